#include "viewer/compared_pictures.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "core/color.h"
#include "core/parallel.h"
#include "fidelity/display.h"
#include "image/resample.h"
#include "measure_fidelity.h"
#include "scene/animate.h"
#include "source/prepared_picture.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

/// Its picture faces the front, along y; the surface of a sculpted mesh with texture coordinates of its own
/// has no picture that it could look like.
bool shows_a_picture(const SourceParams& source) {
    constexpr std::string_view flat[] = {"plane", "relief", "sheet", "disk"};
    if (source.kind != SourceKind::mesh) return false;
    if (source.uv == UvMode::camera || source.uv == UvMode::planar_xz) return true;
    return source.uv == UvMode::mesh && std::ranges::all_of(source.meshes, [&](const auto& part) {
               return std::ranges::find(flat, part.mesh.generic_string()) != std::end(flat);
           });
}

/// Settings that change the size of the picture stay, so that before and after lie on each other.
TextureSettings before_preparation(TextureSettings texture) {
    PrepareParams prepare;
    prepare.align = texture.prepare.align;
    texture.prepare = std::move(prepare);
    return texture;
}

/// With the screen's curve; `opaque`: over black.
Image displayed(Image rgba, bool opaque) {
    parallel_each(rgba.width * rgba.height, 1 << 14, [&](std::int64_t i) {
        float* const p = rgba.pixels.data() + 4 * i;
        for (int c = 0; c < 3; ++c) p[c] = display_srgb(p[c]);
        if (opaque) p[3] = 1.0f;
    });
    return rgba;
}

/// Mean of the three channels, mirrored left to right where asked for.
Image grey_of(const Image& rgba, bool mirrored) {
    Image grey = make_image(rgba.width, rgba.height, 1);
    for (std::int64_t y = 0; y < rgba.height; ++y)
        for (std::int64_t x = 0; x < rgba.width; ++x) {
            const float* const p = rgba.at(mirrored ? rgba.width - 1 - x : x, y);
            *grey.at(x, y) = (p[0] + p[1] + p[2]) / 3.0f;
        }
    return grey;
}

}  // namespace

FrontRequest front_request(Scene now, std::vector<std::shared_ptr<const SplatSet>> sets,
                           std::uint64_t files) {
    OutputParams output;
    output.pixel_filter = now.output.pixel_filter;
    now.output = output;
    now.camera = {};
    now.environment = {};
    stop_animation(now);
    return {std::move(now), std::move(sets), files};
}

bool has_front_picture(const Scene& now) {
    return std::ranges::any_of(
        now.layers, [](const LayerParams& layer) { return layer.visible && shows_a_picture(layer.source); });
}

bool front_changed_by_look(const Scene& now) {
    return std::ranges::any_of(now.layers, [](const LayerParams& layer) {
        LayerRender render = layer.render;
        render.lod = {};
        return layer.visible && !(layer.look == Look{} && render == LayerRender{});
    });
}

FrontCheck::Work front_check(std::int64_t width_px, const SetCache& cache) {
    return [width_px, cache](const FrontRequest& request, const Progress& progress) {
        const FidelityReference reference = fidelity_reference(request.scene, {}, progress, cache);
        FrontComparison front = compare_front(request.scene, request.sets, reference,
                                              std::min(width_px, reference.picture.width), progress);
        return FrontFound{std::move(front.fidelity), signed_difference(front.seen, front.picture), {}};
    };
}

std::optional<PrepareRequest> prepare_request(const LayerParams& layer, std::uint64_t changes) {
    const SourceParams& source = layer.source;
    if (source.kind != SourceKind::mesh || source.meshes.empty() || source.meshes[0].texture.empty())
        return {};
    TextureSettings texture = source.texture;
    texture.mask.clear();  // these come later
    texture.derive = Derived::none;
    texture.smooth = texture.detail = 0.0;
    return PrepareRequest{source.meshes[0].texture, std::move(texture), changes};
}

PreparedView prepared_view(const PrepareRequest& request, std::int64_t most_px, const Progress& progress) {
    PreparedView view;
    view.files = request.files;
    view.before = displayed(
        prepare_picture(request.files, before_preparation(request.texture), progress, most_px).image, true);
    PreparedPicture after = prepare_picture(request.files, request.texture, progress, most_px);
    view.after = displayed(std::move(after.image), true);
    view.stars = static_cast<std::int64_t>(after.stars.size());
    return view;
}

PreparePreview::Work prepare_preview(std::int64_t most_px) {
    return [most_px](const PrepareRequest& request, const Progress& progress) {
        return prepared_view(request, most_px, progress);
    };
}

ReferencePicture::Found ReferencePicture::read(const Request& request, const Progress& progress) {
    constexpr std::int64_t longest_px = 2560;
    Image image = load_linear_image(request.file, progress);
    const std::int64_t longest = std::max(image.width, image.height);
    if (longest > longest_px)
        image = reduced_by_area(image, std::max<std::int64_t>(1, image.width * longest_px / longest),
                                std::max<std::int64_t>(1, image.height * longest_px / longest));
    return {displayed(std::move(image), false), {}};
}

void ReferencePicture::want(const std::filesystem::path& file) {
    request_.file = file;
    std::shared_ptr<const Found> found;
    if (!file.empty()) {
        work_.want(request_);
        found = work_.found(request_);
    }
    error_ = found ? found->error : "";
    if (found && !found->error.empty()) found = nullptr;
    shown_.show(found, &Found::picture);
}

AlignmentFound align_reference(const AlignmentRequest& request, const Progress& progress) {
    const Image& picture = request.picture;
    const FrameOnScreen& frame = request.frame;
    ReferenceParams placed = request.reference;
    const PicturePlace now = place_of(placed, double(picture.width) / double(picture.height), frame);
    const double px_of_scale = frame.height / static_cast<double>(picture.height);
    const PictureOnPicture start{now.corner + 0.5 * (now.right + now.down), placed.scale * px_of_scale,
                                 placed.rotate};
    const std::optional<Registration> found =
        registered(grey_of(request.view, false), grey_of(picture, placed.mirrored), start, progress);
    if (!found) return {};
    const glm::dvec2 heights = (found->place.middle - frame.middle) / frame.height;
    placed.position = {heights.x, -heights.y};
    placed.scale = found->place.scale / px_of_scale;
    placed.rotate = found->place.turn_deg;
    return {rounded_place(placed), found->likeness, {}};
}

void ReferenceAlignment::begin(AlignmentRequest request) {
    request_ = std::make_shared<const AlignmentRequest>(std::move(request));
    work_.want(request_);
}

std::shared_ptr<const AlignmentFound> ReferenceAlignment::take() {
    std::shared_ptr<const AlignmentFound> found = work_.found(request_);
    if (found) work_.forget();
    return found;
}

}  // namespace astrosplat

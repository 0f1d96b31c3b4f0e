#include "viewer/layer_picture.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "core/color.h"
#include "core/parallel.h"
#include "fidelity/display.h"
#include "measure_fidelity.h"
#include "scene/animate.h"
#include "source/prepared_picture.h"

namespace astrosplat {
namespace {

FrontFound compared(const FrontRequest& request, std::int64_t width_px, const SetCache& cache,
                    const Progress& progress) {
    const FidelityReference reference = fidelity_reference(request.scene, {}, progress, cache);
    FrontComparison front = compare_front(request.scene, request.sets, reference,
                                          std::min(width_px, reference.picture.width), progress);
    FrontFound found;
    found.difference = signed_difference(front.seen, front.picture);
    found.fidelity = std::move(front.fidelity);
    return found;
}

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
        return compared(request, width_px, cache, progress);
    };
}

namespace {

/// Over black, with the screen's curve.
Image displayed(Image image) {
    parallel_each(image.width * image.height, 1 << 14, [&](std::int64_t i) {
        float* const p = image.pixels.data() + 4 * i;
        for (int c = 0; c < 3; ++c) p[c] = display_srgb(p[c]);
        p[3] = 1.0f;
    });
    return image;
}

/// Settings that change the size of the picture stay, so that before and after lie on each other.
TextureSettings before_preparation(TextureSettings texture) {
    PrepareParams prepare;
    prepare.align = texture.prepare.align;
    texture.prepare = std::move(prepare);
    return texture;
}

}  // namespace

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
        prepare_picture(request.files, before_preparation(request.texture), progress, most_px).image);
    PreparedPicture after = prepare_picture(request.files, request.texture, progress, most_px);
    view.after = displayed(std::move(after.image));
    view.stars = static_cast<std::int64_t>(after.stars.size());
    return view;
}

PreparePreview::Work prepare_preview(std::int64_t most_px) {
    return [most_px](const PrepareRequest& request, const Progress& progress) {
        return prepared_view(request, most_px, progress);
    };
}

}  // namespace astrosplat

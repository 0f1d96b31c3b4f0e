#include "viewer/comparison.h"

#include <fmt/format.h>

#include <iterator>

#include "core/color.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "fidelity/display.h"
#include "image/resample.h"
#include "measure_fidelity.h"
#include "scene/animate.h"
#include "scene/describe.h"
#include "source/prepared_picture.h"
#include "source/texture.h"
#include "source/write_image.h"

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
    prepare.starless = texture.prepare.starless;  // else the stars alone would stand before
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

std::string front_changed_by(const Scene& now) {
    constexpr std::size_t most = 3;
    std::vector<std::string> changes;
    for (LayerParams layer : now.layers) {
        Look look;
        LayerRender render;
        render.lod = layer.render.lod;
        if (!layer.visible || (layer.look == look && layer.render == render)) continue;
        const Description usual = describe_preset(look, render),
                          own = describe_preset(layer.look, layer.render);
        for (const Parameter& parameter : own.parameters) {
            const Parameter* const standard = find_parameter(usual, parameter.spec.key);
            if (standard && standard->get() == parameter.get()) continue;
            const std::string what =
                lower_case(standard ? parameter.spec.label : std::string(parameter.spec.section));
            if (std::ranges::find(changes, what) == changes.end()) changes.push_back(what);
        }
    }
    const std::size_t named = std::min(changes.size(), most);
    std::string text =
        fmt::format("{}", fmt::join(changes.begin(), changes.begin() + std::ptrdiff_t(named), ", "));
    if (changes.size() > named) text += fmt::format(" and {} more", changes.size() - named);
    return text;
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

void ReferencePicture::want(const fs::path& file) {
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
    const ImageOnImage start{now.corner + 0.5 * (now.right + now.down), placed.scale * px_of_scale,
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

namespace {

std::string png_of(const Image& rgba) {
    std::vector<unsigned char> rgb;
    for (std::size_t i = 0; i < rgba.pixels.size(); ++i)
        if (i % 4 != 3)
            rgb.push_back(
                static_cast<unsigned char>(std::lround(255.0f * std::clamp(rgba.pixels[i], 0.0f, 1.0f))));
    return png_bytes(rgba.width, rgba.height, rgb);
}

/// Black where it is gone: a snapshot is its scene.
Image read_thumbnail(const fs::path& file) {
    try {
        const Image raw = load_raw_image(file);
        Image rgba = make_image(raw.width, raw.height, 4, 1.0f);
        for (std::int64_t y = 0; y < raw.height; ++y)
            for (std::int64_t x = 0; x < raw.width; ++x)
                for (int c = 0; c < 3; ++c) rgba.at(x, y)[c] = raw.at(x, y)[std::min(c, raw.channels - 1)];
        return rgba;
    } catch (const InputError&) {
        return make_image(16, 9, 4, 0.0f);
    }
}

DisplaySettings::Mode mode_of(CompareMode compare, bool blink_shows_other) {
    using Mode = DisplaySettings::Mode;
    if (compare == CompareMode::wipe) return Mode::wipe;
    if (compare == CompareMode::difference) return Mode::difference;
    return compare == CompareMode::blink && !blink_shows_other ? Mode::a : Mode::b;
}

/// Linear light of display values, from a table: 3e-7 of white off at most.
class LightTable {
  public:
    LightTable() {
        for (std::size_t i = 0; i < light_.size(); ++i)
            light_[i] = real::srgb_to_linear(std::min(1.0, double(i) / steps));
    }
    double operator()(float displayed) const {
        const double at = std::clamp(double(displayed), 0.0, 1.0) * steps;
        const auto i = static_cast<std::size_t>(at);
        return light_[i] + (light_[i + 1] - light_[i]) * (at - double(i));
    }

  private:
    static constexpr int steps = 1024;
    std::array<double, steps + 2> light_;
};

}  // namespace

void SnapshotList::open(const fs::path& scene_file, std::vector<std::string>& problems) {
    snapshots_.clear();
    b_ = no_b;
    folder_ = scene_file.empty() ? fs::path() : snapshot_folder(scene_file);
    if (folder_.empty()) return;
    for (const StoredLook& look : read_snapshots(folder_, problems))
        push(look, read_thumbnail(snapshot_image(look.file)));
}

SnapshotList::StoredView& SnapshotList::push(StoredLook look, Image image) {
    snapshots_.push_back({std::move(look), std::move(image)});
    StoredView& view = snapshots_.back();
    view.thumbnail.upload(view.image);
    return view;
}

void SnapshotList::keep(StoredView& view) const {
    StoredLook& look = view.look;
    if (folder_.empty() || look.file.parent_path() == folder_) return;
    look.file = write_snapshot(folder_, look, *look.scene, png_of(view.image));
}

void SnapshotList::move_to(const fs::path& scene_file) {
    folder_ = snapshot_folder(scene_file);
    for (StoredView& view : snapshots_) keep(view);
}

void SnapshotList::add(StoredLook look, Image image) { keep(push(std::move(look), std::move(image))); }

void SnapshotList::rename(std::size_t index, const std::string& name) {
    if (index >= snapshots_.size() || name.empty()) return;
    StoredLook& look = snapshots_[index].look;
    if (!look.file.empty()) rename_snapshot(look.file, name);
    look.name = name;
}

void SnapshotList::remove(std::size_t index) {
    if (index >= snapshots_.size()) return;
    if (const fs::path& file = snapshots_[index].look.file; !file.empty()) remove_snapshot(file);
    snapshots_.erase(snapshots_.begin() + static_cast<std::ptrdiff_t>(index));
    if (b_ == index) b_ = no_b;
    if (b_ != no_b && b_ > index) --b_;
}

std::string SnapshotList::next_name() const {
    const auto is_taken = [&](const std::string& name) {
        return std::ranges::any_of(snapshots_,
                                   [&](const StoredView& view) { return view.look.name == name; });
    };
    std::string name;
    for (std::size_t number = snapshots_.size() + 1; name.empty() || is_taken(name); ++number)
        name = "Look " + std::to_string(number);
    return name;
}

void SnapshotList::fill(Status& status) const {
    status.snapshots.clear();
    for (const StoredView& view : snapshots_)
        status.snapshots.push_back(
            {view.look.name, to_handle(view.thumbnail.handle()),
             static_cast<float>(view.image.width) / static_cast<float>(view.image.height), view.look.splats,
             view.look.seconds});
    status.b_snapshot = b() ? static_cast<int>(b_) : -1;
    status.b_name = b() ? b()->name : "";
}

Image thumbnail_of(const std::vector<unsigned char>& rgba, int width, int height, int most) {
    const int factor = std::max(1, (width + most - 1) / most);
    const int rows = std::min(factor, height);  // of a block, in a view lower than a block is wide
    Image small = make_image(std::max(1, width / factor), std::max(1, height / factor), 4, 0.0f);
    for (std::int64_t y = 0; y < small.height; ++y)
        for (std::int64_t x = 0; x < small.width; ++x)
            for (int c = 0; c < 4; ++c) {
                int sum = 0;
                for (int j = 0; j < rows; ++j)
                    for (int i = 0; i < factor; ++i)
                        sum += rgba[static_cast<std::size_t>(((y * factor + j) * width + x * factor + i) * 4 +
                                                             c)];
                small.at(x, y)[c] = static_cast<float>(sum) / (255.0f * static_cast<float>(factor * rows));
            }
    return small;
}

void Comparison::find_reference(const Scene& scene, const ViewState& view, Status& status) {
    const auto index = astrosplat::find_reference(scene, reference_view(view.view), view.frame);
    reference_.want(index ? scene.references[*index].file : fs::path());
    status.reference.reset();
    if (!index) return;
    status.reference.emplace();
    status.reference->index = *index;
    status.reference->error = reference_.error();
    if (reference_.picture()) status.reference->aspect = reference_.aspect();
}

void Comparison::show(const Scene& scene, const ViewState& view, const ViewOfB& how, DisplaySettings& shown) {
    comparing_ = compares(view);
    blink_shows_other_ = std::fmod(std::floor(how.now * view.blink_hz), 2.0) == 1.0;
    if (!comparing_) return;
    if (view.compare_with == CompareWith::reference) {
        const auto index = astrosplat::find_reference(scene, reference_view(view.view), view.frame);
        if (!index || !reference_.picture()) return;
        const ReferenceParams& reference = scene.references[*index];
        shown.b = reference_.texture();
        shown.b_is_display = true;
        shown.b_place = place_of(reference, reference_.aspect(), how.frame);
        shown.b_opacity = static_cast<float>(reference.opacity);
    } else {
        if (!how.look) return;
        PreviewChoice choice = how.choice;
        choice.refined = false;  // two sums of whole sets would take twice the memory
        b_.show(how.request_for(with_look_of(scene, *how.look->scene)), choice, how.may_settle, how.now);
        shown.b = b_.texture();
    }
    shown.mode = mode_of(view.compare, blink_shows_other_);
    shown.difference_gain = view.difference_gain;
}

const ViewFrameStatus* Comparison::refining() const {
    return comparing_ && b_.status().state == ViewFrameState::refining ? &b_.status() : nullptr;
}

std::optional<DifferenceStatus> difference_of(const Image& a, const Image& b) {
    static const LightTable light;
    double sum = 0.0, squares = 0.0, light_a = 0.0, light_b = 0.0;
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < a.width * a.height; ++i) {
        const float *const pa = a.pixels.data() + 4 * i, *const pb = b.pixels.data() + 4 * i;
        if (pb[3] < 1.0f) continue;
        for (int c = 0; c < 3; ++c) {
            const double difference = double(pa[c]) - double(pb[c]);
            sum += difference;
            squares += difference * difference;
            light_a += light(pa[c]);
            light_b += light(pb[c]);
        }
        count += 3;
    }
    if (count == 0) return std::nullopt;
    const double mean_square = squares / double(count);
    DifferenceStatus found;
    found.mean = sum / double(count);
    found.psnr_db =
        mean_square > 0.0 ? -10.0 * std::log10(mean_square) : std::numeric_limits<double>::infinity();
    found.light = light_b > 0.0   ? light_a / light_b
                  : light_a > 0.0 ? std::numeric_limits<double>::infinity()
                                  : 1.0;
    return found;
}

void DifferenceMeter::measure(Display& display, const DisplaySettings& shown, glm::ivec2 target_px,
                              double now) {
    constexpr double every_s = 0.25;
    waiting_ = !(shown == measured_ && target_px == target_px_);
    if (!waiting_ || (measured_at_ >= 0.0 && now - measured_at_ < every_s)) return;
    const Display::Compared sides = display.read_compared(shown, target_px.x, target_px.y);
    found_ = difference_of(sides.a, sides.b);
    measured_ = shown;
    target_px_ = target_px;
    measured_at_ = now;
    waiting_ = false;
}

}  // namespace astrosplat

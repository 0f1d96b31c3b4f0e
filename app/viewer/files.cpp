#include "viewer/files.h"

#include <glm/gtc/packing.hpp>
#include <sstream>
#include <tuple>

#include "core/color.h"
#include "core/log.h"
#include "core/text.h"
#include "image/resample.h"
#include "output/format.h"
#include "output/metadata.h"
#include "scene/layer_setup.h"
#include "source/stored_picture.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

/// An image made small while it is read, its pixels as they are stored.
struct SmallImage {
    Image image;                         // RGBA, opaque; what had no value is black
    bool light = false;                  // linear, with the primaries of Rec. 709; else display values
    std::int64_t width = 0, height = 0;  // px in the file
};

/// Values of a FITS plane that are held at once.
constexpr std::int64_t most_values = std::int64_t{1} << 22;

/// Pixels without a value are black: a gap must not take the light around it.
ImageRows without_gaps(ImageRows rows) {
    const std::int64_t row_values = rows.width * rows.channels;
    rows.read = [row_values, read = std::move(rows.read)](std::int64_t begin, std::int64_t end, float* out) {
        read(begin, end, out);
        std::replace_if(
            out, out + (end - begin) * row_values, [](float value) { return std::isnan(value); }, 0.0f);
    };
    return rows;
}

std::int64_t shrunk(std::int64_t length, std::int64_t longer, std::int64_t most_px) {
    return longer <= most_px ? length : std::max<std::int64_t>(1, length * most_px / longer);
}

/// Those that an EXR file names.
std::optional<Chromaticities> chromaticities_of(const fs::path& file) {
    for (const auto& [name, text] : read_image_info(file).metadata) {
        if (name != "chromaticities") continue;
        std::vector<double> n;
        std::istringstream words(text);
        for (std::string word; std::getline(words, word, ',');)
            n.push_back(parse_double(trim(word)).value_or(0.0));
        if (n.size() != 8 || std::ranges::any_of(n, [](double x) { return !(x > 0.0 && x < 1.0); })) break;
        return Chromaticities{{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}};
    }
    return std::nullopt;
}

bool is_near(const glm::dvec2& a, const glm::dvec2& b) {
    return std::fabs(a.x - b.x) < 1e-4 && std::fabs(a.y - b.y) < 1e-4;
}

void to_rec709(Image& rgba, const fs::path& file) {
    const std::optional<Chromaticities> from = chromaticities_of(file);
    constexpr Chromaticities to = rec709_chromaticities;
    if (!from || (is_near(from->red, to.red) && is_near(from->green, to.green) &&
                  is_near(from->blue, to.blue) && is_near(from->white, to.white)))
        return;
    const glm::mat3 matrix(primaries_matrix(*from, to));
    for (std::int64_t i = 0; i < rgba.width * rgba.height; ++i) {
        float* const p = rgba.pixels.data() + 4 * i;
        const glm::vec3 light = matrix * glm::vec3(p[0], p[1], p[2]);
        for (int c = 0; c < 3; ++c) p[c] = light[c];
    }
}

/// By rows, so that a large one takes time but no memory. Throws InputError, Cancelled.
SmallImage read_small_image(const fs::path& file, std::int64_t most_px, const Progress& progress = {}) {
    StoredRows from = open_stored(file, TextureSettings{}, progress, most_values);
    SmallImage made{{}, !from.stored.display_values, from.rows.width, from.rows.height};
    const std::int64_t longer = std::max(made.width, made.height);
    const Image small =
        reduced_by_area(without_gaps(std::move(from.rows)), shrunk(made.width, longer, most_px),
                        shrunk(made.height, longer, most_px));
    progress.check();
    const bool multiplies = small.channels == 4 && !from.stored.picture.associated;
    made.image = make_image(small.width, small.height, 4, 1.0f);
    for (std::int64_t i = 0; i < small.width * small.height; ++i) {
        const float* const p = small.pixels.data() + i * small.channels;
        for (int c = 0; c < 3; ++c) made.image.pixels[4 * i + c] = multiplies ? p[c] * p[3] : p[c];
    }
    if (made.light) to_rec709(made.image, file);
    return made;
}

std::uint8_t code_of(float value) {
    return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

std::uint16_t half_of(float value) {
    constexpr float largest = 65504.0f;  // that a half float can be
    return glm::packHalf1x16(std::clamp(value, -largest, largest));
}

/// Red, green and blue of each pixel, as `pack` makes them.
template <class Packed, class Pack>
std::vector<Packed> packed(const Image& rgba, const Pack& pack) {
    std::vector<Packed> values(static_cast<std::size_t>(3 * rgba.width * rgba.height));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = pack(rgba.pixels[i / 3 * 4 + i % 3]);
    return values;
}

PackedImage size_of(const SmallImage& small) {
    return {small.image.width, small.image.height, small.width, small.height, {}, {}, {}};
}

PackedImage frame_of_file(const fs::path& file, std::int64_t most_px, const Progress& progress) {
    const SmallImage small = read_small_image(file, most_px, progress);
    PackedImage frame = size_of(small);
    if (small.light)
        frame.light = packed<std::uint16_t>(small.image, half_of);
    else
        frame.codes = packed<std::uint8_t>(small.image, code_of);
    return frame;
}

/// None where it is gone.
std::optional<ListedPicture> as_it_lies(const fs::path& file) {
    std::error_code missing;
    const ListedPicture listed{file, fs::last_write_time(file, missing), fs::file_size(file, missing)};
    return missing ? std::nullopt : std::optional(listed);
}

}  // namespace

Image to_image(const PackedImage& packed) {
    Image image = make_image(packed.width, packed.height, 4, 1.0f);
    for (std::size_t i = 0; i < packed.codes.size(); ++i)
        image.pixels[i / 3 * 4 + i % 3] = static_cast<float>(packed.codes[i]) * (1.0f / 255.0f);
    for (std::size_t i = 0; i < packed.light.size(); ++i)
        image.pixels[i / 3 * 4 + i % 3] = glm::unpackHalf1x16(packed.light[i]);
    return image;
}

PackedImage thumbnail_of_file(const fs::path& file, std::int64_t most_px, const Progress& progress) {
    const SmallImage small = read_small_image(file, most_px, progress);
    PackedImage thumbnail = size_of(small);
    thumbnail.codes = packed<std::uint8_t>(
        small.image, [&](float value) { return code_of(small.light ? display_srgb(value) : value); });
    return thumbnail;
}

Thumbnails::Thumbnails(std::int64_t most_px, std::size_t most_bytes)
    : ReadAhead(
          [most_px](const ListedPicture& picture, const Progress& progress) {
              const QuietLog quiet;  // whoever opens it is told why it cannot be read
              return thumbnail_of_file(picture.file, most_px, progress);
          },
          most_bytes) {}

void Thumbnails::want(std::vector<ListedPicture> pictures) {
    std::ranges::stable_sort(pictures, {}, &ListedPicture::bytes);
    ReadAhead::want(std::move(pictures));
}

RenderedFrames::RenderedFrames(std::int64_t most_px, std::size_t most_bytes)
    : ReadAhead(
          [most_px](const ListedPicture& picture, const Progress& progress) {
              return frame_of_file(picture.file, most_px, progress);
          },
          most_bytes) {}

void RenderedFrames::want(const std::vector<fs::path>& files) {
    std::vector<ListedPicture> there;
    for (const fs::path& file : files)
        if (const auto listed = as_it_lies(file)) there.push_back(*listed);
    ReadAhead::want(std::move(there));
}

std::shared_ptr<const PackedImage> RenderedFrames::found(const fs::path& file) const {
    const auto listed = as_it_lies(file);
    return listed ? ReadAhead::found(*listed) : nullptr;
}

FinishedView finished_view(const FinishedRequest& request, std::int64_t most_px) {
    SmallImage small = read_small_image(request.file, most_px);
    if (!small.light) {
        for (float& value : small.image.pixels) value = std::clamp(value, 0.0f, 1.0f);
        return {std::move(small.image), {}};
    }
    FrameFormat format;
    format.kind = FrameKind::png;
    format.depth = OutputParams::Depth::uint8;
    format.alpha = OutputParams::Alpha::none;
    format.view = request.view;
    format.exposure = request.exposure;
    format.ocio = request.ocio;
    PackedImage seen = size_of(small);
    seen.codes = encode_8bit(format, small.image, 0, 0);
    return {to_image(seen), {}};
}

FinishedFrames::Work finished_frames(std::int64_t most_px) {
    return [most_px](const FinishedRequest& request, const Progress&) {
        return finished_view(request, most_px);
    };
}

namespace {

/// Of a layer's source: what the scene names, and what was found in there.
std::vector<fs::path> files_of(const LayerParams& layer, const SetLoader& loader) {
    std::vector<fs::path> paths = named_files(layer.source);
    if (const auto loaded = loader.layer(layer.name))
        paths.insert(paths.end(), loaded->files.begin(), loaded->files.end());
    return paths;
}

}  // namespace

const Image& PictureFiles::map(const fs::path& file, Derived derive) {
    std::unique_ptr<Image>& image = maps_[{file, derive}];
    if (!image) image = std::make_unique<Image>(load_map(file, derive));
    return *image;
}

bool PictureFiles::ByPictures::operator()(const EnvironmentParams& a, const EnvironmentParams& b) const {
    const auto key = [](const EnvironmentParams& p) {
        return std::tie(p.image, p.cube, p.tile, p.tiling.height_deg, p.tiling.seed, p.tiling.face_px);
    };
    return key(a) < key(b);
}

std::shared_ptr<const Environment> PictureFiles::environment(const EnvironmentParams& params) {
    constexpr std::size_t most_skies = 3;
    const bool seen = has_environment(params) && params.visible;
    const EnvironmentParams files = pictures_of(params);
    {
        const auto held = worker_.lock();
        wanted_ = seen ? std::optional(files) : std::nullopt;
        if (!seen) return nullptr;
        if (const auto known = skies_.find(files); known != skies_.end()) {
            const Sky& sky = known->second;
            if (sky.error) std::rethrow_exception(sky.error);
            if (!sky.loaded) return nullptr;
            Environment environment = *sky.loaded;
            set_environment_params(environment, params);
            return std::make_shared<const Environment>(std::move(environment));
        }
        if (skies_.size() >= most_skies)
            std::erase_if(skies_, [](const auto& sky) { return sky.second.rests(); });
        skies_[files];
    }
    worker_.wake();
    return nullptr;
}

bool PictureFiles::loading() const {
    const auto held = worker_.lock();
    const auto sky = wanted_ ? skies_.find(*wanted_) : skies_.end();
    return sky != skies_.end() && !sky->second.rests();
}

void PictureFiles::forget(const std::vector<fs::path>& files) {
    const auto is_changed = [&](const fs::path& file) {
        return std::ranges::find(files, file) != files.end();
    };
    old_maps_.clear();
    for (auto& [of, image] : maps_)
        if (is_changed(of.first)) old_maps_.push_back(std::move(image));
    {
        const auto held = worker_.lock();
        for (auto& [of, sky] : skies_)
            if (is_changed(of.image) || is_changed(of.tile) || std::ranges::any_of(of.cube, is_changed))
                sky.due = true;
    }
    worker_.wake();
}

/// The one that is waited for first.
Worker::Task PictureFiles::next_sky() {
    auto next = wanted_ ? skies_.find(*wanted_) : skies_.end();
    if (next == skies_.end() || !next->second.due)
        next = std::ranges::find_if(skies_, [](const auto& sky) { return sky.second.due; });
    if (next == skies_.end()) return {};
    next->second.due = false;
    next->second.loading = true;
    return [this, files = next->first] { load(files); };
}

void PictureFiles::load(const EnvironmentParams& params) {
    std::optional<Environment> loaded;
    std::exception_ptr error;
    try {
        loaded = load_environment(params);
    } catch (...) {
        error = std::current_exception();
    }
    const auto held = worker_.lock();
    Sky& sky = skies_[params];  // which stays while it is loading
    sky.loaded = std::move(loaded);
    sky.error = error;
    sky.loading = false;
}

void ColorManagement::update(const OcioParams& params, bool seen) {
    const fs::path file = config_file(params);
    if (!params.wanted() && (!seen || file.empty())) {
        asked_.reset();
        transform_.reset();
        status_.reset();
        return;
    }
    const Asked now{params, file, stamp_of(file)};
    if (asked_ == now) return;
    asked_ = now;
    read(now);
}

void ColorManagement::read(const Asked& now) {
    ColorStatus status;
    transform_.reset();
    try {
        if (!now.file.empty()) status.config = read_color_config(now.file);
        if (now.params.wanted()) transform_ = display_transform(now.params);
    } catch (const InputError& error) {
        status.error = error.what();
    }
    if (transform_) {
        status.display = transform_->display();
        status.view = transform_->view();
        status.space = transform_->space();
    }
    status_ = std::move(status);
}

std::vector<fs::path> files_in_use(const Scene& scene, const SetLoader& loader, const fs::path& reference) {
    std::vector<fs::path> paths = picture_files(scene);
    for (const LayerParams& layer : scene.layers) {
        const std::vector<fs::path> more = files_of(layer, loader);
        paths.insert(paths.end(), more.begin(), more.end());
    }
    if (!reference.empty()) paths.push_back(reference);
    return paths;
}

void outdate_layers_of(const std::vector<fs::path>& files, const Scene& scene, SetLoader& loader) {
    for (const LayerParams& layer : scene.layers) {
        const std::vector<fs::path> its = files_of(layer, loader);
        if (std::find_first_of(its.begin(), its.end(), files.begin(), files.end()) != its.end())
            loader.outdate(layer.name);
    }
    loader.want(scene);
}

}  // namespace astrosplat

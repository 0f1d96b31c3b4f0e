#include "viewer/file_pictures.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <optional>
#include <sstream>
#include <utility>

#include "core/color.h"
#include "core/log.h"
#include "core/text.h"
#include "image/resample.h"
#include "output/format.h"
#include "output/metadata.h"
#include "source/stored_picture.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

/// A picture made small while it is read, its pixels as they are stored.
struct SmallPicture {
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
SmallPicture read_small_picture(const fs::path& file, std::int64_t most_px, const Progress& progress = {}) {
    StoredRows from = open_stored(file, TextureSettings{}, progress, most_values);
    SmallPicture made{{}, !from.stored.display_values, from.rows.width, from.rows.height};
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

PackedPicture size_of(const SmallPicture& small) {
    return {small.image.width, small.image.height, small.width, small.height, {}, {}, {}};
}

PackedPicture frame_of_file(const fs::path& file, std::int64_t most_px, const Progress& progress) {
    const SmallPicture small = read_small_picture(file, most_px, progress);
    PackedPicture frame = size_of(small);
    if (small.light)
        frame.light = packed<std::uint16_t>(small.image, half_of);
    else
        frame.codes = packed<std::uint8_t>(small.image, code_of);
    return frame;
}

}  // namespace

Image to_image(const PackedPicture& picture) {
    Image image = make_image(picture.width, picture.height, 4, 1.0f);
    for (std::size_t i = 0; i < picture.codes.size(); ++i)
        image.pixels[i / 3 * 4 + i % 3] = static_cast<float>(picture.codes[i]) * (1.0f / 255.0f);
    for (std::size_t i = 0; i < picture.light.size(); ++i)
        image.pixels[i / 3 * 4 + i % 3] = glm::unpackHalf1x16(picture.light[i]);
    return image;
}

PackedPicture thumbnail_of_file(const fs::path& file, std::int64_t most_px, const Progress& progress) {
    const SmallPicture small = read_small_picture(file, most_px, progress);
    PackedPicture thumbnail = size_of(small);
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
    : frames_([most_px](const Key& key,
                        const Progress& progress) { return frame_of_file(key.file, most_px, progress); },
              most_bytes) {}

void RenderedFrames::want(const std::vector<fs::path>& files) {
    wanted_.clear();
    std::vector<Key> keys;
    for (const fs::path& file : files) {
        std::error_code missing;
        const fs::file_time_type written = fs::last_write_time(file, missing);
        if (missing) continue;
        wanted_[file] = written;
        keys.push_back({file, written});
    }
    frames_.want(std::move(keys));
}

std::shared_ptr<const PackedPicture> RenderedFrames::found(const fs::path& file) const {
    const auto key = wanted_.find(file);
    return key == wanted_.end() ? nullptr : frames_.found({file, key->second});
}

FinishedView finished_view(const FinishedRequest& request, std::int64_t most_px) {
    SmallPicture small = read_small_picture(request.file, most_px);
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
    PackedPicture seen = size_of(small);
    seen.codes = encode_8bit(format, small.image, 0, 0);
    return {to_image(seen), {}};
}

FinishedFrames::Work finished_frames(std::int64_t most_px) {
    return [most_px](const FinishedRequest& request, const Progress&) {
        return finished_view(request, most_px);
    };
}

}  // namespace astrosplat

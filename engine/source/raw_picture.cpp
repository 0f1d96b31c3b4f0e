// Pictures that are numbers and no light: maps, masks, depths.
#include <fmt/format.h>

#include "core/log.h"
#include "core/text.h"
#include "image/channels.h"
#include "source/fits.h"
#include "source/picture.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

// RGB, or RGBA, as stored; some values may be none or infinite.
Picture raw_picture(const fs::path& file, Wanted wanted = Wanted::colors) {
    if (!is_fits(file)) return read_picture(file, {}, "auto", wanted);
    const FitsPlane plane = read_fits(file, "auto", {});
    Picture picture;
    picture.image = make_image(plane.width, plane.height, 3);
    const std::size_t copies = plane.channels == 1 ? 3 : 1;
    for (std::size_t i = 0; i < picture.image.pixels.size(); ++i)
        picture.image.pixels[i] = float(plane.values[i / copies]);
    return picture;
}

float usable(float value) {
    return std::isnan(value) ? 0.0f : std::isinf(value) ? std::copysign(half_max, value) : value;
}

Image usable_colors(const Image& stored) {
    return made_by_pixel(stored, 3,
                         [](const float* in, float* out) { std::transform(in, in + 3, out, usable); });
}

// Paint of one colour, or none at all where the colours are multiplied by alpha, on nothing.
bool is_painted_in_alpha(const Picture& picture) {
    const Image& image = picture.image;
    if (!picture.has_alpha()) return false;
    const float* first = nullptr;  // that shows
    bool varies = false;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        const float* const p = image.pixels.data() + i;
        varies = varies || p[3] != image.pixels[3];
        if (!(p[3] > 0.0f)) continue;
        if (!first) first = p;
        if (!std::equal(p, p + 3, first)) return false;
    }
    return varies && first && (!picture.associated || std::max({first[0], first[1], first[2]}) == 0.0f);
}

// Those that are depths, of the values that are numbers and less than the sky's.
struct DepthRange {
    float lo = std::numeric_limits<float>::infinity(), hi = -lo;

    void add(float value) {
        lo = std::min(lo, value);
        hi = std::max(hi, value);
    }
    bool holds(float value) const { return value >= lo && value <= hi; }
};

DepthRange depth_range(const Image& grey, bool floats) {
    constexpr float least_sky = 1e9f;  // Blender's is 1e10
    constexpr float most_times = 100.0f;
    DepthRange all, nearer;
    for (const float value : grey.pixels)
        if (std::isfinite(value) && std::fabs(value) < least_sky) all.add(value);
    for (const float value : grey.pixels)
        if (all.holds(value) && value < all.hi) nearer.add(value);
    const float span = nearer.hi - nearer.lo;
    return floats && span > 0.0f && all.hi - all.lo > most_times * span ? nearer : all;
}

}  // namespace

Image load_raw_image(const fs::path& file) { return usable_colors(raw_picture(file).image); }

Image load_mask(const fs::path& file) {
    const Picture picture = raw_picture(file);
    if (!is_painted_in_alpha(picture)) return usable_colors(picture.image);
    return made_by_pixel(picture.image, 3,
                         [](const float* in, float* out) { std::fill_n(out, 3, usable(in[3])); });
}

Image load_depths(const fs::path& file) {
    const Picture picture = raw_picture(file, Wanted::depths);
    Image grey = mean_of_channels(picture.image);
    const DepthRange range = depth_range(grey, picture.max_integer == 0.0);
    if (!(range.lo <= range.hi)) {
        log_warning(file.string() + ": no depths: every pixel is undefined or sky");
        return make_image(grey.width, grey.height, 1);
    }
    std::int64_t sky = 0;
    for (float& value : grey.pixels) {
        if (!range.holds(value)) {
            value = picture.distances ? range.hi : range.lo;
            ++sky;
        }
        if (picture.distances) value = -value;
    }
    log_info(fmt::format(
        "{}: {} from {:.5g} to {:.5g}{}", file.string(), picture.distances ? "distances" : "depths", range.lo,
        range.hi,
        sky == 0 ? "" : fmt::format("; {} {} sky", counted(sky, "pixel"), sky == 1 ? "is" : "are")));
    return grey;
}

Image load_map(const fs::path& file, Derived derive) {
    if (derive == Derived::none) return load_raw_image(file);
    const Image map = derived_picture(load_linear_image(file), derive);
    Image grey = make_image(map.width, map.height, 3);
    for (std::size_t i = 0; i < grey.pixels.size(); ++i) grey.pixels[i] = map.pixels[i / 3];
    return grey;
}

}  // namespace astrosplat

// FITS keeps its values until stars are taken away: a stretch would change their profiles and cut them off.
#include "source/prepare_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/color.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "source/fits.h"
#include "source/picture.h"
#include "source/stored_picture.h"
#include "source/stretch.h"

namespace astrosplat {
namespace {

constexpr double saturated_integer = 0.98;  // of linear light, in pictures of integers

TanGrid grid_of(const FitsSky& sky) {
    return {{sky.crpix[0], sky.crpix[1]}, {sky.crval[0], sky.crval[1]}, sky.cd};
}

PrepareInput read_fits_input(const std::filesystem::path& file, const TextureSettings& settings,
                             const Progress& progress) {
    const FitsPlane plane = read_fits(file, settings.hdu, settings.plane, progress);
    const Limits limits = choose_limits(value_range(plane.values), settings, file.string());
    PrepareInput input;
    input.image = make_image(plane.width, plane.height, 4);
    input.empty = make_mask(plane.width, plane.height);
    for (std::size_t i = 0; i < plane.values.size(); ++i) {
        const double value = (plane.values[i] - limits.black) / (limits.white - limits.black);
        float* const p = input.image.pixels.data() + 4 * i;
        input.empty.pixels[i] = std::isfinite(value) ? 0 : 1;
        std::fill_n(p, 3, std::isfinite(value) ? static_cast<float>(value) : 0.0f);
        p[3] = std::isfinite(value) ? 1.0f : 0.0f;
    }
    input.stretch = stretch_of(settings);
    input.saturation = std::numeric_limits<double>::infinity();
    input.credit = plane.credit;
    if (plane.sky) input.grid = grid_of(*plane.sky);
    return input;
}

PrepareInput read_picture_input(const std::filesystem::path& file, const TextureSettings& settings,
                                const Progress& progress) {
    Stored stored = read_stored(file, settings, progress);
    PrepareInput input;
    const bool integers = stored.picture.max_integer > 0.0;
    input.saturation = integers ? saturated_integer : std::numeric_limits<double>::infinity();
    input.credit = stored.picture.credit;
    input.image = linear_image(std::move(stored), settings.colorspace);
    input.empty = make_mask(input.image.width, input.image.height);
    for (std::size_t i = 0; i < input.empty.pixels.size(); ++i) {
        float* const p = input.image.pixels.data() + 4 * i;
        const bool finite = std::all_of(p, p + 4, [](float value) { return std::isfinite(value); });
        input.empty.pixels[i] = finite && p[3] > 0.0f ? 0 : 1;
        if (!finite) std::fill_n(p, 4, 0.0f);
    }
    return input;
}

bool same_grid(const TanGrid& a, const TanGrid& b) {
    return a.reference_px == b.reference_px && a.reference_deg == b.reference_deg &&
           a.deg_per_px == b.deg_per_px;
}

// Pixels as a picture of 0 and 1, so that they can be put on a grid as well.
Image as_picture(const PixelMask& mask) {
    Image image = make_image(mask.width, mask.height, 1);
    std::copy(mask.pixels.begin(), mask.pixels.end(), image.pixels.begin());
    return image;
}

// On a grid of width x height pixels; what was mostly empty stays so.
void put_on_grid(PrepareInput& input, const TanGrid& grid, std::int64_t width, std::int64_t height) {
    PixelMask outside;
    const Image emptiness = regridded(as_picture(input.empty), *input.grid, grid, width, height, outside);
    input.image = regridded(input.image, *input.grid, grid, width, height, outside);
    for (std::size_t i = 0; i < outside.pixels.size(); ++i)
        if (emptiness.pixels[i] > 0.5f) outside.pixels[i] = 1;
    input.empty = std::move(outside);
    input.grid = grid;
}

// The mean of a filter's channels becomes one channel of the picture.
void put_channel(const PrepareInput& filter, int channel, PrepareInput& rgb) {
    for (std::size_t i = 0; i < rgb.empty.pixels.size(); ++i) {
        const float* const p = filter.image.pixels.data() + 4 * i;
        rgb.image.pixels[4 * i + static_cast<std::size_t>(channel)] = (p[0] + p[1] + p[2]) / 3.0f;
        if (filter.empty.pixels[i]) rgb.empty.pixels[i] = 1;
    }
}

}  // namespace

PrepareInput read_three_filters(const std::array<std::filesystem::path, 3>& files,
                                const TextureSettings& settings, const Progress& progress) {
    const PrepareInput first = read_prepare_input(files[0], settings, progress);
    PrepareInput rgb = first;
    put_channel(first, 0, rgb);
    for (std::size_t c = 1; c < 3; ++c) {
        PrepareInput filter = read_prepare_input(files[c], settings, progress);
        const bool same_size =
            filter.image.width == rgb.image.width && filter.image.height == rgb.image.height;
        const bool known = filter.grid && first.grid;
        if (!same_size && !known)
            bad_input(files[c].string(), "",
                      fmt::format("{}x{} px like {}, or where the sky is on both", rgb.image.width,
                                  rgb.image.height, files[0].string()),
                      fmt::format("{}x{} px", filter.image.width, filter.image.height));
        if (known && !(same_size && same_grid(*filter.grid, *first.grid)))
            put_on_grid(filter, *first.grid, rgb.image.width, rgb.image.height);
        put_channel(filter, static_cast<int>(c), rgb);
        rgb.credit = joined_once({rgb.credit, filter.credit});
    }
    return rgb;
}

PrepareInput read_prepare_input(const std::filesystem::path& file, const TextureSettings& settings,
                                const Progress& progress) {
    PrepareInput input = is_fits(file) ? read_fits_input(file, settings, progress)
                                       : read_picture_input(file, settings, progress);
    fill(input.image, input.empty, FillKind::membrane, progress);
    input.name = file.string();
    return input;
}

void align_to(const std::filesystem::path& reference, const TextureSettings& settings, PrepareInput& input,
              const Progress& progress) {
    const auto require_sky = [](const std::string& name, bool known) {
        if (!known) bad_input(name, "", "a FITS picture whose header tells the sky (RA---TAN)", "none");
    };
    require_sky(input.name, input.grid.has_value());
    require_sky(reference.string(), is_fits(reference));
    const FitsPlane plane = read_fits(reference, settings.hdu, settings.plane, progress);
    require_sky(reference.string(), plane.sky.has_value());
    put_on_grid(input, grid_of(*plane.sky), plane.width, plane.height);
}

void apply_stretch(Image& image, TextureSettings::Stretch stretch, double softening) {
    if (stretch == TextureSettings::Stretch::linear) return;
    parallel_each(image.height, 16, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c) {
                float& value = image.at(x, y)[c];
                value = static_cast<float>(real::srgb_to_linear(
                    stretched(static_cast<double>(value), {0.0, 1.0}, stretch, softening)));
            }
    });
}

}  // namespace astrosplat

// The stages of a picture's preparation. FITS keeps its values until stars are taken away: a stretch would
// change their profiles and cut them off.
#include "source/prepared_picture.h"

#include <fmt/format.h>

#include "core/color.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/text.h"
#include "image/blur.h"
#include "image/channels.h"
#include "prepare/star_removal.h"
#include "source/fits.h"
#include "source/picture.h"
#include "source/stored_picture.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

// A picture as the stages of its preparation take it.
struct PrepareInput {
    Image image;  // RGBA, premultiplied; FITS: 0 at its black, 1 at its white point, beyond them as measured
    PixelMask empty;          // pixels without a value: filled in `image`, their alpha is 0
    double saturation = 0.0;  // linear light from which a channel tells nothing more; infinite where unknown
    TextureSettings::Stretch stretch = TextureSettings::Stretch::linear;  // still to come
    std::string credit;
    std::optional<TanGrid> grid;  // how the sky lies on it, where that is known
    std::string name;             // of its file
};

constexpr double saturated_integer = 0.98;  // of linear light, in pictures of integers

TanGrid grid_of(const FitsSky& sky) {
    return {{sky.crpix[0], sky.crpix[1]}, {sky.crval[0], sky.crval[1]}, sky.cd};
}

PrepareInput read_fits_input(const fs::path& file, const TextureSettings& settings,
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
        std::fill_n(p, 3, std::isfinite(value) ? float(value) : 0.0f);
        p[3] = std::isfinite(value) ? 1.0f : 0.0f;
    }
    input.stretch = stretch_of(settings);
    input.saturation = std::numeric_limits<double>::infinity();
    input.credit = plane.credit;
    if (plane.sky) input.grid = grid_of(*plane.sky);
    return input;
}

PrepareInput read_picture_input(const fs::path& file, const TextureSettings& settings,
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
        rgb.image.pixels[4 * i + std::size_t(channel)] = (p[0] + p[1] + p[2]) / 3.0f;
        if (filter.empty.pixels[i]) rgb.empty.pixels[i] = 1;
    }
}

// Throws InputError, Cancelled.
PrepareInput read_prepare_input(const fs::path& file, const TextureSettings& settings,
                                const Progress& progress) {
    PrepareInput input = is_fits(file) ? read_fits_input(file, settings, progress)
                                       : read_picture_input(file, settings, progress);
    fill(input.image, input.empty, FillKind::membrane, progress);
    input.name = file.string();
    return input;
}

// Three filters as red, green and blue. Where the sky is known on all of them (FITS) and their grids differ,
// green and blue are sampled on red's; else they must have one size. Throws InputError, Cancelled.
PrepareInput read_three_filters(const std::array<fs::path, 3>& files, const TextureSettings& settings,
                                const Progress& progress) {
    const PrepareInput first = read_prepare_input(files[0], settings, progress);
    PrepareInput rgb = first;
    put_channel(first, 0, rgb);
    for (std::size_t c = 1; c < 3; ++c) {
        PrepareInput filter = read_prepare_input(files[c], settings, progress);
        const bool same_size =
            filter.image.width == rgb.image.width && filter.image.height == rgb.image.height;
        const bool known = filter.grid && first.grid;
        if (!same_size && !known)
            bad_input(files[c],
                      fmt::format("{}x{} px like {}, or where the sky is on both", rgb.image.width,
                                  rgb.image.height, files[0].string()),
                      fmt::format("{}x{} px", filter.image.width, filter.image.height));
        if (known && !(same_size && same_grid(*filter.grid, *first.grid)))
            put_on_grid(filter, *first.grid, rgb.image.width, rgb.image.height);
        put_channel(filter, int(c), rgb);
        rgb.credit = joined_once({rgb.credit, filter.credit});
    }
    return rgb;
}

// Puts a picture on the grid that the FITS picture `reference` has on the sky, with its size. Throws
// InputError where the sky is not known on both, Cancelled.
void align_to(const fs::path& reference, const TextureSettings& settings, PrepareInput& input,
              const Progress& progress) {
    const auto require_sky = [](const std::string& name, bool known) {
        if (!known) bad_input(name, "a FITS picture whose header tells the sky (RA---TAN)", "none");
    };
    require_sky(input.name, input.grid.has_value());
    require_sky(reference.string(), is_fits(reference));
    const FitsPlane plane = read_fits(reference, settings.hdu, settings.plane, progress);
    require_sky(reference.string(), plane.sky.has_value());
    put_on_grid(input, grid_of(*plane.sky), plane.width, plane.height);
}

// The stretch that was still to come, as the texture of a scene would have had it:
// the result is linear light.
void apply_stretch(Image& image, TextureSettings::Stretch stretch, double softening) {
    if (stretch == TextureSettings::Stretch::linear) return;
    const StretchCurve curve({0.0, 1.0}, stretch, softening);
    change_pixels(image, [&](float* p) {
        for (int c = 0; c < 3; ++c) p[c] = float(real::srgb_to_linear(curve(double(p[c]))));
    });
}

// The stages, on a picture that may have been halved, as often as its masks are then.
struct Preparation {
    PrepareInput input;
    const TextureSettings& settings;
    const Progress& progress;
    const PrepareParams& params = settings.prepare;
    Image full = {input.image.width, input.image.height, 4, {}};  // of the size of masks; without pixels
    int halvings = 0;

    void halve_to(std::int64_t most_px) {
        while (most_px > 0 && std::max(input.image.width, input.image.height) > most_px) {
            input.image = halved(input.image);
            ++halvings;
        }
        if (halvings > 0) input.empty = empty_pixels(input.image);
    }

    PreparedPicture run() {
        PreparedPicture result;
        if (!params.fill.empty())
            fill(input.image, bright_pixels(mask("fill", params.fill)), FillKind::texture, progress);
        if (params.stars == PrepareParams::Stars::remove) take_stars_away(result);
        if (params.background != PrepareParams::Background::keep) {
            result.sky = fit_sky(input.image, int(params.background) - 1);
            subtract_sky(input.image, *result.sky);
        }
        if (params.lupton)
            apply_lupton(input.image, {params.q, params.lupton_stretch});
        else
            apply_stretch(input.image, input.stretch, settings.softening);
        cut();
        result.image = std::move(input.image);
        result.credit = std::move(input.credit);
        return result;
    }

    static PixelMask empty_pixels(const Image& image) {
        PixelMask empty = make_mask(image.width, image.height);
        for (std::size_t i = 0; i < empty.pixels.size(); ++i)
            empty.pixels[i] = !(image.pixels[4 * i + 3] > 0.5f);
        return empty;
    }

    Image mask(const char* key, const fs::path& file) const {
        Image picture = read_mask_like(full, std::string("prepare.") + key, file);
        for (int i = 0; i < halvings; ++i) picture = halved(picture);
        return picture;
    }

    void take_stars_away(PreparedPicture& result) {
        claim_memory(star_removal_bytes(input.image), "star removal");
        StarRemoval removal = remove_stars(
            input.image, {params.threshold, params.saturation.value_or(input.saturation)}, progress);
        input.image = std::move(removal.starless);
        result.stars = std::move(removal.stars);
    }

    void cut() {
        Image& image = input.image;
        if (params.ellipse) {
            const glm::dvec4 e = *params.ellipse / std::exp2(halvings);
            cut_ellipse(image, {{e.x, e.y}, {e.z, e.w}, -params.turn, params.feather});
        }
        if (!params.mask.empty()) cut_with_mask(image, mask("mask", params.mask));
        if (params.alpha) alpha_from_luminance(image, params.alpha->x, params.alpha->y);
        for (std::size_t i = 0; i < input.empty.pixels.size(); ++i)
            if (input.empty.pixels[i]) std::fill_n(image.pixels.data() + 4 * i, 4, 0.0f);
    }
};

}  // namespace

PreparedPicture prepare_picture(const std::vector<fs::path>& files, const TextureSettings& settings,
                                const Progress& progress, std::int64_t most_px) {
    PrepareInput input = files.size() == 1
                             ? read_prepare_input(files[0], settings, progress)
                             : read_three_filters({files[0], files[1], files[2]}, settings, progress);
    if (!settings.prepare.align.empty()) align_to(settings.prepare.align, settings, input, progress);
    Preparation preparation{std::move(input), settings, progress};
    preparation.halve_to(most_px);
    return preparation.run();
}

PreparedPicture make_prepared(const std::vector<fs::path>& files, const TextureSettings& settings,
                              const Progress& progress) {
    return prepare_picture(files, settings, progress);
}

Image without_plain_alpha(Image image) {
    const std::int64_t pixels = image.width * image.height;
    for (std::int64_t i = 0; i < pixels; ++i)
        if (image.pixels[4 * i + 3] != 1.0f) return image;
    Image colors = make_image(image.width, image.height, 3);
    for (std::int64_t i = 0; i < 3 * pixels; ++i) colors.pixels[i] = image.pixels[i / 3 * 4 + i % 3];
    return colors;
}

Image read_mask_like(const Image& like, const std::string& option, const fs::path& file) {
    Image mask = load_raw_image(file);
    if (mask.width != like.width || mask.height != like.height)
        bad_input(option, file.string(), fmt::format("{}x{} px like the picture", like.width, like.height),
                  fmt::format("{}x{} px", mask.width, mask.height));
    return mask;
}

PixelMask bright_pixels(const Image& mask) {
    PixelMask bright = make_mask(mask.width, mask.height);
    for (std::size_t i = 0; i < bright.pixels.size(); ++i) bright.pixels[i] = mask.pixels[3 * i] > 0.0f;
    return bright;
}

}  // namespace astrosplat

// The stages of a picture's preparation. FITS keeps its values until stars are taken away: a stretch would
// change their profiles and cut them off.
#include "source/prepared_picture.h"

#include <fmt/format.h>

#include "core/color.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/text.h"
#include "image/blur.h"
#include "image/channels.h"
#include "prepare/star_removal.h"
#include "source/fits.h"
#include "source/picture.h"
#include "source/sky_grid.h"
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
    FitsSky sky;
    std::string name;  // of its file
};

constexpr double saturated_integer = 0.98;  // of linear light, in pictures of integers

PrepareInput input_of(const FitsPlane& plane, const Limits& limits, const TextureSettings& settings,
                      const fs::path& file) {
    PrepareInput input;
    input.image = make_image(plane.width, plane.height, 4);
    input.empty = make_mask(plane.width, plane.height);
    const auto channels = std::size_t(plane.channels);
    for (std::size_t i = 0; i < input.empty.pixels.size(); ++i) {
        float* const p = input.image.pixels.data() + 4 * i;
        p[3] = 1.0f;
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = plane.values[channels * i + c % channels];
            p[c] = float((value - limits.black) / (limits.white - limits.black));
            if (!std::isfinite(p[c])) p[3] = 0.0f;
        }
        input.empty.pixels[i] = p[3] == 0.0f;
        if (p[3] == 0.0f) std::fill_n(p, 3, 0.0f);
    }
    input.stretch = stretch_of(settings);
    if (const auto colors = followed_colors(plane, input.stretch, file))
        decode_colors(input.image, *colors, false);
    input.saturation = std::numeric_limits<double>::infinity();
    input.credit = plane.credit;
    input.sky = plane.sky;
    return input;
}

PrepareInput input_of(Stored stored, const TextureSettings& settings) {
    PrepareInput input;
    const bool integers = stored.picture.max_integer > 0.0;
    input.saturation = integers ? saturated_integer : std::numeric_limits<double>::infinity();
    input.credit = stored.picture.credit;
    input.image = linear_image(std::move(stored), settings.colorspace);
    input.empty = make_mask(input.image.width, input.image.height);
    for (std::size_t i = 0; i < input.empty.pixels.size(); ++i) {
        float* const p = input.image.pixels.data() + 4 * i;
        for (float* c = p; c < p + 3; ++c) {
            if (!(std::isinf(*c) && *c > 0.0f)) continue;
            *c = half_max;
            input.saturation = std::min(input.saturation, double(half_max));
        }
        const bool finite = std::all_of(p, p + 4, [](float value) { return std::isfinite(value); });
        input.empty.pixels[i] = finite && p[3] > 0.0f ? 0 : 1;
        if (!finite) std::fill_n(p, 4, 0.0f);
    }
    return input;
}

// Pixels as a picture of 0 and 1, so that they can be put on a grid as well.
Image as_picture(const PixelMask& mask) {
    Image image = make_image(mask.width, mask.height, 1);
    std::copy(mask.pixels.begin(), mask.pixels.end(), image.pixels.begin());
    return image;
}

// How the sky lies on a picture that has to tell it. Throws InputError.
const SkyGrid& required_grid(const std::string& name, const FitsSky& sky) {
    if (!sky.grid)
        bad_input(name, "a FITS picture whose header tells the sky",
                  sky.unfollowed.empty() ? "none" : sky.unfollowed + ", which is not followed");
    return *sky.grid;
}

// Rows of a picture `height` high, on a picture of another grid.
RowPlaces rows_on(const SkyGrid& own, std::int64_t own_height, const SkyGrid& target, std::int64_t height) {
    return [=, &own, &target](std::int64_t row, std::span<glm::dvec2> places) {
        for (std::size_t x = 0; x < places.size(); ++x) places[x] = {double(x) + 1.0, double(height - row)};
        target.to_sky(places);
        own.to_pixels(places);
        for (glm::dvec2& place : places) place = {place.x - 0.5, double(own_height) + 0.5 - place.y};
    };
}

// How many pixels of `own` one of `target` is wide, on the same steps as places.
double texels_of(const SkyGrid& own, const SkyGrid& target) {
    const auto area = [](const SkyGrid& grid) {
        const auto& [a, b, c, d] = grid.degrees_per_px();
        return std::fabs(a * d - b * c);
    };
    return std::floor(std::sqrt(area(target) / area(own)) * 4096.0 + 0.5) / 4096.0;
}

// On the grid of `reference`, of width x height pixels; what was mostly empty stays so. Throws InputError
// where nothing of the picture is there.
void put_on_grid(PrepareInput& input, const SkyGrid& grid, std::int64_t width, std::int64_t height,
                 const std::string& reference) {
    const SkyGrid& own = required_grid(input.name, input.sky);
    const RowPlaces places = rows_on(own, input.image.height, grid, height);
    const double texels = texels_of(own, grid);
    PixelMask outside;
    const Image emptiness = regridded(as_picture(input.empty), places, texels, width, height, outside);
    if (std::ranges::find(outside.pixels, 0) == outside.pixels.end())
        bad_input(input.name, fmt::format("a part of the sky that {} shows", reference),
                  fmt::format("none: they are about {:.4g} and {:.4g} degrees", own.reference_deg().x,
                              own.reference_deg().y));
    input.image = regridded(input.image, places, texels, width, height, outside);
    for (std::size_t i = 0; i < outside.pixels.size(); ++i)
        if (emptiness.pixels[i] > 0.5f) outside.pixels[i] = 1;
    input.empty = std::move(outside);
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
    PrepareInput input;
    if (is_fits(file)) {
        const FitsPlane plane = read_fits(file, settings.hdu, settings.plane, progress);
        input = input_of(plane, choose_limits(value_range(plane.values), settings, file.string()), settings,
                         file);
    } else {
        input = input_of(read_stored(file, settings, progress), settings);
    }
    fill(input.image, input.empty, FillKind::membrane, progress);
    input.name = file.string();
    return input;
}

// What the picture of the stars has more than none, added as it is stored: so the two were parted.
void add_values(const FitsPlane& starless, FitsPlane& stars) {
    for (std::size_t i = 0; i < stars.values.size(); ++i) stars.values[i] += starless.values[i];
}
void add_values(const Image& starless, Image& stars) {
    for (std::size_t i = 0; i < stars.pixels.size(); ++i)
        if (i % std::size_t(stars.channels) < 3) stars.pixels[i] += starless.pixels[i];
}

// A picture that two files make: their sum, and in `starless` what it is without stars. Throws InputError
// where they do not fit together, Cancelled.
PrepareInput read_pair(const fs::path& file, const TextureSettings& settings, PrepareInput& starless,
                       const Progress& progress) {
    const fs::path& other = settings.prepare.starless;
    const auto require_same = [&](const auto& stars, const auto& sky) {
        if (stars.width != sky.width || stars.height != sky.height || stars.channels != sky.channels)
            bad_input(other,
                      fmt::format("{}x{} px of {} channels like {}", stars.width, stars.height,
                                  stars.channels, file.string()),
                      fmt::format("{}x{} px of {}", sky.width, sky.height, sky.channels));
    };
    if (std::error_code none; fs::equivalent(file, other, none))
        bad_input(other, "another picture than the one of the stars", "the same");
    PrepareInput whole;
    if (is_fits(file) && is_fits(other)) {
        FitsPlane sum = read_fits(file, settings.hdu, settings.plane, progress);
        const FitsPlane sky = read_fits(other, settings.hdu, settings.plane, progress);
        require_same(sum, sky);
        add_values(sky, sum);
        const Limits limits = choose_limits(value_range(sum.values), settings, file.string());
        whole = input_of(sum, limits, settings, file);
        starless = input_of(sky, limits, settings, file);
    } else {
        if (is_fits(file) || is_fits(other))
            bad_input(other, fmt::format("a file of the kind of {}", file.string()), "another");
        Stored sum = read_stored(file, settings, progress), sky = read_stored(other, settings, progress);
        require_same(sum.picture.image, sky.picture.image);
        add_values(sky.picture.image, sum.picture.image);
        whole = input_of(std::move(sum), settings);
        starless = input_of(std::move(sky), settings);
    }
    for (PrepareInput* const input : {&whole, &starless}) {
        fill(input->image, input->empty, FillKind::membrane, progress);
        input->name = file.string();
    }
    return whole;
}

// Three filters as red, green and blue. Green and blue are sampled on red's grid where headers tell the sky,
// which all or none have to do; without it they have one size. Throws InputError, Cancelled.
PrepareInput read_three_filters(const std::array<fs::path, 3>& files, const TextureSettings& settings,
                                const Progress& progress) {
    const PrepareInput first = read_prepare_input(files[0], settings, progress);
    PrepareInput rgb = first;
    put_channel(first, 0, rgb);
    for (std::size_t c = 1; c < 3; ++c) {
        PrepareInput filter = read_prepare_input(files[c], settings, progress);
        const bool same_size =
            filter.image.width == rgb.image.width && filter.image.height == rgb.image.height;
        const auto says = [](const PrepareInput& input) {
            return input.sky.grid || !input.sky.unfollowed.empty();
        };
        if (!same_size && !(says(filter) && says(first)))
            bad_input(files[c],
                      fmt::format("{}x{} px like {}, or where the sky is on both", rgb.image.width,
                                  rgb.image.height, files[0].string()),
                      fmt::format("{}x{} px", filter.image.width, filter.image.height));
        if (says(filter) || says(first)) {
            const SkyGrid &grid = required_grid(first.name, first.sky),
                          &own = required_grid(filter.name, filter.sky);
            if (!same_size || !(own == grid))
                put_on_grid(filter, grid, rgb.image.width, rgb.image.height, first.name);
        }
        put_channel(filter, int(c), rgb);
        rgb.credit = joined_once({rgb.credit, filter.credit});
    }
    return rgb;
}

// Puts a picture on the grid that the FITS picture `reference` has on the sky, with its size. Throws
// InputError where the sky is not known on both, Cancelled.
void align_to(const fs::path& reference, const TextureSettings& settings, PrepareInput& input,
              const Progress& progress) {
    required_grid(input.name, input.sky);
    if (!is_fits(reference)) required_grid(reference.string(), {});
    const FitsPlane plane = open_fits_rows(reference, settings.hdu, settings.plane, progress).plane;
    put_on_grid(input, required_grid(reference.string(), plane.sky), plane.width, plane.height,
                reference.string());
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
    Image starless = {};  // where another file shows it
    const PrepareParams& params = settings.prepare;
    Image full = {input.image.width, input.image.height, 4, {}};  // of the size of masks; without pixels
    int halvings = 0;

    void halve_to(std::int64_t most_px) {
        while (most_px > 0 && std::max(input.image.width, input.image.height) > most_px) {
            input.image = halved(input.image);
            if (starless.width > 0) starless = halved(starless);
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
        warn_of_nothing(input.image, std::ranges::find(input.empty.pixels, 0) == input.empty.pixels.end(),
                        input.name);
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
        if (starless.width > 0)  // what it has more are the stars alone
            for_each_pixel(input.image, [&](std::int64_t x, std::int64_t y) {
                for (int c = 0; c < 3; ++c) input.image.at(x, y)[c] -= starless.at(x, y)[c];
            });
        StarRemoval removal = remove_stars(
            input.image, {params.threshold, params.saturation.value_or(input.saturation)}, progress);
        input.image = starless.width > 0 ? std::move(starless) : std::move(removal.starless);
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
    const StoppableLoops stops(progress);
    const bool pair = !settings.prepare.starless.empty();
    if (pair && files.size() != 1)
        throw InputError(fmt::format("starless: expected one picture, of the stars, found {}", files.size()));
    PrepareInput starless;
    PrepareInput input = pair ? read_pair(files[0], settings, starless, progress)
                         : files.size() == 1
                             ? read_prepare_input(files[0], settings, progress)
                             : read_three_filters({files[0], files[1], files[2]}, settings, progress);
    if (!settings.prepare.align.empty()) {
        if (pair) align_to(settings.prepare.align, settings, starless, progress);
        align_to(settings.prepare.align, settings, input, progress);
    }
    Preparation preparation{std::move(input), settings, progress, std::move(starless.image)};
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
    Image mask = load_mask(file);
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

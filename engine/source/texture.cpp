// From stored values to linear, premultiplied colour: stretch (FITS), colour space, alpha, in this order.
#include "source/texture.h"

#include <fmt/format.h>

#include <atomic>

#include "core/color.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/text.h"
#include "image/blur.h"
#include "image/channels.h"
#include "prepare/stages.h"
#include "source/fits.h"
#include "source/picture.h"

namespace astrosplat {
namespace {

using Settings = TextureSettings;

constexpr std::int64_t rows_per_chunk = 32;

// Red of the first, green of the second, blue of the third.
StoredRows combine(const std::vector<fs::path>& files,
                   const std::function<StoredRows(const fs::path&)>& open) {
    std::vector<ImageRows> channels;
    StoredRows rgb;
    for (const fs::path& file : files) {
        StoredRows one = open(file);
        channels.push_back(std::move(one.rows));
        const ImageRows &first = channels.front(), &here = channels.back();
        if (here.width != first.width || here.height != first.height)
            bad_input(file, fmt::format("{}x{} px like {}", first.width, first.height, files[0].string()),
                      fmt::format("{}x{} px", here.width, here.height));
        if (channels.size() == 1)
            rgb.stored = std::move(one.stored);
        else
            rgb.stored.picture.summary += "; " + one.stored.picture.summary;
    }
    Picture& picture = rgb.stored.picture;
    picture.image.channels = 3;
    picture.max_integer = 0.0;
    picture.associated = false;
    rgb.rows = joined_channels({channels[0], channels[1], channels[2]});
    return rgb;
}

// NaN anywhere makes a pixel empty (returns false); light is not negative and not infinite.
bool make_sane(float* p, int channels) {
    for (int c = 0; c < channels; ++c)
        if (std::isnan(p[c])) return false;
    for (int c = 0; c < 3; ++c) p[c] = std::isinf(p[c]) && p[c] > 0.0f ? half_max : std::max(p[c], 0.0f);
    return true;
}

bool is_made_of_light(Settings::Alpha alpha) {
    return alpha == Settings::Alpha::max || alpha == Settings::Alpha::luminance;
}

// Whether the stored colours are to be taken as already multiplied by the alpha chosen.
bool colors_are_premultiplied(const Picture& picture, const Settings& settings, Settings::Alpha alpha) {
    if (settings.unpremultiply != Settings::Unpremultiply::automatic)
        return settings.unpremultiply == Settings::Unpremultiply::yes;
    if (alpha == Settings::Alpha::file) return picture.associated;
    return is_made_of_light(alpha);
}

float alpha_of(const float* p, Settings::Alpha alpha) {
    if (alpha == Settings::Alpha::file) return p[3];
    if (alpha == Settings::Alpha::luminance) return luminance(p[0], p[1], p[2]);
    return alpha == Settings::Alpha::max ? std::max({p[0], p[1], p[2]}) : 1.0f;
}

Settings::Alpha choose_alpha(const fs::path& file, const Picture& picture, Settings::Alpha wanted) {
    if (wanted == Settings::Alpha::automatic)
        return picture.has_alpha() ? Settings::Alpha::file : Settings::Alpha::max;
    if (wanted == Settings::Alpha::file && !picture.has_alpha())
        bad_input(file, "an alpha channel (alpha = \"file\")", "none");
    return wanted;
}

// Linear stored colours -> premultiplied RGBA. Returns how many pixels have no value: they are empty.
std::int64_t apply_alpha(const Image& stored, Settings::Alpha alpha, bool premultiplied, float* rgba) {
    std::atomic<std::int64_t> empty{0};
    parallel_chunks(stored.height, rows_per_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        std::int64_t nans = 0;
        for (std::int64_t i = begin * stored.width; i < end * stored.width; ++i) {
            float p[4] = {0.0f, 0.0f, 0.0f, 1.0f};
            std::copy_n(stored.pixels.data() + i * stored.channels, stored.channels, p);
            float* const to = rgba + i * 4;
            if (!make_sane(p, stored.channels)) {
                ++nans;
                std::fill_n(to, 4, 0.0f);
                continue;
            }
            const float a = std::clamp(alpha_of(p, alpha), 0.0f, 1.0f);
            for (int c = 0; c < 3; ++c) to[c] = premultiplied ? p[c] : p[c] * a;
            to[3] = a;
        }
        empty.fetch_add(nans, std::memory_order_relaxed);
    });
    return empty;
}

// The picture as premultiplied RGBA of linear light, on `size`, which is no larger than it is. Strip by
// strip: only what comes out is held as a whole. `undefined`: none of its pixels has a value.
Image linear_picture(const StoredRows& from, const Settings& settings, Settings::Alpha alpha,
                     bool premultiplied, const ImageSize& size, bool& undefined) {
    std::int64_t empty = 0;
    const ImageRows rgba{
        from.rows.width, from.rows.height, 4, [&](std::int64_t begin, std::int64_t end, float* rows) {
            Stored strip = from.stored;
            strip.picture.image = unfilled_image(from.rows.width, end - begin, from.rows.channels);
            from.rows.read(begin, end, strip.picture.image.pixels.data());
            make_linear(strip, settings.colorspace, premultiplied);
            empty += apply_alpha(strip.picture.image, alpha, premultiplied, rows);
        }};
    const bool whole = size.width == rgba.width && size.height == rgba.height;
    Image image = whole ? read_whole(rgba) : reduced_by_area(rgba, size.width, size.height);
    undefined = empty == rgba.width * rgba.height;
    if (empty > 0) log_detail(fmt::format("{} pixels without a value (NaN) are empty", empty));
    return image;
}

// A picture after reading.
ImageSize size_to_read(const ImageRows& rows, std::int64_t most_texels) {
    if (most_texels <= 0 || rows.width * rows.height <= texels_read_whole) return {rows.width, rows.height};
    return size_of_area(rows.width, rows.height, double(most_texels), 1.0);
}

// Alpha that was made of the light follows what became of it; a file's alpha stays.
void retake_alpha(Image& image, Settings::Alpha alpha) {
    if (is_made_of_light(alpha))
        change_pixels(image, [&](float* p) { p[3] = std::clamp(alpha_of(p, alpha), 0.0f, 1.0f); });
}

// The map as a grey picture, under the alpha rules of a picture from a file.
void show_derived(Image& image, Derived kind, Settings::Alpha alpha, bool premultiplied) {
    const Image map = derived_picture(image, kind);
    const bool made = is_made_of_light(alpha);
    for_each_pixel(image, [&](std::int64_t x, std::int64_t y) {
        float* const p = image.at(x, y);
        if (made) p[3] = *map.at(x, y);
        std::fill_n(p, 3, made && premultiplied ? *map.at(x, y) : *map.at(x, y) * p[3]);
    });
}

// Leaves what a blur takes away; where that is negative, nothing.
void keep_detail(Image& image, const Image& blurred) {
    for_each_pixel(image, [&](std::int64_t x, std::int64_t y) {
        for (int c = 0; c < 3; ++c)
            image.at(x, y)[c] = std::max(0.0f, image.at(x, y)[c] - blurred.at(x, y)[c]);
    });
}

// Masks look at the picture as it was; what it shows is derived, then smoothed, then reduced to detail.
void rework(Texture& texture, const Settings& settings, Settings::Alpha alpha) {
    Image& image = texture.image;
    if (!settings.mask.empty()) texture.mask = mask_weights(image, settings.mask);
    if (settings.derive != Derived::none) show_derived(image, settings.derive, alpha, texture.divided);
    if (settings.smooth == 0.0 && settings.detail == 0.0) return;
    const auto width = double(image.width);
    Image blurred;
    if (settings.detail > 0.0) blurred = gaussian_blur(image, settings.detail * width);
    if (settings.smooth > 0.0) image = gaussian_blur(image, settings.smooth * width);
    if (settings.detail > 0.0) keep_detail(image, blurred);
    if (texture.divided) retake_alpha(image, alpha);
}

// By Settings::Alpha.
constexpr const char* alpha_names[] = {"", "the file's alpha", "alpha from luminance",
                                       "alpha from the brightest channel", "no alpha"};

std::string joined_names(const std::vector<fs::path>& files) {
    std::string names = files[0].string();
    for (std::size_t i = 1; i < files.size(); ++i) names += ", " + files[i].string();
    return names;
}

// A prepared picture as if it came from a file of linear light.
Stored as_stored(PreparedPicture prepared) {
    Stored stored;
    stored.picture.image = without_plain_alpha(std::move(prepared.image));
    stored.picture.associated = stored.picture.has_alpha();
    stored.picture.credit = std::move(prepared.credit);
    stored.picture.summary =
        fmt::format("{}x{} px, prepared", stored.picture.image.width, stored.picture.image.height);
    return stored;
}

// How the file is read was seen to before: what comes out is linear, and premultiplied.
Settings settings_after_preparation(Settings settings) {
    settings.colorspace = Settings::Colorspace::linear;
    settings.unpremultiply = Settings::Unpremultiply::automatic;
    return settings;
}

}  // namespace

Texture load_texture(const std::vector<fs::path>& files, const TextureSettings& asked,
                     TextureSettings::Wrap default_wrap, const Progress& progress,
                     const PictureReaders& readers) {
    if (files.size() != 1 && files.size() != 3)
        throw InputError(
            fmt::format("expected one texture, or three for red, green and blue, found {}", files.size()));
    const bool is_prepared = prepares(asked.prepare);
    const TextureSettings settings = is_prepared ? settings_after_preparation(asked) : asked;
    const auto open = [&](const fs::path& file) {
        if (!readers.raw) return open_stored(file, settings, progress);
        return rows_of(stored_of(readers.raw(file, settings.hdu, settings.plane, progress), settings, file));
    };
    StoredRows rows = is_prepared         ? rows_of(as_stored(readers.prepared(files, asked, progress)))
                      : files.size() == 1 ? open(files[0])
                                          : combine(files, open);
    const Stored stored = rows.stored;
    const Settings::Alpha alpha = choose_alpha(files[0], stored.picture, settings.alpha);
    const bool premultiplied = colors_are_premultiplied(stored.picture, settings, alpha);
    Texture texture;
    const ImageSize size = size_to_read(rows.rows, is_prepared ? 0 : readers.most_texels);
    if (size.width < rows.rows.width || size.height < rows.rows.height) {
        texture.file_width = rows.rows.width;
        texture.file_height = rows.rows.height;
    }
    claim_memory(std::int64_t(std::min(16.0 * double(size.width) * double(size.height), 9e18)),
                 fmt::format("reading {}", files[0].string()));
    bool undefined = false;
    texture.image = linear_picture(rows, settings, alpha, premultiplied, size, undefined);
    rows = {};
    if (!is_prepared) warn_of_nothing(texture.image, undefined, joined_names(files));
    texture.filter = settings.filter;
    texture.wrap = settings.wrap == Settings::Wrap::automatic ? default_wrap : settings.wrap;
    texture.divided = premultiplied;
    texture.alpha_from_light = settings.alpha == Settings::Alpha::automatic && alpha == Settings::Alpha::max;
    rework(texture, settings, alpha);
    texture.credit = stored.picture.credit;
    texture.summary = fmt::format("{}, {}, {}", stored.picture.summary,
                                  colors_of(stored, settings.colorspace), alpha_names[int(alpha)]);
    return texture;
}

void warn_of_nothing(const Image& image, bool undefined, const std::string& name) {
    constexpr float least = 0.5f / 255.0f / 12.92f;  // less is 0 of 8 bits of sRGB
    float most = 0.0f;
    for (std::size_t i = 0; !(most >= least) && i < image.pixels.size(); i += 4)
        for (std::size_t c = i; c < i + 3; ++c) most = std::max(most, image.pixels[c]);
    const std::string reason = undefined     ? "every pixel is undefined (NaN)"
                               : most > 0.0f ? fmt::format("no light is more than {:.2g} of white", most)
                                             : "all pixels are equal, black or transparent";
    if (!(most >= least)) log_warning(fmt::format("{}: nothing to see: {}", name, reason));
}

void fill_values(std::span<Image> pictures, int border, const fs::path& file, const Progress& progress) {
    std::atomic<std::int64_t> absent{0}, infinite{0};
    for (Image& picture : pictures) {
        PixelMask holes = make_mask(picture.width - 2 * border, picture.height - 2 * border);
        std::atomic<bool> has_holes{false};
        for_each_pixel({holes.width, holes.height, 0, {}}, [&](std::int64_t x, std::int64_t y) {
            float* const p = picture.at(x + border, y + border);
            if (std::any_of(p, p + picture.channels, [](float v) { return std::isinf(v); })) ++infinite;
            if (make_sane(p, picture.channels)) return;
            holes.at(x, y) = 1;
            has_holes = true;
            ++absent;
        });
        if (!has_holes) continue;
        claim_memory(std::int64_t{20} * picture.channels * holes.width * holes.height,
                     fmt::format("filling {}", file.string()));
        Image inner = unfilled_image(holes.width, holes.height, picture.channels);
        const auto copy_rows = [&](Image& to, std::int64_t to_border, const Image& from,
                                   std::int64_t from_border) {
            for (std::int64_t y = 0; y < holes.height; ++y)
                std::copy_n(from.at(from_border, y + from_border), holes.width * picture.channels,
                            to.at(to_border, y + to_border));
        };
        copy_rows(inner, 0, picture, border);
        fill(inner, holes, FillKind::membrane, progress);
        copy_rows(picture, border, inner, 0);
    }
    std::vector<std::string> said;
    if (absent > 0)
        said.push_back(fmt::format("{} without a value (NaN) {} filled from around", counted(absent, "pixel"),
                                   absent == 1 ? "is" : "are"));
    if (infinite > 0)
        said.push_back(fmt::format("{} {} as {:.0f}", counted(infinite, "infinite pixel"),
                                   infinite == 1 ? "counts" : "count", half_max));
    if (!said.empty()) log_warning(fmt::format("{}: {}", file.string(), fmt::join(said, ", ")));
}

void apply_mask(Texture& texture) {
    if (texture.mask.pixels.empty()) return;
    const std::int64_t pixels = texture.image.width * texture.image.height;
    parallel_each(pixels, 1 << 16, [&](std::int64_t i) {
        for (int c = 0; c < 4; ++c) texture.image.pixels[4 * i + c] *= texture.mask.pixels[i];
    });
    texture.mask = {};
}

Image load_linear_image(const fs::path& file, const Progress& progress) {
    return linear_image(read_stored(file, Settings{}, progress), {});
}

// Strip by strip: only what comes out is held as a whole.
std::vector<Image> load_environment_pictures(const fs::path& file, int border, const Progress& progress) {
    const StoredRows from = open_stored(file, Settings{}, progress);
    const bool alpha = from.stored.picture.has_alpha();
    const bool premultiplied = alpha && from.stored.picture.associated;
    const std::int64_t width = from.rows.width;
    const std::int64_t height = from.stored.picture.cube ? width : from.rows.height;  // of a picture
    const double texels = double(width + 2 * border) * double(height + 2 * border);
    const std::size_t count = from.stored.picture.cube ? 6 : 1;
    claim_memory(std::int64_t(std::min(16.0 * double(count) * texels, 9e18)),
                 fmt::format("{} and its mip levels", file.string()));
    std::vector<Image> pictures;
    for (std::size_t n = 0; n < count; ++n)
        pictures.push_back(unfilled_image(width + 2 * border, height + 2 * border, 3));
    constexpr std::int64_t strip_rows = 64;
    for (std::int64_t begin = 0, end = 0; begin < from.rows.height; begin = end) {
        end = std::min(from.rows.height, begin + strip_rows);
        Stored strip = from.stored;
        Image& image = strip.picture.image;
        image = unfilled_image(width, end - begin, from.rows.channels);
        from.rows.read(begin, end, image.pixels.data());
        make_linear(strip, {}, premultiplied);
        parallel_each(end - begin, rows_per_chunk / 4, [&](std::int64_t row) {
            const std::int64_t y = begin + row;
            float* to = pictures[y / height].at(border, y % height + border);
            for (std::int64_t x = 0; x < width; ++x, to += 3) {
                const float* const p = image.at(x, row);
                for (int c = 0; c < 3; ++c) to[c] = alpha && !premultiplied ? p[c] * p[3] : p[c];
            }
        });
    }
    fill_values(pictures, border, file, progress);
    return pictures;
}

}  // namespace astrosplat

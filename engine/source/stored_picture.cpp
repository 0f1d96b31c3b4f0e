#include "source/stored_picture.h"

#include <fmt/format.h>

#include "core/color.h"
#include "core/log.h"
#include "core/parallel.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

using Settings = TextureSettings;

// Facts about a plane's picture, known before its pixels.
Stored stored_without_pixels(const FitsPlane& plane, const Limits& limits, Settings::Stretch stretch,
                             const fs::path& file) {
    Stored stored;
    stored.display_values = stretch != Settings::Stretch::linear;
    stored.picture.credit = plane.credit;
    stored.picture.colors = followed_colors(plane, stretch, file);
    stored.picture.image = {plane.width, plane.height, 3, {}};
    stored.picture.summary =
        fmt::format("{}x{} px, HDU {}{}{}{}{}, {} stretch, black {:.6g}, white {:.6g}", plane.width,
                    plane.height, plane.hdu, plane.name.empty() ? "" : " ", plane.name,
                    plane.what.empty() ? "" : ", ", plane.what, name_of(stretch), limits.black, limits.white);
    return stored;
}

// Of one channel as r = g = b.
void stretch_values(std::span<const double> values, int channels, const StretchCurve& curve, float* rgb) {
    const std::size_t copies = channels == 1 ? 3 : 1;
    parallel_each(values.size(), 1 << 13,
                  [&](std::size_t i) { std::fill_n(rgb + copies * i, copies, float(curve(values[i]))); });
}

Stored stretched_plane(const FitsPlane& plane, const ValueRange& range, const Settings& settings,
                       const fs::path& file) {
    const Limits limits = choose_limits(range, settings, file.string());
    Stored stored = stored_without_pixels(plane, limits, stretch_of(settings), file);
    Image& image = stored.picture.image;
    image = unfilled_image(plane.width, plane.height, 3);
    stretch_values(plane.values, plane.channels,
                   StretchCurve(limits, stretch_of(settings), settings.softening), image.pixels.data());
    return stored;
}

// Hands out all values of a plane, some rows at a time.
void hand_out(const FitsRows& rows, const ValueTaker& take) {
    constexpr std::int64_t values_at_once = std::int64_t{1} << 22;
    const std::int64_t width = rows.plane.width * rows.plane.channels, height = rows.plane.height;
    const std::int64_t at_once = std::clamp<std::int64_t>(values_at_once / width, 1, height);
    Buffer<double> values(std::size_t(at_once * width));
    for (std::int64_t begin = 0; begin < height; begin += at_once) {
        const std::int64_t end = std::min(height, begin + at_once);
        rows.read(begin, end, values.data());
        take({values.data(), std::size_t((end - begin) * width)});
    }
}

StoredRows stretched_rows(const FitsRows& plane, const Settings& settings, const fs::path& file) {
    const bool limits_are_set = settings.black && settings.white;
    const ValueRange range =
        limits_are_set ? ValueRange{} : value_range([&](const ValueTaker& take) { hand_out(plane, take); });
    const Limits limits = choose_limits(range, settings, file.string());
    const StretchCurve curve(limits, stretch_of(settings), settings.softening);
    StoredRows result;
    result.stored = stored_without_pixels(plane.plane, limits, stretch_of(settings), file);
    result.rows = {plane.plane.width, plane.plane.height, 3,
                   [=](std::int64_t begin, std::int64_t end, float* rgb) {
                       const int channels = plane.plane.channels;
                       Buffer<double> values(std::size_t((end - begin) * plane.plane.width * channels));
                       plane.read(begin, end, values.data());
                       stretch_values(values, channels, curve, rgb);
                   }};
    return result;
}

// Linear light of each of an integer file's values.
std::vector<float> linear_table(double max_integer) {
    std::vector<float> table(std::size_t(max_integer) + 1);
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = float(real::srgb_to_linear(double(i) / max_integer));
    return table;
}

// Decodes the sRGB curve of colours that are not multiplied by alpha.
void linearise(Image& image, double max_integer) {
    static const std::vector<float> of_bytes = linear_table(255.0), of_words = linear_table(65535.0);
    const bool tabled = max_integer == 255.0 || max_integer == 65535.0;
    const std::vector<float>& table = max_integer == 255.0 ? of_bytes : of_words;
    const float scale = float(max_integer);
    change_pixels(image, [&](float* p) {
        const bool grey = p[0] == p[1] && p[1] == p[2];
        for (int c = 0; c < 3; ++c) {
            if (tabled)
                p[c] = table[std::size_t(std::clamp(p[c], 0.0f, 1.0f) * scale + 0.5f)];
            else
                p[c] = c > 0 && grey ? p[0] : float(real::srgb_to_linear(p[c]));
        }
    });
}

// Files with associated alpha and encoded colours multiplied the encoded values: undo that before decoding,
// redo it in linear light. (Dividing linear values instead darkens soft edges.)
void linearise_associated(Image& image) {
    change_pixels(image, [](float* p) {
        const float a = p[3];
        if (!(a > 0.0f)) return;
        for (int c = 0; c < 3; ++c) p[c] = a * float(real::srgb_to_linear(p[c] / a));
    });
}

}  // namespace

Settings::Stretch stretch_of(const Settings& settings) {
    return settings.stretch == Settings::Stretch::automatic ? Settings::Stretch::asinh : settings.stretch;
}

RawPicture read_raw(const fs::path& file, const std::string& hdu, std::optional<int> plane,
                    const Progress& progress) {
    RawPicture raw;
    if (is_fits(file)) {
        raw.fits = read_fits(file, hdu, plane, progress);
        raw.range = value_range(raw.fits->values);
    } else {
        raw.picture = read_picture(file, progress, hdu);
    }
    return raw;
}

std::shared_ptr<const ColorEncoding> followed_colors(const FitsPlane& plane, TextureSettings::Stretch stretch,
                                                     const fs::path& file) {
    if (stretch == TextureSettings::Stretch::linear) return plane.colors;
    if (plane.colors && !plane.colors->is_rec709(TransferCurve::Kind::srgb))
        log_warning(
            fmt::format("{}: its {} is not followed: the stretch makes colours of sRGB "
                        "(stretch = linear follows it)",
                        file.string(), plane.colors->name));
    return nullptr;
}

Stored stored_of(RawPicture raw, const Settings& settings, const fs::path& file) {
    if (raw.fits) return stretched_plane(*raw.fits, raw.range, settings, file);
    Stored stored;
    stored.picture = std::move(raw.picture);
    stored.display_values = stored.picture.max_integer > 0.0;
    return stored;
}

StoredRows rows_of(Stored stored) {
    StoredRows result;
    Image& image = stored.picture.image;
    const Image empty{image.width, image.height, image.channels, {}};
    result.rows = rows_of(std::exchange(image, empty));
    result.stored = std::move(stored);
    return result;
}

StoredRows open_stored(const fs::path& file, const Settings& settings, const Progress& progress,
                       std::int64_t most_held) {
    if (!is_fits(file)) {
        PictureRows picture = open_picture_rows(file, progress, settings.hdu);
        const bool integers = picture.picture.max_integer > 0.0;
        return {{std::move(picture.picture), integers}, std::move(picture.rows)};
    }
    FitsRows plane = open_fits_rows(file, settings.hdu, settings.plane, progress);
    if (plane.plane.width * plane.plane.height * plane.plane.channels > most_held)
        return stretched_rows(plane, settings, file);
    const FitsPlane whole = whole_plane(std::move(plane), file);
    return rows_of(stretched_plane(whole, value_range(whole.values), settings, file));
}

Stored read_stored(const fs::path& file, const Settings& settings, const Progress& progress) {
    return stored_of(read_raw(file, settings.hdu, settings.plane, progress), settings, file);
}

std::string colors_of(const Stored& stored, Settings::Colorspace colorspace) {
    using Kind = TransferCurve::Kind;
    const ColorEncoding* const own = stored.picture.colors.get();
    if (colorspace == Settings::Colorspace::srgb) return "sRGB";
    if (colorspace == Settings::Colorspace::linear) return "linear";
    if (!own) return stored.display_values ? "sRGB" : "linear";
    return own->is_rec709(Kind::srgb) ? "sRGB" : own->is_rec709(Kind::linear) ? "linear" : own->name;
}

void make_linear(Stored& stored, Settings::Colorspace colorspace, bool premultiplied) {
    const std::string colors = colors_of(stored, colorspace);
    const bool associated = premultiplied && stored.picture.associated;
    Image& image = stored.picture.image;
    if (colors == "linear") return;
    if (colors != "sRGB") return decode_colors(image, *stored.picture.colors, associated);
    if (associated)
        linearise_associated(image);
    else
        linearise(image, stored.picture.max_integer);
}

Image linear_image(Stored stored, Settings::Colorspace colorspace) {
    const bool alpha = stored.picture.has_alpha();
    const bool premultiplied = alpha && stored.picture.associated;
    make_linear(stored, colorspace, premultiplied);
    const Image& from = stored.picture.image;
    Image image = make_image(from.width, from.height, 4, 1.0f);
    for_each_pixel(image, [&](std::int64_t x, std::int64_t y) {
        const float* const p = from.at(x, y);
        float* const to = image.at(x, y);
        to[3] = alpha ? p[3] : 1.0f;
        for (int c = 0; c < 3; ++c) to[c] = alpha && !premultiplied ? p[c] * p[3] : p[c];
    });
    return image;
}

}  // namespace astrosplat

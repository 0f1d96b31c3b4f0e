// Channels, windows and orientation of what OpenImageIO reads.
#include <fmt/format.h>
// (This line keeps clang-format from sorting the two.)
#include "source/open_picture.h"

#include "core/color.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/text.h"
#include "image/channels.h"
#include "source/fits.h"
#include "source/object_metadata.h"
#include "source/picture.h"
#include "source/value_layout.h"

namespace astrosplat {
namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;

// Where r, g, b and alpha are among a file's channels.
struct Channels {
    std::array<int, 3> color{};
    int alpha = -1;
    bool luma_chroma = false;  // color is Y, RY, BY
    bool xyz = false;          // color is X, Y, Z of CIE
};

int find_channel(const ImageSpec& spec, const std::string& name) {
    for (int c = 0; c < spec.nchannels; ++c)
        if (OIIO::Strutil::iequals(spec.channel_name(c), name)) return c;
    return -1;
}

// Blender's layers have names before it, since 3.0 of a value; with an X beside it, Z is a place or a
// direction.
int depth_channel(const ImageSpec& spec) {
    const int z = find_channel(spec, "Z");
    if (z >= 0 && find_channel(spec, "X") < 0) return z;
    for (const char* const name : {"depth.Z", "depth.V", "depth"})
        for (int c = 0; c < spec.nchannels; ++c)
            if (OIIO::Strutil::iends_with(spec.channel_name(c), name)) return c;
    return -1;
}

using Trio = std::array<int, 3>;

Trio find_channels(const ImageSpec& spec, const std::array<std::string, 3>& names) {
    Trio found{};
    for (std::size_t i = 0; i < 3; ++i) found[i] = find_channel(spec, names[i]);
    return found;
}

Trio colors_of_layer(const ImageSpec& spec, const std::string& layer) {
    return find_channels(spec, {layer + ".R", layer + ".G", layer + ".B"});
}

bool is_complete(const Trio& channels) { return *std::ranges::min_element(channels) >= 0; }

// EXR's names before the dots of channels R, G and B.
std::vector<std::string> layers_of(const ImageSpec& spec) {
    std::vector<std::string> layers;
    for (const std::string& name : spec.channelnames)
        if (name.ends_with(".R") && is_complete(colors_of_layer(spec, name.substr(0, name.size() - 2))))
            layers.push_back(name.substr(0, name.size() - 2));
    return layers;
}

// `layer`: the name of one, or empty.
Channels choose_channels(const ImageSpec& spec, Wanted wanted, std::string layer) {
    Channels c;
    const int depth = depth_channel(spec);
    if (wanted == Wanted::depths && depth >= 0) {
        c.color = {depth, depth, depth};
        return c;
    }
    // OpenImageIO's GIF reader names a channel beyond the last one.
    const bool named = spec.alpha_channel >= 0 && spec.alpha_channel < spec.nchannels;
    c.alpha = named ? spec.alpha_channel : find_channel(spec, "A");
    const std::array sets{find_channels(spec, {"R", "G", "B"}), find_channels(spec, {"Y", "RY", "BY"}),
                          find_channels(spec, {"X", "Y", "Z"})};
    const auto plain = std::ranges::find_if(sets, is_complete) - sets.begin();
    const std::vector<std::string> layers = layers_of(spec);
    if (layer.empty() && plain == std::ssize(sets) && !layers.empty()) layer = layers[0];
    if (!layer.empty()) {
        c.color = colors_of_layer(spec, layer);
        c.alpha = find_channel(spec, layer + ".A");
        return c;
    }
    c.luma_chroma = plain == 1;
    c.xyz = plain == 2;
    if (plain < std::ssize(sets)) {
        c.color = sets[std::size_t(plain)];
        return c;
    }
    const int first = c.alpha == 0 && spec.nchannels > 1 ? 1 : 0;
    const bool three =
        spec.nchannels - first - (c.alpha > first ? 1 : 0) >= 3 && (c.alpha < first || c.alpha >= first + 3);
    c.color = three ? Trio{first, first + 1, first + 2} : Trio{first, first, first};
    return c;
}

void warn_of_other_channels(const fs::path& file, const ImageSpec& spec, const Channels& channels) {
    std::vector<std::string> taken, layers;
    for (int c = 0; c < spec.nchannels; ++c)
        if (c == channels.alpha || std::ranges::find(channels.color, c) != channels.color.end())
            taken.push_back(spec.channel_name(c));
    for (const std::string& layer : layers_of(spec))
        if (colors_of_layer(spec, layer) != channels.color) layers.push_back(layer);
    warn_of_channels(file, spec.nchannels - std::ssize(taken), fmt::format("{}", fmt::join(taken, ", ")),
                     layers.empty() ? "" : fmt::format(" (hdu = {} takes another)", alternatives(layers)));
}

// How many rows of a file are read at once: whole tiles and strips, of some 32 MiB.
std::int64_t band_rows(const ImageSpec& spec) {
    constexpr std::int64_t floats = std::int64_t{1} << 23, most_floats = 8 * floats;
    const std::int64_t row = std::int64_t{spec.width} * spec.nchannels;
    const std::int64_t strip = std::max(1, spec.get_int_attribute("tiff:RowsPerStrip", 1));
    const std::int64_t step = spec.tile_height > 0         ? spec.tile_height
                              : strip <= most_floats / row ? strip
                                                           : 1;
    return std::max<std::int64_t>(1, floats / row / step) * step;
}

// OpenEXR's cube maps are six faces one above the other; the display window that they come with is the first.
bool is_cube_map(const ImageSpec& spec) {
    return spec.get_string_attribute("textureformat") == "CubeFace Environment" &&
           spec.height == 6 * spec.width;
}

bool windows_meet(const ImageSpec& spec) {
    return spec.full_x < spec.x + spec.width && spec.x < spec.full_x + spec.full_width &&
           spec.full_y < spec.y + spec.height && spec.y < spec.full_y + spec.full_height;
}

// The window the picture shows, in the file's coordinates; the data window where the two do not meet.
Region display_window(const ImageSpec& spec) {
    if (is_cube_map(spec) || !windows_meet(spec)) return {spec.x, spec.y, spec.width, spec.height};
    return {spec.full_x, spec.full_y, spec.full_width, spec.full_height};
}

// A window may show much more than the file has pixels for, as that of a cropped frame does; but a few bytes
// of header must not cost minutes and all memory. 16384 x 16384 px is more than any frame.
void check_window(const fs::path& file, const ImageSpec& spec) {
    constexpr std::int64_t largest_frame_px = std::int64_t{1} << 28, most_times = 64;
    const Region window = display_window(spec);
    const std::int64_t stored_px = std::int64_t{spec.width} * spec.height;
    if (window.width <= std::max(largest_frame_px, most_times * stored_px) / window.height) return;
    bad_input(
        file, "display window",
        fmt::format("at most {} px for the {}x{} px that it has", largest_frame_px, spec.width, spec.height),
        fmt::format("{}x{} px", window.width, window.height));
}

void check_spec(const fs::path& file, const ImageSpec& spec) {
    if (spec.deep) fail_picture(file, "it holds deep samples");
    if (spec.depth > 1) fail_picture(file, "it is a volume");
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) fail_picture(file, "it has no pixels");
    check_window(file, spec);
    claim_memory(band_rows(spec) * spec.width * spec.nchannels * 4,
                 fmt::format("a band of {}", file.string()));
}

// The rows of a file, of which a band is held.
class Bands {
  public:
    Bands(fs::path file, std::unique_ptr<ImageInput> in, int part, Progress progress)
        : file_(std::move(file)),
          in_(std::move(in)),
          part_(part),
          spec_(in_->spec(part)),
          progress_(std::move(progress)),
          rows_(band_rows(spec_)) {}

    const ImageSpec& spec() const { return spec_; }
    std::int64_t begin() const { return begin_; }
    std::int64_t end() const { return begin_ + band_.height; }
    // A row of the band that is held, counted from the file's first one.
    const float* row(std::int64_t y) const { return band_.at(0, y - begin_); }

    // Takes the band with this row.
    void read(std::int64_t y) {
        progress_.check();
        begin_ = y / rows_ * rows_;
        band_ = {spec_.width, std::min<std::int64_t>(rows_, spec_.height - begin_), spec_.nchannels,
                 std::move(band_.pixels)};
        band_.pixels.resize(std::size_t(band_.width * band_.height * band_.channels));
        const QuietStderr quiet;
        if (!read_rows(spec_.y + int(begin_), spec_.y + int(end()))) fail_picture(file_, in_->geterror());
        progress_.at(double(end()) / spec_.height);
        progress_.check();
    }

  private:
    bool read_rows(int begin, int end) {
        if (spec_.tile_width == 0)
            return in_->read_scanlines(part_, 0, begin, end, spec_.z, 0, spec_.nchannels, OIIO::TypeFloat,
                                       band_.pixels.data());
        return in_->read_tiles(part_, 0, spec_.x, spec_.x + spec_.width, begin, end, spec_.z, spec_.z + 1, 0,
                               spec_.nchannels, OIIO::TypeFloat, band_.pixels.data());
    }

    fs::path file_;
    std::unique_ptr<ImageInput> in_;
    int part_;
    ImageSpec spec_;
    Progress progress_;
    std::int64_t rows_, begin_ = 0;
    Image band_;  // from row begin_ on
};

// OpenEXR's luminance/chroma: RY = (R - Y) / Y, BY = (B - Y) / Y, Y the luminance for Rec. 709 primaries.
void to_rgb(float* c) {
    const float y = c[0], r = (c[1] + 1.0f) * y, b = (c[2] + 1.0f) * y;
    const float g = (y - luminance(r, 0.0f, b)) / luminance(0.0f, 1.0f, 0.0f);
    c[0] = r;
    c[1] = g;
    c[2] = b;
}

// One row of the window from a row of the file.
void pick_channels(const float* from_row, const ImageSpec& spec, const Channels& channels,
                   const Region& window, float* to_row) {
    const int count = channels.alpha >= 0 ? 4 : 3;
    const std::int64_t shift = window.x - spec.x;
    std::fill_n(to_row, window.width * count, 0.0f);  // where the file has nothing
    for (std::int64_t x = std::max<std::int64_t>(0, -shift); x < std::min(window.width, spec.width - shift);
         ++x) {
        const float* const from = from_row + (x + shift) * spec.nchannels;
        float* const to = to_row + x * count;
        for (int c = 0; c < 3; ++c) to[c] = from[channels.color[c]];
        if (channels.luma_chroma) to_rgb(to);
        if (count == 4) to[3] = from[channels.alpha];
    }
}

// Rows of the picture as the file has it, not turned.
ImageRows rows_of_file(const std::shared_ptr<Bands>& bands, const Channels& channels) {
    const Region window = display_window(bands->spec());
    const int count = channels.alpha >= 0 ? 4 : 3;
    const auto read = [=](std::int64_t begin, std::int64_t end, float* rows) {
        const ImageSpec& spec = bands->spec();
        const std::int64_t row_floats = window.width * count, up = window.y - spec.y;
        const std::int64_t last = std::min<std::int64_t>(end + up, spec.height);
        for (std::int64_t y = begin; y < end; ++y)
            if (y + up < 0 || y + up >= last) std::fill_n(rows + (y - begin) * row_floats, row_floats, 0.0f);
        for (std::int64_t y = std::max<std::int64_t>(begin + up, 0); y < last;) {
            if (y < bands->begin() || y >= bands->end()) bands->read(y);
            const std::int64_t next = std::min(last, bands->end());
            parallel_each(next - y, 16, [&](std::int64_t i) {
                pick_channels(bands->row(y + i), spec, channels, window,
                              rows + (y + i - up - begin) * row_floats);
            });
            y = next;
        }
    };
    return {window.width, window.height, count, read};
}

Image all_rows(const ImageRows& rows, const fs::path& file) {
    const double bytes = 4.0 * rows.channels * double(rows.width) * double(rows.height);
    claim_memory(std::int64_t(std::min(bytes, 9e18)), fmt::format("reading {}", file.string()));
    Image image = unfilled_image(rows.width, rows.height, rows.channels);
    rows.read(0, rows.height, image.pixels.data());
    return image;
}

// The eight values of EXIF's and TIFF's tag Orientation, from 1: what has to be done to see the picture as it
// was meant.
constexpr std::array orientations = {
    "",
    "nothing",
    "mirrored left to right",
    "turned by 180 degrees",
    "mirrored top to bottom",
    "mirrored along its falling diagonal",
    "turned by 90 degrees clockwise",
    "mirrored along its rising diagonal",
    "turned by 90 degrees anticlockwise",
};

int orientation_of(const fs::path& file, const ImageSpec& spec) {
    const int orientation = spec.get_int_attribute("Orientation", 1);
    if (orientation >= 1 && orientation <= 8) return orientation;
    log_warning(fmt::format("{}: its orientation {} is none of 1 to 8 and is not followed", file.string(),
                            orientation));
    return 1;
}

// Pixels that are not square become more along their longer side, between them linear.
void make_square(const fs::path& file, const ImageSpec& spec, ImageRows& rows) {
    constexpr float most_times = 4.0f, same_within = 0.01f;
    const float aspect = spec.get_float_attribute("PixelAspectRatio", 1.0f);  // width / height
    if (std::fabs(aspect - 1.0f) <= same_within || is_cube_map(spec)) return;
    if (!(aspect >= 1.0f / most_times && aspect <= most_times))
        return log_warning(
            fmt::format("{}: its PixelAspectRatio {:g} is not followed; its pixels are taken as square",
                        file.string(), aspect));
    const bool wide = aspect > 1.0f;
    const std::int64_t side = wide ? rows.width : rows.height;
    const std::int64_t longer = std::llround(double(side) * double(wide ? aspect : 1.0f / aspect));
    const Image image = all_rows(rows, file);
    Image square = unfilled_image(wide ? longer : rows.width, wide ? rows.height : longer, rows.channels);
    for_each_pixel(square, [&](std::int64_t x, std::int64_t y) {
        const double place = (double(wide ? x : y) + 0.5) * double(side) / double(longer) - 0.5;
        const double at = std::clamp(place, 0.0, double(side - 1));
        const auto first = std::int64_t(at), next = std::min(first + 1, side - 1);
        const auto share = float(at - double(first));
        const float* const p = wide ? image.at(first, y) : image.at(x, first);
        const float* const q = wide ? image.at(next, y) : image.at(x, next);
        for (int c = 0; c < image.channels; ++c)
            square.at(x, y)[c] = share > 0.0f ? p[c] * (1.0f - share) + q[c] * share : p[c];
    });
    log_info(fmt::format("{}: read as {}x{} px, as its pixels are {:g} times as wide as high", file.string(),
                         square.width, square.height, aspect));
    rows = rows_of(std::move(square));
}

// change(value, channel) of each colour.
template <class Change>
void change_colors(ImageRows& rows, const Change& change) {
    rows.read = [=, width = rows.width * rows.channels, channels = rows.channels, read = rows.read](
                    std::int64_t begin, std::int64_t end, float* values) {
        read(begin, end, values);
        for (float* p = values; p < values + (end - begin) * width; p += channels)
            for (int c = 0; c < 3; ++c) p[c] = change(p[c], c);
    };
}

// OpenImageIO scales netpbm's integers to those of 8 or 16 bits, which are `most`, and rounds them down.
void undo_scaling(ImageRows& rows, double most, double largest) {
    if (largest != most)
        change_colors(rows, [=](float value, int) {
            return float(std::ceil(std::round(value * most) * largest / most) / largest);
        });
}

// OpenImageIO turns white that is 0 around in 8 bits only, and has nothing below 0. What a TIFF has beside
// grey, RGB, palettes, CMYK and YCbCr (TIFF 6.0, TIFF/EP and libtiff's LogLuv) it converts roughly or not.
void warn_of_values(const fs::path& file, const ImageSpec& spec) {
    const int meaning = spec.get_int_attribute("tiff:PhotometricInterpretation", 1);
    const auto warn = [&](std::string_view what) { log_warning(fmt::format("{}: {}", file.string(), what)); };
    if (meaning == 0 && spec.format.size() > 1)
        warn("that 0 is white (PhotometricInterpretation) is not followed: it is black");
    if (meaning == 32803 || meaning == 34892)
        warn(
            "that its values are a camera's (PhotometricInterpretation) is not followed: a mosaic stays "
            "grey");
    else if (meaning >= 8)
        warn("its CIELab or LogLuv colours (PhotometricInterpretation) are followed roughly; save it as RGB");
    if (spec.format.is_signed() && !spec.format.is_floating_point())
        warn("its whole numbers have a sign: those below 0 are black");
    if (!is_cube_map(spec) && !windows_meet(spec))
        warn("its display window, which has none of its pixels, is not followed");
}

// ---- several pictures in one file

bool has_colors(const ImageSpec& spec) { return is_complete(find_channels(spec, {"R", "G", "B"})); }

std::string part_name(const ImageSpec& spec) { return spec.get_string_attribute("oiio:subimagename"); }

std::vector<ImageSpec> parts_of(ImageInput& in) {
    constexpr int most_parts = 4096;
    const QuietStderr quiet;
    std::vector<ImageSpec> parts;
    for (int i = 0; i < most_parts && in.seek_subimage(i, 0); ++i) parts.push_back(in.spec(i));
    (void)in.geterror();
    return parts;
}

// Bit 0: of lower resolution than another one, bit 2: a mask (TIFF 6.0, NewSubfileType).
bool is_lesser_page(const ImageSpec& spec) {
    return (spec.get_int_attribute("tiff:subfiletype", 0) & 5) != 0;
}

bool is_blank_page(ImageInput& in, int page, const ImageSpec& spec) {
    if (spec.tile_width > 0) return false;
    const QuietStderr quiet;
    std::vector<float> row(std::size_t(spec.width) * std::size_t(spec.nchannels));
    for (int y = 0; y < spec.height; ++y) {
        if (!in.read_scanlines(page, 0, spec.y + y, spec.y + y + 1, spec.z, 0, spec.nchannels,
                               OIIO::TypeFloat, row.data())) {
            (void)in.geterror();
            return false;
        }
        for (std::size_t i = 0; i < row.size(); ++i)
            if (row[i] != row[i % std::size_t(spec.nchannels)]) return false;
    }
    return true;
}

int best_page(ImageInput& in, const std::vector<ImageSpec>& pages) {
    int best = -1;
    const auto area = [&](int page) { return std::int64_t{pages[page].width} * pages[page].height; };
    for (int i = 0; i < int(pages.size()); ++i) {
        if (best >= 0 && (is_lesser_page(pages[i]) || area(i) <= area(best))) continue;
        if (i + 1 < int(pages.size()) && (is_lesser_page(pages[i]) || is_blank_page(in, i, pages[i])))
            continue;
        best = i;
    }
    return std::max(best, 0);
}

// ImageJ stores channels as pages, and says so in the first one's description.
bool are_channels(const std::vector<ImageSpec>& pages) {
    const std::string text = pages[0].get_string_attribute("ImageDescription");
    return pages.size() == 3 && text.starts_with("ImageJ=") && text.find("channels=3") != std::string::npos &&
           std::ranges::all_of(pages, [&](const ImageSpec& page) {
               return page.nchannels == 1 && page.width == pages[0].width && page.height == pages[0].height;
           });
}

// The picture that is taken of those in a file: its number, or the first of three that are its channels.
struct PartChoice {
    int first = 0;
    bool three = false;
    std::string layer = {};  // of the part; empty: its own colours, else its first
};

PartChoice named_part(const fs::path& file, const std::vector<ImageSpec>& parts, const std::string& wanted) {
    const std::optional<std::int64_t> number = parse_int64(wanted);
    if (number && *number >= 0 && *number < std::ssize(parts)) return {int(*number)};
    std::vector<std::string> names;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::string name = part_name(parts[i]);
        if (!name.empty() && lower_case(name) == lower_case(wanted)) return {int(i)};
        names.push_back(name.empty() ? std::to_string(i) : name);
        for (const std::string& layer : layers_of(parts[i])) {
            if (lower_case(layer) == lower_case(wanted)) return {int(i), false, layer};
            names.push_back(layer);
        }
    }
    bad_input(file, fmt::format("a picture of {}", fmt::join(names, ", ")), "hdu = " + wanted);
}

PartChoice choose_part(const fs::path& file, ImageInput& in, const std::string& part,
                       Wanted wanted = Wanted::colors) {
    const std::vector<ImageSpec> parts = parts_of(in);
    if (part != "auto") return named_part(file, parts, part);
    for (int i = 0; wanted == Wanted::depths && i < int(parts.size()); ++i)
        if (depth_channel(parts[i]) >= 0) return {i};
    const std::string_view format = in.format_name();
    warn_of_hidden_pictures(file, format);
    if (parts.size() < 2 || format == "psd") return {};  // Photoshop's first is the whole picture
    if (format == "tiff" && are_channels(parts)) return {0, true};
    PartChoice choice;
    std::int64_t candidates = std::ssize(parts);  // frames of an animation
    if (format == "tiff") {
        choice.first = best_page(in, parts);
        candidates =
            std::ranges::count_if(parts, [](const ImageSpec& page) { return !is_lesser_page(page); });
    } else if (format == "openexr") {
        candidates = std::ranges::count_if(parts, has_colors);
        const auto has_light = [](const ImageSpec& spec) { return find_channel(spec, "Y") >= 0; };
        auto best = std::ranges::find_if(parts, has_colors);
        if (best == parts.end()) best = std::ranges::find_if(parts, has_light);
        if (best != parts.end()) choice.first = int(best - parts.begin());
    }
    const std::string name = part_name(parts[choice.first]);
    if (candidates != 1)
        log_warning(fmt::format("{}: it holds {} pictures; {}{} is taken (hdu = {}NUMBER takes another)",
                                file.string(), parts.size(), choice.first,
                                name.empty() ? "" : " '" + name + "'", name.empty() ? "" : "NAME or "));
    return choice;
}

std::string find_credit(const fs::path& file, const ImageSpec& spec) {
    std::string credit = read_xmp_metadata(file).credit;
    for (const char* name : {"IPTC:Provider", "Artist", "Exif:Artist", "IPTC:Creator", "Copyright"})
        if (credit.empty()) credit = trim(spec.get_string_attribute(name));
    return credit;
}

}  // namespace

ImageRows joined_channels(const std::array<ImageRows, 3>& channels) {
    const auto read = [channels](std::int64_t begin, std::int64_t end, float* rows) {
        for (std::size_t c = 0; c < 3; ++c) {
            Image strip = unfilled_image(channels[c].width, end - begin, channels[c].channels);
            channels[c].read(begin, end, strip.pixels.data());
            for (std::int64_t i = 0; i < strip.width * strip.height; ++i)
                rows[3 * i + std::int64_t(c)] = strip.pixels[i * strip.channels];
        }
    };
    return {channels[0].width, channels[0].height, 3, read};
}

PictureRows open_picture_rows(const fs::path& file, const Progress& progress, const std::string& part,
                              Wanted wanted) {
    std::unique_ptr<ImageInput> in = open_picture(file);
    const PartChoice choice = choose_part(file, *in, part, wanted);
    ImageSpec spec = in->spec(choice.first);
    check_spec(file, spec);
    const std::string format = in->format_name();
    if (format == "jpeg" && !jpeg_is_whole(file)) fail_picture(file, "the file ends before the picture does");
    if (format == "webp") add_webp_exif(file, spec);
    warn_of_values(file, spec);
    Channels channels = choose_channels(spec, wanted, choice.layer);
    if (wanted == Wanted::colors && !choice.three) warn_of_other_channels(file, spec, channels);
    if (format == "bmp" && !bmp_has_alpha(file)) channels.alpha = -1;
    if (channels.xyz)
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), xyz_chromaticities.data());
    PictureRows result;
    Picture& picture = result.picture;
    picture.colors = colors_of_picture(file, format, spec, choice.first);
    const auto rows_of_part = [&](std::unique_ptr<ImageInput> own, int number) {
        return rows_of_file(std::make_shared<Bands>(file, std::move(own), number, progress), channels);
    };
    if (choice.three)
        result.rows = joined_channels({rows_of_part(open_picture(file), 0),
                                       rows_of_part(open_picture(file), 1), rows_of_part(std::move(in), 2)});
    else
        result.rows = rows_of_part(std::move(in), choice.first);
    if (const auto none = format == "tiff" ? check_tiff(file, choice.first) : std::nullopt)
        change_colors(result.rows, [none = float(*none)](float value, int) {
            return value == none ? std::numeric_limits<float>::quiet_NaN() : value;
        });
    if (format == "hdr")
        change_colors(result.rows, [factors = radiance_factors(file)](float value, int c) {
            return value / factors[std::size_t(c)];
        });
    picture.max_integer = largest_integer(spec);
    if (const double largest = format == "pnm" ? largest_of_pnm(file) : 0.0; largest > 0.0)
        undo_scaling(result.rows, std::exchange(picture.max_integer, largest), largest);
    // OpenEXR's whole numbers are light, as its others are; OpenImageIO makes fractions of them.
    if (format == "openexr" && std::exchange(picture.max_integer, 0.0) > 0.0)
        change_colors(result.rows, [](float value, int) { return value * 4294967295.0f; });
    make_square(file, spec, result.rows);
    if (const int orientation = orientation_of(file, spec); orientation != 1) {
        result.rows = rows_of(turned(all_rows(result.rows, file), orientation));
        log_info(fmt::format("{}: {}, as its orientation {} says", file.string(), orientations[orientation],
                             orientation));
    }
    picture.image = {result.rows.width, result.rows.height, result.rows.channels, {}};
    // The reader of JPEG 2000 heeds the wish for it without a word, that of BMP never multiplies.
    picture.associated = channels.alpha >= 0 && format != "jpeg2000" && format != "bmp" &&
                         spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0;
    picture.distances = wanted == Wanted::depths && depth_channel(spec) >= 0;
    picture.cube = is_cube_map(spec);
    picture.credit = find_credit(file, spec);
    picture.summary =
        fmt::format("{}x{} px, {}", picture.image.width, picture.image.height, spec.format.c_str());
    return result;
}

Picture read_picture(const fs::path& file, const Progress& progress, const std::string& part, Wanted wanted) {
    PictureRows rows = open_picture_rows(file, progress, part, wanted);
    rows.picture.image = all_rows(rows.rows, file);
    return std::move(rows.picture);
}

PictureParts describe_parts(const fs::path& file) {
    const std::unique_ptr<ImageInput> in = open_picture(file);
    const QuietLog quiet;
    PictureParts found;
    for (const ImageSpec& spec : parts_of(*in)) {
        const std::string name = part_name(spec);
        found.parts.push_back(
            fmt::format("{}: {}x{} px, {}{}", found.parts.size(), spec.width, spec.height,
                        spec.nchannels == 1 ? "1 channel" : fmt::format("{} channels", spec.nchannels),
                        name.empty() ? "" : ", '" + name + "'"));
    }
    found.taken = choose_part(file, *in, "auto").first;
    return found;
}

ObjectMetadata read_picture_metadata(const fs::path& file) {
    const QuietLog quiet;  // what is taken is said when it is read
    if (is_fits(file)) return read_fits_metadata(file);
    ObjectMetadata found = read_xmp_metadata(file);
    if (!found.credit.empty()) return found;  // before OpenImageIO has to start
    const std::unique_ptr<ImageInput> in = open_picture(file);
    found.credit = find_credit(file, in->spec(choose_part(file, *in, "auto").first));
    return found;
}

void require_picture(const fs::path& file) {
    const QuietLog quiet;  // what is taken is said when it is read
    if (is_fits(file)) return require_fits_picture(file);
    const std::unique_ptr<ImageInput> in = open_picture(file);
    check_spec(file, in->spec(choose_part(file, *in, "auto").first));
}

}  // namespace astrosplat

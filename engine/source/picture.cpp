// Channels, windows and orientation of what OpenImageIO reads.
#include <fmt/format.h>
// (This line keeps clang-format from sorting the two.)
#include "source/open_picture.h"

#include <tiffio.h>

#include <fstream>
#include <sstream>

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

namespace astrosplat {
namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;

// Where r, g, b and alpha are among a file's channels.
struct Channels {
    std::array<int, 3> color{};
    int alpha = -1;
    bool luma_chroma = false;  // color is Y, RY, BY
};

int find_channel(const ImageSpec& spec, const char* name) {
    for (int c = 0; c < spec.nchannels; ++c)
        if (OIIO::Strutil::iequals(spec.channel_name(c), name)) return c;
    return -1;
}

// Blender's layers have names before it; with an X beside it, Z is a place or a direction.
int depth_channel(const ImageSpec& spec) {
    const int z = find_channel(spec, "Z");
    if (z >= 0 && find_channel(spec, "X") < 0) return z;
    for (int c = 0; c < spec.nchannels; ++c)
        if (OIIO::Strutil::iends_with(spec.channel_name(c), "depth.Z")) return c;
    return -1;
}

Channels choose_channels(const ImageSpec& spec, Wanted wanted) {
    Channels c;
    const int depth = depth_channel(spec);
    if (wanted == Wanted::depths && depth >= 0) {
        c.color = {depth, depth, depth};
        return c;
    }
    // OpenImageIO's GIF reader names a channel beyond the last one.
    const bool named = spec.alpha_channel >= 0 && spec.alpha_channel < spec.nchannels;
    c.alpha = named ? spec.alpha_channel : find_channel(spec, "A");
    const std::array<int, 3> rgb{find_channel(spec, "R"), find_channel(spec, "G"), find_channel(spec, "B")};
    const std::array<int, 3> yc{find_channel(spec, "Y"), find_channel(spec, "RY"), find_channel(spec, "BY")};
    const auto complete = [](const std::array<int, 3>& set) { return *std::ranges::min_element(set) >= 0; };
    c.luma_chroma = complete(yc);
    if (complete(rgb) || c.luma_chroma) {
        c.color = complete(rgb) ? rgb : yc;
        c.luma_chroma = !complete(rgb);
        return c;
    }
    const int first = c.alpha == 0 && spec.nchannels > 1 ? 1 : 0;
    const bool three =
        spec.nchannels - first - (c.alpha > first ? 1 : 0) >= 3 && (c.alpha < first || c.alpha >= first + 3);
    c.color =
        three ? std::array<int, 3>{first, first + 1, first + 2} : std::array<int, 3>{first, first, first};
    return c;
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

// The window the picture shows, in the file's coordinates; the data window where the two do not meet.
Region display_window(const ImageSpec& spec) {
    const Region data{spec.x, spec.y, spec.width, spec.height};
    if (is_cube_map(spec)) return data;
    const Region display{spec.full_x, spec.full_y, spec.full_width, spec.full_height};
    const bool meet = display.x < data.x + data.width && data.x < display.x + display.width &&
                      display.y < data.y + data.height && data.y < display.y + display.height;
    return meet ? display : data;
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
        std::fill_n(rows, (end - begin) * row_floats, 0.0f);  // where the file has nothing
        const std::int64_t last = std::min<std::int64_t>(end + up, spec.height);
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

int orientation_of(const ImageSpec& spec) {
    const int orientation = spec.get_int_attribute("Orientation", 1);
    return orientation >= 1 && orientation <= 8 ? orientation : 1;
}

Image turned(const Image& image, int orientation) {
    const bool swaps = orientation >= 5;  // rows become columns
    const bool from_right = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
    const bool from_below = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
    Image result =
        make_image(swaps ? image.height : image.width, swaps ? image.width : image.height, image.channels);
    for_each_pixel(result, [&](std::int64_t x, std::int64_t y) {
        const std::int64_t column = swaps ? y : x, row = swaps ? x : y;
        std::copy_n(image.at(from_right ? image.width - 1 - column : column,
                             from_below ? image.height - 1 - row : row),
                    image.channels, result.at(x, y));
    });
    return result;
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
        const float *const p = wide ? image.at(first, y) : image.at(x, first), *const q =
                                                                                   wide ? image.at(next, y)
                                                                                        : image.at(x, next);
        for (int c = 0; c < image.channels; ++c)
            square.at(x, y)[c] = share > 0.0f ? p[c] * (1.0f - share) + q[c] * share : p[c];
    });
    log_info(fmt::format("{}: read as {}x{} px, as its pixels are {:g} times as wide as high", file.string(),
                         square.width, square.height, aspect));
    rows = rows_of(std::move(square));
}

// By what a Radiance file's values have to be divided to be radiances (its format's EXPOSURE and COLORCORR,
// both cumulative), which OpenImageIO leaves to others.
std::array<float, 3> radiance_factors(const fs::path& file) {
    std::array<double, 3> factors{1.0, 1.0, 1.0};
    std::ifstream in(file, std::ios::binary);
    for (std::string line; std::getline(in, line) && !trim(line).empty();) {
        const std::size_t equals = line.find('=');
        const std::string_view key = trim(std::string_view(line).substr(0, equals));
        const bool corrects = key == "COLORCORR", exposes = key == "EXPOSURE";
        std::istringstream words(equals == std::string::npos ? "" : line.substr(equals + 1));
        std::array<double, 3> values{};
        std::size_t count = 0;
        for (std::string word; count < (corrects ? 3u : 1u) && words >> word; ++count)
            values[count] = parse_double(word).value_or(0.0);
        const bool whole =
            std::all_of(values.begin(), values.begin() + count, [](double v) { return v > 0.0; });
        if ((corrects && count == 3 && whole) || (exposes && count == 1 && whole))
            for (std::size_t c = 0; c < 3; ++c) factors[c] *= values[corrects ? c : 0];
        else if (corrects || exposes || key == "PRIMARIES" || line.find("_xyze") != std::string::npos ||
                 (key == "PIXASPECT" && values[0] != 1.0))
            log_warning(fmt::format("{}: its {} is not followed", file.string(), trim(line)));
    }
    return {float(factors[0]), float(factors[1]), float(factors[2])};
}

void divide_by(const std::array<float, 3>& factors, ImageRows& rows) {
    if (factors == std::array{1.0f, 1.0f, 1.0f}) return;
    rows.read = [=, width = rows.width * rows.channels, channels = rows.channels, read = rows.read](
                    std::int64_t begin, std::int64_t end, float* values) {
        read(begin, end, values);
        for (float* p = values; p < values + (end - begin) * width; p += channels)
            for (int c = 0; c < 3; ++c) p[c] /= factors[c];
    };
}

// Where a TIFF does not say its bits they are one, and OpenImageIO reads eight; where it was cut short,
// OpenImageIO reads black.
void check_tiff(const fs::path& file, int page) {
    const QuietStderr quiet;
    const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(file.c_str(), "r"), TIFFClose);
    if (!tiff || !TIFFSetDirectory(tiff.get(), static_cast<tdir_t>(page))) return;
    std::uint16_t bits = 0;
    if (TIFFGetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, &bits) != 1)
        fail_picture(file, "it does not say how many bits a value has (BitsPerSample); save it with 8");
    const std::uint64_t size = fs::file_size(file);
    const bool tiled = TIFFIsTiled(tiff.get()) != 0;
    const std::uint32_t parts = tiled ? TIFFNumberOfTiles(tiff.get()) : TIFFNumberOfStrips(tiff.get());
    for (std::uint32_t i = 0; i < parts; ++i) {
        const std::uint64_t at = TIFFGetStrileOffset(tiff.get(), i);
        if (at > size || TIFFGetStrileByteCount(tiff.get(), i) > size - at)
            fail_picture(file, "the file ends before the picture does");
    }
}

// OpenImageIO turns white that is 0 around in 8 bits only, and has nothing below 0.
void warn_of_values(const fs::path& file, const ImageSpec& spec) {
    const bool white = spec.get_int_attribute("tiff:PhotometricInterpretation", 1) == 0;
    if (white && spec.format.size() > 1)
        log_warning(fmt::format(
            "{}: that 0 is white (PhotometricInterpretation) is not followed: it is black", file.string()));
    if (spec.format.is_signed() && !spec.format.is_floating_point())
        log_warning(fmt::format("{}: its whole numbers have a sign: those below 0 are black", file.string()));
}

double largest_integer(const ImageSpec& spec) {
    if (spec.format.is_floating_point()) return 0.0;
    return spec.format.size() == 1 ? 255.0 : spec.format.size() == 2 ? 65535.0 : 4294967295.0;
}

// ---- several pictures in one file

bool has_colors(const ImageSpec& spec) {
    return find_channel(spec, "R") >= 0 && find_channel(spec, "G") >= 0 && find_channel(spec, "B") >= 0;
}

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
};

int named_part(const fs::path& file, const std::vector<ImageSpec>& parts, const std::string& wanted) {
    const std::optional<std::int64_t> number = parse_int64(wanted);
    if (number && *number >= 0 && *number < std::ssize(parts)) return int(*number);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::string name = part_name(parts[i]);
        if (!name.empty() && lower_case(name) == lower_case(wanted)) return int(i);
        names.push_back(name.empty() ? std::to_string(i) : name);
    }
    bad_input(file, fmt::format("a picture of {}", fmt::join(names, ", ")), "hdu = " + wanted);
}

PartChoice choose_part(const fs::path& file, ImageInput& in, const std::string& part,
                       Wanted wanted = Wanted::colors) {
    const std::vector<ImageSpec> parts = parts_of(in);
    if (part != "auto") return {named_part(file, parts, part)};
    for (int i = 0; wanted == Wanted::depths && i < int(parts.size()); ++i)
        if (depth_channel(parts[i]) >= 0) return {i};
    const std::string_view format = in.format_name();
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

// ---- colours

std::shared_ptr<const ColorEncoding> encoding_of(const fs::path& file, ImageInput& in,
                                                 const ImageSpec& spec) {
    const double largest = largest_integer(spec);
    std::string problem;
    std::shared_ptr<const ColorEncoding> encoding;
    const bool png = std::string_view(in.format_name()) == "png";
    const OIIO::ParamValue* const profile = spec.find_attribute("ICCProfile");
    if (png) encoding = png_encoding(file, profile != nullptr, problem);
    if (!encoding && problem.empty() && profile && profile->type().basetype == OIIO::TypeDesc::UINT8)
        encoding = icc_encoding({static_cast<const std::uint8_t*>(profile->data()),
                                 static_cast<std::size_t>(profile->type().size())},
                                problem);
    const OIIO::ParamValue* const xy = spec.find_attribute("chromaticities");
    if (!encoding && xy && xy->type().size() == 8 * sizeof(float))
        encoding = chromaticity_encoding(std::span<const float, 8>(static_cast<const float*>(xy->data()), 8),
                                         {}, "chromaticities");
    const std::string space = spec.get_string_attribute("oiio:ColorSpace");
    if (!encoding && problem.empty() && !png && space.starts_with("Gamma")) {
        TransferCurve curve{TransferCurve::Kind::parametric, {1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, {}};
        curve.parameters[0] = double(spec.get_float_attribute("oiio:Gamma", 2.2f));
        encoding = std::make_shared<const ColorEncoding>(ColorEncoding{space, {curve, curve, curve}, {}, {}});
    }
    if (problem.empty() && space == "KodakLog") problem = "colour space KodakLog";
    if (!problem.empty())
        log_warning(fmt::format("{}: its {} is not followed; colours are read as {}", file.string(), problem,
                                largest > 0.0 ? "sRGB" : "linear Rec. 709"));
    return with_tables(encoding, largest);
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
    const ImageSpec spec = in->spec(choice.first);
    check_spec(file, spec);
    const std::string format = in->format_name();
    if (format == "jpeg" && !jpeg_is_whole(file)) fail_picture(file, "the file ends before the picture does");
    if (format == "tiff") check_tiff(file, choice.first);
    warn_of_values(file, spec);
    const Channels channels = choose_channels(spec, wanted);
    PictureRows result;
    Picture& picture = result.picture;
    picture.colors = encoding_of(file, *in, spec);
    const auto rows_of_part = [&](std::unique_ptr<ImageInput> own, int number) {
        return rows_of_file(std::make_shared<Bands>(file, std::move(own), number, progress), channels);
    };
    if (choice.three)
        result.rows = joined_channels({rows_of_part(open_picture(file), 0),
                                       rows_of_part(open_picture(file), 1), rows_of_part(std::move(in), 2)});
    else
        result.rows = rows_of_part(std::move(in), choice.first);
    if (format == "hdr") divide_by(radiance_factors(file), result.rows);
    // OpenEXR's whole numbers are light, as its others are; OpenImageIO makes fractions of them.
    const bool counts = format == "openexr" && spec.format.basetype == OIIO::TypeDesc::UINT32;
    constexpr float whole = 1.0f / 4294967295.0f;
    if (counts) divide_by({whole, whole, whole}, result.rows);
    make_square(file, spec, result.rows);
    if (const int orientation = orientation_of(spec); orientation != 1) {
        result.rows = rows_of(turned(all_rows(result.rows, file), orientation));
        log_info(fmt::format("{}: {}, as its orientation {} says", file.string(), orientations[orientation],
                             orientation));
    }
    picture.image = {result.rows.width, result.rows.height, result.rows.channels, {}};
    picture.max_integer = counts ? 0.0 : largest_integer(spec);
    // The reader of JPEG 2000 heeds the wish for it without a word.
    picture.associated = channels.alpha >= 0 && format != "jpeg2000" &&
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
    if (is_fits(file)) return require_fits_picture(file);
    const std::unique_ptr<ImageInput> in = open_picture(file);
    const QuietLog quiet;  // what is taken is said when it is read
    check_spec(file, in->spec(choose_part(file, *in, "auto").first));
}

}  // namespace astrosplat

// Channels, windows and orientation of what OpenImageIO reads.
#include <fmt/format.h>
// (This line keeps clang-format from sorting the two.)
#include "source/open_picture.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "core/color.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/text.h"
#include "source/credit.h"
#include "source/fits.h"
#include "source/jpeg_end.h"
#include "source/picture.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;
using OIIO::ImageInput;
using OIIO::ImageSpec;

// Where r, g, b and alpha are among a file's channels.
struct Channels {
    std::array<int, 3> color{};
    int alpha = -1;
    bool luma_chroma = false;  // color is Y, RY, BY
};

int find_channel(const ImageSpec& spec, const char* name) {
    for (int c = 0; c < spec.nchannels; ++c) {
        if (OIIO::Strutil::iequals(spec.channel_name(c), name)) return c;
    }
    return -1;
}

Channels choose_channels(const ImageSpec& spec) {
    Channels c;
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

void check_spec(const fs::path& file, const ImageSpec& spec) {
    if (spec.deep) fail_picture(file, "it holds deep samples");
    if (spec.depth > 1) fail_picture(file, "it is a volume");
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) fail_picture(file, "it has no pixels");
    const double bytes = 4.0 * (spec.nchannels + 4) *
                         (static_cast<double>(spec.width) * spec.height +
                          static_cast<double>(spec.full_width) * spec.full_height);
    claim_memory(static_cast<std::int64_t>(std::min(bytes, 9e18)), fmt::format("reading {}", file.string()));
}

// OpenImageIO asks this between bands of rows; true ends the reading.
bool report_progress(void* progress, float fraction) {
    static_cast<const Progress*>(progress)->at(static_cast<double>(fraction));
    return static_cast<const Progress*>(progress)->stop();
}

Image read_all(const fs::path& file, ImageInput& in, const ImageSpec& spec, const Progress& progress) {
    Image all{spec.width, spec.height, spec.nchannels, {}};
    all.pixels.resize(all.width * all.height * all.channels);
    const QuietStderr quiet;
    const bool read =
        in.read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, all.pixels.data(), OIIO::AutoStride,
                      OIIO::AutoStride, OIIO::AutoStride, report_progress, const_cast<Progress*>(&progress));
    progress.check();
    if (!read) fail_picture(file, in.geterror());
    return all;
}

// OpenEXR's luminance/chroma: RY = (R - Y) / Y, BY = (B - Y) / Y, Y the luminance for Rec. 709 primaries.
void to_rgb(float* c) {
    const float y = c[0], r = (c[1] + 1.0f) * y, b = (c[2] + 1.0f) * y;
    const float g = (y - luminance(r, 0.0f, b)) / luminance(0.0f, 1.0f, 0.0f);
    c[0] = r;
    c[1] = g;
    c[2] = b;
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

Image pick_channels(const Image& all, const ImageSpec& spec, const Channels& channels) {
    const Region window = display_window(spec);
    const int count = channels.alpha >= 0 ? 4 : 3;
    Image image = make_image(window.width, window.height, count);
    parallel_each(window.height, 64, [&](std::int64_t y) {
        const std::int64_t from_y = window.y + y - spec.y;
        if (from_y < 0 || from_y >= all.height) return;
        const std::int64_t shift = window.x - spec.x;
        for (std::int64_t x = std::max<std::int64_t>(0, -shift);
             x < std::min(window.width, all.width - shift); ++x) {
            const float* from = all.at(x + shift, from_y);
            float* to = image.at(x, y);
            for (int c = 0; c < 3; ++c) to[c] = from[channels.color[c]];
            if (channels.luma_chroma) to_rgb(to);
            if (count == 4) to[3] = from[channels.alpha];
        }
    });
    return image;
}

// The eight values of EXIF's and TIFF's tag Orientation, from 1: what has to be done to see the picture as it
// was meant.
constexpr std::array<const char*, 9> orientations = {"",
                                                     "nothing",
                                                     "mirrored left to right",
                                                     "turned by 180 degrees",
                                                     "mirrored top to bottom",
                                                     "mirrored along its falling diagonal",
                                                     "turned by 90 degrees clockwise",
                                                     "mirrored along its rising diagonal",
                                                     "turned by 90 degrees anticlockwise"};

int orientation_of(const ImageSpec& spec) {
    const int orientation = spec.get_int_attribute("Orientation", 1);
    return orientation >= 1 && orientation <= 8 ? orientation : 1;
}

Image turned(Image image, int orientation) {
    if (orientation == 1) return image;
    const bool swaps = orientation >= 5;  // rows become columns
    const bool from_right = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
    const bool from_below = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
    Image result =
        make_image(swaps ? image.height : image.width, swaps ? image.width : image.height, image.channels);
    parallel_each(result.height, 64, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < result.width; ++x) {
            const std::int64_t column = swaps ? y : x, row = swaps ? x : y;
            std::copy_n(image.at(from_right ? image.width - 1 - column : column,
                                 from_below ? image.height - 1 - row : row),
                        image.channels, result.at(x, y));
        }
    });
    return result;
}

double largest_integer(const ImageSpec& spec) {
    if (spec.format.is_floating_point()) return 0.0;
    switch (spec.format.size()) {
        case 1:
            return 255.0;
        case 2:
            return 65535.0;
        default:
            return 4294967295.0;
    }
}

std::string find_credit(const fs::path& file, const ImageSpec& spec) {
    std::string credit = xmp_credit(file);
    if (!credit.empty()) return credit;
    for (const char* name : {"IPTC:Provider", "Artist", "Exif:Artist", "IPTC:Creator", "Copyright"}) {
        credit = trim(spec.get_string_attribute(name));
        if (!credit.empty()) return credit;
    }
    return {};
}

}  // namespace

Picture read_picture(const fs::path& file, const Progress& progress) {
    const std::unique_ptr<ImageInput> in = open_picture(file);
    const ImageSpec spec = in->spec();
    check_spec(file, spec);
    if (std::string_view(in->format_name()) == "jpeg" && !jpeg_is_whole(file))
        fail_picture(file, "the file ends before the picture does");
    const Channels channels = choose_channels(spec);
    const Image all = read_all(file, *in, spec, progress);
    const int orientation = orientation_of(spec);
    const char* const turn = orientations[orientation];
    Picture picture;
    picture.image = turned(pick_channels(all, spec, channels), orientation);
    picture.max_integer = largest_integer(spec);
    picture.associated = channels.alpha >= 0 && spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0;
    picture.cube = is_cube_map(spec);
    picture.credit = find_credit(file, spec);
    picture.summary =
        fmt::format("{}x{} px, {}", picture.image.width, picture.image.height, spec.format.c_str());
    if (orientation != 1)
        log_info(fmt::format("{}: {}, as its orientation {} says", file.string(), turn, orientation));
    return picture;
}

void require_picture(const fs::path& file) {
    if (is_fits(file))
        require_fits_picture(file);
    else
        open_picture(file);
}

}  // namespace astrosplat

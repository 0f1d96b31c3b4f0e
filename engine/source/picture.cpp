// The only reader that touches OpenImageIO. <fmt/format.h> comes first: OpenImageIO's own copy of fmt would
// turn exceptions off.
#include <fmt/format.h>
// (This line keeps clang-format from sorting the two.)
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "core/color.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/text.h"
#include "source/credit.h"
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
    bool gray = false;
};

std::string first_line(const std::string& text) { return std::string(trim(text.substr(0, text.find('\n')))); }

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
    throw InputError(fmt::format("{}: cannot be read as a picture: {}", file.string(), first_line(reason)));
}

std::unique_ptr<ImageInput> open_picture(const fs::path& file) {
    std::error_code error;
    if (!fs::exists(file, error)) fail(file, "no such file");
    if (fs::is_directory(file, error)) fail(file, "it is a folder");
    ImageSpec wish;
    wish.attribute("oiio:UnassociatedAlpha", 1);
    std::unique_ptr<ImageInput> in = ImageInput::open(file.string(), &wish);
    if (in) return in;
    const std::string reason = OIIO::geterror();
    if (reason.find("Subsampled channels") != std::string::npos)
        fail(file,
             "its colour is stored at a lower resolution (subsampled luminance/chroma); save it as RGB");
    fail(file, reason.empty() ? "no picture format that OpenImageIO knows" : reason);
}

int find_channel(const ImageSpec& spec, const char* name) {
    for (int c = 0; c < spec.nchannels; ++c) {
        const std::string& have = spec.channelnames[static_cast<std::size_t>(c)];
        if (OIIO::Strutil::iequals(have, name)) return c;
    }
    return -1;
}

Channels choose_channels(const ImageSpec& spec) {
    Channels c;
    c.alpha = spec.alpha_channel >= 0 ? spec.alpha_channel : find_channel(spec, "A");
    const std::array<int, 3> rgb{find_channel(spec, "R"), find_channel(spec, "G"), find_channel(spec, "B")};
    const std::array<int, 3> yc{find_channel(spec, "Y"), find_channel(spec, "RY"), find_channel(spec, "BY")};
    const auto complete = [](const std::array<int, 3>& set) {
        return *std::min_element(set.begin(), set.end()) >= 0;
    };
    c.luma_chroma = complete(yc);
    if (complete(rgb) || c.luma_chroma) {
        c.color = complete(rgb) ? rgb : yc;
        c.luma_chroma = !complete(rgb);
        return c;
    }
    const int first = c.alpha == 0 && spec.nchannels > 1 ? 1 : 0;
    const bool three =
        spec.nchannels - first - (c.alpha > first ? 1 : 0) >= 3 && (c.alpha < first || c.alpha >= first + 3);
    c.gray = !three;
    c.color =
        three ? std::array<int, 3>{first, first + 1, first + 2} : std::array<int, 3>{first, first, first};
    return c;
}

void check_spec(const fs::path& file, const ImageSpec& spec) {
    if (spec.deep) fail(file, "it holds deep samples");
    if (spec.depth > 1) fail(file, "it is a volume");
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) fail(file, "it has no pixels");
    const double bytes = 4.0 * (spec.nchannels + 4) *
                         (static_cast<double>(spec.width) * spec.height +
                          static_cast<double>(spec.full_width) * spec.full_height);
    claim_memory(static_cast<std::int64_t>(std::min(bytes, 9e18)), fmt::format("reading {}", file.string()));
}

Image read_all(const fs::path& file, ImageInput& in, const ImageSpec& spec) {
    Image all{spec.width, spec.height, spec.nchannels, {}};
    all.pixels.resize(static_cast<std::size_t>(all.width * all.height * all.channels));
    if (!in.read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, all.pixels.data()))
        fail(file, in.geterror());
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

// The window the picture shows, in the file's coordinates; the data window where the two do not meet.
Region display_window(const ImageSpec& spec) {
    const Region data{spec.x, spec.y, spec.width, spec.height};
    const Region display{spec.full_x, spec.full_y, spec.full_width, spec.full_height};
    const bool meet = display.x < data.x + data.width && data.x < display.x + display.width &&
                      display.y < data.y + data.height && data.y < display.y + display.height;
    return meet ? display : data;
}

Image pick_channels(const Image& all, const ImageSpec& spec, const Channels& channels) {
    const Region window = display_window(spec);
    const int count = channels.alpha >= 0 ? 4 : 3;
    Image image = make_image(window.width, window.height, count);
    parallel_chunks(window.height, 64, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t y = begin; y < end; ++y) {
            const std::int64_t from_y = window.y + y - spec.y;
            if (from_y < 0 || from_y >= all.height) continue;
            const std::int64_t shift = window.x - spec.x;
            for (std::int64_t x = std::max<std::int64_t>(0, -shift);
                 x < std::min(window.width, all.width - shift); ++x) {
                const float* from = all.at(x + shift, from_y);
                float* to = image.at(x, y);
                for (int c = 0; c < 3; ++c) to[c] = from[channels.color[static_cast<std::size_t>(c)]];
                if (channels.luma_chroma) to_rgb(to);
                if (count == 4) to[3] = from[channels.alpha];
            }
        }
    });
    return image;
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
    for (const char* key : {"IPTC:Provider", "Artist", "Exif:Artist", "IPTC:Creator", "Copyright"}) {
        credit = trim(spec.get_string_attribute(key));
        if (!credit.empty()) return credit;
    }
    return {};
}

}  // namespace

Picture read_picture(const fs::path& file) {
    const std::unique_ptr<ImageInput> in = open_picture(file);
    const ImageSpec spec = in->spec();
    check_spec(file, spec);
    if (std::string_view(in->format_name()) == "jpeg" && !jpeg_is_whole(file))
        fail(file, "the file ends before the picture does");
    const Channels channels = choose_channels(spec);
    const Image all = read_all(file, *in, spec);
    Picture picture;
    picture.image = pick_channels(all, spec, channels);
    picture.max_integer = largest_integer(spec);
    picture.associated = channels.alpha >= 0 && spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0;
    picture.gray = channels.gray;
    picture.credit = find_credit(file, spec);
    picture.summary =
        fmt::format("{}x{} px, {}", picture.image.width, picture.image.height, spec.format.c_str());
    return picture;
}

}  // namespace astrosplat

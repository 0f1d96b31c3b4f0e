// What picture files say of their colours and of pictures beside the first where OpenImageIO does not tell
// it.
#include <fmt/format.h>
// (This line keeps clang-format from sorting the two.)
#include "source/open_picture.h"

#include "core/file.h"
#include "core/log.h"
#include "core/text.h"

namespace astrosplat {
namespace {

using namespace std::string_literals;
constexpr std::size_t most_metadata = std::size_t{1} << 18;  // segments of a JPEG before its pixels

// From a marker's name on, as much as a segment can have.
std::string segment_of(const fs::path& file, std::string_view name) {
    const std::string bytes = read_beginning(file, most_metadata);
    const std::size_t at = bytes.find(name);
    return at == bytes.npos ? "" : bytes.substr(at, std::size_t{1} << 16);
}

// By an entry of Exif's directory, in either byte order.
bool is_adobe_rgb(const fs::path& file, const OIIO::ImageSpec& spec) {
    const std::string exif = segment_of(file, std::string_view("Exif\0\0", 6));
    return spec.get_int_attribute("Exif:ColorSpace", 1) == 2 ||
           exif.find("\1\0\2\0\4\0\0\0R03"s) != exif.npos || exif.find("\0\1\0\2\0\0\0\4R03"s) != exif.npos;
}

// Likewise; there are fewer than 256.
std::int64_t jpeg_pictures(const fs::path& file) {
    const std::string index = segment_of(file, std::string_view("MPF\0", 4));
    const std::size_t little = index.find("\1\xb0\4\0\1\0\0\0"s), big = index.find("\xb0\1\0\4\0\0\0\1"s);
    const std::size_t at = little != index.npos ? little + 8 : big != index.npos ? big + 11 : index.size();
    return at < index.size() ? std::uint8_t(index[at]) : 1;
}

}  // namespace

double largest_integer(const OIIO::ImageSpec& spec) {
    if (spec.format.is_floating_point()) return 0.0;
    return spec.format.size() == 1 ? 255.0 : spec.format.size() == 2 ? 65535.0 : 4294967295.0;
}

void warn_of_hidden_pictures(const fs::path& file, std::string_view format) {
    const std::int64_t count = format == "png"    ? png_frames(file)
                               : format == "jpeg" ? jpeg_pictures(file)
                                                  : 1;
    if (count > 1)
        log_warning(fmt::format("{}: it holds {} pictures; 0 is taken, as the others are not followed",
                                file.string(), count));
}

std::shared_ptr<const ColorEncoding> colors_of_picture(const fs::path& file, std::string_view format,
                                                       const OIIO::ImageSpec& spec, int page) {
    const double largest = largest_integer(spec);
    std::string problem;
    std::shared_ptr<const ColorEncoding> encoding;
    const auto is_open = [&] { return !encoding && problem.empty(); };
    const OIIO::ParamValue* const profile = spec.find_attribute("ICCProfile");
    if (format == "png") encoding = png_encoding(file, profile != nullptr, problem);
    if (is_open() && profile && profile->type().basetype == OIIO::TypeDesc::UINT8)
        encoding = icc_encoding({static_cast<const std::uint8_t*>(profile->data()),
                                 static_cast<std::size_t>(profile->type().size())},
                                problem);
    const OIIO::ParamValue* const xy = spec.find_attribute("chromaticities");
    if (is_open() && xy && xy->type().size() == 8 * sizeof(float))
        encoding = chromaticity_encoding(std::span<const float, 8>(static_cast<const float*>(xy->data()), 8),
                                         {}, "set of chromaticities", problem);
    const std::string id = spec.get_string_attribute("colorInteropID");  // of the Color Interop Forum
    const bool is_known = id.empty() || id.starts_with(encoding ? "lin_" : "lin_rec709_") || id == "data";
    if (problem.empty() && format == "openexr" && !is_known) problem = "colorInteropID " + printable(id);
    if (is_open() && format == "tiff") encoding = tiff_encoding(colors_of_tiff(file, page), largest, problem);
    if (is_open() && format == "jpeg" && is_adobe_rgb(file, spec)) encoding = adobe_rgb_encoding();
    const std::string space = spec.get_string_attribute("oiio:ColorSpace");
    if (is_open() && format != "png" && (format == "dpx" || space.starts_with("Gamma")))
        encoding = named_encoding(space, double(spec.get_float_attribute("oiio:Gamma", 2.2f)));
    if (is_open() && space == "KodakLog") problem = "colour space KodakLog";
    if (!problem.empty())
        log_warning(fmt::format("{}: its {} is not followed; colours are read as {}", file.string(), problem,
                                largest > 0.0 ? "sRGB" : "linear Rec. 709"));
    return with_tables(encoding, largest);
}

}  // namespace astrosplat

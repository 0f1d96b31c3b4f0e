// After the specification of XISF 1.0 (Pleiades Astrophoto, 2014 to 2017): a header in XML, and blocks of
// data. What a header says of sizes is compared with the file and with memory before anything is taken.
#include "source/xisf.h"

#include <fmt/format.h>
#include <lz4.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <bit>
#include <pugixml.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/text.h"
#include "source/value_layout.h"

namespace astrosplat {
namespace {

using Bytes = Buffer<char>;

/// A file, its header, and where messages lead.
struct Xisf {
    fs::path file;
    InputFile in;
    pugi::xml_document header;
    Progress progress;

    Xisf(const fs::path& path, const Progress& own) : file(path), in(path), progress(own) { read_header(); }

    [[noreturn]] void fail(std::string_view expected, std::string_view found) const {
        bad_input(file, "XISF", expected, found.empty() ? "none" : found);
    }

    void read_header() {
        constexpr std::int64_t most_bytes = std::int64_t{64} << 20;
        std::array<char, 16> begin{};
        if (in.read(begin.data(), begin.size()) < begin.size()) fail("a header", "a file of a few bytes");
        std::uint32_t size = 0;
        for (std::size_t i = 0; i < 4; ++i) size |= std::uint32_t(std::uint8_t(begin[8 + i])) << (8 * i);
        if (size > most_bytes || std::int64_t(size) + 16 > in.size())
            fail("a header within the file", fmt::format("{} bytes", size));
        const Bytes text = bytes_at(16, size);
        const pugi::xml_parse_result parsed = header.load_buffer(text.data(), std::size_t(size));
        if (!parsed) fail("a header in XML", parsed.description());
    }

    Bytes bytes_at(std::int64_t position, std::int64_t size) const {
        claim_memory(size, fmt::format("reading {}", file.string()));
        Bytes bytes(static_cast<std::size_t>(size));
        constexpr std::int64_t portion = std::int64_t{1} << 24;
        for (std::int64_t done = 0; done < size;) {
            progress.check();
            const ssize_t got = ::pread(in.descriptor(), bytes.data() + done,
                                        static_cast<std::size_t>(std::min(portion, size - done)),
                                        static_cast<off_t>(position + done));
            if (got <= 0) fail(fmt::format("{} bytes of data", size), fmt::format("{}", done));
            done += got;
        }
        return bytes;
    }
};

std::vector<std::string> fields_of(const pugi::xml_node& node, const char* attribute) {
    std::vector<std::string> fields{""};
    for (const char c : std::string_view(node.attribute(attribute).value()))
        c == ':' ? void(fields.emplace_back()) : void(fields.back() += c);
    return fields;
}

std::int64_t count_of(const Xisf& xisf, const std::string& text, const char* what) {
    const std::optional<std::int64_t> number = parse_int64(text);
    if (!number || *number < 0) xisf.fail(fmt::format("{}, a whole number", what), "'" + text + "'");
    return *number;
}

/// A block's bytes as they are stored.
Bytes stored_bytes(const Xisf& xisf, const pugi::xml_node& node) {
    const std::vector<std::string> place = fields_of(node, "location");
    const pugi::xml_node data = place[0] == "embedded" ? node.child("Data") : node;
    if (place[0] == "attachment" && place.size() == 3) {
        const std::int64_t position = count_of(xisf, place[1], "a position"),
                           size = count_of(xisf, place[2], "a size");
        if (position > xisf.in.size() || size > xisf.in.size() - position)
            xisf.fail("data within the file", node.attribute("location").value());
        return xisf.bytes_at(position, size);
    }
    const std::string encoding =
        place[0] == "inline" && place.size() == 2 ? place[1] : data.attribute("encoding").value();
    std::optional<std::string> text;
    std::string plain;
    for (const char c : std::string_view(data.text().get()))
        if (!std::isspace(static_cast<unsigned char>(c))) plain += c;
    if (encoding == "base64") text = bytes_of_base64(plain);
    if (encoding == "hex") {
        text = "";
        for (std::size_t i = 0; i + 1 < plain.size() && text; i += 2) {
            const std::size_t high = std::string_view("0123456789abcdef").find(plain[i]),
                              low = std::string_view("0123456789abcdef").find(plain[i + 1]);
            if (high == std::string_view::npos || low == std::string_view::npos)
                text.reset();
            else
                *text += char(16 * high + low);
        }
    }
    if (!text) xisf.fail("data attached, in base64 or in hex", node.attribute("location").value());
    return Bytes(text->begin(), text->end());
}

void check_sum(const Xisf& xisf, const pugi::xml_node& node, const Bytes& bytes) {
    const std::vector<std::string> sum = fields_of(node, "checksum");
    if (sum.size() != 2) return;
    std::string name = sum[0];
    std::erase(name, '-');
    const std::optional<std::string> hex = digest_of(name, {bytes.data(), bytes.size()});
    if (!hex) return log_warning(fmt::format("{}: checksum {} is not followed", xisf.file.string(), sum[0]));
    if (*hex != lower_case(sum[1])) xisf.fail("data of the " + sum[0] + " that it names", *hex);
}

bool decompress(const std::string& codec, std::span<const char> from, std::span<char> to) {
    if (codec == "zlib") {
        uLongf size = to.size();
        return ::uncompress(reinterpret_cast<Bytef*>(to.data()), &size,
                            reinterpret_cast<const Bytef*>(from.data()), from.size()) == Z_OK &&
               size == to.size();
    }
    if (codec == "lz4" || codec == "lz4hc") {
        constexpr auto most = static_cast<std::size_t>(std::numeric_limits<int>::max());
        return from.size() <= most && to.size() <= most &&
               LZ4_decompress_safe(from.data(), to.data(), int(from.size()), int(to.size())) ==
                   int(to.size());
    }
    return ZSTD_decompress(to.data(), to.size(), from.data(), from.size()) == to.size();
}

/// A block's bytes; of `expected` of them where that is not 0.
Bytes block_of(const Xisf& xisf, const pugi::xml_node& node, std::int64_t expected) {
    const auto right_size = [&](std::int64_t size) {
        if (expected != 0 && size != expected)
            xisf.fail(fmt::format("{} bytes of data", expected), fmt::format("{}", size));
    };
    const std::vector<std::string> compression = fields_of(node, "compression");
    if (compression.size() < 2) {
        Bytes bytes = stored_bytes(xisf, node);
        check_sum(xisf, node, bytes);
        right_size(std::ssize(bytes));
        return bytes;
    }
    const bool shuffled = compression[0].ends_with("+sh");
    const std::string codec = compression[0].substr(0, compression[0].find('+'));
    constexpr std::array codecs{"zlib", "lz4", "lz4hc", "zstd"};
    if (std::ranges::find(codecs, codec) == codecs.end())
        xisf.fail(fmt::format("compression {}", fmt::join(codecs, ", ")), compression[0]);
    const std::int64_t size = count_of(xisf, compression[1], "an uncompressed size");
    right_size(size);
    const Bytes stored = stored_bytes(xisf, node);
    check_sum(xisf, node, stored);
    claim_memory(size, fmt::format("reading {}", xisf.file.string()));
    Bytes bytes(static_cast<std::size_t>(size));
    // "c1,u1:c2,u2": parts that are compressed one by one
    std::vector<std::string> parts = fields_of(node, "subblocks");
    if (parts[0].empty()) parts = {fmt::format("{},{}", stored.size(), size)};
    std::int64_t from = 0, to = 0;
    for (const std::string& part : parts) {
        const std::size_t comma = std::min(part.find(','), part.size() - 1);
        const std::int64_t packed = count_of(xisf, part.substr(0, comma), "a subblock"),
                           whole = count_of(xisf, part.substr(comma + 1), "a subblock");
        if (packed > std::ssize(stored) - from || whole > size - to ||
            !decompress(codec, {stored.data() + from, std::size_t(packed)},
                        {bytes.data() + to, std::size_t(whole)}))
            xisf.fail(fmt::format("{} bytes compressed by {}", size, codec), "something else");
        xisf.progress.check();
        from += packed;
        to += whole;
    }
    right_size(to);
    if (!shuffled || compression.size() < 3) return bytes;
    const std::int64_t item = count_of(xisf, compression[2], "the size of an item");
    if (item < 2) return bytes;
    Bytes plain(bytes);
    const std::int64_t items = size / item;
    for (std::int64_t b = 0; b < item; ++b)
        for (std::int64_t i = 0; i < items; ++i) plain[i * item + b] = bytes[b * items + i];
    return plain;
}

/// An image element.
struct XisfImage {
    pugi::xml_node node;
    std::string id;
    std::int64_t width = 0, height = 0, channels = 0;
    int bitpix = 0;  // as FITS has it, unsigned
    bool by_pixel = false, big_endian = false;
    bool rgb = false;

    std::int64_t bytes() const { return width * height * channels * (std::abs(bitpix) / 8); }
};

XisfImage image_of(const Xisf& xisf, const pugi::xml_node& node) {
    XisfImage image{node, node.attribute("id").value()};
    const std::vector<std::string> sides = fields_of(node, "geometry");
    if (sides.size() != 3) xisf.fail("an image of WIDTH:HEIGHT:CHANNELS", node.attribute("geometry").value());
    image.width = count_of(xisf, sides[0], "a width");
    image.height = count_of(xisf, sides[1], "a height");
    image.channels = count_of(xisf, sides[2], "channels");
    constexpr std::array<std::pair<std::string_view, int>, 6> formats{
        {{"UInt8", 8}, {"UInt16", 16}, {"UInt32", 32}, {"UInt64", 64}, {"Float32", -32}, {"Float64", -64}}};
    const std::string_view format = node.attribute("sampleFormat").value();
    const auto known = std::ranges::find(formats, format, &std::pair<std::string_view, int>::first);
    if (known == formats.end()) xisf.fail("samples of UInt8 to UInt64, Float32 or Float64", format);
    image.bitpix = known->second;
    std::int64_t count = image.width;
    constexpr std::int64_t most = std::int64_t{1} << 48;
    if (image.width < 1 || image.height < 1 || image.channels < 1 ||
        __builtin_mul_overflow(count, image.height, &count) ||
        __builtin_mul_overflow(count, image.channels, &count) || count > most)
        xisf.fail("a picture that fits into memory", node.attribute("geometry").value());
    image.by_pixel = std::string_view(node.attribute("pixelStorage").value()) == "Normal";
    image.big_endian = std::string_view(node.attribute("byteOrder").value()) == "big";
    const std::string_view space = node.attribute("colorSpace").value();
    image.rgb = space == "RGB" && image.channels >= 3;
    if (!space.empty() && space != "RGB" && space != "Gray") xisf.fail("colours of RGB or Gray", space);
    const std::string_view orientation = node.attribute("orientation").value();
    if (!orientation.empty() && orientation != "0")
        log_warning(fmt::format("{}: orientation = '{}' is not followed", xisf.file.string(), orientation));
    return image;
}

std::vector<pugi::xml_node> image_nodes(const Xisf& xisf) {
    std::vector<pugi::xml_node> nodes;
    for (const pugi::xml_node& node : xisf.header.child("xisf").children("Image")) nodes.push_back(node);
    if (nodes.empty()) xisf.fail("an image", "none");
    return nodes;
}

/// The image that is asked for, and its number.
std::pair<XisfImage, int> find_image(const Xisf& xisf, const std::string& wanted) {
    const std::vector<pugi::xml_node> nodes = image_nodes(xisf);
    if (wanted == "auto") {
        if (nodes.size() > 1)
            log_warning(fmt::format("{}: it holds {} pictures; 0 is taken (hdu = NUMBER or ID takes another)",
                                    xisf.file.string(), nodes.size()));
        return {image_of(xisf, nodes[0]), 0};
    }
    const std::optional<std::int64_t> number = parse_int64(wanted);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (number ? *number == std::int64_t(i)
                   : lower_case(nodes[i].attribute("id").value()) == lower_case(wanted))
            return {image_of(xisf, nodes[i]), int(i)};
    bad_input(xisf.file, fmt::format("one of {} images", nodes.size()), "hdu = " + wanted);
}

template <class T>
double value_at(const char* bytes, bool big_endian) {
    std::array<char, sizeof(T)> own{};
    std::copy_n(bytes, sizeof(T), own.begin());
    if (big_endian) std::ranges::reverse(own);
    return static_cast<double>(std::bit_cast<T>(own));
}
static_assert(std::endian::native == std::endian::little);

template <class T>
ValueReader reader_of(const XisfImage& image, std::shared_ptr<const Bytes> bytes) {
    return [=, pixels = image.width * image.height](std::int64_t first, std::int64_t count, double* values) {
        for (std::int64_t i = first; i < first + count; ++i) {  // planes one after the other
            const std::int64_t at = image.by_pixel ? i % pixels * image.channels + i / pixels : i;
            *values++ = value_at<T>(bytes->data() + at * std::int64_t(sizeof(T)), image.big_endian);
        }
    };
}

ValueReader read_values(const Xisf& xisf, const XisfImage& image) {
    const auto bytes = std::make_shared<const Bytes>(block_of(xisf, image.node, image.bytes()));
    if (image.bitpix == 8) return reader_of<std::uint8_t>(image, bytes);
    if (image.bitpix == 16) return reader_of<std::uint16_t>(image, bytes);
    if (image.bitpix == 32) return reader_of<std::uint32_t>(image, bytes);
    if (image.bitpix == 64) return reader_of<std::uint64_t>(image, bytes);
    return image.bitpix == -32 ? reader_of<float>(image, bytes) : reader_of<double>(image, bytes);
}

/// Numbers of a property, whose vectors are blocks.
std::vector<double> numbers_of(const Xisf& xisf, const XisfImage& image, const std::string& property) {
    const std::string id = "PCL:AstrometricSolution:" + property;
    const pugi::xml_node node = image.node.find_child_by_attribute("Property", "id", id.c_str());
    if (!node) return {};
    const Bytes bytes = block_of(xisf, node, 0);
    std::vector<double> numbers;
    for (std::size_t at = 0; at + 8 <= bytes.size(); at += 8)
        numbers.push_back(value_at<double>(bytes.data() + at,
                                           std::string_view(node.attribute("byteOrder").value()) == "big"));
    return numbers;
}

void add_card(std::string& cards, std::string_view name, std::string_view value) {
    std::string card = fmt::format("{:8}= {:>20}", name.substr(0, 8), value);
    card.resize(80, ' ');
    cards += card;
}

/// FITS' cards of an image; PixInsight's own solution of the sky where they tell none, whose pixels count
/// from the upper left corner.
std::string cards_of(const Xisf& xisf, const XisfImage& image) {
    std::string cards;
    bool has_sky = false;
    for (const pugi::xml_node& keyword : image.node.children("FITSKeyword")) {
        const std::string_view name = keyword.attribute("name").value();
        has_sky = has_sky || name == "CTYPE1";
        if (name != "HISTORY" && name != "COMMENT")
            add_card(cards, name, trim(keyword.attribute("value").value()));
    }
    const std::vector<double> sky = numbers_of(xisf, image, "ReferenceCelestialCoordinates"),
                              place = numbers_of(xisf, image, "ReferenceImageCoordinates"),
                              matrix = numbers_of(xisf, image, "LinearTransformationMatrix");
    if (has_sky || sky.size() != 2 || place.size() != 2 || matrix.size() != 4) return cards;
    const pugi::xml_node projection =
        image.node.find_child_by_attribute("Property", "id", "PCL:AstrometricSolution:ProjectionSystem");
    constexpr std::array<std::pair<std::string_view, const char*>, 6> systems{{{"Gnomonic", "TAN"},
                                                                               {"Stereographic", "STG"},
                                                                               {"PlateCarree", "CAR"},
                                                                               {"Mercator", "MER"},
                                                                               {"HammerAitoff", "AIT"},
                                                                               {"Orthographic", "SIN"}}};
    const std::string_view name = trim(std::string_view(
        projection.attribute("value") ? projection.attribute("value").value() : projection.text().get()));
    const auto system = std::ranges::find(systems, name, &std::pair<std::string_view, const char*>::first);
    if (system == systems.end()) return cards;
    if (image.node.find_child_by_attribute("Property", "id",
                                           "PCL:AstrometricSolution:SplineWorldTransformation"))
        log_warning(
            fmt::format("{}: the spline of its astrometric solution is not followed", xisf.file.string()));
    const auto number = [&](std::string_view key, double value) {
        add_card(cards, key, fmt::format("{:.17g}", value));
    };
    add_card(cards, "CTYPE1", fmt::format("'RA---{}'", system->second));
    add_card(cards, "CTYPE2", fmt::format("'DEC--{}'", system->second));
    number("CRVAL1", sky[0]);
    number("CRVAL2", sky[1]);
    number("CRPIX1", place[0] + 0.5);
    number("CRPIX2", double(image.height) - place[1] + 0.5);
    number("CD1_1", matrix[0]);
    number("CD1_2", -matrix[1]);
    number("CD2_1", matrix[2]);
    number("CD2_2", -matrix[3]);
    return cards;
}

/// An element in an image, or one of the document to which a Reference in it leads.
pugi::xml_node element_of(const XisfImage& image, const char* name) {
    if (const pugi::xml_node own = image.node.child(name)) return own;
    for (const pugi::xml_node& reference : image.node.children("Reference"))
        if (const pugi::xml_node shared =
                image.node.parent().find_child_by_attribute(name, "uid", reference.attribute("ref").value()))
            return shared;
    return {};
}

std::string keyword(const XisfImage& image, const char* name) {
    const pugi::xml_node node = image.node.find_child_by_attribute("FITSKeyword", "name", name);
    std::string value = node.attribute("value").value();
    std::erase(value, '\'');
    return std::string(trim(value));
}

ValueLayout layout_of(const Xisf& xisf, const XisfImage& image, std::optional<int> plane) {
    using Values = ValueLayout::Values;
    ValueLayout layout;
    layout.width = image.width;
    layout.height = image.height;
    layout.top_down = true;
    if (plane && (*plane < 0 || *plane >= image.channels))
        bad_input(xisf.file, fmt::format("a plane from 0 to {}", image.channels - 1),
                  fmt::format("plane = {}", *plane));
    layout.first = plane.value_or(0) * image.width * image.height;
    std::string mosaic = element_of(image, "ColorFilterArray").attribute("pattern").value();
    if (mosaic.empty() && image.channels == 1) mosaic = keyword(image, "BAYERPAT");
    const auto pattern = bayer_channels(mosaic, 0, 0);
    if (plane) return layout;
    if (image.rgb) layout.values = Values::planes;
    warn_of_channels(xisf.file, image.channels - (image.rgb ? 3 : 1), "its colours");
    if (pattern && image.channels == 1 && image.width > 1 && image.height > 1) {
        layout.values = Values::bayer;
        layout.pattern = *pattern;
        layout.what = "Bayer's mosaic " + mosaic;
    } else if (!mosaic.empty()) {
        log_warning(
            fmt::format("{}: its colour filter array '{}' is not followed: the picture stays as it is",
                        xisf.file.string(), mosaic));
    }
    return layout;
}

}  // namespace

bool is_xisf(const fs::path& file) {
    const FileFormat* const format = format_of_file(file);
    return format && format->id == "xisf";
}

FitsRows open_xisf_rows(const fs::path& file, const std::string& hdu, std::optional<int> plane,
                        const Progress& progress) {
    const Xisf xisf(file, progress);
    const auto [image, number] = find_image(xisf, hdu);
    const ValueLayout layout = layout_of(xisf, image, plane);
    FitsRows rows;
    FitsPlane& picture = rows.plane;
    picture.width = image.width;
    picture.height = image.height;
    picture.channels = layout.channels();
    picture.hdu = number;
    picture.name = image.id;
    picture.what = layout.what;
    picture.credit = keyword(image, "AUTHOR");
    picture.object = keyword(image, "OBJECT");
    picture.exposure = {
        keyword(image, "TELESCOP"), keyword(image, "INSTRUME"), "", "", keyword(image, "FILTER"), ""};
    if (picture.object.empty()) {
        const pugi::xml_node object =
            image.node.find_child_by_attribute("Property", "id", "Observation:Object:Name");
        picture.object = trim(std::string_view(object.text().get()));
    }
    picture.sky = read_fits_sky(file, cards_of(xisf, image), image.height, false);
    if (const pugi::xml_node profile = element_of(image, "ICCProfile")) {
        const Bytes bytes = block_of(xisf, profile, 0);
        std::string problem;
        picture.colors =
            icc_encoding({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, problem);
        if (!problem.empty()) log_warning(fmt::format("{}: its {} is not followed", file.string(), problem));
    }
    rows.read = rows_of_values(layout, read_values(xisf, image));
    return rows;
}

std::vector<FitsHdu> describe_xisf(const fs::path& file, const Progress& progress) {
    const Xisf xisf(file, progress);
    std::vector<FitsHdu> found;
    for (const pugi::xml_node& node : image_nodes(xisf)) {
        const XisfImage image = image_of(xisf, node);
        FitsHdu hdu;
        hdu.number = int(found.size());
        hdu.name = image.id;
        hdu.kind = "image";
        hdu.bitpix = image.bitpix;
        hdu.axes = {image.width, image.height, image.channels};
        hdu.picture = true;
        const ValueReader read = read_values(xisf, image);
        const std::int64_t count = image.width * image.height * image.channels;
        claim_memory(8 * count, fmt::format("reading {}", file.string()));
        Buffer<double> values(static_cast<std::size_t>(count));
        read(0, count, values.data());
        hdu.range = value_range(values);
        hdu.nan_count = std::ranges::count_if(values, [](double v) { return std::isnan(v); });
        found.push_back(std::move(hdu));
    }
    return found;
}

}  // namespace astrosplat

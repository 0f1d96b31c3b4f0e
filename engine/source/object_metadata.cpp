// XMP writes a property as an attribute of rdf:Description or as an element in it, a list as rdf:Seq, Bag or
// Alt of rdf:li; its prefixes are whatever the packet declares.
#include "source/object_metadata.h"

#include <fmt/format.h>
#include <unistd.h>

#include <pugixml.hpp>
#include <sstream>

#include "core/file.h"
#include "core/log.h"
#include "core/real.h"
#include "core/text.h"
#include "source/fits.h"

namespace astrosplat {
namespace {

constexpr std::string_view packet_begin = "<rdf:RDF", packet_end = "</rdf:RDF>";
constexpr std::size_t searched_bytes = std::size_t{4}
                                       << 20;  // at either end; published packets have up to 100 kB
constexpr const char* avm_space = "http://www.communicatingastronomy.org/avm/1.0/";
constexpr const char* dublin_core_space = "http://purl.org/dc/elements/1.1/";
constexpr const char* photoshop_space = "http://ns.adobe.com/photoshop/1.0/";
constexpr const char* rights_space = "http://ns.adobe.com/xap/1.0/rights/";
constexpr const char* contact_space = "http://iptc.org/std/Iptc4xmpCore/1.0/xmlns/";

// In the order of SpectralBlock.
constexpr std::array<const char*, 6> spectral_properties{
    "Facility",      "Instrument",        "Spectral.ColorAssignment",
    "Spectral.Band", "Spectral.Bandpass", "Spectral.CentralWavelength"};
constexpr const char* alternatives_kind = "rdf:Alt";  // of languages
constexpr std::size_t most_values = 256;              // of a list that is written
constexpr std::size_t most_titles = 8;
constexpr std::size_t longest_value = 4096;  // bytes

// A file's first and last bytes, one after the other; a small one is read whole.
std::string read_ends(const fs::path& file) {
    InputFile in(file);
    const auto size = std::size_t(std::max<std::int64_t>(0, in.size()));
    std::string bytes;
    const auto read_on = [&](std::size_t count) {
        const std::size_t before = bytes.size();
        bytes.resize(before + count);
        std::size_t have = before;
        for (std::size_t got = 1; got > 0; have += got)
            got = in.read(bytes.data() + have, bytes.size() - have);
        bytes.resize(have);
    };
    read_on(std::min(size, size > 2 * searched_bytes ? searched_bytes : size));
    if (size > bytes.size() && ::lseek(in.descriptor(), -static_cast<off_t>(searched_bytes), SEEK_END) >= 0)
        read_on(searched_bytes);
    return bytes;
}

// As UTF-8, without blanks at its ends, runs of them inside as one: packets are often indented.
std::string plain(std::string_view text) {
    std::string result;
    for (const char c : utf8_line(trim(text)))
        if (c != ' ' || result.back() != ' ') result += c;
    return result;
}

// The prefix that the packet declares for a namespace; `usual` where it declares none.
std::string prefix_of(const pugi::xml_node& root, std::string_view space, std::string usual) {
    struct Finder : pugi::xml_tree_walker {
        std::string_view space;
        std::string found;
        bool for_each(pugi::xml_node& node) override {
            for (const pugi::xml_attribute& a : node.attributes()) {
                const std::string_view name = a.name();
                if (name.starts_with("xmlns:") && space == a.value()) found = name.substr(6);
            }
            return found.empty();
        }
    } finder;
    finder.space = space;
    pugi::xml_node(root).traverse(finder);
    return finder.found.empty() ? std::move(usual) : finder.found;
}

class Properties {
  public:
    Properties(const pugi::xml_document& packet, const char* space, const char* usual_prefix)
        : rdf_(packet.child("rdf:RDF")), prefix_(prefix_of(packet, space, usual_prefix) + ":") {}

    /// All values of a property, without blanks at their ends; empty ones and "-", AVM's word for none, keep
    /// their places.
    std::vector<std::string> list(const char* property) const {
        const std::string name = prefix_ + property;
        std::vector<std::string> values;
        for (const pugi::xml_node& description : rdf_.children("rdf:Description")) {
            if (const pugi::xml_attribute value = description.attribute(name.c_str()))
                values.push_back(plain(value.value()));
            for (const pugi::xml_node& element : description.children(name.c_str())) add(element, values);
        }
        return values;
    }

    /// The first value that says anything.
    std::string text(const char* property) const {
        for (std::string& value : list(property))
            if (!value.empty() && value != "-") return std::move(value);
        return "";
    }

    std::optional<double> number(const char* property, std::size_t place = 0) const {
        const std::vector<std::string> values = list(property);
        const std::optional<double> value =
            place < values.size() ? parse_double(values[place]) : std::nullopt;
        return value && std::isfinite(*value) ? value : std::nullopt;
    }

    /// Of all properties of the schema, without its prefix.
    std::vector<std::string> names() const {
        std::vector<std::string> names;
        const auto add = [&](std::string_view name) {
            if (name.starts_with(prefix_)) names.emplace_back(name.substr(prefix_.size()));
        };
        for (const pugi::xml_node& description : rdf_.children("rdf:Description")) {
            for (const pugi::xml_attribute& a : description.attributes()) add(a.name());
            for (const pugi::xml_node& element : description.children()) add(element.name());
        }
        return names;
    }

  private:
    /// Items of lists; fields of structures, which are attributes or elements; or the text. AVM's are at most
    /// `levels` deep, and a damaged file's as deep as they like.
    static void add(const pugi::xml_node& element, std::vector<std::string>& values, int levels = 8) {
        const std::size_t before = values.size();
        for (const pugi::xml_attribute& a : element.attributes()) {
            const std::string_view name = a.name();
            if (name.find(':') != name.npos && !name.starts_with("xml") && !name.starts_with("rdf:"))
                values.push_back(plain(a.value()));
        }
        for (const pugi::xml_node& child : element.children())
            if (child.type() == pugi::node_element && levels > 0) add(child, values, levels - 1);
        if (values.size() == before) values.push_back(plain(element.text().get()));
    }

    pugi::xml_node rdf_;
    std::string prefix_;
};

// Light years; nothing in the sky is farther.
std::optional<double> if_distance(std::optional<double> value) {
    constexpr double farthest = 1e12;
    return value && *value > 0.0 && *value <= farthest ? value : std::nullopt;
}

std::vector<std::string> saying(std::vector<std::string> values) {
    std::erase_if(values, [](const std::string& value) { return value.empty() || value == "-"; });
    return values;
}

std::string first_of(std::string a, std::string b) { return a.empty() ? std::move(b) : std::move(a); }

std::optional<std::array<double, 2>> pair_of(const Properties& avm, const char* property) {
    const std::optional<double> a = avm.number(property, 0), b = avm.number(property, 1);
    return a && b ? std::optional(std::array{*a, *b}) : std::nullopt;
}

// Degrees of the sky to the east and to the north that a pixel to the right and one upwards are: CD1_1,
// CD1_2, CD2_1, CD2_2 of a FITS header.
using SkyMatrix = std::array<double, 4>;

// Towards north the right ascension stays: along (-east_up, east_right) / area.
void set_matrix(ObjectMetadata& found, const SkyMatrix& sky) {
    constexpr double least = 1e-15, most = 360.0;  // degrees a pixel; others are no picture's
    const auto& [east_right, east_up, north_right, north_up] = sky;
    const double area = east_right * north_up - east_up * north_right;
    const double width = std::hypot(east_right, north_right);
    const auto too_large = [](double degrees) { return !(std::fabs(degrees) <= most); };
    if (std::ranges::any_of(sky, too_large) || width < least || std::fabs(area) < least * least) return;
    found.degrees_per_px = width;
    found.north_angle = real::degrees(real::atan2(east_up / area, east_right / area));
}

// Spatial.Scale has the signs of CDELT, so that two positive ones are a mirrored picture, and
// Spatial.Rotation is CROTA2. One scale alone is of square pixels with east to the left.
void set_scale(ObjectMetadata& found, const Properties& avm) {
    std::optional<double> turn = avm.number("Spatial.Rotation");
    if (turn) turn = std::remainder(*turn, 360.0);
    found.north_angle = turn;
    const std::optional<double> right = avm.number("Spatial.Scale", 0), up = avm.number("Spatial.Scale", 1);
    if (!right) return;
    const double x = up ? *right : -std::fabs(*right), y = up.value_or(-x);
    const double angle = real::radians(turn.value_or(0.0)), c = real::cos(angle), s = real::sin(angle);
    set_matrix(found, {x * c, -y * s, x * s, y * c});
    if (!turn) found.north_angle.reset();
}

// AVM's older way, which has to have all four.
std::optional<SkyMatrix> matrix_of(const Properties& avm) {
    SkyMatrix matrix{};
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        const std::optional<double> value = avm.number("Spatial.CDMatrix", i);
        if (!value) return {};
        matrix[i] = *value;
    }
    return matrix;
}

void set_sky(ObjectMetadata& found, const Properties& avm) {
    set_scale(found, avm);
    const std::optional<SkyMatrix> matrix = matrix_of(avm);
    if (matrix && !found.degrees_per_px) set_matrix(found, *matrix);
    found.reference_px = pair_of(avm, "Spatial.ReferenceDimension").value_or(std::array{0.0, 0.0});
    found.sky_position = pair_of(avm, "Spatial.ReferenceValue");
    const std::string frame = avm.text("Spatial.CoordinateFrame");
    if (frame != "GAL" && frame != "SGAL" && frame != "ECL") return;
    found.north_angle.reset();  // of another north, and another place
    found.sky_position.reset();
}

// Lists that belong together, value by value; the longest tells how many there are.
std::vector<SpectralBlock> spectra_of(const Properties& avm) {
    std::vector<SpectralBlock> blocks;
    for (std::size_t i = 0; i < spectral_properties.size(); ++i) {
        const std::vector<std::string> values = avm.list(spectral_properties[i]);
        if (values.size() > blocks.size()) blocks.resize(std::min(values.size(), most_values));
        for (std::size_t k = 0; k < std::min(values.size(), blocks.size()); ++k)
            if (values[k] != "-") blocks[k][i] = values[k];
    }
    std::erase(blocks, SpectralBlock{});
    return blocks;
}

ObjectMetadata metadata_of(const pugi::xml_document& packet) {
    const Properties avm(packet, avm_space, "avm"), core(packet, dublin_core_space, "dc"),
        photoshop(packet, photoshop_space, "photoshop");
    ObjectMetadata found;
    found.categories = saying(avm.list("Subject.Category"));
    found.names = saying(avm.list("Subject.Name"));  // of AVM 1.0; since 1.1 it is dc:subject
    for (std::string& name : saying(core.list("subject"))) found.names.push_back(std::move(name));
    found.title = first_of(core.text("title"), photoshop.text("Headline"));
    found.credit = first_of(photoshop.text("Credit"), first_of(core.text("creator"), core.text("rights")));
    found.type = avm.text("Type");
    found.spectra = spectra_of(avm);
    found.urls = saying(avm.list("ReferenceURL"));
    for (std::string& url : saying(core.list("relation")))
        if (std::ranges::find(found.urls, url) == found.urls.end()) found.urls.push_back(std::move(url));
    found.distance_ly = if_distance(avm.number("Distance"));
    set_sky(found, avm);
    return found;
}

// The first with AVM, else the first one; without a child where there is none.
pugi::xml_document find_packet(std::string_view bytes) {
    pugi::xml_document first;
    for (std::size_t begin; (begin = bytes.find(packet_begin)) != std::string_view::npos;) {
        bytes.remove_prefix(begin);
        const std::size_t end = bytes.find(packet_end);
        if (end == std::string_view::npos) break;
        const std::size_t size = end + packet_end.size();
        pugi::xml_document packet;
        if (packet.load_buffer(bytes.data(), size, pugi::parse_default, pugi::encoding_utf8)) {
            if (!Properties(packet, avm_space, "avm").names().empty()) return packet;
            if (!first.first_child()) first = std::move(packet);
        }
        bytes.remove_prefix(size);
    }
    return first;
}

// Properties of AVM 1.2, with the schemas of others that it takes some from.
struct Wording {
    const char *space, *property, *group, *words;
};
constexpr Wording wordings[] = {
    {photoshop_space, "Source", "creator", "name"},
    {contact_space, "CreatorContactInfo", "creator", "contact"},
    {dublin_core_space, "creator", "creator", "contact name"},
    {photoshop_space, "Credit", "creator", "credit"},
    {rights_space, "UsageTerms", "creator", "rights"},
    {dublin_core_space, "rights", "creator", "copyright"},
    {dublin_core_space, "title", "image", "title"},
    {photoshop_space, "Headline", "image", "headline"},
    {dublin_core_space, "description", "image", "description"},
    {avm_space, "Type", "image", "type"},
    {avm_space, "Image.ProductQuality", "image", "quality"},
    {photoshop_space, "DateCreated", "image", "date"},
    {avm_space, "ID", "image", "ID"},
    {avm_space, "ReferenceURL", "image", "web page"},
    {dublin_core_space, "relation", "image", "web pages of all sources"},
    {avm_space, "Subject.Category", "subject", "category"},
    {avm_space, "Subject.Name", "subject", "names"},
    {dublin_core_space, "subject", "subject", "names"},
    {avm_space, "Distance", "subject", "distance, light years (then redshift)"},
    {avm_space, "Distance.Notes", "subject", "notes on distance"},
    {avm_space, "Facility", "observation", "facility"},
    {avm_space, "Instrument", "observation", "instrument"},
    {avm_space, "Spectral.ColorAssignment", "observation", "shown as"},
    {avm_space, "Spectral.Band", "observation", "band"},
    {avm_space, "Spectral.Bandpass", "observation", "filter"},
    {avm_space, "Spectral.CentralWavelength", "observation", "wavelength, nm"},
    {avm_space, "Spectral.Notes", "observation", "notes on colors"},
    {avm_space, "Temporal.StartTime", "observation", "began"},
    {avm_space, "Temporal.IntegrationTime", "observation", "exposure, s"},
    {avm_space, "DatasetID", "observation", "data sets"},
    {avm_space, "Spatial.CoordinateFrame", "spatial", "frame"},
    {avm_space, "Spatial.Equinox", "spatial", "equinox"},
    {avm_space, "Spatial.ReferenceValue", "spatial", "position, degrees"},
    {avm_space, "Spatial.ReferencePixel", "spatial", "at pixel"},
    {avm_space, "Spatial.ReferenceDimension", "spatial", "size of the original, px"},
    {avm_space, "Spatial.Scale", "spatial", "scale, degrees a pixel"},
    {avm_space, "Spatial.Rotation", "spatial", "rotation, degrees"},
    {avm_space, "Spatial.CDMatrix", "spatial", "matrix, degrees a pixel"},
    {avm_space, "Spatial.CoordsystemProjection", "spatial", "projection"},
    {avm_space, "Spatial.Quality", "spatial", "quality"},
    {avm_space, "Spatial.Notes", "spatial", "notes on the sky"},
    {avm_space, "Spatial.FITSheader", "spatial", "FITS header"},
    {avm_space, "Publisher", "publisher", "name"},
    {avm_space, "PublisherID", "publisher", "ID"},
    {avm_space, "ResourceID", "publisher", "resource"},
    {avm_space, "ResourceURL", "publisher", "file"},
    {avm_space, "RelatedResources", "publisher", "related"},
    {avm_space, "PublicationID", "publisher", "publications"},
    {avm_space, "ProposalID", "publisher", "proposals"},
    {avm_space, "MetadataDate", "publisher", "metadata of"},
    {avm_space, "MetadataVersion", "publisher", "version of AVM"}};

template <class T>
void add_once(std::vector<T>& all, const std::vector<T>& more, std::size_t most = most_values) {
    for (const T& value : more)
        if (all.size() < most && std::ranges::find(all, value) == all.end()) all.push_back(value);
}

}  // namespace

ObjectMetadata find_xmp_metadata(std::string_view bytes) {
    const pugi::xml_document packet = find_packet(bytes);
    return packet.first_child() ? metadata_of(packet) : ObjectMetadata{};
}

std::vector<AvmTag> find_avm_tags(std::string_view bytes) {
    const pugi::xml_document packet = find_packet(bytes);
    std::vector<AvmTag> tags;
    const auto add = [&](const char* group, const std::string& name, std::vector<std::string> values) {
        values = saying(std::move(values));
        if (!values.empty()) tags.push_back({group, name, std::move(values)});
    };
    for (const auto& [space, property, group, words] : wordings)
        add(group, words, Properties(packet, space, "").list(property));
    const Properties avm(packet, avm_space, "avm");
    for (const std::string& name : avm.names())
        if (std::ranges::none_of(wordings, [&](const Wording& w) { return w.property == name; }))
            add("other", name, avm.list(name.c_str()));
    return tags;
}

ObjectMetadata merged_metadata(std::span<const ObjectMetadata> pictures) {
    ObjectMetadata all;
    std::vector<std::string> titles, credits;
    bool distances_agree = true;
    for (const ObjectMetadata& picture : pictures) {
        add_once(all.categories, picture.categories);
        add_once(all.names, picture.names);
        add_once(all.spectra, picture.spectra);
        add_once(all.urls, picture.urls);
        add_once(titles, {utf8_line(picture.title, longest_value)}, most_titles);
        credits.push_back(utf8_line(picture.credit, longest_value));
        if (!all.distance_ly) all.distance_ly = picture.distance_ly;
        if (picture.distance_ly && picture.distance_ly != all.distance_ly) distances_agree = false;
    }
    if (!distances_agree) all.distance_ly.reset();
    all.title = joined_once(titles);
    all.credit = joined_once(credits);
    const bool simulated = !pictures.empty() && std::ranges::all_of(pictures, [](const ObjectMetadata& m) {
        return m.type == "Simulation";
    });
    all.type = simulated ? "Simulation" : "Artwork";
    return all;
}

std::string xmp_packet(const ObjectMetadata& m) {
    if (m == ObjectMetadata{}) return "";
    pugi::xml_document packet;
    pugi::xml_node root = packet.append_child("x:xmpmeta");
    root.append_attribute("xmlns:x") = "adobe:ns:meta/";
    pugi::xml_node rdf = root.append_child("rdf:RDF");
    rdf.append_attribute("xmlns:rdf") = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";
    pugi::xml_node description = rdf.append_child("rdf:Description");
    description.append_attribute("rdf:about") = "";
    description.append_attribute("xmlns:avm") = avm_space;
    description.append_attribute("xmlns:dc") = dublin_core_space;
    description.append_attribute("xmlns:photoshop") = photoshop_space;
    const auto text = [&](const char* property, const std::string& value) {
        if (!value.empty()) description.append_child(property).text() = utf8_line(value).c_str();
    };
    const auto add = [&](const char* property, const char* kind, const std::vector<std::string>& values) {
        if (std::ranges::all_of(values, &std::string::empty)) return;
        pugi::xml_node list = description.append_child(property).append_child(kind);
        for (const std::string& value : values) {
            pugi::xml_node item = list.append_child("rdf:li");
            item.text() = value.empty() ? "-" : utf8_line(value).c_str();
            if (kind == alternatives_kind) item.append_attribute("xml:lang") = "x-default";
        }
    };
    const auto number = [](double value) { return fmt::format("{}", value); };
    const auto add_pair = [&](const char* property, const std::array<double, 2>& pair) {
        add(property, "rdf:Seq", {number(pair[0]), number(pair[1])});
    };
    text("avm:MetadataVersion", "1.2");
    text("avm:ID", m.id);
    add("avm:Subject.Category", "rdf:Bag", m.categories);
    add("dc:subject", "rdf:Bag", m.names);
    add("dc:title", alternatives_kind, {m.title});
    text("photoshop:Credit", m.credit);
    text("avm:Type", m.type);
    if (!m.urls.empty()) text("avm:ReferenceURL", m.urls.front());  // which AVM has one of
    if (m.urls.size() > 1) add("dc:relation", "rdf:Bag", m.urls);
    for (std::size_t i = 0; i < spectral_properties.size(); ++i) {
        std::vector<std::string> values;
        for (const SpectralBlock& block : m.spectra) values.push_back(block[i]);
        add((std::string("avm:") + spectral_properties[i]).c_str(), "rdf:Seq", values);
    }
    if (m.distance_ly) add("avm:Distance", "rdf:Seq", {number(*m.distance_ly)});
    if (m.degrees_per_px) add_pair("avm:Spatial.Scale", {-*m.degrees_per_px, *m.degrees_per_px});
    if (m.north_angle) text("avm:Spatial.Rotation", number(*m.north_angle));
    if (m.reference_px[0] > 0.0) add_pair("avm:Spatial.ReferenceDimension", m.reference_px);
    if (m.sky_position) add_pair("avm:Spatial.ReferenceValue", *m.sky_position);
    std::ostringstream xml;
    packet.save(xml, "", pugi::format_raw | pugi::format_no_declaration);
    return "<?xpacket begin=\"\xef\xbb\xbf\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>" + xml.str() +
           "<?xpacket end=\"r\"?>";
}

std::vector<AvmTag> read_avm_tags(const fs::path& file) { return find_avm_tags(read_ends(file)); }

ObjectMetadata read_xmp_metadata(const fs::path& file) {
    const std::string bytes = read_ends(file);
    const pugi::xml_document packet = find_packet(bytes);
    if (packet.first_child()) return metadata_of(packet);
    if (bytes.find(packet_begin) != std::string::npos)
        log_warning(fmt::format("{}: its XMP packet is no XML and is not followed", file.string()));
    return {};
}

ObjectMetadata read_fits_metadata(const fs::path& file) {
    const QuietLog quiet;  // what is taken is said when it is read
    const FitsPlane plane = open_fits_rows(file, "auto", {}).plane;
    ObjectMetadata found;
    if (!plane.object.empty()) found.names.push_back(plane.object);
    found.credit = plane.credit;
    if (plane.exposure != SpectralBlock{}) found.spectra.push_back(plane.exposure);
    found.distance_ly = if_distance(plane.distance_ly);
    found.reference_px = {double(plane.width), double(plane.height)};
    if (!plane.sky.grid) return found;
    set_matrix(found, plane.sky.grid->degrees_per_px());
    const glm::dvec2 position = plane.sky.grid->reference_deg();
    found.sky_position = {position.x, position.y};
    return found;
}

std::optional<double> degrees_per_px_of(const ObjectMetadata& metadata, double width_px, double height_px) {
    if (!metadata.degrees_per_px || !(width_px > 0.0) || !(height_px > 0.0)) return {};
    const auto [reference_width, reference_height] = metadata.reference_px;
    const bool reduced = reference_width > 0.0 && reference_height > 0.0;
    const double times = reduced ? std::max(width_px / reference_width, height_px / reference_height) : 1.0;
    const double degrees = *metadata.degrees_per_px / times;
    return degrees * std::max(width_px, height_px) <= 360.0 ? std::optional(degrees) : std::nullopt;
}

}  // namespace astrosplat

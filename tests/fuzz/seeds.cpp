#include "fuzz/seeds.h"

#include <bzlib.h>
#include <fitsio.h>
#include <zlib.h>

#include <glm/geometric.hpp>

#include "camera_files/camera_track.h"
#include "camera_files/formats.h"
#include "core/text.h"
#include "fuzz/targets.h"
#include "source/object_metadata.h"
#include "splat_files/formats.h"
#include "stars/catalogue.h"
#include "stars/star_set.h"
#include "support/packed_captures.h"
#include "unit/stars/catalogues.h"

namespace astrosplat::fuzz {
namespace {

std::string ending_of(std::string_view bytes) {
    const auto has = [&](std::string_view part) { return bytes.find(part) != std::string_view::npos; };
    if (bytes.starts_with("glTF")) return ".glb";
    if (bytes.starts_with("{")) return has("transform_matrix") ? ".json" : ".gltf";
    if (bytes.starts_with("#usda")) return ".usda";
    if (bytes.starts_with("OpenSpace")) return ".osrectxt";
    return has("1548767330626") ? ".gsc" : ".chan";
}

std::string binary_gltf(std::string json) {
    while (json.size() % 4) json += ' ';
    return "glTF" + test::little_endian(2) + test::little_endian(20 + json.size()) +
           test::little_endian(json.size()) + "JSON" + json;
}

/// How much of it says something.
std::size_t check(const ObjectMetadata& found) {
    demand(!found.distance_ly || (*found.distance_ly > 0.0 && *found.distance_ly <= 1e12), "a distance");
    demand(!found.degrees_per_px || (*found.degrees_per_px > 0.0 && *found.degrees_per_px <= 1e3), "a scale");
    demand(!found.north_angle || std::fabs(*found.north_angle) <= 180.0, "an angle");
    if (found.sky_position)
        for (const double degrees : *found.sky_position) demand(std::isfinite(degrees), "a finite place");
    for (const auto& [width, height] : {std::pair(1.0, 1e5), std::pair(1e5, 3.0)}) {
        const std::optional<double> degrees = degrees_per_px_of(found, width, height);
        demand(!degrees || (*degrees >= 0.0 && *degrees * std::max(width, height) <= 360.0),
               "a part of the sky");
    }
    demand(find_xmp_metadata(xmp_packet(found)).names.size() == found.names.size(), "the names again");
    for (const auto& list : {found.categories, found.names, found.urls})
        for (const std::string& text : list) demand(!text.empty() && text != "-", "words");
    return found.categories.size() + found.names.size() + found.title.size() + found.credit.size() +
           found.type.size() + found.distance_ly.has_value() + found.degrees_per_px.has_value() +
           found.north_angle.has_value() + found.sky_position.has_value();
}

std::string xmp_packet(const std::string& attributes, const std::string& elements) {
    return "<?xpacket begin='\xef\xbb\xbf'?><x:xmpmeta xmlns:x='adobe:ns:meta/'><rdf:RDF "
           "xmlns:rdf='http://www.w3.org/1999/02/22-rdf-syntax-ns#'><rdf:Description "
           "xmlns:avm='http://www.communicatingastronomy.org/avm/1.0/' "
           "xmlns:dc='http://purl.org/dc/elements/1.1/' "
           "xmlns:photoshop='http://ns.adobe.com/photoshop/1.0/' " +
           attributes + ">" + elements + "</rdf:Description></rdf:RDF></x:xmpmeta><?xpacket end='w'?>";
}

std::size_t check(const CameraTrack& track) {
    demand(!track.samples.empty(), "a sample");
    for (const TrackSample& sample : track.samples) {
        demand(std::isfinite(sample.frame) && std::isfinite(sample.fov_deg) && std::isfinite(sample.height),
               "finite numbers");
        for (int i = 0; i < 3; ++i) demand(std::isfinite(sample.eye[i]), "a finite place");
        demand(std::fabs(glm::length(sample.rotation) - 1.0) < 1e-6, "a rotation of length 1");
    }
    for (std::size_t i = 1; i < track.samples.size(); ++i)
        demand(track.samples[i].frame > track.samples[i - 1].frame, "frames that ascend");
    return track.samples.size();
}

// As one member of a gzip file; zlib's header would hold the time if it were asked to.
std::string gzipped(const std::string& text) {
    std::string packed(compressBound(static_cast<uLong>(text.size())) + 32, '\0');
    z_stream stream{};
    demand(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) == Z_OK, "a compressor");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    demand(deflate(&stream, Z_FINISH) == Z_STREAM_END, "a gzip file");
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

bool all_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::size_t read_picture_bytes(const fs::path& file) {
    const PictureTable table = read_picture_table(file);
    demand(table.rows == table.bad.count + std::int64_t(table.stars.size()), "every row on one side");
    for (const TableStar& star : table.stars) {
        demand(std::isfinite(star.uv.x) && std::isfinite(star.uv.y) && std::isfinite(star.sigma_px),
               "places");
        demand(std::isfinite(star.luminance()) && star.luminance() > 0.0, "light");
    }
    return table.stars.size();
}

template <class Vector>
void demand_finite(const Vector& v) {
    for (int k = 0; k < v.length(); ++k) demand(std::isfinite(v[k]), "finite numbers");
}

std::size_t check_capture(const SplatSet& set) {
    const std::size_t size = set.position.size();
    demand(set.color.size() == size && set.alpha.size() == size && set.distance.size() == size &&
               set.id.size() == size && set.scale.size() == set.rotation.size(),
           "arrays of one length");
    demand(set.scale.empty() || (set.scale.size() == size && set.radius.size() == size), "a radius each");
    demand(set.harmonics.empty() || set.harmonics.size() == size, "harmonics each");
    for (std::size_t i = 0; i < set.scale.size(); ++i) {
        demand_finite(set.position[i]);
        demand_finite(set.color[i]);
        demand_finite(set.scale[i]);
        demand(std::isfinite(set.radius[i]), "a finite radius");
        demand(set.alpha[i] >= 0.0f && set.alpha[i] <= 1.0f, "an opacity");
        double length = 0.0;
        for (int k = 0; k < 4; ++k) length += double(set.rotation[i][k]) * set.rotation[i][k];
        demand(std::fabs(length - 1.0) < 1e-5, "rotations of length 1");
    }
    for (const Harmonics& harmonics : set.harmonics)
        for (const glm::vec3& c : harmonics.c) demand_finite(c);
    return size;
}

/// The same as text, with its bytes inside.
std::string text_of_glb(const std::string& glb) {
    const std::size_t binary = glb.find(std::string("BIN\0", 4));
    std::string json = glb.substr(20, binary - 24);
    const std::string buffer = "\"buffers\":[{";
    return json.insert(json.find(buffer) + buffer.size(), "\"uri\":\"data:application/octet-stream;base64," +
                                                              base64(glb.substr(binary + 4)) + "\",");
}

// Two stars: right ascension as a text.
std::string fits_table(int kind) {
    const TemporaryFile file("", ".fits");
    fs::remove(file.path);
    fitsfile* out = nullptr;
    int status = 0;
    const bool ascii = kind == ASCII_TBL;
    std::string names[] = {"RA", "DEC", "Vmag", "Plx"}, units[] = {"h:m:s", "deg", "mag", "mas"},
                forms[] = {ascii ? "A8" : "8A", ascii ? "F8.3" : "D", ascii ? "I6" : "I",
                           ascii ? "E12.4" : "E"};
    char *name[4], *form[4], *unit[4];
    for (int i = 0; i < 4; ++i)
        name[i] = names[i].data(), form[i] = forms[i].data(), unit[i] = units[i].data();
    std::string clock = "06:45:08";
    char* clocks[] = {clock.data(), clock.data()};
    double numbers[] = {3.0, 4.0};
    fits_create_diskfile(&out, file.path.c_str(), &status);
    fits_create_tbl(out, kind, 2, 4, name, form, unit, "STARS", &status);
    fits_write_col(out, TSTRING, 1, 1, 1, 2, clocks, &status);
    for (int column = 2; column <= 4; ++column)
        fits_write_col(out, TDOUBLE, column, 1, 1, 2, numbers, &status);
    fits_close_file(out, &status);
    demand(status == 0, "a FITS table");
    return test::bytes_of(file.path);
}

}  // namespace

std::vector<std::string> camera_seeds() {
    CameraTrack track;
    track.fps = 24.0;
    track.has_fov = true;
    track.samples = {{1.0, {0.0, 1.0, 2.0}, {0.0, 0.0, 0.0, 1.0}, 40.0, 0.0},
                     {2.0, {3.0, 1.0, 2.0}, {0.0, 0.6, 0.0, 0.8}, 40.0, 0.0}};
    const std::string gltf = gltf_text(track, 1.5, 0.1, 0.0);
    return {
        "# frame\n1 0 0 9 0 0 0 40\n2 0.5 -0.25 8 10 20 -30 42.5\n",
        "1548767330626 1 2 3 1 0 0 0 1 0\n1548767330626 2 2 3 0 0 -2 0.5 3 0\n",
        "OpenSpace_record/playback03.00A\nscript 0 0 1 x()\ncamera 0.5 7 1 2 3 0.8 0 0.6 0 0.1 - Venus\n"
        "camera 1.5 8 1e12 2 3 0.8 0 0.6 0 0.1 F Mars\n",
        gltf,
        binary_gltf(gltf),
        usda_text(track, {}),
        "#usda 1.0\n(\n upAxis = \"Z\"\n metersPerUnit = 0.01\n)\ndef Xform \"a\" (\n kind = 'x'\n)\n{\n"
        " float3 xformOp:rotateXYZ.timeSamples = { 0: (1, 2, 3), 4: (5, 6, 7) }\n"
        " double3 xformOp:translate = (1, 2, 3)\n"
        " uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateXYZ\"]\n"
        " def Camera \"c\"\n {\n float focalLength = 35\n rel r = </a>\n"
        " quatf xformOp:orient = (1, 0, 0, 0)\n uniform token[] xformOpOrder = [\"xformOp:orient\"]\n }\n}\n",
        R"({"camera_angle_x":0.7,"w":8,"h":6,"frames":[{"transform_matrix":[[0,0,-1,1],[-1,0,0,2],[0,1,0,3]]},)"
        R"({"fl_y":5,"transform_matrix":[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}]})"};
}

std::size_t read_camera_bytes(std::string_view bytes) {
    return check(read_camera(TemporaryFile(bytes, ending_of(bytes)).path, FrameRate{24.0, 0.0}));
}

std::string bzipped(std::string text) {
    unsigned size = unsigned(text.size()) + 1000;
    std::string packed(size, '\0');
    demand(
        BZ2_bzBuffToBuffCompress(packed.data(), &size, text.data(), unsigned(text.size()), 9, 0, 0) == BZ_OK,
        "a bzip2 file");
    return packed.substr(0, size);
}

std::vector<std::string> catalogue_seeds() {
    const std::string hipparcos =
        test::hipparcos_line({}) +
        test::hipparcos_line({"-1.44", "", "", "379.21", "", "06 45 08", "-16 42 58"});
    const std::string table =
        "\xef\xbb\xbfra;Dec;plx;\"vmag\";bv\r\n1;-2.5;10;3e0;\r\n# none\r\n359.9;90;-1;\"4\";~\r\n";
    const std::string hyg = std::string(test::hyg_header) +
                            "0,,,,,,Sol,0,0,0,0,0,0,-26.7,4.85,G2V,0.656,0,0,0\n"
                            "1,2,3,4,\"Gl, 5\",,,6.75,-16.7,100000,0,0,0,-1.44,1.4,A0,0.009,0,0,0\n";
    const std::string picture =
        "x,y,u,v,flux_r,flux_g,flux_b,sigma_px\n1,2,0.1,0.9,1,2,3,1.5\n3,4,.5,.5,-1,0,1e3,2\n";
    const auto votable = [](const std::string& data) {
        return "<VOTABLE><RESOURCE><TABLE><FIELD datatype='double' name='ra' unit='rad'/>"
               "<FIELD datatype='float' name='d' ucd='pos.eq.dec'/><FIELD datatype='short' "
               "name='mag'><VALUES null='9'/>"
               "</FIELD><FIELD datatype='char' arraysize='*' name='plx'/><DATA>" +
               data + "</DATA></TABLE></RESOURCE></VOTABLE>";
    };
    const std::string row = std::string("\x3f\xf0\0\0\0\0\0\0\x40\0\0\0\0\3\0\0\0\2", 18) + "10";
    return {
        hipparcos,
        table,
        hyg,
        gzipped(hipparcos + hipparcos),
        bzipped(table),
        picture,
        votable("<TABLEDATA><TR><TD>1</TD><TD>2</TD><TD>3</TD><TD>10</TD></TR></TABLEDATA>"),
        votable("<BINARY><STREAM>" + base64(row + row) + "</STREAM></BINARY>"),
        votable("<BINARY2><STREAM encoding='gzip'>" + base64(gzipped('\0' + row)) + "</STREAM></BINARY2>"),
        fits_table(BINARY_TBL),
        fits_table(ASCII_TBL)};
}

std::size_t read_catalogue_bytes(std::string_view bytes) {
    const TemporaryFile file(bytes, ".stars");
    if (kind_of_catalogue(file.path) == CatalogueKind::picture) return read_picture_bytes(file.path);
    const StarCatalogue catalogue = read_catalogue(file.path);
    demand(catalogue.rows == catalogue.bad.count + std::int64_t(catalogue.stars.size()),
           "every row on one side");
    const SplatSet set = star_set(catalogue, {1.0, 100.0, 4.0});
    check_consistent(set);
    demand(set.position.size() == catalogue.stars.size(), "every star");
    for (const glm::vec3& p : set.position) demand(all_finite(p) && p != glm::vec3(0.0f), "places");
    for (const glm::vec3& c : set.color)
        demand(all_finite(c) && c.x >= 0.0f && c.y >= 0.0f && c.z >= 0.0f, "light");
    return catalogue.stars.size();
}

std::vector<std::string> gaussian_ply_seeds() {
    using namespace astrosplat::test;
    return {ply_of(capture(3, 0), 0), ply_of(capture(2, 1), 1)};
}

std::vector<std::string> gltf_seeds() {
    using namespace astrosplat::test;
    const std::string turned =
        glb_of(capture(2, 1), 1, R"(,"rotation":[0,0.6,0,0.8],"scale":[2,2,2],"translation":[1,2,3])");
    return {glb_of(capture(3, 0), 0), turned, text_of_glb(turned)};
}

std::vector<std::string> usda_seeds() {
    using namespace astrosplat::test;
    return {
        usda_of(capture(3, 0), 0),
        usda_of(capture(2, 1), 1,
                "        quatf xformOp:orient = (0.8, 0, 0.6, 0)\n        float3 xformOp:scale = (2, 2, 2)\n"
                "        uniform token[] xformOpOrder = [\"xformOp:orient\", \"xformOp:scale\"]\n",
                "    upAxis = \"Z\"\n")};
}

std::vector<std::string> spz_seeds() {
    using namespace astrosplat::test;
    const std::string axes = number_bytes(0xadbe0003, 4) + number_bytes(4, 4) + number_bytes(14, 4);
    return {spz_of(capture(3, 0), 0, 1), spz_of(capture(3, 1), 1, 2), spz_of(capture(3, 3), 3, 3, axes),
            spz_of(capture(3, 0), 0, 4), spz_of(capture(2, 1), 1, 4, axes)};
}

std::vector<std::string> compressed_ply_seeds() {
    using namespace astrosplat::test;
    return {compressed_ply_of(capture(3, 0), 0, false), compressed_ply_of(capture(2, 1), 1)};
}

std::vector<std::string> dot_splat_seeds() { return {test::dot_splat_of(test::capture(3, 0))}; }

std::vector<std::string> sog_seeds() {
    using namespace astrosplat::test;
    return {sog_of(capture(3, 0), 0), sog_of(capture(2, 1), 1, true)};
}

std::size_t read_spz_bytes(std::string_view bytes) {
    return check_capture(read_spz(TemporaryFile(bytes, ".spz").path));
}

std::size_t read_dot_splat_bytes(std::string_view bytes) {
    return check_capture(read_dot_splat(TemporaryFile(bytes, ".splat").path));
}

std::size_t read_sog_bytes(std::string_view bytes) {
    return check_capture(read_sog(TemporaryFile(bytes, ".sog").path));
}

std::size_t read_gaussian_ply_bytes(std::string_view bytes) {
    return check_capture(read_ply(TemporaryFile(bytes, ".ply").path));
}

std::size_t read_usda_bytes(std::string_view bytes) {
    return check_capture(read_usda_splats(TemporaryFile(bytes, ".usda").path));
}

std::size_t read_gltf_bytes(std::string_view bytes) {
    return check_capture(
        read_gltf_splats(TemporaryFile(bytes, bytes.starts_with("{") ? ".gltf" : ".glb").path));
}

std::string fits(const std::vector<std::string>& cards) {
    std::string bytes;
    for (std::string card : cards) {
        card.resize(80, ' ');
        bytes += card;
    }
    bytes.resize((bytes.size() + 2879) / 2880 * 2880, ' ');
    for (int i = 0; i < 12; ++i) bytes += std::string{char(i % 3), char(i * 21)};
    bytes.resize((bytes.size() + 2879) / 2880 * 2880, '\0');
    return bytes;
}

std::vector<std::string> xmp_seeds() {
    const std::string lists = xmp_packet(
        "avm:Type='Observation' avm:Spatial.Rotation='-30' avm:Spatial.CoordinateFrame='ICRS'",
        "<avm:Subject.Category><rdf:Bag><rdf:li>C.5.1.1</rdf:li><rdf:li>-</rdf:li></rdf:Bag>"
        "</avm:Subject.Category><avm:Distance><rdf:Seq><rdf:li>4.6e7</rdf:li><rdf:li>0.002</rdf:li></rdf:Seq>"
        "</avm:Distance><avm:Spatial.Scale><rdf:Seq><rdf:li>-1e-5</rdf:li><rdf:li>1e-5</rdf:li></rdf:Seq>"
        "</avm:Spatial.Scale><avm:Spatial.ReferenceDimension><rdf:Seq><rdf:li>400</rdf:li><rdf:li>300</"
        "rdf:li>"
        "</rdf:Seq></avm:Spatial.ReferenceDimension><avm:Spatial.ReferenceValue><rdf:Seq><rdf:li>140.5</"
        "rdf:li>"
        "<rdf:li>-51</rdf:li></rdf:Seq></avm:Spatial.ReferenceValue>"
        "<dc:title><rdf:Alt><rdf:li xml:lang='x-default'>A\n  spiral</rdf:li></rdf:Alt></dc:title>");
    const std::string matrix = xmp_packet(
        "photoshop:Credit='A &amp; B' avm:Distance='1300'",
        "<avm:Spatial.CDMatrix><rdf:Seq><rdf:li>-8e-5</rdf:li><rdf:li>-6e-5</rdf:li><rdf:li>-6e-5</rdf:li>"
        "<rdf:li>8e-5</rdf:li></rdf:Seq></avm:Spatial.CDMatrix><avm:Subject.Name>M 42</avm:Subject.Name>");
    return {lists, std::string("\xff\xd8\xff\xe1 <rdf:RDF><a></rdf:RDF>", 27) + matrix + lists};
}

std::size_t read_xmp_bytes(std::string_view bytes) {
    for (const AvmTag& tag : find_avm_tags(bytes)) demand(!tag.values.empty(), "values of a tag");
    return check(read_xmp_metadata(TemporaryFile(bytes, ".jpg").path));
}

std::vector<std::string> fits_metadata_seeds() {
    const std::vector<std::string> picture{"SIMPLE  =                    T",
                                           "BITPIX  =                   16",
                                           "NAXIS   =                    2",
                                           "NAXIS1  =                    4",
                                           "NAXIS2  =                    3",
                                           "OBJECT  = 'M 51    '",
                                           "DISTANCE=                  8.6 / [Mpc] to it",
                                           "CTYPE1  = 'RA---TAN'",
                                           "CTYPE2  = 'DEC--TAN'",
                                           "CRPIX1  =                  2.0",
                                           "CRPIX2  =                  1.5",
                                           "CRVAL1  =                202.5",
                                           "CRVAL2  =                 47.2"};
    const auto with = [&](std::vector<std::string> cards) {
        cards.insert(cards.begin(), picture.begin(), picture.end());
        cards.emplace_back("END");
        return fits(cards);
    };
    return {with({"CD1_1   =              -8.0E-5", "CD1_2   =              -6.0E-5",
                  "CD2_1   =              -6.0E-5", "CD2_2   =               8.0E-5"}),
            with({"CDELT1  =              -1.0E-4", "CDELT2  =               1.0E-4",
                  "CROTA2  =                 30.0"})};
}

std::size_t read_fits_metadata_bytes(std::string_view bytes) {
    return check(read_fits_metadata(TemporaryFile(bytes, ".fits").path));
}

}  // namespace astrosplat::fuzz

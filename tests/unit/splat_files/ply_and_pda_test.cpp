// PLY and PDA.

#include <csignal>

#include "splat_files/formats.h"
#include "splat_files/ply_bytes.h"
#include "support/test_data.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

/// Bytes of a number, in the file's order.
template <class T>
std::string raw(T value, bool big = false) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    if (big) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

class Ply : public SplatFileTest {
  protected:
    SplatSet read(const std::string& bytes) { return read_ply(write("a.ply", bytes)); }
    std::string error(const std::string& bytes) {
        return error_of(write("a.ply", bytes), [](const auto& file) { read_ply(file); });
    }
    static std::string header(const std::string& format, const std::string& body) {
        return "ply\nformat " + format + " 1.0\n" + body + "end_header\n";
    }
    static std::string vertex(const std::string& count, const std::string& more = "") {
        return "element vertex " + count + "\nproperty float x\nproperty float y\nproperty float z\n" + more;
    }
    static std::string xyz(bool big = false) { return raw(1.0f, big) + raw(2.0f, big) + raw(3.0f, big); }
};

TEST_F(Ply, AHeaderIsDataBeforeAnyRowIsRead) {
    const std::string text =
        "ply\r\nformat binary_big_endian 1.0\r\ncomment credit: NASA, ESA \nelement face 2\nproperty list "
        "uchar int corners\nelement vertex 3\nproperty double x\nend_header\nDATA";
    const PlyHeader header = read_ply_header("a.ply", text);
    EXPECT_EQ(header.format, PlyFormat::big_endian);
    EXPECT_EQ(header.credit, "NASA, ESA");
    EXPECT_EQ(header.data, "DATA");
    EXPECT_EQ(header.data_line, 9);
    ASSERT_EQ(header.elements.size(), 2u);
    EXPECT_EQ(header.elements[0].count, 2u);
    EXPECT_TRUE(header.elements[0].properties.at(0).list);
    EXPECT_EQ(header.elements[0].properties[0].list_count, NumberType::u8);
    EXPECT_EQ(header.elements[1].properties.at(0).name, "x");
    EXPECT_EQ(header.elements[1].properties[0].type, NumberType::f64);
}

TEST_F(Ply, WritesAHeaderOthersRead) {
    SplatSet set = awkward_set(1);
    set.id[0] = 5;
    set.normal.clear();
    set.credit = "ESA\nHubble";
    set.origin = "measured: light";
    write_ply(path("a.ply"), set);
    const std::string bytes = bytes_of(path("a.ply"));
    const std::string expected =
        "ply\nformat binary_little_endian 1.0\ncomment credit: ESA Hubble\ncomment origin: measured: light\n"
        "element vertex 1\nproperty float x\n"
        "property float y\nproperty float z\nproperty float red\nproperty float green\nproperty float blue\n"
        "property float alpha\nproperty float distance\nproperty float radius\nproperty float s\nproperty "
        "float t\n"
        "property uint mesh\nproperty uint id\nend_header\n";
    EXPECT_EQ(bytes.substr(0, expected.size()), expected);
    EXPECT_EQ(bytes.size(), expected.size() + 13 * 4);
    EXPECT_EQ(read_ply(path("a.ply")).credit, "ESA Hubble");
    EXPECT_EQ(read_ply(path("a.ply")).origin, "measured: light");
}

TEST_F(Ply, EveryBitSurvives) {
    const SplatSet set = awkward_set(50000);
    write_ply(path("a.ply"), set);
    const SplatSet got = read_ply(path("a.ply"));
    expect_same_splats(got, set);
    EXPECT_TRUE(same_bits(got.uv, set.uv));
}

TEST_F(Ply, OptionalArraysStayUnknown) {
    SplatSet set = awkward_set(10);
    set.radius.clear();
    set.mesh.clear();
    set.uv.clear();
    write_ply(path("a.ply"), set);
    const SplatSet got = read_ply(path("a.ply"));
    expect_same_splats(got, set);
    EXPECT_TRUE(got.uv.empty());
    write_ply(path("a.ply"), SplatSet{});
    EXPECT_EQ(read_ply(path("a.ply")).size(), 0);
}

TEST_F(Ply, AsciiWithColourCodesAndFaces) {
    const SplatSet set =
        read(header("ascii", "comment by hand\nobj_info x\n" +
                                 vertex("2",
                                        "property uchar red\nproperty uchar green\n"
                                        "property uchar blue\nproperty uchar alpha\n"
                                        "property float confidence\nproperty list uchar int links\n") +
                                 "element face 1\nproperty list uchar int vertex_indices\n") +
             "1 2 3 255 0 188 51 9 0\n4 5 6.5 0 10 11 255 9 3 7 8 9\n3 0 1 1\n");
    ASSERT_EQ(set.size(), 2);
    EXPECT_EQ(set.position[1], glm::vec3(4, 5, 6.5f));
    EXPECT_EQ(set.color[0].x, 1.0f);
    EXPECT_EQ(set.color[0].y, 0.0f);
    EXPECT_NEAR(set.color[0].z, std::pow((188.0 / 255.0 + 0.055) / 1.055, 2.4), 1e-7);
    EXPECT_NEAR(set.color[1].y, 10.0 / 255.0 / 12.92, 1e-9);
    EXPECT_EQ(set.alpha[0], 0.2f);
}

TEST_F(Ply, BigEndianOfAllTypes) {
    const std::string body =
        "element edge 1\nproperty short a\nelement vertex 1\nproperty double x\nproperty int16 y\nproperty "
        "char z\n"
        "property ushort red\nproperty ushort green\nproperty ushort blue\nproperty double alpha\n"
        "property double radius\nproperty int distance\nproperty double id\nproperty list int float "
        "skipped\n";
    const std::string row = raw(0.1, true) + raw(std::int16_t{-300}, true) + raw(std::int8_t{-5}) +
                            raw(std::uint16_t{65535}, true) + raw(std::uint16_t{0}, true) +
                            raw(std::uint16_t{65535}, true) + raw(0.25, true) + raw(2.5, true) +
                            raw(7, true) + raw(9007199254740992.0, true) + raw(1, true) + raw(1.0f, true);
    const SplatSet set = read(header("binary_big_endian", body) + raw(std::int16_t{1}, true) + row);
    ASSERT_EQ(set.size(), 1);
    EXPECT_EQ(set.position[0], glm::vec3(0.1f, -300, -5));
    EXPECT_EQ(set.color[0], glm::vec3(1, 0, 1));
    EXPECT_EQ(set.alpha[0], 0.25f);
    EXPECT_EQ(set.radius[0], 2.5f);
    EXPECT_EQ(set.distance[0], 7.0f);
    EXPECT_EQ(set.max_distance, 7.0);
    EXPECT_EQ(set.id[0], 9007199254740992u);
}

TEST_F(Ply, ElementsWithListsBeforeTheVertices) {
    const std::string body = "element face 2\nproperty list uchar int i\n" + vertex("1");
    const std::string faces = "\x03" + raw(1) + raw(2) + raw(3) + std::string(1, '\0');
    EXPECT_EQ(read(header("binary_little_endian", body) + faces + xyz()).position[0], glm::vec3(1, 2, 3));
    EXPECT_EQ(read(header("ascii", body) + "3 1 2 3\n0\n1 2 3\n").position[0], glm::vec3(1, 2, 3));
}

TEST_F(Ply, IdsOfSixtyFourBits) {
    const std::string halves =
        header("binary_little_endian", vertex("1", "property uint id_high\nproperty uint id\n"));
    EXPECT_EQ(read(halves + xyz() + raw(0x12345678u) + raw(0x9abcdef0u)).id[0], 0x123456789abcdef0u);
    const std::string wide = header("binary_little_endian", vertex("1", "property uint64 id\n"));
    EXPECT_EQ(read(wide + xyz() + raw(~0ull)).id[0], ~0ull);
}

TEST_F(Ply, WindowsLineEndsAndDefaults) {
    const SplatSet set = read(
        "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float y\r\n"
        "property float z\r\nproperty float red\r\nend_header\r\n1 2 3 0.5\r\n");
    EXPECT_EQ(set.position[0], glm::vec3(1, 2, 3));
    EXPECT_EQ(set.color[0], glm::vec3(1.0f));  // red alone is no colour
    EXPECT_EQ(set.alpha[0], 1.0f);
    EXPECT_EQ(set.id[0], 0u);
    EXPECT_TRUE(set.radius.empty());
}

/// An ASCII file of one vertex at the origin.
std::string one_vertex(const std::string& properties, const std::string& values) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    std::istringstream words(properties);
    for (std::string word; words >> word;) text += "property float " + word + "\n";
    return text + "end_header\n0 0 0 " + values + "\n";
}

TEST_F(Ply, OtherNamesOfColours) {
    const glm::vec3 color(0.25f, 0.5f, 0.75f);
    EXPECT_EQ(read(one_vertex("diffuse_red diffuse_green diffuse_blue", "0.25 0.5 0.75")).color[0], color);
    const SplatSet rgba = read(one_vertex("a b g r", "0.125 0.75 0.5 0.25"));
    EXPECT_EQ(rgba.color[0], color);
    EXPECT_EQ(rgba.alpha[0], 0.125f);
    // Of two the usual names count, whatever their order; of an incomplete one nothing.
    EXPECT_EQ(read(one_vertex("r g b red green blue a alpha", "9 9 9 0.25 0.5 0.75 0 0.5")).color[0], color);
    EXPECT_EQ(read(one_vertex("r g b red green blue a alpha", "9 9 9 0.25 0.5 0.75 0 0.5")).alpha[0], 0.5f);
    EXPECT_EQ(read(one_vertex("red green r g b", "9 9 0.25 0.5 0.75")).color[0], color);
    EXPECT_EQ(read(one_vertex("r g", "0 0")).color[0], glm::vec3(1.0f));
}

TEST_F(Ply, WrongHeaders) {
    EXPECT_EQ(error(""), "a.ply:1: expected 'ply', found ''");
    EXPECT_EQ(error("plywood\n"), "a.ply:1: expected 'ply', found 'plywood'");
    EXPECT_EQ(error("ply\nelement vertex 1\n"),
              "a.ply:2: expected 'format ascii 1.0', binary_little_endian or binary_big_endian, found "
              "'element vertex 1'");
    EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex 1\n"),
              "a.ply:4: expected 'end_header', found the end of the file");
    EXPECT_EQ(error(header("ascii", "element vertex\n")),
              "a.ply:3: expected 'element NAME COUNT', found 'element vertex'");
    EXPECT_EQ(error(header("ascii", "element vertex -1\n")),
              "a.ply:3: expected a number of elements, found '-1'");
    EXPECT_EQ(error(header("ascii", "element vertex 1\nproperty half x\n")),
              "a.ply:4: expected a number type such as float or uchar, found 'half'");
    EXPECT_EQ(error(header("ascii", "element vertex 1\nproperty x\n")),
              "a.ply:4: expected 'property TYPE NAME', found 'property x'");
    EXPECT_EQ(error(header("ascii", "element vertex 1\nproperty list float int x\n")),
              "a.ply:4: expected a whole number as the list's count, found 'float'");
    EXPECT_EQ(error(header("ascii", "element vertex 1\nproperty float x\nproperty int x\n")),
              "a.ply:5: expected each property once, found 'x'");
    EXPECT_EQ(error(header("ascii", "property float x\n")),
              "a.ply:3: expected element, property, comment or end_header, found 'property float x'");
    EXPECT_EQ(error(header("ascii", "element face 0\n")), "a.ply: expected an element vertex, found none");
    EXPECT_EQ(error(header("ascii", "element vertex 0\nproperty float x\nproperty float y\n")),
              "a.ply: expected vertex properties x, y and z, found no z");
    EXPECT_EQ(error(header("ascii", vertex("0", "property int alpha\n"))),
              "a.ply: expected alpha as float, double, uchar or ushort, found another type");
}

TEST_F(Ply, WrongCounts) {
    const std::string huge = "1000000000000000000";
    EXPECT_EQ(error(header("binary_little_endian", vertex(huge)) + xyz()),
              "a.ply: expected " + huge + " vertex elements, as the header says, found the end of the file");
    EXPECT_EQ(error(header("binary_little_endian", vertex("2")) + xyz() + "12345678901"),
              "a.ply: expected 2 vertex elements, as the header says, found the end of the file");
    EXPECT_EQ(error(header("ascii", vertex(huge)) + "1 2 3\n"),
              "a.ply: expected " + huge + " rows of element vertex, found 1");
    EXPECT_EQ(error(header("ascii", vertex("1")) + "1 2 3\n4 5 6\n"),
              "a.ply: expected as many rows as the header says, found 1 more");
    const std::string list =
        header("binary_little_endian", vertex("1", "property list int uchar l\n")) + xyz();
    for (const int count : {-1, 2, 2147483647})
        EXPECT_EQ(error(list + raw(count) + "x"),
                  "a.ply: expected 1 vertex elements, as the header says, found the end of the file");
}

TEST_F(Ply, WrongValues) {
    const std::string binary =
        header("binary_little_endian", vertex("1", "property float radius\nproperty int id\n"));
    EXPECT_EQ(error(binary + raw(1.0f) + raw(NAN) + raw(1.0f) + raw(1.0f) + raw(1)),
              "a.ply:vertex 0: expected a finite number for y, found nan");
    EXPECT_EQ(error(binary + xyz() + raw(-1.0f) + raw(1)),
              "a.ply:vertex 0: expected a finite number >= 0 for radius, found -1");
    EXPECT_EQ(error(binary + xyz() + raw(1.0f) + raw(-7)),
              "a.ply:vertex 0: expected a whole number >= 0 for id, found -7");
    EXPECT_EQ(error(header("ascii", vertex("1")) + "1 2 z\n"),
              "a.ply:8: expected a finite number for z, found 'z'");
    EXPECT_EQ(error(header("ascii", vertex("1")) + "1 2 3 4\n"),
              "a.ply:8: expected 3 numbers (x y z), found 4");
    const std::string codes = vertex("1", "property uchar red\nproperty uchar green\nproperty uchar blue\n");
    EXPECT_EQ(error(header("ascii", codes) + "1 2 3 0 256 0\n"),
              "a.ply:11: expected a whole number 0..255 for green, found '256'");
    EXPECT_EQ(error(header("ascii", codes) + "1 2 3 0 0.5 0\n"),
              "a.ply:11: expected a whole number 0..255 for green, found '0.5'");
}

TEST_F(Ply, TheFirstWrongVertexIsNamedWhateverItsColumn) {
    std::string bytes = header("binary_little_endian", vertex("90000", "property float radius\n"));
    for (int i = 0; i < 90000; ++i)
        bytes += raw(i == 70001 || i == 80000 ? INFINITY : 1.0f) + raw(2.0f) + raw(3.0f) +
                 raw(i == 70000 ? -1.0f : 4.0f);
    for (const int threads : {1, 4}) {
        set_thread_count(threads);
        EXPECT_EQ(error(bytes), "a.ply:vertex 70000: expected a finite number >= 0 for radius, found -1");
    }
}

TEST_F(Ply, OpacitiesOutsideAreClampedAndCountedOnce) {
    for (const bool wide : {false, true}) {
        const int rows = wide ? 1000 : 900;  // the same warning is not given twice
        const std::string type = wide ? "property double alpha\n" : "property float alpha\n";
        std::string bytes = header("binary_little_endian", vertex(std::to_string(rows), type));
        for (int i = 0; i < rows; ++i) {
            const float alpha = i == 3 ? -0.5f : i >= rows - 2 ? 1.5f : 0.25f;
            bytes += xyz() + (wide ? raw(double{alpha}) : raw(alpha));
        }
        const Said said;
        const SplatSet set = read(bytes);
        EXPECT_EQ(set.alpha[2], 0.25f);
        EXPECT_EQ(set.alpha[3], 0.0f);
        EXPECT_EQ(set.alpha.back(), 1.0f);
        EXPECT_HAS(said.text(), fmt::format("3 of {} opacities lie outside 0..1", rows));
    }
}

TEST_F(Ply, EveryTruncationIsAnError) {
    write_ply(path("whole.ply"), awkward_set(2));
    const std::string whole = bytes_of(path("whole.ply"));
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_NE(error(whole.substr(0, size)), "") << size;
}

// PDA: exact round trips, everything a header may look like, and one test for each thing that can be wrong.

class Pda : public SplatFileTest {
  protected:
    SplatSet read(const std::string& text) { return read_pda(write("a.pda", text)); }
    std::string error(const std::string& text) {
        return error_of(write("a.pda", text), [](const auto& file) { read_pda(file); });
    }
    /// A file with one attribute besides position and one row.
    static std::string one(const std::string& attribute, const std::string& type, const std::string& value) {
        return "ATTRIBUTES\n position " + attribute + "\nTYPES\n V " + type +
               "\nNUMBER_OF_PARTICLES: 1\nBEGIN DATA\n1 2 3 " + value + "\n";
    }
    static std::string positions(const std::string& count, const std::string& rows) {
        return "ATTRIBUTES\n position\nTYPES\n V\nNUMBER_OF_PARTICLES: " + count + "\nBEGIN DATA\n" + rows;
    }
};

TEST_F(Pda, WritesWhatMayaReads) {
    SplatSet set;
    set.position.push_back({0.1f, -0.0f, 1e-5f});
    set.color.push_back({1.0f, 0.5f, 16777216.0f});
    set.alpha.push_back(0.25f);
    set.distance.push_back(0.0f);
    set.id.push_back(~0ull);
    set.mesh.push_back(2);
    write_pda(path("a.pda"), set);
    EXPECT_EQ(bytes_of(path("a.pda")),
              "ATTRIBUTES\n position rgbPP opacityPP DistanceFromSurfaceMeshPP whichMeshPP particleId\n"
              "TYPES\n V V R R I I\nNUMBER_OF_PARTICLES: 1\nBEGIN DATA\n"
              "0.1 -0 1e-05 1 0.5 16777216 0.25 0 2 18446744073709551615\n");
}

TEST_F(Pda, EveryBitSurvives) {
    const SplatSet set = awkward_set(50000);
    write_pda(path("a.pda"), set);
    const SplatSet got = read_pda(path("a.pda"));
    expect_same_splats(got, set);
    EXPECT_TRUE(got.uv.empty());
    EXPECT_TRUE(got.normal.empty());
    EXPECT_FALSE(got.generated);
}

TEST_F(Pda, ParticleIdCountsMoreThanId) {
    const std::string rows = "\nNUMBER_OF_PARTICLES: 1\nBEGIN DATA\n0 0 0 5 7\n";
    EXPECT_EQ(read("ATTRIBUTES\n position id particleId\nTYPES\n V I I" + rows).id[0], 7u);
    EXPECT_EQ(read("ATTRIBUTES\n position particleId id\nTYPES\n V I I" + rows).id[0], 5u);
    EXPECT_EQ(read("ATTRIBUTES\n position other id\nTYPES\n V I I" + rows).id[0], 7u);
    EXPECT_EQ(read(one("id", "R", "5.0")).id[0], 5u);
}

TEST_F(Pda, EmptySetSurvives) {
    write_pda(path("a.pda"), SplatSet{});
    EXPECT_EQ(read_pda(path("a.pda")).size(), 0);
}

TEST_F(Pda, LocaleDoesNotMatter) {
    const SplatSet set = awkward_set(2000);
    write_pda(path("plain.pda"), set);
    {
        const CommaLocale locale;
        write_pda(path("comma.pda"), set);
        expect_same_splats(read_pda(path("plain.pda")), set);
    }
    EXPECT_EQ(bytes_of(path("comma.pda")), bytes_of(path("plain.pda")));
}

TEST_F(Pda, AttributesInAnyOrderAndOthersSkippedByType) {
    const SplatSet set = read(
        "ATTRIBUTES\n particleId velocity opacityPP rgbPP lifespan whichMeshPP event position radiusPP "
        "DistanceFromSurfaceMeshPP\nTYPES\n I V R V R R I V R R\nNUMBER_OF_PARTICLES: 2\nBEGIN DATA\n"
        "9007199254740993 7 7 7 0.5 1 2 3 nan 4 8 10 20 30 0.75 0.125\n"
        "3 7 7 7 1 1 2 3 9 5 8 11 21 31 0.5 0.25\n");
    ASSERT_EQ(set.size(), 2);
    EXPECT_EQ(set.id[0], 9007199254740993u);
    EXPECT_EQ(set.alpha[0], 0.5f);
    EXPECT_EQ(set.color[0], glm::vec3(1, 2, 3));
    EXPECT_EQ(set.mesh[1], 5u);
    EXPECT_EQ(set.position[1], glm::vec3(11, 21, 31));
    EXPECT_EQ(set.radius[0], 0.75f);
    EXPECT_EQ(set.distance[0], 0.125f);
    EXPECT_EQ(set.max_distance, 0.25);
}

TEST_F(Pda, WhatAFileLacksHasDefaults) {
    const SplatSet set = read(positions("2", "1 2 3\n4 5 6\n"));
    EXPECT_EQ(set.color[1], glm::vec3(1.0f));
    EXPECT_EQ(set.alpha[1], 1.0f);
    EXPECT_EQ(set.distance[1], 0.0f);
    EXPECT_EQ(set.id[0], 0u);
    EXPECT_EQ(set.id[1], 1u);
    EXPECT_TRUE(set.radius.empty());
    EXPECT_TRUE(set.mesh.empty());
    EXPECT_EQ(set.spacing, glm::dvec3(0.0));
}

TEST_F(Pda, BlanksAndLineEndsOfAllKinds) {
    const SplatSet set = read(
        "\xef\xbb\xbf"
        "ATTRIBUTES \r\n\tposition\r\n id \r\nTYPES\r\n V I\r\nNUMBER_OF_PARTICLES : 2\r\nBEGIN DATA\r\n"
        "\r\n  1\t2  +3 7\t\r\n \t\r\n4e0 5.E+1 .6e-1 8");
    ASSERT_EQ(set.size(), 2);
    EXPECT_EQ(set.position[0], glm::vec3(1, 2, 3));
    EXPECT_EQ(set.position[1], glm::vec3(4, 50, 0.06f));
    EXPECT_EQ(set.id[1], 8u);
    EXPECT_EQ(read("ATTRIBUTES\nposition\nTYPES\nV\nNUMBER_OF_PARTICLES 1\nBEGIN DATA\n1 2 3").size(), 1);
    EXPECT_EQ(read("ATTRIBUTES\nposition\nTYPES\nV\nNUMBER_OF_PARTICLES:1\nBEGIN DATA\n1 2 3").size(), 1);
    EXPECT_EQ(read(positions("0", "")).size(), 0);
}

TEST_F(Pda, OpacityIsClampedWithAWarning) {
    const Said said;
    const SplatSet set = read(
        "ATTRIBUTES position opacityPP TYPES V R NUMBER_OF_PARTICLES: 3\nBEGIN DATA\n"
        "0 0 0 1.5\n0 0 0 -1\n0 0 0 0.5\n");
    EXPECT_EQ(set.alpha[0], 1.0f);
    EXPECT_EQ(set.alpha[1], 0.0f);
    EXPECT_EQ(set.alpha[2], 0.5f);
    EXPECT_HAS(said.text(), "2 of 3 opacities lie outside 0..1");
}

TEST_F(Pda, RealFiles) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(circle, "particles/circle.00001.pda");
    const SplatSet set = read_pda(circle);
    ASSERT_EQ(set.size(), 30);
    EXPECT_EQ(set.position[1], glm::vec3(0.207912f, 0.0f, 0.978148f));
    for (const glm::vec3& p : set.position) EXPECT_NEAR(p.x * p.x + p.z * p.z, 1.0f, 1e-5f);
    EXPECT_EQ(set.id[29], 29u);
    ASTROSPLAT_TEST_DATA_OR_SKIP(test, "particles/test.pda");
    EXPECT_EQ(error_of(test, [](const auto& file) { read_pda(file); }),
              "test.pda:7: expected 5 numbers (position life id), found 6");
}

TEST_F(Pda, WrongHeaders) {
    EXPECT_EQ(error(""), "a.pda:1: expected 'ATTRIBUTES', found the end of the file");
    EXPECT_EQ(error("v 0 0 0\n"), "a.pda:1: expected 'ATTRIBUTES', found 'v'");
    EXPECT_EQ(error(std::string("\x89PNG\r\n\0", 7)), "a.pda:1: expected 'ATTRIBUTES', found '\\x89PNG'");
    EXPECT_EQ(error("ATTRIBUTES\n position\n"), "a.pda:3: expected 'TYPES', found the end of the file");
    EXPECT_EQ(error("ATTRIBUTES\n position\nTYPES\n V\n"),
              "a.pda:5: expected 'NUMBER_OF_PARTICLES:', found the end of the file");
    EXPECT_EQ(error("ATTRIBUTES\n position\nTYPES\n Q\n"),
              "a.pda:4: expected type I, R or V of attribute position, found 'Q'");
    EXPECT_EQ(error("ATTRIBUTES\n position\nTYPES\n R\n"),
              "a.pda:4: expected type V of attribute position, found 'R'");
    EXPECT_EQ(error("ATTRIBUTES\n position life\nTYPES\n V\nNUMBER_OF_PARTICLES: 1\n"),
              "a.pda:5: expected type I, R or V of attribute life, found 'NUMBER_OF_PARTICLES:'");
    EXPECT_EQ(error("ATTRIBUTES\n life life\nTYPES\n"),
              "a.pda:2: expected each attribute once, found 'life'");
    EXPECT_EQ(error("ATTRIBUTES\n life\nTYPES\n R\n"),
              "a.pda:4: expected an attribute position, found 'none'");
    EXPECT_EQ(error("ATTRIBUTES\n position\nTYPES\n V\nNUMBER_OF_PARTICLES: 1\nBEGIN DATA 1 2 3\n"),
              "a.pda:6: expected nothing behind 'BEGIN DATA' on its line, found '1'");
    EXPECT_EQ(error("ATTRIBUTES\n position\nTYPES\n V\nNUMBER_OF_PARTICLES: 1\nDATA\n"),
              "a.pda:6: expected 'BEGIN', found 'DATA'");
}

TEST_F(Pda, WrongCounts) {
    EXPECT_EQ(error(positions("-3", "1 2 3\n")), "a.pda:5: expected a number of particles, found '-3'");
    EXPECT_EQ(error(positions("3x", "1 2 3\n")), "a.pda:5: expected a number of particles, found '3x'");
    EXPECT_EQ(error(positions("1000000000000000000", "1 2 3\n")),
              "a.pda: expected 1000000000000000000 rows, as NUMBER_OF_PARTICLES says, found 1");
    EXPECT_EQ(error(positions("99999999999999999999", "1 2 3\n")),
              "a.pda:5: expected a number of particles, found '99999999999999999999'");
    EXPECT_EQ(error(positions("3", "1 2 3\n1 2")),
              "a.pda: expected 3 rows, as NUMBER_OF_PARTICLES says, found 2");
    EXPECT_EQ(error(positions("1", "1 2 3\n1 2 3\n")),
              "a.pda: expected 1 rows, as NUMBER_OF_PARTICLES says, found 2");
}

TEST_F(Pda, WrongRows) {
    EXPECT_EQ(error(positions("2", "1 2 3\n1 2")), "a.pda:8: expected 3 numbers (position), found 2");
    EXPECT_EQ(error(positions("2", "\n1 2 3 4\n1 2\n")), "a.pda:8: expected 3 numbers (position), found 4");
    for (const std::string word : {"two", "2,5", "nan", "-inf", "1e39"})
        EXPECT_EQ(error(positions("1", "1 " + word + " 3\n")),
                  "a.pda:7: expected a finite number for position, found '" + word + "'");
    EXPECT_EQ(error(one("opacityPP", "R", "nan")),
              "a.pda:7: expected a finite number for opacityPP, found 'nan'");
    EXPECT_EQ(error(one("radiusPP", "R", "-1")),
              "a.pda:7: expected a finite number >= 0 for radiusPP, found '-1'");
    EXPECT_EQ(error(one("DistanceFromSurfaceMeshPP", "R", "-1")),
              "a.pda:7: expected a finite number >= 0 for DistanceFromSurfaceMeshPP, found '-1'");
    EXPECT_EQ(error(one("particleId", "I", "-1")),
              "a.pda:7: expected a whole number >= 0 for particleId, found '-1'");
    EXPECT_EQ(error(one("particleId", "I", "1.5")),
              "a.pda:7: expected a whole number >= 0 for particleId, found '1.5'");
    EXPECT_EQ(error(one("whichMeshPP", "I", "4294967296")),
              "a.pda:7: expected a whole number >= 0 and < 2^32 for whichMeshPP, found '4294967296'");
}

TEST_F(Pda, TheFirstBadRowIsNamedWhateverTheThreads) {
    std::string rows;
    for (int i = 0; i < 300000; ++i) rows += i == 200000 || i == 290000 ? "1 2\n" : "1.5 2.5 3.5\n";
    for (const int threads : {1, 4}) {
        set_thread_count(threads);
        EXPECT_EQ(error(positions("300000", rows)), "a.pda:200007: expected 3 numbers (position), found 2");
    }
}

TEST_F(Pda, EveryTruncationIsAnErrorOrTheSameRows) {
    write_pda(path("whole.pda"), awkward_set(4));
    const std::string whole = bytes_of(path("whole.pda"));
    for (std::size_t size = 0; size + 21 < whole.size();
         ++size)  // a cut inside the last id cannot be noticed
        EXPECT_NE(error(whole.substr(0, size)), "") << size;
}

TEST_F(Pda, MissingFileFolderAndReadOnlyTarget) {
    const auto read = [](const auto& file) { read_pda(file); };
    EXPECT_EQ(error_of(path("none.pda"), read), "none.pda: cannot be read: No such file or directory");
    fs::create_directories(path("folder.pda"));
    EXPECT_EQ(error_of(path("folder.pda"), read), "folder.pda: cannot be read: it is a folder");
    EXPECT_THROW(write_pda(path("no such folder") / "a.pda", awkward_set(1)), OutputError);
}

TEST_F(Pda, CancelLeavesNothing) {
    const std::atomic<bool> stop{true};
    EXPECT_THROW(write_pda(path("a.pda"), awkward_set(10), {{}, &stop}), Cancelled);
    EXPECT_TRUE(fs::is_empty(path("a.pda").parent_path()));
}

TEST_F(Pda, CancelInTheMiddleLeavesNothing) {
    const SplatSet set = awkward_set(200000);
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        std::atomic<bool> stop{false};
        const Progress progress{[&](double fraction) { stop = fraction > 0.3; }, &stop};
        EXPECT_THROW(write_pda(path("a.pda"), set, progress), Cancelled);
        EXPECT_TRUE(fs::is_empty(path("a.pda").parent_path()));
    }
}

TEST_F(Pda, AFullDiskIsOneErrorAndLeavesNothing) {
    const SplatSet set = awkward_set(200000);
    const FileLimit full(8 << 20);
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        EXPECT_THROW(write_pda(path("a.pda"), set), OutputError);
        EXPECT_TRUE(fs::is_empty(path("a.pda").parent_path()));
    }
}

}  // namespace
}  // namespace astrosplat

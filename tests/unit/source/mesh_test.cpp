// OBJ files small enough to read, measures, projections, built-in shapes.
#include "source/mesh.h"

#include <tiny_obj_loader.h>

#include <clocale>

#include "support/test.h"

namespace astrosplat {
namespace {

Mesh from_text(const std::string& text) {
    const TempFolder folder;
    return load_obj(folder.file("a mesh.obj", text));
}

// The message behind the file's name.
std::string obj_error(const std::string& text) {
    const TempFolder folder;
    const fs::path file = folder.file("m.obj", text);
    const std::string message = ERROR_OF(load_obj(file));
    EXPECT_EQ(message.rfind(file.string(), 0), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message.substr(std::min(message.size(), file.string().size()));
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, TriangleWithUv) {
    const Mesh mesh = from_text(
        "# c\nv 0 0 0\nv 1.5 0 0\nv 0 2e0 -.25\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n");
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.positions[2], glm::vec3(0.0f, 2.0f, -0.25f));
    EXPECT_EQ(mesh.triangles[0].position, (std::array<std::uint32_t, 3>{0, 1, 2}));
    EXPECT_EQ(mesh.triangles[0].uv, (std::array<std::uint32_t, 3>{0, 1, 2}));
    EXPECT_TRUE(mesh.maps.empty());
}

TEST(Obj, FacesOfSeveralObjectsKeepTheFilesOrder) {
    const Mesh mesh = from_text("o a\n" + square + "f 1 2 3\no b\ng x y\nf 3 4 1\nf 2 3 4\n");
    ASSERT_EQ(mesh.triangles.size(), 3u);
    EXPECT_EQ(mesh.triangles[0].position[0], 0u);
    EXPECT_EQ(mesh.triangles[1].position[0], 2u);
    EXPECT_EQ(mesh.triangles[2].position[0], 1u);
}

TEST(Obj, NegativeIndicesCountFromTheLastVertexSoFar) {
    const Mesh mesh = from_text("v 9 9 9\n" + square + "f -4//-1 -3//-1 -2//-1\nv 8 8 8\n");
    EXPECT_EQ(mesh.triangles[0].position, (std::array<std::uint32_t, 3>{1, 2, 3}));
    EXPECT_EQ(mesh.triangles[0].uv[0], Mesh::no_uv);
}

TEST(Obj, FacesMayPrecedeTheirVertices) { EXPECT_EQ(from_text("f 1 2 3 4\n" + square).triangles.size(), 2u); }

TEST(Obj, ContinuedLinesCarriageReturnsAndByteOrderMark) {
    const Mesh mesh = from_text("\xef\xbb\xbfv 0 0 0\r\nv 1 0 \\\r\n0\r\nv 1 1 0\r\nf 1 2 \\\n 3");
    EXPECT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST(Obj, NumbersDoNotDependOnTheLocale) {
    const std::string before = std::setlocale(LC_NUMERIC, nullptr);
    std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
    const Mesh mesh = from_text("v 0.5 0 0\nv 1.25 0 0\nv 1 1 0\nf 1 2 3\n");
    std::setlocale(LC_NUMERIC, before.c_str());
    EXPECT_EQ(mesh.positions[1].x, 1.25f);
}

TEST(Obj, NumbersAreRoundedCorrectly) {
    EXPECT_EQ(from_text("v 0.1 16777217 3.4028234e38\n" + square + "f 2 3 4\n").positions[0],
              glm::vec3(0.1f, 16777216.0f, 3.4028234e38f));
}

TEST(Obj, ConcavePolygonKeepsItsArea) {
    // An arrow head: a fan around corner 0 would cover area outside.
    const Mesh mesh = from_text("v 2 1 0\nv 0 2 0\nv 1 1 0\nv 0 0 0\nf 1 2 3 4\n");
    ASSERT_EQ(mesh.triangles.size(), 2u);
    EXPECT_NEAR(surface_area(mesh), 1.0, 1e-12);
    const Mesh turned = from_text("v 1 1 0\nv 0 0 0\nv 2 1 0\nv 0 2 0\nf 1 2 3 4\n");
    EXPECT_NEAR(surface_area(turned), 1.0, 1e-12);
    const Mesh other = from_text("v 0 2 0\nv 1 1 0\nv 0 0 0\nv 2 1 0\nf 1 2 3 4\n");
    EXPECT_NEAR(surface_area(other), 1.0, 1e-12);
}

TEST(Obj, DegenerateTrianglesAreKeptAndHaveNoArea) {
    const Mesh mesh = from_text(square + "f 1 1 2\nf 1 2 3\n");
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(surface_area(mesh), 0.5);
}

TEST(Obj, MapsAreFoundBesideTheMaterialLibrary) {
    const TempFolder folder;
    fs::create_directory(folder / "mat");
    folder.file("mat/my lib.mtl",
                "newmtl red\nKd 1 0 0\nmap_Kd tex\\red one.png\nnewmtl plain\nKd 1 1 1\nnewmtl blue\nmap_Kd "
                "blue.png\n");
    const fs::path file =
        folder.file("m.obj", "mtllib mat\\my lib.mtl\n" + square +
                                 "f 1 2 3\nusemtl red\nf 1 2 3\nusemtl plain\nf 1 2 3\nusemtl "
                                 "blue\nf 1 2 3 4\nusemtl red\nf 1 2 3\n");
    const Mesh mesh = load_obj(file);
    std::vector<fs::path> map_of_triangle;
    for (const Mesh::Triangle& t : mesh.triangles) map_of_triangle.push_back(mesh.maps[t.material]);
    const fs::path red = folder / "mat/tex/red one.png", blue = folder / "mat/blue.png";
    EXPECT_EQ(map_of_triangle, (std::vector<fs::path>{"", red, "", blue, blue, red}));
}

TEST(Obj, MaterialsAreTheLibrariesAndThePicturesThatExist) {
    const TempFolder folder;
    const fs::path library =
        folder.file("a.mtl", "newmtl red\nmap_Kd red.png\nnewmtl gone\nmap_Kd gone.png\nnewmtl plain\n");
    const fs::path red = folder.file("red.png", "any bytes"), other = folder.file("b c.mtl", "newmtl x\n");
    const fs::path file = folder.file(
        "m.obj", "# mtllib no.mtl\nmtllib a.mtl\n" + square + "usemtl x\nf 1 2 3\nmtllib b c.mtl\n");
    EXPECT_EQ(obj_materials(file), (std::vector<fs::path>{library, other, red}));
    EXPECT_TRUE(obj_materials(folder.file("bare.obj", square)).empty());
    EXPECT_THROW(obj_materials(folder / "missing.obj"), InputError);
}

TEST(Obj, MissingMaterialLibraryIsAWarning) {
    const Said said;
    const Mesh mesh = from_text("mtllib gone.mtl\nusemtl x\n" + square + "f 1 2 3\n");
    ASSERT_EQ(said.lines.size(), 1u);
    EXPECT_TRUE(said.lines[0].ends_with(".obj:1: material library 'gone.mtl' not found")) << said.lines[0];
    EXPECT_TRUE(mesh.maps.empty());
}

TEST(Obj, LibrariesMissingFromOneLineAreOneWarning) {
    const TempFolder folder;
    folder.file("b.mtl", "newmtl x\n");
    const Said said;
    const fs::path file = folder.file("m.obj", "mtllib a.mtl b.mtl c.mtl d.mtl\n" + square + "f 1 2 3\n");
    load_obj(file);
    EXPECT_EQ(said.text(), file.string() + ":1: material library 'a.mtl', 'c.mtl', 'd.mtl' not found\n");
}

TEST(Obj, ReadingStopsWhenAsked) {
    std::string text = square;
    for (int i = 0; i < 10000; ++i) text += "f 1 2 3\n";
    const TempFolder folder;
    const fs::path file = folder.file("m.obj", text);
    std::atomic<bool> stop{false};
    const Progress progress{[&](double fraction) { stop = fraction > 0.3; }, &stop};
    EXPECT_THROW(load_obj(file, progress), Cancelled);
    stop = true;
    EXPECT_THROW(load_obj(file, Progress{{}, &stop}), Cancelled);
}

TEST(ObjErrors, OneLineEach) {
    EXPECT_EQ(obj_error("v 0 0 0\nv 1.0 2"), ":2: expected three coordinates after 'v', found 2");
    EXPECT_EQ(obj_error("v 0 0 abc\n"), ":1: expected a finite number, found 'abc'");
    EXPECT_EQ(obj_error("v 0 nan 0\n"), ":1: expected a finite number, found 'nan'");
    EXPECT_EQ(obj_error("v 0 1e39 0\n"), ":1: expected a finite number, found '1e39'");
    EXPECT_EQ(obj_error("vt 1\n"), ":1: expected two texture coordinates after 'vt', found 1");
    EXPECT_EQ(obj_error(square + "f 1/1/1 2/"), ":5: expected at least three corners after 'f', found 2");
    EXPECT_EQ(obj_error(square + "vt 0 0\nf 1/1 2/1 3/"),
              ":6: expected the number of a texture coordinate, found ''");
    EXPECT_EQ(obj_error(square + "vt 0 0\nf 1/1 2/1 3"),
              ":6: expected texture coordinates at all corners of a face or at none, found a mixture");
    EXPECT_EQ(obj_error(square + "f 1/ 2/ 3/"), ":5: expected the number of a texture coordinate, found ''");
    EXPECT_EQ(obj_error(square + "f 1//x 2//1 3//1"), ":5: expected the number of a normal, found '1//x'");
    EXPECT_EQ(obj_error(square + "f 1 2 5\nf 1 2 3\n"),
              ":5: expected one of the file's 4 vertices, found number 5");
    EXPECT_EQ(obj_error(square + "f 1 2 5\nf 1 2 5\nf 1 3 5\n"),
              ":5: expected one of the file's 4 vertices, found number 5");
    EXPECT_EQ(obj_error(square + "f 1 2 0\n"), ":5: expected the number of a vertex, found '0'");
    EXPECT_EQ(obj_error(square + "f 1 2 99999999999999999999\n"),
              ":5: expected the number of a vertex, found '99999999999999999999'");
    EXPECT_EQ(obj_error(square + "f 1 2 -5\n"), ":5: expected one of the 4 vertices so far, found -5");
    EXPECT_EQ(obj_error(""), ": expected an OBJ mesh with vertices ('v x y z'), found none");
    EXPECT_EQ(obj_error(square), ": expected an OBJ mesh with faces ('f'), found none");
}

// Why tinyobjloader reads our materials only. Where this fails with a newer version,
// it may read the faces too.
TEST(Obj, TinyobjloaderDoesNotReadOrRefuseAsWeDo) {
    const auto triangles = [](const std::string& text) {
        std::istringstream in(text);
        tinyobj::attrib_t attributes;
        std::vector<tinyobj::shape_t> shapes;
        std::vector<tinyobj::material_t> materials;
        std::string warning, error;
        if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &in)) return -1;
        int count = 0;
        for (const tinyobj::shape_t& shape : shapes) count += int(shape.mesh.num_face_vertices.size());
        return count;
    };
    EXPECT_EQ(triangles(square + "f 1// 2// 3//\n"), -1);  // as in trimesh's polygonfaces.obj
    EXPECT_EQ(from_text(square + "f 1// 2// 3//\n").triangles.size(), 1u);
    EXPECT_EQ(triangles(square + "f 1 2 9\n"), 1);
    EXPECT_NE(obj_error(square + "f 1 2 9\n"), "no error");
    EXPECT_EQ(triangles(square + "f 1 2\nf 1 2 3\n"), 1);
    EXPECT_NE(obj_error(square + "f 1 2\nf 1 2 3\n"), "no error");
}

TEST(ObjErrors, FolderAndMissingFile) {
    const TempFolder folder;
    EXPECT_EQ(ERROR_OF(load_obj(folder.path())), folder.path().string() + ": cannot be read: it is a folder");
    EXPECT_EQ(ERROR_OF(load_obj(folder / "x.obj")),
              (folder / "x.obj").string() + ": cannot be read: No such file or directory");
}

TEST(Polygon, StarOfManyCornersKeepsItsArea) {
    std::vector<glm::vec3> corners;
    double area = 0.0;
    for (int i = 0; i < 100; ++i) {
        const double r = i % 2 ? 1.0 : 3.0, angle = 2.0 * real::pi * i / 100;
        corners.emplace_back(r * real::cos(angle), r * real::sin(angle), 2.0);
    }
    for (std::size_t i = 0; i < 100; ++i) {
        const glm::dvec3 a(corners[i]), b(corners[(i + 1) % 100]);
        area += 0.5 * (a.x * b.y - a.y * b.x);
    }
    double sum = 0.0;
    for (const auto& [a, b, c] : triangulate(corners)) {
        const glm::dvec3 p(corners[a]), q(corners[b]), r(corners[c]);
        const double z = glm::cross(q - p, r - p).z;
        EXPECT_GT(z, 0.0);
        sum += 0.5 * z;
    }
    EXPECT_NEAR(sum, area, 1e-9);
}

TEST(ApplyUv, PlanarProjectionsPointAsTheDesignSays) {
    const Bounds box{glm::dvec3(-1.0), glm::dvec3(1.0)};
    const auto uv_of = [&](glm::vec3 p, UvMode mode) {
        Mesh mesh;
        mesh.positions = {p, p, p};
        mesh.triangles = {{{0, 1, 2}, {Mesh::no_uv, Mesh::no_uv, Mesh::no_uv}, 0}};
        apply_uv(mesh, mode, box);
        return mesh.uvs[mesh.triangles[0].uv[0]];
    };
    EXPECT_EQ(uv_of({1, 0, -1}, UvMode::planar_xz), glm::vec2(1, 1));
    EXPECT_EQ(uv_of({-1, 0, 1}, UvMode::planar_xz), glm::vec2(0, 0));
    EXPECT_EQ(uv_of({1, 1, 0}, UvMode::planar_xy), glm::vec2(1, 1));
    EXPECT_EQ(uv_of({0, 1, -1}, UvMode::planar_yz), glm::vec2(1, 1));
    EXPECT_EQ(uv_of({0.5f, 0, 0.5f}, UvMode::planar_xz), glm::vec2(0.75f, 0.25f));
}

TEST(ApplyUv, MissingUvIsAnErrorThatSaysWhatHelps) {
    Mesh mesh = from_text(square + "f 1 2 3\n");
    mesh.name = "m.obj";
    EXPECT_EQ(ERROR_OF(apply_uv(mesh, UvMode::mesh, bounds(mesh))),
              "m.obj: expected texture coordinates ('vt') at every face, or uv = \"planar-xz\" or another "
              "projection, "
              "found a face without them");
    EXPECT_NO_THROW(apply_uv(mesh, UvMode::planar_xy, bounds(mesh)));
}

TEST(Builtin, PlaneHasThePicturesShape) {
    const Mesh wide = builtin_mesh("plane", 2.0), high = builtin_mesh("plane", 0.5);
    EXPECT_EQ(bounds(wide).extent(), glm::dvec3(10.0, 0.0, 5.0));
    EXPECT_EQ(bounds(high).extent(), glm::dvec3(5.0, 0.0, 10.0));
    EXPECT_EQ(surface_area(wide), 50.0);
    for (std::size_t i = 0; i < 4; ++i) {  // uv as planar-xz
        EXPECT_EQ(wide.uvs[i].x, wide.positions[i].x / 10.0f + 0.5f);
        EXPECT_EQ(wide.uvs[i].y, 0.5f - wide.positions[i].z / 5.0f);
    }
}

TEST(Builtin, FacesLookOutAndUp) {
    for (const char* name : {"plane", "disk", "sphere"}) {
        const Mesh mesh = builtin_mesh(name, 1.5);
        for (const Mesh::Triangle& t : mesh.triangles) {
            const glm::dvec3 a(mesh.positions[t.position[0]]), b(mesh.positions[t.position[1]]),
                c(mesh.positions[t.position[2]]);
            const glm::dvec3 normal = glm::cross(b - a, c - a);
            const glm::dvec3 out = std::string(name) == "sphere" ? a + b + c : glm::dvec3(0, 1, 0);
            ASSERT_GT(glm::dot(normal, out), 0.0) << name;
        }
    }
}

TEST(Builtin, AreasApproachTheCircleAndTheSphere) {
    EXPECT_NEAR(surface_area(builtin_mesh("disk", 1.0)), 25.0 * real::pi, 25.0 * real::pi * 2e-4);
    EXPECT_NEAR(surface_area(builtin_mesh("sphere", 1.0)), 100.0 * real::pi, 100.0 * real::pi * 1e-3);
    EXPECT_EQ(builtin_mesh("sphere", 1.0).triangles.size(), 128u * 2u * 63u);
}

TEST(Builtin, DiskShowsTheLargestCircleUndistorted) {
    for (const double aspect : {0.5, 1.0, 2.0}) {
        const Mesh mesh = builtin_mesh("disk", aspect);
        const double picture_height =
            std::max(10.0, 10.0 / aspect);  // scene units, when 10 is the shorter side
        for (std::size_t i = 0; i < mesh.uvs.size(); ++i) {
            const glm::vec2 uv = mesh.uvs[i];
            EXPECT_TRUE(uv.x >= 0.0f && uv.x <= 1.0f && uv.y >= 0.0f && uv.y <= 1.0f);
            EXPECT_NEAR((uv.x - 0.5) * aspect * picture_height, mesh.positions[i].x, 1e-5);
            EXPECT_NEAR((0.5 - uv.y) * picture_height, mesh.positions[i].z, 1e-5);
        }
    }
}

TEST(Builtin, SphereMapReadsRightFromOutside) {
    const Mesh mesh = builtin_mesh("sphere", 2.0);
    const auto at = [&](std::size_t column, std::size_t row) {
        EXPECT_EQ(mesh.uvs[row * 129 + column], glm::vec2(float(column) / 128.0f, float(row) / 64.0f));
        return mesh.positions[row * 129 + column];
    };
    const auto near = [](glm::vec3 p, glm::vec3 q) { return glm::length(p - q) < 1e-5f; };
    EXPECT_TRUE(near(at(64, 32), {0, 0, 5}));  // the middle of the map looks to +z
    EXPECT_TRUE(near(at(96, 32), {5, 0, 0}));  // and its right, seen from there, is +x
    EXPECT_EQ(at(20, 64), glm::vec3(0, 5, 0));
    EXPECT_EQ(at(20, 0), glm::vec3(0, -5, 0));
    EXPECT_EQ(at(0, 32), at(128, 32));  // the seam closes
    for (const glm::vec3& p : mesh.positions) EXPECT_NEAR(glm::length(p), 5.0, 1e-5);
}

}  // namespace
}  // namespace astrosplat

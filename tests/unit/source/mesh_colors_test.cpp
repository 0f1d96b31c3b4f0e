// Meshes without a picture, or with colours besides it: grey, of their materials, of their vertices.
#include "core/color.h"
#include "source/textured_mesh.h"
#include "support/quiet.h"
#include "support/test.h"

namespace astrosplat {
namespace {

class MeshColors : public testing::Test {
  protected:
    const TempFolder folder;
};

TexturedMesh loaded_mesh(const fs::path& file) {
    SourceParams source;
    source.meshes = {{file, {}}};
    return load_meshes(source).at(0);
}

glm::vec3 color_of_triangle(const TexturedMesh& m, std::size_t i) {
    const Mesh::Triangle& t = m.mesh.triangles[i];
    const Texture& texture = m.textures[m.textures.size() > 1 ? t.material : 0];
    return sample(texture, m.mesh.uvs[t.uv[0]]).color;
}

const std::string two_triangles = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(MeshColors, AMeshWithoutPictureNeedsNoTextureCoordinates) {
    const fs::path file = folder.file("grey.obj", two_triangles + "f 1 2 3\nf 1 3 4\n");
    const Said said;
    EXPECT_EQ(color_of_triangle(loaded_mesh(file), 1), glm::vec3(0.18f));
    EXPECT_HAS(said.one_warning(), "neutral grey");
}

TEST_F(MeshColors, MaterialsWithoutPictureHaveTheirColour) {
    folder.file("m.mtl", "newmtl a\nKd 0 0 1\nnewmtl b\nKd 0.5 0.25 0\n");
    const fs::path file =
        folder.file("kd.obj", "mtllib m.mtl\n" + two_triangles + "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n");
    const Said said;
    const TexturedMesh mesh = loaded_mesh(file);
    EXPECT_EQ(color_of_triangle(mesh, 0), glm::vec3(0.0f, 0.0f, 1.0f));
    EXPECT_EQ(color_of_triangle(mesh, 1), glm::vec3(0.5f, 0.25f, 0.0f));
    EXPECT_EQ(said.text(), "");
}

TEST_F(MeshColors, AMaterialsColourTintsItsPicture) {
    folder.file("p.ppm", "P3 1 1 255 255 255 255\n");
    folder.file("m.mtl", "newmtl a\nKd 0.5 1 0.25\nmap_Kd p.ppm\nnewmtl b\nKd 0 0 0\nmap_Kd p.ppm\n");
    const fs::path file = folder.file("t.obj", "mtllib m.mtl\n" + two_triangles +
                                                   "vt 0.5 0.5\nusemtl a\nf 1/1 2/1 3/1\nusemtl b\nf "
                                                   "1/1 3/1 4/1\n");
    const TexturedMesh mesh = loaded_mesh(file);
    EXPECT_EQ(color_of_triangle(mesh, 0), glm::vec3(0.5f, 1.0f, 0.25f));
    EXPECT_EQ(color_of_triangle(mesh, 1), glm::vec3(1.0f)) << "exporters write black with pictures";
}

TEST_F(MeshColors, VerticesColourTheirTriangles) {
    const fs::path file = folder.file(
        "v.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\nv 0 1 0 0 0 0\nf 1 2 3\nf 1 3 4\n");
    const Said said;
    const TexturedMesh mesh = loaded_mesh(file);
    EXPECT_EQ(color_of_triangle(mesh, 0), glm::vec3(1.0f, 0.0f, 0.0f));
    EXPECT_NEAR(color_of_triangle(mesh, 1).r, 2.0f / 3.0f, 1e-6f);
    EXPECT_EQ(said.text(), "");
}

TEST_F(MeshColors, WhatIsNotUsedIsSaid) {
    const std::string colored = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\nf 1 2 3\n";
    const fs::path file = folder.file("v.obj", colored);
    SourceParams flat;
    flat.meshes = {{file, {}}};
    flat.uv = UvMode::planar_xy;
    const std::vector<std::string> warnings = warnings_of([&] { load_meshes(flat); });
    ASSERT_EQ(warnings.size(), 2u) << "and that it is grey";
    EXPECT_EQ(warnings[0], file.string() +
                               ": the colours of its vertices are used in columns, with uv = "
                               "\"mesh\" and without a picture alone");
    folder.file("m.mtl", "newmtl a\nKd spectral a.rfl\n");
    const fs::path spectral = folder.file("s.obj", "mtllib m.mtl\n" + two_triangles + "usemtl a\nf 1 2 3\n");
    const Said said;
    load_obj(spectral);
    EXPECT_EQ(said.one_warning(), (folder / "m.mtl").string() + ":2: 'Kd spectral a.rfl' is not followed");
}

TEST_F(MeshColors, WhatAMaterialSaysBesideItsColourIsSaid) {
    const auto said_of = [&](const std::string& line) {
        folder.file("m.mtl", "newmtl a\n" + line + "\n");
        const fs::path file = folder.file("o.obj", "mtllib m.mtl\n" + two_triangles + "usemtl a\nf 1 2 3\n");
        return warnings_of([&] { load_obj(file); });
    };
    for (const char* const line :
         {"Ke 1 0.5 0", "map_Ke a.png", "d 0.5", "Tr 0.25", "map_d a.png", "map_Kd -s 2 2 1 a.png",
          "map_Kd -o 0.25 0 a.png", "map_Kd -clamp on a.png"}) {
        ASSERT_EQ(said_of(line).size(), 1u) << line;
        EXPECT_HAS(said_of(line)[0], fmt::format("m.mtl:2: '{}' is not followed", line));
    }
    for (const char* const line :
         {"Ke 0 0 0", "d 1.0", "Tr 0", "map_Kd -s 1 1 1 -o 0 0 0 -clamp off a.png", "Ns 250", "illum 2"})
        EXPECT_TRUE(said_of(line).empty()) << line;
    const fs::path file = folder.file("l.obj", two_triangles + "f 1 2 3\nl 1 2\np 3\n");
    const Said said;
    load_obj(file);
    EXPECT_EQ(said.one_warning(),
              file.string() + ": its 2 elements that are no faces (l, p, curv, surf) are not followed");
}

TEST_F(MeshColors, WholeNumbersOfVerticesAreCodes) {
    const fs::path file =
        folder.file("v.obj", "v 0 0 0 255 0 51\nv 1 0 0 255 0 51\nv 1 1 0 255 0 51\nf 1 2 3\n");
    const Said said;
    EXPECT_EQ(load_obj(file).vertex_colors.at(0), glm::vec3(1.0f, 0.0f, 0.2f));
    EXPECT_HAS(said.one_warning(), "its vertex colours are whole numbers: taken as parts of 255");
}

TEST_F(MeshColors, VerticesWithoutCodesAreWhite) {
    const fs::path file =
        folder.file("w.obj", "v 9 9 9\nv 0 0 0 255 0 51\nv 1 0 0\nv 1 1 0 0 0 255\nv 2 2 2\nf 2 3 4\n");
    const std::vector<glm::vec3> wanted = {{1, 1, 1}, {1, 0, 0.2f}, {1, 1, 1}, {0, 0, 1}, {1, 1, 1}};
    EXPECT_EQ(load_obj(file).vertex_colors, wanted);
    const fs::path parts = folder.file("p.obj", "v 0 0 0\nv 0 1 0 1 0 0.5\nv 1 0 0\nf 1 2 3\n");
    EXPECT_EQ(load_obj(parts).vertex_colors, (std::vector<glm::vec3>{{1, 1, 1}, {1, 0, 0.5f}, {1, 1, 1}}));
}

}  // namespace
}  // namespace astrosplat

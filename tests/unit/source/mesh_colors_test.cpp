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

}  // namespace
}  // namespace astrosplat

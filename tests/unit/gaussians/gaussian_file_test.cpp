// Gaussians that were read, through the baker and the writers, and read again; and USD text.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>

#include "core/rotation.h"
#include "gaussians/gaussian_file.h"
#include "gaussians/gaussians.h"
#include "splat_files/splat_file.h"
#include "support/capture.h"
#include "support/temp_folder.h"

namespace astrosplat::test {
namespace {

/// A capture as a layer shows it, untouched: what the pipeline hands to export.
struct ShownCapture {
    SplatSet set;
    ShadedSplats splats;
    RenderLayer layer;

    explicit ShownCapture(const std::filesystem::path& file) : set(read_splats(file)) {
        splats.position = set.position;
        splats.color = set.color;
        splats.alpha = set.alpha;
        splats.radius = set.radius;
        splats.id = set.id;
        for (std::size_t i = 0; i < set.scale.size(); ++i) {
            glm::dmat3 m = matrix_of_quaternion(glm::dvec4(set.rotation[i]));
            for (int k = 0; k < 3; ++k) m[k] *= 3.0 * double(set.scale[i][k]) / double(set.radius[i]);
            splats.stretch.push_back(glm::mat3(m));
        }
        layer.splats = &splats;
        layer.gaussians = true;
    }
};

void expect_same_gaussians(const SplatSet& a, const SplatSet& b, double tolerance) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.position.size(); ++i) {
        EXPECT_EQ(a.position[i], b.position[i]);
        EXPECT_NEAR(a.alpha[i], b.alpha[i], tolerance);
        EXPECT_NEAR(std::fabs(glm::dot(a.rotation[i], b.rotation[i])), 1.0, tolerance);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(a.scale[i][k] / b.scale[i][k], 1.0, tolerance);
            EXPECT_NEAR(a.color[i][k], b.color[i][k], tolerance * std::max(1.0f, b.color[i][k]));
        }
    }
}

// Read, exported and read again: the same Gaussians, also those brighter than 1.
TEST(GaussianFile, ThatWereReadComeOutAsTheyAre) {
    const TempFolder folder;
    ShownCapture shown(folder.file("a.ply", ply_of(capture(200, 0), 0)));
    Gaussians gaussians;
    BakeCounts counts;
    bake_layer(shown.layer, Camera{}, 1.0, gaussians, counts);
    EXPECT_EQ(counts.lost, 0.0);
    write_gaussian_glb(folder / "linear.glb", gaussians, false);
    expect_same_gaussians(read_splats(folder / "linear.glb"), shown.set, 3e-6);
    encode_for_display(gaussians);
    write_gaussian_ply(folder / "b.ply", gaussians);
    write_gaussian_glb(folder / "b.glb", gaussians, true);
    expect_same_gaussians(read_splats(folder / "b.ply"), shown.set, 3e-6);
    expect_same_gaussians(read_splats(folder / "b.glb"), shown.set, 3e-6);
    write_gaussian_usda(folder / "b.usda", gaussians);
    expect_same_gaussians(read_splats(folder / "b.usda"), shown.set, 3e-6);
    // A turned and doubled layer turns and doubles them.
    shown.layer.world_from_layer = rotation_from_degrees({20.0, 30.0, 40.0});
    shown.layer.scale = 2.0;
    Gaussians turned;
    bake_layer(shown.layer, Camera{}, 1.0, turned, counts);
    const glm::dmat3 wanted =
        rotation_from_degrees({20.0, 30.0, 40.0}) * matrix_of_quaternion(glm::dvec4(shown.set.rotation[5]));
    const glm::dmat3 found = matrix_of_quaternion(glm::dvec4(turned.rotation[5]));
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(turned.scale[5][k] / shown.set.scale[5][k], 2.0, 1e-5);
        EXPECT_NEAR(glm::length(found[k] - wanted[k]), 0.0, 1e-5);
    }
}

ShadedSplats one_of_radius_3() {
    ShadedSplats splats;
    splats.position.push_back(glm::vec3(0.0f));
    splats.color.push_back(glm::vec3(0.5f));
    splats.alpha.push_back(0.5f);
    splats.radius.push_back(3.0f);
    splats.id.push_back(0);
    return splats;
}

TEST(GaussianFile, FlatOnesAndNeedlesKeepTheirDirections) {
    for (const glm::dvec3& scale :
         {glm::dvec3(0.0, 1.0, 2.0), glm::dvec3(0.0, 0.0, 2.0), glm::dvec3(1.0, 0.0, 0.0)}) {
        ShadedSplats splats = one_of_radius_3();
        glm::dmat3 m = rotation_from_degrees({50.0, 60.0, 70.0});
        for (int k = 0; k < 3; ++k) m[k] *= scale[k];
        splats.stretch.push_back(glm::mat3(m));
        RenderLayer layer;
        layer.splats = &splats;
        layer.gaussians = true;
        Gaussians gaussians;
        BakeCounts counts;
        bake_layer(layer, Camera{}, 1.0, gaussians, counts);
        ASSERT_EQ(gaussians.size(), 1);
        const glm::dmat3 axes = matrix_of_quaternion(glm::dvec4(gaussians.rotation[0]));
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(gaussians.scale[0][k], scale[k], 1e-6);
            EXPECT_NEAR(glm::length(axes[k] * scale[k] - m[k]), 0.0, 1e-6);
        }
    }
}

// Field by field as text, for other readers than ours.
TEST(GaussianFile, UsdTextSaysWhatTheyAre) {
    const TempFolder folder;
    Gaussians g;
    for (int i = 0; i < 10; ++i) {
        g.position.push_back({0.5f * float(i), -1.0f, 2.0f});
        g.color.push_back(glm::vec3(0.5f));
        g.alpha.push_back(0.25f);
        g.scale.push_back({1.0f, 2.0f, 0.125f});
        g.rotation.push_back({0.0f, 0.6f, 0.0f, 0.8f});
    }
    write_gaussian_usda(folder / "a.usda", g);
    std::ifstream in(folder / "a.usda");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(text.find("#usda 1.0\n("), 0u);
    EXPECT_TRUE(text.ends_with("interpolation = \"vertex\"\n    )\n}\n")) << text;
    for (const char* part :
         {"def ParticleField3DGaussianSplat \"Splats\"\n{\n    float3[] extent = [(-6, -7, -4), (10.5, 5, "
          "8)]\n",
          "    point3f[] positions = [(0, -1, 2), (0.5, -1, 2), ",
          "(3.5, -1, 2), \n        (4, -1, 2), (4.5, -1, 2)]\n",
          "    quatf[] orientations = [(0.8, 0, 0.6, 0), ", "    float3[] scales = [(1, 2, 0.125), ",
          "    float[] opacities = [0.25, 0.25", "    uniform int radiance:sphericalHarmonicsDegree = 0\n",
          "Coefficients = [(0, 0, 0), ", "upAxis = \"Y\""})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
}

}  // namespace
}  // namespace astrosplat::test

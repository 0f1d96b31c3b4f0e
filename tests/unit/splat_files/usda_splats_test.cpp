// Gaussians of USD as text, ParticleField3DGaussianSplat: as we, the schema and others write them, and one
// test for each error. What glTF's nodes and USD's prims do with them is one test.
#include <fmt/format.h>

#include "core/rotation.h"
#include "unit/splat_files/gaussian_files.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

TEST_F(GaussianFiles, UsdaOfEveryDegree) {
    for (const int degree : {0, 1, 2, 3}) {
        const std::vector<Trained> all = capture(20, degree);
        const SplatSet set = read(usda_of(all, degree), "a.usda");
        expect_near(set, all, degree);
        EXPECT_TRUE(set.display_harmonics);
        // Without a degree it is what there are numbers for.
        expect_near(read(replaced(usda_of(all, degree), "HarmonicsDegree", "HarmonicsRank"), "a.usda"), all,
                    degree);
    }
    EXPECT_EQ(
        splat_attributes(path("a.usda")),
        (std::vector<std::string>{"position", "color", "alpha", "radius", "scale", "rotation", "harmonics"}));
    EXPECT_EQ(splat_count(path("a.usda")), 20);
    EXPECT_TRUE(may_hold_splats(path("a.usda")));
    EXPECT_FALSE(may_hold_splats(write("b.usda", "#usda 1.0\ndef Camera \"shot\"\n{\n}\n")));
}

// Halves, what the schema says of lists that are not there, z up, and two prims after each other.
TEST_F(GaussianFiles, UsdaAsOthersWriteIt) {
    const SplatSet set = read(R"(#usda 1.0
(
    upAxis = "Z"
)
def ParticleField3DGaussianSplat "A"
{
    point3h[] positionsh = [(1, 2, 3)]
    point3f[] positions.timeSamples = {
        1: [(7, 7, 7)],
    }
}
class ParticleField3DGaussianSplat "no"
{
}
def Scope "B"
{
    def ParticleField3DGaussianSplat "C"
    {
        double3 xformOp:translate = (0, 0, 10)
        uniform token[] xformOpOrder = ["xformOp:translate"]
        point3f[] positions = [(4, 5, 6), (0, 0, 0)]
        half[] opacitiesh = [0.25, 0.5, 0.75]
        float3[] radiance:sphericalHarmonicsCoefficients = [(1, 0, 0), (0, 1, 0)]
    }
}
)",
                              "a.usda");
    ASSERT_EQ(set.size(), 3);
    EXPECT_EQ(set.position[0], glm::vec3(1.0f, 3.0f, -2.0f));
    EXPECT_EQ(set.position[1], glm::vec3(4.0f, 16.0f, -5.0f));
    EXPECT_EQ(set.alpha[0], 1.0f);
    EXPECT_EQ(set.alpha[2], 0.5f);
    EXPECT_NEAR(set.color[0].y, real::srgb_to_linear(0.5), 1e-6);
    EXPECT_NEAR(set.color[1].x, real::srgb_to_linear(0.5 + 0.28209479177387814), 1e-6);
    EXPECT_NEAR(set.color[2].x, real::srgb_to_linear(0.5), 1e-6);
    EXPECT_EQ(set.scale[2], glm::vec3(1.0f));
}

TEST_F(GaussianFiles, WrongUsda) {
    const std::string good = usda_of(capture(2, 1), 1);
    EXPECT_EQ(error_usda("#usda 1.0\ndef Xform \"World\"\n{\n}\n"),
              "a.usda: expected Gaussians (ParticleField3DGaussianSplat), found none");
    EXPECT_EQ(error_usda("PXR-USDC\1"),
              "a.usda: expected USD as text (usdcat FILE -o FILE.usda makes it), found a binary file");
    EXPECT_EQ(
        error_usda(replaced(good, "positions =", "positions.timeSamples = {0: [(1, 2, 3)]}\nint[] other =")),
        "a.usda: expected positions of 'Splats' (no time samples), found none");
    EXPECT_EQ(error_usda(replaced(good, "Degree = 1", "Degree = 4")),
              "a.usda:27: expected harmonics of degree 0 to 3, found 4");
    EXPECT_EQ(error_usda(replaced(good, "Degree = 1", "Degree = 2")),
              "a.usda:27: expected 9 harmonics of each of 2 Gaussians, found 8");
    EXPECT_EQ(error_usda(replaced(good, "opacities = [ # by rows\n", "opacities = [ #")),
              "a.usda:22: expected 2 of opacities, found 1");
    EXPECT_EQ(error_usda(replaced(good, "opacities = [ # by rows\n", "opacities = [ many")).substr(0, 39),
              "a.usda:22: expected a number, found 'ma");
    EXPECT_EQ(error_usda(replaced(good, "positions = [ # by rows\n", "positions = [ 1")),
              "a.usda:10: expected tuples of 3 numbers, found 7 numbers");
    EXPECT_EQ(error_usda(good.substr(0, good.find("scales") + 20)),
              "a.usda:14: expected ']', found the end of the file");
    EXPECT_EQ(
        error_usda(usda_of(
            capture(2, 0), 0,
            "float3 xformOp:scale = (1, 2, 1)\nuniform token[] xformOpOrder = [\"xformOp:scale\"]\n")),
        "a.usda: expected prims that scale Gaussians alike along all axes, found others above 'Splats'");
}

// A node's turn moves places, shapes and colours together; mirrors too.
TEST_F(GaussianFiles, NodesPlaceTheirGaussians) {
    const std::vector<Trained> all = capture(12, 3);
    const glm::dmat3 turn = rotation_from_degrees({30.0, -50.0, 200.0});
    for (const auto& [usd, sign] :
         {std::pair{false, 1.0}, std::pair{false, -1.0}, std::pair{true, 1.0}, std::pair{true, -1.0}}) {
        std::string matrix;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) {
                const double value = column == 3 ? (row == 3 ? 1.0 : row + 4.0)
                                     : row == 3  ? 0.0
                                                 : 2.0 * turn[column][row] * (column == 0 ? sign : 1.0);
                matrix += fmt::format("{}{}", matrix.empty() ? "" : ",", value);
            }
        const SplatSet set =
            usd ? read(usda_of(all, 3,
                               "matrix4d xformOp:transform = (" + matrix +
                                   ")\nuniform token[] xformOpOrder = [\"xformOp:transform\"]\n"),
                       "a.usda")
                : read(glb_of(all, 3, R"(,"matrix":[)" + matrix + "]"), "a.glb");
        const glm::dmat3 whole(sign * turn[0], turn[1], turn[2]);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const glm::dvec3 p = 2.0 * (whole * all[i].position) + glm::dvec3(4.0, 5.0, 6.0);
            EXPECT_LT(glm::distance(glm::dvec3(set.position[i]), p), 1e-5);
            // The covariance, entry by entry.
            const auto spread = [](const glm::dmat3& axes, const glm::dvec3& scale, int a, int b) {
                double sum = 0.0;
                for (int k = 0; k < 3; ++k) sum += axes[k][a] * axes[k][b] * scale[k] * scale[k];
                return sum;
            };
            const glm::dmat3 wanted = whole * matrix_of_quaternion(all[i].rotation),
                             found = matrix_of_quaternion(glm::dvec4(set.rotation[i]));
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b)
                    EXPECT_NEAR(spread(found, glm::dvec3(set.scale[i]), a, b),
                                4.0 * spread(wanted, all[i].scale, a, b), 1e-5);
            // Seen from the turned direction the colour is that of the file from the first.
            Harmonics own;
            for (std::size_t j = 0; j < 16; ++j) own.c[j] = glm::vec3(all[i].harmonics[j]);
            const glm::vec3 d = glm::normalize(glm::vec3(0.3f, -0.7f, 0.2f + float(i)));
            const glm::vec3 then = color_towards(own, d),
                            now = color_towards(set.harmonics[i], glm::vec3(whole * glm::dvec3(d)));
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(now[k], then[k], 1e-5);
        }
    }
}

}  // namespace
}  // namespace astrosplat

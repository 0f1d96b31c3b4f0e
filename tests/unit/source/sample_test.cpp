// Lookup on pictures of a few texels whose filtered values can be worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "source/sample.h"
#include "source/shapes.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

using Filter = TextureSettings::Filter;
using Wrap = TextureSettings::Wrap;

// Opaque gray texels, row by row from the top.
Texture gray(std::int64_t width, std::int64_t height, const std::vector<float>& values) {
    Texture texture;
    texture.image = make_image(width, height, 4, 1.0f);
    for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) texture.image.pixels[4 * i + c] = values[i];
    return texture;
}

TEST(Sample, TexelCentresAndOrientation) {
    Texture texture = gray(3, 2, {1, 2, 3, 4, 5, 6});  // 1 2 3 is the top row, v towards 1
    for (const Filter filter : {Filter::nearest, Filter::bilinear, Filter::area}) {
        texture.filter = filter;
        EXPECT_FLOAT_EQ(sample(texture, {0.5f / 3, 0.75f}).color.x, 1.0f);
        EXPECT_FLOAT_EQ(sample(texture, {2.5f / 3, 0.75f}).color.x, 3.0f);
        EXPECT_FLOAT_EQ(sample(texture, {0.5f / 3, 0.25f}).color.x, 4.0f);
        EXPECT_FLOAT_EQ(sample(texture, {2.5f / 3, 0.25f}).color.x, 6.0f);
    }
}

TEST(Sample, BilinearBetweenCentres) {
    const Texture texture = gray(2, 2, {0, 1, 2, 3});
    EXPECT_FLOAT_EQ(sample(texture, {0.5f, 0.5f}).color.x, 1.5f);
    EXPECT_FLOAT_EQ(sample(texture, {0.375f, 0.75f}).color.x, 0.25f);
    EXPECT_FLOAT_EQ(sample(texture, {0.25f, 0.625f}).color.x, 0.5f);
}

TEST(Sample, WrapModesAtAndBeyondTheEdge) {
    Texture texture = gray(2, 1, {1, 3});
    texture.wrap = Wrap::clamp;
    EXPECT_EQ(sample(texture, {0.0f, 0.5f}).color.x, 1.0f);
    EXPECT_EQ(sample(texture, {5.0f, -3.0f}).color.x, 3.0f);
    texture.wrap = Wrap::repeat;
    EXPECT_EQ(sample(texture, {0.0f, 0.5f}).color.x, 2.0f);
    EXPECT_EQ(sample(texture, {-0.75f, 7.5f}).color.x, 1.0f);
    EXPECT_EQ(sample(texture, {1.75f, 0.5f}).color.x, 3.0f);
    texture.wrap = Wrap::black;
    const TextureSample edge = sample(texture, {0.0f, 0.5f});
    EXPECT_EQ(edge.alpha, 0.5f);
    EXPECT_EQ(edge.color.x, 1.0f);  // straight: half a texel of colour over half its alpha
    EXPECT_EQ(sample(texture, {1.5f, 0.5f}).alpha, 0.0f);
}

TEST(Sample, FiltersPremultipliedAndDividesAfterwards) {
    Texture texture = gray(2, 1, {1, 0});
    texture.image.at(1, 0)[3] = 0.0f;  // an empty neighbour must not darken
    const TextureSample middle = sample(texture, {0.5f, 0.5f});
    EXPECT_EQ(middle.alpha, 0.5f);
    EXPECT_EQ(middle.color, glm::vec3(1.0f));
    const TextureSample empty = sample(texture, {0.75f, 0.5f});
    EXPECT_EQ(empty.alpha, 0.0f);
    EXPECT_EQ(empty.color, glm::vec3(0.0f));
}

TEST(Sample, AreaIsTheExactBoxMean) {
    Texture texture = gray(4, 1, {0, 4, 8, 100});
    texture.filter = Filter::area;
    EXPECT_FLOAT_EQ(sample(texture, {0.375f, 0.5f}, {2.0f, 1.0f}).color.x, 4.0f);  // 0.25 0 + 0.5 4 + 0.25 8
    EXPECT_FLOAT_EQ(sample(texture, {0.375f, 0.5f}, {0.0f, 0.0f}).color.x, 4.0f);  // at least one texel
    EXPECT_FLOAT_EQ(sample(texture, {0.5f, 0.5f}, {4.0f, 1.0f}).color.x, 28.0f);   // all
    EXPECT_FLOAT_EQ(sample(texture, {0.5f, 0.5f}, {1e9f, 1e9f}).color.x,
                    28.0f);  // never more than the picture
}

TEST(Sample, PlacesThatAreNoNumbersAreEmpty) {
    const Texture texture = gray(2, 1, {1, 3});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(sample(texture, {nan, 0.5f}).alpha, 0.0f);
    EXPECT_EQ(sample(texture, {0.5f, std::numeric_limits<float>::infinity()}).alpha, 0.0f);
    EXPECT_EQ(sample(texture, {3e38f, -3e38f}).alpha, 1.0f);
}

TEST(Relief, LiftsTheBrightSideAndKeepsThePlane) {
    std::vector<float> values(64 * 32, 0.0f);
    for (std::size_t y = 0; y < 32; ++y)
        for (std::size_t x = 48; x < 64; ++x) values[y * 64 + x] = 1.0f;
    const Mesh mesh = relief_mesh(gray(64, 32, values), 0.15);
    EXPECT_EQ(mesh.positions.size(), 257u * 129u);
    const Bounds box = bounds(mesh);
    EXPECT_EQ(box.extent().x, 10.0);
    EXPECT_EQ(box.extent().z, 5.0);
    EXPECT_NEAR(box.hi.y, 1.5, 1e-6);
    EXPECT_NEAR(box.lo.y, 0.0, 1e-6);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 p = mesh.positions[i];
        ASSERT_NEAR(mesh.uvs[i].x, p.x / 10.0f + 0.5f, 1e-6f);
        ASSERT_NEAR(mesh.uvs[i].y, 0.5f - p.z / 5.0f, 1e-6f);
        ASSERT_TRUE(p.x < 4.0f || p.y > 1.4f) << i;
        ASSERT_TRUE(p.x > 1.0f || p.y < 0.1f) << i;
    }
}

TEST(Relief, IsAsHighForADarkPicture) {
    std::vector<float> bright(16 * 16), dark(16 * 16);
    for (std::size_t i = 0; i < bright.size(); ++i) {
        bright[i] = static_cast<float>(i % 16) / 16.0f;
        dark[i] = bright[i] / 1024.0f;
    }
    const Mesh a = relief_mesh(gray(16, 16, bright), 0.15), b = relief_mesh(gray(16, 16, dark), 0.15);
    EXPECT_NEAR(bounds(a).hi.y, 1.5, 1e-6);
    EXPECT_NEAR(bounds(b).hi.y, 1.5, 1e-6);
}

TEST(Relief, CoversThePlaneOnceFacingUp) {
    const Mesh mesh = relief_mesh(gray(8, 4, std::vector<float>(32, 0.5f)), 0.15);
    double area = 0.0;
    for (const Mesh::Triangle& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.position[0]]), b(mesh.positions[t.position[1]]),
            c(mesh.positions[t.position[2]]);
        const double up = glm::cross(b - a, c - a).y;
        ASSERT_GT(up, 0.0);
        area += up * 0.5;
    }
    EXPECT_NEAR(area, 10.0 * 5.0, 1e-4);
}

}  // namespace
}  // namespace astrosplat

// Pictures that no telescope took: every row of their sets is read, of all structures.
#include <glm/common.hpp>

#include "bodies/bodies.h"
#include "core/text.h"
#include "support/printing.h"
#include "support/test.h"

namespace astrosplat {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

class HostilePictures : public testing::TestWithParam<StructureKind> {
  protected:
    // Its bodies on a plane of 10 units along the longer side, with every row looked at.
    SplatSet set_of(Image rgba) const {
        TexturedMesh mesh;
        const double aspect = double(rgba.width) / double(rgba.height);
        mesh.mesh = builtin_mesh("plane", aspect);
        mesh.textures.emplace_back().image = std::move(rgba);
        StructureParams params;
        params.kind = GetParam();
        const SplatSet set = make_bodies({mesh}, params, 3u, "gas");
        check_consistent(set);
        const auto side = float(aspect >= 1.0 ? 10.0 / aspect : 10.0 * aspect);
        const glm::vec2 half = 0.5f * (aspect >= 1.0 ? glm::vec2(10.0f, side) : glm::vec2(side, 10.0f));
        for (std::size_t i = 0; i < set.id.size(); ++i) expect_sound(set, i, half * 1.001f);
        return set;
    }
    static void expect_sound(const SplatSet& set, std::size_t i, const glm::vec2& half) {
        const glm::vec3 &p = set.position[i], &color = set.color[i];
        ASSERT_TRUE(std::fabs(p.x) <= half.x && std::fabs(p.z) <= half.y && std::fabs(p.y) <= 5.0f) << i;
        for (int c = 0; c < 3; ++c) {
            ASSERT_TRUE(std::isfinite(color[c])) << i;
            ASSERT_EQ(color[c] < 0.0f, color.x < 0.0f) << "dust in all channels, or light";
        }
        ASSERT_TRUE(set.alpha[i] > 0.0f && set.alpha[i] <= 1.0f) << i;
        ASSERT_TRUE(set.radius[i] > 0.0f && set.radius[i] < 20.0f) << i;
        ASSERT_TRUE(set.distance[i] >= 0.0f && set.distance[i] < 5.0f) << i;
        ASSERT_TRUE(set.uv[i].x >= 0.0f && set.uv[i].x <= 1.0f && set.uv[i].y >= 0.0f && set.uv[i].y <= 1.0f);
    }
    // Light of the splats within `reach` of a place on the plane, as square units of white;
    // what absorbs has none.
    static double light_of(const SplatSet& set, const glm::vec2& about = {}, float reach = 100.0f) {
        double sum = 0.0;
        for (std::size_t i = 0; i < set.id.size(); ++i) {
            const glm::vec2 from = glm::vec2(set.position[i].x, set.position[i].z) - about;
            if (set.color[i].x < 0.0f || std::hypot(from.x, from.y) > reach) continue;
            const double radius = double(set.radius[i]);
            sum += double(set.alpha[i] * set.color[i].y) * radius * radius;
        }
        return sum;
    }
};

INSTANTIATE_TEST_SUITE_P(Bodies, HostilePictures,
                         testing::Values(StructureKind::disk, StructureKind::sheet, StructureKind::walls,
                                         StructureKind::axis),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

TEST_P(HostilePictures, BlackIsNothing) { EXPECT_EQ(set_of(make_image(160, 100, 4, 0.0f)).size(), 0); }

TEST_P(HostilePictures, OpaqueBlackHasNoLight) {
    Image image = make_image(160, 100, 4, 0.0f);
    for (std::size_t i = 3; i < image.pixels.size(); i += 4) image.pixels[i] = 1.0f;
    const SplatSet set = set_of(std::move(image));
    EXPECT_EQ(light_of(set), 0.0);
    EXPECT_EQ(set.size(), 0);
}

TEST_P(HostilePictures, WhiteIsWhiteAllOver) {
    const SplatSet set = set_of(make_image(160, 100, 4, 1.0f));
    EXPECT_GT(set.size(), 16000 / 10);
    EXPECT_LT(set.size(), 16000 * 8);
    const double all = light_of(set);
    for (const glm::vec2 at : {glm::vec2(-3, -1.5f), {3, -1.5f}, {0, 0}, {-3, 1.5f}, {3, 1.5f}})
        EXPECT_NEAR(light_of(set, at, 1.5f) / all, M_PI * 1.5 * 1.5 / 62.5, 0.03) << at.x << " " << at.y;
}

TEST_P(HostilePictures, AHotPixelShinesAloneWhereItIs) {
    Image image = make_image(160, 100, 4, 0.0f);
    for (std::size_t i = 3; i < image.pixels.size(); i += 4) image.pixels[i] = 1.0f;
    for (int c = 0; c < 3; ++c) image.at(120, 30)[c] = 1.0f;  // 120.5 and 30.5 from the top left
    const SplatSet set = set_of(image);
    const double all = light_of(set);
    EXPECT_GE(set.size(), 1);
    EXPECT_LT(set.size(), 2000);
    EXPECT_GT(all, 0.0);
    EXPECT_GT(light_of(set, {2.53125f, -1.21875f}, 0.3f) / all, 0.95) << "within five px";
    for (int c = 0; c < 3; ++c) image.at(120, 30)[c] = 1e36f;
    const SplatSet hot = set_of(std::move(image));
    EXPECT_GT(light_of(hot, {2.53125f, -1.21875f}, 0.3f) / light_of(hot), 0.95);
}

TEST_P(HostilePictures, WhatIsNoNumberIsDark) {
    Image image = make_image(160, 100, 4, 0.25f);
    for (std::int64_t y = 0; y < 100; ++y)
        for (std::int64_t x = 0; x < 160; ++x) {
            image.at(x, y)[3] = 1.0f;
            if (x < 80) std::fill_n(image.at(x, y), 3, y % 3 == 0 ? nan : y % 3 == 1 ? -infinite : -1.0f);
        }
    const SplatSet set = set_of(std::move(image));
    EXPECT_GT(set.size(), 500);
    EXPECT_GT(light_of(set, {2.5f, 0.0f}, 2.0f), 0.0);
    EXPECT_LT(light_of(set, {-2.7f, 0.0f}, 2.2f) / light_of(set), 0.01);
    EXPECT_EQ(set_of(make_image(40, 40, 4, nan)).size(), 0);
}

TEST_P(HostilePictures, HaveAnyShape) {
    for (const glm::ivec2 size : {glm::ivec2(1, 1), {2, 2}, {1, 200}, {200, 1}, {3, 500}, {500, 3}}) {
        SCOPED_TRACE(testing::Message() << size.x << " x " << size.y);
        const SplatSet set = set_of(make_image(size.x, size.y, 4, 0.5f));
        EXPECT_GE(set.size(), 1);
        EXPECT_LE(set.size(), 100 + 20 * size.x * size.y);
        EXPECT_GT(light_of(set), 0.0);
    }
}

}  // namespace
}  // namespace astrosplat

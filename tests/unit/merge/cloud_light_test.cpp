// Structure close by (lod.noise) in a preview's dots: as bright as the children of the final frame are on
// average, and 1 where there are none.
#include "merge/cut.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "core/shared_maths.h"
#include "render/lod.h"
#include "render/render.h"
#include "splats/splat_set.h"
#include "unit/merge/cloud.h"

namespace astrosplat {
namespace {

/// Grey splats, each of which takes up a few blocks of the frame.
struct CloseBy {
    static constexpr int side = 256;  // px of the frame

    RenderLayer layer;
    test::Cloud cloud;
    Camera camera;
    RenderSettings frame;

    CloseBy() {
        layer.render.blend = Blend::add;
        layer.render.lod = {20.0f * 1080.0f / side, 64, 1.0f};
        layer.seed = 5;
        layer.splats = &cloud.splats;
        CameraParams params;
        params.projection = Projection::orthographic;
        params.position = glm::dvec3(0.0, 0.0, 10.0);
        params.height = 2.0;
        camera = make_camera(params, side, side, {});
        frame.width = side;
        frame.height = side;
    }
    void add(const glm::vec3& position, float radius, std::uint64_t id) {
        cloud.add(position, glm::vec3(0.5f), 0.05f, radius, id);
    }
    void fill(std::uint32_t count, float radius) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto place = [&](std::uint32_t axis) {
                return 2.4f * shared::as_uniform(shared::as_hash(11u, i, 0u, axis)) - 1.2f;
            };
            add({place(0), place(1), place(2)}, radius, i);
        }
    }
    ShadedSplats cut(std::int64_t budget) const {
        return test::cut_of(cloud.merged(), DotSettings(layer.render),
                            make_projection(layer, 0, camera, frame), {budget, 0.0f, side, side});
    }
    /// Light of blocks of 32 px.
    std::vector<double> blocks(const ShadedSplats& shown, bool children) const {
        RenderLayer drawn = layer;
        drawn.splats = &shown;
        if (!children) drawn.render.lod = {};
        const Image image = render(std::span(&drawn, 1), camera, nullptr, frame).beauty;
        constexpr int block = 32, blocks = side / block;
        std::vector<double> sums(blocks * blocks);
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                sums[static_cast<std::size_t>(y / block * blocks + x / block)] += double(image.at(x, y)[0]);
        return sums;
    }
};

/// Root mean square of the relative difference.
double difference(const std::vector<double>& shown, const std::vector<double>& wanted) {
    double sum = 0.0;
    for (std::size_t i = 0; i < wanted.size(); ++i) sum += std::pow(shown[i] / wanted[i] - 1.0, 2);
    return std::sqrt(sum / static_cast<double>(wanted.size()));
}

double total(const std::vector<double>& blocks) {
    double sum = 0.0;
    for (const double block : blocks) sum += block;
    return sum;
}

TEST(CloudLight, DotsAreBrightWhereTheirChildrenAre) {
    CloseBy scene;
    scene.fill(3000, 0.3f);
    const std::vector<double> final = scene.blocks(scene.cloud.splats, true);
    const double unlit = difference(scene.blocks(scene.cloud.splats, false), final);
    EXPECT_GT(unlit, 0.1) << "there is structure";
    for (const auto& [budget, share] :
         {std::pair{3000, 0.5}, {1000, 0.75}}) {  // of the splats; merged ones blur
        SCOPED_TRACE(budget);
        const std::vector<double> preview = scene.blocks(scene.cut(budget), false);
        EXPECT_LT(difference(preview, final), share * unlit);
        EXPECT_NEAR(total(preview) / total(final), 1.0, 0.03);
    }
}

TEST(CloudLight, IsOneWithoutChildren) {
    CloseBy scene;
    const auto light = [&](float radius) {
        const LayerProjection layer = make_projection(scene.layer, 0, scene.camera, scene.frame);
        CloudPlace place;
        place.in_camera = {0.3f, 0.1f, -10.0f};
        place.centre = {0.3f, 0.1f, 0.0f};
        place.spread = glm::vec3(0.4f * radius);
        place.radius = radius;
        place.alpha = 0.05f;
        place.color = glm::vec3(0.5f);
        return cloud_light(layer, place);
    };
    EXPECT_EQ(light(0.07f), 1.0f) << "18 px";
    EXPECT_NE(light(0.3f), 1.0f);
    EXPECT_NEAR(light(0.0782f), 1.0f, 0.01f) << "20.02 px: they fade in";
    scene.layer.render.lod.noise = 0.0f;
    EXPECT_EQ(light(0.3f), 1.0f);
    scene.layer.render.lod = {0.0f, 64, 1.0f};
    EXPECT_EQ(light(0.3f), 1.0f) << "nothing is divided";
}

TEST(CloudLight, StarsOfAPictureAreNoClouds) {
    CloseBy scene;
    scene.add({0.3f, 0.1f, 0.0f}, 0.3f, std::uint64_t{star_band} << 48);
    scene.add({-0.3f, 0.1f, 0.0f}, 0.3f, 1);
    const ShadedSplats cut = scene.cut(10);
    ASSERT_EQ(cut.size(), 2);
    const bool star_first = cut.position[0].x > 0.0f;
    EXPECT_EQ(cut.color[star_first ? 0 : 1].x, 0.5f);
    EXPECT_NE(cut.color[star_first ? 1 : 0].x, 0.5f);
}

}  // namespace
}  // namespace astrosplat

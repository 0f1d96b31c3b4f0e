// Projection: place, size, near fade and sort depth of single splats and of whole vectors of them.
#include "render/project.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>

#include "splats/splat_set.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

constexpr ScreenRect everywhere{-1e6f, -1e6f, 1e6f, 1e6f};

Buffer<ScreenSplat> project_all(const ShadedSplats& splats, const Camera& camera) {
    const RenderLayer layer = layer_of("one", splats);
    Buffer<ScreenSplat> out;
    Buffer<Shape> shapes;
    project(make_projection(layer, 0, camera, settings_of(64, 64)), 0, splats.size(), everywhere, out,
            shapes);
    EXPECT_TRUE(shapes.empty());
    return out;
}

/// Enough copies for whole vectors and for what is left over.
ShadedSplats copies(const OneSplat& splat) { return make_splats(std::vector<OneSplat>(19, splat)); }

Camera perspective_camera() {
    Camera camera;
    camera.focal_px = 100.0;
    camera.center_x_px = camera.center_y_px = 32.0;
    camera.near = 1.0;
    return camera;
}

TEST(Project, PerspectiveDividesByDepth) {
    const Buffer<ScreenSplat> found = project_all(copies({{1.0f, 2.0f, -10.0f}, 0.5f}), perspective_camera());
    ASSERT_EQ(found.size(), 19u);
    for (const ScreenSplat& splat : found) {
        EXPECT_EQ(splat.x_px, 42.0f);
        EXPECT_EQ(splat.y_px, 12.0f);  // y down
        EXPECT_EQ(splat.radius_px, 5.0f);
        EXPECT_EQ(std::bit_cast<float>(splat.depth), 1.0f + 4.0f + 100.0f);  // distance squared
    }
}

TEST(Project, OrthographicKeepsSizesAndSortsByDepth) {
    const Buffer<ScreenSplat> found = project_all(copies({{1.0f, 2.0f, -10.0f}, 0.5f}), pixel_camera(64, 64));
    ASSERT_EQ(found.size(), 19u);
    for (const ScreenSplat& splat : found) {
        EXPECT_EQ(splat.x_px, 33.0f);
        EXPECT_EQ(splat.y_px, 30.0f);
        EXPECT_EQ(splat.radius_px, 0.5f);
        EXPECT_EQ(std::bit_cast<float>(splat.depth), 1010.0f);
    }
}

TEST(Project, NearFadeIsTheCamerasOrOneRadius) {
    Camera camera = perspective_camera();
    const ShadedSplats splats = copies({{0.0f, 0.0f, -2.0f}, 0.5f});  // one unit behind the near plane
    const auto opacity = [&](double near_fade) {
        camera.near_fade = near_fade;
        const Buffer<ScreenSplat> found = project_all(splats, camera);
        EXPECT_EQ(found.size(), 19u);
        for (const ScreenSplat& splat : found) EXPECT_EQ(splat.opacity, found.front().opacity);
        return found.front().opacity;
    };
    EXPECT_EQ(opacity(0.0), 1.0f);      // farther than its radius
    EXPECT_EQ(opacity(2.0), 0.5f);      // half way
    EXPECT_EQ(opacity(4.0), 0.15625f);  // smoothstep of a quarter
    const ShadedSplats wide = copies({{0.0f, 0.0f, -2.0f}, 2.0f});
    camera.near_fade = 0.25;
    EXPECT_EQ(project_all(wide, camera).front().opacity, 0.5f);  // its radius, which is larger
}

TEST(Project, TheLimitOfLevelsIsForTheLinesOfThePicture) {
    const ShadedSplats splats = copies({{0.0f, 0.0f, -2.0f}, 0.5f});
    RenderLayer layer = layer_of("one", splats);
    layer.render.lod.max_px = 90.0f;
    const auto limit = [&](std::int64_t height) {
        return make_projection(layer, 0, perspective_camera(), settings_of(64, height)).lod_limit_px;
    };
    EXPECT_EQ(limit(1080), 90.0f);
    EXPECT_EQ(limit(540), 45.0f);
    layer.render.blend = Blend::lighten;  // never split
    EXPECT_EQ(limit(1080), 0.0f);
}

// A million children of one splat are no reason to keep somebody waiting.
TEST(Project, StopsAmongTheChildrenOfASplat) {
    const ShadedSplats splats = make_splats({{{0.0f, 0.0f, -2.0f}, 0.5f}});
    RenderLayer layer = layer_of("one", splats);
    layer.render.falloff.shape = Falloff::Shape::gaussian;
    layer.render.lod.max_px = 0.01f;
    layer.render.lod.max_children = 1 << 20;
    LodTable table(layer.render.falloff);
    table.prepare(10);
    std::atomic<bool> cancelled{false};
    LayerProjection projection = make_projection(layer, 0, perspective_camera(), settings_of(64, 64));
    projection.lod = &table;
    projection.cancelled = &cancelled;
    Buffer<ScreenSplat> out;
    Buffer<Shape> shapes;
    project(projection, 0, 1, everywhere, out, shapes);
    EXPECT_EQ(out.size(), std::size_t{1} << 20);
    out.clear();
    cancelled = true;
    EXPECT_THROW(project(projection, 0, 1, everywhere, out, shapes), Cancelled);
    EXPECT_LT(out.size(), 5000u);
}

TEST(Project, NothingOutsideNearAndFar) {
    Camera camera = perspective_camera();
    EXPECT_EQ(project_all(copies({{0.0f, 0.0f, -1.0f}, 0.5f}), camera).size(), 0u);
    EXPECT_EQ(project_all(copies({{0.0f, 0.0f, -1e6f}, 0.5f}), camera).size(), 19u);
    camera.far = 20.0;
    EXPECT_EQ(project_all(copies({{0.0f, 0.0f, -20.0f}, 0.5f}), camera).size(), 19u);
    EXPECT_EQ(project_all(copies({{0.0f, 0.0f, -20.5f}, 0.5f}), camera).size(), 0u);
}

/// Of all sizes, in front of the camera and behind it, on the frame and beside it; every fifth a star.
ShadedSplats mixed_splats() {
    std::vector<OneSplat> splats;
    for (int i = 0; i < 4000; ++i) {
        const auto part = [&](int n) { return static_cast<float>(i * n % 3989) / 3989.0f; };
        const float size = part(1117) * part(1117) * part(1117);
        splats.push_back({{12.0f * part(727) - 6.0f, 12.0f * part(1931) - 6.0f, 4.0f - 12.0f * part(2953)},
                          0.01f + 1.5f * size,
                          0.1f + 0.8f * part(331),
                          {1.0f, part(557), 0.5f}});
    }
    ShadedSplats set = make_splats(splats);
    for (std::size_t i = 0; i < set.id.size(); i += 5) set.id[i] |= star_band << 48;
    return set;
}

bool is_before(const ScreenSplat& a, const ScreenSplat& b) { return in_front_of(a, b); }

/// A row alone is no vector.
TEST(Project, VectorsDivideWhatSingleSplatsDo) {
    const ShadedSplats splats = mixed_splats();
    const LodTable table = [] {
        LodTable made({Falloff::Shape::gaussian});
        made.prepare(4);
        return made;
    }();
    for (const float noise : {0.0f, 0.5f})
        for (const float star_distance : {0.0f, 5.0f}) {
            RenderLayer asked = layer_of("mixed", splats, Blend::over, Falloff::Shape::gaussian);
            asked.render.lod = {100.0f, 256, noise};
            asked.render.lod.star_distance = star_distance;
            LayerProjection layer = make_projection(asked, 0, perspective_camera(), settings_of(64, 64));
            layer.lod = &table;
            const ScreenRect rect{0.0f, 0.0f, 64.0f, 64.0f};
            Buffer<ScreenSplat> together, single;
            Buffer<Shape> shapes;
            project(layer, 0, splats.size(), rect, together, shapes);
            for (std::int64_t i = 0; i < splats.size(); ++i) project(layer, i, i + 1, rect, single, shapes);
            std::ranges::sort(together, is_before);
            std::ranges::sort(single, is_before);
            ASSERT_EQ(together.size(), single.size());
            EXPECT_GT(single.size(), 5000u) << "children";
            EXPECT_EQ(std::memcmp(together.data(), single.data(), single.size() * sizeof(ScreenSplat)), 0)
                << noise << " " << star_distance;
        }
}

}  // namespace
}  // namespace astrosplat

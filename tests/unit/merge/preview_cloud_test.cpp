// Clouds of splats for a preview: their light close by, and their evenness.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "core/real.h"
#include "core/shared_maths.h"
#include "merge/cut.h"
#include "render/lod.h"
#include "render/render.h"
#include "splats/splat_set.h"
#include "support/splats.h"
#include "unit/merge/cloud.h"

namespace astrosplat {
namespace {

// Structure close by (lod.noise) in a preview's splats: as bright as the children of the final frame are on
// average, and 1 where there are none.

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
        return test::cut_of(cloud.merged(), MergeSettings(layer.render),
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

TEST(CloudLight, SplatsAreBrightWhereTheirChildrenAre) {
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

// Splats in place of a lattice: as even as it was although its cells are alike and in line, and none of both
// sides of its middle.

struct Seen {
    double unevenness;  // standard deviation over mean of the light of its middle
    double cover;       // of what is drawn, over that of the splats
    std::size_t splats;
};

/// A block of 48 x 48 x `deep` splats through merged ones that stand for 64 each, from so far beside its
/// front.
Seen seen_through_splats(bool lattice, int deep = 48, double degrees = 0.0) {
    constexpr int splats_a_side = 48, side = 256, first = 96, end = 160;  // px
    test::Cloud cloud;
    const auto at = [](int i) { return (static_cast<float>(i) + 0.5f) / splats_a_side * 2.0f - 1.0f; };
    const int count = splats_a_side * splats_a_side * deep;
    for (int i = 0; i < count; ++i) {
        const int slice = i / splats_a_side / splats_a_side + (splats_a_side - deep) / 2;
        cloud.add({at(i % splats_a_side), at(i / splats_a_side % splats_a_side), at(slice)}, glm::vec3(0.5f),
                  0.01f, 2.0f / splats_a_side);
    }
    RenderLayer layer;
    layer.render.blend = Blend::add;
    CameraParams params;
    params.projection = Projection::orthographic;
    const double angle = real::radians(degrees);
    params.position = glm::dvec3(0.0, -10.0 * std::sin(angle), 10.0 * std::cos(angle));
    params.height = 3.0;
    const Camera camera = make_camera(params, side, side, {});
    RenderSettings frame;
    frame.width = frame.height = side;
    const ShadedSplats cut =
        test::cut_of(cloud.merged(), MergeSettings(layer.render, lattice),
                     make_projection(layer, 0, camera, frame), {count / 64, 0.0f, side, side});
    layer.splats = &cut;
    const Image image = render(std::span(&layer, 1), camera, nullptr, frame).beauty;
    double sum = 0.0, squares = 0.0, cover = 0.0;
    const int rows = degrees > 0.0 ? (end - first) / 4 : (end - first) / 2;  // aslant it is lower
    for (int y = side / 2 - rows; y < side / 2 + rows; ++y)
        for (int x = first; x < end; ++x) {
            const double light = double(image.at(x, y)[0]);
            sum += light;
            squares += light * light;
        }
    for (std::size_t i = 0; i < cut.radius.size(); ++i)
        cover += double(cut.alpha[i]) * double(cut.radius[i]) * double(cut.radius[i]);
    const double pixels = 2.0 * rows * (end - first), mean = sum / pixels;
    const double whole = count * 0.01 * (2.0 / splats_a_side) * (2.0 / splats_a_side);
    return {std::sqrt(squares / pixels - mean * mean) / mean, cover / whole, cut.radius.size()};
}

TEST(MergedLattice, HasNoStripes) {
    const double even = seen_through_splats(true).unevenness;
    EXPECT_LT(even, 0.14) << "waves 17 % high along either axis; the root mean square of both";
    EXPECT_GT(seen_through_splats(false).unevenness, 1.6 * even) << "as other sets' splats would look";
}

// Its cells look wider than high: each becomes several splats, which lie side by side and share its light.
TEST(MergedLattice, HasNoStripesAslantEither) {
    constexpr int deep = 8;
    for (const double degrees : {60.0, 72.0}) {
        const Seen seen = seen_through_splats(true, deep, degrees);
        EXPECT_LT(seen.unevenness, 0.16) << degrees;
        EXPECT_GT(seen_through_splats(false, deep, degrees).unevenness, 2.0 * seen.unevenness) << degrees;
        EXPECT_NEAR(seen.cover, 1.0, 1e-4) << degrees;
        EXPECT_LE(seen.splats, 48u * 48u * deep / 64u) << degrees;
        EXPECT_GT(seen.splats, 48u * 48u * deep / 192u) << degrees;
    }
}

TEST(MergedLattice, KeepsToItsBudgetFromEverySide) {
    for (const int deep : {2, 8, 48})
        for (double degrees = 0.0; degrees < 90.0; degrees += 5.0)
            EXPECT_LE(seen_through_splats(true, deep, degrees).splats,
                      48u * 48u * static_cast<unsigned>(deep) / 64u)
                << deep << " deep, from " << degrees;
}

/// Leaves of the tree over a disk that have splats from above its middle and from below it.
int mixed_leaves(double spacing) {
    constexpr std::uint32_t count = 20000;
    SplatSet set;
    set.spacing = glm::dvec3(spacing);
    const auto uniform = [](std::uint32_t i, std::uint32_t which) {
        return shared::as_uniform(shared::as_hash(7u, i, 0u, which));
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        add_splat(set, {10.0f * uniform(i, 1), 0.72f * uniform(i, 2), 10.0f * uniform(i, 3)}, glm::vec3(0.5f),
                  0.5f);
    }
    const auto middle = static_cast<float>(bounds(set).center().y);
    const MergeTree tree = build_merge_tree(set);
    int mixed = 0;
    for (const MergeNode& node : tree.nodes) {
        if (!node.is_leaf()) continue;
        std::int64_t above = 0;
        for (std::int64_t r = node.first; r < node.end; ++r) above += set.position[tree.rows[r]].y > middle;
        mixed += above > 0 && above < node.end - node.first;
    }
    return mixed;
}

/// A merged splat of both would be all before the dust of a disk, or all behind it.
TEST(MergedLattice, IsHalvedInItsMiddle) {
    EXPECT_EQ(mixed_leaves(0.1), 0);
    EXPECT_GT(mixed_leaves(0.0), 100) << "as other sets are";
}

}  // namespace
}  // namespace astrosplat

// Dots in place of a lattice: as even as it was although its cells are alike and in line, and none of both
// sides of its middle.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/real.h"
#include "core/shared_maths.h"
#include "render/render.h"
#include "unit/merge/cloud.h"

namespace astrosplat {
namespace {

struct Seen {
    double unevenness;  // standard deviation over mean of the light of its middle
    double cover;       // of the dots, over that of the splats
    std::size_t dots;
};

/// A block of 48 x 48 x `deep` splats through dots that stand for 64 each, seen from so far beside its front.
Seen seen_through_dots(bool lattice, int deep = 48, double degrees = 0.0) {
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
        test::cut_of(cloud.merged(), DotSettings(layer.render, lattice),
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
    const double even = seen_through_dots(true).unevenness;
    EXPECT_LT(even, 0.14) << "waves 17 % high along either axis; the root mean square of both";
    EXPECT_GT(seen_through_dots(false).unevenness, 1.6 * even) << "as other sets' dots would look";
}

// Its cells look wider than high: each becomes several dots, which lie side by side and share its light.
TEST(MergedLattice, HasNoStripesAslantEither) {
    constexpr int deep = 8;
    for (const double degrees : {60.0, 72.0}) {
        const Seen seen = seen_through_dots(true, deep, degrees);
        EXPECT_LT(seen.unevenness, 0.16) << degrees;
        EXPECT_GT(seen_through_dots(false, deep, degrees).unevenness, 2.0 * seen.unevenness) << degrees;
        EXPECT_NEAR(seen.cover, 1.0, 1e-4) << degrees;
        EXPECT_LE(seen.dots, 48u * 48u * deep / 64u) << degrees;
        EXPECT_GT(seen.dots, 48u * 48u * deep / 192u) << degrees;
    }
}

TEST(MergedLattice, KeepsToItsBudgetFromEverySide) {
    for (const int deep : {2, 8, 48})
        for (double degrees = 0.0; degrees < 90.0; degrees += 5.0)
            EXPECT_LE(seen_through_dots(true, deep, degrees).dots,
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
        set.position.push_back({10.0f * uniform(i, 1), 0.72f * uniform(i, 2), 10.0f * uniform(i, 3)});
        set.color.push_back(glm::vec3(0.5f));
        set.alpha.push_back(0.5f);
        set.distance.push_back(0.0f);
        set.id.push_back(i);
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

/// A dot of both would be all before the dust of a disk, or all behind it.
TEST(MergedLattice, IsHalvedInItsMiddle) {
    EXPECT_EQ(mixed_leaves(0.1), 0);
    EXPECT_GT(mixed_leaves(0.0), 100) << "as other sets are";
}

}  // namespace
}  // namespace astrosplat

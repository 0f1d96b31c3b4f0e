// Dots in place of a lattice: as even as it was although its cells are alike and in line, and none of both
// sides of its middle.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/shared_maths.h"
#include "merge/cut.h"
#include "render/render.h"

namespace astrosplat {
namespace {

/// Standard deviation over mean of the light of the middle of a block of 48^3 splats, seen from the front
/// through dots that stand for 64 each.
double unevenness(bool lattice) {
    constexpr int splats_a_side = 48, side = 256, first = 96, end = 160;  // px
    auto set = std::make_shared<SplatSet>();
    ShadedSplats splats;
    const auto at = [](int i) { return (static_cast<float>(i) + 0.5f) / splats_a_side * 2.0f - 1.0f; };
    for (int i = 0; i < splats_a_side * splats_a_side * splats_a_side; ++i) {
        const glm::vec3 p(at(i % splats_a_side), at(i / splats_a_side % splats_a_side),
                          at(i / splats_a_side / splats_a_side));
        const auto id = static_cast<std::uint64_t>(i);
        set->position.push_back(p);
        set->color.push_back(glm::vec3(0.5f));
        set->alpha.push_back(0.01f);
        set->distance.push_back(0.0f);
        set->id.push_back(id);
        splats.position.push_back(p);
        splats.color.push_back(glm::vec3(0.5f));
        splats.alpha.push_back(0.01f);
        splats.radius.push_back(2.0f / splats_a_side);
        splats.id.push_back(id);
    }
    RenderLayer layer;
    layer.render.blend = Blend::add;
    CameraParams params;
    params.projection = Projection::orthographic;
    params.position = glm::dvec3(0.0, 0.0, 10.0);
    params.height = 3.0;
    const Camera camera = make_camera(params, side, side, {});
    RenderSettings frame;
    frame.width = frame.height = side;
    const auto tree = std::make_shared<const MergeTree>(build_merge_tree(*set));
    const MergedSplats merged = merge_splats({set, tree, 1.0f}, splats);
    const DotSettings dots(layer.render, lattice);
    const CutLayer source{&merged, &dots, make_projection(layer, 0, camera, frame)};
    const std::vector<ShadedSplats> cut = cut_splats(
        std::span(&source, 1), {splats_a_side * splats_a_side * splats_a_side / 64, 0.0f, side, side});
    layer.splats = &cut[0];
    const Image image = render(std::span(&layer, 1), camera, nullptr, frame).beauty;
    double sum = 0.0, squares = 0.0;
    for (int y = first; y < end; ++y)
        for (int x = first; x < end; ++x) {
            const double light = double(image.at(x, y)[0]);
            sum += light;
            squares += light * light;
        }
    const double count = (end - first) * (end - first), mean = sum / count;
    return std::sqrt(squares / count - mean * mean) / mean;
}

TEST(MergedLattice, HasNoStripes) {
    const double even = unevenness(true);
    EXPECT_LT(even, 0.14) << "waves 17 % high along either axis; the root mean square of both";
    EXPECT_GT(unevenness(false), 1.6 * even) << "as other sets' dots would look";
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

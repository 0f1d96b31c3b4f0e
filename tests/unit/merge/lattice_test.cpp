// Dots in place of an even lattice: as even as it was, for all its cells are alike and in line.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

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
    EXPECT_LT(even, 0.09) << "waves 12 % high, of which this is the root mean square";
    EXPECT_GT(unevenness(false), 2.0 * even) << "as other sets' dots would look";
}

}  // namespace
}  // namespace astrosplat

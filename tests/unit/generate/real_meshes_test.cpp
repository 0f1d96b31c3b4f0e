// Real meshes: the search against a plain loop over all triangles, 100,000 positions each (5,000 in builds
// without optimisation and under sanitizers, where the loop would take minutes).
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "core/parallel.h"
#include "generate/triangle_tree.h"
#include "source/obj.h"
#include "support/test_data.h"
#include "unit/generate/generate_support.h"
#include "unit/generate/lattice_positions.h"

namespace astrosplat {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__OPTIMIZE__)
constexpr double positions = 5e3;
#else
constexpr double positions = 1e5;
#endif

class RealMeshes : public testing::TestWithParam<const char*> {};

TEST_P(RealMeshes, EqualBruteForceBitForBit) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, std::string("meshes/") + GetParam());
    std::vector<TexturedMesh> meshes;
    meshes.push_back(test::textured(load_obj(file), test::flat_texture({1, 1, 1, 1})));
    apply_uv(meshes[0].mesh, UvMode::planar_xz, bounds(meshes));
    const Bounds box = bounds(meshes);
    const double side = std::max({box.extent().x, box.extent().y, box.extent().z});
    const double max_distance = 0.03 * side;
    SourceParams source;
    const glm::dvec3 grown = box.extent() + 2.0 * max_distance;
    source.voxel_size = std::cbrt(2.0 * grown.x * grown.y * grown.z / positions);
    const Lattice lattice = make_lattice(source, meshes, max_distance);
    ASSERT_GE(static_cast<double>(lattice.positions()), positions);

    const SplatSet set = generate(meshes, lattice, max_distance, 1.0, 11);
    const Mesh* const shape = &meshes[0].mesh;
    const TriangleTree tree = make_triangle_tree({&shape, 1});
    const test::Oracle oracle(meshes[0].mesh);
    std::atomic<std::int64_t> kept{0}, different{0};
    parallel_chunks(lattice.positions(), 256, [&](std::int64_t begin, std::int64_t end, int) {
        auto at = static_cast<std::size_t>(
            std::lower_bound(set.id.begin(), set.id.end(), static_cast<std::uint64_t>(begin)) -
            set.id.begin());
        for (auto id = static_cast<std::uint64_t>(begin); id < static_cast<std::uint64_t>(end); ++id) {
            const glm::dvec3 p = jittered_position(lattice, id, 1.0, 11);
            const ClosestPoint slow = oracle.closest(p, max_distance),
                               fast = closest_point(tree, p, max_distance).closest;
            bool same = fast.triangle == slow.triangle && fast.distance_squared == slow.distance_squared;
            const bool in_set = at < set.id.size() && set.id[at] == id;
            same = same && in_set == (slow.triangle != ClosestPoint::none);
            if (in_set && same) {
                const Mesh::Triangle& t = meshes[0].mesh.triangles[slow.triangle];
                const auto corner = [&](std::size_t k) { return glm::dvec2(meshes[0].mesh.uvs[t.uv[k]]); };
                const glm::vec2 uv(corner(0) + (corner(1) - corner(0)) * slow.barycentric.x +
                                   (corner(2) - corner(0)) * slow.barycentric.y);
                same = fast.barycentric == slow.barycentric && set.uv[at] == uv &&
                       set.distance[at] == static_cast<float>(std::sqrt(slow.distance_squared));
            }
            at += in_set ? 1 : 0;
            kept += in_set ? 1 : 0;
            different += same ? 0 : 1;
        }
    });
    EXPECT_EQ(different, 0);
    EXPECT_EQ(kept, set.size());
    EXPECT_GT(kept, static_cast<std::int64_t>(positions / 50.0));
}

INSTANTIATE_TEST_SUITE_P(Meshes, RealMeshes,
                         testing::Values("spot/spot_triangulated.obj", "smallbodies/phobos.obj",
                                         "smallbodies/epimetheus.obj", "smallbodies/216Kleopatra.obj",
                                         "qt3d/starfield.obj"));

TEST(RealMesh, AutomaticVoxelsKeepAboutCount) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, "meshes/spot/spot_triangulated.obj");
    std::vector<TexturedMesh> meshes;
    meshes.push_back(test::textured(load_obj(file), test::flat_texture({1, 1, 1, 1})));
    SourceParams source;
    source.count = 200000;
    const double distance = resolved_max_distance(source, bounds(meshes));
    const SplatSet set = generate(meshes, make_lattice(source, meshes, distance), distance, 1.0, 3);
    EXPECT_NEAR(static_cast<double>(set.size()), 200000.0, 30000.0);
}

}  // namespace
}  // namespace astrosplat

// Generation against a plain loop over the lattice, and the lattice itself.
#include "generate/generate.h"

#include "generate/lattice.h"
#include "source/texture.h"
#include "source/textured_mesh.h"
#include "support/test.h"
#include "unit/generate/generate_support.h"

namespace astrosplat {
namespace {

// Generation against a plain loop over the lattice, for any thread count; what is stored; what is dropped.

using glm::dvec3;
using glm::i64vec3;
using test::flat_texture;
using test::lattice_of;
using test::textured;

/// Everything DESIGN 4 says, one position after the other.
SplatSet plain_generate(const TexturedMesh& m, const Lattice& lattice, double max_distance, double jitter,
                        std::uint32_t seed) {
    const test::Oracle oracle(m.mesh);
    SplatSet set;
    for (std::uint64_t id = 0; id < std::uint64_t(lattice.positions()); ++id) {
        const dvec3 p = jittered_position(lattice, id, jitter, seed);
        const ClosestPoint c = oracle.closest(p, max_distance);
        if (c.triangle == ClosestPoint::none) continue;
        const Mesh::Triangle& t = m.mesh.triangles[c.triangle];
        const glm::dvec2 a(m.mesh.uvs[t.uv[0]]), b(m.mesh.uvs[t.uv[1]]), d(m.mesh.uvs[t.uv[2]]);
        const glm::vec2 uv(a + (b - a) * c.barycentric.x + (d - a) * c.barycentric.y);
        const TextureSample picture = sample(m.textures[0], uv);
        if (picture.alpha == 0.0f) {
            ++set.zero_alpha;
            continue;
        }
        const dvec3 v0(m.mesh.positions[t.position[0]]);
        const dvec3 n = glm::cross(dvec3(m.mesh.positions[t.position[1]]) - v0,
                                   dvec3(m.mesh.positions[t.position[2]]) - v0);
        set.id.push_back(id);
        set.position.push_back(glm::vec3(p));
        set.color.push_back(picture.color);
        set.alpha.push_back(picture.alpha);
        set.distance.push_back(float(std::sqrt(c.distance_squared)));
        set.uv.push_back(uv);
        set.normal.push_back(glm::vec3(n / std::sqrt(glm::dot(n, n))));
        set.mesh.push_back(0);
    }
    return set;
}

class GenerateTest : public testing::Test {
  protected:
    ~GenerateTest() override { set_thread_count(0); }
};

TEST_F(GenerateTest, EqualsThePlainLoopForAnyThreadCount) {
    for (const char* name : {"plane", "disk", "sphere"}) {
        std::vector<TexturedMesh> meshes = {textured(builtin_mesh(name, 1.5), test::half_lit())};
        const Lattice lattice = lattice_of({19, 16, 21}, meshes, 0.6);  // whole and broken blocks
        const SplatSet plain = plain_generate(meshes[0], lattice, 0.6, 1.0, 5);
        EXPECT_GT(plain.size(), 100) << name;
        EXPECT_GT(plain.zero_alpha, 100) << name;
        for (const int threads : {1, 2, 3, 7}) {
            set_thread_count(threads);
            SCOPED_TRACE(name);
            test::expect_same_bits(generate(meshes, lattice, 0.6, 1.0, 5), plain);
        }
    }
}

TEST_F(GenerateTest, LongAndThinLatticesToo) {
    std::vector<TexturedMesh> meshes = {textured(builtin_mesh("sphere", 1.0))};
    for (const i64vec3 n : {i64vec3(1, 1, 1), i64vec3(600, 2, 3), i64vec3(3, 400, 4), i64vec3(4, 1, 333)}) {
        const Lattice lattice = lattice_of(n, meshes, 1.0);
        test::expect_same_bits(generate(meshes, lattice, 1.0, 0.5, 9),
                               plain_generate(meshes[0], lattice, 1.0, 0.5, 9));
    }
}

// Thousands of triangles near every block, many of them equal.
TEST_F(GenerateTest, DenseMeshes) {
    Mesh mesh = builtin_mesh("sphere", 1.0);
    const std::size_t once = mesh.triangles.size();
    while (mesh.triangles.size() < 6000)
        mesh.triangles.push_back(mesh.triangles[mesh.triangles.size() - once]);
    for (glm::vec3& p : mesh.positions) p *= 0.02f;
    std::vector<TexturedMesh> meshes = {textured(std::move(mesh))};
    const Lattice lattice = lattice_of({6, 5, 7}, meshes, 0.3);
    const SplatSet plain = plain_generate(meshes[0], lattice, 0.3, 1.0, 2);
    EXPECT_GT(plain.size(), 200);
    test::expect_same_bits(generate(meshes, lattice, 0.3, 1.0, 2), plain);
}

TEST_F(GenerateTest, PlaneWithoutJitterIsKnownByHand) {
    std::vector<TexturedMesh> meshes = {
        textured(builtin_mesh("plane", 1.0), flat_texture({0.25f, 0.5f, 1.0f, 0.5f}))};
    // Corners at y = -2 -1 0 1 2, centres at -1.5 -0.5 0.5 1.5.
    const SplatSet set = generate(meshes, lattice_of({2, 4, 2}, meshes, 1.0, dvec3(0, 2, 0)), 1.0, 0.0, 1);
    ASSERT_EQ(set.size(), 3 * 9 + 2 * 4);  // both sides of the plane, the distance included
    EXPECT_EQ(set.position[0], glm::vec3(-5, -1, -5));
    EXPECT_EQ(set.distance[0], 1.0f);
    EXPECT_EQ(set.uv[0], glm::vec2(0, 1));  // -z is the top of the picture
    EXPECT_EQ(set.position[3], glm::vec3(-5, 0, -5));
    EXPECT_EQ(set.distance[3], 0.0f);
    EXPECT_EQ(set.position[27], glm::vec3(-2.5f, -0.5f, -2.5f));
    EXPECT_EQ(set.distance[27], 0.5f);
    EXPECT_EQ(set.id[27], 45u + 2u * 1u);  // 3 * 5 * 3 corners, then the row j = 1
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        EXPECT_EQ(set.color[i], glm::vec3(0.25f, 0.5f, 1.0f));
        EXPECT_EQ(set.alpha[i], 0.5f);
        EXPECT_EQ(std::fabs(set.normal[i].y), 1.0f);
    }
    EXPECT_EQ(set.spacing, dvec3(5, 1, 5));
    EXPECT_EQ(set.max_distance, 1.0);
    EXPECT_TRUE(set.generated);
    EXPECT_EQ(set.test_positions, 45 + 16);
}

TEST_F(GenerateTest, IdsAscendAndDistancesStayBelowTheLimit) {
    std::vector<TexturedMesh> meshes = {textured(builtin_mesh("sphere", 1.0))};
    SourceParams source;
    source.count = 20000;
    const Lattice lattice = make_lattice(source, meshes, 0.4);
    const SplatSet set = generate(meshes, lattice, 0.4, 1.0, 3);
    for (std::size_t i = 1; i < set.id.size(); ++i) ASSERT_LT(set.id[i - 1], set.id[i]);
    EXPECT_LE(*std::max_element(set.distance.begin(), set.distance.end()), 0.4f);
    EXPECT_GT(*std::max_element(set.distance.begin(), set.distance.end()), 0.39f);
    const auto inside = std::count_if(set.position.begin(), set.position.end(),
                                      [](const glm::vec3& p) { return glm::length(p) < 5.0f; });
    EXPECT_NEAR(double(inside) / double(set.size()), 0.47,
                0.02);  // both sides count
}

// The centres of all batches come after the corners of all batches.
TEST_F(GenerateTest, SeveralBatchesKeepTheOrderOfIds) {
    std::vector<TexturedMesh> meshes = {textured(builtin_mesh("plane", 1.0))};
    // 1 x 93 x 93 blocks, all of them near enough.
    const Lattice lattice = lattice_of({2, 370, 370}, meshes, 20.0, dvec3(0, 0.1, 0));
    set_thread_count(3);
    const SplatSet set = generate(meshes, lattice, 20.0, 1.0, 3);
    ASSERT_EQ(set.size(), lattice.positions());
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        ASSERT_EQ(set.id[i], i);
        ASSERT_EQ(set.position[i], glm::vec3(jittered_position(lattice, i, 1.0, 3)));
    }
}

TEST_F(GenerateTest, AutomaticVoxelsKeepAboutCount) {
    for (const char* name : {"plane", "sphere"}) {
        std::vector<TexturedMesh> meshes = {textured(builtin_mesh(name, 1.0))};
        SourceParams source;
        source.count = 50000;
        const double distance = resolved_max_distance(source, bounds(meshes));
        const SplatSet set = generate(meshes, make_lattice(source, meshes, distance), distance, 1.0, 3);
        EXPECT_NEAR(double(set.size()), 50000.0, 7500.0) << name;
    }
}

TEST_F(GenerateTest, SeveralMeshesWithTheirPictures) {
    Mesh low = builtin_mesh("plane", 1.0), high = low;
    for (glm::vec3& p : high.positions) p.y = 1.0f;
    std::vector<TexturedMesh> meshes = {textured(low, flat_texture({1, 0, 0, 1})),
                                        textured(high, flat_texture({0, 1, 0, 1}))};
    meshes[0].textures[0].credit = "NASA";
    meshes[1].textures[0].credit = "ESA";
    meshes[1].textures[0].divided = true;
    meshes.push_back(meshes[0]);  // ties with the first, which wins
    const SplatSet set = generate(meshes, lattice_of({4, 12, 4}, meshes, 0.3), 0.3, 1.0, 1);
    int found[3] = {0, 0, 0};
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        ++found[set.mesh[i]];
        const bool upper = set.position[i].y > 0.5f;
        EXPECT_EQ(set.mesh[i], upper ? 1u : 0u);
        EXPECT_EQ(set.color[i], upper ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0));
    }
    EXPECT_GT(found[0], 50);
    EXPECT_GT(found[1], 50);
    EXPECT_EQ(found[2], 0);
    EXPECT_EQ(set.credit, "NASA; ESA");
    EXPECT_TRUE(set.divided);
}

// A picture of 1-texel stripes: a voxel 10 texels wide sees their mean,
// a bilinear sample sees single stripes.
TEST_F(GenerateTest, AreaFilterAveragesOverTheVoxel) {
    Texture stripes = flat_texture({1, 1, 1, 1}, 200);
    for (std::int64_t y = 0; y < 200; ++y)
        for (std::int64_t x = 0; x < 200; x += 2) std::fill_n(stripes.image.at(x, y), 3, 0.0f);
    const auto spread = [&](TextureSettings::Filter filter) {
        stripes.filter = filter;
        std::vector<TexturedMesh> meshes = {textured(builtin_mesh("plane", 1.0), stripes)};
        const SplatSet set =
            generate(meshes, lattice_of({20, 4, 20}, meshes, 1.0, dvec3(0, 1, 0)), 1.0, 1.0, 1);
        float lo = 1.0f, hi = 0.0f;
        for (std::size_t i = 0; i < set.id.size(); ++i) {
            if (std::fabs(set.uv[i].x - 0.5f) > 0.4f) continue;  // the border halves the box
            lo = std::min(lo, set.color[i].x);
            hi = std::max(hi, set.color[i].x);
        }
        return hi - lo;
    };
    EXPECT_GT(spread(TextureSettings::Filter::bilinear), 0.9f);
    EXPECT_LT(spread(TextureSettings::Filter::area),
              0.11f);  // 10 texels: at most one stripe too many or too few
}

TEST_F(GenerateTest, CancelStops) {
    std::vector<TexturedMesh> meshes = {textured(builtin_mesh("sphere", 1.0))};
    const std::atomic<bool> cancelled{true};
    const Lattice lattice = make_lattice(SourceParams(), meshes, 0.2);
    EXPECT_THROW(generate(meshes, lattice, 0.2, 1.0, 1, {{}, &cancelled}), Cancelled);
}

TEST_F(GenerateTest, MoreThanTheMemoryIsRefusedBeforeItIsTaken) {
    std::vector<TexturedMesh> meshes = {textured(builtin_mesh("sphere", 1.0))};
    SourceParams source;
    source.count = std::int64_t{1} << 50;
    EXPECT_THROW(generate(meshes, make_lattice(source, meshes, 0.2), 0.2, 1.0, 1), InputError);
}

TEST_F(GenerateTest, EmptySpaceCostsNothing) {
    Mesh mesh = builtin_mesh("plane", 1.0);
    for (glm::vec3& p : mesh.positions) p *= 1e-4f;
    const std::vector<TexturedMesh> meshes = {textured(std::move(mesh))};
    // 2e18 positions: only a search from the top can end.
    const Lattice lattice = lattice_of(i64vec3(1'000'001), meshes, 0.002, dvec3(500.0));
    const SplatSet set = generate(meshes, lattice, 0.002, 0.0, 1);
    EXPECT_GT(set.size(), 30);
    EXPECT_LT(set.size(), 200);
}

// With a camera's picture a position shows what the camera sees there, not what its closest point shows.
TEST_F(GenerateTest, ACamerasPictureIsSeenAtThePositionsThemselves) {
    std::vector<TexturedMesh> meshes = {
        textured(builtin_mesh("plane", 1.0), flat_texture({0.25f, 0.5f, 1.0f, 1.0f}))};
    TexturedMesh& mesh = meshes[0];
    UvCamera params;
    params.position = dvec3(0.0, 0.5, 0.0);  // amid the positions: some are behind it
    params.up = dvec3(0.0, 0.0, -1.0);
    params.fov = 120.0;
    mesh.camera = picture_camera(params, 1.0);
    apply_camera_uv(mesh.mesh, *mesh.camera);
    mesh.textures[0].wrap = TextureSettings::Wrap::black;
    const SplatSet set = generate(meshes, lattice_of({40, 10, 40}, meshes, 1.0), 1.0, 1.0, 9u);
    ASSERT_GT(set.size(), 1000);
    EXPECT_GT(set.zero_alpha, 1000);
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        const auto seen = place_in_picture(*mesh.camera, dvec3(set.position[i]));
        ASSERT_TRUE(seen);
        ASSERT_LT(glm::distance(seen->uv, glm::dvec2(set.uv[i])), 1e-4);
        ASSERT_GE(std::min(set.uv[i].x, set.uv[i].y), -0.0625f);  // half a texel is filtered beyond the edge
        ASSERT_LE(std::max(set.uv[i].x, set.uv[i].y), 1.0625f);
    }
}

// Lattices: names and places of positions, jitter, the choice of voxels, and its messages.

Lattice small_lattice() {
    Lattice lattice;
    lattice.box.lo = dvec3(-1, 0, 10);
    lattice.box.hi = dvec3(1, 3, 14);
    lattice.n = i64vec3(2, 3, 4);
    return lattice;
}

std::vector<TexturedMesh> one_plane() { return {test::textured(builtin_mesh("plane", 2.0))}; }

std::string message(const SourceParams& source, double max_distance = 0.1) {
    return ERROR_OF(make_lattice(source, one_plane(), max_distance));
}

TEST(Lattice, PositionsById) {
    const Lattice lattice = small_lattice();
    EXPECT_EQ(lattice.corners(), 3 * 4 * 5);
    EXPECT_EQ(lattice.positions(), 60 + 24);
    EXPECT_EQ(lattice_position(lattice, 0), dvec3(-1, 0, 10));
    EXPECT_EQ(lattice_position(lattice, 1), dvec3(0, 0, 10));
    EXPECT_EQ(lattice_position(lattice, 3), dvec3(-1, 1, 10));
    EXPECT_EQ(lattice_position(lattice, 12), dvec3(-1, 0, 11));
    EXPECT_EQ(lattice_position(lattice, 59), dvec3(1, 3, 14));
    EXPECT_EQ(lattice_position(lattice, 60), dvec3(-0.5, 0.5, 10.5));
    EXPECT_EQ(lattice_position(lattice, 83), dvec3(0.5, 2.5, 13.5));
    EXPECT_EQ(corner_id(lattice, {1, 2, 3}), (3u * 4u + 2u) * 3u + 1u);
    EXPECT_EQ(centre_id(lattice, {1, 2, 3}), 60u + (3u * 3u + 2u) * 2u + 1u);
}

TEST(Lattice, JitterFillsHalfAVoxelAndNoMore) {
    const Lattice lattice = small_lattice();
    for (const double jitter : {0.0, 0.25, 1.0}) {
        double largest = 0.0, sum = 0.0;
        for (std::uint32_t seed = 1; seed <= 100; ++seed)
            for (std::uint64_t id = 0; id < 84; ++id) {
                const dvec3 moved =
                    jittered_position(lattice, id, jitter, seed) - lattice_position(lattice, id);
                for (int axis = 0; axis < 3; ++axis) {
                    const double share = moved[axis] / (0.5 * lattice.spacing()[axis]);
                    largest = std::max(largest, std::fabs(share));
                    sum += share;
                }
            }
        EXPECT_LE(largest, jitter * (1.0 + 1e-12));
        EXPECT_GE(largest, jitter * 0.999);
        EXPECT_NEAR(sum / 25200.0, 0.0,
                    jitter * 4.0 * std::sqrt(1.0 / 3.0 / 25200.0));  // four standard deviations
    }
}

TEST(Lattice, SeedsComeFromNamesAndAreNeverZero) {
    EXPECT_EQ(resolved_seed(7, "stars"), 7u);
    EXPECT_NE(resolved_seed(0, "stars"), resolved_seed(0, "dust"));
    EXPECT_NE(resolved_seed(0, "ab"), resolved_seed(0, "ba"));
    EXPECT_EQ(resolved_seed(0, "stars"), resolved_seed(0, "stars"));
    std::set<std::uint32_t> seeds;
    for (int i = 0; i < 1000; ++i) seeds.insert(resolved_seed(0, std::to_string(i)));
    EXPECT_EQ(seeds.size(), 1000u);
    EXPECT_EQ(seeds.count(0), 0u);
}

TEST(Lattice, MaxDistanceZeroIsTwoPercentOfTheLongestSide) {
    SourceParams source;
    EXPECT_DOUBLE_EQ(resolved_max_distance(source, bounds(one_plane())), 0.2);
    source.max_distance = 0.7;
    EXPECT_EQ(resolved_max_distance(source, bounds(one_plane())), 0.7);
    source.max_distance = -1.0;
    EXPECT_THROW(resolved_max_distance(source, bounds(one_plane())), InputError);
}

TEST(Lattice, BufferGrowsTheBoxOnBothSides) {
    SourceParams source;
    source.voxels = i64vec3(10, 2, 5);
    const Lattice automatic = make_lattice(source, one_plane(), 0.5);
    EXPECT_EQ(automatic.box.lo, dvec3(-5.5, -0.5, -3.0));
    EXPECT_EQ(automatic.box.hi, dvec3(5.5, 0.5, 3.0));
    EXPECT_EQ(automatic.n, i64vec3(10, 2, 5));
    source.buffer = dvec3(1, 2, 3);
    EXPECT_EQ(make_lattice(source, one_plane(), 0.5).box.hi, dvec3(6, 2, 5.5));
}

TEST(Lattice, VoxelSizeGrowsTheBoxEvenly) {
    SourceParams source;
    source.voxel_size = 0.4;  // the box is 11 x 1 x 6: 27.5, 2.5 and 15 voxels
    const Lattice lattice = make_lattice(source, one_plane(), 0.5);
    EXPECT_EQ(lattice.n, i64vec3(28, 3, 15));
    EXPECT_NEAR(lattice.box.lo.x, -5.6, 1e-12);
    EXPECT_NEAR(lattice.box.hi.x, 5.6, 1e-12);
    EXPECT_NEAR(lattice.box.hi.y, 0.6, 1e-12);
    EXPECT_NEAR(lattice.box.hi.z, 3.0, 1e-12);
    source.voxel_size = 100.0;
    EXPECT_EQ(make_lattice(source, one_plane(), 0.5).n, i64vec3(1, 1, 1));
}

TEST(Lattice, FlatBoxesHaveOneVoxel) {
    SourceParams source;
    source.buffer = dvec3(0.0);
    source.voxel_size = 0.5;
    EXPECT_EQ(make_lattice(source, one_plane(), 0.5).n, i64vec3(20, 1, 10));
}

TEST(Lattice, AutomaticVoxelsFollowTheFormula) {
    SourceParams source;
    source.count = 4000;
    const Lattice lattice = make_lattice(source, one_plane(), 0.2);  // edge^3 = 4 * 50 * 0.2 / 4000 = 0.01
    EXPECT_NEAR(lattice.spacing().x, std::cbrt(0.01), 1e-12);
    EXPECT_NEAR(lattice.spacing().y, std::cbrt(0.01), 1e-12);
    EXPECT_NEAR(expected_kept(lattice, one_plane(), 0.2), 4000.0, 1e-6);
}

TEST(LatticeErrors, OneLineEach) {
    SourceParams source;
    source.voxels = i64vec3(10, 0, 10);
    EXPECT_EQ(message(source), "source.voxels: expected at least 1 per axis, found 0");
    source.voxels = i64vec3(1'000'000'000'000, 1'000'000'000'000, 1);
    EXPECT_EQ(
        message(source),
        "source.voxels: expected a lattice of fewer than 2^62 positions, found 1e+12 x 1e+12 x 1 voxels");
    source.voxels = i64vec3(std::numeric_limits<std::int64_t>::max());
    EXPECT_HAS(message(source), "fewer than 2^62");
    source.voxels.reset();
    source.voxel_size = -0.5;
    EXPECT_EQ(message(source), "source.voxel_size: expected a number above 0, found -0.5");
    source.voxel_size = 1e-200;
    EXPECT_HAS(message(source), "source.voxel_size: expected a lattice of fewer than 2^62");
    source.voxel_size = 0.0;
    source.count = 0;
    EXPECT_EQ(message(source), "source.count: expected at least 1, found 0");
    source.count = std::numeric_limits<std::int64_t>::max();
    EXPECT_HAS(message(source), "source.count: expected a lattice of fewer than 2^62");
    source.count = 1000;
    source.buffer = dvec3(1, -1, 1);
    EXPECT_EQ(message(source), "source.buffer: expected numbers of at least 0, found -1");
}

TEST(LatticeErrors, AutomaticVoxelsNeedAnArea) {
    std::vector<TexturedMesh> meshes = one_plane();
    meshes[0].mesh.triangles = {{{0, 0, 0}, {0, 0, 0}, 0}};
    EXPECT_EQ(ERROR_OF(make_lattice(SourceParams(), meshes, 0.1)),
              "source.voxels: expected numbers, because the meshes have no area to choose them by, "
              "found \"auto\"");
}

// The volume near meshes, by Steiner's formula: flat convex meshes of area A and perimeter P have
// 2 A d + pi/2 P d^2 + 4/3 pi d^3 within d. And that `count` and `splats` are kept, on any mesh.

using real::pi;

double steiner(double width, double depth, double d) {
    return 2.0 * width * depth * d + pi / 2.0 * 2.0 * (width + depth) * d * d + 4.0 / 3.0 * pi * d * d * d;
}

Texture half_texture() { return test::half_lit(glm::vec4(1.0f)); }

std::vector<TexturedMesh> rectangle(double width, double depth, Texture texture) {
    Mesh mesh = builtin_mesh("plane", 1.0);
    for (glm::vec3& p : mesh.positions) p = glm::vec3(dvec3(p) * dvec3(width / 10.0, 1.0, depth / 10.0));
    return {textured(std::move(mesh), std::move(texture))};
}

Neighbourhood measured(const std::vector<TexturedMesh>& meshes, double d) {
    Bounds box = bounds(meshes);
    box.lo -= dvec3(d);
    box.hi += dvec3(d);
    return measure_neighbourhood(meshes, box, d);
}

TEST(Neighbourhood, IsSteinersVolume) {
    for (const dvec3& given : {dvec3(10, 10, 1), dvec3(10, 10, 0.01), dvec3(100, 0.01, 2), dvec3(3, 1, 5)}) {
        const double width = given.x, depth = given.y, d = given.z;
        const double volume = steiner(width, depth, d);
        const Neighbourhood near = measured(rectangle(width, depth, flat_texture({1, 1, 1, 1})), d);
        EXPECT_NEAR(near.volume, volume, 0.02 * volume) << width << " x " << depth << ", " << d;
        EXPECT_EQ(near.lit, near.volume);
    }
}

TEST(Neighbourhood, LitIsThePartBeforeThatIsNotTransparent) {
    const Neighbourhood near = measured(rectangle(10, 10, half_texture()), 0.5);
    EXPECT_NEAR(near.lit / near.volume, 0.5, 0.02);
}

TEST(Neighbourhood, ABoxWithoutRoomIsNothing) {
    const std::vector<TexturedMesh> meshes = rectangle(10, 10, half_texture());
    EXPECT_EQ(measure_neighbourhood(meshes, bounds(meshes), 0.5).volume, 0.0);
}

// Splats, and those that were transparent, of a source's lattice.
struct Kept {
    double splats, positions;
};
Kept kept(const SourceParams& source, const std::vector<TexturedMesh>& meshes) {
    const double d = resolved_max_distance(source, bounds(meshes));
    const SplatSet set = generate(meshes, make_lattice(source, meshes, d), d, 1.0, 3);
    return {double(set.size()), double(set.size() + set.zero_alpha)};
}

TEST(AutomaticVoxels, CountIsKeptOnThinMeshesAndWithStrayVertices) {
    SourceParams source;
    source.count = 100000;
    std::vector<TexturedMesh> strip = rectangle(100, 0.01, flat_texture({1, 1, 1, 1}));
    EXPECT_NEAR(kept(source, strip).positions, 1e5, 0.05 * 1e5);
    std::vector<TexturedMesh> stray = rectangle(2, 2, flat_texture({1, 1, 1, 1}));
    stray[0].mesh.positions.emplace_back(300.0f, 40.0f, 0.0f);
    EXPECT_NEAR(kept(source, stray).positions, 1e5, 0.05 * 1e5);
    source.count = 3000;
    EXPECT_NEAR(kept(source, strip).positions, 3e3, 0.1 * 3e3);
}

TEST(AutomaticVoxels, CountIsOfPositionsAndSplatsOfWhatIsLeftOfThem) {
    SourceParams source;
    source.count = 50000;
    const std::vector<TexturedMesh> half = rectangle(10, 10, half_texture());
    EXPECT_NEAR(kept(source, half).positions, 5e4, 0.15 * 5e4);
    EXPECT_NEAR(kept(source, half).splats, 2.5e4, 0.15 * 2.5e4);
    source.splats = 50000;
    EXPECT_NEAR(kept(source, half).splats, 5e4, 0.03 * 5e4);
}

TEST(AutomaticVoxels, TheAreaDecidesWhereItTellsTheCount) {
    SourceParams source;
    source.count = 40000;
    const std::vector<TexturedMesh> plane = rectangle(10, 10, flat_texture({1, 1, 1, 1}));
    EXPECT_NEAR(make_lattice(source, plane, 0.2).spacing().x, std::cbrt(4.0 * 100.0 * 0.2 / 4e4), 1e-12);
}

TEST(AutomaticVoxels, WhatIsExpectedFollowsTheRoomAndTheTransparency) {
    SourceParams source;
    source.count = 50000;
    for (const auto& meshes :
         {rectangle(100, 0.01, flat_texture({1, 1, 1, 1})), rectangle(10, 10, half_texture())}) {
        const double d = resolved_max_distance(source, bounds(meshes));
        const double expected = expected_kept(make_lattice(source, meshes, d), meshes, d);
        EXPECT_NEAR(kept(source, meshes).splats, expected, 0.15 * expected);
    }
}

TEST(AutomaticVoxels, SplatsOfAnEmptyPictureAreRefused) {
    SourceParams source;
    source.splats = 1000;
    EXPECT_EQ(ERROR_OF(make_lattice(source, rectangle(10, 10, flat_texture({1, 1, 1, 0})), 0.2)),
              "source.splats: expected a picture and masks that leave something, found nothing that "
              "is not transparent");
}

}  // namespace
}  // namespace astrosplat

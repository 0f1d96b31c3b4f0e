// Sets: bounds, orders and rows; spherical harmonics.
#include <numbers>

#include "core/rotation.h"
#include "splats/harmonics.h"
#include "splats/row_order.h"
#include "splats/splat_set.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Sets: bounds and order.

SplatSet unsorted() {
    SplatSet set;
    const std::uint64_t ids[] = {5, 1, 5, std::uint64_t{1} << 40, 0, 1};
    for (int i = 0; i < 6; ++i) {
        set.position.push_back(glm::vec3(float(i), float(-i), 2.0f));
        set.color.push_back(glm::vec3(float(i)));
        set.alpha.push_back(float(i));
        set.distance.push_back(float(i));
        set.radius.push_back(float(i));
        set.id.push_back(ids[i]);
    }
    return set;
}

TEST(SplatSet, SortIsStableAndMovesEveryArray) {
    SplatSet set = unsorted();
    sort_by_id(set);
    const float expected[] = {4, 1, 5, 0, 2, 3};
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(set.position[i].x, expected[i]);
        EXPECT_EQ(set.color[i].y, expected[i]);
        EXPECT_EQ(set.alpha[i], expected[i]);
        EXPECT_EQ(set.distance[i], expected[i]);
        EXPECT_EQ(set.radius[i], expected[i]);
    }
    EXPECT_TRUE(set.uv.empty());
}

// Ids near each other, equal ones, and some that are as far away as can be.
Buffer<std::uint64_t> scattered_ids(std::size_t count) {
    Buffer<std::uint64_t> ids;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t mixed = i * 0x9e3779b97f4a7c15u;
        ids.push_back(i % 1000 == 7 ? mixed : mixed >> 46);
    }
    ids[count / 2] = std::numeric_limits<std::uint64_t>::max();
    return ids;
}

TEST(SplatSet, SortsManyRowsAsAStableSortDoes) {
    const Buffer<std::uint64_t> ids = scattered_ids(200000);
    std::vector<std::size_t> expected(ids.size());
    std::iota(expected.begin(), expected.end(), std::size_t{0});
    std::stable_sort(expected.begin(), expected.end(),
                     [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        SplatSet set;
        set.id = ids;
        set.position.resize(ids.size());
        set.color.resize(ids.size());
        set.alpha.resize(ids.size());
        set.distance.resize(ids.size());
        for (std::size_t i = 0; i < ids.size(); ++i) set.distance[i] = float(i);
        sort_by_id(set);
        for (std::size_t i = 0; i < ids.size(); ++i) {
            ASSERT_EQ(set.id[i], ids[expected[i]]) << i;
            ASSERT_EQ(set.distance[i], float(expected[i])) << i;
        }
    }
    set_thread_count(0);
}

TEST(RowOrder, DescentsAreFoundAnywhere) {
    Buffer<std::uint64_t> ids(150000);
    std::iota(ids.begin(), ids.end(), std::uint64_t{0});
    ids[7] = 6;
    EXPECT_TRUE(ids_ascend(ids));
    EXPECT_TRUE(ids_ascend({}));
    for (const std::size_t at :
         {1, 65535, 65536, 65537, 131072, 149999}) {  // work is cut at multiples of 2^16
        Buffer<std::uint64_t> other = ids;
        std::swap(other[at - 1], other[at]);
        EXPECT_FALSE(ids_ascend(other)) << at;
    }
}

TEST(RowOrder, BinsThenIdsThenRows) {
    const Buffer<std::uint32_t> bins{2, 0, 2, 1, 2, 0};
    const Buffer<std::uint64_t> ids{9, 4, 3, 8, 9, 4};
    const auto rows = rows_by_bin<std::uint32_t>(bins, 4, ids);
    EXPECT_EQ(std::vector(rows.begin(), rows.end()), (std::vector<std::uint32_t>{1, 5, 3, 2, 0, 4}));
    const auto wide = rows_by_bin<std::uint64_t>(bins, 4, ids);
    EXPECT_TRUE(std::equal(rows.begin(), rows.end(), wide.begin(), wide.end()));
}

TEST(SplatSet, Bounds) {
    const Bounds box = bounds(unsorted());
    EXPECT_EQ(box.lo, glm::dvec3(0, -5, 2));
    EXPECT_EQ(box.hi, glm::dvec3(5, 0, 2));
    EXPECT_TRUE(bounds(SplatSet()).empty());
}

// Orders and samples of a set's rows: Morton codes in closed form, ties, threads, and what rows bring along.

SplatSet set_of(const std::vector<glm::vec3>& positions) {
    SplatSet set;
    set.position.assign(positions.begin(), positions.end());
    const std::size_t n = positions.size();
    set.color.assign(n, glm::vec3(0.5f));
    set.alpha.assign(n, 0.5f);
    set.distance.assign(n, 0.0f);
    set.id.resize(n);
    std::iota(set.id.begin(), set.id.end(), std::uint64_t{0});
    return set;
}

float uniform(std::uint32_t i, std::uint32_t which) {
    return shared::as_uniform(shared::as_hash(5u, i, 0u, which));
}

SplatSet cloud(std::uint32_t count) {
    std::vector<glm::vec3> positions;
    for (std::uint32_t i = 0; i < count; ++i)
        positions.push_back({10.0f * uniform(i, 1), uniform(i, 2), 10.0f * uniform(i, 3)});
    return set_of(positions);
}

std::vector<std::int64_t> order_of(const SplatSet& set) {
    std::vector<std::int64_t> rows;
    for (const MortonRow& row : morton_order(set)) rows.push_back(row.row);
    return rows;
}

TEST(Morton, InterleavesTheBitsOfTheCoordinates) {
    EXPECT_EQ(morton_place(1, 0, 0), 1u);
    EXPECT_EQ(morton_place(0, 1, 0), 2u);
    EXPECT_EQ(morton_place(0, 0, 1), 4u);
    for (unsigned bit = 0; bit < morton_axis_bits; ++bit)
        EXPECT_EQ(spread_bits(std::uint64_t{1} << bit), std::uint64_t{1} << 3 * bit) << bit;
    const std::uint64_t most = (std::uint64_t{1} << morton_axis_bits) - 1;
    EXPECT_EQ(morton_place(most, most, most), (std::uint64_t{1} << 63) - 1);
}

TEST(MortonOrder, CornersOfACubeComeXFirst) {
    std::vector<glm::vec3> corners;
    for (int i = 7; i >= 0; --i) corners.push_back({float(i & 1), float(i >> 1 & 1), float(i >> 2)});
    EXPECT_EQ(order_of(set_of(corners)), (std::vector<std::int64_t>{7, 6, 5, 4, 3, 2, 1, 0}));
}

TEST(MortonOrder, EveryRowComesOnce) {
    const SplatSet set = cloud(200001);
    std::vector<std::int64_t> sorted = order_of(set);
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], std::int64_t(i));
    const Buffer<MortonRow> rows = morton_order(set);
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(),
                               [](const MortonRow& a, const MortonRow& b) { return a.code < b.code; }));
}

TEST(MortonOrder, OfEqualPlacesTheLowestIdComesFirst) {
    SplatSet set = set_of({{1, 1, 1}, {0, 0, 0}, {1, 1, 1}, {1, 1, 1}});
    EXPECT_EQ(order_of(set), (std::vector<std::int64_t>{1, 0, 2, 3}));
    set.id = {9, 1, 4, 5};
    EXPECT_EQ(order_of(set), (std::vector<std::int64_t>{1, 2, 3, 0}));
}

TEST(MortonOrder, WhatAbsorbsComesLast) {
    SplatSet set = cloud(1000);
    for (std::size_t i = 0; i < 1000; i += 3) set.color[i] = glm::vec3(-1.0f);
    const auto absorbs = [&](std::int64_t row) { return set.color[row].x < 0.0f; };
    std::vector<std::int64_t> order = order_of(set);
    EXPECT_FALSE(std::is_partitioned(order.begin(), order.end(), std::not_fn(absorbs)))
        << "a set that does not say so has no such splats";
    set.absorbs = true;
    order = order_of(set);
    EXPECT_TRUE(std::is_partitioned(order.begin(), order.end(), std::not_fn(absorbs)));
}

TEST(MortonOrder, StopsWhenAskedAndBetweenItsSteps) {
    const std::atomic<bool> stop{true};
    EXPECT_THROW(morton_order(cloud(1000), Progress{{}, &stop}), Cancelled);
    for (const double when : {0.4, 0.8}) {
        std::atomic<bool> later{false};
        const Progress progress{[&](double fraction) { later = fraction >= when; }, &later};
        if (when < 0.8)
            EXPECT_THROW(morton_order(cloud(1000), progress), Cancelled);
        else
            EXPECT_EQ(morton_order(cloud(1000), progress).size(), 1000u);
    }
}

TEST(TakeRows, BringsEverythingAlong) {
    SplatSet set = cloud(50);
    set.uv.resize(50);
    set.radius.resize(50);
    for (std::size_t i = 0; i < 50; ++i) {
        set.uv[i] = glm::vec2(float(i));
        set.radius[i] = float(i) * 2.0f;
        set.alpha[i] = float(i) * 0.01f;
    }
    set.spacing = {1, 2, 3};
    set.max_distance = 4.0;
    set.generated = set.divided = true;
    set.credit = "someone";
    const Buffer<std::int64_t> rows = {7, 3, 49, 3};
    const SplatSet taken = take_rows(set, rows);
    ASSERT_EQ(taken.size(), 4);
    EXPECT_TRUE(taken.normal.empty());
    EXPECT_TRUE(taken.mesh.empty());
    for (std::size_t i = 0; i < 4; ++i) {
        const auto row = std::size_t(rows[i]);
        EXPECT_EQ(taken.position[i], set.position[row]);
        EXPECT_EQ(taken.color[i], set.color[row]);
        EXPECT_EQ(taken.alpha[i], set.alpha[row]);
        EXPECT_EQ(taken.distance[i], set.distance[row]);
        EXPECT_EQ(taken.id[i], set.id[row]);
        EXPECT_EQ(taken.uv[i], set.uv[row]);
        EXPECT_EQ(taken.radius[i], set.radius[row]);
    }
    EXPECT_EQ(taken.spacing, set.spacing);
    EXPECT_EQ(taken.max_distance, 4.0);
    EXPECT_TRUE(taken.generated && taken.divided);
    EXPECT_EQ(taken.credit, "someone");
}

TEST(SampleRows, HasOneRowOfEachStretch) {
    const SplatSet set = cloud(1000);
    const SplatSet sample = sample_rows(set, 250);
    ASSERT_EQ(sample.size(), 250);
    std::vector<int> places(4, 0);
    for (std::uint64_t i = 0; i < 250; ++i) {
        EXPECT_EQ(sample.id[i] / 4, i);
        ++places[sample.id[i] % 4];
    }
    for (const int count : places) EXPECT_GT(count, 30) << "no pattern";
}

TEST(SampleRows, OfFewAreAll) {
    const SplatSet set = cloud(7);
    for (const std::int64_t count : {7, 100}) EXPECT_EQ(sample_rows(set, count).size(), 7);
    EXPECT_EQ(sample_rows(set, 0).size(), 0);
    EXPECT_EQ(sample_rows(cloud(0), 10).size(), 0);
}

// Spherical harmonics: orthonormal, of the right signs, and turned with what they are of.

TEST(Harmonics, AreOrthonormal) {
    constexpr int rings = 200, around = 64;
    double products[16][16] = {};
    for (int r = 0; r < rings; ++r)
        for (int a = 0; a < around; ++a) {
            const double z = -1.0 + (2.0 * r + 1.0) / rings, angle = 2.0 * std::numbers::pi * a / around;
            const double across = std::sqrt(1.0 - z * z);
            const auto y =
                harmonic_functions(glm::vec3(across * std::cos(angle), across * std::sin(angle), z));
            for (std::size_t i = 0; i < 16; ++i)
                for (std::size_t j = 0; j < 16; ++j)
                    products[i][j] += double(y[i]) * y[j] * 4.0 * std::numbers::pi / (rings * around);
        }
    for (int i = 0; i < 16; ++i)
        for (int j = 0; j < 16; ++j) EXPECT_NEAR(products[i][j], i == j ? 1.0 : 0.0, 1e-3) << i << ' ' << j;
}

// With the Condon-Shortley phase: functions of odd m are negative where their products of
// coordinates are not.
TEST(Harmonics, HaveTheSignsOfTheirFormat) {
    const auto y = harmonic_functions(glm::normalize(glm::vec3(0.5f, 0.4f, 1.2f)));
    const int signs[16] = {1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, 1};
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(y[i] > 0.0f ? 1 : -1, signs[i]) << i;
    EXPECT_NEAR(harmonic_functions({0.0f, 0.0f, 1.0f})[12], std::sqrt(7.0 / (4.0 * std::numbers::pi)), 1e-6);
}

TEST(Harmonics, ColoursAreNeverBelowZero) {
    Harmonics harmonics{};
    harmonics.c[2] = glm::vec3(2.0f);
    EXPECT_NEAR(color_towards(harmonics, {0.0f, 0.0f, 1.0f}).x, 0.5 + 2.0 * 0.4886025, 1e-6);
    EXPECT_EQ(color_towards(harmonics, {0.0f, 0.0f, -1.0f}), glm::vec3(0.0f));
    EXPECT_EQ(mean_color(harmonics), glm::vec3(0.5f));
    EXPECT_NEAR(mean_color({{mean_coefficient(glm::vec3(0.25f))}}).y, 0.25f, 1e-7);
}

TEST(Quaternion, IsItsMatrixInAllQuarters) {
    for (const glm::dvec3& degrees :
         {glm::dvec3(0.0), glm::dvec3(170.0, 5.0, 3.0), glm::dvec3(4.0, 175.0, 9.0),
          glm::dvec3(3.0, 8.0, 179.0), glm::dvec3(30.0, 40.0, -50.0)}) {
        const glm::dmat3 m = rotation_from_degrees(degrees),
                         other = rotation_from_degrees({10.0, 20.0, 30.0});
        const glm::dmat3 back = matrix_of_quaternion(quaternion_of_matrix(m));
        const glm::dmat3 both =
            matrix_of_quaternion(quaternion_product(quaternion_of_matrix(m), quaternion_of_matrix(other)));
        for (int i = 0; i < 9; ++i) {
            EXPECT_NEAR(back[i / 3][i % 3], m[i / 3][i % 3], 1e-12);
            EXPECT_NEAR(both[i / 3][i % 3], (m * other)[i / 3][i % 3], 1e-12);
        }
    }
}

}  // namespace
}  // namespace astrosplat

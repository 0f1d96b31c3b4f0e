// Depths: the envelope, the noise that all bands share, and the same bits everywhere.
#include "bodies/depth_kernel.h"
#include "bodies/fields.h"
#include "bodies/picture_light.h"
#include "bodies/placement.h"
#include "image/channels.h"
#include "support/painted_picture.h"
#include "support/test.h"
#include "unit/bodies/bodies_support.h"

namespace astrosplat {
namespace {

// Splats at random places of a picture of 1000 x 1000, all of one scale height.
std::vector<std::unique_ptr<PlacedBlock>> scattered(int blocks, float height) {
    std::vector<std::unique_ptr<PlacedBlock>> result;
    for (int b = 0; b < blocks; ++b) {
        auto block = std::make_unique<PlacedBlock>(
            splats_about(glm::vec2(500.0f), glm::vec2(1000.0f), std::uint32_t(b)));
        std::fill_n(block->height, block->count, height);
        std::fill_n(block->clumping, block->count, 1.0f);
        result.push_back(std::move(block));
    }
    return result;
}

NoiseStack octaves(int count, float gain, float longest = 80.0f) {
    NoiseStack noise;
    noise.seed = 5u;
    for (int i = 0; i < count; ++i) {
        noise.frequency[i] = float(1 << i) / longest;
        noise.gain[i] = gain;
    }
    noise.count = count;
    return noise;
}

TEST(Depths, WithoutClumpsFollowTheEnvelope) {
    std::vector<double> z;
    int number = 0;
    for (auto& block : scattered(80, 20.0f)) {
        const bool evenly = ++number % 2 == 0;  // no noise; or all of it, of which nothing counts
        if (!evenly) std::fill_n(block->clumping, block->count, 0.0f);
        disk_depths(octaves(2, evenly ? 0.0f : 3.0f), *block);
        z.insert(z.end(), block->z, block->z + block->count);
    }
    std::sort(z.begin(), z.end());
    // Quantiles of sech^2(z / 20), of which 1.5 % are cut off at either side: z = 10 ln(v / (1 - v)).
    for (const double u : {0.05, 0.25, 0.5, 0.75, 0.95}) {
        const double v = 0.015 + 0.97 * u;
        EXPECT_NEAR(z[std::size_t(u * double(z.size()))], 10.0 * std::log(v / (1.0 - v)), 1.0) << u;
    }
    EXPECT_LE(z.back(), 41.9);
}

// Where the noise is high there are more splats, and for octaves past the third the finer draw does it.
TEST(Depths, GatherWhereTheNoiseIsHigh) {
    const NoiseStack noise = octaves(5, 1.5f);
    double coarse = 0.0, fine = 0.0;
    int count = 0;
    for (auto& block : scattered(20, 20.0f)) {
        disk_depths(noise, *block);
        for (int i = 0; i < block->count; ++i, ++count) {
            const auto octave = [&](int k) {
                return double(shared::as_noise_octave(block->x[i], block->y[i], block->z[i],
                                                      noise.frequency[k], noise.seed, k));
            };
            coarse += octave(0) + octave(1) + octave(2);
            fine += octave(3) + octave(4);
        }
    }
    EXPECT_GT(coarse / count, 0.3);
    EXPECT_GT(fine / count, 0.1);
}

// The first of the two draws, candidate by candidate.
float drawn_plainly(const NoiseStack& noise, const DepthBlock& block, int i) {
    constexpr int candidates = 24;
    const double even = double(block.even[i]), within = even * candidates - std::floor(even * candidates);
    double place[candidates], weight[candidates], sum = 0.0;
    for (int c = 0; c < candidates; ++c) {
        const double u = 0.015 + 0.97 * (c + within) / candidates;
        place[c] = 0.5 * double(block.height[i]) * std::log(u / (1.0 - u));
        double energy = 0.0;
        for (int k = 0; k < noise.count; ++k)
            energy += double(noise.gain[k]) / 0.26 *
                      double(shared::as_noise_octave(block.x[i], block.y[i], float(place[c]),
                                                     noise.frequency[k], noise.seed, k));
        weight[c] = std::exp(double(block.clumping[i]) * energy);
        sum += weight[c];
    }
    double rest = sum * even;
    int chosen = 0;
    for (int c = 0; c < candidates && rest >= 0.0; rest -= weight[c++]) chosen = c;
    return float(place[chosen]);
}

// Heights of .1 to 3 times the longest wave: few planes of the noise's lattice, and many.
TEST(Depths, AreThoseOfTheNoiseItself) {
    const NoiseStack noise = octaves(3, 1.5f);
    int others = 0, count = 0;
    for (auto& block : scattered(8, 20.0f)) {
        for (int i = 0; i < block->count; ++i) {
            block->height[i] = 8.0f * float(1 + i % 30);
            block->clumping[i] = i % 3 == 0 ? 0.4f : 1.0f;
        }
        disk_depths(noise, *block);
        for (int i = 0; i < block->count; ++i, ++count)
            others += std::fabs(block->z[i] - drawn_plainly(noise, *block, i)) > 1e-3f ? 1 : 0;
    }
    EXPECT_LE(others, count / 1000);  // where a sum's rounding decides
}

TEST(Depths, AnOctaveHasTheDeviationThatGainsCount) {
    double sum = 0.0, squares = 0.0;
    int count = 0;
    for (auto& block : scattered(80, 1.0f)) {
        noise_sum(octaves(1, 1.0f, 8.0f), *block);
        for (int i = 0; i < block->count; ++i, ++count) {
            sum += double(block->z[i]);
            squares += double(block->z[i]) * double(block->z[i]);
        }
    }
    EXPECT_NEAR(sum / count, 0.0, 0.03);
    EXPECT_NEAR(std::sqrt(squares / count), 1.0, 0.05);
}

TEST(Depths, ASheetStaysWithinTwoScaleHeightsAndItsSpread) {
    for (auto& block : scattered(8, 20.0f)) {
        sheet_depths(octaves(4, 100.0f), 0.001f, *block);
        float highest = 0.0f;
        for (int i = 0; i < block->count; ++i) highest = std::max(highest, std::fabs(block->z[i]));
        EXPECT_GT(highest, 39.0f);
        EXPECT_LE(highest, 40.1f);
    }
}

TEST(Depths, AreTheSameOnEveryInstructionSet) {
    const auto run = [] {
        std::vector<float> z;
        for (auto& block : scattered(4, 20.0f)) {
            disk_depths(octaves(5, 1.5f), *block);
            z.insert(z.end(), block->z, block->z + block->count);
            sheet_depths(octaves(5, 9.0f), 4.0f, *block);
            z.insert(z.end(), block->z, block->z + block->count);
        }
        return z;
    };
    const std::vector<float> best = run();
    ASSERT_GT(vector_targets().size(), 1u);
    for (const std::string& target : vector_targets()) {
        set_vector_target(target);
        const std::vector<float> here = run();
        for (std::size_t i = 0; i < best.size(); ++i)
            ASSERT_EQ(here[i], best[i]) << target << ", splat " << i;
    }
    set_vector_target("best");
}

TEST(Fields, ThicknessIsBoundedAndLargestInBrightParts) {
    const Image brightest = brightest_channel(painted::galaxy(720, 450));
    const Image field = thickness_field(brightest, 10.0);
    float lo = 1e9f, hi = 0.0f;
    for (const float v : field.pixels) {
        lo = std::min(lo, v);
        hi = std::max(hi, v);
    }
    EXPECT_GE(lo, 5.49f);
    EXPECT_LT(lo, 6.5f);
    EXPECT_GT(hi, 15.0f);
    EXPECT_LE(hi, 22.01f);
    EXPECT_GT(*field.at(360, 225), 15.0f);
}

// A wave, of whose deviation both blurs leave .76; even light; and stripes.
TEST(Fields, ASheetFoldsAsMuchAsThePictureHasStructure) {
    constexpr double wave_px = 120.0, deviation = 0.125 / 0.76;  // half of what folds a sheet wholly
    Image brightest = make_image(1920, 300, 1, 1.0f);
    for (std::int64_t y = 0; y < brightest.height; ++y)
        for (std::int64_t x = 0; x < brightest.width; ++x) {
            const double wave = std::sqrt(2.0) * std::sin(2.0 * real::pi * double(x) / wave_px);
            if (x < 640) *brightest.at(x, y) = float(std::exp(deviation * wave));
            if (x >= 1280) *brightest.at(x, y) = (x / 40) % 2 == 0 ? 1.0f : 0.2f;
        }
    const Image field = structure_field(brightest);
    const auto at = [&](std::int64_t x) { return *field.at(x * field.width / 1920, field.height / 2); };
    EXPECT_NEAR(at(200), 0.5f, 0.05f);
    EXPECT_LT(at(960), 0.13f);
    EXPECT_FLOAT_EQ(at(1700), 1.0f);
}

TEST(Depths, ASheetsFoldsAreAsHighAsItsClumping) {
    for (auto& block : scattered(2, 200.0f)) {
        sheet_depths(octaves(4, 10.0f), 0.0f, *block);
        const std::vector<float> whole(block->z, block->z + block->count);
        std::fill_n(block->clumping, block->count, 0.25f);
        sheet_depths(octaves(4, 10.0f), 0.0f, *block);
        for (int i = 0; i < block->count; ++i) ASSERT_FLOAT_EQ(block->z[i], 0.25f * whole[std::size_t(i)]);
    }
}

// A small bulge is less tall than a large one of the same light.
TEST(Fields, ThicknessRisesNowhereSteeply) {
    for (const double sigma : {15.0, 160.0}) {
        Image light = make_image(960, 600, 3, 0.001f);
        painted::add_point(light, 480.0, 300.0, sigma, 1.0, 1.0, 1.0);
        const Image field = thickness_field(brightest_channel(light), 40.0);
        ASSERT_EQ(field.width, 480);  // of steps of 2 px
        float slope = 0.0f;
        for (std::int64_t x = 0; x + 1 < field.width; ++x)
            slope = std::max(slope, std::fabs(*field.at(x + 1, 150) - *field.at(x, 150)) / 2.0f);
        EXPECT_LE(slope, 0.3001f);
        if (sigma < 20.0) {
            EXPECT_LT(*field.at(240, 150), 60.0f);
        } else {
            EXPECT_GT(*field.at(240, 150), 70.0f);
        }
    }
}

TEST(Fields, ReliefIsNowhereTooSteepAndNothingOnEmptySky) {
    Image brightest = make_image(240, 150, 1);
    for (std::int64_t y = 60; y < 90; ++y)
        for (std::int64_t x = 100; x < 140; ++x) *brightest.at(x, y) = 1.0f;
    for (const double steepest : {0.7, 0.1}) {
        const Image field = relief_field(brightest, 60.0, steepest);
        float highest = 0.0f, slope = 0.0f;
        for (std::int64_t y = 0; y + 1 < field.height; ++y)
            for (std::int64_t x = 0; x + 1 < field.width; ++x) {
                highest = std::max(highest, *field.at(x, y));
                slope = std::max(slope, std::fabs(*field.at(x + 1, y) - *field.at(x, y)));
            }
        EXPECT_LE(slope, 1.03 * steepest);
        EXPECT_GT(slope, 0.5 * steepest);
        EXPECT_LE(highest, 60.0f);
        EXPECT_GT(highest, steepest > 0.5 ? 10.0f : 2.0f);
        EXPECT_LT(*field.at(2, 2), 0.5f);
    }
}

// All splats of a knot share its depth; other fine splats at the same distance from each other do not.
// Standard deviation of the heights of 200 of the finest splats about a texel.
double spread_at(const Placement& placement, float cx, float cy) {
    const BandSplats splats = band_splats(make_bands(320)[0], false, placement)[0];
    PlacedBlock block;
    block.count = 200;
    for (int i = 0; i < block.count; ++i) {
        block.x[i] = cx + 0.01f * float(i % 10);
        block.y[i] = cy + 0.01f * float(i / 10);
        block.random[i] = shared::as_hash(3u, std::uint32_t(i), 0u, 4u);
        block.even[i] = shared::as_uniform(shared::as_mix(block.random[i]));
    }
    place(placement, splats, block);
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < block.count; ++i) {
        sum += double(block.z[i]);
        squares += double(block.z[i]) * double(block.z[i]);
    }
    const double mean = sum / block.count;
    return std::sqrt(squares / block.count - mean * mean);
}

// On a sheet it is flatter: seen at 60 degrees those of an upright rim would be one needle.
TEST(Placement, AKnotIsABall) {
    Image light = make_image(320, 200, 3, 0.05f);
    painted::add_point(light, 160.0, 100.0, 3.0, 0.5, 0.5, 0.5);
    for (const StructureKind kind : {StructureKind::disk, StructureKind::sheet}) {
        const Placement placement = make_placement(brightest_channel(light), of_kind(kind), 32.0, true, 9u);
        ASSERT_EQ(placement.knots.knots.size(), 1u);
        const bool disk = kind == StructureKind::disk;
        const double sigmas = spread_at(placement, 160.0f, 100.0f) / double(placement.knots.knots[0].sigma);
        EXPECT_GT(sigmas, disk ? 0.45 : 0.25);
        EXPECT_LT(sigmas, disk ? 0.7 : 0.4);
        if (disk) {
            EXPECT_GT(spread_at(placement, 40.0f, 40.0f), 0.2 * placement.galaxies[0].thickness);
        }
    }
}

// A round knot is level on a slope, a piece of a filament is not.
TEST(Placement, KnotsOfAFilamentLieOnTheRelief) {
    Image light = make_image(320, 200, 3, 0.05f);
    painted::add_point(light, 160.0, 100.0, 3.0, 0.5, 0.5, 0.5);
    Placement placement =
        make_placement(brightest_channel(light), of_kind(StructureKind::sheet), 32.0, true, 9u);
    ASSERT_EQ(placement.knots.knots.size(), 1u);
    placement.relief = make_image(320, 200, 1);
    for (std::int64_t i = 0; i < 320 * 200; ++i)
        placement.relief.pixels[std::size_t(i)] = 0.5f * float(i % 320);
    const BandSplats splats = band_splats(make_bands(320)[0], false, placement)[0];
    for (const float roundness : {0.0f, 1.0f}) {
        placement.knots.knots[0].roundness = roundness;
        PlacedBlock block;
        block.count = 200;
        for (int i = 0; i < block.count; ++i) {
            block.x[i] = i < 100 ? 158.0f : 162.0f;
            block.y[i] = 100.0f;
            block.random[i] = shared::as_hash(3u, std::uint32_t(i % 100), 0u, 4u);
            block.even[i] = shared::as_uniform(shared::as_mix(block.random[i]));
        }
        place(placement, splats, block);
        double rise = 0.0;
        for (int i = 0; i < 100; ++i) rise += double(block.z[i + 100] - block.z[i]) / 100.0;
        EXPECT_NEAR(rise, roundness > 0.5f ? 0.0 : 4.0, 1e-4);
    }
}

TEST(Placement, WallsLieOnBothSidesAndASheetOnOne) {
    const Image brightest = brightest_channel(painted::remnant(320, 200));
    for (const StructureKind kind : {StructureKind::walls, StructureKind::sheet}) {
        StructureParams params = of_kind(kind);
        params.stars = StructureParams::Stars::no;
        const Placement placement = make_placement(brightest, params, 32.0, true, 9u);
        const BandSplats splats = band_splats(make_bands(320)[1], false, placement)[0];
        int front = 0, back = 0;
        for (int repeat = 0; repeat < 20; ++repeat) {
            PlacedBlock block = splats_about({160.0f, 100.0f}, {60.0f, 40.0f}, std::uint32_t(repeat));
            place(placement, splats, block);
            for (int i = 0; i < block.count; ++i) {
                const float out = *placement.relief.at(std::int64_t(block.x[i]), std::int64_t(block.y[i]));
                EXPECT_LT(block.distance[i], 6.0 * placement.height) << i;
                front += block.z[i] > 0.5f * out;
                back += block.z[i] < -0.5f * out;
            }
        }
        EXPECT_GT(front, 1000);
        if (kind == StructureKind::walls) {
            EXPECT_GT(back, 1000);
        }
        if (kind == StructureKind::sheet) {
            EXPECT_LT(back, front / 4);
        }
    }
}

}  // namespace
}  // namespace astrosplat

// Scopes of pictures whose counts can be worked out by hand.
#include "output/scopes.h"

#include "support/test.h"

namespace astrosplat {
namespace {

using Rgb = std::array<int, 3>;

ScreenPoints points_of(std::int64_t width, std::int64_t height, const std::function<Rgb(int x, int y)>& at) {
    ScreenPoints points{width, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const int value : {at(x, y)[0], at(x, y)[1], at(x, y)[2], 255})
                points.rgba.push_back(static_cast<unsigned char>(value));
    return points;
}

/// Black at its left, white at its right, two columns a value.
ScreenPoints grey_ramp() {
    return points_of(512, 9, [](int x, int) { return Rgb{x / 2, x / 2, x / 2}; });
}

std::uint32_t sum(const ScopeCounts& counts, int channel) {
    std::uint32_t sum = 0;
    for (std::size_t i = static_cast<std::size_t>(channel); i < counts.counts.size();
         i += static_cast<std::size_t>(counts.channels))
        sum += counts.counts[i];
    return sum;
}

/// Brightness of a picture's pixel, whose row is counted from below.
float light(const Image& picture, std::int64_t x, std::int64_t row) {
    const float* const p = picture.at(x, picture.height - 1 - row);
    return p[0] + p[1] + p[2];
}

TEST(Scopes, CountEveryPointOnceAChannel) {
    const ScreenPoints points = points_of(331, 77, [](int x, int y) {
        return Rgb{x * y % 256, x % 256, (x * 7 + y * 13) % 256};
    });
    for (const Scope scope : {Scope::histogram, Scope::waveform, Scope::vectorscope}) {
        const ScopeCounts counts = count_points(scope, points);
        for (int k = 0; k < counts.channels; ++k) EXPECT_EQ(sum(counts, k), 331u * 77u);
    }
}

TEST(Scopes, AGreyRampIsFlatADiagonalAndAPoint) {
    const ScopeCounts histogram = count_points(Scope::histogram, grey_ramp()),
                      waveform = count_points(Scope::waveform, grey_ramp()),
                      vectors = count_points(Scope::vectorscope, grey_ramp());
    for (int value = 0; value < 256; ++value)
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(histogram.at(value, 0, k), 18u);
            for (int column = 0; column < 256; ++column)
                ASSERT_EQ(waveform.at(column, value, k), column == value ? 18u : 0u);
        }
    EXPECT_EQ(vectors.at(vectors.columns / 2, vectors.rows / 2, 0), 512u * 9u);
}

TEST(Scopes, AHistogramTellsItsChannelsApart) {
    const ScopeCounts counts = count_points(Scope::histogram, points_of(4, 1, [](int x, int) {
                                                return Rgb{200, x < 3 ? 10 : 11, 0};
                                            }));
    EXPECT_EQ(counts.at(200, 0, 0), 4u);
    EXPECT_EQ(counts.at(10, 0, 1), 3u);
    EXPECT_EQ(counts.at(11, 0, 1), 1u);
    EXPECT_EQ(counts.at(0, 0, 2), 4u);
}

/// Rec. 709 of the six bars at 75 %, to three digits: ITU-R BT.709-6, item 3.4.
TEST(Scopes, ColourBarsFallOnTheirTargets) {
    const struct {
        Rgb code;
        float cb, cr;
    } bars[] = {{{191, 191, 0}, -0.375f, 0.034f}, {{0, 191, 191}, 0.086f, -0.375f},
                {{0, 191, 0}, -0.289f, -0.341f},  {{191, 0, 191}, 0.289f, 0.341f},
                {{191, 0, 0}, -0.086f, 0.375f},   {{0, 0, 191}, 0.375f, -0.034f}};
    for (const auto& bar : bars) {
        const ScopeCounts counts =
            count_points(Scope::vectorscope, points_of(8, 8, [&](int, int) { return bar.code; }));
        const auto bin = [&](float chroma) {
            return int(std::floor((chroma / vector_reach + 1.0f) * 0.5f * float(counts.columns)));
        };
        std::uint32_t there = 0;
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y) there += counts.at(bin(bar.cb) + x, bin(bar.cr) + y, 0);
        EXPECT_EQ(there, 64u) << bar.cb << " " << bar.cr;
    }
}

TEST(Scopes, NoColourLeavesTheVectorscope) {
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec2 chroma = chroma_of(glm::vec3(corner & 1, corner >> 1 & 1, corner >> 2));
        EXPECT_LE(std::max(std::abs(chroma.x), std::abs(chroma.y)), 0.5001f);
    }
    EXPECT_EQ(chroma_of({0.0f, 0.0f, 1.0f}).x, 0.5f);
    EXPECT_EQ(chroma_of({1.0f, 0.0f, 0.0f}).y, 0.5f);
}

TEST(Scopes, PicturesShowWhatWasCounted) {
    const Image waveform = scope_picture(Scope::waveform, count_points(Scope::waveform, grey_ramp()));
    for (int column = 2; column < 254; ++column) {
        EXPECT_EQ(light(waveform, column, column), 3.0f);
        EXPECT_GT(light(waveform, column, column + 1), 0.0f);  // softened
        EXPECT_EQ(light(waveform, column, column + 2), 0.0f);
        EXPECT_EQ(light(waveform, column, column - 2), 0.0f);
    }
    // Black over half of the picture does not flatten the rest: value 100 is the fullest, 50 a quarter of it.
    const ScreenPoints dark = points_of(90, 10, [](int x, int) {
        const int value = x < 50 ? 0 : x < 82 ? 100 : 50;
        return Rgb{value, value, value};
    });
    const Image histogram = scope_picture(Scope::histogram, count_points(Scope::histogram, dark));
    const std::int64_t top = histogram.height - 1;
    EXPECT_GT(light(histogram, 100, top), 0.0f);
    EXPECT_GT(light(histogram, 50, histogram.height / 2 - 1), 0.0f);
    EXPECT_EQ(light(histogram, 50, histogram.height / 2 + 1), 0.0f);
    EXPECT_GT(light(histogram, 0, top), 0.0f);
    EXPECT_EQ(light(histogram, 75, 0), 0.0f);
    const Image vectors = scope_picture(Scope::vectorscope, count_points(Scope::vectorscope, grey_ramp()));
    EXPECT_GT(light(vectors, vectors.width / 2, vectors.height / 2), 1.0f);
    EXPECT_EQ(light(vectors, vectors.width / 2 + 2, vectors.height / 2), 0.0f);
}

TEST(Scopes, NothingCountsNothing) {
    for (const Scope scope : {Scope::histogram, Scope::waveform, Scope::vectorscope}) {
        const ScopeCounts counts = count_points(scope, {});
        EXPECT_EQ(sum(counts, 0), 0u);
        const Image picture = scope_picture(scope, counts);
        for (std::int64_t x = 0; x < picture.width; ++x) EXPECT_EQ(light(picture, x, 0), 0.0f);
    }
}

}  // namespace
}  // namespace astrosplat

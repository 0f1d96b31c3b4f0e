// Every message a person can meet in the look, word for word.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/log.h"
#include "core/parallel.h"
#include "unit/look/sets.h"

namespace astrosplat {
namespace {

std::string message(const SplatSet& set, const Look& look) {
    try {
        apply_look(set, look, {});
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(LookErrors, CurveWithTooManyPoints) {
    Look look;
    for (int i = 0; i < 17; ++i) look.pdf.points.push_back({float(i), 1.0f});
    EXPECT_EQ(message(test::file_set(1), look), "look.pdf.points: expected at most 16 points, found 17");
}

TEST(LookErrors, CurveThatGoesBack) {
    Look look;
    look.vertical.points = {{0.0f, 1.0f}, {0.5f, 1.0f}, {0.25f, 0.0f}};
    EXPECT_EQ(message(test::file_set(1), look),
              "look.vertical.points: expected points in ascending order of x, found 0.25 after 0.5");
}

TEST(LookErrors, CurveOfAThicknessStopIsNamed) {
    Look look;
    look.thickness.stops.resize(1);
    look.thickness.stops[0].pdf.points = {{0.5f, 1.0f}, {0.5f, 0.0f}};
    EXPECT_EQ(message(test::file_set(1), look),
              "look.thickness.keys[0].points: expected points in ascending order of x, found 0.5 after 0.5");
}

TEST(LookErrors, TooManyStops) {
    Look look;
    look.thickness.stops.resize(9);
    EXPECT_EQ(message(test::file_set(1), look), "look.thickness.keys: expected at most 8 stops, found 9");
}

TEST(LookErrors, TooManyNoises) {
    Look look;
    look.noise.resize(5);
    for (Noise& noise : look.noise) noise.alpha = 0.1f;
    EXPECT_EQ(message(test::file_set(1), look), "look.noise: expected at most 4 noises, found 5");
}

TEST(LookErrors, ThicknessMapWithoutTextureCoordinates) {
    Look look;
    look.thickness.map = "map.exr";
    EXPECT_EQ(message(test::file_set(1), look),
              "look.thickness.map: expected splats with texture coordinates, found a set without");
}

TEST(LookErrors, NoRadiusKnown) {
    SplatSet set = test::file_set(1);
    set.radius.clear();
    EXPECT_EQ(message(set, {}),
              "look.radius: expected min and max, since the splat file holds no radius, found 0 and 0");
}

TEST(LookErrors, MatchWithoutSpacing) {
    Look look;
    look.vertical.match = VerticalAlpha::Match::coverage;
    EXPECT_EQ(message(test::file_set(1), look),
              "look.vertical.match: expected none, since the spacing of the splat file's lattice is not "
              "known, found "
              "coverage");
    look.vertical.match = VerticalAlpha::Match::sum;
    EXPECT_EQ(message(test::file_set(1), look),
              "look.vertical.match: expected none, since the spacing of the splat file's lattice is not "
              "known, found "
              "sum");
}

struct Warnings {
    std::vector<std::string> lines;
    Warnings() {
        set_log_sink([this](LogLevel level, const std::string& line) {
            if (level == LogLevel::warning) lines.push_back(line);
        });
    }
    ~Warnings() { set_log_sink(nullptr); }
};

TEST(LookErrors, WarnsWhereColoursAreDividedTwice) {
    SplatSet set = test::file_set(1);
    set.divided = true;
    Look look;
    Warnings warnings;
    apply_look(set, look, {});
    EXPECT_TRUE(warnings.lines.empty());
    look.alpha.unpremultiply = true;
    apply_look(set, look, {});
    ASSERT_EQ(warnings.lines.size(), 1u);
    EXPECT_NE(warnings.lines[0].find("they are divided again"), std::string::npos);
}

TEST(LookErrors, StopsWhenAsked) {
    const std::atomic<bool> stop{true};
    Progress progress;
    progress.cancelled = &stop;
    EXPECT_THROW(apply_look(test::file_set(10), {}, {}, progress), Cancelled);
}

TEST(LookProgress, RisesToTheWhole) {
    set_thread_count(1);
    std::vector<double> reported;
    Progress progress;
    progress.report = [&](double fraction) { reported.push_back(fraction); };
    apply_look(test::file_set(200000), {}, {}, progress);
    ASSERT_GT(reported.size(), 2u);
    EXPECT_TRUE(std::is_sorted(reported.begin(), reported.end()));
    EXPECT_GT(reported.front(), 0.0);
    EXPECT_EQ(reported.back(), 1.0);
}

TEST(LookErrors, AnEmptySetIsNoError) { EXPECT_EQ(apply_look(test::file_set(0), {}, {}).size(), 0); }

}  // namespace
}  // namespace astrosplat

// The compensation of a share, splat by splat: alpha * radius^2 times the share is what it was.
#include "look/decimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace astrosplat {
namespace {

ShadedSplats splats_of_all_alphas() {
    ShadedSplats splats;
    for (int i = 0; i <= 1000; ++i) {
        splats.position.push_back(glm::vec3(float(i)));
        splats.color.push_back({0.25f, 0.5f, 2.0f});
        splats.alpha.push_back(float(i) * 0.001f);
        splats.radius.push_back(0.1f + float(i % 7) * 0.05f);
        splats.id.push_back(std::uint64_t(i));
    }
    return splats;
}

constexpr float shares[] = {0.9f, 0.5f, 0.1f, 0.05f, 0.001f};

TEST(Decimate, ConservesAlphaTimesArea) {
    const ShadedSplats before = splats_of_all_alphas();
    for (const float share : shares) {
        ShadedSplats after = before;
        decimate(after, share, false);
        for (std::size_t i = 0; i < after.alpha.size(); ++i) {
            const double was = double(before.alpha[i]) * before.radius[i] * before.radius[i];
            const double is = double(after.alpha[i]) * after.radius[i] * after.radius[i] * share;
            ASSERT_NEAR(is, was, was * 1e-6) << "alpha " << before.alpha[i] << " share " << share;
            ASSERT_EQ(after.color[i], before.color[i]);
        }
    }
}

TEST(Decimate, FillsUpAlphaToAHalfBeforeTheRadiusGrows) {
    const ShadedSplats before = splats_of_all_alphas();
    for (const float share : shares) {
        ShadedSplats after = before;
        decimate(after, share, false);
        for (std::size_t i = 0; i < after.alpha.size(); ++i) {
            ASSERT_LE(after.alpha[i], std::max(0.5f, before.alpha[i]));
            ASSERT_GE(after.radius[i], before.radius[i]);
            if (after.radius[i] > before.radius[i]) {
                ASSERT_EQ(after.alpha[i], std::max(0.5f, before.alpha[i]));
            }
        }
    }
}

TEST(Decimate, AdditiveSplatsKeepTheirSizeAndBrightenInstead) {
    const ShadedSplats before = splats_of_all_alphas();
    for (const float share : shares) {
        ShadedSplats after = before;
        decimate(after, share, true);
        for (std::size_t i = 0; i < after.alpha.size(); ++i) {
            ASSERT_EQ(after.radius[i], before.radius[i]);
            ASSERT_LE(after.alpha[i], 1.0f);
            const double was = double(before.alpha[i]) * before.color[i].y;
            ASSERT_NEAR(double(after.alpha[i]) * after.color[i].y * share, was, was * 1e-6);
        }
    }
}

TEST(Decimate, TheWholeSetStaysAsItIs) {
    const ShadedSplats before = splats_of_all_alphas();
    for (const bool additive : {false, true}) {
        ShadedSplats after = before;
        decimate(after, 1.0f, additive);
        EXPECT_TRUE(std::equal(after.alpha.begin(), after.alpha.end(), before.alpha.begin()));
        EXPECT_TRUE(std::equal(after.radius.begin(), after.radius.end(), before.radius.begin()));
        EXPECT_TRUE(std::equal(after.color.begin(), after.color.end(), before.color.begin()));
    }
}

TEST(Decimate, NothingStaysNothing) {
    ShadedSplats none;
    decimate(none, 0.1f, false);
    EXPECT_EQ(none.size(), 0);
}

}  // namespace
}  // namespace astrosplat

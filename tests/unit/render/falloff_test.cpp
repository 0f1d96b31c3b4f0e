// Each falloff's traits against its formula: a shape that says too little of itself is noticed as soon as it
// has a name.
#include "render/footprint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace astrosplat {
namespace {

std::vector<Falloff> all_falloffs() {
    std::vector<Falloff> all;
    for (std::size_t shape = 0; shape < names_of(Falloff::Shape{}).size(); ++shape)
        for (const float core : {0.2f, 0.7f})
            for (const float sharpness : {0.5f, 4.5f, 30.0f})
                all.push_back({Falloff::Shape(shape), core, sharpness});
    return all;
}

std::string name(const Falloff& falloff) {
    return std::string(name_of(falloff.shape)) + ", core " + std::to_string(falloff.core) + ", sharpness " +
           std::to_string(falloff.sharpness);
}

TEST(Falloffs, BeginAtOneAndNeverRise) {
    for (const Falloff& falloff : all_falloffs()) {
        EXPECT_EQ(falloff_value(falloff, 0.0), 1.0) << name(falloff);
        EXPECT_EQ(falloff_value(falloff, 1.0), 0.0) << name(falloff);
        for (int i = 1; i < 1000; ++i)
            ASSERT_LE(falloff_value(falloff, i / 1000.0), falloff_value(falloff, (i - 1) / 1000.0) + 1e-7)
                << name(falloff) << " at " << i;
    }
}

TEST(Falloffs, AreFlatAsFarAsTheySay) {
    for (const Falloff& falloff : all_falloffs()) {
        const FalloffTraits traits = traits_of(falloff);
        EXPECT_EQ(traits.flat_core, traits.core > 0.0f) << name(falloff);
        double flat = 0.0;
        while (flat + 1e-3 < 1.0 && falloff_value(falloff, flat + 1e-3) == 1.0) flat += 1e-3;
        EXPECT_NEAR(flat, double(traits.core), 2e-3) << name(falloff);
    }
}

TEST(Falloffs, CarryNothingBeyondTheirReach) {
    for (const Falloff& falloff : all_falloffs()) {
        const double reach = traits_of(falloff).reach;
        EXPECT_LT(falloff_value(falloff, reach), 1.1e-5) << name(falloff);
        EXPECT_GT(falloff_value(falloff, 0.95 * reach), 1e-5) << name(falloff);
    }
}

/// Where slopes on both sides differ, there is a kink; where w only curves, they differ less on a finer look.
TEST(Falloffs, HaveTheKinksTheySay) {
    for (const Falloff& falloff : all_falloffs()) {
        const auto slope_jump = [&](double t, double h) {
            const double left = (falloff_value(falloff, t) - falloff_value(falloff, t - h)) / h;
            const double right = (falloff_value(falloff, t + h) - falloff_value(falloff, t)) / h;
            return std::fabs(right - left);
        };
        const std::vector<double> kinks = traits_of(falloff).kinks;
        for (double t = 0.01; t < 0.985; t += 0.005) {
            double jump = 0.0;  // the kink is at none of the places looked at, perhaps
            for (int k = -2; k <= 2; ++k) jump = std::max(jump, slope_jump(t + 0.00125 * k, 0.002));
            const bool is_kink = jump > 0.5 * slope_jump(t, 0.008) && jump > 0.05;
            const bool said =
                std::ranges::any_of(kinks, [&](double kink) { return std::fabs(kink - t) < 0.006; });
            EXPECT_TRUE(said || !is_kink) << name(falloff) << " at " << t;
        }
    }
}

/// Tables over the squared distance need a w that is smooth in it: no peak at the centre.
TEST(Falloffs, AreTabulatedAsTheirCentreIs) {
    for (const Falloff& falloff : all_falloffs()) {
        const double slope = (1.0 - falloff_value(falloff, 1e-3)) / 1e-3;
        EXPECT_TRUE(traits_of(falloff).linear_in_distance || slope <= 0.1) << name(falloff);
    }
}

}  // namespace
}  // namespace astrosplat

// The budget against machines of known speed, and steps of more dots at rest.
#include "viewer/preview_budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace astrosplat {
namespace {

/// Milliseconds of a frame: a fixed part and so much per thousand splats.
struct Machine {
    double fixed_ms, ms_per_thousand;
    double frame(std::int64_t splats) const {
        return fixed_ms + ms_per_thousand * static_cast<double>(splats) / 1000.0;
    }
    friend void PrintTo(const Machine& given, std::ostream* out) {
        *out << given.fixed_ms << " ms and " << given.ms_per_thousand << " per thousand";
    }
};

/// Runs `frames` frames with all the splats one may ask for.
void run(PreviewBudget& budget, const Machine& machine, double target_ms, int frames) {
    for (int i = 0; i < frames; ++i) budget.measured(machine.frame(budget.splats), target_ms, budget.splats);
}

class Budget : public testing::TestWithParam<Machine> {};

TEST_P(Budget, ReachesTheTargetAndStaysThere) {
    for (const std::int64_t start : {30000, 200000, 3000000}) {
        PreviewBudget budget;
        budget.splats = start;
        run(budget, GetParam(), 25.0, 150);
        const double reached = GetParam().frame(budget.splats);
        EXPECT_GT(reached, 25.0 / 1.13) << "from " << start;
        EXPECT_LT(reached, 25.0 / 0.87) << "from " << start;
        const std::int64_t steady = budget.splats;
        for (int i = 0; i < 50; ++i) {
            run(budget, GetParam(), 25.0, 1);
            ASSERT_EQ(budget.splats, steady);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Machines, Budget,
                         testing::Values(Machine{6.0, 0.05}, Machine{15.0, 0.1}, Machine{1.0, 0.02},
                                         Machine{0.0, 0.3}));

TEST(PreviewBudgetTest, NeverFallsBelowTheLeast) {
    PreviewBudget budget;
    run(budget, {100.0, 1.0}, 25.0, 100);
    EXPECT_EQ(budget.splats, budget.least);
}

TEST(PreviewBudgetTest, NeverRisesAboveTheMost) {
    PreviewBudget budget;
    run(budget, {1.0, 0.0}, 25.0, 200);
    EXPECT_EQ(budget.splats, budget.most);
}

TEST(PreviewBudgetTest, ASlowFrameAmongOthersChangesNothing) {
    PreviewBudget budget;
    const std::int64_t before = budget.splats;
    for (int i = 0; i < 100; ++i) budget.measured(i % 5 == 3 ? 90.0 : 25.0, 25.0, budget.splats);
    EXPECT_EQ(budget.splats, before);
}

TEST(PreviewBudgetTest, FewerSplatsThanTheBudgetDoNotRaiseIt) {
    PreviewBudget budget;
    const std::int64_t before = budget.splats;
    for (int i = 0; i < 50; ++i) budget.measured(3.0, 25.0, 6000);
    EXPECT_EQ(budget.splats, before);
}

TEST(PreviewBudgetTest, FarTooSlowIsMendedWithinAFewFrames) {
    PreviewBudget budget;
    budget.splats = 2000000;
    const Machine machine{5.0, 0.1};
    run(budget, machine, 25.0, 12);
    EXPECT_LT(machine.frame(budget.splats), 50.0);
}

TEST(FramePace, LeavesTimeForTheRestOfTheWindow) {
    FramePace pace;
    EXPECT_DOUBLE_EQ(pace.target_ms(5.0, 25.0), 25.0);  // nothing known
    pace.drew(20.0);
    EXPECT_NEAR(pace.target_ms(5.050, 25.0), 1000.0 / 24.0 - 30.0, 1e-9);  // 30 ms beside the preview
    pace.drew(12.0);
    EXPECT_NEAR(pace.target_ms(5.122, 25.0), 1000.0 / 24.0 - 30.0, 1e-9);  // a slower frame says nothing
    pace.drew(12.0);
    EXPECT_DOUBLE_EQ(pace.target_ms(5.139, 25.0), 25.0);  // 5 ms beside it
    pace.drew(25.0);
    EXPECT_DOUBLE_EQ(pace.target_ms(6.0, 25.0), 25.0);  // after a pause, nothing known
    pace.drew(20.0);
    EXPECT_DOUBLE_EQ(pace.target_ms(6.1, 25.0), 10.0);  // never less
}

TEST(FinerSteps, StepsAreSharesThatTheTimeAllows) {
    constexpr std::int64_t galaxy = 9'400'000;
    EXPECT_EQ(dots_of_step(1, galaxy, 81'000, 0.03, 0.4), 470'000);
    EXPECT_EQ(dots_of_step(2, galaxy, 470'000, 0.1, 0.4), 1'880'000);
    EXPECT_EQ(dots_of_step(2, galaxy, 470'000, 0.2, 0.4), 940'000) << "which take 0.4 s";
    EXPECT_EQ(dots_of_step(2, galaxy, 470'000, 0.2, 0.0), 1'880'000) << "whatever it takes";
    EXPECT_EQ(dots_of_step(1, 100'000, 60'000, 0.01, 0.4), 0) << "fewer than there are";
    EXPECT_EQ(dots_of_step(3, galaxy, 81'000, 0.01, 0.4), 0) << "there is no such step";
}

TEST(FinerSteps, QuickFinalFramesAreNotHeldUp) {
    EXPECT_EQ(plan_steps(-1.0).count, 2) << "nobody knows yet";
    EXPECT_EQ(plan_steps(5.0).count, 2);
    EXPECT_EQ(plan_steps(1.7).count, 1);
    EXPECT_LE(plan_steps(1.7).most_s, 0.09) << "within the rest before it";
    EXPECT_EQ(plan_steps(0.2).count, 0);
}

}  // namespace
}  // namespace astrosplat

// Between what moves and the final frame, the picture comes closer to it in steps.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "unit/viewer/disk_session.h"

namespace astrosplat::test {
namespace {

TEST(FinerPreview, StepsAreSharesThatTheTimeAllows) {
    constexpr std::int64_t galaxy = 9'400'000;
    EXPECT_EQ(dots_of_step(1, galaxy, 81'000, 0.03, 0.4), 470'000);
    EXPECT_EQ(dots_of_step(2, galaxy, 470'000, 0.1, 0.4), 1'880'000);
    EXPECT_EQ(dots_of_step(2, galaxy, 470'000, 0.2, 0.4), 940'000) << "which take 0.4 s";
    EXPECT_EQ(dots_of_step(2, galaxy, 470'000, 0.2, 0.0), 1'880'000) << "whatever it takes";
    EXPECT_EQ(dots_of_step(1, 100'000, 60'000, 0.01, 0.4), 0) << "fewer than there are";
    EXPECT_EQ(dots_of_step(3, galaxy, 81'000, 0.01, 0.4), 0) << "there is no such step";
}

TEST(FinerPreview, QuickFinalFramesAreNotHeldUp) {
    EXPECT_EQ(plan_steps(-1.0).count, 2) << "nobody knows yet";
    EXPECT_EQ(plan_steps(5.0).count, 2);
    EXPECT_EQ(plan_steps(1.7).count, 1);
    EXPECT_LE(plan_steps(1.7).most_s, 0.09) << "within the rest before it";
    EXPECT_EQ(plan_steps(0.2).count, 0);
}

class FinerPreviewSession : public DiskSession {
  protected:
    FinerPreviewSession() : DiskSession(400'000, {640, 360}) {
        session.gl.software = true;
        session.fixed_splats = 3000;
        session.view.settle = false;
    }

    std::int64_t shown() const { return session.view_frame.status().shown; }
    double distance_to(const Image& other) const {
        const Image image = session.view_frame.read();
        double sum = 0.0;
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            sum += std::fabs(double(image.pixels[i]) - double(other.pixels[i]));
        return sum;
    }
};

TEST_F(FinerPreviewSession, EveryStepIsCloserToTheFinalFrame) {
    for (; !session.sets.loaded(session.document) || !preview_exact(session); now += 0.02) draw();
    session.document.edit("Wider", [](Scene& scene) { scene.camera.fov = 50.0; });  // the last change
    do draw();
    while (!session.sets.loaded(session.document) || !preview_exact(session));
    std::vector<Image> seen{session.view_frame.read()};
    std::vector<std::int64_t> dots{shown()};
    session.view.settle = true;
    draw();
    EXPECT_EQ(shown(), dots.back()) << "the hand may still move";
    now += 0.1;  // less than the final frame waits for
    while (seen.size() < 3) {
        draw();
        ASSERT_EQ(session.view_frame.status().state, ViewFrameState::preview);
        if (shown() == dots.back()) continue;
        dots.push_back(shown());
        seen.push_back(session.view_frame.read());
    }
    EXPECT_GT(dots[1], 3 * dots[0]);
    EXPECT_GT(dots[2], 3 * dots[1]);
    for (now += 1.0; !settled(session); now += 0.02) draw();
    EXPECT_LT(distance_to(seen[1]), 0.8 * distance_to(seen[0]));
    EXPECT_LT(distance_to(seen[2]), distance_to(seen[1]));
    EXPECT_GE(next_due(session, now), 0.1) << "nothing is left to be done";
}

}  // namespace
}  // namespace astrosplat::test

// From a start on, what is waited for comes first: the final picture before all that serves the next touch.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "unit/viewer/disk_session.h"

namespace astrosplat::test {
namespace {

class Start : public DiskSession {
  protected:
    Start() : DiskSession(1'500'000, {320, 180}) {}
    std::shared_ptr<const LoadedLayer> disk() const { return session.sets.loader().layer("disk"); }
};

// The clock stands: a set that arrives is no touch, after which the picture would have to rest.
TEST_F(Start, TheFinalPictureComesBeforeTheTreesOfLaterPreviews) {
    draw();
    now += 0.5;
    while (!settled(session)) draw();
    ASSERT_TRUE(disk()->set);
    EXPECT_FALSE(disk()->arranged);
    EXPECT_FALSE(disk()->histograms);
    while (!session.sets.loaded(session.document)) draw();
    EXPECT_TRUE(disk()->arranged);
    EXPECT_TRUE(disk()->histograms);
    EXPECT_TRUE(settled(session)) << "what came later changed nothing";
}

// Whoever moves needs them at once.
TEST_F(Start, AMovingHandDoesNotHoldUpTheTrees) {
    for (; !disk() || !disk()->arranged; now += 0.1) {
        session.document.edit("Wider", [&](Scene& scene) { scene.camera.fov = 40.0 + now - 1000.0; });
        draw();
        ASSERT_FALSE(settled(session));
    }
}

// Which takes the system a while.
TEST_F(Start, MemoryIsCountedEveryFiveSeconds) {
    advance(session, now);
    const std::int64_t before = session.status.memory_bytes;
    EXPECT_GT(before, 0);
    const std::vector<char> more(std::size_t{256} << 20, 'x');
    advance(session, now + 4.9);
    EXPECT_EQ(session.status.memory_bytes, before);
    advance(session, now + 5.0);
    EXPECT_GT(session.status.memory_bytes, before + (std::int64_t{200} << 20)) << more[0];
}

}  // namespace
}  // namespace astrosplat::test

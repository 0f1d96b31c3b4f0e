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

// From elsewhere bodies with depth along its rays look cut off.
TEST_F(Start, APictureIsSeenByItsOwnCamera) {
    ASSERT_EQ(session.view.view, ViewKind::camera);
    session.view.view = ViewKind::free;
    open_file(session, ASTROSPLAT_SOURCE_DIR "/assets/textures/spiral.jpg");
    EXPECT_EQ(session.view.view, ViewKind::camera);
    ASSERT_TRUE(session.document.scene().camera.position);
    EXPECT_EQ(*session.document.scene().camera.position,
              session.document.scene().layers[0].source.uv_camera.position);
}

// Whoever moves needs them at once.
TEST_F(Start, AMovingHandDoesNotHoldUpTheTrees) {
    int moves = 0;
    for (; !disk() || !disk()->arranged; now += 0.1) {
        ASSERT_LT(++moves, 2000) << "they take some seconds with the set itself";
        session.document.edit("Wider", [&](Scene& scene) { scene.camera.fov = 40.0 + 0.01 * moves; });
        draw();
        ASSERT_FALSE(settled(session));
    }
}

// They would take half of the processor from it.
TEST_F(Start, SumsForTheNextMoveGiveWayToTheFinalFrame) {
    session.gl.software = true;
    session.view.settle = false;
    for (; !session.sets.loaded(session.document) || !preview_exact(session); now += 0.02) draw();
    session.document.edit("Harder", [](Scene& scene) { scene.layers[0].look.alpha.power = 0.7f; });
    draw();  // what moved is at rest from now on
    draw();
    now += 0.15;
    draw();  // sums of the whole begin
    ASSERT_FALSE(session.view_frame.exact());
    session.view.settle = true;
    now += 0.1;
    draw();
    ASSERT_EQ(session.view_frame.status().state, ViewFrameState::refining);
    std::this_thread::sleep_for(std::chrono::seconds(2));  // they would long be there
    while (!settled(session)) draw();
    EXPECT_FALSE(session.view_frame.exact()) << "they begin again now";
    while (!session.view_frame.exact()) draw();
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

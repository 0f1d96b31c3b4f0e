// From a start on, what is waited for comes first: the final picture before all that serves the next touch.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "gl/gl_fixture.h"
#include "support/quiet.h"
#include "support/temp_folder.h"
#include "viewer/session.h"
#include "viewer/session_view.h"

namespace astrosplat::test {
namespace {

class Start : public GlTest {
  protected:
    ViewerOptions options() const {
        ViewerOptions options;
        options.input = folder.file("scene.toml",
                                    "astrosplat = 1\n[camera]\nposition = [0.0, 6.0, 8.0]\n"
                                    "[[layer]]\nname = \"disk\"\n[layer.source]\n"
                                    "meshes = [ { mesh = \"plane\", texture = \"" ASTROSPLAT_SOURCE_DIR
                                    "/assets/textures/spiral.jpg\" } ]\ncount = 1500000\n");
        return options;
    }
    void draw() {
        advance(session, now);
        draw_viewport(session, {320, 180}, now);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::shared_ptr<const LoadedLayer> disk() const { return session.sets.loader().layer("disk"); }

    const Quiet quiet;
    double now = 1000.0;  // s
    const TempFolder folder;
    Session session{options(), {}};
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

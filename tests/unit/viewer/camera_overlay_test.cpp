// The scene's camera as other views show it. Seen through itself, its frame is the picture's edge.
#include "viewer/viewport_camera.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "unit/edit/scenes.h"

namespace astrosplat {
namespace {

using Line = CameraOverlay::Line;

struct CameraOverlayTest : testing::Test {
    Scene scene = parse_scene(test::edit_scene, "/scene.toml");  // 640 x 360 px
    Bounds box{{-4.0, -1.0, -3.0}, {6.0, 1.0, 5.0}};
    ViewRequest request;
    Rect place{10.0f, 20.0f, 320.0f, 180.0f};
    CameraOverlay overlay;
    CameraOverlayTest() {
        request.scene = scene;
        request.box = box;
        request.width = 640;
        request.height = 360;
    }
    std::vector<Line> lines() { return overlay.lines(scene, scene, box, request, place); }
    bool has_line(const Line& wanted) {
        const std::vector<Line> all = lines();
        return std::any_of(all.begin(), all.end(), [&](const Line& line) {
            return std::equal(line.begin(), line.end(), wanted.begin(), wanted.end(),
                              [](const glm::vec2& a, const glm::vec2& b) {
                                  return std::abs(a.x - b.x) < 0.01f && std::abs(a.y - b.y) < 0.01f;
                              });
        });
    }
};

TEST_F(CameraOverlayTest, FrameAndTheMarkAboveItLieAtThePicturesEdge) {
    EXPECT_TRUE(has_line({{10, 20}, {330, 20}, {330, 200}, {10, 200}, {10, 20}}));
    EXPECT_TRUE(has_line({{138, 12.8f}, {170, -8.8f}, {202, 12.8f}, {138, 12.8f}}));
}

TEST_F(CameraOverlayTest, AViewFromElsewhereSeesTheWholeFrustum) {
    request.scene.camera.position = glm::dvec3(30.0, 4.0, 10.0);
    request.scene.camera.target =
        glm::dvec3(0.0, 4.0, 10.0);  // the scene's camera, which is so in the middle
    const std::vector<Line> all = lines();
    ASSERT_GE(all.size(), 6u);
    for (std::size_t i = 0; i < 4; ++i) {  // from the eye to the corners
        ASSERT_EQ(all[i].size(), 2u);
        EXPECT_NEAR(all[i][0].x, 170.0f, 0.01f);
        EXPECT_NEAR(all[i][0].y, 110.0f, 0.01f);
        EXPECT_GT(all[i][1].y, 110.0f - 180.0f);
    }
}

TEST_F(CameraOverlayTest, ACameraThatCannotBeMadeHasNoLines) {
    request.scene.camera.fov = 0.0;
    EXPECT_TRUE(lines().empty());
}

}  // namespace
}  // namespace astrosplat

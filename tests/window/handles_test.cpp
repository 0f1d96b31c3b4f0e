// A layer is moved by its handles in the picture, and a crop cuts it.
#include "edit/placement.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowHandles : public WindowTest {
  protected:
    /// Where the scene's camera shows a point at frame 1, px of the window.
    glm::vec2 at(const glm::dvec3& point) const {
        const Rect viewport = make_layout(ViewState(), width, height, 1.0f).viewport;
        const OutputParams output = saved().output;
        const double aspect = double(output.width) / double(output.height);
        const double high = std::min(double(viewport.height), double(viewport.width) / aspect);
        const Rect place =
            place_frame(ViewState(), viewport, int(std::lround(high * aspect)), int(std::lround(high)));
        const Camera camera = make_camera(saved().camera, double(place.width), double(place.height), {});
        return glm::vec2(place.x, place.y) + *project_point(camera, point);
    }
};

TEST_F(WindowHandles, ALayerIsDraggedUndoneAndSaved) {
    start();
    const Pixels before = settled_frame();
    person->press("w");
    person->drag(at({0.0, 0.0, 0.0}), at({1.0, 0.0, 0.0}) - at({0.0, 0.0, 0.0}));
    expect_title("scene.toml - edited");
    person->press("ctrl+s");
    expect_title("scene.toml");
    EXPECT_NEAR(saved().layers[0].transform.translate.x, 1.0, 0.05);
    person->press("ctrl+z");
    expect_title("scene.toml - edited");
    person->press("w");
    expect_settled(before);
}

TEST_F(WindowHandles, ADragBesideThemOrbits) {
    start();
    settled_frame();
    person->press("w");
    person->drag(at({0.0, 0.0, 0.0}) + glm::vec2(0.0f, 200.0f), {60.0f, 0.0f});
    const Pixels tools = pixels_of(&Layout::tools);
    person->press("0");
    EXPECT_TRUE(comes_true([&] { return pixels_of(&Layout::tools) != tools; })) << "it was a free view";
    EXPECT_EQ(title(), "scene.toml - astrosplat");
}

}  // namespace
}  // namespace astrosplat::test

// Scenes begun in the window: empty, with a shape, with a mesh that has no picture.
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowNew : public WindowTest {
  protected:
    static int lit(const Pixels& pixels) {
        int count = 0;
        for (const std::uint32_t rgb : pixels.rgb) count += (rgb & 0xff) > 40 && (rgb >> 16 & 0xff) > 40;
        return count;
    }
};

TEST_F(WindowNew, AnEmptySceneTakesAShape) {
    start();
    settled_frame();
    choose("File/New/Empty scene");
    expect_title("Untitled");
    EXPECT_TRUE(comes_true([&] { return lit(frame_pixels()) < 8000; })) << "only words and the gate are left";
    choose("Layer/Add shape/Sphere");
    expect_title("Untitled - edited");
    EXPECT_TRUE(comes_true([&] { return settled() && lit(frame_pixels()) > 20000; }))
        << program->err_so_far();
    EXPECT_EQ(end(SIGTERM).code, 143);
}

TEST_F(WindowNew, AMeshWithoutAPictureIsNeutralGrey) {
    write_text(folder / "netz.obj", "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 2 3 4\n");
    fs::remove(folder / "rings.png");
    start({(folder / "netz.obj").string(), "--no-cache"});
    EXPECT_TRUE(comes_true([&] { return settled() && lit(frame_pixels()) > 20000; }))
        << program->err_so_far();
    ViewState offers;
    offers.grey_layer = "netz";
    const Rect notice = make_layout(offers, width, height, 1.0f).notice;
    EXPECT_GT(lit(screen->pixels({int(notice.x), int(notice.y), 500, int(notice.height)})), 100)
        << "it is said";
}

}  // namespace
}  // namespace astrosplat::test

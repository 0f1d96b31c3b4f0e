// Files from the window: what it shows, one frame, and a range that is cancelled.
#include <cmath>
#include <set>

#include "output/read_frame.h"
#include "source/texture.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowWaysOut : public WindowTest {
  protected:
    std::set<std::string> names_in(const fs::path& place) const {
        std::set<std::string> names;
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(place, ignored))
            names.insert(entry.path().filename().string());
        return names;
    }
};

/// A picture file of the window, as the screen has it.
Pixels load_pixels(const fs::path& file) {
    const Image image = load_raw_image(file);
    Pixels pixels{static_cast<int>(image.width), static_cast<int>(image.height), {}};
    for (std::int64_t i = 0; i < image.width * image.height; ++i) {
        std::uint32_t rgb = 0;
        for (int c = 0; c < 3; ++c)
            rgb = rgb << 8 | static_cast<std::uint32_t>(std::lround(
                                 255.0f * image.pixels[static_cast<std::size_t>(i * image.channels + c)]));
        pixels.rgb.push_back(rgb);
    }
    return pixels;
}

TEST_F(WindowWaysOut, AScreenshotIsTheWindow) {
    start();
    settled_frame();
    person->move({width - 2.0f, height - 2.0f});
    Pixels shown = screen->pixels({0, 0, width, height});
    person->press("F12");
    person->press("ctrl+a");
    person->type("window.png");
    person->press("Return");
    ASSERT_TRUE(comes_true([&] { return fs::exists(folder / "window.png"); }));
    Pixels saved = load_pixels(folder / "window.png");
    ASSERT_EQ(saved.width, width);
    ASSERT_EQ(saved.height, height);
    const Rect status = make_layout(ViewState(), width, height, 1.0f).status;  // memory, messages
    for (Pixels* pixels : {&shown, &saved})
        pixels->rgb.resize(static_cast<std::size_t>(status.y) * static_cast<std::size_t>(width));
    EXPECT_EQ(saved, shown);
}

TEST_F(WindowWaysOut, AFrameIsRendered) {
    start();
    const Pixels before = settled_frame();
    choose("Render/This frame...");
    same_widgets().frame(2);
    person->press("ctrl+a");
    person->type("frame.png");
    person->click(same_widgets().at("file/Save"));
    ASSERT_TRUE(comes_true([&] { return fs::exists(folder / "frame.png"); }));
    const ImageInfo info = read_image_info(folder / "frame.png");
    EXPECT_EQ(info.width, 320);
    EXPECT_EQ(info.height, 180);
    const RunResult batch = run({"--batch", scene_file.string(), "-f", "1", "-o", "batch.png", "--no-cache"});
    ASSERT_EQ(batch.code, 0) << batch.err;
    EXPECT_EQ(text_of(folder / "frame.png"), text_of(folder / "batch.png"));
    expect_settled(before);
}

TEST_F(WindowWaysOut, ACancelledRangeLeavesWholeFilesOnly) {
    std::string text = text_of(scene_file);
    text.replace(text.find("1-24"), 4, "1-9000");
    write_text(scene_file, text);
    start();
    settled_frame();
    person->press("ctrl+shift+r");
    ASSERT_TRUE(comes_true([&] { return names_in(folder / "frames").size() > 2; }));
    person->drag(same_widgets().at("frame in view"), {60.0f, 0.0f});  // usable meanwhile
    same_widgets().status.job = {"Rendering", 0.1f};
    same_widgets().frame();
    choose("Render/Cancel");
    EXPECT_TRUE(comes_true([&] { return names_in(folder / "tmp").empty(); })) << "the job's folder stays";
    const std::set<std::string> files = names_in(folder / "frames");
    EXPECT_LT(files.size(), 9000u);
    for (const std::string& file : files) {
        EXPECT_EQ(file.size(), std::string("shot.0001.png").size()) << file;
        const Image image = load_linear_image(folder / "frames" / file);
        EXPECT_EQ(image.width, 320) << file;
    }
    EXPECT_TRUE(running());
}

/// Frames that are finished and still the scene's are kept, others are rendered again.
TEST_F(WindowWaysOut, ARangeGoesOnWhereItEnded) {
    std::string text = text_of(scene_file);
    text.replace(text.find("1-24"), 4, "1-3");
    write_text(scene_file, text);
    ASSERT_EQ(run({"--batch", scene_file.string(), "--no-cache"}).code, 0);
    const fs::path frames = folder / "frames", kept = frames / "shot.0002.png";
    const std::string whole = text_of(kept);
    fs::remove(frames / "shot.0001.png");
    ASSERT_EQ(run({"--batch", scene_file.string(), "-f", "3", "--set", "output.exposure=2", "--overwrite",
                   "--no-cache"})
                  .code,
              0);
    const std::string other = text_of(frames / "shot.0003.png");
    const fs::file_time_type long_ago = fs::last_write_time(kept) - std::chrono::hours(1);
    fs::last_write_time(kept, long_ago);
    start();
    settled_frame();
    person->press("ctrl+shift+r");
    EXPECT_TRUE(comes_true([&] {
        return fs::exists(frames / "shot.0001.png") && text_of(frames / "shot.0003.png") != other &&
               names_in(folder / "tmp").empty();
    }));
    EXPECT_EQ(fs::last_write_time(kept), long_ago);
    EXPECT_EQ(text_of(kept), whole);
}

}  // namespace
}  // namespace astrosplat::test

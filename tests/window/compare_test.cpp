// Two looks one after the other, and the output's own pixels.
#include <cmath>

#include "output/metadata.h"
#include "source/texture.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowCompare : public WindowTest {};

TEST_F(WindowCompare, TabShowsTheStoredLookAndTheOneAtHand) {
    start();
    const Pixels stored = settled_frame();
    person->press("b");
    person->drag(value_box(power), {60.0f, 0.0f});
    const Pixels changed = settled_frame(stored);
    person->press("Tab");
    expect_settled(stored);
    person->press("Tab");
    expect_settled(changed);
    expect_title("scene.toml - edited");
}

/// The ground of a signed difference is what no picture of the scene has.
TEST_F(WindowCompare, DShowsWhereTheFrontDiffersAndThePictureAgain) {
    start();
    const Pixels before = settled_frame();
    constexpr std::uint32_t ground = IM_COL32(18, 18, 22, 255);
    ASSERT_EQ(count_of(before, ground), 0);
    person->press("d");
    EXPECT_TRUE(comes_true([&] { return count_of(frame_pixels(), ground) > 1000; })) << program->err_so_far();
    person->press("d");
    expect_settled(before);
}

/// Of a picture larger than the viewport its middle, pixel by pixel as it will be in the file.
TEST_F(WindowCompare, OutputPixelsAreThoseOfTheFrame) {
    std::string text = text_of(scene_file);
    text.replace(text.find("[320, 180]"), 10, "[1600, 1200]");
    write_text(scene_file, text);
    start();
    const Pixels fitted = settled_frame();
    person->press("z");
    const Pixels shown = settled_frame(fitted);
    ASSERT_EQ(run({"--batch", scene_file.string(), "-f", "1", "-o", "frame.png", "--no-cache"}).code, 0);
    const Image frame = load_raw_image(folder / "frame.png");
    ViewState view;
    view.size = SizeMode::one_to_one;
    const Rect viewport = make_layout(ViewState(), width, height, 1.0f).viewport;
    const Rect whole = place_frame(view, viewport, 1600, 1200);
    const auto left = static_cast<int>(viewport.x - whole.x), top = static_cast<int>(viewport.y - whole.y);
    ASSERT_GT(left, 0);
    ASSERT_GT(top, 0);
    int wrong = 0;
    for (int y = 150; y < shown.height - 150; ++y)  // words and a frame lie over the edges
        for (int x = 200; x < shown.width - 200; ++x)
            for (int c = 0; c < 3; ++c) {
                const int wanted = static_cast<int>(std::lround(255.0f * frame.at(x + left, y + top)[c]));
                const std::uint32_t rgb =
                    shown.rgb[std::size_t(y) * std::size_t(shown.width) + std::size_t(x)];
                wrong += std::abs(static_cast<int>(rgb >> (16 - 8 * c) & 255) - wanted) > 1;
            }
    EXPECT_EQ(wrong, 0);
}

TEST_F(WindowCompare, WhatACommandDidIsSaid) {
    start();
    settled_frame();
    const Rect bar = make_layout(ViewState(), width, height, 1.0f).status;
    const auto message = [&] {
        return screen->pixels({0, static_cast<int>(bar.y), 400, static_cast<int>(bar.height)});
    };
    const Pixels before = message();
    choose("Render/Copy batch command");
    EXPECT_TRUE(comes_true([&] { return message() != before; }));
}

}  // namespace
}  // namespace astrosplat::test

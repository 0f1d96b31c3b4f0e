// Pictures to compare with: two looks, the output's own pixels, a reference.
#include "gui/widgets.h"
#include "output/metadata.h"
#include "source/texture.h"
#include "support/test.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

// Two looks one after the other, and the output's own pixels.

class WindowCompare : public WindowTest {};

TEST_F(WindowCompare, TabShowsTheStoredLookAndTheOneAtHand) {
    const Pixels stored = start_settled();
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
    const Pixels before = start_settled();
    constexpr std::uint32_t ground = IM_COL32(18, 18, 22, 255);
    ASSERT_EQ(count_of(before, ground), 0);
    person->press("d");
    EXPECT_TRUE(comes_true([&] { return count_of(frame_pixels(), ground) > 1000; })) << program->err_so_far();
    person->press("d");
    expect_settled(before);
}

/// Of a picture larger than the viewport its middle, pixel by pixel as it will be in the file.
TEST_F(WindowCompare, OutputPixelsAreThoseOfTheFrame) {
    replace_in_scene("[320, 180]", "[1600, 1200]");
    const Pixels fitted = start_settled();
    person->press("z");
    const Pixels shown = settled_frame(fitted);
    expect_success(run({"--batch", scene_file.string(), "-f", "1", "-o", "frame.png", "--no-cache"}));
    const Image frame = load_raw_image(folder / "frame.png");
    ViewState view;
    view.size = SizeMode::one_to_one;
    const Rect viewport = layout().viewport;
    const Rect whole = place_frame(view, viewport, 1600, 1200);
    const auto left = int(viewport.x - whole.x), top = int(viewport.y - whole.y);
    ASSERT_GT(left, 0);
    ASSERT_GT(top, 0);
    int wrong = 0;
    for (int y = 150; y < shown.height - 150; ++y)  // words and a frame lie over the edges
        for (int x = 200; x < shown.width - 200; ++x)
            for (int c = 0; c < 3; ++c) {
                const int wanted = int(std::lround(255.0f * frame.at(x + left, y + top)[c]));
                const std::uint32_t rgb =
                    shown.rgb[std::size_t(y) * std::size_t(shown.width) + std::size_t(x)];
                wrong += std::abs(int(rgb >> (16 - 8 * c) & 255) - wanted) > 1;
            }
    EXPECT_EQ(wrong, 0);
}

TEST_F(WindowCompare, WhatACommandDidIsSaid) {
    start_settled();
    const Rect bar = layout().status;
    const auto message = [&] { return screen->pixels({0, int(bar.y), 400, int(bar.height)}); };
    const Pixels before = message();
    choose("Render/Copy batch command");
    EXPECT_TRUE(comes_true([&] { return message() != before; }));
}

// A picture to compare with: over the view where it is placed, blinking, and taken from it.

constexpr std::uint32_t picture_color = IM_COL32(200, 100, 50, 255);
constexpr std::uint32_t no_difference = IM_COL32(128, 128, 128, 255);

/// Of one colour, twice as wide as high, half as high as the frame, named in the scene.
class WindowReference : public WindowTest {
  protected:
    WindowReference() {
        write_plain(folder / "ferner Nebel ä.png", 32, 16, {200, 100, 50});
        write_text(scene_file,
                   text_of(scene_file) + "\n[[reference]]\nfile = \"ferner Nebel ä.png\"\nscale = 0.5\n");
    }
    Rect frame() const {
        const Rect viewport = layout().viewport;
        const OutputParams output = saved().output;
        const double shown =
            std::min(viewport.height / double(output.height), viewport.width / double(output.width));
        return place_frame(ViewState(), viewport, int(std::lround(shown * double(output.width))),
                           int(std::lround(shown * double(output.height))));
    }
    glm::vec2 middle() const { return {frame().x + 0.5f * frame().width, frame().y + 0.5f * frame().height}; }
    int seen() const { return count_of(frame_pixels(), picture_color); }
};

TEST_F(WindowReference, IsPlacedByTheMouseSavedAndUndone) {
    const Pixels before = start_settled();
    EXPECT_EQ(seen(), 0);
    person->press("shift+b");
    person->press("p");
    const double area = 0.5 * frame().height * frame().height;
    EXPECT_TRUE(comes_true([&] { return seen() > 0.97 * area; })) << seen();
    person->drag(middle(), {0.25f * frame().height, 0.125f * frame().height});
    expect_title("scene.toml - edited");
    save();
    ASSERT_EQ(saved().references.size(), 1u);
    EXPECT_NEAR(saved().references[0].position.x, 0.25, 0.01);
    EXPECT_NEAR(saved().references[0].position.y, -0.125, 0.01);
    person->press("ctrl+z");
    expect_title("scene.toml - edited");
    person->press("Escape");
    person->press("Tab");
    expect_settled(before);
    EXPECT_EQ(end(SIGTERM).code, 143);
}

TEST_F(WindowReference, IsNotInThePictureOfASnapshot) {
    start_settled();
    person->press("shift+b");
    person->press("Tab");
    EXPECT_TRUE(comes_true([&] { return seen() > 0; }));
    person->press("b");
    const fs::path picture = folder / "scene.snapshots/0001.png";
    ASSERT_TRUE(comes_true([&] { return fs::exists(picture); }));
    const Image thumbnail = load_raw_image(picture);
    const float* const middle = thumbnail.at(thumbnail.width / 2, thumbnail.height / 2);
    EXPECT_GT(std::fabs(middle[0] - 200.0f / 255.0f) + std::fabs(middle[2] - 50.0f / 255.0f), 0.1f);
}

TEST_F(WindowReference, BlinksAndStops) {
    const Pixels before = start_settled();
    person->press("shift+b");
    person->press("x");
    for (int change = 0; change < 2; ++change) {
        EXPECT_TRUE(comes_true([&] { return seen() > 0; }));
        EXPECT_TRUE(comes_true([&] { return seen() == 0; }));
    }
    person->press("x");
    expect_settled(before);
}

TEST_F(WindowReference, OneThatCannotBeReadIsSaid) {
    fs::remove(folder / "ferner Nebel ä.png");
    const Pixels before = start_settled();
    person->press("shift+b");
    person->press("Tab");
    const Rect bar = layout().status;
    EXPECT_TRUE(comes_true([&] {
        return count_of(screen->pixels({0, int(bar.y), 600, int(bar.height)}), color::error) > 0;
    })) << "the message is red";
    EXPECT_EQ(frame_pixels(), before);
}

/// The frame itself, as a picture that lies elsewhere.
TEST_F(WindowReference, IsAlignedToTheView) {
    expect_success(run({"--batch", scene_file.string(), "-f", "1", "-o", "frame.png", "--no-cache"}));
    std::string text = text_of(scene_file);
    text.replace(text.find("ferner Nebel"), text.size(),
                 "frame.png\"\nposition = [0.1, -0.05]\nscale = 0.8\n");
    write_text(scene_file, text);
    start_settled();
    same_widgets().status.reference = ReferenceStatus{0, 16.0 / 9.0, ""};
    same_widgets().frame(2);
    choose("View/Align reference to this view");
    expect_title("scene.toml - edited");
    save();
    const ReferenceParams found = saved().references.at(0);
    EXPECT_NEAR(found.position.x, 0.0, 1.0 / frame().height);
    EXPECT_NEAR(found.position.y, 0.0, 1.0 / frame().height);
    EXPECT_NEAR(found.scale, 1.0, 0.005);
    person->press("ctrl+z");
    expect_title("scene.toml - edited");
}

/// Pixels equal to B are grey in the difference, whatever is stored as B; changes lie about that grey.
TEST_F(WindowReference, TheDifferenceFromBIsNeverBlack) {
    start_settled();
    person->press("b");
    choose("View/Difference");
    const double pixels = double(frame().width) * double(frame().height);
    EXPECT_TRUE(comes_true([&] { return count_of(frame_pixels(), no_difference) > 0.8 * pixels; }));
    person->press("b");
    EXPECT_TRUE(comes_true([&] { return count_of(frame_pixels(), no_difference) > 0.8 * pixels; }));
    person->drag(value_box(power), {60.0f, 0.0f});
    EXPECT_TRUE(comes_true([&] { return count_of(frame_pixels(), no_difference) < 0.8 * pixels; }));
}

}  // namespace
}  // namespace astrosplat::test

// The viewport: drags, flying, wipe, 1:1, and the badge.
#include "gui/viewport.h"
#include "gui/gui_frame.h"
#include "gui/panel/panel.h"
#include "gui/test_window.h"
#include "gui/viewport_overlay.h"
#include "gui/widgets.h"
#include "support/test.h"

namespace astrosplat {
namespace {

using Kind = Command::Kind;

class ViewportTest : public ExampleWindow {};

TEST_F(ViewportTest, ItsShapeIsInSmallNumbersOrToOne) {
    EXPECT_EQ(aspect_text(1920, 1080), "16:9");
    EXPECT_EQ(aspect_text(2900, 1900), "29:19");
    EXPECT_EQ(aspect_text(3000, 1900), "1.58:1");
    EXPECT_EQ(aspect_text(1900, 3000), "0.63:1");
    EXPECT_EQ(aspect_text(1000, 1000), "1:1");
}

TEST_F(ViewportTest, MouseButtonsMeanDrags) {
    using Drag = ViewportInput::Drag;
    EXPECT_EQ(drag_of(0, false, false), Drag::orbit);
    EXPECT_EQ(drag_of(0, true, false), Drag::pan);
    EXPECT_EQ(drag_of(2, false, false), Drag::pan);
    EXPECT_EQ(drag_of(1, false, false), Drag::look);
    EXPECT_EQ(drag_of(0, false, true), Drag::orbit);
    EXPECT_EQ(drag_of(2, false, true), Drag::pan);
    EXPECT_EQ(drag_of(1, false, true), Drag::dolly);
}

TEST_F(ViewportTest, ADragBeginsMovesAndEnds) {
    const glm::vec2 middle = window.at("frame in view");
    window.hover(middle);
    EXPECT_TRUE(window.gui.viewport_input().hovered);
    window.press(0);
    EXPECT_TRUE(window.gui.viewport_input().drag_begins);
    EXPECT_EQ(window.gui.viewport_input().drag, ViewportInput::Drag::orbit);
    window.move(middle + glm::vec2(30, -10));
    window.frame();
    EXPECT_EQ(window.gui.viewport_input().delta_px, glm::dvec2(30, -10));
    EXPECT_FALSE(window.gui.viewport_input().drag_begins);
    window.release(0);
    EXPECT_TRUE(window.gui.viewport_input().drag_ends);
    window.frame();
    EXPECT_FALSE(window.gui.viewport_input().drag_ends);
}

/// A click, `by` px from the middle of the view; the mouse may slip a little between press and release.
ViewportInput::Click click_in_view(TestWindow& window, glm::vec2 by, float slip = 0.0f) {
    const glm::vec2 at = window.at("frame in view") + by;
    window.frame(60);  // no double click of the last one
    window.hover(at);
    window.press(0);
    EXPECT_EQ(window.gui.viewport_input().click, ViewportInput::Click::none);
    window.move(at + glm::vec2(slip, 0.0f));
    window.frame();
    window.release(0);
    const ViewportInput::Click click = window.gui.viewport_input().click;
    window.frame();
    EXPECT_EQ(window.gui.viewport_input().click, ViewportInput::Click::none);
    return click;
}

TEST_F(ViewportTest, APressWithoutADragIsAClick) {
    using Click = ViewportInput::Click;
    EXPECT_EQ(click_in_view(window, {0, 0}), Click::in_front);
    EXPECT_EQ(click_in_view(window, {40, 0}), Click::in_front);
    EXPECT_EQ(click_in_view(window, {42, 1}), Click::behind) << "in the same place again";
    EXPECT_EQ(click_in_view(window, {0, 0}, 2.0f), Click::in_front);
    EXPECT_EQ(click_in_view(window, {80, 0}, 30.0f), Click::none);
    window.hold(true, false, false);
    EXPECT_EQ(click_in_view(window, {120, 0}), Click::behind);
    window.hold(false, true, false);
    EXPECT_EQ(click_in_view(window, {160, 0}), Click::none) << "Shift pans";
    window.hold(false, false, true);
    EXPECT_EQ(click_in_view(window, {200, 0}), Click::none);
}

/// By the button at its row or by its action; a click is one, whatever could be dragged there.
TEST_F(ViewportTest, TheFocusIsPicked) {
    window.view.tab = PanelTab::camera;
    window.frame(3);
    EXPECT_FALSE(window.has("pick focus")) << "there is no focus";
    window.choose("Camera/Pick the focus in the view");
    EXPECT_FALSE(window.view.picking_focus);
    window.tap(key_code::escape);
    window.tap(key_code::escape);  // the menu stays open
    window.document.edit("F-number", [](Scene& scene) { scene.camera.f_number = 2.0; });
    window.frame(3);
    window.click("pick focus");
    EXPECT_TRUE(window.view.picking_focus);
    window.click("pick focus");
    EXPECT_FALSE(window.view.picking_focus);
    window.choose("Camera/Pick the focus in the view");
    EXPECT_TRUE(window.view.picking_focus);
    window.view.tool = HandleTool::move;
    window.view.select = SelectTool::lasso;
    window.status.viewport_camera = make_camera({}, 100.0, 100.0, {});
    EXPECT_EQ(click_in_view(window, {0, 0}), ViewportInput::Click::in_front);
    window.view.picking_focus = false;
    EXPECT_EQ(click_in_view(window, {40, 0}), ViewportInput::Click::none) << "it begins a lasso";
    window.view.picking_focus = true;
    window.tap(key_code::escape);
    EXPECT_FALSE(window.view.picking_focus);
    EXPECT_EQ(window.view.select, SelectTool::lasso) << "Escape ends one thing";
}

TEST_F(ViewportTest, ADoubleClickIsOneClickOnly) {
    const glm::vec2 at = window.at("frame in view");
    window.frame(60);
    window.click(at);
    window.press(0);
    EXPECT_TRUE(window.gui.viewport_input().double_click);
    window.release(0);
    EXPECT_EQ(window.gui.viewport_input().click, ViewportInput::Click::none);
}

TEST_F(ViewportTest, LettersFlyOnlyWhileLookingAround) {
    window.hover(window.at("frame in view"));
    ImGui::GetIO().KeysDown['W'] = true;
    window.frame();
    EXPECT_EQ(window.gui.viewport_input().fly, glm::dvec3(0));
    window.press(1);
    window.hold(false, true, false);
    window.frame();
    EXPECT_EQ(window.gui.viewport_input().fly, glm::dvec3(0, 0, 1));
    EXPECT_EQ(window.gui.viewport_input().speed, 10.0);
    ImGui::GetIO().KeysDown['W'] = false;
    ImGui::GetIO().KeysDown['S'] = true;
    window.frame();
    EXPECT_EQ(window.gui.viewport_input().fly, glm::dvec3(0, 0, -1));
    EXPECT_TRUE(window.view.solo.empty()) << "S flies, it does not solo";
    ImGui::GetIO().KeysDown['S'] = false;
    window.release(1);
}

TEST(ToolRow, ThePreviewGoesFromFluidToEverySplat) {
    TestWindow window(example_document());
    ASSERT_EQ(window.view.preview_share, 0.0f);
    window.drag(window.at("preview"), {20.0f, 0.0f});
    EXPECT_GT(window.view.preview_share, 0.5f);
    EXPECT_LT(window.view.preview_share, 0.95f);
    window.frame(60);  // not a double click
    window.drag(window.at("preview"), {400.0f, 0.0f});
    EXPECT_EQ(window.view.preview_share, 1.0f);
    window.frame(60);
    window.drag(window.at("preview"), {-400.0f, 0.0f});
    EXPECT_EQ(window.view.preview_share, 0.0f);
}

TEST_F(ViewportTest, TheWipeIsDragged) {
    window.view.compare = CompareMode::wipe;
    window.frame();
    const glm::vec2 middle = window.at("frame in view");
    window.drag(middle, {200, 0});
    EXPECT_GT(window.view.wipe, 0.6f);
    EXPECT_LT(window.view.wipe, 0.7f);
}

/// A square reference as high as the frame, being placed.
class Placing : public testing::Test {
  protected:
    Placing() {
        window.document.edit("Reference", [](Scene& scene) {
            scene.references.resize(1);
            scene.references[0].file = "m51.png";
        });
        window.status.reference = ReferenceStatus{0, 1.0, ""};
        window.frame();
        window.tap('P');
        const Rect picture = make_layout(window.view, 1600.0f, 900.0f, 1.0f).viewport;
        const ViewFrameStatus& shown = window.status.view_frame;
        frame = frame_on_screen(place_frame(window.view, picture, shown.width, shown.height));
    }
    const ReferenceParams& placed() const { return window.document.scene().references[0]; }
    float h() const { return float(frame.height); }
    double px() const { return 1.0 / frame.height; }  // the mouse lies on whole ones

    TestWindow window{example_document()};
    FrameOnScreen frame;
};

TEST_F(Placing, ShowsTheReferenceAndEndsByEscape) {
    EXPECT_TRUE(window.view.placing);
    EXPECT_EQ(window.view.compare, CompareMode::other);
    EXPECT_EQ(window.view.compare_with, CompareWith::reference);
    window.tap(key_code::escape);
    EXPECT_FALSE(window.view.placing);
    window.drag(frame.middle, {40.0f, 0.0f});
    EXPECT_EQ(placed().position, glm::dvec2(0.0)) << "the mouse is the camera's again";
}

TEST_F(Placing, TheInsideMovesItAsOneUndoStep) {
    window.drag(frame.middle, {0.25f * h(), -0.125f * h()});
    EXPECT_NEAR(placed().position.x, 0.25, px());
    EXPECT_NEAR(placed().position.y, 0.125, px());
    EXPECT_EQ(placed().scale, 1.0);
    EXPECT_EQ(placed().rotate, 0.0);
    EXPECT_EQ(window.document.undo_name(), "Place reference");
    EXPECT_EQ(window.view.view, ViewKind::camera) << "the camera stays";
    window.tap('Z', true);
    EXPECT_EQ(placed().position, glm::dvec2(0.0));
    EXPECT_EQ(placed().file, "m51.png");
}

TEST_F(Placing, ACornerScalesAndTheOutsideOrShiftTurns) {
    window.document.edit("Smaller", [](Scene& scene) { scene.references[0].scale = 0.5; });
    window.frame();
    const glm::vec2 corner{0.25f * h(), 0.25f * h()};  // from the middle, lower right
    window.drag(glm::vec2(frame.middle) + corner, 0.5f * corner);
    EXPECT_NEAR(placed().scale, 0.75, 2.0 * px());
    EXPECT_EQ(placed().position, glm::dvec2(0.0));
    const glm::vec2 right{0.45f * h(), 0.0f}, up{0.0f, -0.45f * h()};
    window.drag(glm::vec2(frame.middle) + right, up - right);
    EXPECT_NEAR(placed().rotate, 90.0, 0.4) << "a pixel at the mouse";
    window.hold(false, true, false);
    window.drag(glm::vec2(frame.middle) + 0.25f * up, 0.25f * (right - up));
    window.hold(false, false, false);
    EXPECT_NEAR(placed().rotate, 0.0, 0.8);
}

TEST_F(Placing, TheWheelScalesItAboutTheMouseAndNotTheCamera) {
    window.hover(glm::vec2(frame.middle) + glm::vec2(0.25f * h(), 0.0f));
    window.wheel(1.0f);
    EXPECT_NEAR(placed().scale, 1.05, 1e-5);
    EXPECT_NEAR(placed().position.x, 0.25 - 0.25 * 1.05, 0.05 * px());
    EXPECT_EQ(window.gui.viewport_input().wheel, 0.0f);
    window.wheel(1.0f);
    window.tap('Z', true);
    EXPECT_EQ(placed().scale, 1.0) << "notches in a row are one step";
}

TEST_F(ViewportTest, TheDifferenceIsSaidInNumbers) {
    EXPECT_EQ(difference_text({0.0041, 31.24, 0.9699}), "Mean +0.4 %, 31.2 dB, light -3.0 %");
    EXPECT_EQ(difference_text({-0.0, std::numeric_limits<double>::infinity(), 1.0}),
              "Mean +0.0 %, the same, light +0.0 %");
    EXPECT_EQ(difference_text({0.5, 3.0, std::numeric_limits<double>::infinity()}),
              "Mean +50.0 %, 3.0 dB, no light to compare with");
}

TEST_F(ViewportTest, OneToOneZoomsAboutTheMouseAndMoves) {
    window.view.size = SizeMode::one_to_one;
    const glm::vec2 middle = window.at("frame in view");
    window.hover(middle + glm::vec2(100, 0));
    for (int i = 0; i < 4; ++i) window.wheel(1);
    EXPECT_NEAR(window.view.zoom, 2.0, 1e-9);
    EXPECT_NEAR(window.view.pan_px.x, -100, 1) << "what lies under the mouse stays";
    EXPECT_EQ(window.gui.viewport_input().wheel, 0.0f) << "the camera does not move";
    window.view.pan_px = {0, 0};
    window.drag(middle, {40, 20}, 2);
    EXPECT_EQ(window.view.pan_px, glm::dvec2(40, 20));
}

TEST_F(ViewportTest, APictureOfNothingIsNotCalledFinal) {
    Status status;
    status.view_frame.state = ViewFrameState::final;
    Scene scene;
    EXPECT_EQ(badge_text(scene, status).text, "Empty");
    EXPECT_EQ(badge_text(scene, status).beside, "no layer yet");
    scene.layers.emplace_back();
    EXPECT_EQ(badge_text(scene, status).beside, "no splats to show");
    status.view_frame.total = 1;
    EXPECT_NE(badge_text(scene, status).text, "Empty");
}

TEST_F(ViewportTest, TheBadgeSaysHowFinalItIs) {
    const Document document = example_document();
    Status status = example_status();
    EXPECT_EQ(badge_text(document.scene(), status).text, "Refining 41 %");
    status.view_frame.state = ViewFrameState::preview;
    EXPECT_EQ(badge_text(document.scene(), status).text, "Preview, 240 k splats for 12.4 M");
    status.view_frame.state = ViewFrameState::final;
    status.view_frame.seconds = 1.8;
    EXPECT_EQ(badge_text(document.scene(), status).text, "Final 1.8 s");
    status.view_frame.seconds = 0.0234;
    status.view_frame.device = "a card";
    EXPECT_EQ(badge_text(document.scene(), status).text, "Final 23 ms");
    EXPECT_HAS(badge_text(document.scene(), status).beside, ", a card");
    status.view_frame.seconds = 1.8;
    status.view_frame.device.clear();
    status.layers[1].stale = true;
    EXPECT_EQ(badge_text(document.scene(), status).text, "Not final: stars needs to be generated again");
    status.layers[0].error = "dust.obj: no such file";
    EXPECT_EQ(badge_text(document.scene(), status).text, "Not final: dust is missing");
    status.layers[0].error.clear();
    status.layers[1].stale = false;
    status.layers[1].loading = true;
    status.layers[1].progress = 0.37f;
    status.layers[1].found = 3100000;
    EXPECT_EQ(badge_text(document.scene(), status).text, "Generating stars 37 %");
    EXPECT_EQ(badge_text(document.scene(), status).beside, "3.1 M splats");
    status.layers[1].found = 0;  // read from a file
    EXPECT_EQ(badge_text(document.scene(), status).beside, "");
}

TEST_F(ViewportTest, TheFrontIsMeasuredBesideTheBadge) {
    FrontStatus front;
    EXPECT_EQ(front_text(front), "");
    front.working = true;
    EXPECT_EQ(front_text(front), "Comparing the front");
    front.working = false;
    front.changed_by = "gain, saturation";
    EXPECT_EQ(front_text(front), "Front changed by look: gain, saturation");
    front.changed_by.clear();
    front.measured = true;
    front.psnr_db = 39.62;
    front.ssim = 0.9756;
    front.light = 0.9969;
    EXPECT_EQ(front_text(front), "Differs from the picture");
    front.matches = true;
    EXPECT_EQ(front_text(front), "Matches the picture");
    EXPECT_EQ(front_figures(front), "Front 39.6 dB, SSIM 0.976, light -0.3 %");
    front.light = 0.99996;
    EXPECT_EQ(front_figures(front), "Front 39.6 dB, SSIM 0.976, light +0.0 %");
    front.light = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(front_text(front), "The picture has no light to compare with");
    EXPECT_EQ(front_figures(front), "Front 39.6 dB, SSIM 0.976, no light to compare with");
    front = {};
    front.error = "no picture";
    EXPECT_EQ(front_text(front), "Front cannot be compared: no picture");
}

/// The card of a picture taken for a galaxy, perhaps a nebula.
PictureStart galaxy_start() {
    PictureStart start{"m77.jpg"};
    start.guesses = {{SkyObject::galaxy, 0.72}, {SkyObject::nebula, 0.2}};
    start.seen = "seen at 40 degrees";
    start.because = "AVM says C.5.1.1: spiral galaxy";
    return start;
}

TEST_F(ViewportTest, APicturesSceneIsMadeAgainAsWhatElseItMayBe) {
    window.frame();
    EXPECT_FALSE(window.has("start/Nebula"));
    window.view.start = galaxy_start();
    window.frame(2);
    EXPECT_LT(window.at("start/Galaxy").x, window.at("start/Nebula").x) << "the likeliest";
    EXPECT_LT(window.at("start/Nebula").x, window.at("start/Elliptical galaxy").x) << "likelier";
    const auto choice_of = [&](const char* button) {
        window.click(button);
        return window.take_only(Command::Kind::start_again).text;
    };
    window.take_commands();
    EXPECT_EQ(choice_of("start/Nebula"), "nebula");
    EXPECT_EQ(choice_of("start/Make a film"), "film");
    EXPECT_EQ(choice_of("start/Part"), "part");
    window.click("start/Keep");
    window.click("start/Galaxy");
    EXPECT_TRUE(window.take_commands().empty()) << "as it is";
    window.keep_screen("start");
    const float before = window.at("start/Nebula").x;
    window.hover(window.at("start/Nebula"));
    window.wheel(-2.0f);
    window.frame(2);
    EXPECT_LT(window.at("start/Nebula").x, before) << "the wheel scrolls the row";
}

TEST_F(ViewportTest, APictureThatIsLookedAtIsSaidAndCancelledAtOnePlace) {
    window.status.starting = {"m77.jpg", "", 0.4f};
    window.frame(2);
    EXPECT_EQ(badge_text(window.document.scene(), window.status).text, "Looking at m77.jpg 40 %");
    window.keep_screen("starting");
    window.take_commands();
    window.click("badge/Cancel");
    window.take_only(Command::Kind::cancel_start);
    window.tap(key_code::escape);
    window.take_only(Command::Kind::cancel_start);
    window.view.start = galaxy_start();
    window.status.starting = {"m77.jpg", "nebula", 0.4f};
    window.frame(2);
    EXPECT_EQ(badge_text(window.document.scene(), window.status).text, "Taken for a nebula: it is made 40 %");
    window.click("start/Elliptical galaxy");
    EXPECT_EQ(window.take_only(Command::Kind::start_again).text, "elliptical") << "in its place";
}

/// At the least size and at twice the scale the frame is still seen beside it.
TEST(StartCard, LeavesTheFrameInSight) {
    for (const auto& [width, height, scale] :
         {std::tuple(1280, 800, 1.0f), {900, 600, 1.0f}, {1280, 800, 2.0f}, {1920, 1080, 1.5f}}) {
        TestWindow window(example_document(), width, height, scale);
        const auto grey = [&](const Picture8& picture) {
            const Rect view = make_layout(window.view, float(width), float(height), scale).viewport;
            int found = 0, all = 0;
            for (int y = int(view.y); y < int(view.y + view.height); ++y)
                for (int x = int(view.x); x < int(view.x + view.width); ++x) {
                    const Rgba8 p = picture.at(x, y);
                    found += p.r + p.g + p.b > 0 ? 1 : 0;
                    ++all;
                }
            return double(found) / all;
        };
        window.frame(2);
        const double before = grey(window.picture());
        window.view.start = galaxy_start();
        window.status.layers[0].making = {300.0, 10LL << 30, 60'000'000, 60'000'000};
        window.frame(4);
        EXPECT_LT(grey(window.picture()) - before, 0.62) << width << " at " << scale;
        EXPECT_TRUE(window.has("start/close"));
        const Rect view = make_layout(window.view, float(width), float(height), scale).viewport;
        EXPECT_LT(window.at("start/close").x, view.end().x);
        window.keep_screen(fmt::format("start {} at {}", width, scale));
    }
}

TEST_F(ViewportTest, ALargePictureSaysWhatItTakesAndMayBeHalved) {
    window.view.start = galaxy_start();
    ASSERT_FALSE(window.status.layers.empty());
    window.frame(2);
    EXPECT_FALSE(window.has("start/Half size")) << "nothing is made";
    Making& making = window.status.layers[0].making;
    making = {20.0, 1LL << 30, 7'000'000, 7'000'000};
    window.frame(2);
    EXPECT_FALSE(window.has("start/Half size")) << "it is not large";
    making = {300.0, 10LL << 30, 60'000'000, 60'000'000};
    window.frame(2);
    window.take_commands();
    window.click("start/Half size");
    EXPECT_EQ(window.take_only(Command::Kind::start_again).text, "splats 15000000");
    window.view.start->most_splats = 15'000'000;
    making = {75.0, 10LL << 28, 15'000'000, 60'000'000};
    window.frame(2);
    window.keep_screen("start half");
    window.click("start/Whole");
    EXPECT_EQ(window.take_only(Command::Kind::start_again).text, "whole");
    window.click("start/Half size");
    EXPECT_TRUE(window.take_commands().empty()) << "as it is";
}

TEST_F(ViewportTest, TheStartOfAPictureClosesByItsCrossAndWithTheFirstEdit) {
    window.view.start = galaxy_start();
    window.frame(2);
    window.click("start/close");
    EXPECT_FALSE(window.view.start);
    window.view.start = galaxy_start();
    window.frame(2);
    EXPECT_TRUE(window.view.start);
    make_edited(window);
    window.frame(2);
    EXPECT_FALSE(window.view.start);
    EXPECT_FALSE(window.has("start/Nebula"));
}

TEST_F(ViewportTest, DShowsWhereTheFrontDiffersIfThereIsAPicture) {
    window.frame();
    window.tap('D');
    EXPECT_EQ(window.view.compare, CompareMode::a);
    window.status.front.emplace();
    window.frame();
    window.tap('D');
    EXPECT_EQ(window.view.compare, CompareMode::front);
    window.tap('D');
    EXPECT_EQ(window.view.compare, CompareMode::a);
}

TEST_F(ViewportTest, TheBadgesButtons) {
    window.status.view_frame.state = ViewFrameState::failed;
    window.status.view_frame.error = "no such picture";
    window.frame(2);
    window.click("badge/Copy");
    EXPECT_EQ(window.take_only(Kind::copy_text).text, "no such picture");
    window.status.layers[1].loading = true;
    window.frame(2);
    window.click("badge/Cancel");
    EXPECT_EQ(window.take_only(Kind::cancel_load).index, 1U);
}

TEST_F(ViewportTest, TheBadgeStaysInThePictureHoweverLongANameIs) {
    window.document.edit("Rename", [](Scene& scene) { scene.layers[1].name = std::string(300, 'x'); });
    window.status.layers[1].loading = true;
    window.frame(2);
    const Rect picture = make_layout(window.view, 1600.0f, 900.0f, 1.0f).viewport;
    EXPECT_LT(window.at("badge/Cancel").x, picture.x + picture.width - 25.0f);
    EXPECT_GT(window.at("badge/Cancel").x, picture.x + picture.width - 80.0f);
}

TEST(Fitting, ATextThatJustFitsIsNotCut) {
    const TestWindow window(example_document());
    ImGui::NewFrame();
    const std::string text = "abcdefgh";
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    EXPECT_EQ(fitting(text, width), text);
    EXPECT_NE(fitting(text, width - 1.0f), text);
    EXPECT_LE(ImGui::CalcTextSize(fitting(text, width - 1.0f).c_str()).x, width - 1.0f);
    ImGui::Render();
}

TEST(MessageBar, AnErrorStaysUntilItIsClicked) {
    TestWindow window(example_document());
    const Rect bar = make_layout(window.view, 1600.0f, 900.0f, 1.0f).status;
    const auto seen = [&] {
        window.hover({-100.0f, -100.0f});
        return cropped(window.picture(Style::schematic), {0, int(bar.y), 800, int(bar.height)}).pixels;
    };
    window.status.message = {};
    const auto empty = seen();
    window.status.message = {"a.toml:14: expected a file", true};
    const auto error = seen();
    EXPECT_FALSE(error == empty);
    window.status.message = {};
    EXPECT_TRUE(seen() == error);
    window.click("message");
    EXPECT_TRUE(seen() == empty);
}

/// Of the status bar, without what lies at its right.
TEST_F(ViewportTest, AnErrorBelongsToItsSceneAndItsCauseAndHidesNothing) {
    const Rect bar = make_layout(window.view, 1600.0f, 900.0f, 1.0f).status;
    std::uint64_t number = 0;
    const auto say = [&](const char* text, bool error) {
        window.status.message = {text, error, ++number};
        window.frame();
    };
    const auto is_red = [&] {
        window.hover({-100.0f, -100.0f});
        const Picture8 picture = window.picture();
        for (int y = int(bar.y); y < int(bar.end().y); ++y)
            for (int x = 30; x < 500; ++x)  // right of the sign
                if (picture.at(x, y).r > 150 && picture.at(x, y).g < 120) return true;
        return false;
    };
    say("dust.png: expected a picture", true);
    EXPECT_TRUE(is_red());
    say("Undone: Opacity of dust", false);
    EXPECT_FALSE(is_red()) << "what undo says is seen";
    window.status.message.text.clear();
    EXPECT_TRUE(is_red()) << "nobody has read it";
    ++window.status.scenes;
    EXPECT_FALSE(is_red()) << "it was another scene's";
    window.status.standing_errors = {"stars.fits: no such file"};
    say("stars.fits: no such file", true);
    EXPECT_TRUE(is_red());
    say("no keyframe without a camera", true);
    EXPECT_TRUE(is_red()) << "another one after it";
    say("stars.fits: no such file", true);
    window.frame();
    window.status.standing_errors.clear();
    EXPECT_FALSE(is_red()) << "its cause is gone";
}

TEST_F(ViewportTest, ARefusedValueIsExplainedUntilSomethingElseChanges) {
    const auto refuse = [&] {
        window.frame(30);  // its clicks are no part of the last double click
        for (const DrawnRow& row : window.gui.panel().rows())
            if (row.key == "layer.dust.look.alpha.gain") window.double_click(row.value);
        window.type("much");
        window.tap(key_code::enter);
        EXPECT_NE(window.gui.panel().message(), "");
    };
    refuse();
    make_edited(window);
    window.frame();
    EXPECT_EQ(window.gui.panel().message(), "");
    refuse();
    window.document = example_document();
    window.frame();
    EXPECT_EQ(window.gui.panel().message(), "");
}

TEST_F(ViewportTest, CountsHaveThreeDigitsAtMost) {
    EXPECT_EQ(short_count(999), "999");
    EXPECT_EQ(splat_count(0), "0 splats");
    EXPECT_EQ(splat_count(1), "1 splat");
    EXPECT_EQ(splat_count(1000), "1.0 k splats");
    EXPECT_EQ(short_count(1000), "1.0 k");
    EXPECT_EQ(short_count(9949), "9.9 k");
    EXPECT_EQ(short_count(240000), "240 k");
    EXPECT_EQ(short_count(999499), "999 k");
    EXPECT_EQ(short_count(999600), "1.0 M");
    EXPECT_EQ(short_count(12400000), "12.4 M");
    EXPECT_EQ(short_count(2500000000), "2.5 G");
}

}  // namespace
}  // namespace astrosplat

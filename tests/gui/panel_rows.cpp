// Rows of the side panel, driven by mouse and keyboard, and their values in words.
#include "edit/edits.h"
#include "gui/panel/parts.h"
#include "gui/panel_driver.h"
#include "support/test.h"

namespace astrosplat::panel {
namespace {

// Rows of the side panel, driven by mouse and keyboard: what is dragged, typed, animated and reset arrives in
// the document, as one undo step each.

const std::string power = "layer.dust.look.alpha.power", opacity = "layer.dust.render.opacity",
                  gain = "layer.dust.look.grade.gain", density = "layer.dust.look.density";

class PanelRowsTest : public testing::Test {
  protected:
    PanelDriver d{dust_scene()};
};

TEST_F(PanelRowsTest, DraggingAValueIsOneUndoStep) {
    d.show(PanelTab::mixing);
    const double before = d.value(opacity).number();
    d.drag(d.row(opacity).value, {-50.0f, 0.0f});
    EXPECT_DOUBLE_EQ(before, 1.0);
    EXPECT_DOUBLE_EQ(d.value(opacity).number(), 0.8);  // 250 px are the whole range
    d.document.undo();
    EXPECT_DOUBLE_EQ(d.value(opacity).number(), 1.0);
    EXPECT_FALSE(d.document.can_undo());
}

TEST_F(PanelRowsTest, AFocalLengthTakesThePlaceOfTheAngle) {
    PanelDriver angle(dust_scene());
    angle.show(PanelTab::camera);
    EXPECT_TRUE(angle.has_row("camera.fov"));
    EXPECT_FALSE(angle.has_row("camera.film_width"));
    PanelDriver length(dust_scene("[camera]\nfocal_length = 50.0\n"));
    length.show(PanelTab::camera);
    EXPECT_FALSE(length.has_row("camera.fov"));
    EXPECT_TRUE(length.has_row("camera.film_width"));
}

TEST_F(PanelRowsTest, EverySourceHasItsOwnFiles) {
    const std::string splats =
        "astrosplat = 1\n[[layer]]\nname = \"dust\"\n[layer.source]\nkind = \"splats\"\n"
        "file = \"a.pda\"\n";
    PanelDriver mesh(dust_scene()), file(splats);
    mesh.show(PanelTab::source);
    file.show(PanelTab::source);
    EXPECT_TRUE(mesh.has_row("layer.dust.source.uv"));
    EXPECT_FALSE(mesh.has_row("layer.dust.source.file"));
    EXPECT_FALSE(file.has_row("layer.dust.source.uv"));
    EXPECT_TRUE(file.has_row("layer.dust.source.file"));
}

TEST(PanelRowsOfAnother, TheFirstThicknessStopChangesNothing) {
    PanelDriver d(dust_scene("[layer.look]\npdf = { shape = \"gaussian\" }\n"));
    d.show(PanelTab::look);
    const auto stops = [&] { return d.document.scene().layers[0].look.thickness.stops; };
    d.click(d.row("layer.dust.look.thickness.map").label + glm::vec2(-20.0f, 26.0f));  // the line below
    ASSERT_EQ(stops().size(), 1u);
    EXPECT_EQ(stops()[0].pdf, d.document.scene().layers[0].look.pdf);
    d.document.undo();
    EXPECT_TRUE(stops().empty());
}

TEST_F(PanelRowsTest, ANewCropIsABoxAroundTheLayerWithHandles) {
    d.status.layers.resize(1);
    d.status.layers[0].box = {{-5.0, -1.0, -5.0}, {15.0, 1.0, 5.0}};
    d.document.edit("Crop", [](Scene& scene) { scene.layers[0].look.crop.resize(1); });
    d.show(PanelTab::look);
    d.click(d.row("layer.dust.look.crop.0.soft").label + glm::vec2(-20.0f, 26.0f));  // the line below
    const std::vector<Crop>& crops = d.document.scene().layers[0].look.crop;
    ASSERT_EQ(crops.size(), 2u);
    EXPECT_EQ(crops[1].center, glm::vec3(5.0f, 0.0f, 0.0f));
    EXPECT_EQ(crops[1].size, glm::vec3(22.0f, 2.2f, 11.0f)) << "a tenth larger than the layer";
    EXPECT_EQ(d.view.handle_target, HandleTarget::crop);
    EXPECT_EQ(d.view.handle_crop, 1u);
    EXPECT_NE(d.view.tool, HandleTool::none);
}

TEST_F(PanelRowsTest, AMeshIsAShapeOrAFile) {
    d.show(PanelTab::source);
    const std::string mesh = "layer.dust.source.meshes.0.mesh";
    const auto browse = [&] { d.click({310.0f, d.row(mesh).value.y}); };  // the folder at the row's end
    browse();
    d.choose("Sphere");
    EXPECT_EQ(d.value(mesh), Value("sphere"));
    browse();
    d.choose("File...");
    const std::optional<ParameterKey> request = d.panel.take_request();
    ASSERT_TRUE(request);
    EXPECT_EQ(request->text(), mesh);
}

TEST_F(PanelRowsTest, TwoDragsAreTwoUndoSteps) {
    d.show(PanelTab::mixing);
    d.drag(d.row(opacity).value, {-25.0f, 0.0f});
    d.drag(d.row(opacity).value, {-25.0f, 0.0f});
    EXPECT_DOUBLE_EQ(d.value(opacity).number(), 0.8);
    d.document.undo();
    EXPECT_DOUBLE_EQ(d.value(opacity).number(), 0.9);
    EXPECT_TRUE(d.document.can_undo());
}

TEST_F(PanelRowsTest, DraggingStopsAtTheRange) {
    d.show(PanelTab::mixing);
    d.drag(d.row(opacity).value, {340.0f, 0.0f});
    EXPECT_DOUBLE_EQ(d.value(opacity).number(), 1.0);
    d.drag(d.row(opacity).value, {-200.0f, 0.0f});
    d.drag(d.row(opacity).value, {-200.0f, 0.0f});
    EXPECT_DOUBLE_EQ(d.value(opacity).number(), 0.0);
}

TEST_F(PanelRowsTest, AltDragsFinerAndShiftCoarser) {
    d.show(PanelTab::mixing);
    ImGui::GetIO().KeyAlt = true;
    d.drag(d.row(opacity).value, {-50.0f, 0.0f});
    ImGui::GetIO().KeyAlt = false;
    EXPECT_DOUBLE_EQ(d.value(opacity).number(), 0.98);
    ImGui::GetIO().KeyShift = true;
    d.drag(d.row(opacity).value, {-10.0f, 0.0f});
    ImGui::GetIO().KeyShift = false;
    EXPECT_NEAR(d.value(opacity).number(), 0.58, 1e-9);
}

TEST_F(PanelRowsTest, ADoubleClickTypesAValue) {
    d.show(PanelTab::look);
    d.double_click(d.row(density).value);
    d.type("0.25");
    EXPECT_DOUBLE_EQ(d.value(density).number(), 1.0);  // not before Enter
    d.tap(ImGuiKey_Enter);
    EXPECT_DOUBLE_EQ(d.value(density).number(), 0.25);
    d.document.undo();
    EXPECT_FALSE(d.document.can_undo());
}

TEST_F(PanelRowsTest, EscapeClosesTheMenuOfARow) {
    d.show(PanelTab::look);
    d.click(d.row(power).label, 1);
    d.frames(2);
    const auto is_open = [] { return ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup); };
    EXPECT_TRUE(is_open());
    d.tap(ImGuiKey_Escape);
    EXPECT_FALSE(is_open());
}

TEST_F(PanelRowsTest, EscapeDropsWhatWasTyped) {
    d.show(PanelTab::look);
    d.double_click(d.row(density).value);
    d.type("0.25");
    d.tap(ImGuiKey_Escape);
    EXPECT_DOUBLE_EQ(d.value(density).number(), 1.0);
    EXPECT_FALSE(d.document.can_undo());
    EXPECT_FALSE(d.panel.busy());
}

TEST_F(PanelRowsTest, TabTypesTheNextValue) {
    d.show(PanelTab::look);
    d.double_click(d.row("layer.dust.look.radius.min").value);
    d.type("0.1");
    d.tap(ImGuiKey_Tab);
    d.type("0.2");
    d.tap(ImGuiKey_Enter);
    EXPECT_EQ(d.panel.message(), "");
    EXPECT_DOUBLE_EQ(d.value("layer.dust.look.radius.min").number(), 0.1);
    EXPECT_DOUBLE_EQ(d.value("layer.dust.look.radius.max").number(), 0.2);
}

TEST_F(PanelRowsTest, ARefusedValueIsSaidAndChangesNothing) {
    d.show(PanelTab::mixing);
    d.enter(opacity, "2");
    EXPECT_DOUBLE_EQ(d.value(opacity).number(), 1.0);
    EXPECT_FALSE(d.document.can_undo());
    EXPECT_HAS(d.panel.message(), "from 0 to 1");
    d.drag(d.row(opacity).value, {-50.0f, 0.0f});
    EXPECT_EQ(d.panel.message(), "");
}

TEST_F(PanelRowsTest, TheDiamondSetsAndRemovesAKeyframe) {
    d.show(PanelTab::mixing);
    d.view.frame = 12.0;
    d.frames();
    d.click(d.row(opacity).diamond);
    EXPECT_TRUE(has_keyframe_at(d.document.scene(), opacity, 12.0));
    d.view.frame = 24.0;
    d.drag(d.row(opacity).value, {-50.0f, 0.0f});
    EXPECT_TRUE(has_keyframe_at(d.document.scene(), opacity, 24.0));
    EXPECT_EQ(find_track(d.document.scene(), opacity)->keyframes.size(), 2u);
    d.click(d.row(opacity).diamond);
    EXPECT_FALSE(has_keyframe_at(d.document.scene(), opacity, 24.0));
    EXPECT_TRUE(is_animated(d.document.scene(), opacity));
}

TEST(PanelRowsOfAnother, AKeyedValueIsShownAsItIsAtTheFrame) {
    PanelDriver d(
        dust_scene("[animation]\n\"layer.dust.render.opacity\" = { keys = [[1, 0.0], [101, 1.0]] }\n"));
    d.show(PanelTab::mixing);
    d.view.frame = 51.0;
    d.frames();
    d.drag(d.row(opacity).value, {25.0f, 0.0f});
    ASSERT_TRUE(has_keyframe_at(d.document.scene(), opacity, 51.0));
    EXPECT_DOUBLE_EQ(find_track(d.document.scene(), opacity)->keyframes[1].value[0], 0.6);
}

void choose(PanelDriver& d, const std::string& key, const std::string& item) {
    d.click(d.row(key).label, 1);
    d.choose(item);
}

TEST(PanelRowsOfAnother, RightClickResets) {
    PanelDriver d(dust_scene("[layer.look]\ngrade = { gain = 3.0 }\n"));
    d.show(PanelTab::look);
    ASSERT_DOUBLE_EQ(d.value(gain).number(), 3.0);
    choose(d, gain, "Reset");
    EXPECT_DOUBLE_EQ(d.value(gain).number(), 1.0);
    d.document.undo();
    EXPECT_DOUBLE_EQ(d.value(gain).number(), 3.0);
}

TEST(PanelRowsOfAnother, TheMenuCopiesKeyAndSetOption) {
    PanelDriver d(dust_scene("[layer.look]\nalpha = { power = 6.0 }\n"));
    d.show(PanelTab::look);
    choose(d, power, "Copy key path");
    EXPECT_EQ(d.clipboard, power);
    choose(d, power, "Copy --set");
    EXPECT_EQ(d.clipboard, "--set " + power + "=6.0");
}

TEST_F(PanelRowsTest, TheMenuPastesASetOption) {
    d.show(PanelTab::look);
    d.clipboard = "--set layer.other.look.alpha.power=2.5";
    choose(d, power, "Paste");
    EXPECT_DOUBLE_EQ(d.value(power).number(), 2.5);
    d.clipboard = "much";
    choose(d, power, "Paste");
    EXPECT_DOUBLE_EQ(d.value(power).number(), 2.5);
    EXPECT_NE(d.panel.message(), "");
}

TEST_F(PanelRowsTest, WhatIsCopiedIsPasted) {
    d.show(PanelTab::output);
    const std::string title = "provenance.title";
    for (const std::string wanted : {"E = m c2", "\"quoted\" it's", "path=frames/a.exr"})
        for (const std::string copy : {"Copy value", "Copy --set"}) {
            d.document.set(title, wanted, 1.0);
            d.frames(2);
            choose(d, title, copy);
            d.document.set(title, "", 1.0);
            d.frames(2);
            choose(d, title, "Paste");
            EXPECT_EQ(d.value(title), Value(wanted)) << copy;
        }
    d.clipboard = "a = b";  // from elsewhere
    choose(d, title, "Paste");
    EXPECT_EQ(d.value(title), Value("a = b"));
}

TEST_F(PanelRowsTest, ACheckBoxAndAVectorsComponent) {
    d.show(PanelTab::mixing);
    const std::string holdout = "layer.dust.render.holdout";
    d.click(d.row(holdout).value);
    EXPECT_EQ(d.value(holdout), Value(true));
    d.show(PanelTab::source);
    const std::string place = "layer.dust.transform.translate";
    d.enter(place, "-4");  // the middle one of three
    EXPECT_EQ(d.value(place), Value(Value::List{0.0, -4.0, 0.0}));
}

TEST_F(PanelRowsTest, AutoIsTypedOverAndTypedBack) {
    d.show(PanelTab::source);
    const std::string voxels = "layer.dust.source.voxels";
    d.enter(voxels, "10, 20, 30");
    const Value typed = Value::List{std::int64_t{10}, std::int64_t{20}, std::int64_t{30}};
    EXPECT_EQ(d.value(voxels), typed);
    d.document.undo();
    d.frames();
    d.enter(voxels, "10 20 30");
    EXPECT_EQ(d.value(voxels), typed);
}

constexpr const char *disk = "structure = { kind = \"disk\" }\n",
                     *height = "layer.dust.source.structure.height", *splats = "layer.dust.source.splats";

TEST_F(PanelRowsTest, AValueThatIsNotSetIsDraggedFromWhatItShows) {
    PanelDriver bodies(dust_scene(disk));
    bodies.status.layers.resize(1);
    bodies.status.layers[0].body_height = 0.1876543;
    bodies.status.layers[0].splats = 15'700'000;
    bodies.show(PanelTab::source);
    bodies.drag(bodies.row(height).value, {10.0f, 0.0f});
    EXPECT_NEAR(bodies.value(height).number(), 0.226, 0.003);
    bodies.drag(bodies.row(splats).value, {-10.0f, 0.0f});
    EXPECT_NEAR(bodies.value(splats).number(), 14.13e6, 0.1e6);
}

TEST_F(PanelRowsTest, AValueThatNobodyKnowsIsDraggedFromTheMiddle) {
    PanelDriver bodies(dust_scene(disk));
    bodies.show(PanelTab::source);
    const std::string inclination = "layer.dust.source.structure.inclination",
                      bulge = "layer.dust.source.structure.bulge", dust = "layer.dust.source.structure.dust";
    for (const auto& [key, value] : {std::pair(inclination, 45.0), {bulge, 0.5}, {dust, 0.8}}) {
        bodies.enter(key, "auto");
        bodies.drag(bodies.row(key).value, {4.0f, 0.0f});
        ASSERT_TRUE(bodies.value(key).is_number()) << key;
        EXPECT_NEAR(bodies.value(key).number(), value, 0.05 * value) << key;
    }
    d.show(PanelTab::camera);
    d.drag(d.row("camera.f_number").value, {4.0f, 0.0f});
    EXPECT_GT(d.value("camera.f_number").number(), 1.0)
        << "from the middle, not from 0: a blur of everything";
}

TEST_F(PanelRowsTest, AValueThatIsNotSetIsTypedFromWhatItShows) {
    PanelDriver bodies(dust_scene(disk));
    bodies.status.layers.resize(1);
    bodies.status.layers[0].body_height = 0.1876543;
    bodies.show(PanelTab::source);
    bodies.double_click(bodies.row(height).value);
    bodies.tap(ImGuiKey_End);
    bodies.type("5");
    bodies.tap(ImGuiKey_Enter);
    EXPECT_DOUBLE_EQ(bodies.value(height).number(), 0.187655);
    bodies.document.undo();
    bodies.frames();
    bodies.double_click(bodies.row(height).value);
    bodies.tap(ImGuiKey_Enter);
    EXPECT_DOUBLE_EQ(bodies.value(height).number(), 0.0) << "what was not changed stays automatic";
}

TEST_F(PanelRowsTest, WhatAPictureNeedsComesFirstAndItsMeshLast) {
    PanelDriver bodies(dust_scene(disk));
    const auto order = [](PanelDriver& driver, PanelTab tab, std::vector<std::string> keys) {
        driver.show(tab);
        for (std::size_t i = 1; i < keys.size(); ++i)
            EXPECT_LT(driver.row("layer.dust." + keys[i - 1]).label.y,
                      driver.row("layer.dust." + keys[i]).label.y)
                << keys[i];
    };
    order(bodies, PanelTab::source,
          {"source.structure.kind", "source.black", "source.splats", "source.derive", "name", "source.kind"});
    order(d, PanelTab::source,
          {"source.kind", "source.black", "source.structure.kind", "source.count", "name"});
    order(bodies, PanelTab::look, {"look.grade.gain", "look.alpha.power", "look.pdf.shape"});
    order(d, PanelTab::look,
          {"look.pdf.shape", "look.density", "look.vertical.shape", "look.alpha.power", "look.grade.gain"});
}

TEST_F(PanelRowsTest, BodiesHaveALimitButNoLattice) {
    PanelDriver bodies(dust_scene(disk));
    bodies.show(PanelTab::source);
    d.show(PanelTab::source);
    EXPECT_TRUE(bodies.has_row(splats));
    for (const char* key : {"count", "voxels", "jitter", "max_distance", "buffer"}) {
        EXPECT_FALSE(bodies.has_row(std::string("layer.dust.source.") + key)) << key;
        EXPECT_TRUE(d.has_row(std::string("layer.dust.source.") + key)) << key;
    }
}

// Numbers and values in words, as the side panel shows them; and how far a pixel of dragging goes.

TEST(PanelWords, FiguresAreThreeAtLeastAndFiveAtMost) {
    EXPECT_EQ(figures(0.35), "0.350");
    EXPECT_EQ(figures(1.0), "1.00");
    EXPECT_EQ(figures(45.0), "45.0");
    EXPECT_EQ(figures(12.345), "12.345");
    EXPECT_EQ(figures(2.487106), "2.4871");
    EXPECT_EQ(figures(0.008), "0.00800");
    EXPECT_EQ(figures(-812.0), "-812");
    EXPECT_EQ(figures(0.0), "0.00");
    EXPECT_EQ(figures(1e-9), short_number(1e-9));
}

TEST(PanelWords, ANarrowBoxShowsFewerFigures) {
    const auto within = [](std::size_t most) {
        return [most](const std::string& text) { return text.size() <= most; };
    };
    EXPECT_EQ(figures_that_fit(-12.3456, within(9)), "-12.346");
    EXPECT_EQ(figures_that_fit(-12.3456, within(6)), "-12.35");
    EXPECT_EQ(figures_that_fit(-12.3456, within(5)), "-12.3");
    EXPECT_EQ(figures_that_fit(0.008, within(5)), "0.008");
    EXPECT_EQ(figures_that_fit(1234.5, within(5)), "1234");
    EXPECT_EQ(figures_that_fit(-81234.0, within(3)),
              "-81 234");  // never other than what it is: the box ends it
}

TEST(PanelWords, LargeIntegersAreGrouped) {
    EXPECT_EQ(figures(std::int64_t{4096}), "4096");
    EXPECT_EQ(figures(std::int64_t{2000000}), "2 000 000");
    EXPECT_EQ(figures(std::int64_t{-65536}), "-65 536");
}

TEST(PanelWords, SharesArePercent) {
    EXPECT_EQ(percent(0.614), "61 %");
    EXPECT_EQ(percent(0.004), "0.4 %");
}

TEST(PanelWords, SetOptionsAreOneWordOfAShell) {
    EXPECT_EQ(set_option("layer.a.look.density", 0.5), "--set layer.a.look.density=0.5");
    EXPECT_EQ(set_option("camera.up", Value::List{0.0, 1.0, 0.0}), "--set 'camera.up=[0.0, 1.0, 0.0]'");
    EXPECT_EQ(set_option("provenance.title", "it's"), "--set 'provenance.title=\"it'\\''s\"'");
}

TEST(PanelWords, ADefaultOfZeroThatIsNoAmountSaysWhatItMeans) {
    ParameterSpec spec;
    spec.zero = "Auto";
    const auto has = [&](const Value& standard, const char* text) {
        return tooltip_text(spec, standard).find(text) != std::string::npos;
    };
    EXPECT_TRUE(has(0.0, "; default Auto (0.0)"));
    EXPECT_TRUE(has(0.5, "; default 0.5"));
    spec.zero = {};
    EXPECT_TRUE(has(0.0, "; default 0.0"));
}

TEST(PanelWords, DraggingRoundsToCleanNumbers) {
    ParameterSpec spec;
    spec.min = 0.0, spec.max = 1.0;
    const double step = drag_step(spec, 0.5);
    EXPECT_DOUBLE_EQ(step, 0.004);
    EXPECT_EQ(short_number(rounded_to_step(0.5 + 17 * step, step)), "0.568");
    ParameterSpec magnitude;
    magnitude.min = 1e-6, magnitude.slider_min = 0.01, magnitude.slider_max = 100.0;
    magnitude.scale = Scale::logarithmic;
    EXPECT_DOUBLE_EQ(drag_step(magnitude, 50.0), 0.5);  // of itself
    EXPECT_EQ(rounded_to_step(1234.5, 20.0), 1230.0);
    ParameterSpec open;  // on both sides of 0, and farther than the slider
    open.slider_min = -10.0, open.slider_max = 10.0;
    EXPECT_DOUBLE_EQ(drag_step(open, 0.0), 0.02);
    EXPECT_DOUBLE_EQ(drag_step(open, -2.0), 0.04);
    EXPECT_DOUBLE_EQ(drag_step(open, 1000.0), 0.08);
}

}  // namespace
}  // namespace astrosplat::panel

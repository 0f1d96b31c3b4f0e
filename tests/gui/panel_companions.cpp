// Edits that need another one to stand: what follows what, as one undo step.
#include <gtest/gtest.h>

#include "gui/panel/companions.h"
#include "gui/panel_driver.h"

namespace astrosplat {
namespace {

const char* const companions_scene = R"(astrosplat = 1
[[layer]]
name = "dust"
[layer.source]
meshes = [ { mesh = "plane", texture = "dust.png" } ]
[layer.look]
pdf = { shape = "linear" }
)";
const std::string look = "layer.dust.look.";

void type(PanelDriver& d, const std::string& key, const std::string& text) {
    d.double_click(d.row(key).value);
    d.type(text);
    d.tap(ImGuiKey_Enter);
}

TEST(PanelCompanions, SmallestAndLargestSizePushEachOther) {
    PanelDriver d(companions_scene);
    d.show(PanelTab::look);
    type(d, look + "radius.min", "0.2");
    EXPECT_DOUBLE_EQ(d.value(look + "radius.max").number(), 0.2);
    type(d, look + "radius.max", "0.1");
    EXPECT_DOUBLE_EQ(d.value(look + "radius.min").number(), 0.1);
    d.document.undo();
    EXPECT_DOUBLE_EQ(d.value(look + "radius.min").number(), 0.2);
    d.document.undo();
    EXPECT_FALSE(d.document.can_undo());
}

TEST(PanelCompanions, ACustomCurveBeginsAsTheShapeBefore) {
    Scene scene;
    scene.layers.resize(1);
    scene.layers[0].name = "a";
    scene.layers[0].look.pdf.shape = DensityCurve::Shape::linear;
    const auto others = panel::companions(scene, "layer.a.look.pdf.shape", "curve");
    ASSERT_EQ(others.size(), 1u);
    EXPECT_EQ(others[0].key, "layer.a.look.pdf.points");
    EXPECT_EQ(to_toml(others[0].value), "[[0.0, 1.0], [0.25, 0.75], [0.5, 0.5], [0.75, 0.25], [1.0, 0.0]]");
    scene.layers[0].look.pdf.points = {{0.0f, 1.0f}, {1.0f, 1.0f}};
    EXPECT_TRUE(panel::companions(scene, "layer.a.look.pdf.shape", "curve").empty());
}

TEST(PanelCompanions, ChoosingCurveInTheListWorks) {
    PanelDriver d(companions_scene);
    d.show(PanelTab::look);
    d.click(d.row(look + "pdf.shape").value);
    d.frames(2);
    d.choose("Curve");
    EXPECT_EQ(d.value(look + "pdf.shape"), Value("curve"));
    EXPECT_EQ(d.document.scene().layers[0].look.pdf.points.size(), 5u);
    d.document.undo();
    EXPECT_EQ(d.value(look + "pdf.shape"), Value("linear"));
    EXPECT_FALSE(d.document.can_undo());
}

TEST(PanelCompanions, AThicknessMapBringsItsFirstStops) {
    PanelDriver d(companions_scene);
    d.panel.answer(look + "thickness.map", "/nowhere/map.png", d.frame());
    const Thickness& thickness = d.document.scene().layers[0].look.thickness;
    EXPECT_EQ(thickness.map, "/nowhere/map.png");
    ASSERT_EQ(thickness.stops.size(), 3u);
    EXPECT_EQ(thickness.stops[2].pdf.shape, DensityCurve::Shape::linear);
    d.document.undo();
    EXPECT_FALSE(d.document.can_undo());
}

TEST(PanelCompanions, SplatsAskForTheirFileFirst) {
    PanelDriver d(companions_scene);
    d.show(PanelTab::source);
    d.click(d.row("layer.dust.source.kind").value);
    d.frames(2);
    d.choose("Splats");
    EXPECT_EQ(d.value("layer.dust.source.kind"), Value("mesh"));
    const std::optional<ParameterKey> request = d.panel.take_request();
    ASSERT_TRUE(request);
    EXPECT_EQ(request->text(), "layer.dust.source.file");
    d.panel.answer(*request, "/nowhere/set.ply", d.frame());
    EXPECT_EQ(d.value("layer.dust.source.kind"), Value("splats"));
    d.document.undo();
    EXPECT_EQ(d.value("layer.dust.source.kind"), Value("mesh"));
    EXPECT_FALSE(d.document.can_undo());
}

TEST(PanelCompanions, VoxelsReplaceTheVoxelSizeAndPicturesTheCube) {
    Scene scene;
    scene.layers.resize(1);
    scene.layers[0].name = "a";
    scene.layers[0].source.voxel_size = 0.1;
    scene.environment.cube = {"a", "b", "c", "d", "e", "f"};
    const Value voxels = Value::List{1.0, 1.0, 1.0};
    ASSERT_EQ(panel::companions(scene, "layer.a.source.voxels", voxels).size(), 1u);
    ASSERT_EQ(panel::companions(scene, "environment.image", "sky.exr").size(), 1u);
    EXPECT_EQ(panel::companions(scene, "environment.image", "sky.exr")[0].key, "environment.cube");
    EXPECT_TRUE(panel::companions(scene, "layer.a.look.density", 0.5).empty());
}

}  // namespace
}  // namespace astrosplat

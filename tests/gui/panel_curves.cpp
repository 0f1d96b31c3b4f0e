// Curves, levels and lists of the panel, and a way to every parameter.
#include "gui/panel_driver.h"
#include "scene/describe.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Curves, levels and lists of the Look and Source tabs, driven by the mouse.

const char* const curves_scene = R"(astrosplat = 1
[[layer]]
name = "dust"
[layer.source]
meshes = [ { mesh = "plane", texture = "a.fits" } ]
[layer.look.pdf]
shape = "curve"
points = [[0.0, 1.0], [1.0, 0.0]]
)";
const std::string points = "layer.dust.look.pdf.points";

using Points = std::vector<glm::vec2>;
const Points& curve(const PanelDriver& d) { return d.document.scene().layers[0].look.pdf.points; }

// The plot of 84 px stands above the row of its shape: captions of 17 px and the gaps of rows between.
glm::vec2 on_plot(const PanelDriver& d, float x, float y) {
    const DrawnRow shape = d.row("layer.dust.look.pdf.shape");
    const glm::vec4 plot = d.panel.plot_area(points);  // x, y, width, height
    EXPECT_LT(plot.y, shape.value.y);
    return {plot.x + x * plot.z, plot.y + plot.w - 2.0f - y * (plot.w - 5.0f)};
}

class PanelCurvesTest : public testing::Test {
  protected:
    PanelDriver d{curves_scene};
    PanelCurvesTest() { d.show(PanelTab::look); }
};

TEST_F(PanelCurvesTest, AClickAddsAPointOneUndoStep) {
    d.click(on_plot(d, 0.5f, 0.25f));
    ASSERT_EQ(curve(d).size(), 3u);
    EXPECT_NEAR(curve(d)[1].x, 0.5f, 0.01f);
    EXPECT_NEAR(curve(d)[1].y, 0.25f, 0.02f);
    d.document.undo();
    EXPECT_EQ(curve(d).size(), 2u);
    EXPECT_FALSE(d.document.can_undo());
}

TEST_F(PanelCurvesTest, ADragMovesAPointButNotPastItsNeighbours) {
    d.click(on_plot(d, 0.5f, 0.25f));
    const glm::vec2 from = on_plot(d, 0.5f, 0.25f);
    d.drag(from, on_plot(d, 0.75f, 0.5f) - from);
    ASSERT_EQ(curve(d).size(), 3u);
    EXPECT_NEAR(curve(d)[1].x, 0.75f, 0.01f);
    EXPECT_NEAR(curve(d)[1].y, 0.5f, 0.02f);
    const glm::vec2 again = on_plot(d, 0.75f, 0.5f);
    d.drag(again, {400.0f, 0.0f});
    EXPECT_LT(curve(d)[1].x, curve(d)[2].x);
    d.document.undo();
    EXPECT_NEAR(curve(d)[1].x, 0.75f, 0.01f);
}

TEST_F(PanelCurvesTest, ARightClickDeletesDownToTwoPoints) {
    d.click(on_plot(d, 0.5f, 0.25f));
    d.click(on_plot(d, 0.5f, 0.25f), 1);
    EXPECT_EQ(curve(d).size(), 2u);
    d.click(on_plot(d, 0.0f, 1.0f), 1);
    EXPECT_EQ(curve(d), (Points{{0.0f, 1.0f}, {1.0f, 0.0f}}));
}

TEST_F(PanelCurvesTest, ArrowsNudgeTheSelectedPoint) {
    d.click(on_plot(d, 0.5f, 0.25f));
    const glm::vec2 before = curve(d)[1];
    d.tap(ImGuiKey_RightArrow);
    d.tap(ImGuiKey_UpArrow);
    EXPECT_NEAR(curve(d)[1].x, before.x + 0.01f, 1e-5f);
    EXPECT_NEAR(curve(d)[1].y, before.y + 0.01f, 1e-5f);
}

TEST_F(PanelCurvesTest, AtMostSixteenPoints) {
    for (int i = 0; i < 20; ++i) d.click(on_plot(d, 0.04f + 0.045f * float(i), i % 2 ? 0.3f : 0.7f));
    EXPECT_EQ(curve(d).size(), 16u);
    EXPECT_EQ(d.panel.message(), "");
}

const std::string black = "layer.dust.source.black", white = "layer.dust.source.white";

void tell_values(PanelDriver& d, double lo, double hi) {
    auto histograms = std::make_shared<LayerHistograms>();
    histograms->values.share.assign(64, 0.5f);
    histograms->values.lo = lo;
    histograms->values.hi = hi;
    histograms->values.black = lo + 0.1 * (hi - lo);
    histograms->values.white = hi - 0.1 * (hi - lo);
    d.status.layers.resize(1);
    d.status.layers[0].histograms = histograms;
}

TEST(PanelCurvesOfAnother, RowsOfLevelsAreDraggedAsFastAsTheDataIsWide) {
    for (const double wide : {1e-3, 1e5}) {
        PanelDriver d(curves_scene);
        tell_values(d, 0.0, wide);
        d.document.set(black, 0.5 * wide, 1.0);
        d.show(PanelTab::source);
        d.drag(d.row(black).value, {-50.0f, 0.0f});
        EXPECT_NEAR(d.value(black).number() / wide, 0.3, 0.005) << "250 px are the whole range";
    }
}

TEST_F(PanelCurvesTest, BlackAndWhiteAreDraggedOverTheHistogram) {
    tell_values(d, 0.0, 1000.0);
    d.show(PanelTab::source);
    EXPECT_EQ(d.value(black), Value("auto"));
    const glm::vec4 plot = d.panel.plot_area(black);
    const float middle = plot.y + plot.w * 0.5f;
    d.drag({plot.x + 0.1f * plot.z, middle}, {0.1f * plot.z, 0.0f});
    ASSERT_TRUE(d.value(black).is_number());
    EXPECT_NEAR(d.value(black).number(), 200.0, 5.0);
    d.drag({plot.x + 0.9f * plot.z, middle}, {-0.9f * plot.z, 0.0f});
    EXPECT_GT(d.value(white).number(), d.value(black).number());  // never past each other
    d.document.undo();
    d.document.undo();
    EXPECT_EQ(d.value(black), Value("auto"));
    EXPECT_FALSE(d.document.can_undo());
}

// Every parameter of the description can be reached in some tab, and its words lead to the right one.

std::set<std::string> keys_drawn(const std::string& toml, const std::set<PanelTab>& tabs) {
    PanelDriver d(toml, 360.0f, 900.0f);
    d.status.reference = ReferenceStatus{0, 1.5, ""};
    Scene scene = d.document.scene();
    const Description description = describe(scene);
    std::set<std::string> keys;
    for (const PanelTab tab : tabs) {
        d.show(tab);
        for (const DrawnRow& row : d.panel.rows()) {
            const Parameter* parameter = find_parameter(description, row.key);
            if (parameter) keys.insert(parameter->spec.generic_key);
        }
    }
    return keys;
}

const std::set<PanelTab> all_tabs{PanelTab::source, PanelTab::look,        PanelTab::mixing,
                                  PanelTab::camera, PanelTab::environment, PanelTab::output};

std::string layer(const std::string& source, const std::string& look, const std::string& render,
                  const std::string& top = "") {
    return "astrosplat = 1\n" + top + "[[layer]]\nname = \"a\"\n[layer.source]\n" + source +
           "\n[layer.look]\n" + look + "\n[layer.render]\n" + render + "\n";
}

// Scenes that between them make every parameter matter.
std::vector<std::string> telling_scenes() {
    const std::string mesh = "meshes = [ { mesh = \"relief\", texture = \"a.fits\" } ]";
    return {
        layer(mesh,
              "pdf = { shape = \"exponential\" }\nvertical = { shape = \"exponential\" }\n"
              "noise = { cull = 0.5 }\n"
              "crop = [ {}, { shape = \"sphere\" }, { shape = \"outline\", outline = \"M 0 0 1 0 1 1\" } ]",
              "falloff = \"trapezoid\"\nblend = \"hybrid\""),
        layer(mesh,
              "pdf = { shape = \"gaussian\" }\nvertical = { shape = \"curve\", points = [[0, 1], [1, 0]] }\n"
              "thickness = { map = \"m.png\", keys = [ { color = [1, 0, 0], shape = \"curve\", points = [[0, "
              "1], [1, 0]] },"
              "{ shape = \"exponential\" }, { shape = \"gaussian\" } ] }",
              "",
              "[camera]\nprojection = \"orthographic\"\nposition = [0, 0, 9]\n[[reference]]\nfile = "
              "\"b.png\"\n"),
        layer(mesh + "\nstructure = { kind = \"walls\" }", "", "blend = \"absorb\""),
        layer(mesh + "\nstructure = { kind = \"axis\" }", "", ""),
        layer("meshes = [ { mesh = \"sheet\" }, { mesh = \"hourglass\" }, { mesh = \"shell\" }, { mesh = "
              "\"bubble\" },"
              "{ mesh = \"spheroid\", shells = 3 }, { mesh = \"ring\" },"
              "{ mesh = \"revolution\", outline = [[0, 0], [1, 1]] } ]\nuv = \"planar-xy\"\nuv_width = 5\n"
              "mask = [ { ellipse = [0.5, 0.5, 0.2, 0.2], any = [ { ellipse = [0.5, 0.5, 0.2, 0.2] } ] } ]",
              "", ""),
        layer(mesh + "\nprepare = { stars = \"remove\", lupton = true, ellipse = [9, 9, 5, 5] }", "", ""),
        layer(
            mesh + "\nuv = \"camera\"\nuv_camera = { position = [0, 9, 0] }\nstructure = { kind = \"disk\" }",
            "", ""),
        layer("kind = \"splats\"\nfile = \"a.ply\"",
              "pdf = { shape = \"gaussian\" }\nradius = { min = 0.1, max = 0.2 }", "",
              "[camera]\nprojection = \"fisheye\"\n"),
        layer("kind = \"stars\"\ncatalogue = \"c.csv\"\n"
              "wings = { share = 0.1 }\nspikes = { share = 0.1 }",
              "pdf = { shape = \"curve\", points = [[0, 1], [1, 0]] }", "",
              "[camera]\nfocal_length = 50.0\nf_number = 2.0\n"),
        layer("kind = \"stars\"\ncatalogue = \"stars.csv\"\nlike = \"b\"", "",
              "[[layer]]\nname = \"b\"\n[layer.source]\n" + mesh),
        layer("kind = \"stars\"\nalong = \"camera\"", "", "", "[camera]\nposition = [0, 0, 9]\n"),
        layer("kind = \"splats\"\nfile = \"a.ply\"", "", "isolate = true",
              "[output.ocio]\nconfig = \"c.ocio\"\n[camera]\nprojection = "
              "\"cylindrical\"\n[environment]\ntile = \"t.png\"\n")};
}

TEST(PanelCoverage, EveryParameterIsInSomeTab) {
    std::set<std::string> drawn;
    for (const std::string& scene : telling_scenes()) drawn.merge(keys_drawn(scene, all_tabs));
    const TempFolder folder;
    const std::string camera = folder.file("a.chan", "1 0 0 9 0 0 0\n").string();
    drawn.merge(keys_drawn(
        layer("kind = \"splats\"\nfile = \"a.ply\"", "", "", "[camera]\nfile = \"" + camera + "\"\n"),
        all_tabs));
    for (const ParameterRow& row : parameter_rows())
        EXPECT_TRUE(drawn.count(row.spec.generic_key)) << row.spec.generic_key << " is in no tab";
}

TEST(PanelCoverage, NoParameterIsDrawnTwiceInOneTab) {
    for (const std::string& scene : telling_scenes()) {
        PanelDriver d(scene);
        for (const PanelTab tab : all_tabs) {
            d.show(tab);
            std::set<std::string> keys;
            for (const DrawnRow& row : d.panel.rows()) EXPECT_TRUE(keys.insert(row.key).second) << row.key;
        }
    }
}

TEST(PanelCoverage, RowsKeepInsideThePanelFrom300To520Px) {
    for (const float width : {300.0f, 360.0f, 520.0f}) {
        PanelDriver d(telling_scenes()[0], width);
        for (const PanelTab tab : all_tabs) {
            d.show(tab);
            for (const DrawnRow& row : d.panel.rows()) {
                EXPECT_GT(row.label.x, 0.0f);
                EXPECT_LT(row.value.x, width - 20.0f);
                EXPECT_GT(row.value.x, row.label.x);
                EXPECT_LT(row.diamond.x, width - 10.0f);
            }
        }
    }
}

}  // namespace
}  // namespace astrosplat

// Every parameter of the description can be reached in some tab, and its words lead to the right one.
#include <gtest/gtest.h>

#include <set>

#include "gui/panel_driver.h"
#include "scene/describe.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

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
              "noise = { cull = 0.5 }\ncrop = [ {}, { shape = \"sphere\" } ]",
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

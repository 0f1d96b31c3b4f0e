// Sections of the panel: colours, prepare, edits that need others, folded heads.
#include "gui/panel/context.h"
#include "gui/panel/parts.h"
#include "gui/panel_driver.h"
#include "gui/reference_screens.h"
#include "support/test.h"

namespace astrosplat::panel {
namespace {

// The rows of colour management: a configuration is named, its displays and views are chosen, names of
// another one go.

const std::string colors_scene = dust_scene("[output]\nocio = { config = \"colors.ocio\" }\n");
const std::string ocio = "output.ocio.";

class PanelColors : public testing::Test {
  protected:
    PanelColors() {
        ColorStatus color;
        color.config = {"/nowhere/colors.ocio",
                        {{"Screen", {"Film", "Plain"}, "Film"}, {"Projector", {"Pure"}, "Pure"}},
                        "Screen"};
        color.display = "Screen";
        color.view = "Film";
        d.status.color = color;
        d.show(PanelTab::output);
    }
    void choose(const std::string& key, const std::string& item) {
        d.click(d.row(ocio + key).value);
        d.choose(item);
        d.frames(2);
    }
    std::string text(const std::string& key) { return *d.value(ocio + key).text(); }

    PanelDriver d{colors_scene};
};

TEST_F(PanelColors, DisplayAndViewAreChosenUndoneAndSaved) {
    choose("view", "Plain");
    EXPECT_EQ(text("view"), "Plain");
    choose("display", "Projector");
    EXPECT_EQ(text("display"), "Projector");
    EXPECT_EQ(text("view"), "") << "a view of the display before";
    choose("view", "Pure");
    const std::string saved = d.document.text_for("/nowhere/scene.toml");
    for (const char* line : {"colors.ocio", "\"Projector\"", "\"Pure\""}) EXPECT_HAS(saved, line);
    d.document.undo();
    d.document.undo();
    EXPECT_EQ(text("display"), "");
    EXPECT_EQ(text("view"), "Plain");
    d.document.undo();
    EXPECT_FALSE(d.document.can_undo());
    EXPECT_EQ(d.document.text_for("/nowhere/scene.toml"), colors_scene);
}

TEST_F(PanelColors, TheProgramsOwnViewHidesMeanwhile) {
    EXPECT_FALSE(d.has_row("output.view"));
    EXPECT_TRUE(d.has_row("output.exposure"));
    d.panel.answer(ocio + "config", "", d.frame());
    d.show(PanelTab::output);
    EXPECT_TRUE(d.has_row("output.view"));
    EXPECT_FALSE(d.has_row(ocio + "view"));
    EXPECT_TRUE(d.has_row(ocio + "display")) << "the environment names a configuration";
    d.status.color.reset();
    d.show(PanelTab::output);
    EXPECT_FALSE(d.has_row(ocio + "display"));
    EXPECT_TRUE(d.has_row(ocio + "config"));
}

TEST(PanelColorCompanions, NamesOfAnotherConfigurationGo) {
    Scene scene;
    scene.output.ocio = {"a.ocio", "Screen", "Film", "linear"};
    EXPECT_EQ(panel::companions(scene, ocio + "config", "b.ocio").size(), 3u);
    EXPECT_EQ(panel::companions(scene, ocio + "display", "Projector").size(), 1u);
    EXPECT_TRUE(panel::companions(scene, ocio + "view", "Plain").empty());
}

// The section Prepare: its rows, before and after with the line between them, and the command of its button.

class PanelPreparation : public testing::Test {
  protected:
    PanelPreparation() {
        driver.status.layers.resize(1);
        driver.status.preparation.emplace();
        driver.status.preparation->before = driver.status.preparation->after = &texture;
        driver.status.preparation->aspect = 1.5f;
        driver.status.preparation->stars = 213;
    }
    glm::vec4 area() const { return driver.panel.plot_area("layer.dust.source.prepare"); }

    Picture8 texture{30, 20};
    PanelDriver driver{dust_scene("prepare = { stars = \"remove\" }\n"), 360.0f, 2400.0f};
};

TEST_F(PanelPreparation, ShowsItsRowsAndAsksForAPreviewWhileItIsOpen) {
    driver.view.tab = PanelTab::source;
    driver.frames(2);
    EXPECT_FALSE(driver.view.preparation_open) << "it is folded at first";
    driver.show(PanelTab::source);
    EXPECT_TRUE(driver.view.preparation_open);
    for (const char* key : {"align", "starless", "fill", "stars", "threshold", "saturation", "background",
                            "lupton", "ellipse", "mask", "alpha"})
        EXPECT_TRUE(driver.has_row(std::string("layer.dust.source.prepare.") + key)) << key;
    EXPECT_FALSE(driver.has_row("layer.dust.source.prepare.q")) << "it does nothing without lupton";
    driver.show(PanelTab::look);
    driver.frames(2);
    EXPECT_FALSE(driver.view.preparation_open);
}

TEST_F(PanelPreparation, TheLineBetweenBeforeAndAfterIsDragged) {
    driver.show(PanelTab::source);
    const glm::vec4 before = area();
    ASSERT_GT(before.z, 300.0f);
    EXPECT_NEAR(before.w, before.z / 1.5f, 1.5f);
    const auto drawn = [&] {
        Picture8 picture(360, 2400);
        software_draw(*ImGui::GetDrawData(), picture, Style::schematic);
        return picture;
    };
    driver.move({before.x + before.z * 0.5f, before.y + 40.0f});
    driver.frames(3);
    const Picture8 half = drawn();
    driver.drag({before.x + before.z * 0.5f, before.y + 40.0f}, {before.z * 0.25f, 0.0f});
    driver.move({before.x + before.z * 0.5f, before.y + 40.0f});
    driver.frames(3);
    const Picture8 moved = drawn();
    const auto x = int(before.x + before.z * 0.75f), y = int(before.y + 60.0f);
    int differing = 0;
    for (int dx = -2; dx <= 2; ++dx) differing += half.at(x + dx, y) != moved.at(x + dx, y);
    EXPECT_GT(differing, 0) << "the line lies there now";
    EXPECT_EQ(driver.document.edited(), false);
}

TEST_F(PanelPreparation, ItsButtonAsksForTheFolder) {
    driver.show(PanelTab::source);
    const glm::vec4 picture = area();
    // Below the picture: captions, a line of text, the button.
    for (float y = picture.y + picture.w + 24.0f;
         y < picture.y + picture.w + 90.0f && driver.commands.empty(); y += 6.0f)
        driver.click({picture.x + picture.z * 0.5f, y});
    ASSERT_EQ(driver.commands.size(), 1u);
    EXPECT_EQ(driver.commands[0].kind, Command::Kind::prepare_picture);
    EXPECT_EQ(driver.commands[0].index, 0u);
}

TEST_F(PanelPreparation, LooksLikeItsReference) {
    driver.show(PanelTab::source);
    driver.frames(3);
    const glm::vec4 place = area();
    expect_like_reference("panel_preparation", Part{0, int(place.y) - 330, 360, int(place.w) + 420});
}

TEST(PanelPreparationOfSplats, IsNotThere) {
    PanelDriver driver(
        "astrosplat = 1\n[[layer]]\nname = \"a\"\n[layer.source]\nkind = \"splats\"\n"
        "file = \"a.ply\"\n");
    driver.status.layers.resize(1);
    driver.show(PanelTab::source);
    EXPECT_FALSE(driver.view.preparation_open);
}

// Edits that need another one to stand: what follows what, as one undo step.

const std::string companions_scene = dust_scene("[layer.look]\npdf = { shape = \"linear\" }\n");
const std::string look = "layer.dust.look.";

TEST(PanelCompanions, SmallestAndLargestSizePushEachOther) {
    PanelDriver d(companions_scene);
    d.show(PanelTab::look);
    d.enter(look + "radius.min", "0.2");
    EXPECT_DOUBLE_EQ(d.value(look + "radius.max").number(), 0.2);
    d.enter(look + "radius.max", "0.1");
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

// The words at the head of folded sections.

/// The window's status and the scene, for a panel on a layer with this look.
struct Shown {
    Document document;
    ViewState view;
    Status status;
    Commands commands;
    Memory memory;
    std::vector<DrawnItem> drawn;

    explicit Shown(const std::string& of_dust, const LayerStatus& layer = {})
        : document(Document::untitled(dust_scene(of_dust), "/nowhere/scene.toml")) {
        status.layers = {layer};
        describe_current(memory, document, 1.0);
    }
    Context context() { return {{document, view, status, commands, drawn}, memory}; }
};

/// Of the section of that title.
std::string state_of(const std::string& title, const std::string& of_dust) {
    return std::ranges::find(tab_sections(), title, &TabSection::title)->state(Shown(of_dust).context());
}

TEST(PanelStates, SayWhatALookDoes) {
    EXPECT_EQ(state_of("Noise", ""), "off");
    EXPECT_EQ(state_of("Noise", "[[layer.look.noise]]\njitter = 0.5\n[[layer.look.noise]]\n"), "2");
    EXPECT_EQ(state_of("Thickness map", ""), "off");
    EXPECT_EQ(state_of("Colour", ""), "off");
    EXPECT_EQ(state_of("Colour", "[layer.look.grade]\ngain = 2.0\n"), "changed");
    EXPECT_EQ(state_of("Opacity at soft edges", ""), "off");
    EXPECT_EQ(state_of("Opacity at soft edges", "[layer.look.alpha]\npower = 2.0\n"), "power 2");
}

/// The word in place of this key's 0.
std::string zero_of(const std::string& key, const LayerStatus& layer) {
    Shown shown("", layer);
    Context context = shown.context();
    return unset_in_words(context, find(context, key)->spec, Value(0.0));
}

TEST(PanelStates, ZerosThatAreNoAmountSayWhatIsUsed) {
    LayerStatus layer;
    EXPECT_EQ(zero_of("layer.dust.source.max_distance", layer), "Auto") << "as long as it is not known";
    layer.radius_min = 0.0165;
    layer.histograms = [] {
        auto histograms = std::make_shared<LayerHistograms>();
        histograms->max_distance = 0.25;
        return histograms;
    }();
    EXPECT_EQ(zero_of("layer.dust.source.max_distance", layer), "Auto (0.250)");
    EXPECT_EQ(zero_of("layer.dust.look.radius.min", layer), "Auto (0.0165)");
    EXPECT_EQ(zero_of("layer.dust.look.reach", layer), "Auto (0.250)");
    EXPECT_EQ(zero_of("layer.dust.source.uv_width", layer), "Auto");
    EXPECT_EQ(zero_of("layer.dust.source.structure.height", layer), "Auto");
    layer.uv_width = 12.0;
    layer.body_height = 0.198;
    EXPECT_EQ(zero_of("layer.dust.source.uv_width", layer), "Auto (12.0)");
    EXPECT_EQ(zero_of("layer.dust.source.structure.height", layer), "Auto (0.198)");
    layer.stale = true;  // the set is that of another distance
    EXPECT_EQ(zero_of("layer.dust.source.max_distance", layer), "Auto");
    EXPECT_EQ(zero_of("layer.dust.source.structure.height", layer), "Auto");
}

}  // namespace
}  // namespace astrosplat::panel

// Saving: what is loaded again is what was saved, and the text keeps everything that did not change.

#include "scene/save.h"
#include "scene/check.h"
#include "scene/new_scene.h"
#include "scene_texts.h"
#include "support/random_values.h"

namespace astrosplat::test {
namespace {

const char* const commented = R"(# My galaxy
astrosplat = 1   # the format

[output]
fps = 24.0  # cinema
resolution = [ 640, 360 ]

# The stars.
[[layer]]
name = "stars"
  [layer.source]
  meshes = [ { mesh = "plane", texture = "a.png" } ]  # flat
  [layer.look]
  alpha = { power = 1.0 }  # spelled out
  noise = { cull = 0.25, frequency = 2 }

# The dust.
[[layer]]
name = "dust"
source.meshes = [{ mesh = "disk", texture = "d.png" }, { mesh = "sphere" }]
look.noise = [{ cull = 0.5 }, { jitter = 0.1 }]

[animation]
"camera.fov" = { keys = [
  [1, 20],   # wide
  [9, 40],
] }
"camera.roll" = { keys = [[1, 0], [9, 10, "step"]], interpolation = "smooth" }  # tilt
)";

/// Saves and loads again: must be the same. Returns the text.
std::string saved(Scene scene, const std::string& original = commented,
                  const std::string& file = "scene.toml") {
    const std::string text = save_text(scene, original, file);
    scene.file = file;
    EXPECT_EQ(parse_scene(text, file), scene) << text;
    return text;
}

TEST(Save, NothingChangedIsTheSameText) { EXPECT_EQ(saved(parse(commented)), commented); }

TEST(Save, AValueIsChangedInPlace) {
    Scene scene = parse(commented);
    scene.output.fps = 25.0;
    scene.layers[0].look.alpha.power = 6.0f;
    scene.layers[1].look.noise[1].jitter = 0.2f;
    std::string expected = replaced(commented, "24.0  # cinema", "25.0  # cinema");
    expected = replaced(expected, "power = 1.0 }", "power = 6.0 }");
    EXPECT_EQ(saved(scene), replaced(expected, "jitter = 0.1", "jitter = 0.2"));
}

TEST(Save, BackToTheDefaultIsWritten) {
    Scene scene = parse(commented);
    scene.layers[0].look.noise[0].cull = 0.0f;
    EXPECT_EQ(saved(scene), replaced(commented, "cull = 0.25", "cull = 0.0"));
}

TEST(Save, BezierHandlesAreWrittenAndReadAgain) {
    Scene scene = parse(commented);
    using Numbers = std::vector<double>;
    constexpr Interpolation bezier = Interpolation::bezier;
    const Handle<Numbers> flat{HandleKind::flat, 0.0, {}};
    scene.animation[0].keyframes = {
        {1.0, {20.0}, bezier, {}, {HandleKind::free, 2.5, {-1.0}}},
        {5.0, {30.0}, bezier, flat, flat},
        {9.0, {40.0}, Interpolation::linear, {HandleKind::free, -2.0, {0.125}}, {}, true}};
    Track path{"camera.position", {}, bezier, Ends::through, false};
    path.keyframes = {{1.0, {0, 0, 9}, bezier, {}, {HandleKind::free, 10.0, {1.0, 0.0, -0.5}}},
                      {40.0, {3, 0, 9}, bezier}};
    scene.animation.push_back(path);
    const std::string text = saved(scene);
    EXPECT_HAS(text,
               "[1, 20.0, \"bezier\", { out = [2.5, -1.0] }], [5, 30.0, \"bezier\", \"flat\"], "
               "[9, 40.0, \"linear\", { in = [-2, 0.125], broken = true }]");
    EXPECT_HAS(text, "{ out = [10, [1.0, 0.0, -0.5]] }], [40, [3.0, 0.0, 9.0]]], interpolation = \"bezier\"");
}

TEST(Save, NewKeysGoToTheirTable) {
    Scene scene = parse(commented);
    scene.layers[0].look.alpha.threshold = 0.5f;
    scene.layers[0].look.density = 0.5f;
    scene.layers[0].render.blend = Blend::add;
    scene.layers[1].visible = false;
    scene.output.exposure = 1.0;
    scene.camera.fov = 30.0;
    std::string expected = replaced(commented, "{ power = 1.0 }", "{ power = 1.0, threshold = 0.5 }");
    expected = replaced(expected, "frequency = 2 }\n",
                        "frequency = 2 }\ndensity = 0.5\n\n[layer.render]\nblend = \"add\"\n");
    expected = replaced(expected, "{ jitter = 0.1 }]\n", "{ jitter = 0.1 }]\nvisible = false\n");
    expected = replaced(expected, "[ 640, 360 ]\n", "[ 640, 360 ]\nexposure = 1.0\n");
    EXPECT_EQ(saved(scene), expected + "\n[camera]\nfov = 30.0\n");
}

TEST(Save, LayersAreAddedRemovedMovedAndRenamed) {
    Scene scene = parse(commented);
    LayerParams third = scene.layers[1];
    third.name = "gas";
    third.look.density = 0.125f;
    scene.layers.push_back(third);
    const std::string three = saved(scene);
    EXPECT_HAS(three, "# The dust.");
    std::swap(scene.layers[0], scene.layers[1]);
    const std::string moved = saved(scene);
    EXPECT_LT(moved.find("# The dust."), moved.find("# The stars."));
    EXPECT_HAS(moved, "# spelled out");
    scene.layers.erase(scene.layers.begin() + 1);
    EXPECT_EQ(saved(scene).find("# The stars."), std::string::npos);
    scene = parse(commented);
    scene.layers[0].name = "suns";
    EXPECT_EQ(saved(scene), replaced(commented, "\"stars\"", "\"suns\""));
}

TEST(Save, TheLastLayerOfAFileIsRemoved) {
    const std::string first =
        "astrosplat = 1\n[[layer]]\nname = \"a\"\nsource.meshes = [{ mesh = \"sphere\" }]\n";
    const std::string both =
        first + "\n# The second.\n[[layer]]\nname = \"b\"\nsource.meshes = [{ mesh = \"disk\" }]\n";
    Scene scene = parse_scene(both, "scene.toml");
    scene.layers.pop_back();
    EXPECT_EQ(saved(scene, both), first + "\n");
}

TEST(Save, TracksAreChangedAddedAndRemoved) {
    Scene scene = parse(commented);
    scene.animation[1].keyframes[1].value = {20.0};
    EXPECT_EQ(saved(scene),
              replaced(commented, "[[1, 0], [9, 10, \"step\"]]", "[[1, 0.0], [9, 20.0, \"step\"]]"));
    scene = parse(commented);
    scene.animation.push_back({"layer.dust.render.blend",
                               {{1.0, {0.0}, Interpolation::linear}, {2.5, {3.0}, Interpolation::step}}});
    EXPECT_EQ(saved(scene),
              std::string(commented) +
                  "\"layer.dust.render.blend\" = { keys = [[1, \"over\"], [2.5, \"lighten\", \"step\"]] }\n");
    std::swap(scene.animation[0], scene.animation[2]);
    saved(scene);
    scene.animation.clear();
    EXPECT_EQ(saved(scene).find("camera."), std::string::npos);
}

TEST(Save, ListsGrowAndShrink) {
    Scene scene = parse(commented);
    scene.layers[0].look.noise.resize(2);
    scene.layers[0].look.noise[1].brightness = 0.5f;
    EXPECT_EQ(saved(scene), replaced(commented, "{ cull = 0.25, frequency = 2 }",
                                     "[{ frequency = 2.0, cull = 0.25 }, { brightness = 0.5 }]"));
    scene.layers[0].look.noise.clear();
    scene.layers[1].source.meshes.pop_back();
    std::string expected = replaced(commented, "{ cull = 0.25, frequency = 2 }", "[]");
    EXPECT_EQ(saved(scene),
              replaced(expected, "[{ mesh = \"disk\", texture = \"d.png\" }, { mesh = \"sphere\" }]",
                       "[{ mesh = \"disk\", texture = \"d.png\" }]"));
}

TEST(Save, ANewFile) {
    Scene scene = parse(commented);
    scene.file = "";
    const std::string text = saved(scene, "");
    EXPECT_EQ(text.find("astrosplat = 1\n"), 0u);
    EXPECT_EQ(text.find("compression"), std::string::npos) << "defaults are not written";
}

TEST(Save, AnotherFolderKeepsTheFiles) {
    Scene scene = parse_scene(commented, "scenes/a.toml");
    EXPECT_HAS(saved(scene, commented, "b.toml"), "texture = \"scenes/a.png\"");
    EXPECT_HAS(saved(scene, commented, "scenes/deep/b.toml"), "texture = \"../a.png\"");
}

TEST(Save, FilesNamedLikeBuiltInMeshes) {
    Scene scene = parse(replaced(commented, "mesh = \"sphere\"", "mesh = \"./sphere\""));
    EXPECT_EQ(scene.layers[1].source.meshes[1].mesh, "./sphere");
    scene.layers[0].source.meshes[0].mesh = "./disk";
    saved(scene);
    scene = parse_scene(commented, "/x/y.toml");
    scene.layers[0].source.meshes[0].mesh = "/x/disk";
    EXPECT_HAS(saved(scene, commented, "/x/y.toml"), "mesh = \"./disk\"");
}

TEST(Save, WindowsLineEndsStay) {
    std::string text = commented;
    for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2) text.replace(i, 1, "\r\n");
    Scene scene = parse(text);
    scene.camera.fov = 30.0;
    const std::string written = saved(scene, text);
    for (std::size_t i = 0; (i = written.find('\n', i)) != std::string::npos; ++i)
        EXPECT_EQ(written[i - 1], '\r');
}

/// Of all that the parameter allows up to 1000.
Value some_value(const ParameterSpec& spec, std::uint32_t seed) {
    Numbers numbers(seed);
    if (spec.nothing.text() && numbers.below(3) == 0) return spec.nothing;
    ParameterSpec wide = spec;
    wide.slider_min = -1000.0;
    wide.slider_max = 1000.0;
    return random_value(wide, numbers);
}

/// The scene with one parameter changed; presets and camera files must exist and names are keys,
/// so these stay.
Scene changed(const Scene& scene, std::size_t index, std::uint32_t seed) {
    Scene edited = scene;
    const Description description = describe(edited);
    const Parameter& parameter = description.parameters[index];
    const std::string key = parameter.spec.generic_key;
    if (key == "layer.name" || key == "layer.preset" || key == "output.preset" || key == "camera.file")
        return scene;
    parameter.set(key == "output.frames" ? Value("1-9") : some_value(parameter.spec, seed));
    return ERROR_OF(check_scene(edited, "", {})) == "no error" ? edited : scene;
}

TEST(Save, EveryParameterSurvives) {
    for (const std::string& original : {std::string(commented), full_scene()}) {
        Scene scene = parse(original);
        const std::size_t count = describe(scene).parameters.size();
        std::size_t edits = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const Scene edited = changed(scene, i, i + 1);
            if (edited == scene) continue;
            saved(edited, original);
            ++edits;
        }
        EXPECT_GT(edits, count * 8 / 10)
            << "the others need a second key to be valid, or drew their old value";
    }
}

TEST(Save, RandomEditsOneAfterAnother) {
    std::string text = commented;
    Scene scene = parse(text);
    Numbers numbers(77);
    for (std::uint32_t step = 1; step <= 200; ++step) {
        scene = changed(scene, numbers.below(describe(scene).parameters.size()), step);
        text = saved(scene, text);
    }
    for (const char* comment : {"# My galaxy", "# the format", "# cinema", "# The stars.", "# flat",
                                "# spelled out", "# The dust.", "# wide", "# tilt"})
        EXPECT_HAS(text, comment) << comment;
}

TEST(Save, ListsWithinLists) {
    Scene scene = parse(small_scene());
    std::string text = small_scene();
    std::vector<MaskParams>& masks = scene.layers[0].source.texture.mask;
    masks.resize(2);
    masks[0].hue = {330.0, 30.0};
    masks[1].any.resize(2);
    masks[1].any[0].ellipse = {0.5, 0.5, 0.25, 0.2};
    masks[1].any[1].invert = true;
    text = saved(scene, text);
    EXPECT_HAS(text,
               "mask = [{ hue = [330.0, 30.0] }, { any = [{ ellipse = [0.5, 0.5, 0.25, 0.2] }, { "
               "invert = true }] }]");
    masks[1].any.pop_back();
    masks[0].any.resize(1);
    masks[0].any[0].derive = Derived::dust;
    text = saved(scene, text);
    masks.erase(masks.begin());
    saved(scene, text);
}

TEST(Save, ReferencesAreAListATableOrHeaders) {
    Scene scene = parse(small_scene());
    scene.references.resize(2);
    scene.references[0].file = "m51.png";
    scene.references[1].view = ReferenceParams::View::top;
    std::string text = saved(scene, small_scene());
    EXPECT_HAS(text, "reference = [{ file = \"m51.png\" }, { view = \"top\" }]\n");
    scene.references[1].opacity = 0.5;
    text = saved(scene, text);
    EXPECT_HAS(text, "{ view = \"top\", opacity = 0.5 }");
    scene.references.clear();
    saved(scene, text);

    const std::string headers = small_scene() + "\n[[reference]]\nfile = \"a.png\"\n\n[[reference]]\n";
    Scene two = parse(headers);
    ASSERT_EQ(two.references.size(), 2u);
    two.references[0].scale = 2.0;
    two.references[1].rotate = 30.0;
    text = saved(two, headers);
    EXPECT_HAS(text, "[[reference]]\nfile = \"a.png\"\nscale = 2.0\n");
    EXPECT_HAS(text, "[[reference]]\nrotate = 30.0\n");

    const std::string table = small_scene() + "\n[reference]\nfile = \"a.png\"\n";
    Scene one = parse(table, {"reference.position=[0.25, 0]"});
    ASSERT_EQ(one.references.size(), 1u);
    EXPECT_HAS(saved(one, table), "[reference]\nfile = \"a.png\"\nposition = [0.25, 0.0]\n");
}

TEST(Save, PresetsGiveBackLookAndRender) {
    Scene scene = parse(commented);
    Look& look = scene.layers[1].look;
    look.thickness.map = "maps/m.png";
    look.thickness.stops.resize(2);
    look.thickness.stops[1].pdf.shape = DensityCurve::Shape::gaussian;
    scene.layers[1].render.falloff.core = 0.25f;
    const TempFolder folder;
    look.thickness.map = folder / "m.png";
    folder.file("p.toml", save_preset_text(look, scene.layers[1].render, folder / "p.toml"));
    const Scene loaded = parse_scene(small_scene("preset = \"p.toml\""), folder / "s.toml");
    EXPECT_EQ(loaded.layers[0].look, look);
    EXPECT_EQ(loaded.layers[0].render, scene.layers[1].render);
}

TEST(Save, OverAPresetOnlyDifferencesAreWritten) {
    const TempFolder folder;
    folder.file("p.toml", "[look]\ndensity = 0.5\nnoise = [{ cull = 0.5 }, { cull = 0.25 }]\n");
    const std::string original = small_scene("preset = \"p.toml\"");
    Scene scene = parse_scene(original, folder / "s.toml");
    EXPECT_EQ(save_text(scene, original, folder / "s.toml"), original);
    scene.layers[0].look.density = 1.0f;
    scene.layers[0].look.noise[1].cull = 0.125f;
    const std::string text = save_text(scene, original, folder / "s.toml");
    EXPECT_HAS(text, "density = 1.0") << "the default, against the preset";
    EXPECT_EQ(parse_scene(text, folder / "s.toml"), scene);
}

TEST(NewScene, LoadsForEveryShapeAndOddNames) {
    for (const char* shape : {"plane", "relief", "disk", "sphere"}) {
        const std::string text = new_scene_text("pictures/51 M\xC3\xB6we.fits", shape, "scenes/a.toml");
        const Scene scene = parse_scene(text, "scenes/a.toml");
        EXPECT_EQ(scene.layers[0].name, "M_we");
        EXPECT_EQ(scene.layers[0].source.meshes[0].mesh, shape);
        EXPECT_EQ(scene.layers[0].source.meshes[0].texture[0], "pictures/51 M\xC3\xB6we.fits");
        EXPECT_EQ(save_text(scene, text, "scenes/a.toml"), text);
    }
    EXPECT_EQ(parse(new_scene_text("51.png", "plane", "a.toml")).layers[0].name, "picture");
    EXPECT_THROW(new_scene_text("a.png", "cube", "a.toml"), InputError);
    const std::string scale = "\n[scene]\nlight_years_per_unit = 3.5\n";
    EXPECT_EQ(parse(new_scene_text("a.png", "plane", "a.toml", scale)).light_years_per_unit, 3.5);
}

// Of a picture that only this program's own reader opens.
TEST(NewScene, TellsTheScaleOfXisf) {
    const std::string header =
        "<xisf version=\"1.0\"><Image geometry=\"2:2:1\" sampleFormat=\"UInt8\" colorSpace=\"Gray\" "
        "location=\"inline:hex\">01020304</Image></xisf>";
    const TempFolder folder;
    EXPECT_EQ(scale_text_of(
                  folder.file("a.xisf", "XISF0100" + (char(header.size()) + std::string(7, '\0')) + header)),
              "");
}

}  // namespace
}  // namespace astrosplat::test

// The list of layers, and every parameter of the description, as they are edited.
#include "edit/layers.h"
#include "edit/document.h"
#include "edit/edits.h"
#include "edit/layer_steps.h"
#include "scenes.h"
#include "support/random_values.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// The list of layers: names, order, copies, and tracks that follow them.

struct Layers : testing::Test {
    Scene scene = parse_scene(test::edit_scene, "/scene.toml");

    std::vector<std::string> names() const { return layer_names(scene); }
    using Names = std::vector<std::string>;
};

TEST_F(Layers, FreeNames) {
    EXPECT_EQ(free_layer_name(scene, "gas"), "gas");
    EXPECT_EQ(free_layer_name(scene, "dust"), "dust_2");
    EXPECT_EQ(free_layer_name(scene, "M 51 (rot)"), "M_51_rot");
    EXPECT_EQ(free_layer_name(scene, "51"), "layer");
    EXPECT_EQ(free_layer_name(scene, "ä"), "layer");
    scene.layers[0].name = "dust_2";
    EXPECT_EQ(free_layer_name(scene, "dust_2"), "dust_2_2");
}

TEST_F(Layers, Duplicate) {
    EXPECT_EQ(duplicate_layer(scene, 1), 2u);
    EXPECT_EQ(names(), (Names{"dust", "stars", "stars_2"}));
    LayerParams copy = scene.layers[2];
    copy.name = "stars";
    EXPECT_EQ(copy, scene.layers[1]);
    const Track* track = find_track(scene, "layer.stars_2.render.core");
    ASSERT_TRUE(track);
    EXPECT_EQ(track->keyframes, find_track(scene, "layer.stars.render.core")->keyframes);
}

TEST_F(Layers, Remove) {
    remove_layer(scene, 1);
    EXPECT_EQ(names(), Names{"dust"});
    EXPECT_FALSE(is_animated(scene, "layer.stars.render.core"));
    EXPECT_TRUE(is_animated(scene, "layer.dust.look.noise.1.jitter"));
}

TEST_F(Layers, Move) {
    duplicate_layer(scene, 0);
    move_layer(scene, 0, 2);
    EXPECT_EQ(names(), (Names{"dust_2", "stars", "dust"}));
    move_layer(scene, 2, 0);
    EXPECT_EQ(names(), (Names{"dust", "dust_2", "stars"}));
    move_layer(scene, 0, 99);
    EXPECT_EQ(names(), (Names{"dust_2", "stars", "dust"}));
}

TEST_F(Layers, Rename) {
    rename_layer(scene, 1, "suns");
    EXPECT_EQ(names(), (Names{"dust", "suns"}));
    EXPECT_TRUE(is_animated(scene, "layer.suns.render.core"));
    EXPECT_FALSE(is_animated(scene, "layer.stars.render.core"));
    const Scene before = scene;
    EXPECT_EQ(ERROR_OF(rename_layer(scene, 1, "dust")),
              "suns: layer.name: expected each name once, found 'dust' twice");
    EXPECT_EQ(ERROR_OF(rename_layer(scene, 1, "2")),
              "suns: layer.name: expected letters, digits and _ beginning with a letter, found '2'");
    rename_layer(scene, 1, "suns");
    EXPECT_EQ(scene, before);
}

TEST_F(Layers, ANameThatBeginsLikeAnotherKeepsItsTracks) {
    scene.layers[0].name = "star";
    rename_layer(scene, 0, "gas");
    EXPECT_TRUE(is_animated(scene, "layer.stars.render.core"));
}

TEST(LayersInAFile, EveryChangeIsSavedAndLoaded) {
    const test::SceneFolder f;
    f.folder.file("m 33 ü.png", "P2\n1 1\n255\n9\n");  // a PNM, whatever its name
    Document document = Document::open(f.file);
    const auto saves = [&] {
        document.save();
        ASSERT_EQ(load_scene(f.file), document.scene()) << f.text();
    };
    document.edit("Duplicate", [](Scene& s) { duplicate_layer(s, 0); });
    saves();
    document.edit("Move", [](Scene& s) { move_layer(s, 0, 2); });
    saves();
    document.edit("Add", [&](Scene& s) { EXPECT_EQ(add_layer(s, f.folder / "m 33 ü.png"), 3u); });
    EXPECT_EQ(document.scene().layers[3].name, "m_33");
    EXPECT_EQ(document.scene().layers[3].source.meshes[0].texture[0], f.folder / "m 33 ü.png");
    saves();
    document.edit("Remove", [](Scene& s) { remove_layer(s, 1); });
    saves();
    EXPECT_NE(f.text().find("# by hand, keep this"), std::string::npos);
    for (int i = 0; i < 4; ++i) document.undo();
    document.save();
    EXPECT_EQ(load_scene(f.file), parse_scene(test::edit_scene, f.file));
}

TEST(Presets, GiveLookAndRender) {
    const TempFolder folder;
    const fs::path preset =
        folder.file("vorlage ä.toml", "[look]\nalpha = { power = 3.0 }\n[render]\nblend = \"add\"\n");
    Scene scene = parse_scene(test::edit_scene, folder / "scene.toml");
    LayerParams& layer = scene.layers[0];
    const SourceParams source = layer.source;
    apply_preset(layer, preset);
    EXPECT_EQ(layer.look.alpha.power, 3.0f);
    EXPECT_EQ(layer.render.blend, Blend::add);
    EXPECT_TRUE(layer.look.noise.empty());  // the whole look
    EXPECT_EQ(layer.name, "dust");
    EXPECT_EQ(layer.source, source);
    EXPECT_TRUE(layer.preset.empty());
    const LayerParams before = layer;
    folder.file("schlecht.toml", "[look]\ndensty = 1\n");
    EXPECT_EQ(ERROR_OF(apply_preset(layer, folder / "schlecht.toml")),
              (folder / "schlecht.toml").string() + ":2: unknown key 'densty'; did you mean 'look.density'?");
    EXPECT_EQ(layer, before);
}

// Every parameter of describe(), edited at random: what it is set to it is, undo and redo lead back and
// forth, and what is saved loads as the same scene. New parameters are tested as soon as they are described.

using test::Numbers;
using test::random_value;
using test::SceneFolder;
using test::value_of;

std::vector<ParameterSpec> specs_of(const Document& document) {
    Scene scene = document.scene();
    std::vector<ParameterSpec> specs;
    for (const Parameter& parameter : describe(scene).parameters) specs.push_back(parameter.spec);
    return specs;
}

/// False where a rule between parameters refused the value; the scene is then as before.
bool try_set(Document& document, const std::string& key, const Value& value, double frame) {
    const Scene before = document.scene();
    if (ERROR_OF(document.set(key, value, frame)) == "no error") return true;
    EXPECT_EQ(document.scene(), before) << key;
    return false;
}

/// Rules between parameters may refuse these: curves without points, half of a pair such as radius.min above
/// max, a cube that is none, a camera file that is not there, places that need a camera or a
/// file beside them.
bool may_be_refused(const std::string& key) {
    return std::ranges::any_of(
        std::initializer_list<const char*>{".shape", ".radius.min", ".radius.max", ".source.kind",
                                           ".source.uv", ".prepare.alpha", "camera.file", ".thickness.map",
                                           ".hybrid.from_deg", ".hybrid.to_deg", "environment.cube"},
        [&](const char* ending) { return key.ends_with(ending); });
}

TEST(EveryParameter, GoesForthAndBackAndThroughTheFile) {
    const SceneFolder f;
    f.folder.file("vorlage.toml", "[look]\nnoise = { cull = 0.5 }\n[render]\ncore = 0.25\n");
    Document document = Document::open(f.file);
    const Scene start = document.scene();
    Numbers numbers(1);
    std::size_t refused = 0;
    const std::vector<ParameterSpec> specs = specs_of(document);
    for (const ParameterSpec& spec : specs) {
        const Value value = random_value(spec, numbers);
        if (!try_set(document, spec.key, value, 5.0)) {
            ++refused;
            EXPECT_TRUE(may_be_refused(spec.key)) << spec.key << " = " << to_toml(value);
            continue;
        }
        const Scene edited = document.scene();
        const fs::path copy = f.folder / "kopie.toml";
        Scene loaded = parse_scene(document.text_for(copy), copy);
        loaded.file = edited.file;
        EXPECT_EQ(loaded, edited) << spec.key << " = " << to_toml(value);
        if (!document.can_undo()) continue;  // the value it had
        document.undo();
        EXPECT_EQ(document.scene(), start) << spec.key;
        document.redo();
        EXPECT_EQ(document.scene(), edited) << spec.key;
        document.undo();
    }
    EXPECT_GT(specs.size(), 150u);
    EXPECT_LE(refused, specs.size() / 10) << "what is refused is not tried";
}

TEST(EveryParameter, ThousandsOfEditsUndoneRedoneAndSaved) {
    const SceneFolder f;
    f.folder.file("vorlage.toml", "[look]\nnoise = { cull = 0.5 }\n[render]\ncore = 0.25\n");
    Document document = Document::open(f.file);
    const Scene start = document.scene();
    Numbers numbers(2);
    std::vector<Scene> scenes{start};
    while (scenes.size() <= 400) {
        const std::vector<ParameterSpec> specs = specs_of(document);
        const ParameterSpec& spec = specs[numbers.below(specs.size())];
        if (!try_set(document, spec.key, random_value(spec, numbers), numbers.frame())) continue;
        if (document.scene() == scenes.back()) continue;
        scenes.push_back(document.scene());
        if (scenes.size() % 40 != 0) continue;
        document.save();
        ASSERT_EQ(load_scene(f.file), document.scene()) << f.text();
        ASSERT_FALSE(document.edited());
    }
    for (std::size_t i = scenes.size(); i-- > 0;) {
        ASSERT_EQ(document.scene(), scenes[i]) << i;
        document.undo();
    }
    EXPECT_FALSE(document.can_undo());
    for (const Scene& scene : scenes) {
        ASSERT_EQ(document.scene(), scene);
        document.redo();
    }
    for (int i = 0; i < 400; ++i) document.undo();
    document.save();
    EXPECT_EQ(load_scene(f.file), start);
    EXPECT_EQ(f.text().rfind("# by hand, keep this", 0), 0u);
}

}  // namespace
}  // namespace astrosplat

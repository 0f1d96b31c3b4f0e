// Every parameter of describe(), edited at random: what it is set to it is, undo and redo lead back and
// forth, and what is saved loads as the same scene. New parameters are tested as soon as they are described.
#include <gtest/gtest.h>

#include <algorithm>

#include "edit/document.h"
#include "scenes.h"
#include "support/random_values.h"

namespace astrosplat {
namespace {

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
    try {
        document.set(key, value, frame);
        return true;
    } catch (const InputError&) {
        EXPECT_EQ(document.scene(), before) << key;
        return false;
    }
}

/// Rules between parameters may refuse these: curves without points, half of a pair such as radius.min above
/// max, a cube that is none, a camera file that is not there, places that need a camera or a file beside
/// them.
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
        const std::filesystem::path copy = f.folder / "kopie.toml";
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

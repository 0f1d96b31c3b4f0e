// Every parameter of describe(), edited at random: what it is set to it is, undo and redo lead back and
// forth, and what is saved loads as the same scene. New parameters are tested as soon as they are described.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/shared_maths.h"
#include "edit/document.h"
#include "scenes.h"

namespace astrosplat {
namespace {

using test::SceneFolder;
using test::value_of;

/// Hashed numbers: the same in every run.
class Numbers {
  public:
    explicit Numbers(std::uint32_t seed) : seed_(seed) {}
    std::uint32_t next() { return shared::as_hash(seed_, count_++, 0u, 1u); }
    std::size_t below(std::size_t n) { return next() % n; }
    double frame() { return static_cast<double>(1 + below(48)); }
    double between(double lo, double hi) { return lo + (hi - lo) * (next() / 4294967296.0); }

  private:
    std::uint32_t seed_, count_ = 0;
};

double random_number(const ParameterSpec& spec, Numbers& numbers) {
    const double x =
        numbers.between(std::fmax(spec.min, spec.slider_min), std::fmin(spec.max, spec.slider_max));
    return spec.type == ParameterType::integer ? std::floor(x) : x;
}

Value random_list(const ParameterSpec& spec, Numbers& numbers) {
    const bool whole = spec.generic_key == "output.resolution" || spec.generic_key == "layer.source.voxels";
    Value::List list;
    for (int i = 0; i < spec.components; ++i) {
        const double x = random_number(spec, numbers);
        if (whole)
            list.emplace_back(static_cast<std::int64_t>(x));
        else
            list.emplace_back(x);
    }
    return list;
}

Value random_words(const ParameterSpec& spec, Numbers& numbers) {
    Value::List words;
    for (const std::string& choice : spec.choices)
        if (numbers.below(2) == 1) words.emplace_back(choice);
    return words;
}

std::string random_text(const ParameterSpec& spec, Numbers& numbers) {
    if (!spec.choices.empty()) return spec.choices[numbers.below(spec.choices.size())];
    if (spec.generic_key == "output.frames") return "1-" + std::to_string(2 + numbers.below(90)) + "x3";
    if (spec.generic_key == "layer.name") return "layer_" + std::to_string(numbers.below(1000000));
    return "Größe \"x\\y\" #" + std::to_string(numbers.below(100));
}

Value random_value(const ParameterSpec& spec, Numbers& numbers) {
    const std::string file = "ordner ü/bild " + std::to_string(numbers.below(100)) + ".png";
    switch (spec.type) {
        case ParameterType::boolean:
            return numbers.below(2) == 1;
        case ParameterType::integer:
            return static_cast<std::int64_t>(random_number(spec, numbers));
        case ParameterType::number:
            return random_number(spec, numbers);
        case ParameterType::text:
            return random_text(spec, numbers);
        case ParameterType::choice:
            return spec.choices[numbers.below(spec.choices.size())];
        case ParameterType::words:
            return random_words(spec, numbers);
        case ParameterType::file:
            if (spec.generic_key == "output.preset") return "dome";
            return spec.generic_key == "layer.preset" ? "vorlage.toml" : file;
        case ParameterType::files:
            if (numbers.below(2) == 1) return file;
            return Value::List{file, "b.png", "c ä.png"};
        case ParameterType::pattern:
            return "bilder " + std::to_string(numbers.below(100)) + "/b.####.png";
        case ParameterType::curve:
            return Value::List{Value::List{0.0, numbers.between(0, 1)},
                               Value::List{numbers.between(0.1, 0.9), numbers.between(0, 1)},
                               Value::List{1.0, numbers.between(0, 1)}};
        default:
            return random_list(spec, numbers);
    }
}

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

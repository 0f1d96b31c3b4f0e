// Parameters and words of a scene.
#include "look/picture_fit.h"
#include "look/prepare.h"
#include "scene/describe.h"
#include "scene/frames.h"
#include "scene/parameter_key.h"
#include "scene/toml_text.h"
#include "scene_texts.h"
#include "support/test.h"
#include "unit/look/sets.h"

namespace astrosplat::test {
namespace {

// Every parameter of the look does something, and blocks of splats are shaded as one splat alone is: what is
// described but not prepared, or used in one of the two only, is noticed as soon as it is described.

constexpr std::int64_t count = 400;

struct LookCase {
    Look look;
    SplatSet set = file_set(count);
    Image map = make_image(3, 2, 3);

    LookCase() {
        for (std::size_t i = 0; i < map.pixels.size(); ++i) map.pixels[i] = uniform(std::int64_t(i), 70);
        for (std::int64_t i = 0; i < count; ++i) set.uv.push_back({uniform(i, 71), uniform(i, 72)});
        set.spacing = glm::dvec3(0.1);
        look.reach = 1.7f;
        look.radius = {0.05f, 0.2f, 1.0f, 1.0f};
    }
    LookInputs inputs() const {
        LookInputs inputs;
        inputs.axis = {0.3f, 0.8f, -0.2f};
        inputs.thickness_map = &map;
        return inputs;
    }
    ShadedSplats shaded() const { return apply_look(set, look, inputs()); }
};

/// One entry in each list, and none of the numbers at a value where another has no effect.
LookCase with_everything() {
    LookCase c;
    c.look.thickness.map = "map.exr";
    c.look.thickness.stops.resize(2);
    c.look.thickness.stops[0].color = {0.2f, 0.4f, 0.1f};
    c.look.noise = {{1.3f, 4, 2.1f, 0.5f, 3, 0.6f, 0.4f, 0.1f, 0.5f, 0.2f}};
    c.look.crop.resize(1);
    c.look.crop[0].size = {6.0f, 0.8f, 7.0f};
    c.look.crop[0].rotate = {3.0f, 20.0f, 4.0f};
    c.look.crop[0].radius = 3.0f;
    c.look.crop[0].soft = 0.4f;
    c.look.crop[0].outline = "M -2 -1 2 -1 0.5 1.5 M 0 0 0.3 0.2";
    c.look.alpha = {1.7f, 0.9f, true, 1.2f};
    c.look.vertical.shape = VerticalAlpha::Shape::linear;
    c.look.radius = {0.05f, 0.2f, 1.6f, 0.7f};
    c.look.grade = {1.3f, {1.0f, 0.8f, 0.9f}, 1.4f, 1.8f, 0.05f};
    return c;
}

bool operator==(const ShadedSplats& a, const ShadedSplats& b) {
    return std::ranges::equal(a.position, b.position) && std::ranges::equal(a.color, b.color) &&
           std::ranges::equal(a.alpha, b.alpha) && std::ranges::equal(a.radius, b.radius) &&
           std::ranges::equal(a.id, b.id);
}

Value number(const ParameterSpec& spec, double share) {
    const double x = spec.slider_min + share * (spec.slider_max - spec.slider_min);
    if (spec.type == ParameterType::integer) return std::int64_t(x);
    if (spec.components == 1) return x;
    Value::List list;
    for (int i = 0; i < spec.components; ++i) list.emplace_back(x * (1.0 - 0.3 * i));
    return list;
}

std::vector<Value> values_to_try(const ParameterSpec& spec) {
    if (spec.type == ParameterType::boolean) return {true, false};
    if (spec.type == ParameterType::curve)
        return {Value::List{Value::List{0.1, 0.9}, Value::List{0.5, 0.2}, Value::List{0.9, 0.6}}};
    if (spec.type == ParameterType::text && spec.choices.empty())
        return {"M -1 -1 1 -1 0 2", "M -3 -0.2 3 0.1 0 0.6"};
    if (is_numeric(spec.type)) return {number(spec, 0.37), number(spec, 0.9), number(spec, 0.0)};
    return {spec.choices.begin(), spec.choices.end()};
}

/// Gives the parameters that it depends on values with which it does something.
void meet_conditions(const Description& description, const ParameterSpec& spec) {
    for (const Condition& condition : spec.conditions) {
        const Parameter& other = *find_parameter(description, condition.key);
        const std::vector<std::string>& choices = other.spec.choices;
        const auto fits = [&](const Value& value) {
            return (std::ranges::find(condition.values, value) != condition.values.end()) == condition.wanted;
        };
        if (fits(other.get())) continue;
        const auto choice = std::ranges::find_if(choices, [&](const std::string& c) { return fits(c); });
        ASSERT_NE(choice, choices.end()) << spec.key << " depends on " << condition.key;
        other.set(*choice);
    }
}

/// Whether blocks are shaded as look_splat, which the preview runs, shades each splat alone.
void expect_alike(const LookCase& c, const ShadedSplats& shaded, const std::string& what) {
    const PreparedLook uniforms = prepare_look(c.set, c.look, c.inputs());
    ShadedSplats unused;
    const LookRun run{LookColumns(c.set), uniforms, &c.map, unused};
    std::size_t kept = 0;
    for (std::int64_t i = 0; i < count; ++i) {
        const OneSplat splat = look_at(run, uniforms, i);
        if (!splat.keep) continue;
        ASSERT_LT(kept, shaded.id.size()) << what;
        ASSERT_EQ(shaded.color[kept], splat.color) << what;
        ASSERT_EQ(shaded.alpha[kept], splat.alpha) << what;
        ASSERT_EQ(shaded.radius[kept], splat.radius) << what;
        ++kept;
    }
    EXPECT_EQ(kept, shaded.id.size()) << what;
}

/// Whether any value of the parameter changes what is shaded.
bool has_influence(const LookCase& original, std::size_t index) {
    LookCase c = original;
    LayerRender unused;
    const Description description = describe_preset(c.look, unused);
    const Parameter& parameter = description.parameters.at(index);
    meet_conditions(description, parameter.spec);
    const ShadedSplats before = c.shaded();
    for (const Value& value : values_to_try(parameter.spec)) {
        parameter.set(value);
        const ShadedSplats after = c.shaded();
        if (after == before) continue;
        expect_alike(c, after, parameter.spec.key.text() + " = " + to_toml(value));
        return true;
    }
    return false;
}

TEST(LookParameters, EachChangesWhatIsShadedInBlocksAsAlone) {
    const Quiet quiet;
    const std::set<std::string> pictures{"look.thickness.map",
                                         "look.thickness.derive"};  // are read elsewhere
    std::map<std::string, bool> used;                               // by key
    for (const LookCase& c : {LookCase(), with_everything()}) {
        Look look = c.look;
        LayerRender unused;
        const Description description = describe_preset(look, unused);
        for (std::size_t i = 0; i < description.parameters.size(); ++i) {
            const ParameterKey& key = description.parameters[i].spec.key;
            if (key.is_below("look") && !pictures.contains(key.text()))
                used[key.text()] |= has_influence(c, i);
        }
    }
    for (const auto& [key, any] : used) EXPECT_TRUE(any) << key << " changes nothing";
    EXPECT_GT(used.size(), 45u);
}

// The description of each parameter besides its key: its place in the window, when it has an effect,
// the names of its choices.

const ParameterSpec& spec_of(const ParameterKey& key) {
    const auto& rows = parameter_rows();
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.spec.key == key; });
    EXPECT_NE(row, rows.end()) << key;
    return row->spec;
}

TEST(DescriptionTest, EveryParameterHasAPlaceInTheWindow) {
    const std::vector<std::string_view> tabs{"Source", "Look", "Mixing", "Camera", "Environment", "Output"};
    for (const ParameterRow& row : parameter_rows()) {
        EXPECT_NE(std::find(tabs.begin(), tabs.end(), row.spec.tab), tabs.end()) << row.spec.key;
        EXPECT_FALSE(row.spec.section.empty()) << row.spec.key;
        EXPECT_FALSE(row.spec.row_label.empty()) << row.spec.key;
    }
    EXPECT_EQ(spec_of("layer.look.radius.min").row_label, "Smallest");
    EXPECT_EQ(spec_of("layer.look.noise.cull").section, "Noise");
}

// Undo, the graph and search name a parameter by its label alone.
TEST(DescriptionTest, NoTwoParametersOfALayerOrOfTheSceneHaveOneName) {
    // The same of two things that are never seen together, or of each of a list. What is prepared and masked
    // is described in the same words.
    const std::set<std::string> shared{"Rate",     "Points",   "Sigma", "Density with distance",
                                       "Rotation", "Position", "Scale", "Width",
                                       "Height"};
    std::map<std::pair<bool, std::string>, std::string> keys;
    for (const ParameterRow& row : parameter_rows()) {
        const bool of_layer = row.spec.key.is_below("layer");
        const bool counts = !row.spec.key.is_below("layer.source.mask") &&
                            !row.spec.key.is_below("layer.source.prepare") &&
                            !row.spec.key.is_below("reference");
        if (!counts || shared.count(row.spec.label)) continue;
        std::string& first = keys[{of_layer, row.spec.label}];
        if (first.empty()) first = row.spec.key.text();
        EXPECT_EQ(first, row.spec.key.text()) << row.spec.label;
    }
    EXPECT_EQ(spec_of("layer.look.alpha.gain").label, "Opacity gain");
    EXPECT_EQ(spec_of("layer.look.noise.gain").label, "Octave gain");
    EXPECT_EQ(spec_of("environment.gain").label, "Light gain");
}

TEST(DescriptionTest, ConditionsNameParametersAndValuesTheyTake) {
    Scene scene = parse(full_scene());
    const Description description = describe(scene);
    int conditions = 0;
    for (const Parameter& parameter : description.parameters)
        for (const Condition& condition : parameter.spec.conditions) {
            const Parameter* other = find_parameter(description, condition.key);
            ASSERT_TRUE(other) << parameter.spec.key << " depends on " << condition.key;
            for (const Value& value : condition.values) {
                const Value before = other->get();
                EXPECT_NO_THROW(other->set(value)) << condition.key << " = " << to_toml(value);
                EXPECT_EQ(other->get(), value) << condition.key;
                other->set(before);
                ++conditions;
            }
        }
    EXPECT_GT(conditions, 40);
}

TEST(DescriptionTest, ARateHasAnEffectOnlyOnAnExponential) {
    Scene scene = parse(small_scene());
    const auto has = [&](const ParameterKey& key) {
        const Description description = describe(scene);
        const auto find = [&](const ParameterKey& other) { return find_parameter(description, other); };
        return has_effect(find(key)->spec, find);
    };
    scene.layers[0].look.pdf.shape = DensityCurve::Shape::linear;
    EXPECT_FALSE(has("layer.stars.look.pdf.rate"));
    scene.layers[0].look.pdf.shape = DensityCurve::Shape::exponential;
    EXPECT_TRUE(has("layer.stars.look.pdf.rate"));
    EXPECT_TRUE(has("camera.fov"));
    EXPECT_FALSE(has("camera.film_width"));
    scene.camera.focal_length = 50.0;
    EXPECT_FALSE(has("camera.fov"));
    EXPECT_TRUE(has("camera.film_width"));
    scene.camera.projection = Projection::orthographic;
    EXPECT_FALSE(has("camera.film_width"));
    scene.camera.rotation = glm::dvec4(0.0, 0.0, 0.0, 1.0);
    EXPECT_FALSE(has("camera.target"));
}

TEST(DescriptionTest, ChoicesAreTheNamesOfTheEnum) {
    EXPECT_EQ(name_of(DensityCurve::Shape::gaussian), "gaussian");
    EXPECT_EQ(spec_of("layer.render.blend").choices,
              (std::vector<std::string>{"over", "add", "screen", "lighten", "hybrid", "absorb"}));
    EXPECT_EQ(spec_of("layer.look.vertical.shape").choices, all_names<VerticalAlpha::Shape>());
    EXPECT_EQ(spec_of("output.depth").choices[4], "8");
}

TEST(DescriptionTest, NumbersHaveFiniteRanges) {
    for (const ParameterRow& row : parameter_rows()) {
        if (!is_numeric(row.spec.type)) continue;
        EXPECT_TRUE(std::isfinite(row.spec.min) && std::isfinite(row.spec.max)) << row.spec.key;
        EXPECT_LT(row.spec.min, row.spec.max) << row.spec.key;
    }
}

// Dotted keys: built from parts, taken apart, compared.

TEST(ParameterKeyTest, IsBuiltFromParts) {
    EXPECT_EQ(layer_key("stars") / "look.noise" / 2 / "cull", "layer.stars.look.noise.2.cull");
    EXPECT_EQ(ParameterKey() / "camera" / "fov", "camera.fov");
    EXPECT_EQ(fmt::format("{}", layer_key("a")), "layer.a");
    EXPECT_EQ(layer_key("a").parts(), (std::vector<std::string>{"layer", "a"}));
    EXPECT_TRUE(ParameterKey().parts().empty());
}

TEST(ParameterKeyTest, LiesBelowWholePartsOnly) {
    const ParameterKey key = "layer.stars.look.density";
    EXPECT_TRUE(key.is_below("layer"));
    EXPECT_TRUE(key.is_below("layer.stars"));
    EXPECT_TRUE(key.is_below(""));
    EXPECT_FALSE(key.is_below("layer.star"));
    EXPECT_FALSE(key.is_below("layer.stars.look.density"));
    EXPECT_FALSE(key.is_below("camera"));
    EXPECT_FALSE(ParameterKey().is_below(""));
    EXPECT_EQ(key.below("layer.stars"), "look.density");
    EXPECT_EQ(key.below(""), "layer.stars.look.density");
    EXPECT_EQ(key.moved("layer.stars", "layer.dust"), "layer.dust.look.density");
    EXPECT_EQ(key.parent(), "layer.stars.look");
    EXPECT_EQ(ParameterKey("camera").parent(), "");
}

TEST(ParameterKeyTest, KnowsItsLayer) {
    EXPECT_EQ(ParameterKey("layer.stars.look.density").layer(), "stars");
    EXPECT_EQ(ParameterKey("layer.stars").layer(), "stars");
    EXPECT_EQ(ParameterKey("layer").layer(), "");
    EXPECT_EQ(ParameterKey("layers.stars.visible").layer(), "");
    EXPECT_EQ(ParameterKey("camera.fov").layer(), "");
}

TEST(ParameterKeyTest, GenericKeysHaveNeitherLayerNorIndex) {
    EXPECT_EQ(ParameterKey("layer.look.look.noise.12.cull").generic(), "layer.look.noise.cull");
    EXPECT_EQ(ParameterKey("look.noise.0.cull").generic(), "look.noise.cull");
    EXPECT_EQ(ParameterKey("camera.position").generic(), "camera.position");
    EXPECT_EQ(ParameterKey("layer.s106.look.vertical.shape").generic(), "layer.look.vertical.shape");
    EXPECT_FALSE(is_list_index(""));
    EXPECT_FALSE(is_list_index("1a"));
}

// "Did you mean": distances worked out by hand, and the slips people make in keys.

TEST(Suggest, EditDistance) {
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
    EXPECT_EQ(edit_distance("", "abc"), 3);
    EXPECT_EQ(edit_distance("same", "same"), 0);
    EXPECT_EQ(edit_distance("outptu", "output"), 1);
    EXPECT_EQ(edit_distance("uotput", "output"), 1);
}

TEST(Suggest, NearestName) {
    const std::vector<std::string> keys{"layer.look.alpha.power", "layer.look.density", "camera.fov"};
    EXPECT_EQ(nearest_name("camera.fow", keys), "camera.fov");
    EXPECT_EQ(nearest_name("alpha.powr", keys), "layer.look.alpha.power");
    EXPECT_EQ(nearest_name("densty", keys), "layer.look.density");
    EXPECT_EQ(nearest_name("fow", keys), "camera.fov");
    EXPECT_EQ(nearest_name("something", keys), "");
}

// Frame lists.

using Frames = std::vector<std::int64_t>;

std::string refusal(const std::string& text) { return ERROR_OF(parse_frames(text, "--frames")); }

TEST(Frames, ListsRangesAndSteps) {
    EXPECT_EQ(parse_frames("5", ""), (Frames{5}));
    EXPECT_EQ(parse_frames("1-3, 7", ""), (Frames{1, 2, 3, 7}));
    EXPECT_EQ(parse_frames("10-15x2", ""), (Frames{10, 12, 14}));
    EXPECT_EQ(parse_frames("10-16:3", ""), (Frames{10, 13, 16}));
    EXPECT_EQ(parse_frames("-3--1,-5", ""), (Frames{-5, -3, -2, -1}));
    EXPECT_EQ(parse_frames("-1-1", ""), (Frames{-1, 0, 1}));
    EXPECT_EQ(parse_frames("3,1-3,2", ""), (Frames{1, 2, 3}));
    EXPECT_EQ(parse_frames("1-240", "").size(), 240u);
}

TEST(Frames, AreWrittenShortAndReadBack) {
    const std::pair<Frames, std::string> cases[] = {
        {{}, ""},
        {{7}, "7"},
        {{1, 2}, "1-2"},
        {{1, 3}, "1,3"},
        {{-3, -2, -1, 4}, "-3--1,4"},
        {{1, 3, 4, 5}, "1,3-5"},
        {{0, 5, 10, 11}, "0-10x5,11"},
        {{1, 2, 3, 7, 10, 12, 14, 16, 40}, "1-3,7,10-16x2,40"},
    };
    for (const auto& [frames, text] : cases) {
        EXPECT_EQ(frames_text(frames), text);
        if (frames.empty()) continue;
        EXPECT_EQ(parse_frames(text, ""), frames);
    }
}

TEST(Frames, Messages) {
    const std::string such = "--frames: expected frames such as 1-100,120,200-300x2, found ";
    EXPECT_EQ(refusal(""), such + "''");
    EXPECT_EQ(refusal("1,"), such + "''");
    EXPECT_EQ(refusal("a"), such + "'a'");
    EXPECT_EQ(refusal("1.5"), such + "'1.5'");
    EXPECT_EQ(refusal("1-"), such + "'1-'");
    EXPECT_EQ(refusal("9-1"), "--frames: expected a range that ascends, found '9-1'");
    EXPECT_EQ(refusal("1-9x0"), "--frames: expected a step of at least 1, found '1-9x0'");
    EXPECT_EQ(refusal("99999999999999999999"),
              "--frames: expected frames between -999999999 and 999999999, found '99999999999999999999'");
    EXPECT_EQ(refusal("1-20000000"), "--frames: expected at most 10000000 frames, found '1-20000000'");
}

// Edits of a TOML text: what is removed goes with its line, and keys are quoted where they must be.

TEST(TomlKey, IsQuotedWhereTomlNeedsIt) {
    EXPECT_EQ(toml_key({"azAZ", "09", "_", "-"}), "azAZ.09._.-");
    EXPECT_EQ(toml_key({"layer.dust.look.density"}), "\"layer.dust.look.density\"");
    EXPECT_EQ(toml_key({"a b", ""}), "\"a b\".\"\"");
    EXPECT_EQ(toml_key({"layer", "0", "name"}, 2), "name");
}

TEST(TomlText, WhatIsRemovedTakesItsLineAlong) {
    TomlText text("a = 1\nb.c = 2  # of b\nb.d = 3\ne = 4\n");
    text.remove({"b", "c"});
    EXPECT_EQ(text.text(), "a = 1\nb.d = 3\ne = 4\n");
    text.remove({"b"});
    EXPECT_EQ(text.text(), "a = 1\ne = 4\n");
    text.remove({"absent"});
    EXPECT_EQ(text.text(), "a = 1\ne = 4\n");
}

TEST(TomlText, InlineTablesCloseTheGapOfWhatIsRemoved) {
    const std::string begin = "a = { b = 1, c = 2, d = 3 }  # kept\n";
    const auto without = [&](const std::string& key) {
        TomlText text(begin);
        text.remove({"a", key});
        return text.text();
    };
    EXPECT_EQ(without("b"), "a = { c = 2, d = 3 }  # kept\n");
    EXPECT_EQ(without("c"), "a = { b = 1, d = 3 }  # kept\n");
    EXPECT_EQ(without("d"), "a = { b = 1, c = 2 }  # kept\n");
}

}  // namespace
}  // namespace astrosplat::test

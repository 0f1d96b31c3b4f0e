// Parameters: their description, and that every one of the look does something.

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "look/picture_fit.h"
#include "look/prepare.h"
#include "scene/describe.h"
#include "scene_texts.h"
#include "support/quiet.h"
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
    if (spec.type == ParameterType::integer) return static_cast<std::int64_t>(x);
    if (spec.components == 1) return x;
    Value::List list;
    for (int i = 0; i < spec.components; ++i) list.emplace_back(x * (1.0 - 0.3 * i));
    return list;
}

std::vector<Value> values_to_try(const ParameterSpec& spec) {
    if (spec.type == ParameterType::boolean) return {true, false};
    if (spec.type == ParameterType::curve)
        return {Value::List{Value::List{0.1, 0.9}, Value::List{0.5, 0.2}, Value::List{0.9, 0.6}}};
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
    const LookUniforms uniforms = prepare_look(c.set, c.look, c.inputs());
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
    // is told in the same words.
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
    Scene scene = parse(full_scene);
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

}  // namespace
}  // namespace astrosplat::test

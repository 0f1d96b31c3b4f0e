// The description of each parameter besides its key: its place in the window, when it has an effect,
// the names of its choices.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "scene/describe.h"
#include "scene_texts.h"

namespace astrosplat::test {
namespace {

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

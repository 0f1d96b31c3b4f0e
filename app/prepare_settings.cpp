#include "prepare_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.h"
#include "scene/check.h"
#include "scene/describe.h"
#include "scene/describe_layer.h"
#include "scene/load.h"
#include "source/fits.h"

namespace astrosplat {
namespace {

std::string placeholder_of(const ParameterSpec& spec) {
    switch (spec.type) {
        case ParameterType::choice:
            return fmt::format("{}", fmt::join(spec.choices, "|"));
        case ParameterType::boolean:
            return "true|false";
        case ParameterType::file:
            return "FILE";
        case ParameterType::vector:
            return spec.components == 2 ? "LOW,HIGH" : "X,Y,RX,RY";
        default:
            return "X";
    }
}

std::string default_text(const Parameter& parameter) {
    const Value value = parameter.get();
    const std::string text = value.text() ? *value.text() : to_toml(value);
    return text.empty() || text == "[]" ? "" : fmt::format(" (default: {})", text);
}

// Words as they are typed: no quotes around text, no brackets around lists.
Value value_typed(const std::string& text, const ParameterSpec& spec) {
    if (spec.type == ParameterType::file) return text;
    const bool list = spec.type == ParameterType::vector && !text.starts_with('[');
    return typed_value(list ? "[" + text + "]" : text);
}

// An option that does nothing by itself was meant to do something.
void require_effect(const Parameter& parameter, const Description& description) {
    const auto find = [&](const ParameterKey& key) { return find_parameter(description, key); };
    if (has_effect(parameter.spec, find)) return;
    const Condition& condition = parameter.spec.conditions.front();
    const std::string value = condition.wanted ? " " + to_toml(condition.values.front()) : "";
    bad_input(prepare_option(parameter.spec.key), "", prepare_option(condition.key) + value + " beside it",
              "none");
}

}  // namespace

TextureSettings default_prepare_settings(bool three_filters) {
    TextureSettings settings;
    settings.prepare.stars = PrepareParams::Stars::remove;
    settings.prepare.lupton = three_filters;
    return settings;
}

std::vector<PrepareOption> prepare_options() {
    TextureSettings settings = default_prepare_settings(false);
    std::vector<PrepareOption> options;
    for (const Parameter& parameter : describe_preparation(settings).parameters) {
        const ParameterSpec& spec = parameter.spec;
        const std::string unit = spec.unit.empty() ? "" : fmt::format(" [{}]", spec.unit);
        options.push_back({spec.key.text(), prepare_option(spec.key), placeholder_of(spec),
                           spec.help + unit + default_text(parameter)});
    }
    return options;
}

bool has_three_filters(const PrepareOptions& options) {
    const int given = !options.red.empty() + !options.green.empty() + !options.blue.empty();
    if (given != 0 && (given != 3 || !options.image.empty()))
        bad_input(
            "--r, --g, --b", "", "all three and no other picture",
            given == 3 ? "'" + options.image.string() + "' as well" : std::to_string(given) + " of them");
    if (given == 0 && options.image.empty())
        bad_input("prepare", "", "a picture, or --r, --g and --b", "none");
    return given == 3;
}

TextureSettings prepare_settings(const PrepareOptions& options) {
    TextureSettings settings = default_prepare_settings(has_three_filters(options));
    const Description description = describe_preparation(settings);
    for (const auto& [key, text] : options.settings) {
        const Parameter* const parameter = find_parameter(description, key);
        try {
            parameter->set(value_typed(text, parameter->spec));
        } catch (const ValueError& error) {
            throw InputError(prepare_option(key) + ": " + error.what());
        }
    }
    for (const auto& [key, text] : options.settings)
        require_effect(*find_parameter(description, key), description);
    if (const std::optional<KeyProblem> problem = problem_of(settings.prepare))
        throw InputError(prepare_option(problem->key) + ": " + problem->message);
    if (options.settings.contains("stretch") && settings.prepare.lupton)
        bad_input("--stretch", "", "--lupton false beside it", "none");
    return settings;
}

}  // namespace astrosplat

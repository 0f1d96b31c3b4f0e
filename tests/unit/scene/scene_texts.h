// Scene texts and helpers that several tests share.
#pragma once

#include "scene/describe.h"
#include "scene/load.h"
#include "support/test.h"

namespace astrosplat::test {

/// All defaults of one layer, "stars", with an element in each list.
Scene scene_of_defaults();
/// The text that says so, with every described key.
std::string full_scene();

/// One layer, nothing else.
inline std::string small_scene(const std::string& layer_rest = "") {
    return "astrosplat = 1\n[[layer]]\nname = \"stars\"\n" + layer_rest +
           "\n[layer.source]\nmeshes = [ { mesh = \"plane\", texture = \"a.png\" } ]\n";
}

inline Scene parse(const std::string& text, std::vector<std::string> assignments = {},
                   const std::string& file = "scene.toml") {
    std::vector<Assignment> list;
    for (const std::string& assignment : assignments) list.push_back(parse_assignment(assignment));
    return parse_scene(text, file, list);
}

/// The message that parsing ends with; "" when it does not.
inline std::string message(const std::string& text, std::vector<std::string> assignments = {}) {
    try {
        parse(text, std::move(assignments));
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// The value of a key as TOML.
inline std::string value(Scene scene, const std::string& key) {
    const Description description = describe(scene);
    const Parameter* parameter = find_parameter(description, key);
    return parameter ? to_toml(parameter->get()) : "no such key";
}

}  // namespace astrosplat::test

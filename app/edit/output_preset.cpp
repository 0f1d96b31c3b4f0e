#include "edit/output_preset.h"

#include <fmt/format.h>

#include "scene/check.h"
#include "scene/describe.h"
#include "scene/entries.h"
#include "scene/load.h"

namespace astrosplat {

void apply_output_preset(Scene& scene) {
    if (scene.output.preset.empty()) return;
    const std::string head = "astrosplat = 1\n";
    const std::string text = fmt::format("[output]\npreset = {}\n", to_toml(scene.output.preset.string()));
    Scene blank = parse_unchecked(head, scene.file), loaded = parse_unchecked(head + text, scene.file);
    const Description standard = describe(blank), wanted = describe(scene);
    for (const Parameter& parameter : describe(loaded).parameters) {
        const ParameterKey& key = parameter.spec.key;
        const Parameter *before = find_parameter(standard, key), *own = find_parameter(wanted, key);
        if (before && own && key != "output.preset" && !(before->get() == parameter.get()))
            own->set(parameter.get());
    }
}

void keep_dome_square(Scene& scene, const Scene& before) {
    OutputParams& output = scene.output;
    if (!is_dome(output)) return;
    const bool width_changed = output.width != before.output.width,
               height_changed = output.height != before.output.height;
    if (width_changed && !height_changed) output.height = output.width;
    if (height_changed && !width_changed) output.width = output.height;
}

}  // namespace astrosplat

#include "edit/prepare_command.h"

#include <string_view>

#include "core/error.h"
#include "scene/describe.h"
#include "scene/describe_prepare.h"
#include "source/fits.h"

namespace astrosplat {
namespace {

void add_inputs(const SourceParams& source, std::vector<std::string>& words) {
    if (source.kind != SourceKind::mesh || source.meshes.empty() || source.meshes[0].texture.empty())
        throw InputError("source.meshes: expected a picture to prepare, found none");
    const std::vector<std::filesystem::path>& files = source.meshes[0].texture;
    if (files.size() == 1) return words.push_back(files[0].string());
    constexpr const char* filters[] = {"--r", "--g", "--b"};
    for (std::size_t i = 0; i < 3; ++i) words.insert(words.end(), {filters[i], files[i].string()});
}

}  // namespace

std::vector<std::string> prepare_command(const SourceParams& source, const std::filesystem::path& folder) {
    std::vector<std::string> words{"prepare"};
    add_inputs(source, words);
    words.insert(words.end(), {"-o", folder.string()});
    TextureSettings texture = source.texture, standard;
    if (texture.prepare.lupton || !is_fits(source.meshes[0].texture[0])) texture.stretch = standard.stretch;
    const Description description = describe_preparation(texture), defaults = describe_preparation(standard);
    const auto find = [&](const ParameterKey& key) { return find_parameter(description, key); };
    for (std::size_t i = 0; i < description.parameters.size(); ++i) {
        const Parameter& parameter = description.parameters[i];
        const Value value = parameter.get();
        const ParameterKey& key = parameter.spec.key;
        const bool said_anyway = key == "stars" || key == "lupton";  // whose defaults the command chooses
        if (!has_effect(parameter.spec, find)) continue;
        if (!said_anyway && value == defaults.parameters[i].get()) continue;
        words.insert(words.end(), {prepare_option(key), value.text() ? *value.text() : to_toml(value)});
    }
    return words;
}

}  // namespace astrosplat

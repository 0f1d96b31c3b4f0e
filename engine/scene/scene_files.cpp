// Which files a scene names, and their paths. Paths are handled as text: no file needs to exist.
#include "scene/scene_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "source/mesh.h"
#include "source/obj.h"

namespace astrosplat {

namespace fs = std::filesystem;

std::vector<fs::path> named_files(const SourceParams& source) {
    if (source.kind == SourceKind::splats) return {source.file};
    if (source.kind == SourceKind::stars)
        return source.stars.catalogue.empty() ? std::vector<fs::path>() : std::vector{source.stars.catalogue};
    std::vector<fs::path> files;
    for (const MeshInput& input : source.meshes) {
        if (!is_builtin_mesh(input.mesh)) files.push_back(input.mesh);
        files.insert(files.end(), input.texture.begin(), input.texture.end());
        if (!input.shape.depth_map.empty()) files.push_back(input.shape.depth_map);
    }
    const PrepareParams& prepare = source.texture.prepare;
    for (const fs::path& file : {prepare.align, prepare.fill, prepare.mask})
        if (!file.empty()) files.push_back(file);
    for (const MaskParams& mask : source.texture.mask) {
        if (!mask.image.empty()) files.push_back(mask.image);
        for (const MaskTerms& terms : mask.any)
            if (!terms.image.empty()) files.push_back(terms.image);
    }
    return files;
}

std::vector<fs::path> all_files(const SourceParams& source) {
    std::vector<fs::path> files = named_files(source);
    if (source.kind != SourceKind::mesh) return files;
    for (const MeshInput& input : source.meshes) {
        if (!has_own_pictures(input)) continue;
        const std::vector<fs::path> materials = obj_materials(input.mesh);
        files.insert(files.end(), materials.begin(), materials.end());
    }
    return files;
}

bool has_own_pictures(const MeshInput& input) {
    const auto is_empty = [](const fs::path& file) { return file.empty(); };
    return !is_builtin_mesh(input.mesh) && std::ranges::all_of(input.texture, is_empty);
}

std::vector<fs::path> picture_files(const Scene& scene) {
    std::vector<fs::path> files = scene.environment.cube;
    files.push_back(scene.environment.image);
    files.push_back(scene.environment.tile);
    for (const LayerParams& layer : scene.layers) files.push_back(layer.look.thickness.map);
    std::erase(files, fs::path());
    return files;
}

std::string expand_environment(const std::string& text) {
    std::string expanded;
    std::size_t from = 0;
    for (;;) {
        const std::size_t open = text.find("${", from);
        if (open == std::string::npos) return expanded + text.substr(from);
        const std::size_t close = text.find('}', open);
        if (close == std::string::npos) throw ValueError("expected '}' after '${', found none");
        const std::string name = text.substr(open + 2, close - open - 2);
        const char* value = std::getenv(name.c_str());
        if (!value)
            throw ValueError(
                fmt::format("expected the environment variable {} to be set, found it undefined", name));
        expanded += text.substr(from, open - from) + value;
        from = close + 1;
    }
}

namespace {

bool stands_for_itself(const std::string& text, const ParameterSpec& spec) {
    return text.empty() || std::ranges::find(spec.choices, text) != spec.choices.end();
}

std::string resolve(const std::string& text, const ParameterSpec& spec, const fs::path& folder) {
    if (stands_for_itself(text, spec)) return text;
    const std::string path = (folder / expand_environment(text)).lexically_normal().string();
    return stands_for_itself(path, spec) ? "./" + path : path;  // a file that is called "plane"
}

std::string unresolve(const std::string& text, const ParameterSpec& spec, const fs::path& folder) {
    if (stands_for_itself(text, spec)) return text;
    const fs::path path(text), base = folder.lexically_normal();
    std::string written = text;
    if (path.is_absolute() == base.is_absolute()) {
        const fs::path relative = path.lexically_relative(base.empty() ? "." : base);
        const bool below = !relative.empty() && *relative.begin() != "..";
        if (!relative.empty() && (below || !path.is_absolute())) written = relative.string();
    }
    if (stands_for_itself(written, spec)) written = "./" + written;
    const bool lost = path.is_relative() && resolve(written, spec, folder) != text;
    return lost ? fs::absolute(path).lexically_normal().string() : written;
}

template <class Change>
Value changed(const Value& value, Change change) {
    if (const auto* text = value.text()) return change(*text);
    if (const auto* list = value.list()) {
        Value::List result;
        for (const Value& element : *list) result.push_back(changed(element, change));
        return result;
    }
    return value;
}

}  // namespace

Value resolve_paths(const Value& value, const ParameterSpec& spec, const fs::path& folder,
                    bool absolute_patterns) {
    const bool file = spec.type == ParameterType::file || spec.type == ParameterType::files;
    if (file) return changed(value, [&](const std::string& text) { return resolve(text, spec, folder); });
    if (spec.type != ParameterType::pattern) return value;
    return changed(value, [&](const std::string& text) {
        const std::string pattern = expand_environment(text);
        return absolute_patterns && !pattern.empty() ? fs::absolute(folder / pattern).string() : pattern;
    });
}

Value unresolve_paths(const Value& value, const ParameterSpec& spec, const fs::path& folder) {
    const bool file = spec.type == ParameterType::file || spec.type == ParameterType::files;
    if (!file) return value;
    return changed(value, [&](const std::string& text) { return unresolve(text, spec, folder); });
}

}  // namespace astrosplat

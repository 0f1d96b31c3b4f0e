// Purely lexical: no file needs to exist.
#include "scene/path_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace astrosplat {
namespace fs = std::filesystem;

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

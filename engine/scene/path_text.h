// Paths as scene files write them: relative to the file, with ${NAME} for environment variables.
#pragma once

#include <filesystem>
#include <string>

#include "scene/parameter.h"

namespace astrosplat {

/// `text` with every ${NAME} replaced. Throws ValueError for an undefined variable or a missing brace.
std::string expand_environment(const std::string& text);

/// The paths of a file, files or pattern parameter, expanded and put below `folder`; names that stand for
/// themselves (built-in meshes) and empty ones stay. Frame patterns stay relative to the scene unless
/// `absolute_patterns`.
Value resolve_paths(const Value& value, const ParameterSpec& spec, const std::filesystem::path& folder,
                    bool absolute_patterns);

/// The inverse for a scene file in `folder`: relative where the path was, or where it lies below the folder.
/// resolve_paths(unresolve_paths(v)) == v.
Value unresolve_paths(const Value& value, const ParameterSpec& spec, const std::filesystem::path& folder);

}  // namespace astrosplat

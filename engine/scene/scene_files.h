// The files that a scene is made of, which are watched while it is open, asked for before a run, and hashed;
// and paths as scene files write them: relative to the file, with ${NAME} for environment variables.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// The files that a source names: meshes, textures, pictures of masks, splats, catalogues. Not what is built
/// in.
std::vector<std::filesystem::path> named_files(const SourceParams& source);
/// The same with what an OBJ brings of its own: material libraries and their pictures. Reads it.
std::vector<std::filesystem::path> all_files(const SourceParams& source);
/// A mesh from a file that takes the pictures its own materials name.
bool has_own_pictures(const MeshInput& input);

/// Those of a scene beside its layers' sources: thickness maps and pictures of the sky.
std::vector<std::filesystem::path> picture_files(const Scene& scene);

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

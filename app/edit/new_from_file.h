// What a file that is dropped on the window or named on the command line becomes. In: a picture, mesh or
// splat file. Out: the text of a first scene that shows it.
#pragma once

#include <filesystem>
#include <string>

#include "core/file_format.h"

namespace astrosplat {

/// By content or ending (core/file_format.h); a .toml is a look when it has a [look] or [render] and no
/// layers, else a scene. Unreadable files are what their ending says.
FileKind kind_of_file(const std::filesystem::path& file);

/// The text of a scene file `place` around a picture (on the built-in plane), an OBJ (with its own pictures,
/// else with the picture of the same name beside it or the only one in its folder; projected along its
/// thinnest axis where it has no texture coordinates) or a splat file (dots of half the mean spacing where it
/// has no radii). Reads the mesh, and splat files without radii, as a whole. Throws InputError for other
/// files, looks among them, and for a mesh without pictures.
std::string scene_text_for(const std::filesystem::path& file, const std::filesystem::path& place);

}  // namespace astrosplat

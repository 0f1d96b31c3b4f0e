// First scenes for a file that is dropped on the window or named on the command line, and for a built-in
// shape. In: a picture, mesh or splat file, or a name. Out: the text of a first scene that shows it.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "core/file_format.h"
#include "scene/scene.h"

namespace astrosplat {

/// By content or ending (core/file_format.h); a .toml is a look when it has a [look] or [render] and no
/// layers, else a scene. Unreadable files are what their ending says.
FileKind kind_of_file(const std::filesystem::path& file);

/// The text of a scene file `place` around a picture (on the built-in plane), an OBJ (with its own pictures,
/// else with the picture of the same name beside it or the only one in its folder, else in neutral grey;
/// projected along its thinnest axis where it has no texture coordinates) or a splat file (radii of half the
/// mean spacing where it has no radii). Reads the mesh, and splat files without radii, as a whole. Throws
/// InputError for other files, looks among them.
std::string scene_text_for(const std::filesystem::path& file, const std::filesystem::path& place);

/// Built-in shapes that need no picture of their own.
inline constexpr std::array shape_names{"plane", "disk",   "sphere",    "spheroid",
                                        "shell", "bubble", "hourglass", "ring"};
/// The same as menus have them.
inline constexpr std::array shape_labels{"Plane", "Disk",   "Sphere",    "Spheroid",
                                         "Shell", "Bubble", "Hourglass", "Ring"};
static_assert(shape_names.size() == shape_labels.size());

/// The text of a scene of one such shape in neutral grey, and of one without layers.
std::string shape_scene_text(const std::string& shape);
std::string empty_scene_text();

/// Neutral grey stands for the picture of the layer's first mesh. Reads the mesh where it may have pictures
/// of its own; throws InputError.
bool lacks_picture(const LayerParams& layer);

}  // namespace astrosplat

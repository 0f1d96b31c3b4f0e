// Edits of a scene's list of layers. Names stay unique and valid; tracks follow a layer's name. And first
// scenes for a file that is dropped on the window or named on the command line, and for a built-in shape.
#pragma once

#include "core/file_format.h"
#include "scene/scene.h"

namespace astrosplat {

/// Null: there is none of that name.
const LayerParams* find_layer(const Scene& scene, const std::string& name);
/// A name like `wanted` that no layer has and that scene files allow.
std::string free_layer_name(const Scene& scene, const std::string& wanted);
/// A layer for a picture (on the built-in plane), a mesh (with its own texture) or a splat file, at the end
/// of the list. Throws InputError for another kind of file. Returns its index.
std::size_t add_layer(Scene& scene, const fs::path& file);
/// The same of one of shape_names, in neutral grey.
std::size_t add_shape(Scene& scene, const std::string& shape);
std::size_t duplicate_layer(Scene& scene, std::size_t index);
void remove_layer(Scene& scene, std::size_t index);
void move_layer(Scene& scene, std::size_t from, std::size_t to);
/// Throws InputError where the name is taken or not valid.
void rename_layer(Scene& scene, std::size_t index, const std::string& name);

/// Look and render of a preset file (see save_preset_text) put on a layer. Throws InputError.
void apply_preset(LayerParams& layer, const fs::path& preset);

/// What is copied from one scene into another, keyframes included, as text for the clipboard.
enum class CopiedKind { layer, look, camera };
/// A scene of that alone; its paths are valid anywhere on this machine.
std::string copied_text(const Scene& scene, CopiedKind kind, std::size_t layer);
/// None for any other text.
std::optional<CopiedKind> copied_kind(std::string_view text);
/// A layer comes above `layer` under a name that is free, a look takes the place of its look, a camera that
/// of the camera, keyframes included. Returns the layer that it is about. Throws InputError.
std::size_t paste_text(Scene& scene, const std::string& text, std::size_t layer);

bool is_visible(const Scene& scene, std::size_t index, double frame);

/// By content or ending (core/file_format.h); a .toml is a look when it has a [look] or [render] and no
/// layers, else a scene. Unreadable files are what their ending says.
FileKind kind_of_file(const fs::path& file);

/// The text of a scene file `place` around a picture (on the built-in plane), an OBJ (with its own pictures,
/// else with the picture of the same name beside it or the only one in its folder, else in neutral grey;
/// projected along its thinnest axis where it has no texture coordinates) or a splat file (radii of half the
/// mean spacing where it has no radii). Reads the mesh, and splat files without radii, as a whole. Throws
/// InputError for other files, looks among them.
std::string scene_text_for(const fs::path& file, const fs::path& place);

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

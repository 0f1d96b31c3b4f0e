// A first scene around a picture: what `astrosplat new` writes and what the viewer opens for a picture.
#pragma once

#include <filesystem>
#include <string>

namespace astrosplat {

/// The commented text of a scene file `file` that shows `image` on a built-in shape: plane, relief, disk or
/// sphere. Throws InputError for another shape.
std::string new_scene_text(const std::filesystem::path& image, const std::string& shape,
                           const std::filesystem::path& file);

/// Letters, digits and _ of a file's or person's name, beginning with a letter; `otherwise` where none is
/// left.
std::string layer_name_of(const std::string& text, const char* otherwise = "layer");

}  // namespace astrosplat

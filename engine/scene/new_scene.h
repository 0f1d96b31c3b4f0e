// A first scene around a picture: on a shape of columns: what `astrosplat new --shape` writes.
#pragma once

#include <filesystem>
#include <string>

namespace astrosplat {

/// The commented text of a scene file `file` that shows `image` on a built-in shape: plane, relief, disk or
/// sphere. Throws InputError for another shape.
std::string new_scene_text(const std::filesystem::path& image, const std::string& shape,
                           const std::filesystem::path& file);

/// The path of a picture as a scene in `file` writes it.
std::string picture_path(const std::filesystem::path& image, const std::filesystem::path& file);

/// Letters, digits and _ of a file's or person's name, beginning with a letter; `otherwise` where none is
/// left.
std::string layer_name_of(const std::string& text, const char* otherwise = "layer");

}  // namespace astrosplat

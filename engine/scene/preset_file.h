// Files of keys that hold before a scene's own: looks of layers, and outputs for kinds of screens. In: what a
// scene calls them, and the parameters they may name. Out: those parameters changed, and where each was set.
// Include in .cpp files only, as toml_read.h.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "scene/parameter.h"
#include "scene/parameter_key.h"
#include "scene/toml_read.h"

namespace astrosplat {

/// Throws InputError unless the table says `astrosplat = 1`; where it is not `required`, it may say nothing.
void check_version(const toml::table& table, const std::string& file, bool required);

struct PresetFile {
    std::filesystem::path file;
    std::string text;
};

/// A file, or the short name of a look of one's own or that comes with the program. Throws InputError.
PresetFile find_look(const std::filesystem::path& wanted);

/// The same for a kind of screen; a scene beside this one may have the short name, too. Throws InputError.
PresetFile find_output_preset(const std::filesystem::path& wanted);

/// Sets the preset's keys in what `describe` lists, anew each time it is called. Throws InputError, and
/// nothing is set then.
void apply_preset(const PresetFile& preset, const std::function<Description()>& describe, Places& places);

}  // namespace astrosplat

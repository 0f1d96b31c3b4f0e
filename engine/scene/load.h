// Scene files (TOML) to Scene values. Precedence: defaults < preset < scene < animation < camera.file < --set
// < window. Every error is one line with file, line and the nearest known key;
// nothing half-loaded is ever returned.
#pragma once

#include "scene/parameter.h"
#include "scene/parameter_key.h"
#include "scene/scene.h"

namespace astrosplat {

/// One `--set KEY=VALUE`; VALUE is TOML (a bare word is taken as a string).
struct Assignment {
    ParameterKey key;
    std::string value;
};
Assignment parse_assignment(const std::string& text);

/// A typed value: TOML where it is TOML, otherwise the text itself, also for dates and
/// tables, which no parameter takes.
Value typed_value(const std::string& text);

/// Loads a scene and applies the assignments. Paths inside the file are resolved against its folder, those of
/// assignments against the working directory; ${NAME} is an environment variable. The camera file is read
/// (camera_file.h). Throws InputError.
Scene load_scene(const fs::path& file, std::span<const Assignment> assignments = {});

/// A scene and where its keys were last set, for messages about what is found out later.
struct PlacedScene {
    Scene scene;
    Places places;
};
PlacedScene load_placed(const fs::path& file, std::span<const Assignment> assignments = {});

/// The same from text in memory; `file` names it in messages and resolves its paths.
Scene parse_scene(const std::string& toml, const fs::path& file,
                  std::span<const Assignment> assignments = {});

/// parse_scene without the rules between parameters (check.h) and without its camera file, for texts on their
/// way to becoming a scene.
Scene parse_unchecked(const std::string& toml, const fs::path& file);

}  // namespace astrosplat

// camera.file: another program's camera becomes tracks of the scene, which win over those of [animation].
#pragma once

#include <string>

#include "scene/scene.h"

namespace astrosplat {

/// Reads the file that camera.file names into scene.imported; nothing where it names none. `place` of the
/// key begins the message of a file that cannot be read at all. Throws InputError.
void attach_camera_file(Scene& scene, const std::string& place);

/// The same where the scene's keys ask for other tracks than those it has.
void refresh_camera_file(Scene& scene, const std::string& place);

/// The tracks of a camera file, for a scene that has its keys camera.file_*. Lists of the scene grow where a
/// table names their next element. Throws InputError.
std::vector<Track> camera_file_tracks(Scene& scene, const std::filesystem::path& file);

}  // namespace astrosplat

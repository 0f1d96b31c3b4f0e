// The tracks of a scene's camera.file, which win over those of [animation]. In: another program's camera, or
// a .csv whose header names `frame` and keys of the scene, numbers of a vector as KEY.x, KEY.y, KEY.z (w),
// colours as KEY.r, KEY.g, KEY.b. Out: tracks; and the text of such a table.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "camera_files/camera_track.h"
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

/// One linear track per key, in the order of the header; booleans, choices and whole numbers step. Columns
/// are separated by commas, semicolons or tabs, numbers have decimal points. Lists of the scene grow where a
/// key names their next element. Throws InputError for keys that cannot be animated, values out of range and
/// frames that do not ascend.
std::vector<Track> read_csv_tracks(const std::filesystem::path& file, const FrameRate& rate, Scene& scene);

/// The text of such a file: one row for every frame, of tracks that have a keyframe at each of these frames.
std::string csv_text(const std::vector<Track>& tracks);

}  // namespace astrosplat

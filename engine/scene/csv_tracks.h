// Tracks from a table: a .csv whose header names `frame` and keys of the scene, numbers of a vector as
// KEY.x, KEY.y, KEY.z (w), colours as KEY.r, KEY.g, KEY.b.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "camera_files/camera_track.h"
#include "scene/scene.h"

namespace astrosplat {

/// One linear track per key, in the order of the header; booleans, choices and whole numbers step. Columns
/// are separated by commas, semicolons or tabs, numbers have decimal points. Lists of the scene grow where a
/// key names their next element. Throws InputError for keys that cannot be animated, values out of range and
/// frames that do not ascend.
std::vector<Track> read_csv_tracks(const std::filesystem::path& file, const FrameRate& rate, Scene& scene);

/// The text of such a file: one row for every frame, of tracks that have a keyframe at each of these frames.
std::string csv_text(const std::vector<Track>& tracks);

}  // namespace astrosplat

// Camera files of every kind that is read as samples, told apart by the ending of their name.
#pragma once

#include "camera_files/camera_track.h"

namespace astrosplat {

/// Whether the name ends as one of such files does, in capitals or not (core/file_format.h).
bool is_camera_file(const std::filesystem::path& file);

/// A file of one of these endings. Throws InputError, one line with file, line (where the format has lines),
/// expectation and finding.
CameraTrack read_camera(const std::filesystem::path& file, const FrameRate& rate);

}  // namespace astrosplat

// .chan, the camera files of Nuke, Maya, Houdini and Blender: one line a frame, "frame tx ty tz rx ry rz
// [fov]", angles in degrees applied in the order z, x, y (Nuke's ZXY), fov vertical, y up.
#pragma once

#include "camera_files/camera_track.h"

namespace astrosplat {

/// Throws InputError.
CameraTrack read_chan(const std::filesystem::path& file, const FrameRate& rate);

/// The text of a file with these samples; the field of view is written where the track has one.
std::string chan_text(const CameraTrack& track);

}  // namespace astrosplat

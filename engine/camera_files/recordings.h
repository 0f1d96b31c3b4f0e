// Recordings of flights: Gaia Sky's .gsc and OpenSpace's text recordings. In: the file. Out: samples; the
// places of both are in the file's units, metres in OpenSpace, 1e9 m in Gaia Sky.
#pragma once

#include "camera_files/camera_track.h"

namespace astrosplat {

/// "time x y z, direction, up" in every line, one line a frame from frame 1 on, 60 a second unless
/// rate.file_fps says otherwise (the time is that of the sky, which may stand still). Without a field of
/// view. Throws InputError.
CameraTrack read_gaia_sky(const std::filesystem::path& file, const FrameRate& rate);

/// Formats 1.00, 2.00 and 3.00 as text. Seconds since the recording's start become frames, frame 1 at 0 s;
/// lines that are no camera's are skipped, as are further ones at one time. Places are relative to a body:
/// where that is not the same all the time, a warning tells. Without a field of view. Throws InputError.
CameraTrack read_openspace(const std::filesystem::path& file, const FrameRate& rate);

}  // namespace astrosplat

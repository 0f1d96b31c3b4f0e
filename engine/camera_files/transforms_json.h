// transforms.json: the cameras of a capture, as NeRF and its successors keep them.
#pragma once

#include "camera_files/camera_track.h"

namespace astrosplat {

/// One sample for each of its frames, at frames 1, 2, ... in the file's order; z is up. Their
/// transform_matrix is world from camera, its camera looks along -z. The field of view is that of fl_y and h,
/// or fl_x and w, of the frame or of all; else camera_angle_y; else camera_angle_x, of square pictures unless
/// w and h are told. Without any of these there is none. Throws InputError.
CameraTrack read_transforms_json(const std::filesystem::path& file, const FrameRate& rate);

}  // namespace astrosplat

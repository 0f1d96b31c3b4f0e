// Cameras of USD as text (.usda): UsdGeomCamera as Blender, Houdini and we ourselves (usda.h) write it. In:
// the file. Out: samples at whole frames and wherever the file has one.
#pragma once

#include "camera_files/camera_track.h"

namespace astrosplat {

/// The first camera that a .usda or .usd defines, moved by its own and its parents' transforms (xformOps of
/// every kind, in their order). A time code is a frame of the output, or as many as output_fps is to
/// file_fps or to the file's own timeCodesPerSecond. One sample at every time code that anything has one at
/// and at every whole one between, one in all where nothing moves. The field of view is that of focalLength
/// and verticalAperture; without a focalLength there is none. Places stay in the file's units whatever its
/// metersPerUnit; up is its upAxis. Nothing that the file refers to is opened. Throws InputError.
CameraTrack read_usda(const std::filesystem::path& file, const FrameRate& rate);

}  // namespace astrosplat

// The scene's camera, frame by frame, for other programs. In: a scene with its animation and camera file.
// Out: samples, and the text of a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "camera_files/camera_track.h"
#include "scene/scene.h"

namespace astrosplat {

/// The camera at each of these ascending frames: in scene units, y up, between a pair's eyes, before a
/// fisheye's tilt. With fov where it is perspective at all of them, with height where it is orthographic at
/// all; projections may change to no other kind in between. Throws InputError where the camera has no place
/// of its own but frames its layers.
CameraTrack camera_track(const Scene& scene, std::span<const std::int64_t> frames);

/// The text of a file whose name ends in .chan, .csv, .gltf or .usda. camera.file reads .chan and .csv
/// back within 1e-6, .gltf within a float's precision. Throws InputError for other names.
std::string camera_text(const CameraTrack& track, const Scene& scene, const std::filesystem::path& file);

}  // namespace astrosplat

// Cameras of other programs. In: a scene's camera.file, whose tracks win over those of [animation]: another
// program's camera, or a .csv whose header names `frame` and keys of the scene, numbers of a vector as KEY.x,
// KEY.y, KEY.z (w), colours as KEY.r, KEY.g, KEY.b. Out: the scene's camera, frame by frame, as the text of
// such a file.
#pragma once

#include "camera_files/camera_track.h"
#include "scene/scene.h"

namespace astrosplat {

/// Reads the file that camera.file names into scene.imported; nothing where it names none. `place` of the
/// key begins the message of a file that cannot be read at all. Throws InputError.
void attach_camera_file(Scene& scene, const std::string& place);

/// The same where the scene's keys ask for other tracks than those it has.
void refresh_camera_file(Scene& scene, const std::string& place);

/// A line that tells where the camera file's frames meet none of `frames`, and the camera.file_offset that
/// would fit; empty where they do, or nothing moves.
std::string missed_camera_frames(const Scene& scene, std::span<const std::int64_t> frames);

/// One linear track per key, in the order of the header; booleans, choices and whole numbers step. Columns
/// are separated by commas, semicolons or tabs, numbers have decimal points. Lists of the scene grow where a
/// key names their next element. Throws InputError for keys that cannot be animated, values out of range and
/// frames that do not ascend.
std::vector<Track> read_csv_tracks(const fs::path& file, const FrameRate& rate, Scene& scene);

/// The text of such a file: one row for every frame, of tracks that have a keyframe at each of these frames.
std::string csv_text(const std::vector<Track>& tracks);

/// The camera at each of these ascending frames: in scene units, y up, between a pair's eyes, before a
/// fisheye's tilt. With fov where it is perspective at all of them, with height where it is orthographic at
/// all; projections may change to no other kind in between. Throws InputError where the camera has no place
/// of its own but frames its layers.
CameraTrack camera_track(const Scene& scene, std::span<const std::int64_t> frames);

/// The text of a file whose name ends in .chan, .csv, .gltf or .usda. camera.file reads .chan and .csv
/// back within 1e-6, .gltf within a float's precision; warnings tell of lenses that a format cannot hold.
/// Throws InputError for other names.
std::string camera_text(const CameraTrack& track, const Scene& scene, const fs::path& file);

}  // namespace astrosplat

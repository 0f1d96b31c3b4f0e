// glTF 2.0: the animated camera of a .gltf or .glb, as Blender and Houdini write them. In: the file, with the
// buffers that lie in it or beside it. Out: samples at whole frames.
#pragma once

#include <string>

#include "camera_files/camera_track.h"

namespace astrosplat {

/// The first node with a camera, moved by its own and its parents' transforms and by the first animation that
/// moves any of them; a second of the file is output_fps frames, from frame 0 on (file_fps is not used). One
/// sample at every whole frame that the animation touches, one in all where nothing moves. Throws InputError.
CameraTrack read_gltf(const std::filesystem::path& file, const FrameRate& rate);

/// A .gltf with one animated camera and all its bytes inside. Its field of view or height is that of the
/// first sample, for glTF moves none; places and turns have a float's precision. `aspect`: width / height;
/// frames are not negative (InputError).
std::string gltf_text(const CameraTrack& track, double aspect, double near, double far);

}  // namespace astrosplat

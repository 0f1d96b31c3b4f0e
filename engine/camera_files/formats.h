// Cameras of other programs, one reader (and the text of a file, where we write one) each. In and out:
// CameraTrack. Readers throw InputError with the file and, where the format has lines, the line.
//
// A new format: its functions here and in a file of their own, a row in camera_track.cpp,
// and its ending in core/file_format.cpp.
#pragma once

#include "camera_files/camera_track.h"

namespace astrosplat {

/// Turns the sample, and tells once of mirrored and of sheared axes in the track's warnings. Returns false
/// where the axes span no space.
bool set_axes(const glm::dmat3& world_from_camera, const std::string& file, TrackSample& sample,
              CameraTrack& track);

/// .chan, the camera files of Nuke, Maya, Houdini and Blender: one line a frame, "frame tx ty tz rx ry rz
/// [fov]", angles in degrees applied in the order z, x, y (Nuke's ZXY), fov vertical, y up.
CameraTrack read_chan(const fs::path& file, const FrameRate& rate);
/// The field of view is written where the track has one.
std::string chan_text(const CameraTrack& track);

/// The animated camera of a .gltf or .glb, as Blender and Houdini write them, with the buffers that lie in it
/// or beside it: the first node with a camera of the scene that the file shows, moved by its own and its
/// parents' transforms and by all animations that move any of them or the lens (KHR_animation_pointer); one
/// that moves again what another moves is told and left out. A second of the file is output_fps frames, from
/// frame 0 on (file_fps is not used). One sample at every whole frame that the animations touch, one in all
/// where nothing moves.
CameraTrack read_gltf(const fs::path& file, const FrameRate& rate);
/// A .gltf with one animated camera and all its bytes inside. Its field of view or height is that of the
/// first sample, for glTF moves none; places and turns have a float's precision. `aspect`: width / height;
/// frames are not negative (InputError).
std::string gltf_text(const CameraTrack& track, double aspect, double near, double far);

/// The first camera that a .usda or .usd defines, in the variants that it selects, moved by its own and its
/// parents' transforms (xformOps of every kind, in their order). A time code is a frame of the output, or as
/// many as output_fps is to file_fps or to the file's own timeCodesPerSecond. One sample at every time code
/// that anything has one at and at every whole one between, one in all where nothing moves. The field of view
/// and the shift are those of focalLength and the apertures, USD's own where the file says none. Places stay
/// in the file's units whatever its metersPerUnit; up is its upAxis. Nothing that the file refers to is
/// opened.
CameraTrack read_usda(const fs::path& file, const FrameRate& rate);
/// Values of a camera in USD besides its samples.
struct UsdLens {
    double aspect = 1.0;            // width / height
    double near = 0.01, far = 0.0;  // scene units; far 0: none
};
/// A stage with one camera, y up, whose transform, focal length (24 mm of film from bottom to top, as tenths
/// of scene units) or apertures, and offsets of the aperture where it is shifted, have a time sample at every
/// frame.
std::string usda_text(const CameraTrack& track, const UsdLens& lens);

/// Gaia Sky's recordings of flights (.gsc): "time x y z, direction, up" in every line, one line a frame from
/// frame 1 on, 60 a second unless rate.file_fps says otherwise (the time is that of the sky, which may stand
/// still). Units are 1e9 m. Without a field of view.
CameraTrack read_gaia_sky(const fs::path& file, const FrameRate& rate);

/// OpenSpace's recordings, formats 1.00, 2.00 and 3.00 as text. Seconds since the recording's start become
/// frames, frame 1 at 0 s; lines that are no camera's are skipped, as are further ones at one time. Places,
/// in metres, are relative to a body: where that is not the same all the time, a warning tells. Without a
/// field of view.
CameraTrack read_openspace(const fs::path& file, const FrameRate& rate);

/// transforms.json, the cameras of a capture as NeRF and its successors keep them: one sample for each of its
/// frames, at frames 1, 2, ... in the order of the last numbers in their files' names, in the file's order
/// where some have none or the same; z is up. Their transform_matrix is world from camera, its camera looks
/// along -z. The field of view is that of fl_y and h, or fl_x and w, of the frame or of all; else
/// camera_angle_y; else camera_angle_x, of square pictures unless w and h are given. Without any of these
/// there is none. cx and cy shift a perspective frame; OPENCV_FISHEYE is an equidistant fisheye, whose cone
/// is that of the picture's shorter side. Distortions, and what scales places or axes, are told and left out;
/// applied_transform and applied_scale, which the matrices have, change nothing.
CameraTrack read_transforms_json(const fs::path& file, const FrameRate& rate);

}  // namespace astrosplat

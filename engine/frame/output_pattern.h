// Where frames go: a folder, which is taken as it is, and a name below it with places for the frame's number
// and the eye. Batch, verify, farm and window all ask here.
#pragma once

#include "camera/camera.h"

namespace astrosplat {

/// In `name`, "####", "%04d" and "{frame:04}" stand for the frame's number, padded with zeros, at one place
/// at most; "%V" for the eye and "%v" for its first letter. In `folder` these are letters as any others.
struct OutputPattern {
    fs::path folder;
    std::string name;  // "shot.####.exr", "%V/shot.%v.%04d.exr"

    /// The file of a frame: frame 12 of "shot.####.exr" is "shot.0012.exr". Negative numbers keep the width,
    /// with a minus sign in front. Throws InputError where the name has several places for the number.
    fs::path resolve(std::int64_t frame, Eye eye = Eye::centre) const;

    /// The name has a place for the frame's number; for the eye: then frames are pairs.
    bool is_numbered() const;
    bool is_stereo() const;

    /// The innermost folder that holds all frames.
    fs::path common_folder() const;
    /// The name's last part up to the places, and without what joined them: "shot" of "shot_%V.####.exr";
    /// "frame" where nothing is left.
    std::string stem() const;

    /// Folder and name, as output_pattern reads them.
    std::string text() const { return (folder / name).string(); }
};

/// A pattern as written, relative to `base`. Folders at its beginning that exist are taken as they are,
/// whatever their names: "C#1/shot.####.exr". Throws InputError where the rest has several places
/// for the number.
OutputPattern output_pattern(const fs::path& base, const std::string& text);

/// The eyes that every frame is rendered for: both where the pattern has a place for them, else the camera's.
/// Throws InputError where the camera has no two.
std::vector<Eye> eyes_of(const OutputPattern& pattern, const CameraParams& camera);

}  // namespace astrosplat

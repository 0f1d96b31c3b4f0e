// Frame numbers in file names.
#pragma once

#include <cstdint>
#include <string>

#include "camera/camera.h"

namespace astrosplat {

/// "frames/shot.####.exr" with frame 12 gives "frames/shot.0012.exr"; also %04d and {frame:04}. Negative
/// frames keep the width with a minus sign in front. %V becomes the eye, %v its first letter: "shot.%V.exr"
/// gives "shot.left.exr". Throws InputError where a pattern has several places for the number.
std::string frame_file(const std::string& pattern, std::int64_t frame, Eye eye = Eye::centre);

/// The pattern has a place for the frame's number.
bool has_frame_token(const std::string& pattern);

/// The pattern has a place for the eye: frames are pairs.
bool has_eye_token(const std::string& pattern);

}  // namespace astrosplat

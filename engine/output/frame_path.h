// Frame numbers in file names.
#pragma once

#include <cstdint>
#include <string>

namespace astrosplat {

/// "frames/shot.####.exr" with frame 12 gives "frames/shot.0012.exr"; also %04d and {frame:04}. Negative
/// frames keep the width with a minus sign in front. Throws InputError where a pattern has several places for
/// the number.
std::string frame_file(const std::string& pattern, std::int64_t frame);

/// The pattern has a place for the frame's number.
bool has_frame_token(const std::string& pattern);

}  // namespace astrosplat

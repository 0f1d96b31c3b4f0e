// Lists of frames as people write them: "1-100,120,200-300x2".
#pragma once

#include "core/standard.h"

namespace astrosplat {

/// Frames of "1-100,120,200-300x2" (x or : is the step; negative numbers allowed), ascending, each once.
/// Throws InputError naming `place`.
std::vector<std::int64_t> parse_frames(const std::string& text, const std::string& place);

/// The other way round, short: "1-100,120,200-300x2" of ascending frames, each once; empty of none.
std::string frames_text(const std::vector<std::int64_t>& frames);

}  // namespace astrosplat

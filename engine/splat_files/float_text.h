// Floats to decimal text, the counterpart of number_scan.h. In: a value and room. Out: the very characters
// that std::to_chars writes, in half its time for the values that splats have, because std::to_chars alone
// would set the speed of writing a particle file.
#pragma once

#include <cstddef>

namespace astrosplat {

/// put_float() may write this many bytes from `out` on, however short the text is.
inline constexpr std::size_t float_text_room = 20;

/// The shortest text that reads back as the same float, the nearest of them if there are several; fixed or
/// scientific, whichever is shorter. Returns the end of the text.
char* put_float(char* out, float value);

}  // namespace astrosplat

// Floats to decimal text, the counterpart of number_scan.h. In: a value and room. Out: the very characters
// that std::to_chars writes, for the values that splats have in half the time of it and of fmt: 680 MB/s a
// thread where they write 325 and 360. With std::to_chars a particle file was written at 630 instead of
// 910 MB/s, so the library's writer is left to the other values.
#pragma once

#include <cstddef>

namespace astrosplat {

/// put_float() may write this many bytes from `out` on, however short the text is.
inline constexpr std::size_t float_text_room = 20;

/// The shortest text that reads back as the same float, the nearest of them if there are several; fixed or
/// scientific, whichever is shorter. Returns the end of the text.
char* put_float(char* out, float value);

}  // namespace astrosplat

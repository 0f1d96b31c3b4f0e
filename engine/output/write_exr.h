// Frames as EXR through OpenEXR itself, which is there in a few milliseconds: one part, each channel in its
// own format. In: a frame. Out: a file that appears whole or not at all.
#pragma once

#include "output/format.h"
#include "output/write.h"

namespace astrosplat {

/// Writes a frame whose values are finite. Throws OutputError; AlreadyExists as AtomicFile does.
void write_exr(const FrameFile& target, const FrameFormat& format, const RenderedFrame& frame,
               const FrameMetadata& metadata);

}  // namespace astrosplat

// PNG frames, by libpng.
#pragma once

#include "output/format.h"
#include "output/metadata.h"
#include "output/write.h"

namespace astrosplat {

/// Throws as write_frame() does.
void write_png(const FrameFile& target, const FrameFormat& format, const Image& beauty,
               const FrameMetadata& metadata);

std::optional<StoredHeader> read_png_header(const std::filesystem::path& file);
/// True when the file was read to its end. False says nothing of interlaced ones.
bool png_is_whole(const std::filesystem::path& file);

}  // namespace astrosplat

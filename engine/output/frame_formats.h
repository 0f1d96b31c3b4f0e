// Frames in their three file formats, each through the format's own library, which starts in a few
// milliseconds (OpenImageIO takes a fifth of a second): EXR with each channel in its own type, TIFF with
// strips that are deflated here, on all threads, and PNG. In: a frame. Out: a file that appears whole or not
// at all; of a file its header, and whether it is whole.
#pragma once

#include "output/format.h"
#include "output/metadata.h"
#include "output/write.h"

namespace astrosplat {

/// Write a frame whose values are finite, TIFF and PNG its beauty alone. Throw OutputError; AlreadyExists as
/// AtomicFile does.
void write_exr(const FrameFile& target, const FrameFormat& format, const RenderedFrame& frame,
               const FrameMetadata& metadata);
void write_tiff(const FrameFile& target, const FrameFormat& format, const RenderedFrame& frame,
                const FrameMetadata& metadata);
void write_png(const FrameFile& target, const FrameFormat& format, const RenderedFrame& frame,
               const FrameMetadata& metadata);

/// Nothing where the file is none of the format, or damaged.
std::optional<StoredHeader> read_exr_header(const fs::path& file);
std::optional<StoredHeader> read_tiff_header(const fs::path& file);
std::optional<StoredHeader> read_png_header(const fs::path& file);

/// True when the file was read to its last pixel. False says nothing of forms that no frame is written in:
/// tiles, several parts, interlacing.
bool exr_is_whole(const fs::path& file);
bool tiff_is_whole(const fs::path& file);
bool png_is_whole(const fs::path& file);

struct FrameFileFormat {
    std::string_view id;  // of core/file_format.h
    decltype(&write_exr) write;
    decltype(&read_exr_header) read_header;
    decltype(&exr_is_whole) is_whole;
};

/// By FrameKind.
inline constexpr FrameFileFormat frame_file_formats[] = {
    {"openexr", write_exr, read_exr_header, exr_is_whole},
    {"tiff", write_tiff, read_tiff_header, tiff_is_whole},
    {"png", write_png, read_png_header, png_is_whole}};

}  // namespace astrosplat

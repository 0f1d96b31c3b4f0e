// EXR frames written and read back through OpenEXR itself, which starts in a few milliseconds: one part, each
// channel in its own format. In: a frame. Out: a file that appears whole or not at all; of a file its header,
// and whether it is whole.
#pragma once

#include <ImfThreading.h>

#include <exception>
#include <filesystem>
#include <optional>

#include "core/parallel.h"
#include "output/format.h"
#include "output/metadata.h"
#include "output/write.h"

namespace astrosplat {

std::optional<StoredHeader> read_exr_header(const std::filesystem::path& file);
/// True when the file was read to its last pixel. False says nothing of files with tiles or several parts.
bool exr_is_whole(const std::filesystem::path& file);

/// Writes a frame whose values are finite. Throws OutputError; AlreadyExists as AtomicFile does.
void write_exr(const FrameFile& target, const FrameFormat& format, const RenderedFrame& frame,
               const FrameMetadata& metadata);

/// The threads that OpenEXR may pack and unpack pixels with: as many as the program's own; none where there
/// are none to be had, and it does without.
inline int exr_threads() {
    try {
        if (Imf::globalThreadCount() != thread_count()) Imf::setGlobalThreadCount(thread_count());
        return Imf::globalThreadCount();
    } catch (const std::exception&) {
        return 0;
    }
}

}  // namespace astrosplat

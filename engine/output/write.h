// Frame files: EXR, TIFF, PNG with the alpha rule, view transform, dither and metadata of DESIGN 7-9, written
// atomically (temporary name, fsync, rename).
#pragma once

#include "camera/camera.h"
#include "core/atomic_file.h"
#include "core/image.h"
#include "render/frame.h"
#include "scene/scene.h"
#include "source/object_metadata.h"

namespace astrosplat {

/// The header of a frame.
struct FrameMetadata {
    std::int64_t frame = 1;
    Eye eye = Eye::centre;
    double fps = 24.0;
    std::string frame_hash;   // hex
    std::string pixel_hash;   // hex
    std::string hashed_text;  // what frame_hash was made of (frame_hash.h)
    std::uint32_t seed = 0;
    ProvenanceParams provenance;  // as resolved() has it
    ObjectMetadata sources;       // merged
    std::string origin;           // what of its layers is measured and what is invented
    std::optional<ExrMatrices> matrices;
};

/// Where a frame goes, and as what.
struct FrameFile {
    fs::path file;  // its ending chooses the format
    OutputParams output;
    std::int64_t whole_width = 0, whole_height = 0;  // px, of the whole frame
    Region region{};                                 // where the frame lies in it (EXR: the data window)
    std::vector<std::string> layer_names{};          // of RenderedFrame::layers
    Existing existing = Existing::replace;
};

/// Writes one frame. Throws OutputError; AlreadyExists as AtomicFile does.
void write_frame(const FrameFile& target, const RenderedFrame& frame, const FrameMetadata& metadata);

/// sha256 of the pixels' float bytes (beauty, row by row, RGBA).
std::string pixel_hash(const Image& image);

}  // namespace astrosplat

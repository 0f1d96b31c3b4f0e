// The frame hash: one number for all that reaches a frame's pixels, and nothing else (DESIGN 8). Equal hashes
// mean that rendering again would give the same pixels, so --resume skips the frame.
#pragma once

#include <map>

#include "core/file.h"
#include "core/image.h"
#include "core/progress.h"
#include "frame/frame_scene.h"
#include "scene/parameter.h"

namespace astrosplat {

/// Raised whenever the program's own arithmetic changes a pixel of any scene.
inline constexpr int pixel_version = 5;

/// Input files as they were when they were hashed.
struct HashedFile {
    std::string hash;
    FileStamp stamp;
};
using HashedFiles = std::map<fs::path, HashedFile>;

/// To be called once the files are loaded. Throws InputError where one has other bytes now: what was loaded
/// may not be what was hashed; Cancelled.
void check_unchanged(const HashedFiles& files, const Progress& progress = {});

/// Whether a key of the camera is of lenses other than this projection's, as its description says. The field
/// of view never is: it places a camera without a position, whatever its projection.
bool is_of_another_lens(const ParameterSpec& spec, Projection projection);

/// Hashes frames; input files are hashed by content, once each.
class FrameHasher {
  public:
    /// `region` as in RenderSettings: the part of the frames that is rendered; empty: all.
    explicit FrameHasher(const Region& region = {}) : region_(region) {}

    /// 64 hex digits. Throws InputError when an input file exists but cannot be read.
    std::string frame_hash(const FrameScene& frame);

    /// The hashed text: lines "key = value" of every parameter that reaches the frame, evaluated there, files
    /// as their content's hash; under an open shutter again "sample key = value" of all that moves. Left out:
    /// where and how often frames go (path, frames, fps, compression), provenance, the scene's scale (which
    /// stands in the unit of stars that it decides), presets (their values are
    /// in the scene), layers and environments that do not show at any moment, and the animation's keyframes.
    std::string canonical_text(const FrameScene& frame);

    /// All files that the hashes so far depend on.
    const HashedFiles& files() const { return files_; }

  private:
    std::string file_text(const fs::path& file);
    std::string line(const Parameter& parameter);
    std::string ocio_text(const DisplayTransform& ocio);
    std::string layer_text(const Scene& scene, const LayerParams& layer);

    Region region_;
    HashedFiles files_;
    std::map<fs::path, std::string> material_lists_;  // of meshes
};

}  // namespace astrosplat

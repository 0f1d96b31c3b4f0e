// The plan of a batch run, made before anything is touched: the scene with the command line applied, and for
// every frame its file, its hash and whether it is rendered.
#pragma once

#include "command.h"
#include "core/atomic_file.h"
#include "core/image.h"
#include "frame/frame_hash.h"
#include "frame/output_pattern.h"
#include "scene/scene.h"

namespace astrosplat {

struct FramePlan {
    std::int64_t frame = 0;
    Eye eye = Eye::centre;
    fs::path file;
    std::string hash;                       // frame hash, hex
    bool render = true;                     // false: a whole frame of this hash is there already
    Existing existing = Existing::replace;  // keep: nothing was there, and what comes is not replaced
};

struct BatchPlan {
    Scene scene;           // with the command line applied
    OutputPattern output;  // scene.output.path as a pattern
    Region region;
    std::int64_t memory_limit_bytes = 0;  // 0: none
    SetCache cache;
    std::vector<FramePlan> frames;  // ascending
    FrameHasher hasher;             // which knows the files that the frames' hashes were made of
    bool resume = false;            // frames of the right hash are as good as rendered ones
};

/// "--memory GiB" in bytes. Throws InputError.
std::int64_t parse_memory(const std::string& text);

/// Sets most_texels of a layer of bodies whose pictures would take more than `bytes` with the program, so
/// that it is made of smaller ones; a warning says so. The sizes follow from the pictures and `bytes` alone.
/// Throws as load_meshes does.
void limit_bodies(LayerParams& layer, std::int64_t bytes, const SetCache& cache);

/// How many of the frames are rendered.
std::int64_t count_to_render(const BatchPlan& plan);

/// The file at a frame's place: a whole frame of the planned hash, a picture that cannot be read to its end,
/// or anything else.
enum class Found { nothing, same, damaged, other };
Found found_at(const FramePlan& frame);

/// All of a plan but its frames. Throws InputError.
BatchPlan plan_scene(const CommandOptions& options);

/// The frames, all of them to be rendered, without a look at what lies at their places. Throws InputError.
BatchPlan plan_frames(const CommandOptions& options);

/// plan_frames, and then what becomes of frames that have files already. Throws InputError for bad input, and
/// where files are in the way that neither --resume nor --overwrite covers; OutputError where something else
/// than a file lies at a frame's place.
BatchPlan plan_batch(const CommandOptions& options);

}  // namespace astrosplat

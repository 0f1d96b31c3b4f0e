// Memory, time and bytes that a batch run will take, before it takes them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch_plan.h"
#include "sampled_run.h"

namespace astrosplat {

/// About how many splats the layers will have, and how many bytes are taken at most: while sets are made, or
/// by sets, shaded splats, screen splats and pictures.
struct JobEstimate {
    struct Layer {
        std::string name;
        std::int64_t splats = 0;
    };
    std::vector<Layer> layers;
    std::int64_t splats = 0;
    std::int64_t bytes = 0;
    std::optional<bool> sky_kept;  // of a scene whose sky is made of one picture: whether it is in the cache
    /// Layers of .splats files that stay on disk, because all in memory would be more than there may be.
    std::vector<std::string> streamed;
    /// For splats of meshes of which nobody knows yet where they lie, or into how many they are split.
    bool guesses_much = false;
    std::int64_t renderer_bytes = 0;  // what is left for RenderSettings::memory_limit_bytes; 0: any number
};
/// Loads meshes and pictures where `count` alone does not tell and the set is not in the cache, nothing else.
/// Throws InputError, also where --memory is less than what the job needs.
JobEstimate estimate(const BatchPlan& plan, SampledRun& sample);

/// The same with a sample of what is there, and of what is not where much would be guessed.
JobEstimate estimate(const BatchPlan& plan);

/// "--memory GiB" in bytes. Throws InputError.
std::int64_t parse_memory(const std::string& text);

/// Sets most_texels of a layer of bodies whose pictures would take more than `bytes` with the program, so
/// that it is made of smaller ones; a warning says so. The sizes follow from the pictures and `bytes` alone.
/// Throws as load_meshes does.
void limit_bodies(LayerParams& layer, std::int64_t bytes, const SetCache& cache);

}  // namespace astrosplat

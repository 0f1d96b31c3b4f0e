// Memory, time and bytes that a batch run will take, before it takes them; estimated from a run over a
// hundredth of its splats. In: a plan. Out: seconds, bytes of memory and bytes of files.
#pragma once

#include "batch_plan.h"
#include "pipeline.h"

namespace astrosplat {

/// Of one frame, a mean over some of the run.
struct FrameCost {
    double seconds = 0.0;
    std::optional<std::int64_t> file_bytes;  // none: there is no place to write a sample to
};

class SampledRun {
  public:
    /// The layers that are sampled: those whose sets are in the cache or in .splats files, for a quick
    /// answer; those of meshes too, whose sets are made small where they are missing; or all, for which other
    /// inputs are read, with the environment.
    enum class Layers { there, meshes, all };
    /// Layers that no frame shows and stars of a picture, which are few, are left out. Throws as load_source
    /// does, Cancelled.
    SampledRun(const BatchPlan& plan, Layers layers);

    struct Layer {
        std::string name;
        std::int64_t splats = 0;        // of the whole set, about
        bool is_made = false;           // was not there
        bool has_radius = false;        // of every splat
        std::int64_t making_bytes = 0;  // of bodies that are not there
    };
    /// Null: it was not sampled.
    const Layer* find(const std::string& name) const;

    /// Of all sets that are not there, about.
    double making_seconds() const { return making_seconds_; }

    /// Of the projected splats in the fullest of some frames.
    std::int64_t record_bytes();

    FrameCost frame_cost();

  private:
    FrameScene scene_of(const FramePlan& frame) const {
        return pipeline_.frame_scene(static_cast<double>(frame.frame), frame.eye);
    }
    RenderSettings settings(const FrameScene& frame) const;
    double seconds_of(Pipeline& pipeline, const FrameScene& frame, RenderedFrame& rendered) const;
    std::optional<std::int64_t> bytes_of(const fs::path& name, const FrameScene& frame,
                                         const RenderedFrame& rendered) const;

    const BatchPlan& plan_;
    std::vector<const FramePlan*> frames_;  // that are looked at
    std::vector<Layer> layers_;
    double making_seconds_ = 0.0;
    double each_ = 1.0;  // splats that a row stands for
    Pipeline pipeline_;
    Pipeline empty_;  // the same scene with a splat a layer
    RenderCache cache_;
};

/// About how many splats the layers will have, and how many bytes are taken at most: while sets are made, or
/// by sets, shaded splats, screen splats and images.
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
    /// Because of meshes: where their splats lie is not known yet, or into how many they are split.
    bool guesses_much = false;
    std::int64_t renderer_bytes = 0;  // what is left for RenderSettings::memory_limit_bytes; 0: any number
};
/// Loads meshes and pictures where `count` alone does not tell and the set is not in the cache, nothing else.
/// Throws InputError, also where --memory is less than what the job needs.
JobEstimate estimate(const BatchPlan& plan, SampledRun& sample);

/// The same with a sample of what is there, and of what is not where much would be guessed.
JobEstimate estimate(const BatchPlan& plan);

}  // namespace astrosplat

// What every band, slab and tile of a frame being rendered shares. In: render()'s arguments. Out:
// projections, blend groups, tables and fold settings.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "render/fold.h"
#include "render/footprint.h"
#include "render/lod.h"
#include "render/project.h"
#include "render/render.h"
#include "render/resolve.h"
#include "render/scatter.h"

namespace astrosplat {

struct RenderCache::State {
    using Profile = std::tuple<int, float, float>;  // shape, core, sharpness
    using Table = std::tuple<Profile, float>;       // and pixel filter
    SplatStore store;
    std::map<Table, std::unique_ptr<FootprintTable>> footprints;
    std::map<Profile, std::unique_ptr<LodTable>> lods;

    FootprintTable& footprint(const Falloff& falloff, float pixel_filter);
    const LodTable& lod(const Falloff& falloff, int finest, const Progress& progress);
};

/// One frame being rendered: what every band and tile shares.
struct FrameJob {
    std::span<const RenderLayer> layers;
    const Camera& camera;
    const Environment* environment;
    const RenderSettings& settings;
    const Progress& progress;
    const TileDone& tile_done;
    Region region;
    std::vector<BlendGroup> groups;
    std::vector<int> group_of_layer;
    std::vector<LayerProjection> projections;
    std::vector<FoldLayer> fold_layers;
    FoldSettings fold;
};

/// What remains to be said of a job after its arguments.
void prepare(FrameJob& job, RenderCache::State& cache);

/// Makes the footprints that the splats of a band ask for.
void make_footprints(const FrameJob& job, const TileBins::Sums& sums, RenderCache::State& cache);

}  // namespace astrosplat

#include "render/frame_job.h"

#include <algorithm>

#include "camera/projection.h"
#include "core/parallel.h"
#include "core/real.h"
#include "render/child_noise.h"
#include "render/near_star.h"
#include "render/project_stars.h"
#include "render/shared_render.h"
#include "render/spectrum.h"
#include "splats/splat_set.h"

namespace astrosplat {
namespace {

RenderCache::State::Profile numbers_of(const Falloff& falloff) {
    return {static_cast<int>(falloff.shape), falloff.core, falloff.sharpness};
}

/// Drops all entries when an animated falloff has filled the map, so that a long sequence stays small.
template <class Map>
void keep_small(Map& map) {
    constexpr std::size_t most = 64;
    if (map.size() > most) map.clear();
}

/// The largest light of a single splat: alpha * opacity * brightest channel, over all layers (DESIGN 7's L).
/// Taken over all splats, seen or not, so that a region renders as the whole does.
float largest_light(std::span<const RenderLayer> layers, const Progress& progress) {
    constexpr std::int64_t chunk = 1 << 18;
    float largest = 0.0f;
    for (const RenderLayer& layer : layers) {
        if (layer.stars) continue;  // largest_star_light
        const LevelOfDetail& lod = layer.render.lod;
        const float structure = lod.max_px > 0.0f ? largest_child_light(lod.noise) : 1.0f,
                    star = stars_stay_points(layer.render) ? brightest_near_star / structure : 1.0f;
        if (layer.blocks) {
            largest = std::max(largest, layer.blocks->largest_light() * layer.render.opacity * structure *
                                            std::max(1.0f, star));
            continue;
        }
        const ShadedSplats& splats = *layer.splats;
        std::vector<float> partial(static_cast<std::size_t>((splats.size() + chunk - 1) / chunk), 0.0f);
        parallel_chunks(splats.size(), chunk, [&](std::int64_t begin, std::int64_t end, int) {
            progress.check();
            float most = 0.0f;
            for (std::int64_t i = begin; i < end; ++i) {
                const glm::vec3& c = splats.color[i];
                const float nearest = is_star(splats.id[i]) ? star : 1.0f;
                most = std::max(most, splats.alpha[i] * std::max({c.x, c.y, c.z}) * nearest);
            }
            partial[begin / chunk] = most;
        });
        for (float p : partial) largest = std::max(largest, p * layer.render.opacity * structure);
    }
    return largest;
}

/// Transmittance below which a pixel is closed.
float stop_threshold(float largest, float exposure_stops) {
    const double exposed = largest * real::exp(std::max(0.0f, exposure_stops) * real::log(2.0));
    return static_cast<float>(0x1p-16 / std::max(1.0, exposed));
}

}  // namespace

RenderCache::RenderCache() : state(std::make_unique<State>()) {}
RenderCache::~RenderCache() = default;

FootprintTable& RenderCache::State::footprint(const Falloff& falloff, float pixel_filter) {
    std::unique_ptr<FootprintTable>& table = footprints[{numbers_of(falloff), pixel_filter}];
    if (!table) table = std::make_unique<FootprintTable>(begin_footprint_table(falloff, pixel_filter));
    return *table;
}

const LodTable& RenderCache::State::lod(const Falloff& falloff, int finest, const Progress& progress) {
    std::unique_ptr<LodTable>& table = lods[numbers_of(falloff)];
    if (!table) table = std::make_unique<LodTable>(falloff);
    table->prepare(finest, progress);
    return *table;
}

void prepare(FrameJob& job, RenderCache::State& cache) {
    const RenderSettings& settings = job.settings;
    const std::span<const RenderLayer> layers = job.layers;
    const Camera& camera = job.camera;
    job.region = settings.region;
    if (job.region.width <= 0 || job.region.height <= 0) job.region = {0, 0, settings.width, settings.height};
    job.fold.aovs = settings.aov_depth || settings.aov_coverage || settings.aov_count || settings.aov_layers;
    job.groups = make_groups(layers, job.fold.aovs);
    job.group_of_layer.resize(layers.size());
    for (std::size_t g = 0; g < job.groups.size(); ++g)
        for (std::size_t l : job.groups[g].layers) job.group_of_layer[l] = static_cast<int>(g);
    keep_small(cache.footprints);
    keep_small(cache.lods);
    for (std::size_t l = 0; l < layers.size(); ++l) {
        const LayerRender& render = layers[l].render;
        const FootprintTable& footprints = cache.footprint(render.falloff, settings.pixel_filter);
        LayerProjection projection =
            make_projection(layers[l], static_cast<std::uint16_t>(l), camera, settings);
        projection.reach = footprints.reach;
        projection.variance = footprints.variance;
        if (projection.lod_limit_px > 0.0f)
            projection.lod = &cache.lod(render.falloff, finest_level(render.lod.max_children), job.progress);
        if (layers[l].stars) projection.star_dots = star_dots(*layers[l].stars, footprints);
        job.projections.push_back(projection);
        job.fold_layers.push_back(
            {&footprints, render.blend, render.holdout, render.absorb, layers[l].absorbs});
    }
    float largest = largest_light(layers, job.progress);
    for (const LayerProjection& projection : job.projections)
        if (!projection.star_dots.empty()) largest = std::max(largest, largest_star_light(projection));
    if (job.environment) largest = std::max(largest, job.environment->largest);
    job.fold.stop = stop_threshold(largest, settings.exposure);
    job.fold.lens = make_lens(camera);
}

void make_footprints(const FrameJob& job, const TileBins::Sums& sums, RenderCache::State& cache) {
    if (sums.least_px > sums.largest_px) return;
    const float largest_px = shared::is_onto_sphere(job.fold.lens)
                                 ? std::max(sums.largest_px, sphere_spectrum_px * 1.05f)
                                 : sums.largest_px;
    for (const RenderLayer& layer : job.layers)
        make_footprint_nodes(cache.footprint(layer.render.falloff, job.settings.pixel_filter), sums.least_px,
                             largest_px, job.progress);
}

}  // namespace astrosplat

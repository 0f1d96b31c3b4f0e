#include "look/normalise.h"

#include <algorithm>

#include "core/memory.h"
#include "core/parallel.h"
#include "look/picture_chart.h"
#include "look/picture_fit.h"

namespace astrosplat {
namespace {

// On both sides of a square scene unit, of a lattice and the one between its corners.
double positions_due(const SplatSet& set) {
    const glm::dvec3& s = set.spacing;
    return set.generated ? 2.0 * set.max_distance * 2.0 / (s.x * s.y * s.z) : 0.0;
}

// Noise that only moves splats along the axis does not show from there, and takes longer than the rest.
LookUniforms without_jitter(LookUniforms u) {
    using shared_types::LookNoise;
    const auto shows = [](const LookNoise& n) {
        return n.cull != 0.0f || n.silhouette != 0.0f || n.alpha != 0.0f || n.brightness != 0.0f;
    };
    LookNoise* const end = std::stable_partition(u.noises, u.noises + u.noise_count, shows);
    u.noise_count = static_cast<int>(end - u.noises);
    return u;
}

}  // namespace

PictureFactors picture_factors(const LookRun& whole, const SplatSet& set, const FalloffMoments& falloff) {
    const LookUniforms uniforms = without_jitter(whole.uniforms);
    const LookRun run{whole.in, uniforms, whole.map, whole.out};
    PictureFactors factors;
    if (set.uv.empty() || set.size() == 0) return factors;
    const PictureChart chart = picture_chart(run, set, falloff.variance);
    if (chart.meshes == 0) return factors;
    claim_memory(picture_cells_bytes(chart, set.size()) + picture_fit_bytes(chart), "matching the picture");
    PictureCells cells = picture_cells(run, set, chart, falloff.integral);
    factors.of_cell = picture_fit(chart, cells, run.uniforms.match, positions_due(set));
    std::erase(cells.cell_of, no_cell);
    factors.cell_of = std::move(cells.cell_of);
    return factors;
}

void apply_factors(const PictureFactors& factors, ShadedSplats& shaded) {
    constexpr std::int64_t chunk = 1 << 14;
    parallel_each(factors.cell_of.size(), chunk, [&](std::size_t i) {
        const std::size_t cell = factors.cell_of[i];
        if (cell == beyond_cells) return;
        const float opacity = factors.of_cell[0][cell];
        shaded.alpha[i] = std::min(1.0f, shaded.alpha[i] * opacity);
        for (int c = 0; c < 3; ++c)
            shaded.color[i][c] *= factors.of_cell[static_cast<std::size_t>(c) + 1][cell] / opacity;
    });
}

}  // namespace astrosplat

// A sample of the set says for each block and its neighbours how places follow from u and v, and so how many
// cells a footprint is wide.
#include "look/picture_chart.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

#include "core/parallel.h"
#include "look/one_splat.h"
#include "look/shared_look.h"
#include "look/surface_metric.h"

namespace astrosplat {
namespace {

constexpr std::int64_t most_sampled = 1 << 17;  // positions
constexpr std::int64_t most_cells = 1 << 22;    // of all meshes
constexpr double widest_sigma = 8.0;            // cells; wider ones only cost
constexpr float edge_width = 2e-6f;             // of the picture: what rounding leaves
constexpr std::uint32_t purpose_sample = 0x706373u;

float part_of(float x) {
    const float part = x - std::floor(x);
    return part == 0.0f && x > 0.0f ? 1.0f : part;  // the right edge of the picture is not its left
}

std::int64_t mesh_of(const SplatSet& set, std::int64_t i) { return set.mesh.empty() ? 0 : set.mesh[i]; }

std::int64_t place_along(float x, std::int64_t size) {
    return std::min(size - 1, static_cast<std::int64_t>(part_of(x) * static_cast<float>(size)));
}

// A sample of the set, by blocks.
std::vector<SurfaceSamples> sampled(const LookRun& run, const SplatSet& set, std::int64_t meshes) {
    std::vector<SurfaceSamples> samples(static_cast<std::size_t>(meshes * chart_side * chart_side));
    const std::int64_t step = std::max<std::int64_t>(1, set.size() / most_sampled);
    for (std::int64_t from = 0; from + step <= set.size(); from += step) {
        // Anywhere in the step, since a set is in rows.
        const auto low = static_cast<std::uint32_t>(from), high = static_cast<std::uint32_t>(from >> 32);
        const std::int64_t i = from + shared::as_hash(1u, low, high, purpose_sample) % step;
        if (PictureChart::on_edge(set, i)) continue;
        const OneSplat look = look_at(run, run.uniforms, i);
        const glm::vec2 uv = set.uv[i];
        const std::int64_t row = place_along(uv.y, chart_side), column = place_along(uv.x, chart_side);
        const double r2 = static_cast<double>(look.radius) * static_cast<double>(look.radius);
        const double light = static_cast<double>(look.probability) * static_cast<double>(look.alpha) * r2;
        samples[static_cast<std::size_t>((mesh_of(set, i) * chart_side + row) * chart_side + column)]
            .push_back({{part_of(uv.x), part_of(uv.y)}, set.position[i], light, r2});
    }
    return samples;
}

// Of a block and its neighbours.
SurfaceSamples around(const std::vector<SurfaceSamples>& samples, std::int64_t block) {
    const std::int64_t row = block / chart_side % chart_side, column = block % chart_side;
    SurfaceSamples result;
    for (std::int64_t y = std::max<std::int64_t>(0, row - 1); y <= std::min(chart_side - 1, row + 1); ++y)
        for (std::int64_t x = std::max<std::int64_t>(0, column - 1);
             x <= std::min(chart_side - 1, column + 1); ++x) {
            const SurfaceSamples& own =
                samples[static_cast<std::size_t>(block + (y - row) * chart_side + x - column)];
            result.insert(result.end(), own.begin(), own.end());
        }
    return result;
}

glm::dvec2 middle_of(std::int64_t block) {
    const auto side = static_cast<double>(chart_side);
    return {(static_cast<double>(block % chart_side) + 0.5) / side,
            (static_cast<double>(block / chart_side % chart_side) + 0.5) / side};
}

// Cells as wide as a footprint's standard deviation in the mean, if there may be so many.
void choose_cells(const std::vector<SurfaceMetric>& metrics, std::int64_t positions, PictureChart& chart) {
    double columns = 0.0, rows = 0.0, known = 0.0;
    for (const SurfaceMetric& m : metrics) {
        if (m.area == 0.0) continue;
        columns += 1.0 / m.sigma_u, rows += 1.0 / m.sigma_v, known += 1.0;
    }
    if (known == 0.0) return;
    columns /= known, rows /= known;
    const auto most =
        static_cast<double>(std::min(positions, most_cells)) / static_cast<double>(chart.meshes);
    const double less = std::min(1.0, std::sqrt(most / (columns * rows)));
    columns = std::clamp(columns * less, 1.0, most), rows = std::clamp(rows * less, 1.0, most / columns);
    chart.columns = static_cast<std::int64_t>(columns), chart.rows = static_cast<std::int64_t>(rows);
}

ChartBlock block_of(const SurfaceMetric& m, const PictureChart& chart) {
    const auto columns = static_cast<double>(chart.columns), rows = static_cast<double>(chart.rows);
    return {std::min(widest_sigma, m.sigma_u * columns), std::min(widest_sigma, m.sigma_v * rows),
            m.area / (columns * rows)};
}

SurfaceMetric mean_of_known(const std::vector<SurfaceMetric>& metrics) {
    SurfaceMetric mean;
    double known = 0.0;
    for (const SurfaceMetric& m : metrics) {
        if (m.area == 0.0) continue;
        mean.sigma_u += m.sigma_u, mean.sigma_v += m.sigma_v, mean.area += m.area, known += 1.0;
    }
    return {mean.sigma_u / known, mean.sigma_v / known, mean.area / known};
}

}  // namespace

std::int64_t PictureChart::cell_of(const SplatSet& set, std::int64_t i) const {
    const glm::vec2 uv = set.uv[i];
    return (mesh_of(set, i) * rows + place_along(uv.y, rows)) * columns + place_along(uv.x, columns);
}

bool PictureChart::on_edge(const SplatSet& set, std::int64_t i) {
    const auto ends = [](float x) {
        const float part = part_of(x);
        return part < edge_width || part > 1.0f - edge_width;
    };
    return ends(set.uv[i].x) || ends(set.uv[i].y);
}

PictureChart picture_chart(const LookRun& run, const SplatSet& set, double falloff_variance) {
    PictureChart chart;
    const std::int64_t meshes =
        set.mesh.empty() ? 1 : static_cast<std::int64_t>(*std::ranges::max_element(set.mesh)) + 1;
    const std::vector<SurfaceSamples> samples = sampled(run, set, meshes);
    std::vector<SurfaceMetric> metrics(samples.size());
    parallel_for(static_cast<std::int64_t>(samples.size()), [&](std::int64_t block, int) {
        SurfaceSamples about = around(samples, block);
        metrics[static_cast<std::size_t>(block)] = surface_metric(about, middle_of(block), falloff_variance);
    });
    chart.meshes = meshes;
    choose_cells(metrics, set.size(), chart);
    if (chart.columns == 0 || chart.rows == 0) return {};
    const SurfaceMetric mean = mean_of_known(metrics);
    for (const SurfaceMetric& m : metrics) chart.blocks.push_back(block_of(m.area == 0.0 ? mean : m, chart));
    return chart;
}

}  // namespace astrosplat

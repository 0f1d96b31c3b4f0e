#include "look/normalise.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include "core/parallel.h"
#include "look/shared_look.h"

namespace astrosplat {
namespace {

constexpr double splats_per_cell = 8.0;      // fewer, and some cells would have none
constexpr std::int64_t most_sampled = 8192;  // positions, for how many are kept
constexpr double most_cells_a_side = 4096.0;
constexpr double whole_light = 1048576.0;  // 2^20: light is counted in whole steps, whose sum has no order
constexpr double least_factor = 0.25, most_factor = 4.0;
constexpr std::int64_t normalised_chunk = 1 << 14;
constexpr std::uint32_t dropped = 0xffffffffu;

// Light of one cell.
struct CellLight {
    std::atomic<std::int64_t> due{0}, kept{0};
};

struct Cells {
    std::uint32_t side;    // cells along u, and along v
    std::uint32_t meshes;  // each has cells of its own

    std::uint32_t of(const SplatSet& set, std::int64_t i) const {
        const glm::vec2 uv = set.uv[i];
        const auto along = [&](float x) {
            const float part = x - std::floor(x);
            return std::min(side - 1, static_cast<std::uint32_t>(part * static_cast<float>(side)));
        };
        const std::uint32_t mesh = set.mesh.empty() ? 0 : std::min(set.mesh[i], meshes - 1);
        return (mesh * side + along(uv.y)) * side + along(uv.x);
    }
};

// A map's value as the kernel and the preview read it.
glm::vec3 map_value(const Image& map, const glm::vec2& uv) {
    const int width = static_cast<int>(map.width), height = static_cast<int>(map.height);
    const float x = shared::look_texel(uv.x, width), y = shared::look_texel(1.0f - uv.y, height);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
    glm::vec3 value;
    for (int c = 0; c < 3; ++c) {
        const int from = map.channels >= 3 ? c : 0;
        value[c] = shared::look_bilinear(map.at(x0, y0)[from], map.at(x1, y0)[from], map.at(x0, y1)[from],
                                         map.at(x1, y1)[from], x - std::floor(x), y - std::floor(y));
    }
    return value;
}

shared::LookOutput look_at(const LookRun& run, std::int64_t i) {
    const LookColumns& in = run.in;
    shared::LookInput s{};
    s.position = in.position[i];
    s.color = in.color[i];
    s.alpha = in.alpha[i];
    s.from_surface = in.distance[i];
    s.radius = run.uniforms.own_radius ? in.radius[i] : 0.0f;
    s.map_value = run.uniforms.stop_count > 1 ? map_value(*run.map, in.uv[i]) : glm::vec3(0.0f);
    s.id_low = static_cast<std::uint32_t>(in.id[i]);
    s.id_high = static_cast<std::uint32_t>(in.id[i] >> 32);
    return shared::look_splat(run.uniforms, s);
}

// So many that about `splats_per_cell` are kept in each, by a sample of the set.
Cells cells_for(const LookRun& run, const SplatSet& set) {
    const std::uint32_t meshes = set.mesh.empty() ? 1 : *std::ranges::max_element(set.mesh) + 1;
    const std::int64_t step = std::max<std::int64_t>(1, set.size() / most_sampled);
    double kept = 0.0;
    for (std::int64_t i = 0; i < set.size(); i += step)
        kept += static_cast<double>(look_at(run, i).probability) * static_cast<double>(step);
    const double side = std::sqrt(kept / splats_per_cell / meshes);
    return {static_cast<std::uint32_t>(std::clamp(side, 1.0, most_cells_a_side)), meshes};
}

// Of radius 1 and alpha 1 at most.
double light_of(const shared::LookOutput& look, double largest_radius) {
    const double r = std::min(1.0, static_cast<double>(look.radius) / largest_radius);
    return static_cast<double>(look.alpha) * r * r;
}

double largest_radius(const LookRun& run, const SplatSet& set) {
    const LookUniforms& u = run.uniforms;
    const float own =
        u.own_radius && !set.radius.empty() ? *std::ranges::max_element(set.radius) : u.radius_max;
    const float most = own * std::max(1.0f, u.horizontal_scale) * std::max(1.0f, u.vertical_scale);
    return std::max(static_cast<double>(most), 1e-30);
}

double factor_of(const CellLight& cell) {
    const auto due = static_cast<double>(cell.due), kept = static_cast<double>(cell.kept);
    return kept > 0.0 ? std::clamp(due / kept, least_factor, most_factor) : 1.0;
}

}  // namespace

std::vector<float> picture_factors(const LookRun& run, const SplatSet& set) {
    std::vector<float> factors;
    if (set.uv.empty() || set.size() == 0) return factors;
    const Cells cells = cells_for(run, set);
    const std::size_t count = std::size_t(cells.meshes) * cells.side * cells.side;
    const auto lights = std::make_unique<CellLight[]>(count);
    std::vector<std::uint32_t> cell_of_kept(static_cast<std::size_t>(set.size()), dropped);
    const double radius = largest_radius(run, set);
    parallel_chunks(set.size(), normalised_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin; i < end; ++i) {
            const shared::LookOutput look = look_at(run, i);
            const double light = light_of(look, radius) * whole_light;
            const std::uint32_t cell = cells.of(set, i);
            lights[cell].due += std::llround(static_cast<double>(look.probability) * light);
            if (!look.keep) continue;
            lights[cell].kept += std::llround(light);
            cell_of_kept[static_cast<std::size_t>(i)] = cell;
        }
    });
    for (const std::uint32_t cell : cell_of_kept)
        if (cell != dropped) factors.push_back(static_cast<float>(factor_of(lights[cell])));
    return factors;
}

}  // namespace astrosplat

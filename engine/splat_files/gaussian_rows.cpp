#include "splat_files/gaussian_rows.h"

#include <fmt/format.h>

#include <glm/matrix.hpp>

#include "core/color.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/rotation.h"
#include "splats/harmonics.h"

namespace astrosplat {

SplatColumns gaussian_set_columns(bool directional) {
    SplatColumns columns;
    for (const SplatColumn column : {SplatColumn::position, SplatColumn::color, SplatColumn::alpha,
                                     SplatColumn::radius, SplatColumn::scale, SplatColumn::rotation})
        columns.set(index_of(column));
    return columns.set(index_of(SplatColumn::harmonics), directional);
}

SplatSet room_for_gaussians(std::int64_t count, bool directional, const std::string& what) {
    const SplatColumns columns = gaussian_set_columns(directional);
    claim_memory(count * std::int64_t(bytes_per_splat([&](SplatColumn column) {
                     return !is_optional(column) || columns[index_of(column)];
                 })),
                 what);
    SplatSet set;
    const auto size = std::size_t(count);
    set.position.resize(size);
    set.alpha.resize(size);
    set.distance.assign(size, 0.0f);
    set.id.resize(size);
    for (std::size_t i = 0; i < size; ++i) set.id[i] = i;
    set.color.resize(size);
    set.scale.resize(size);
    set.rotation.resize(size);
    if (directional) set.harmonics.assign(size, Harmonics{});
    return set;
}

std::optional<GaussianPlacement> gaussian_placement(const glm::dmat4& world) {
    constexpr double tolerance = 1e-3;
    const glm::dmat3 m(world);
    GaussianPlacement p;
    p.place = glm::dvec3(world[3]);
    p.scale = std::cbrt(std::fabs(glm::determinant(m)));
    p.turn = m / p.scale;
    const glm::dmat3 square = glm::transpose(p.turn) * p.turn;
    bool alike = p.scale > 0.0 && std::isfinite(p.scale);
    for (int i = 0; i < 9; ++i)
        alike = alike && std::fabs(square[i / 3][i % 3] - (i % 4 == 0 ? 1.0 : 0.0)) < tolerance;
    if (!alike) return std::nullopt;
    for (int i = 0; i < 9; ++i)
        p.turns = p.turns || std::fabs(p.turn[i / 3][i % 3] - (i % 4 == 0 ? 1.0 : 0.0)) > 1e-9;
    return p;
}

void place_gaussians(SplatSet& set, std::size_t begin, std::size_t end, const GaussianPlacement& placement) {
    // A mirrored Gaussian is the one that the opposite matrix turns.
    const glm::dmat3 proper = glm::determinant(placement.turn) < 0.0 ? -placement.turn : placement.turn;
    const glm::dvec4 by = quaternion_of_matrix(proper);
    for (std::size_t i = begin; i < end; ++i) {
        const glm::dvec3 position(set.position[i]), scale(set.scale[i]);
        set.position[i] = glm::vec3(placement.scale * (placement.turn * position) + placement.place);
        set.scale[i] = glm::vec3(placement.scale * scale);
        if (placement.turns) set.rotation[i] = glm::vec4(quaternion_product(by, set.rotation[i]));
    }
    if (!placement.turns || set.harmonics.empty()) return;
    const HarmonicsTurn turn = harmonics_turn(placement.turn);
    for (std::size_t i = begin; i < end; ++i) set.harmonics[i] = turned(set.harmonics[i], turn);
}

namespace {

constexpr std::int64_t rows_per_task = 1 << 14;

template <class Vector>
bool is_finite(const Vector& v) {
    for (int k = 0; k < v.length(); ++k)
        if (!std::isfinite(v[k])) return false;
    return true;
}

bool is_finite(const Harmonics& harmonics) {
    return std::ranges::all_of(harmonics.c, [](const glm::vec3& c) { return is_finite(c); });
}

/// Sets the numbers of one row; false where they are of no use.
bool finish_row(SplatSet& set, const GaussianNumbers& numbers, std::size_t i) {
    glm::vec3& scale = set.scale[i];
    float& alpha = set.alpha[i];
    glm::vec4& rotation = set.rotation[i];
    if (numbers.trained) {
        for (int k = 0; k < 3; ++k) scale[k] = float(real::exp(scale[k]));
        alpha = float(1.0 / (1.0 + real::exp(-double(alpha))));
    }
    if (numbers.filtered) {  // Yu et al. 2024, "Mip-Splatting", as its save_fused_ply() has it
        const double filter = set.radius[i];
        double kept = 1.0;  // of the opacity: the square root of the determinants' ratio
        for (int k = 0; k < 3; ++k) {
            const double own = scale[k], wide = std::sqrt(own * own + filter * filter);
            kept *= wide > 0.0 ? own / wide : 1.0;
            scale[k] = float(wide);
        }
        alpha = float(alpha * kept);
    }
    const glm::dvec4 q(rotation);
    const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    rotation = glm::vec4(q / length);
    glm::vec3& color = set.color[i];
    if (set.harmonics.empty())
        color = mean_color(Harmonics{{color}});
    else
        color = is_finite(set.harmonics[i]) ? mean_color(set.harmonics[i]) : glm::vec3(std::nanf(""));
    if (numbers.display)
        for (int k = 0; k < 3; ++k) color[k] = float(real::srgb_to_linear(color[k]));
    set.radius[i] = gaussian_radius(scale);
    const bool positive = scale.x >= 0.0f && scale.y >= 0.0f && scale.z >= 0.0f;
    if (!(positive && is_finite(set.position[i]) && std::isfinite(set.radius[i]) && is_finite(color) &&
          is_finite(rotation) && !std::isnan(alpha)))
        return false;
    alpha = std::clamp(alpha, 0.0f, 1.0f);
    return true;
}

}  // namespace

float gaussian_radius(const glm::vec3& scale) {
    const glm::dvec3 s(scale);
    const double xy = s.x * s.y, yz = s.y * s.z, zx = s.z * s.x;
    return float(3.0 * std::sqrt(std::sqrt((xy * xy + yz * yz + zx * zx) / 3.0)));
}

SplatSet finish_gaussians(SplatSet set, const GaussianNumbers& numbers, const fs::path& file) {
    set.display_harmonics = numbers.display;
    set.radius.resize(set.scale.size());
    set.color.resize(set.scale.size());
    Buffer<std::uint8_t> is_good(set.scale.size());
    parallel_each(is_good.size(), rows_per_task,
                  [&](std::size_t i) { is_good[i] = finish_row(set, numbers, i); });
    const auto bad = std::ranges::count(is_good, 0);
    if (bad == 0) return set;
    const auto first = std::ranges::find(is_good, 0) - is_good.begin();
    log_warning(fmt::format(
        "{}: {} of {} Gaussians have numbers that are not finite and are left out, the first is number {}",
        file.string(), bad, set.size(), first));
    Buffer<std::int64_t> rows;
    for (std::size_t i = 0; i < is_good.size(); ++i)
        if (is_good[i]) rows.push_back(std::int64_t(i));
    return take_rows(set, rows);
}

}  // namespace astrosplat

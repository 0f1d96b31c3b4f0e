#include "splat_files/finish_gaussians.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/color.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/text.h"
#include "splats/take_rows.h"

namespace astrosplat {
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
        for (int k = 0; k < 3; ++k) scale[k] = static_cast<float>(real::exp(scale[k]));
        alpha = static_cast<float>(1.0 / (1.0 + real::exp(-double(alpha))));
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
        for (int k = 0; k < 3; ++k) color[k] = static_cast<float>(real::srgb_to_linear(color[k]));
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
    return static_cast<float>(3.0 * std::sqrt(std::sqrt((xy * xy + yz * yz + zx * zx) / 3.0)));
}

SplatSet finish_gaussians(SplatSet set, const GaussianNumbers& numbers, const std::filesystem::path& file) {
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
        if (is_good[i]) rows.push_back(static_cast<std::int64_t>(i));
    return take_rows(set, rows);
}

}  // namespace astrosplat

#include "source/sky_patches.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/real.h"
#include "core/shared_maths.h"
#include "source/cube_faces.h"

namespace astrosplat {
namespace {

constexpr double spacing_share = 0.75;  // of a patch's reach: then every direction has one within .93 of it
constexpr double jitter = 0.25;         // of the spacing
constexpr int choices = 12;             // parts of the picture that are tried
constexpr double golden_angle = 2.399963229728653;

double random(std::uint32_t seed, std::size_t patch, std::uint32_t what) {
    return double(shared::as_uniform(
        shared::as_hash(seed, static_cast<std::uint32_t>(patch), what, shared::PURPOSE_SKY_PATCH)));
}

// Any two directions square to `middle` and to each other.
void set_axes(SkyPatch& patch, double turn, bool mirrored) {
    const glm::dvec3 other =
        std::fabs(patch.middle.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 a = glm::normalize(glm::cross(other, patch.middle)), b = glm::cross(patch.middle, a);
    patch.right = real::cos(turn) * a + real::sin(turn) * b;
    patch.down = (mirrored ? -1.0 : 1.0) * (real::cos(turn) * b - real::sin(turn) * a);
}

}  // namespace

// A chord of 2 sin(angle / 2) keeps areas.
glm::dvec2 SkyPatch::place(const glm::dvec3& d, double px_per_radian) const {
    const double scale = px_per_radian * std::sqrt(2.0 / std::fmax(1.0 + glm::dot(d, middle), 1e-9));
    return picture + scale * glm::dvec2(glm::dot(d, right), glm::dot(d, down));
}

glm::dvec3 SkyPatch::direction(glm::dvec2 place, double px_per_radian) const {
    const glm::dvec2 p = (place - picture) / px_per_radian;
    const double along = 1.0 - 0.5 * glm::dot(p, p);
    const double scale = std::sqrt(std::fmax(0.0, 0.5 * (1.0 + along)));
    return glm::normalize(along * middle + scale * (p.x * right + p.y * down));
}

SkyPatches::SkyPatches(glm::dvec2 size, double reach_px, double beyond_px, double px_per_radian,
                       std::uint32_t seed)
    : reach_(reach_px / px_per_radian), beyond_(beyond_px / px_per_radian), spacing_(spacing_share * reach_) {
    place(seed);
    fill_cells();
    choose_parts(size, reach_px, seed);
}

// As sunflowers place their seeds, and a little off.
void SkyPatches::place(std::uint32_t seed) {
    const double wanted = 4.0 * real::pi / (spacing_ * spacing_);
    const auto count = static_cast<std::size_t>(std::clamp(wanted, 12.0, 4e6));
    patches_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double y = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
        const double r = std::sqrt(1.0 - y * y);
        const double angle = std::fmod(golden_angle * static_cast<double>(i), 2.0 * real::pi);
        SkyPatch& patch = patches_[i];
        patch.middle = {r * real::cos(angle), y, r * real::sin(angle)};
        set_axes(patch, 0.0, false);
        patch.middle = glm::normalize(patch.middle + jitter * spacing_ *
                                                         ((2.0 * random(seed, i, 0) - 1.0) * patch.right +
                                                          (2.0 * random(seed, i, 1) - 1.0) * patch.down));
        set_axes(patch, 2.0 * real::pi * random(seed, i, 2), random(seed, i, 3) < 0.5);
    }
}

std::size_t SkyPatches::cell_of(const glm::dvec3& d) const {
    const glm::dvec3 a = glm::abs(d);
    const std::size_t axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const double along = d[static_cast<int>(axis)];
    const CubeAxes& face = cube_axes[2 * axis + (along < 0.0 ? 1 : 0)];
    const double scale = 0.5 / std::fabs(along);
    const auto cell = [&](double v) {
        return std::clamp<std::int64_t>(static_cast<std::int64_t>(v * static_cast<double>(cells_)), 0,
                                        cells_ - 1);
    };
    const std::int64_t x = cell(0.5 + glm::dot(face.right, d) * scale),
                       y = cell(0.5 - glm::dot(face.up, d) * scale);
    return (2 * axis + (along < 0.0 ? 1 : 0)) * static_cast<std::size_t>(cells_ * cells_) +
           static_cast<std::size_t>(y * cells_ + x);
}

// A patch is written into every cell that anything within its reach lies in: a cell and two more around the
// one of its middle, where cells are as wide as the reach.
void SkyPatches::fill_cells() {
    cells_ = std::clamp<std::int64_t>(static_cast<std::int64_t>(1.0 / reach_), 1, 32);
    near_.resize(static_cast<std::size_t>(6 * cells_ * cells_));
    const double step = 1.0 / static_cast<double>(cells_);
    std::vector<std::vector<std::uint32_t>> inside(near_.size());
    for (std::uint32_t i = 0; i < patches_.size(); ++i) inside[cell_of(patches_[i].middle)].push_back(i);
    const double cell_reach = std::sqrt(2.0) * step;  // from its middle to its corner, at most
    std::vector<glm::dvec3> middles;
    for (const CubeAxes& face : cube_axes)
        for (std::int64_t y = 0; y < cells_; ++y)
            for (std::int64_t x = 0; x < cells_; ++x)
                middles.push_back(cube_direction(face, (static_cast<double>(x) + 0.5) * step,
                                                 (static_cast<double>(y) + 0.5) * step));
    const double most = reach_ + beyond_ + cell_reach;
    for (std::size_t cell = 0; cell < near_.size(); ++cell)
        for (std::size_t other = 0; other < near_.size(); ++other) {
            if (glm::distance(middles[cell], middles[other]) > most + cell_reach) continue;
            for (const std::uint32_t i : inside[other])
                if (glm::distance(middles[cell], patches_[i].middle) <= most) near_[cell].push_back(i);
        }
    for (auto& patches : near_) std::ranges::sort(patches);
}

// Of several parts the one that is farthest from those that neighbours show.
void SkyPatches::choose_parts(glm::dvec2 size, double reach_px, std::uint32_t seed) {
    const glm::dvec2 lo(reach_px), room = glm::max(size - 2.0 * reach_px, glm::dvec2(0.0));
    for (std::size_t i = 0; i < patches_.size(); ++i) {
        double best = -1.0;
        glm::dvec2 chosen = lo;
        for (int k = 0; k < choices; ++k) {
            const auto what = static_cast<std::uint32_t>(4 + 2 * k);
            const glm::dvec2 part = lo + room * glm::dvec2(random(seed, i, what), random(seed, i, what + 1));
            double nearest = 1e300;
            for (const std::uint32_t j : near(patches_[i].middle))
                if (j < i) nearest = std::fmin(nearest, glm::distance(part, patches_[j].picture));
            if (nearest > best) best = nearest, chosen = part;
        }
        patches_[i].picture = chosen;
    }
}

std::span<const std::uint32_t> SkyPatches::near(const glm::dvec3& direction) const {
    return near_[cell_of(direction)];
}

std::uint32_t SkyPatches::nearest(const glm::dvec3& direction) const {
    std::uint32_t best = 0;
    double most = -2.0;
    for (const std::uint32_t i : near(direction)) {
        const double along = glm::dot(patches_[i].middle, direction);
        if (along > most) most = along, best = i;
    }
    return best;
}

}  // namespace astrosplat

#include "source/tiled_sky.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "detect/parts.h"
#include "image/resample.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

constexpr double spacing_share = 0.75;  // of a patch's reach: then every direction has one within .93 of it
constexpr double jitter = 0.25;         // of the spacing
constexpr int choices = 12;             // parts of the picture that are tried
constexpr double golden_angle = 2.399963229728653;

double random(std::uint32_t seed, std::size_t patch, std::uint32_t what) {
    return double(
        shared::as_uniform(shared::as_hash(seed, std::uint32_t(patch), what, shared::PURPOSE_SKY_PATCH)));
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
    const auto count = std::size_t(std::clamp(wanted, 12.0, 4e6));
    patches_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double y = 1.0 - (2.0 * double(i) + 1.0) / double(count);
        const double r = std::sqrt(1.0 - y * y);
        const double angle = std::fmod(golden_angle * double(i), 2.0 * real::pi);
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
    const double along = d[int(axis)];
    const CubeAxes& face = cube_axes[2 * axis + (along < 0.0 ? 1 : 0)];
    const double scale = 0.5 / std::fabs(along);
    const auto cell = [&](double v) {
        return std::clamp<std::int64_t>(std::int64_t(v * double(cells_)), 0, cells_ - 1);
    };
    const std::int64_t x = cell(0.5 + glm::dot(face.right, d) * scale),
                       y = cell(0.5 - glm::dot(face.up, d) * scale);
    return (2 * axis + (along < 0.0 ? 1 : 0)) * std::size_t(cells_ * cells_) + std::size_t(y * cells_ + x);
}

// A patch is written into every cell that anything within its reach lies in: a cell and two more around the
// one of its middle, where cells are as wide as the reach.
void SkyPatches::fill_cells() {
    cells_ = std::clamp<std::int64_t>(std::int64_t(1.0 / reach_), 1, 32);
    near_.resize(std::size_t(6 * cells_ * cells_));
    const double step = 1.0 / double(cells_);
    std::vector<std::vector<std::uint32_t>> inside(near_.size());
    for (std::uint32_t i = 0; i < patches_.size(); ++i) inside[cell_of(patches_[i].middle)].push_back(i);
    const double cell_reach = std::sqrt(2.0) * step;  // from its middle to its corner, at most
    std::vector<glm::dvec3> middles;
    for (const CubeAxes& face : cube_axes)
        for (std::int64_t y = 0; y < cells_; ++y)
            for (std::int64_t x = 0; x < cells_; ++x)
                middles.push_back(cube_direction(face, (double(x) + 0.5) * step, (double(y) + 0.5) * step));
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
            const auto what = std::uint32_t(4 + 2 * k);
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

namespace {

constexpr double patch_share = 0.28;   // reach of a cut-out, of the picture's shorter side
constexpr double object_share = 0.45;  // of that: the farthest that an object reaches
constexpr double blend_share = 0.35;   // of the spacing: over which skies go over into each other
constexpr std::int64_t least_px = 32;

glm::dvec3 mean_of(const Image& image) {
    glm::dvec3 sum(0.0);
    for (std::int64_t i = 0; i < image.width * image.height; ++i)
        for (int c = 0; c < 3; ++c) sum[c] += double(image.pixels[i * image.channels + c]);
    return sum / double(image.width * image.height);
}

// Four pixels around a place with their weights; those beyond the rim are the rim's.
struct Around {
    std::size_t pixel[4];
    float weight[4];
    Around(const Image& image, glm::dvec2 p) {
        const double fx = std::clamp(p.x - 0.5, 0.0, double(image.width - 1)),
                     fy = std::clamp(p.y - 0.5, 0.0, double(image.height - 1));
        const auto x = std::int64_t(fx), y = std::int64_t(fy);
        const std::int64_t right = std::min(x + 1, image.width - 1),
                           below = std::min(y + 1, image.height - 1);
        const auto u = float(fx - double(x)), v = float(fy - double(y));
        pixel[0] = std::size_t(y * image.width + x), weight[0] = (1 - u) * (1 - v);
        pixel[1] = std::size_t(y * image.width + right), weight[1] = u * (1 - v);
        pixel[2] = std::size_t(below * image.width + x), weight[2] = (1 - u) * v;
        pixel[3] = std::size_t(below * image.width + right), weight[3] = u * v;
    }
};

glm::vec3 pixel_of(const Image& image, std::size_t pixel) {
    const float* const p = image.pixels.data() + 3 * pixel;
    return {p[0], p[1], p[2]};
}

class Sky {
  public:
    Sky(const Image& picture, double px_per_radian, std::uint32_t seed)
        : reach_px_(patch_share * double(std::min(picture.width, picture.height))),
          px_per_radian_(px_per_radian),
          objects_(find_objects(picture, object_share * reach_px_)),
          patches_(glm::dvec2(picture.width, picture.height), reach_px_, object_share * reach_px_,
                   px_per_radian, seed) {
        choose_objects();
    }

    glm::vec3 at(const glm::dvec3& direction) const {
        const std::span<const std::uint32_t> near = patches_.near(direction);
        double nearest = 4.0;
        for (const std::uint32_t i : near)
            nearest = std::fmin(nearest, glm::distance(patches_.all()[i].middle, direction));
        glm::vec3 light(0.0f), between(0.0f);
        float weights = 0.0f;
        for (const std::uint32_t i : near) {
            const SkyPatch& patch = patches_.all()[i];
            const double away = glm::distance(patch.middle, direction);
            if (away >= (1.0 + object_share) * patches_.reach()) continue;
            const Around around(objects_.sky, patch.place(direction, px_per_radian_));
            light += object_light(around, i);
            const auto behind = float(1.0 - (away - nearest) / (blend_share * patches_.spacing()));
            if (behind <= 0.0f || away >= patches_.reach()) continue;
            const float weight = real::smoothstep(behind);
            weights += weight;
            for (int k = 0; k < 4; ++k)
                between += weight * around.weight[k] * pixel_of(objects_.sky, around.pixel[k]);
        }
        return light + between / std::max(weights, 1e-6f);
    }

  private:
    glm::vec3 object_light(const Around& around, std::uint32_t patch) const {
        glm::vec3 light(0.0f);
        for (int k = 0; k < 4; ++k) {
            const std::int32_t owner = objects_.owner[around.pixel[k]];
            if (owner < 0 || !std::ranges::binary_search(shown_[patch], owner)) continue;
            light += around.weight[k] * pixel_of(objects_.light, around.pixel[k]);
        }
        return light;
    }

    // Each patch shows those whose middle lies nearest to its own.
    void choose_objects() {
        const std::span<const SkyPatch> patches = patches_.all();
        shown_.resize(patches.size());
        parallel_each(patches.size(), 64, [&](std::size_t i) {
            for (std::size_t k = 0; k < objects_.objects.size(); ++k) {
                const glm::dvec2 middle(objects_.objects[k].middle);
                if (glm::distance(middle, patches[i].picture) >= reach_px_) continue;
                if (patches_.nearest(patches[i].direction(middle, px_per_radian_)) == i)
                    shown_[i].push_back(std::int32_t(k));
            }
        });
    }

    double reach_px_, px_per_radian_;
    PictureObjects objects_;
    SkyPatches patches_;
    std::vector<std::vector<std::int32_t>> shown_;  // objects of each patch, ascending
};

// Share of all directions that a texel of a cube's face has, up to a factor.
double solid_angle(double x, double y) {
    const double s = 2.0 * x - 1.0, t = 2.0 * y - 1.0, square = 1.0 + s * s + t * t;
    return 1.0 / (square * std::sqrt(square));
}

// Many times the same picture is a little brighter or darker than it is, as the parts fell.
void keep_light(const glm::dvec3& wanted, std::array<Image, 6>& faces) {
    glm::dvec3 sum(0.0);
    double all = 0.0;
    for (const Image& face : faces)
        for (std::int64_t y = 0; y < face.height; ++y)
            for (std::int64_t x = 0; x < face.width; ++x) {
                const double share = solid_angle((double(x) + 0.5) / double(face.width),
                                                 (double(y) + 0.5) / double(face.height));
                const float* const p = face.at(x, y);
                sum += share * glm::dvec3(p[0], p[1], p[2]);
                all += share;
            }
    const glm::dvec3 mean = sum / all;
    glm::vec3 factor(1.0f);
    for (int c = 0; c < 3; ++c)
        if (mean[c] > 0.0) factor[c] = float(wanted[c] / mean[c]);
    for (Image& face : faces)
        for (std::size_t i = 0; i < face.pixels.size(); ++i) face.pixels[i] *= factor[int(i % 3)];
}

}  // namespace

std::array<Image, 6> tiled_sky(const Image& picture, const SkyTiling& tiling, const Progress& progress) {
    const std::int64_t shorter = std::min(picture.width, picture.height), n = tiling.face_px;
    if (shorter < least_px)
        throw InputError(fmt::format(
            "environment.tile: expected a picture of at least {} px a side, found {}", least_px, shorter));
    claim_memory(6 * n * n * 3 * std::int64_t(sizeof(float)), "a sky of cut-outs");
    const glm::dvec3 wanted = mean_of(picture);
    // No finer than the faces, whose texels are smallest in their corners.
    const double height = real::radians(tiling.height_deg);
    const double finest = 0.5 * double(n) * 1.5 * height;
    const bool finer = double(shorter) > finest;
    const double ratio = finer ? std::fmax(finest, double(least_px)) / double(shorter) : 1.0;
    const auto reduced = [&](std::int64_t px) {
        return std::max<std::int64_t>(least_px, std::llround(ratio * double(px)));
    };
    const Image own =
        finer ? reduced_by_area(picture, reduced(picture.width), reduced(picture.height)) : picture;
    const Sky sky(own, double(std::min(own.width, own.height)) / height, tiling.seed);
    std::array<Image, 6> faces;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        faces[f] = make_image(n, n, 3);
        parallel_for(n, [&](std::int64_t y, int) {
            progress.check();
            for (std::int64_t x = 0; x < n; ++x) {
                const glm::vec3 light = sky.at(cube_direction(cube_axes[f], (double(x) + 0.5) / double(n),
                                                              (double(y) + 0.5) / double(n)));
                std::copy_n(&light[0], 3, faces[f].at(x, y));
            }
        });
    }
    keep_light(wanted, faces);
    return faces;
}

std::array<Image, 6> tiled_sky_of(const fs::path& file, const SkyTiling& tiling, const Progress& progress) {
    Image picture = load_linear_image(file, progress);
    fill_values(std::span(&picture, 1), 0, file, progress);
    return tiled_sky(picture, tiling, progress);
}

}  // namespace astrosplat

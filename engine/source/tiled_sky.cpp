#include "source/tiled_sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "image/area.h"
#include "source/cube_faces.h"
#include "source/picture_objects.h"
#include "source/sky_patches.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

constexpr double patch_share = 0.28;   // reach of a cut-out, of the picture's shorter side
constexpr double object_share = 0.45;  // of that: the farthest that an object reaches
constexpr double blend_share = 0.35;   // of the spacing: over which skies go over into each other
constexpr std::int64_t least_px = 32;

glm::dvec3 mean_of(const Image& image) {
    glm::dvec3 sum(0.0);
    for (std::int64_t i = 0; i < image.width * image.height; ++i)
        for (int c = 0; c < 3; ++c)
            sum[c] += double(image.pixels[static_cast<std::size_t>(i * image.channels + c)]);
    return sum / static_cast<double>(image.width * image.height);
}

// Four pixels around a place with their weights; those beyond the rim are the rim's.
struct Around {
    std::size_t pixel[4];
    float weight[4];
    Around(const Image& image, glm::dvec2 p) {
        const double fx = std::clamp(p.x - 0.5, 0.0, static_cast<double>(image.width - 1)),
                     fy = std::clamp(p.y - 0.5, 0.0, static_cast<double>(image.height - 1));
        const auto x = static_cast<std::int64_t>(fx), y = static_cast<std::int64_t>(fy);
        const std::int64_t right = std::min(x + 1, image.width - 1),
                           below = std::min(y + 1, image.height - 1);
        const auto u = static_cast<float>(fx - static_cast<double>(x)),
                   v = static_cast<float>(fy - static_cast<double>(y));
        pixel[0] = static_cast<std::size_t>(y * image.width + x), weight[0] = (1 - u) * (1 - v);
        pixel[1] = static_cast<std::size_t>(y * image.width + right), weight[1] = u * (1 - v);
        pixel[2] = static_cast<std::size_t>(below * image.width + x), weight[2] = (1 - u) * v;
        pixel[3] = static_cast<std::size_t>(below * image.width + right), weight[3] = u * v;
    }
};

glm::vec3 pixel_of(const Image& image, std::size_t pixel) {
    const float* const p = image.pixels.data() + 3 * pixel;
    return {p[0], p[1], p[2]};
}

class Sky {
  public:
    Sky(const Image& picture, double px_per_radian, std::uint32_t seed)
        : reach_px_(patch_share * static_cast<double>(std::min(picture.width, picture.height))),
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
            const auto behind =
                static_cast<float>(1.0 - (away - nearest) / (blend_share * patches_.spacing()));
            if (behind <= 0.0f || away >= patches_.reach()) continue;
            const float weight = behind * behind * (3.0f - 2.0f * behind);
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
                    shown_[i].push_back(static_cast<std::int32_t>(k));
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
                const double share = solid_angle((static_cast<double>(x) + 0.5) / double(face.width),
                                                 (static_cast<double>(y) + 0.5) / double(face.height));
                const float* const p = face.at(x, y);
                sum += share * glm::dvec3(p[0], p[1], p[2]);
                all += share;
            }
    const glm::dvec3 mean = sum / all;
    glm::vec3 factor(1.0f);
    for (int c = 0; c < 3; ++c)
        if (mean[c] > 0.0) factor[c] = static_cast<float>(wanted[c] / mean[c]);
    for (Image& face : faces)
        for (std::size_t i = 0; i < face.pixels.size(); ++i)
            face.pixels[i] *= factor[static_cast<int>(i % 3)];
}

}  // namespace

std::array<Image, 6> tiled_sky(const Image& picture, const SkyTiling& tiling, const Progress& progress) {
    const std::int64_t shorter = std::min(picture.width, picture.height), n = tiling.face_px;
    if (shorter < least_px)
        throw InputError(fmt::format(
            "environment.tile: expected a picture of at least {} px a side, found {}", least_px, shorter));
    claim_memory(6 * n * n * 3 * static_cast<std::int64_t>(sizeof(float)), "a sky of cut-outs");
    const glm::dvec3 wanted = mean_of(picture);
    // No finer than the faces, whose texels are smallest in their corners.
    const double height = real::radians(tiling.height_deg);
    const double finest = 0.5 * static_cast<double>(n) * 1.5 * height;
    const bool finer = static_cast<double>(shorter) > finest;
    const double ratio = finer ? std::fmax(finest, double(least_px)) / static_cast<double>(shorter) : 1.0;
    const auto reduced = [&](std::int64_t px) {
        return std::max<std::int64_t>(least_px, std::llround(ratio * static_cast<double>(px)));
    };
    const Image own =
        finer ? reduced_by_area(picture, reduced(picture.width), reduced(picture.height)) : picture;
    const Sky sky(own, static_cast<double>(std::min(own.width, own.height)) / height, tiling.seed);
    std::array<Image, 6> faces;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        faces[f] = make_image(n, n, 3);
        parallel_for(n, [&](std::int64_t y, int) {
            progress.check();
            for (std::int64_t x = 0; x < n; ++x) {
                const glm::vec3 light =
                    sky.at(cube_direction(cube_axes[f], (static_cast<double>(x) + 0.5) / double(n),
                                          (static_cast<double>(y) + 0.5) / double(n)));
                std::copy_n(&light[0], 3, faces[f].at(x, y));
            }
        });
    }
    keep_light(wanted, faces);
    return faces;
}

std::array<Image, 6> tiled_sky_of(const std::filesystem::path& file, const SkyTiling& tiling,
                                  const Progress& progress) {
    return tiled_sky(load_linear_image(file, progress), tiling, progress);
}

}  // namespace astrosplat

// A whole sky made of one picture of a part of it: cut-outs of the picture, turned and mirrored at random, on
// places all over the sphere. In: linear light. Out: where the cut-outs lie and which of them are near a
// direction; six faces of a cube around the eye, in the order +x -x +y -y +z -z, as pictures of them have it.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "core/progress.h"

namespace astrosplat {

/// A cube face as seen from the origin: where it lies and what is to the right and up in its picture. +y and
/// -y are seen tilting the head from -z.
struct CubeAxes {
    glm::dvec3 forward, right, up;
};
inline const std::array<CubeAxes, 6> cube_axes = {{
    {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
    {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
    {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}},
}};

/// Unit direction of a place on a face, in sides of it from its upper left corner.
inline glm::dvec3 cube_direction(const CubeAxes& face, double x, double y) {
    return glm::normalize(face.forward + face.right * (2.0 * x - 1.0) + face.up * (1.0 - 2.0 * y));
}

/// A part of the picture on the sky, in Lambert's equal-area projection about its middle: no light is gained
/// or lost by stretching.
struct SkyPatch {
    glm::dvec3 middle, right, down;  // unit directions
    glm::dvec2 picture;              // px of the picture, where `middle` is

    /// Where the picture shows a direction near the middle.
    glm::dvec2 place(const glm::dvec3& direction, double px_per_radian) const;
    /// The other way round.
    glm::dvec3 direction(glm::dvec2 place, double px_per_radian) const;
};

class SkyPatches {
  public:
    /// Of a picture of `size` px, parts of `reach_px` around their middles; `beyond_px`: farther from there
    /// near() still finds them.
    SkyPatches(glm::dvec2 size, double reach_px, double beyond_px, double px_per_radian, std::uint32_t seed);

    std::span<const SkyPatch> all() const { return patches_; }
    /// Numbers of those whose middle is within `reach` and what is beyond of a direction, and of some others.
    std::span<const std::uint32_t> near(const glm::dvec3& direction) const;
    double reach() const { return reach_; }      // length of a chord of the unit sphere
    double spacing() const { return spacing_; }  // likewise, between neighbours
    /// The one whose middle is nearest.
    std::uint32_t nearest(const glm::dvec3& direction) const;

  private:
    void place(std::uint32_t seed);
    void fill_cells();
    void choose_parts(glm::dvec2 size, double reach_px, std::uint32_t seed);
    std::size_t cell_of(const glm::dvec3& direction) const;

    std::vector<SkyPatch> patches_;
    double reach_ = 0.0, beyond_ = 0.0, spacing_ = 0.0;
    std::int64_t cells_ = 1;  // a side of a cube's face
    std::vector<std::vector<std::uint32_t>> near_;
};

struct SkyTiling {
    double height_deg = 10.0;  // that the picture's shorter side covers on the sky
    std::uint32_t seed = 1;
    std::int64_t face_px = 2048;  // a side
    bool operator==(const SkyTiling&) const = default;
};

/// RGB, in the order above. An object of the picture (detect/parts.h) is in a cut-out whole or
/// not at all, so there are no cut ones and as many a square degree as in the picture; what is between them
/// goes over softly from one cut-out into the next. Neighbours show different parts of the
/// picture. The mean light of all directions is the picture's. The same bits with any number of threads.
/// Throws InputError for a picture of less than 32 px a side; Cancelled.
std::array<Image, 6> tiled_sky(const Image& picture, const SkyTiling& tiling, const Progress& progress = {});

/// The same of a picture's file, read as linear light.
std::array<Image, 6> tiled_sky_of(const fs::path& file, const SkyTiling& tiling,
                                  const Progress& progress = {});

/// tiled_sky_of, or what keeps its results (sets/kept.h).
using SkyMaker = std::function<std::array<Image, 6>(const fs::path&, const SkyTiling&, const Progress&)>;

}  // namespace astrosplat

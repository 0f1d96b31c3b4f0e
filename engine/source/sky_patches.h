// Where the cut-outs of a tiled sky lie (tiled_sky.h). In: how large they are. Out: places on the sphere with
// their part of the picture, and which of them are near a direction.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace astrosplat {

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

}  // namespace astrosplat

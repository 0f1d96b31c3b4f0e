// Close-ups (DESIGN 7): a splat too large on screen becomes N = 4^level smaller ones in its own volume, fixed
// in layer space. In: projected diameter, alpha, blend. Out: levels to draw, their alphas, where the children
// lie, and their light's structure, e^(strength n) with n octaves of noise between the splat's size and
// theirs (DEPTH 6). A star's splat is only the telescope's blur, so its image grows less.
#pragma once

#include <glm/vec3.hpp>

#include "camera/lens.h"
#include "core/progress.h"
#include "render/frame.h"

namespace astrosplat::shared_types {
using glsl::vec3, glsl::uint;
#include "child_types.glsl"
}  // namespace astrosplat::shared_types

namespace astrosplat {
using shared_types::LevelChoice;

/// As choose_levels() of shaders/shared/children.glsl, of levels with at most so many children.
LevelChoice choose_levels(float diameter_px, float limit_px, int max_children);

/// The finest level of at most so many children.
int finest_level(int max_children);

inline std::int64_t children_of_level(int level) { return std::int64_t{1} << (2 * level); }

/// The reach of children, parent radii.
inline constexpr float child_reach = 1.25f;

/// Child alphas and positions for one falloff. Building is lazy and not thread-safe; lookups after
/// prepare() are.
class LodTable {
  public:
    explicit LodTable(const Falloff& falloff);

    /// Makes lookups for levels up to `finest` possible.
    void prepare(int finest, const Progress& progress = {});

    /// For child_tables.glsl, whose functions are its own: child_alphas() are those of the coarse and the
    /// fine level's splats which together deposit the light of a parent of alpha `a` under over: Integral[1 -
    /// (1 - a_coarse q_coarse)^M (1 - a_fine q_fine)^N] = a Integral[w]. child_offset(): centre of a child
    /// relative to the parent's, in parent radii: density w(|p|) in the ball of radius 1 less half the
    /// child's radius, hashed from (seed, id, level, child).
    struct Numbers {
        std::vector<float> radius, fading;  // inverse of the centres' radial distribution; child alpha over
                                            // (parent alpha, fade), while the coarser level fades out
        std::vector<double> steady;         // child alpha over parent alpha, when drawn alone
    };
    const Numbers& numbers() const { return numbers_; }

  private:
    void build(int level, const Progress& progress);
    std::vector<double> centre_density(int level) const;
    std::vector<double> mean_footprint(int level) const;
    double solve(double target, const std::vector<double>& rest, int level) const;

    Falloff falloff_;
    // Integration over the disc of radius 1.5 parent radii: t and 2 pi t dt.
    std::vector<double> nodes_, weights_;
    std::vector<std::vector<double>>
        footprints_;   // mean child weight q at the nodes, by level; 0 is the parent
    Numbers numbers_;  // of the same levels
};

/// Noise for the children of one splat at one level. It depends on nothing but the splat's radius, the level
/// and the layer's seed: a child keeps its light however near the camera is.
struct ChildNoise {
    std::array<shared_types::ChildOctave, shared_types::CHILD_OCTAVES> octaves;
    int count = 0;
    float strength = 0.0f;
    float offset = 0.0f;  // of the exponent: makes the mean over space 1
};

/// `strength` is lod.noise, 0..2; `radius` in layer space, > 0; `level` as in LevelChoice. Level 0 has none.
ChildNoise make_child_noise(float strength, float radius, int level, std::uint32_t seed);

/// Factor of the light of a child at `p` in layer space: > 0, 1 on average over space,
/// and at most largest_child_light.
float child_light(const ChildNoise& noise, const glm::vec3& p);
float largest_child_light(float strength);

/// The most that the colour of a star close by is multiplied by.
inline constexpr float brightest_near_star = 16.0f;

/// Radius of the image of a star at a share `nearness`, in (0, 1], of lod.star_distance, over that of a splat
/// there. From that distance on the image grows only with the fourth root of 1 / nearness, as a brighter star
/// in a photograph is a little larger, until its light, which is the splat's, is brightest_near_star times as
/// dense. 1 where nearness is 1.
float near_star_size(float nearness);

}  // namespace astrosplat

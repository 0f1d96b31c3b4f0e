// Bodies while their model is changed: some of a set's splats, moved along their lines of sight by as much as
// depths of the same pictures, at a small size, differ between the model that they were made by and another
// one. In: splats of make_bodies(), and what they were made of. Out: about where make_bodies() would have
// them, for a hand that drags.
#pragma once

#include "source/source.h"
#include "source/textured_mesh.h"
#include "splats/splat_set.h"

namespace astrosplat {

class MovedBodies {
  public:
    /// Texels of a picture that depths follow: as fine as its fields are where it is 1920 px wide.
    static constexpr std::int64_t usual_texels = 150'000;

    /// `rows`: any of the splats that make_bodies() made of these meshes, parameters and seed. Takes some
    /// time, and about 100 bytes a row.
    MovedBodies(std::vector<TexturedMesh> meshes, const StructureParams& params, std::uint32_t seed,
                SplatSet rows, std::int64_t small_texels = usual_texels);
    MovedBodies(MovedBodies&&) noexcept;
    ~MovedBodies();

    /// The rows as `now` has them: their places, distances and radii; opacity, density and dust in alpha and
    /// colour. Those under the parameters that they were made by are as they were. One thread at a time.
    SplatSet under(const StructureParams& now) const;

  private:
    struct Picture;
    std::vector<TexturedMesh> meshes_;  // without pictures
    StructureParams params_;
    SplatSet rows_;
    std::vector<std::unique_ptr<const Picture>> pictures_;
};

/// Whether moved bodies show what `now` makes of the model of `before`.
bool only_moves_bodies(const StructureParams& before, const StructureParams& now);

}  // namespace astrosplat

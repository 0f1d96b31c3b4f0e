// The stars of a picture in depth, and how much of their light arrives at the camera of the picture, past the
// splats before them. In: where the picture has them, the mesh that carries it and the splats of their layer.
// Out: places in the layer, each on the ray to the picture's camera, and the camera that sees them there;
// stars of which hardly any light would pass are moved before what hides them.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera/camera.h"
#include "core/progress.h"
#include "source/source.h"
#include "source/textured_mesh.h"
#include "splats/splat_set.h"

namespace astrosplat {

struct SeenStar {
    glm::vec2 uv;         // on the picture as the mesh has it
    float before = 0.5f;  // 0..1: share of the layer's stars that lie nearer
};

/// How far stars lie before and behind the surface.
struct StarDepths {
    double slab = 0.0;          // scene units, from the nearest to the farthest; 0: as stars of bodies do
    StructureParams structure;  // of the bodies
    std::uint32_t seed = 1;     // theirs
};

struct PlacedStars {
    std::vector<std::size_t> star;    // which; those that the mesh does not show are left out
    std::vector<glm::vec3> position;  // layer space
    std::vector<float> distance;      // scene units from the middle of the layer
    std::vector<float> texel_area;    // over that of `texel_side` squared
    Camera camera;                    // the picture's; without one, with parallel rays from the front
    double height_texels = 1.0;       // of what it shows
    double texel_side = 0.0;          // scene units; where rays meet at a distance of 1
};

/// Of the first material of `mesh` that shows a picture; one place a star.
PlacedStars place_stars(const TexturedMesh& mesh, std::span<const SeenStar> stars, const StarDepths& depths);

/// The texture of that material; null where none is shown.
const Texture* shown_picture(const TexturedMesh& mesh);

struct FrontView {
    Camera camera;              // in the layer's own space
    double height_px = 1080.0;  // of what it shows
    double filter_px = 0.5;     // standard deviation of the pixel filter
    double star_px = 1.0;       // the same of a star's image
};

/// Share of the light of each star that arrives, red, green and blue; `position` may change. The splats have
/// radii and alphas of their own and the default falloff: those of bodies. The same bits with any number of
/// threads. Throws Cancelled.
std::vector<glm::dvec3> passing_light(const FrontView& view, const SplatSet& splats,
                                      std::vector<glm::vec3>& position, const Progress& progress = {});

}  // namespace astrosplat

#include "bodies/star_places.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "bodies/picture_light.h"
#include "bodies/placement.h"
#include "bodies/uv_surface.h"
#include "image/channels.h"
#include "source/picture_camera.h"

namespace astrosplat {
namespace {

constexpr float nearest_star = 0.95f;  // of the way to the picture's camera, as of other dots

std::optional<std::uint32_t> material_of_picture(const TexturedMesh& mesh) {
    for (std::uint32_t i = 0; i < mesh.textures.size(); ++i)
        if (mesh.textures[i].image.width > 0) return i;
    return {};
}

std::optional<SurfacePlace> first_place(const UvSurface& surface, glm::vec2 uv) {
    std::optional<SurfacePlace> found;
    surface.at(uv, [&](const SurfacePlace& place) {
        if (!found) found = place;
    });
    return found;
}

// Heights of stars over the surface, texels.
class Heights {
  public:
    Heights(const StarDepths& depths, const Texture& texture, const UvSurface& surface)
        : slab_(depths.slab), width_(texture.image.width), height_(texture.image.height) {
        if (slab_ > 0.0) return;
        const Image light = picture_light(texture, depths.structure.border).light;
        placement_ = make_placement(brightest_channel(light), depths.structure, surface.texels_per_unit(),
                                    surface.flat(), depths.seed);
    }

    /// From the middle of the layer.
    float from_middle(const SeenStar& star, float units_per_texel) const {
        if (slab_ > 0.0) return (0.5f - star.before) * static_cast<float>(slab_) / units_per_texel;
        return star_height(*placement_, x(star), y(star), 1.0f - star.before);
    }
    float middle(const SeenStar& star) const {
        return placement_ ? middle_plane(*placement_, x(star), y(star)) : 0.0f;
    }

  private:
    float x(const SeenStar& star) const { return star.uv.x * static_cast<float>(width_); }
    float y(const SeenStar& star) const { return (1.0f - star.uv.y) * static_cast<float>(height_); }

    double slab_;
    std::int64_t width_, height_;
    std::optional<Placement> placement_;
};

// From the front, with parallel rays, as high as the picture would be if it were flat.
Camera front_camera(const PlacedStars& stars, const glm::dvec3& toward, double aspect) {
    glm::dvec3 middle(0.0);
    for (const glm::vec3& p : stars.position)
        middle += glm::dvec3(p) / static_cast<double>(stars.position.size());
    UvCamera params;
    params.target = middle;
    params.height = stars.texel_side * stars.height_texels;
    params.position = middle + 10.0 * std::max(aspect, 1.0) * params.height * toward;
    params.up = std::fabs(toward.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(0.0, 0.0, -1.0);
    return picture_camera(params, aspect);
}

}  // namespace

const Texture* shown_picture(const TexturedMesh& mesh) {
    const auto material = material_of_picture(mesh);
    return material ? &mesh.textures[*material] : nullptr;
}

PlacedStars place_stars(const TexturedMesh& mesh, std::span<const SeenStar> stars, const StarDepths& depths) {
    PlacedStars placed;
    const auto material = material_of_picture(mesh);
    if (!material) return placed;
    const Texture& texture = mesh.textures[*material];
    const Image& picture = texture.image;
    const UvSurface surface(mesh.mesh, *material, picture.width, picture.height,
                            texture.wrap == TextureSettings::Wrap::repeat,
                            mesh.camera ? &*mesh.camera : nullptr);
    const Heights heights(depths, texture, surface);
    placed.height_texels = static_cast<double>(picture.height);
    const double aspect = static_cast<double>(picture.width) / static_cast<double>(picture.height);
    glm::dvec3 toward(0.0);
    std::vector<double> sides;
    for (std::size_t i = 0; i < stars.size(); ++i) {
        const std::optional<SurfacePlace> place = first_place(surface, stars[i].uv);
        if (!place || !(place->units_per_texel > 0.0f)) continue;
        const float from_middle = heights.from_middle(stars[i], place->units_per_texel);
        float z = from_middle + heights.middle(stars[i]);
        if (place->approach > 0.0f) z = std::min(z, nearest_star / place->approach);
        placed.star.push_back(i);
        placed.position.push_back(place->position + place->rise * (z * place->units_per_texel));
        placed.distance.push_back(std::fabs(from_middle) * place->units_per_texel);
        toward += glm::dvec3(place->normal);
        sides.push_back(static_cast<double>(place->units_per_texel));
    }
    placed.texel_area.assign(placed.star.size(), 1.0f);
    if (placed.star.empty()) return placed;
    if (mesh.camera) {
        placed.camera = *mesh.camera;
        placed.texel_side = picture_height_at(placed.camera, 1.0) / placed.height_texels;
        return placed;
    }
    placed.texel_side = 1.0 / surface.texels_per_unit();
    for (std::size_t i = 0; i < sides.size(); ++i)
        placed.texel_area[i] =
            static_cast<float>(sides[i] * sides[i] / (placed.texel_side * placed.texel_side));
    const double length = glm::length(toward);
    placed.camera = front_camera(placed, length > 0.0 ? toward / length : glm::dvec3(0.0, 1.0, 0.0), aspect);
    return placed;
}

}  // namespace astrosplat

// The splats that hide a star are found the other way round than in rendering: every splat looks for the
// stars that it may hide, on a grid of the picture.
#include "bodies/star_places.h"

#include <glm/geometric.hpp>

#include "bodies/picture_light.h"
#include "bodies/picture_splats.h"
#include "bodies/placement.h"
#include "bodies/uv_surface.h"
#include "core/parallel.h"
#include "core/real.h"
#include "image/channels.h"
#include "source/textured_mesh.h"

namespace astrosplat {
namespace {

// At least so much of a star's light passes: one farther back moves along its ray to where it does.
constexpr double least_passing = 0.95;

constexpr float nearest_star = 0.95f;  // of the way to the picture's camera, as of other splats
constexpr double eye_heights = 10.0;   // from the stars to an eye that sees in parallel: before all of them
constexpr double steepest_y = 0.9;     // of a view's y axis; of steeper ones, along y, -z is up

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

// Heights of stars over the surface, texels; without a placement they fill the slab.
struct Heights {
    const Image& picture;
    double slab;
    std::optional<Placement> placement = {};

    /// From the middle of the layer.
    float from_middle(const SeenStar& star, float units_per_texel) const {
        if (!placement) return (0.5f - star.before) * float(slab) / units_per_texel;
        return star_height(*placement, x(star), y(star), 1.0f - star.before);
    }
    float middle(const SeenStar& star) const {
        return placement ? middle_plane(*placement, x(star), y(star)) : 0.0f;
    }
    float x(const SeenStar& star) const { return star.uv.x * float(picture.width); }
    float y(const SeenStar& star) const { return (1.0f - star.uv.y) * float(picture.height); }
};

// From the front, with parallel rays, as high as the picture would be if it were flat.
Camera front_camera(const PlacedStars& stars, const glm::dvec3& toward, double aspect) {
    glm::dvec3 middle(0.0);
    for (const glm::vec3& p : stars.position) middle += glm::dvec3(p) / double(stars.position.size());
    UvCamera params;
    params.target = middle;
    params.height = stars.texel_side * stars.height_texels;
    params.position = middle + eye_heights * std::max(aspect, 1.0) * params.height * toward;
    params.up = std::fabs(toward.y) < steepest_y ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(0.0, 0.0, -1.0);
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
    const UvSurface surface = surface_of(mesh, *material);
    Heights heights{picture, depths.slab};
    if (!(depths.slab > 0.0))
        heights.placement =
            make_placement(picture_light(texture, depths.structure.border).light, depths.structure,
                           surface.texels_per_unit(), surface.flat(), depths.seed);
    placed.height_texels = double(picture.height);
    const double aspect = double(picture.width) / double(picture.height);
    glm::dvec3 toward(0.0);
    std::vector<double> sides;
    for (std::size_t i = 0; i < stars.size(); ++i) {
        const std::optional<SurfacePlace> place = first_place(surface, stars[i].uv);
        if (!place || !(place->units_per_texel > 0.0f)) continue;
        const float from_middle = heights.from_middle(stars[i], place->units_per_texel);
        float z = from_middle + heights.middle(stars[i]);
        if (heights.placement) z = along_rays(*place, z);  // a slab is as deep as the scene says
        if (place->approach > 0.0f) z = std::min(z, nearest_star / place->approach);
        placed.star.push_back(i);
        placed.position.push_back(place->position + place->rise * (z * place->units_per_texel));
        placed.distance.push_back(std::fabs(from_middle) * place->units_per_texel);
        toward += glm::dvec3(place->normal);
        sides.push_back(double(place->units_per_texel));
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
        placed.texel_area[i] = float(sides[i] * sides[i] / (placed.texel_side * placed.texel_side));
    const double length = glm::length(toward);
    placed.camera = front_camera(placed, length > 0.0 ? toward / length : glm::dvec3(0.0, 1.0, 0.0), aspect);
    return placed;
}

namespace {

constexpr double star_cell_px = 8.0;  // of the grid on which splats look for stars
constexpr std::int64_t splats_per_task = 65536;
constexpr double least_depth = 1e-6;          // of a splat, optical: less hides nothing
constexpr double most_hiding = 1.0f - 1e-6f;  // so that depths are finite
constexpr double gaussian_ends = 4.0;  // sigmas; footprints wider than so many of the filter's keep theirs
constexpr double outer_place = 1.7320508075688772;  // sigmas: sqrt(3), of Gauss and Hermite's three

struct OnPicture {
    double x, y;      // px
    double distance;  // that splats are sorted by, scene units
    double px_per_unit;
};
constexpr OnPicture nowhere{-1e9, -1e9, 0.0, 1.0};  // out of any splat's reach

std::optional<OnPicture> seen_by(const FrontView& view, const glm::dvec3& p) {
    const std::optional<PlaceInPicture> place = place_in_picture(view.camera, p);
    if (!place) return {};
    const bool parallel = view.camera.projection == Projection::orthographic;
    return OnPicture{place->uv.x * view.camera.aspect * view.height_px, place->uv.y * view.height_px,
                     parallel ? place->depth : glm::length(p - view.camera.eye),
                     view.height_px / picture_height_at(view.camera, place->depth)};
}

// Stars by the cells of the picture that they are seen in.
class StarGrid {
  public:
    StarGrid(const FrontView& view, const std::vector<glm::vec3>& positions) {
        width_ = std::int64_t(view.camera.aspect * view.height_px / star_cell_px) + 1;
        height_ = std::int64_t(view.height_px / star_cell_px) + 1;
        cells_.resize(std::size_t(width_ * height_));
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const auto seen = seen_by(view, glm::dvec3(positions[i]));
            seen_.push_back(seen.value_or(nowhere));
            if (!seen) continue;
            cells_[std::size_t(row(seen->y) * width_ + column(seen->x))].push_back(std::uint32_t(i));
        }
    }

    const OnPicture& star(std::size_t i) const { return seen_[i]; }

    template <class Visit>
    void near(const OnPicture& place, double reach_px, const Visit& visit) const {
        for (std::int64_t j = row(place.y - reach_px); j <= row(place.y + reach_px); ++j)
            for (std::int64_t i = column(place.x - reach_px); i <= column(place.x + reach_px); ++i)
                for (const std::uint32_t star : cells_[j * width_ + i]) {
                    const double dx = seen_[star].x - place.x, dy = seen_[star].y - place.y;
                    if (dx * dx + dy * dy < reach_px * reach_px) visit(star, dx, dy);
                }
    }

  private:
    static std::int64_t cell(double px, std::int64_t count) {
        return std::int64_t(std::clamp(px / star_cell_px, 0.0, double(count - 1)));
    }
    std::int64_t row(double y) const { return cell(y, height_); }
    std::int64_t column(double x) const { return cell(x, width_); }

    std::int64_t width_, height_;
    std::vector<OnPicture> seen_;
    std::vector<std::vector<std::uint32_t>> cells_;
};

// A splat before a star.
struct Hit {
    std::uint32_t star;
    float distance;   // of the splat, scene units
    glm::vec3 depth;  // optical, of each channel
};

// The footprint of a splat as the pixel filter shows it: its own where it is wide, else a Gaussian of the
// same integral and variance.
class Footprint {
  public:
    Footprint(double radius_px, double filter_px) {
        const double sigma = radius_px / double(radius_sigmas);
        variance_ = footprint_variance * sigma * sigma + filter_px * filter_px;
        share_ = double(footprint_share) * sigma * sigma / variance_;
        if (sigma > gaussian_ends * filter_px) own_radius_ = radius_px;
    }
    double reach_px() const { return own_radius_ > 0.0 ? own_radius_ : gaussian_ends * std::sqrt(variance_); }
    double at(double square) const {
        if (!(own_radius_ > 0.0)) return share_ * real::exp(-0.5 * square / variance_);
        constexpr double sharpness = 4.5;  // of the default falloff
        static const double rim = real::exp(-sharpness);
        const double t2 = square / (own_radius_ * own_radius_);
        return t2 < 1.0 ? (real::exp(-sharpness * t2) - rim) / (1.0 - rim) : 0.0;
    }

  private:
    double variance_ = 1.0, share_ = 1.0, own_radius_ = 0.0;
};

// Mean over the star's image, whose Gaussian three places a side stand for.
double mean_hiding(const Footprint& footprint, double alpha, double dx, double dy, double star_px) {
    constexpr double weights[] = {1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0};
    const double step = outer_place * star_px;
    double sum = 0.0;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
            const double x = dx + i * step, y = dy + j * step;
            sum += weights[i + 1] * weights[j + 1] * footprint.at(x * x + y * y);
        }
    return std::min(alpha * sum, most_hiding);
}

void find_hits(const FrontView& view, const SplatSet& splats, std::size_t index, const StarGrid& grid,
               std::vector<Hit>& hits) {
    const auto seen = seen_by(view, glm::dvec3(splats.position[index]));
    if (!seen) return;
    const Footprint footprint(double(splats.radius[index]) * seen->px_per_unit, view.filter_px);
    const glm::vec3& color = splats.color[index];
    const bool absorbs = splats.absorbs && color.x < 0.0f;
    const glm::vec3 exponent = absorbs ? -color : glm::vec3(1.0f);
    grid.near(*seen, footprint.reach_px() + outer_place * view.star_px,
              [&](std::uint32_t star, double dx, double dy) {
                  const double s = mean_hiding(footprint, double(splats.alpha[index]), dx, dy, view.star_px);
                  const double depth = -real::log(1.0 - s);
                  if (depth > least_depth)
                      hits.push_back({star, float(seen->distance), exponent * float(depth)});
              });
}

// In order of stars, then of distance.
std::vector<Hit> all_hits(const FrontView& view, const SplatSet& splats, const StarGrid& grid,
                          const Progress& progress) {
    const std::int64_t tasks = (splats.size() + splats_per_task - 1) / splats_per_task;
    std::vector<std::vector<Hit>> parts(tasks);
    parallel_for(tasks, [&](std::int64_t task, int) {
        progress.check();
        const std::int64_t end = std::min(splats.size(), (task + 1) * splats_per_task);
        for (std::int64_t i = task * splats_per_task; i < end; ++i)
            find_hits(view, splats, std::size_t(i), grid, parts[task]);
    });
    std::vector<Hit> hits;
    for (std::vector<Hit>& part : parts) {
        hits.insert(hits.end(), part.begin(), part.end());
        part = {};
    }
    std::stable_sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
        return a.star != b.star ? a.star < b.star : a.distance < b.distance;
    });
    return hits;
}

// To that distance from the eye, along the ray.
glm::vec3 moved_to(const FrontView& view, const glm::vec3& position, double from, double to) {
    const glm::dvec3 p(position);
    if (view.camera.projection == Projection::orthographic)
        return glm::vec3(p + (from - to) * view.camera.world_from_camera[2]);
    return glm::vec3(view.camera.eye + (p - view.camera.eye) * (to / from));
}

}  // namespace

std::vector<glm::dvec3> passing_light(const FrontView& view, const SplatSet& splats,
                                      std::vector<glm::vec3>& position, const Progress& progress) {
    assert(splats.radius.size() == splats.position.size());
    constexpr double just_before = 1.0 - 1e-5;  // of a splat's distance, in single precision, too
    const double most_depth = -real::log(least_passing);
    const StarGrid grid(view, position);
    const std::vector<Hit> hits = all_hits(view, splats, grid, progress);
    std::vector<glm::dvec3> passing(position.size(), glm::dvec3(1.0));
    for (std::size_t begin = 0; begin < hits.size();) {
        const std::size_t star = hits[begin].star;
        const double distance = grid.star(star).distance;
        glm::dvec3 depth(0.0);
        std::size_t i = begin;
        for (; i < hits.size() && hits[i].star == star && double(hits[i].distance) < distance; ++i) {
            const glm::dvec3 more = depth + glm::dvec3(hits[i].depth);
            if (std::max({more.x, more.y, more.z}) > most_depth) {
                position[star] =
                    moved_to(view, position[star], distance, just_before * double(hits[i].distance));
                break;
            }
            depth = more;
        }
        passing[star] = {real::exp(-depth.x), real::exp(-depth.y), real::exp(-depth.z)};
        while (begin < hits.size() && hits[begin].star == star) ++begin;
    }
    return passing;
}

}  // namespace astrosplat

// Depths follow the difference of two placements by the picture at a small size, so that nothing jumps where
// a drag begins, and what such a picture lacks cancels.
#include "bodies/moved_bodies.h"

#include <map>

#include "bodies/axis_depths.h"
#include "bodies/axis_fit.h"
#include "bodies/bodies.h"
#include "bodies/dust.h"
#include "bodies/galaxies.h"
#include "bodies/picture_light.h"
#include "bodies/picture_splats.h"
#include "bodies/placement.h"
#include "bodies/spikes.h"
#include "bodies/stars.h"
#include "bodies/uv_surface.h"
#include "core/parallel.h"
#include "core/real.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

constexpr std::int64_t texels_with_stars = 2'000'000;  // of which stars are found
constexpr std::int64_t rows_at_once = 8;               // blocks of a thread

/// Rows of one band and size; texels of the picture.
struct Group {
    int number = 0, size = 0;
    std::vector<std::uint32_t> row;
    std::vector<float> x, y, even;
    std::vector<std::uint32_t> random;
    std::vector<SurfacePlace> place;
    std::vector<float> z;                        // as they are
    std::vector<float> model_z, model_distance;  // as the small placement has them
};

struct Depths {
    std::vector<float> z, distance;
};

StructureParams with_planes(StructureParams params, std::span<const GalaxyPlane> found,
                            double height_over_width) {
    std::vector<GalaxyParams*> told;
    if (params.galaxies.empty()) told.push_back(&params.galaxy);
    for (GalaxyParams& galaxy : params.galaxies) told.push_back(&galaxy);
    for (std::size_t k = 0; k < std::min(told.size(), found.size()); ++k) {
        const double angle_deg = real::degrees(found[k].angle);
        GalaxyParams& galaxy = *told[k];
        if (!galaxy.near_side)
            galaxy.near_side = galaxy.position_angle.value_or(angle_deg) + 90.0 * found[k].near_side;
        if (!galaxy.position_angle) galaxy.position_angle = angle_deg;
        if (!galaxy.inclination) galaxy.inclination = found[k].inclination_deg;
        if (!galaxy.center) galaxy.center = glm::dvec2(found[k].x, 1.0 - found[k].y / height_over_width);
    }
    return params;
}

double mean_square(std::span<const float> values) {
    double sum = 1e-12;
    for (const float value : values) sum += double(value) * double(value);
    return sum / double(std::max<std::size_t>(values.size(), 1));
}

bool same_axis(const StructureParams& a, const StructureParams& b) {
    return a.axis_angle == b.axis_angle && a.tilt == b.tilt;
}

}  // namespace

struct MovedBodies::Picture {
    ImageSize size;
    UvSurface surface;
    Image light, brightest;  // small
    std::uint32_t seed = 0;
    std::vector<Band> bands;
    std::vector<Star> stars;  // texels of the picture
    std::vector<GalaxyPlane> planes;
    mutable PlacementSight sight;  // of the model asked for last
    Placement before;
    std::vector<Group> groups;

    /// `seen`: the picture at a size at which its stars are found; `small`: that of the light.
    Picture(const TexturedMesh& mesh, std::uint32_t material, const Texture& seen, const ImageSize& small,
            const StructureParams& params, std::uint32_t picture_seed)
        : size{mesh.textures[material].image.width, mesh.textures[material].image.height},
          surface(surface_of(mesh, material)),
          seed(picture_seed),
          bands(make_bands(size.width)) {
        sight.galaxies.coarse = true;
        PictureLight picture = picture_light(seen, params.border);
        brightest = reduced_by_area(brightest_channel(picture.light), small.width, small.height);
        take_stars_out(picture.light, params);
        light = reduced_by_area(picture.light, small.width, small.height);
        if (params.kind == StructureKind::disk) planes = galaxy_planes(light, params);
        before = placement_under(params, params);
    }

    /// As make_bodies() does: a galaxy's core may be one.
    void take_stars_out(Image& picture, const StructureParams& params) {
        if (params.stars == StructureParams::Stars::no) return;
        Spikes spikes = take_spikes(picture, 1);
        stars = take_picture_stars(picture, params, false, std::move(spikes.gaussians)).all;
        const float texels = float(size.width) / float(picture.width);
        for (Star& star : stars) {
            star.x *= texels;
            star.y *= texels;
            star.sigma *= texels;
        }
    }

    Placement placement_under(const StructureParams& made, StructureParams now) const {
        std::optional<AxisDepths> about;
        if (now.kind == StructureKind::axis) {
            const bool known = before.picture_width > 0 && made.kind == now.kind && same_axis(made, now);
            if (known) {
                about = before.axis;
            } else if (AxisFit fit = fit_axis(light, now); is_about_axis(fit)) {
                about = make_axis_depths(std::move(fit), light, size.width);
            }
            if (!about) now.kind = StructureKind::walls;
        }
        if (!planes.empty())
            now = with_planes(std::move(now), planes, double(light.height) / double(light.width));
        return make_placement(light, now, surface.texels_per_unit(), surface.flat(), seed, stars,
                              std::move(about), size, &sight);
    }

    BandSplats splats_of(const Group& group, const Placement& placement) const {
        const int detail = group.number - first_detail_number;
        const std::size_t index =
            detail >= 0 ? std::size_t(detail) % 4 : std::min(std::size_t(group.number), bands.size() - 1);
        const std::vector<BandSplats> sizes =
            detail >= 0 ? detail_splats(bands[index], detail / 4, placement)
                        : band_splats(bands[index], index + 1 == bands.size(), placement);
        return sizes[std::min(std::size_t(group.size), sizes.size() - 1)];
    }

    void place_block(const Placement& placement, const Group& group, const BandSplats& splats,
                     std::size_t first, PlacedBlock& block) const;
    Depths depths(const Placement& placement, const Group& group) const;
    void add(const SplatSet& rows, std::uint32_t row, Group& group) const;
    void set_randoms(const SplatSet& rows, Group& group) const;
    struct Movement;
    void move(const Group& group, const StructureParams& made, const StructureParams& now,
              const Placement& placement, SplatSet& rows) const;
};

void MovedBodies::Picture::place_block(const Placement& placement, const Group& group,
                                       const BandSplats& splats, std::size_t first,
                                       PlacedBlock& block) const {
    block.count = int(std::min(group.row.size() - first, std::size_t(DepthBlock::size)));
    std::copy_n(group.x.data() + first, block.count, block.x);
    std::copy_n(group.y.data() + first, block.count, block.y);
    std::copy_n(group.even.data() + first, block.count, block.even);
    std::copy_n(group.random.data() + first, block.count, block.random);
    const auto add_plane = [&] {
        for (int i = 0; i < block.count; ++i) {
            block.distance[i] = std::fabs(block.z[i]);
            block.z[i] += middle_plane(placement, block.x[i], block.y[i]);
        }
    };
    if (group.number < int(spike_band)) return place(placement, splats, block);
    if (group.number == int(dust_band)) {
        place_dust(placement, block);
        return add_plane();
    }
    for (int i = 0; i < block.count; ++i)
        block.z[i] = star_height(placement, block.x[i], block.y[i], block.even[i]);
    add_plane();
}

Depths MovedBodies::Picture::depths(const Placement& placement, const Group& group) const {
    Depths found{std::vector<float>(group.row.size()), std::vector<float>(group.row.size())};
    BandSplats splats;
    if (group.number < int(spike_band)) splats = splats_of(group, placement);
    parallel_chunks(std::ssize(group.row), rows_at_once * DepthBlock::size,
                    [&](std::int64_t begin, std::int64_t end, int) {
                        for (std::int64_t first = begin; first < end; first += DepthBlock::size) {
                            PlacedBlock block;
                            place_block(placement, group, splats, std::size_t(first), block);
                            std::copy_n(block.z, block.count, found.z.data() + first);
                            std::copy_n(block.distance, block.count, found.distance.data() + first);
                        }
                    });
    return found;
}

void MovedBodies::Picture::add(const SplatSet& rows, std::uint32_t row, Group& group) const {
    const glm::vec2 uv = rows.uv[row];
    std::optional<SurfacePlace> place;
    surface.at(uv, [&](const SurfacePlace& found) {
        const auto off = [&](const SurfacePlace& p) { return glm::length(rows.position[row] - p.position); };
        if (!place || off(found) < off(*place)) place = found;
    });
    if (!place) return;
    const float along = glm::dot(rows.position[row] - place->position, place->rise) /
                        std::max(1e-30f, glm::dot(place->rise, place->rise) * place->units_per_texel);
    group.row.push_back(row);
    group.x.push_back(uv.x * float(size.width));
    group.y.push_back((1.0f - uv.y) * float(size.height));
    group.place.push_back(*place);
    group.z.push_back(along_parallels(*place, along));
}

/// The random numbers that the splats were made with; of stars the share of those that lie behind them.
void MovedBodies::Picture::set_randoms(const SplatSet& rows, Group& group) const {
    const std::size_t count = group.row.size();
    group.random.resize(count);
    group.even.resize(count);
    const bool is_band = group.number < int(spike_band);
    BandSplats splats;
    if (is_band) splats = splats_of(group, before);
    const std::uint64_t of_band = std::uint64_t(group.number) << 8 | std::uint64_t(group.size);
    const std::uint32_t key = before.hash_of(is_band ? of_band : dust_band << band_bit, shared::PURPOSE_EVEN);
    parallel_each(count, 4096, [&](std::size_t i) {
        const std::uint32_t row = group.row[i];
        group.random[i] = before.hash_of(id_in_picture(rows.id[row]), shared::PURPOSE_DEPTH);
        if (!is_band && group.number != int(dust_band)) {
            float low = 0.0f, high = 1.0f;
            for (int step = 0; step < 24; ++step) {
                const float middle = 0.5f * (low + high);
                const float z = star_height(before, group.x[i], group.y[i], middle) +
                                middle_plane(before, group.x[i], group.y[i]);
                (z < group.z[i] ? low : high) = middle;
            }
            group.even[i] = 0.5f * (low + high);
            return;
        }
        float spacing = dust_spacing;
        if (is_band) {
            const SurfacePlace& place = group.place[i];
            const float texel =
                place.units_per_texel * (1.0f - place.approach * along_rays(place, group.z[i]));
            spacing = splats.spacing * (rows.radius[row] / (radius_sigmas * texel)) / splats.sigma;
        }
        const LatticeCell cell{std::int64_t(group.x[i] / spacing), std::int64_t(group.y[i] / spacing)};
        group.even[i] = even_number(cell, key);
    });
}

namespace {

struct Depth {
    float z;                // texels
    float distance = 0.0f;  // as the model has it, texels
    float grows = 1.0f;     // of a distance, before that of the models
};

}  // namespace

/// How depths follow those of the model. On a galaxy's plane heights grow as the model's do at that radius:
/// its noise, whose waves are as long as the disk is thick, would be others at every step, and boil. Else
/// what the model misses is added to its depths; but where the noise is to be another one.
struct MovedBodies::Picture::Movement {
    static constexpr int radii = 8;
    const Picture& picture;
    const Group& group;
    const Placement& placement;
    const Depths& found;
    bool redrawn = false, on_plane = false;
    float missed_grows = 1.0f;
    std::array<float, radii> heights_grow{};

    Movement(const Picture& of, const Group& group_of, const StructureParams& made,
             const StructureParams& now, const Placement& placement_now, const Depths& depths)
        : picture(of), group(group_of), placement(placement_now), found(depths) {
        constexpr float least_cosine = 0.25f;  // of a plane that is seen from its edge depths are no heights
        const std::vector<GalaxyBody>&before = of.before.galaxies, &galaxies = placement_now.galaxies;
        redrawn = made.kind != now.kind || made.clumps != now.clumps || made.spiral != now.spiral;
        on_plane = !redrawn && !galaxies.empty() && before.size() == galaxies.size() &&
                   group.number < int(spike_band);
        for (std::size_t k = 0; on_plane && k < galaxies.size(); ++k)
            on_plane = std::min(before[k].cos_i, galaxies[k].cos_i) > least_cosine;
        if (on_plane) set_growth();
        if (made.kind == StructureKind::walls)
            missed_grows = float(std::sqrt(mean_square(found.z) / mean_square(group.model_z)));
    }

    int radius_of(std::size_t i) const {
        const glm::vec2 middle(0.5f * float(picture.size.width), 0.5f * float(picture.size.height));
        const float r = glm::length(glm::vec2(group.x[i], group.y[i]) - middle) / glm::length(middle);
        return std::min(int(r * float(radii)), radii - 1);
    }

    void set_growth() {
        std::array<double, radii> was, is;
        was.fill(1e-6);
        is.fill(1e-6);
        for (std::size_t i = 0; i < group.row.size(); ++i) {
            const auto r = std::size_t(radius_of(i));
            was[r] += std::fabs(double(height_on(picture.before, i, group.model_z[i])));
            is[r] += std::fabs(double(height_on(placement, i, found.z[i])));
        }
        for (std::size_t r = 0; r < radii; ++r) heights_grow[r] = float(is[r] / was[r]);
    }

    /// Over the plane of the galaxy there; of the placement of now, or that before.
    float height_on(const Placement& of, std::size_t i, float z) const {
        const float x = group.x[i], y = group.y[i];
        return of.galaxies[galaxy_of(i)].in_disk(x, y, z - middle_plane(of, x, y)).z;
    }
    std::size_t galaxy_of(std::size_t i) const {
        const GalaxyBody& galaxy = picture.before.galaxy_at(group.x[i], group.y[i], group.random[i]);
        return std::size_t(&galaxy - picture.before.galaxies.data());
    }

    Depth of(std::size_t i) const {
        if (redrawn) return {found.z[i], found.distance[i], 0.0f};
        if (!on_plane)
            return {found.z[i] + missed_grows * (group.z[i] - group.model_z[i]), found.distance[i], 1.0f};
        const float x = group.x[i], y = group.y[i], grows = heights_grow[std::size_t(radius_of(i))];
        const GalaxyBody& galaxy = placement.galaxies[galaxy_of(i)];
        const float height = height_on(picture.before, i, group.z[i]), on_it = galaxy.in_disk(x, y, 0.0f).z;
        return {(height * grows - on_it) / galaxy.cos_i + middle_plane(placement, x, y),
                group.model_distance[i] * grows, grows};
    }
};

void MovedBodies::Picture::move(const Group& group, const StructureParams& made, const StructureParams& now,
                                const Placement& placement, SplatSet& rows) const {
    const Depths found = depths(placement, group);
    const Movement movement(*this, group, made, now, placement, found);
    const Opacity old_opacity{float(made.opacity), float(made.density)},
        opacity{float(now.opacity), float(now.density)};
    const bool same_opacity = made.opacity == now.opacity && made.density == now.density;
    const auto dust = float(dust_of(now) / std::max(1e-6, dust_of(made)));
    const bool is_band = group.number < int(spike_band), is_dust = group.number == int(dust_band);
    parallel_each(group.row.size(), 512, [&](std::size_t i) {
        const std::uint32_t row = group.row[i];
        const SurfacePlace& place = group.place[i];
        const float old_along = along_rays(place, group.z[i]);
        const Depth depth = movement.of(i);
        const float along = along_rays(place, depth.z);
        rows.position[row] += place.rise * ((along - old_along) * place.units_per_texel);
        rows.radius[row] *= (1.0f - place.approach * along) / (1.0f - place.approach * old_along);
        rows.distance[row] = std::max(
            0.0f, rows.distance[row] * depth.grows +
                      (depth.distance - group.model_distance[i] * depth.grows) * place.units_per_texel);
        float& alpha = rows.alpha[row];
        if (is_dust) {
            alpha = 1.0f - shared::as_pow(1.0f - std::min(alpha, 0.999f), dust);
        } else if (!same_opacity) {
            const float shines =
                bilinear(brightest, 0, group.x[i] * before.to_light, group.y[i] * before.to_light);
            const float old_tau = old_opacity.depth_of(shines, 1.0f), tau = opacity.depth_of(shines, 1.0f);
            const float as_made = alpha;
            alpha = std::clamp(alpha * tau / std::max(old_tau, 1e-6f), 1e-6f, 1.0f);
            rows.color[row] *= as_made / alpha * (is_band ? boost_of(tau) / boost_of(old_tau) : 1.0f);
        }
        if (is_band && placement.axis && before.axis) {
            const glm::vec3 tint = placement.axis->tint(group.x[i], group.y[i], found.z[i]),
                            old_tint = before.axis->tint(group.x[i], group.y[i], group.model_z[i]);
            rows.color[row] *= tint / glm::max(old_tint, glm::vec3(1e-3f));
        }
    });
}

MovedBodies::MovedBodies(std::vector<TexturedMesh> meshes, const StructureParams& params, std::uint32_t seed,
                         SplatSet rows, std::int64_t small_texels)
    : meshes_(std::move(meshes)), params_(params), rows_(std::move(rows)) {
    std::vector<std::unique_ptr<Picture>> pictures;
    for (const PictureOnMesh& picture : pictures_of(meshes_)) {
        const Texture& texture = picture.texture();
        const std::int64_t w = texture.image.width, h = texture.image.height;
        const auto reduced = [&](std::int64_t texels) {
            return size_of_area(w, h, std::min(double(texels), double(w * h)), 1.0);
        };
        Texture seen;
        seen.alpha_from_light = texture.alpha_from_light;
        seen.wrap = texture.wrap;
        const ImageSize with_stars = reduced(texels_with_stars);
        seen.image = reduced_by_area(texture.image, with_stars.width, with_stars.height);
        pictures.push_back(std::make_unique<Picture>(*picture.mesh, picture.material, seen,
                                                     reduced(small_texels), params,
                                                     seed + std::uint32_t(pictures.size())));
    }
    std::map<std::pair<std::uint64_t, std::uint64_t>, Group> groups;  // by picture, band and size
    for (std::size_t row = 0; row < rows_.id.size(); ++row) {
        const std::uint64_t id = rows_.id[row], picture = id >> picture_bit;
        if (picture >= pictures.size()) continue;
        Group& group = groups[{picture, id_in_picture(id) >> size_bit}];
        group.number = int(band_of(id));
        group.size = int(id_in_picture(id) >> size_bit & 3);
        pictures[picture]->add(rows_, std::uint32_t(row), group);
    }
    for (auto& [key, group] : groups) {
        Picture& picture = *pictures[key.first];
        picture.set_randoms(rows_, group);
        Depths model = picture.depths(picture.before, group);
        group.model_z = std::move(model.z);
        group.model_distance = std::move(model.distance);
        picture.groups.push_back(std::move(group));
    }
    for (auto& picture : pictures) pictures_.push_back(std::move(picture));
    for (TexturedMesh& mesh : meshes_) mesh.textures.clear();
}

MovedBodies::MovedBodies(MovedBodies&&) noexcept = default;

MovedBodies::~MovedBodies() = default;

SplatSet MovedBodies::under(const StructureParams& now) const {
    SplatSet rows = rows_;
    if (now == params_) return rows;
    for (const auto& picture : pictures_) {
        const Placement placement = picture->placement_under(params_, now);
        for (const Group& group : picture->groups) picture->move(group, params_, now, placement, rows);
    }
    return rows;
}

bool only_moves_bodies(const StructureParams& before, const StructureParams& now) {
    if (before.kind == StructureKind::columns || now.kind == StructureKind::columns) return false;
    StructureParams same = now;
    same.kind = before.kind;
    same.height = before.height;
    same.depth = before.depth;
    same.clumps = before.clumps;
    same.flare = before.flare;
    same.warp = before.warp;
    same.galaxy = before.galaxy;
    same.galaxies = before.galaxies;
    same.spiral = before.spiral;
    same.axis_angle = before.axis_angle;
    same.tilt = before.tilt;
    same.opacity = before.opacity;
    same.density = before.density;
    same.dust = before.dust;
    return same == before;
}

}  // namespace astrosplat

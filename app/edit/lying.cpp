#include "edit/lying.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/real.h"
#include "edit/edits.h"
#include "edit/view_camera.h"

namespace astrosplat {
namespace {

constexpr double plane_side = 10.0;    // scene units, of the built-in plane
constexpr double radius_share = 0.36;  // of the picture's shorter side: the whole ring is seen
constexpr double mark_share = 0.2;     // of the radius, by which the mark lies outside
constexpr double tenth_deg = 0.1;      // degrees

double within_turn(double degrees, double turn) { return degrees - turn * std::floor(degrees / turn); }

glm::dvec2 direction(double degrees) {
    return {real::cos(real::radians(degrees)), real::sin(real::radians(degrees))};
}

struct PictureSides {
    double width, height, distance;
};

/// None where the picture does not lie on the plane before a camera in its middle.
std::optional<PictureSides> sides_of(const Scene& scene, const SourceParams& source) {
    const UvCamera& camera = source.uv_camera;
    if (source.kind != SourceKind::mesh || source.meshes.size() != 1 || source.meshes[0].mesh != "plane" ||
        source.uv != UvMode::camera || !camera.position)
        return {};
    const glm::dvec3 eye = *camera.position;
    if (eye.x != 0.0 || eye.z != 0.0 || !(eye.y > 0.0) || camera.target != glm::dvec3(0.0) ||
        camera.up != glm::dvec3(0.0, 0.0, -1.0))
        return {};
    const double height =
        camera.height > 0.0 ? camera.height : 2.0 * eye.y * real::tan(real::radians(0.5 * camera.fov));
    constexpr double nearly = 1e-3;  // a picture as high as the plane is at most as wide
    const double width = height < plane_side * (1.0 - nearly)
                             ? plane_side
                             : std::min(plane_side, plane_side * aspect_of(scene.output));
    return PictureSides{width, height, eye.y};
}

std::optional<LyingRing> ring_of(const GalaxyParams& galaxy, const PictureSides& sides) {
    if (!galaxy.inclination || !galaxy.position_angle || !galaxy.center || !galaxy.near_side) return {};
    LyingRing ring;
    ring.inclination = *galaxy.inclination;
    const double from_axis = real::radians(*galaxy.near_side - *galaxy.position_angle);
    ring.near_deg = *galaxy.position_angle + (real::sin(from_axis) >= 0.0 ? 90.0 : -90.0);
    ring.center = {(galaxy.center->x - 0.5) * sides.width, (galaxy.center->y - 0.5) * sides.height};
    return ring;
}

/// The value from `low` to `high` at which `at` is nearest to `wanted_px`: first in whole steps, then in
/// tenths.
template <class At>
double nearest_value(double low, double high, const glm::dvec2& wanted_px, const At& at) {
    double best = low, least = 1e300;
    const auto look = [&](double from, double to, double step) {
        for (double value = std::max(low, from); value <= std::min(high, to) + 1e-9; value += step) {
            const std::optional<glm::dvec2> px = at(value);
            const double off = px ? glm::distance(*px, wanted_px) : 1e300;
            if (off < least) least = off, best = value;
        }
    };
    look(low, high, 1.0);
    const double coarse = best;
    look(coarse - 1.0, coarse + 1.0, tenth_deg);
    return rounded_to_step(best, tenth_deg);
}

}  // namespace

std::vector<LyingRing> lying_rings(const Scene& now, std::size_t index) {
    std::vector<LyingRing> rings;
    if (index >= now.layers.size()) return rings;
    const LayerParams& layer = now.layers[index];
    const std::optional<PictureSides> sides = sides_of(now, layer.source);
    if (!sides) return rings;
    const StructureParams& structure = layer.source.structure;
    const ParameterKey key = layer_key(layer.name) / "source.structure";
    const auto add = [&](std::optional<LyingRing> ring, const std::string& of) {
        if (!ring) return;
        ring->key = of;
        ring->radius = radius_share * std::min(sides->width, sides->height);
        ring->distance = sides->distance;
        ring->placement = placement_of(layer.transform);
        rings.push_back(*ring);
    };
    if (structure.kind == StructureKind::disk && structure.galaxies.empty())
        add(ring_of(structure.galaxy, *sides), key);
    for (std::size_t i = 0; structure.kind == StructureKind::disk && i < structure.galaxies.size(); ++i)
        add(ring_of(structure.galaxies[i], *sides), key / "galaxies" / i);
    if (structure.kind == StructureKind::axis && structure.axis_angle && structure.tilt) {
        LyingRing equator;
        equator.about_axis = true;
        equator.inclination = 90.0 - *structure.tilt;
        equator.near_deg = *structure.axis_angle + 180.0;
        add(equator, key);
    }
    return rings;
}

namespace {

/// Of a place in the picture, `depth` nearer, along the ray to the picture's camera.
glm::dvec3 in_world(const LyingRing& ring, const glm::dvec2& place, double depth) {
    const glm::dvec3 flat(place.x, 0.0, -place.y), eye(0.0, ring.distance, 0.0);
    return to_world(ring.placement, glm::mix(flat, eye, depth / ring.distance));
}

}  // namespace

glm::dvec3 point_on(const LyingRing& ring, double degrees) {
    const glm::dvec2 near = direction(ring.near_deg), major = direction(ring.near_deg - 90.0),
                     turn = direction(degrees), tilt = direction(ring.inclination);
    return in_world(ring, ring.center + ring.radius * (turn.x * major + turn.y * tilt.x * near),
                    ring.radius * turn.y * tilt.y);
}

glm::dvec3 axis_end(const LyingRing& ring) {
    const glm::dvec2 tilt = direction(ring.inclination);
    return in_world(ring, ring.center - ring.radius * tilt.y * direction(ring.near_deg),
                    ring.radius * tilt.x);
}

namespace {

std::optional<glm::dvec2> grip_px(const Camera& camera, const LyingRing& ring, LyingGrip::Of of) {
    const double degrees = lying_grips[std::size_t(of)].degrees;
    glm::dvec3 at = point_on(ring, degrees);
    if (LyingGrip{of}.is_mark()) {
        const glm::dvec2 tilt = direction(ring.inclination);
        const double side = degrees == 90.0 ? 1.0 : -1.0;
        at = in_world(ring,
                      ring.center + side * ring.radius * (tilt.x + mark_share) * direction(ring.near_deg),
                      side * ring.radius * tilt.y);
    }
    const auto px = project_point(camera, at);
    return px ? std::optional(glm::dvec2(*px)) : std::nullopt;
}

}  // namespace

std::vector<SeenGrip> grips_of(const Camera& camera, const LyingRing& ring) {
    std::vector<SeenGrip> grips;
    for (std::size_t i = 1; i < std::size(lying_grips); ++i) {
        const auto of = static_cast<LyingGrip::Of>(i);
        if (ring.about_axis && !lying_grips[i].of_equator) continue;
        if (const std::optional<glm::dvec2> px = grip_px(camera, ring, of)) grips.push_back({of, *px});
    }
    return grips;
}

LyingGrip grip_at(const Camera& camera, std::span<const LyingRing> rings, const glm::dvec2& mouse_px,
                  double reach_px) {
    LyingGrip found;
    double least = reach_px;
    for (std::size_t i = 0; i < rings.size(); ++i)
        for (const SeenGrip& grip : grips_of(camera, rings[i]))
            if (const double off = glm::distance(grip.px, mouse_px); off < least)
                least = off, found = {grip.of, i};
    return found;
}

LyingRing turned_over(LyingRing ring) {
    ring.near_deg = within_turn(ring.near_deg + 180.0, 360.0);
    return ring;
}

LyingRing dragged(const LyingRing& pressed, LyingGrip::Of of, const Camera& camera, const glm::dvec2& from_px,
                  const glm::dvec2& to_px) {
    LyingRing ring = pressed;
    const std::optional<glm::dvec2> from = grip_px(camera, pressed, of);
    if (!from || of == LyingGrip::Of::none) return ring;
    const glm::dvec2 wanted = *from + to_px - from_px;
    const auto with = [&](double LyingRing::*value) {
        return [&ring, &camera, of, value](double tried) {
            ring.*value = tried;
            return grip_px(camera, ring, of);
        };
    };
    if (LyingGrip{of}.is_mark()) {
        const LyingRing other = turned_over(pressed);
        const std::optional<glm::dvec2> there = grip_px(camera, other, of);
        return there && glm::distance(*there, wanted) < glm::distance(*from, wanted) ? other : pressed;
    }
    const bool turns_in_picture = of == LyingGrip::Of::major || of == LyingGrip::Of::major_other;
    if (turns_in_picture) {
        const double before = pressed.near_deg;
        ring.near_deg = nearest_value(before - 180.0, before + 180.0, wanted, with(&LyingRing::near_deg));
    } else {
        const double low = pressed.about_axis ? 10.0 : 0.0, high = pressed.about_axis ? 170.0 : 90.0;
        ring.inclination = nearest_value(low, high, wanted, with(&LyingRing::inclination));
    }
    return ring;
}

std::vector<NewValue> changed_values(const LyingRing& before, const LyingRing& after) {
    std::vector<NewValue> values;
    const ParameterKey key(before.key);
    if (after.inclination != before.inclination)
        values.push_back(before.about_axis
                             ? NewValue{key / "tilt", rounded_to_step(90.0 - after.inclination, tenth_deg)}
                             : NewValue{key / "inclination", after.inclination});
    if (after.near_deg == before.near_deg) return values;
    const auto turned = [](double degrees, double turn) {
        return rounded_to_step(within_turn(rounded_to_step(degrees, tenth_deg), turn), tenth_deg);
    };
    if (before.about_axis) {
        values.push_back({key / "axis_angle", turned(after.near_deg - 180.0, 360.0)});
        return values;
    }
    const double over = within_turn(after.near_deg - before.near_deg, 360.0);
    if (std::fabs(over - 180.0) > tenth_deg)
        values.push_back({key / "position_angle", turned(after.near_deg - 90.0, 180.0)});
    values.push_back({key / "near_side", turned(after.near_deg, 360.0)});
    return values;
}

std::string lying_in_words(const LyingRing& ring) {
    if (ring.about_axis)
        return fmt::format("Axis {:.1f} degrees, tilt {:.1f}", within_turn(ring.near_deg - 180.0, 360.0),
                           90.0 - ring.inclination + 0.0);
    return fmt::format("Inclination {:.1f} degrees, position angle {:.1f}, near side {:.1f}",
                       ring.inclination, within_turn(ring.near_deg - 90.0, 180.0),
                       within_turn(ring.near_deg, 360.0));
}

}  // namespace astrosplat

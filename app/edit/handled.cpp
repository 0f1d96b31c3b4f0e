#include "edit/handled.h"

#include <cmath>
#include <glm/matrix.hpp>

#include "core/real.h"
#include "core/rotation.h"
#include "edit/placement.h"
#include "edit/project_line.h"
#include "edit/rounding.h"
#include "scene/parameter.h"

namespace astrosplat {
namespace {

constexpr double angle_step = 0.1;   // degrees
constexpr double share_step = 1e-3;  // of a size

const Crop* chosen_crop(const Scene& now, const ViewState& view) {
    if (view.handle_target != HandleTarget::crop || view.layer >= now.layers.size()) return nullptr;
    const std::vector<Crop>& crops = now.layers[view.layer].look.crop;
    return view.handle_crop < crops.size() ? &crops[view.handle_crop] : nullptr;
}

glm::dmat3 axes_of(const Crop& crop) {
    const bool turns = crop.shape == Crop::Shape::box;
    return turns ? rotation_from_degrees(glm::dvec3(crop.rotate)) : glm::dmat3(1.0);
}

/// Where `now` differs from `before`, rounded; the rest stays as it was.
Value rounded_list(const glm::dvec3& before, const glm::dvec3& now, double step) {
    Value::List list;
    for (int i = 0; i < 3; ++i) {
        const bool stays = std::fabs(now[i] - before[i]) < 1e-3 * step;
        list.emplace_back(stays ? before[i] : rounded_to_step(now[i], step));
    }
    return list;
}

Value rounded_product(double size, double factor) {
    return rounded_to_step(size * factor, std::max(1e-9, size * factor * share_step));
}

NewValue dragged_layer(const LayerParams& layer, HandleTool tool, const Camera& camera,
                       const Handled& handled, const HandleDrag& drag) {
    const std::string at = layer_key(layer.name) / "transform";
    const LayerTransform& t = layer.transform;
    if (tool == HandleTool::rotate)
        return {at + ".rotate",
                rounded_list(
                    t.rotate,
                    degrees_of(turned_by(camera, handled, drag) * rotation_from_degrees(t.rotate), t.rotate),
                    angle_step)};
    if (tool == HandleTool::scale)
        return {at + ".scale", rounded_product(t.scale, scaled_by(camera, handled, drag).x)};
    return {at + ".translate", rounded_list(t.translate, t.translate + moved_by(camera, handled, drag),
                                            units_per_px(camera, handled.origin))};
}

NewValue dragged_crop(const LayerParams& layer, std::size_t index, HandleTool tool, const Camera& camera,
                      const Handled& handled, const HandleDrag& drag) {
    const std::string at = layer_key(layer.name) / "look.crop" / index;
    const Crop& crop = layer.look.crop[index];
    const LayerPlacement placement = placement_of(layer.transform);
    const double step = units_per_px(camera, handled.origin) / placement.scale;
    if (tool == HandleTool::rotate) {
        const glm::dmat3 in_world = turned_by(camera, handled, drag) * placement.rotation * axes_of(crop);
        const glm::dvec3 before(crop.rotate);
        return {at + ".rotate",
                rounded_list(before, degrees_of(glm::transpose(placement.rotation) * in_world, before),
                             angle_step)};
    }
    if (tool == HandleTool::scale) {
        const glm::dvec3 factors = scaled_by(camera, handled, drag), before(crop.size);
        if (crop.shape == Crop::Shape::sphere)
            return {at + ".radius", rounded_product(double(crop.radius), factors.x)};
        return {at + ".size", rounded_list(before, before * factors, step)};
    }
    const glm::dvec3 before(crop.center);
    const glm::dvec3 after =
        to_layer(placement, to_world(placement, before) + moved_by(camera, handled, drag));
    return {at + ".center", rounded_list(before, after, step)};
}

}  // namespace

std::optional<Handled> handled_in(const Scene& now, const ViewState& view) {
    if (view.tool == HandleTool::none) return std::nullopt;
    Handled handled;
    if (view.handle_target == HandleTarget::camera_target) {
        if (view.tool != HandleTool::move || now.camera.rotation || !now.camera.position) return std::nullopt;
        handled.origin = now.camera.target;
        return handled;
    }
    if (view.layer >= now.layers.size()) return std::nullopt;
    const LayerParams& layer = now.layers[view.layer];
    if (view.handle_target == HandleTarget::layer) {
        handled.origin = layer.transform.translate;
        handled.uniform = true;
        return handled;
    }
    const Crop* crop = chosen_crop(now, view);
    const bool is_sphere = crop && crop->shape == Crop::Shape::sphere;
    if (!crop || (is_sphere && view.tool == HandleTool::rotate)) return std::nullopt;
    const LayerPlacement placement = placement_of(layer.transform);
    handled.origin = to_world(placement, glm::dvec3(crop->center));
    handled.axes = placement.rotation * axes_of(*crop);
    handled.uniform = is_sphere;
    return handled;
}

NewValue dragged_value(const Scene& pressed, const ViewState& view, const Camera& camera,
                       const HandleDrag& drag) {
    const Handled handled = *handled_in(pressed, view);
    if (view.handle_target == HandleTarget::camera_target) {
        const glm::dvec3& before = pressed.camera.target;
        return {"camera.target", rounded_list(before, before + moved_by(camera, handled, drag),
                                              units_per_px(camera, handled.origin))};
    }
    const LayerParams& layer = pressed.layers[view.layer];
    if (view.handle_target == HandleTarget::layer)
        return dragged_layer(layer, view.tool, camera, handled, drag);
    return dragged_crop(layer, view.handle_crop, view.tool, camera, handled, drag);
}

std::vector<std::vector<glm::dvec3>> crop_outline(const LayerParams& layer, std::size_t index) {
    const Crop& crop = layer.look.crop[index];
    const LayerPlacement placement = placement_of(layer.transform);
    const glm::dmat3 axes = axes_of(crop);
    const auto at = [&](const glm::dvec3& from_center) {
        return to_world(placement, glm::dvec3(crop.center) + axes * from_center);
    };
    std::vector<std::vector<glm::dvec3>> lines;
    if (crop.shape == Crop::Shape::box) {
        const Bounds box{-0.5 * glm::dvec3(crop.size), 0.5 * glm::dvec3(crop.size)};
        for (int corner = 0; corner < 8; ++corner)
            for (const int side : {1, 2, 4})
                if (!(corner & side))
                    lines.push_back({at(box.corner(corner)), at(box.corner(corner | side))});
        return lines;
    }
    constexpr int pieces = 64;
    for (int axis = 0; axis < 3; ++axis) {
        lines.emplace_back();
        for (int i = 0; i <= pieces; ++i) {
            const double turn = 2.0 * real::pi * i / pieces;
            glm::dvec3 p(0.0);
            p[(axis + 1) % 3] = double(crop.radius) * real::cos(turn);
            p[(axis + 2) % 3] = double(crop.radius) * real::sin(turn);
            lines.back().push_back(at(p));
        }
    }
    return lines;
}

}  // namespace astrosplat

// What the handles of a view act on: the placement of the selected layer, one of its crops, or the camera's
// target. In: the scene at a frame, what was chosen, a drag. Out: the parameter that the drag changes and its
// new value.
#pragma once

#include <optional>
#include <string>

#include "edit/handles.h"
#include "scene/scene.h"
#include "scene/value.h"

namespace astrosplat {

/// In the world; none where there is nothing that the tool could do: the camera's target has no size, a
/// sphere no direction.
std::optional<Handled> handled_in(const Scene& now, const ViewState& view);

struct NewValue {
    std::string key;  // full: "layer.stars.transform.translate"
    Value value;
};

/// The value after a drag that began with `pressed`, the scene at the frame, seen by `camera`. Rounded to
/// what a pixel can tell. `view` chooses a thing that handled_in() finds.
NewValue dragged_value(const Scene& pressed, const ViewState& view, const Camera& camera,
                       const HandleDrag& drag);

/// Boxes and spheres of the crops of a layer, as lines in the world.
std::vector<std::vector<glm::dvec3>> crop_outline(const LayerParams& layer, std::size_t crop);

}  // namespace astrosplat

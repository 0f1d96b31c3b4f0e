// What a view beside the scene's camera draws over the frame: the camera's path and its frustum. In: the
// scene, the frame, the frame and its place. Out: lines in px of the viewport.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "gui/gui.h"
#include "scene/scene.h"
#include "viewer/view_frame.h"

namespace astrosplat {

class CameraOverlay {
  public:
    using Line = std::vector<glm::vec2>;
    /// `now` is the scene at the frame; `place` shows the frame of `request`. No lines where the camera
    /// cannot be made: the frame's badge says why.
    std::vector<Line> lines(const Scene& scene, const Scene& now, const Bounds& box,
                            const ViewRequest& request, const Rect& place);

  private:
    std::vector<glm::dvec3> path_;  // of the scene's camera
    Scene path_of_;                 // the part of the scene that it was made of, with this box
    Bounds path_box_;
};

}  // namespace astrosplat

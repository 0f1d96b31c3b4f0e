// Where a reference picture lies over the view, and what a hand makes of its placement. In: the placement in
// frame heights, the picture's shape, the frame in px. Out: places in px (x to the right, y down),
// and placements.
#pragma once

#include <glm/vec2.hpp>

#include "scene/scene.h"

namespace astrosplat {

/// Px of a picture's upper left corner, and from there along its upper and its left side.
struct PicturePlace {
    glm::dvec2 corner{0.0}, right{1.0, 0.0}, down{0.0, 1.0};
    bool operator==(const PicturePlace&) const = default;
};

/// The frame that a picture lies over.
struct FrameOnScreen {
    glm::dvec2 middle{0.0};  // px
    double height = 1.0;     // px, > 0
};

/// The first of the scene's references that is for this view alone, else the first for any, at this frame;
/// those without a file do not count.
std::optional<std::size_t> find_reference(const Scene& scene, ReferenceParams::View view, double frame);

/// `aspect`: the picture's width / height.
PicturePlace place_of(const ReferenceParams& reference, double aspect, const FrameOnScreen& frame);

/// The part that a press at `px` takes hold of: a corner within `reach` px scales, the inside moves,
/// the rest turns.
enum class PlaceGrip { move, scale, turn };
PlaceGrip grip_at(const PicturePlace& place, glm::dvec2 px, double reach);

/// The placement after the hand that held it went from one point to another, px. Scaling and turning are
/// about the picture's middle.
ReferenceParams dragged(ReferenceParams reference, PlaceGrip grip, glm::dvec2 from, glm::dvec2 to,
                        const FrameOnScreen& frame);
/// `factor` times as large; what lies at `px` stays there.
ReferenceParams scaled_about(ReferenceParams reference, double factor, glm::dvec2 px,
                             const FrameOnScreen& frame);
/// As many digits as can be seen.
ReferenceParams rounded_place(ReferenceParams reference);

}  // namespace astrosplat

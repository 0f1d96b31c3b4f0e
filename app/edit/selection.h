// Parts of a layer that are selected by drawing in a view: the mouse's line becomes an outline among the
// crops of the layer's look (look/look.h), in the layer's own space, so that it stays on what it selects
// wherever layer and camera go.
#pragma once

#include "edit/placement.h"

namespace astrosplat {

/// A line that was drawn in a view, px.
struct DrawnLine {
    std::vector<glm::dvec2> points;  // at least one, of a polygon three
    double radius = 0.0;   // of a brush, in the middle of the line; 0: it goes around what is selected
    double feather = 0.0;  // width of the soft edge where the layer has its middle
};

/// simplified_path() of the line, px; a single point is twice there.
std::vector<glm::dvec2> simplified(std::span<const glm::dvec2> line, double tolerance);

/// What lies behind a line, to be kept. None where it encloses nothing: a polygon of less than three points
/// or of less than a px; and where its directions are too far apart for one outline, which a fisheye can
/// show.
std::optional<Crop> crop_behind(const Camera& camera, const LayerPlacement& placement, const DrawnLine& line);

/// What `fate` says becomes of what a crop keeps: strokes of one view become one crop. Returns the layer of
/// the part.
std::size_t select_part(Scene& scene, std::size_t layer, const Crop& kept, SelectionFate fate);

/// All of a layer that outlines took away is there again.
void forget_outlines(Scene& scene, std::size_t layer);

}  // namespace astrosplat

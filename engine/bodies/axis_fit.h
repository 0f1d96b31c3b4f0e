// Bodies of revolution: which way the axis of a nebula lies and where about it light comes from, found by
// symmetry and inverse rendering (Magnor et al. 2004, Wenger et al. 2013). In: linear light without its
// stars. Out: the axis, its tilt and a grid of rings that shine.
#pragma once

#include <numbers>

#include "core/image.h"
#include "source/source.h"

namespace astrosplat {

struct AxisFit {
    double x = 0.5, y = 0.5;  // its middle, from the top left corner in picture widths (both)
    /// Of the axis in the picture, radians from right counter-clockwise as seen; found ones [0, pi).
    double angle = 0.5 * std::numbers::pi;
    /// By which the end of the axis there leans out of the picture's plane towards the viewer, -80..80. Which
    /// end it is cannot be seen without dust: found ones are >= 0.
    double tilt_deg = 0.0;
    /// Tilts that show the picture about as well. Of an ellipsoid any does: tilt_deg is a choice then.
    double tilt_from_deg = 0.0, tilt_to_deg = 0.0;
    double explained = 0.0;  // share of the picture's light, above the sky's, that the rings are
    /// How alike the picture without its details is on both sides of the axis, the share of its structure
    /// that symmetry explains: 1 the same, 0 as any two of its places.
    double alike = 0.0;
    double reach = 0.0;  // half of the grid's height along the axis, picture widths
    /// Light a picture width, RGB: from left to right heights -reach..reach along the axis, from the top
    /// radii from 0 on in steps as large.
    Image rings;
    bool tilt_is_sure() const { return tilt_to_deg - tilt_from_deg <= 20.0; }
};

/// What of it is known already.
struct GivenAxis {
    std::optional<double> angle;     // radians, as above
    std::optional<double> tilt_deg;  // -80..80
};

/// Whether the picture shows a body about that axis: rings explain enough of its light, and more by symmetry
/// than of a cloud, whose halves can always be made of smooth rings.
bool is_about_axis(const AxisFit& fit);
/// These two shares in words.
std::string symmetry_words(const AxisFit& fit);

/// Fits rings about one axis to the light (RGB, linear, >= 0) of a picture. The same bits with any number of
/// threads.
AxisFit fit_axis(const Image& light, const GivenAxis& given = {});
/// The same with what the scene says of it.
AxisFit fit_axis(const Image& light, const StructureParams& params);

}  // namespace astrosplat

// What the depths of a picture's splats follow (DEPTH 4), as smooth fields over it: how thick a layer is,
// where its middle or the walls of a shell lie, and how much of a shell's light is on neither of its walls.
// In: the picture's light without its stars. Out: one-channel images, in texels, halved as often as their
// smoothness allows.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// How often the fields of a picture are halved: twice at a width of 1920, more for larger ones.
int field_halvings(const Image& brightest);

/// The scale height at every pixel of a layer whose typical one is `height`: .55 to 2.2 times it, more where
/// the picture is bright over a wide area: H min(.55 + 1.65 (G_40 * m / its 99.5 %)^5, 2.2), rising by at
/// most .3 a px, so that a bulge is no taller than it is wide. (DEPTH 4 has 1.6 and the power 1.5, which made
/// a slab of whole inner disks and a tower of a small bulge.)
Image thickness_field(const Image& brightest, double height);

/// How far a body stands out, 0 to `depth`: the root of the picture's brightness over wide areas, 0 on empty
/// sky. Nowhere steeper than `steepest`; what is steeper looks like drapery.
Image relief_field(const Image& brightest, double depth, double steepest);

/// How much of its folds a sheet has at each place, .12..1: as much as the picture has structure of their
/// size there, for light that is smooth from the front is so from aside (INCLINED 3).
Image structure_field(const Image& brightest);

/// The picture's silhouette blown up like a balloon, on a coarse grid: h solves the Poisson equation
/// -laplace(h) = 1 inside of it and is 0 outside. The silhouette is where the light of wide areas is above a
/// twelfth of its range.
Image balloon_of(const Image& brightest);

/// Half of the distance between the walls of a shell: the root of that light's balloon, which is an
/// ellipsoid's height over an ellipse, a ridge's over a filament. At most `depth`, at the middle of the
/// widest part; nowhere steeper than `steepest`.
Image shell_field(const Image& brightest, Image balloon, double depth, double steepest);

/// Light of a shell that is on neither of its walls: that of compact bright cores inside, and that of the
/// dark sky around. On the walls a core would be seen twice, with a column between, and the sky would be a
/// sheet with the picture's own straight edges.
struct FilledLight {
    Image core_share, sky_share;  // 0..1 of a column's light
    Image core_reach;             // texels, half the depth
};

/// A core is what an opening by lines takes away, a fifth of the width long, in the best of twelve
/// directions: filaments survive it. It is as deep as it is wide. The sky is what lies outside of the
/// silhouette of shell_field().
FilledLight find_filled_light(const Image& brightest);

}  // namespace astrosplat

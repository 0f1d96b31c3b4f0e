// Pictures continued beyond their edges, so that from aslant a galaxy or nebula that fills its picture does
// not end in a straight line. In: planes with their pictures. Out: larger planes with larger pictures, within
// which the pictures are as they were.
#pragma once

#include <glm/vec2.hpp>

#include "source/source.h"
#include "source/textured_mesh.h"

namespace astrosplat {

/// Continues every picture on a plane by structure.margin of its width on each side (0..0.5) without its
/// stars: a galaxy by itself, turned in its disk's plane and fading beyond what the frame shows of it; a
/// cloud mirrored, fading raggedly, at least three fifths of the way all around, so that its corners are
/// round. Light inside is
/// untouched; a camera of the picture sees as much more. Out: for each mesh how many times as wide and high
/// its picture became; 1 for other meshes, of which a warning says so.
std::vector<glm::dvec2> add_margins(std::vector<TexturedMesh>& meshes, const StructureParams& structure,
                                    const std::string& layer_name);

/// A picture with such margins, and in these the picture mirrored, without fading.
Image mirrored_margin(const Image& image, double margin);

}  // namespace astrosplat

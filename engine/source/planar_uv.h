// Planar texture coordinates beyond the stretch over a mesh's own box: pictures in scene units, and back
// walls that differ from the front. In: a source's keys and a mesh. Out: the mesh with other uvs.
#pragma once

#include "source/mesh.h"

namespace astrosplat {

/// The box over which apply_uv projects a picture, `aspect` = width / height, so that it covers `width` scene
/// units about `center`.
Bounds picture_box(UvMode mode, double width, const glm::dvec3& center, double aspect);

/// Changes planar uvs of what lies behind the middle of `box`, seen from where the projection reads right
/// (planar-xy: from +z). A closed shape whose walls show one picture is its own mirror image from the side.
/// - mirrored: faces whose middle is behind show the picture left to right, so that it reads right from there
///   too.
/// - varied: they show it displaced by smooth noise, not at all at the box's middle and at the back by up to
///   0.3 of the picture, .1 on average; features of 0.3 of the box. Follows the vertices.
void tell_back_apart(Mesh& mesh, UvMode mode, BackWall back, const Bounds& box);

/// All of it for one mesh of a source; `box` is that of all its meshes, `aspect` of this one's picture.
/// UvMode::mesh: as apply_uv.
void apply_source_uv(Mesh& mesh, const SourceParams& source, const Bounds& box, double aspect);

}  // namespace astrosplat

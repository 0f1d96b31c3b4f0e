// A layer of a scene as the look and the renderer want it, for the pipeline and the viewer's preview alike.
// In: a scene and one of its layers. Out: plain inputs of look and renderer, its source with what that takes
// from the rest of the scene, and the files it is made of, which are watched while the scene is open, asked
// for before a run, and hashed.
#pragma once

#include "core/bounds.h"
#include "look/apply.h"
#include "render/frame.h"
#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// The layer without its splats.
RenderLayer render_layer(const LayerParams& params);

/// The same in its scene: stars of another layer's picture go where that goes (source.like).
RenderLayer render_layer(const Scene& scene, const LayerParams& params);

/// The look that the layer's splats get: of stars, whose size and opacity are not theirs, only its grade.
Look look_of(const LayerParams& params);

/// Inputs of the look besides the set; the thickness map is left null.
LookInputs look_inputs(const LayerParams& params);

/// Bounds in world space of a box in layer space: of its eight corners, so that no splat lies outside.
Bounds world_bounds(const Bounds& box, const RenderLayer& layer);

/// Throws InputError, naming the layer, where splats lie farther than `farthest` scene units from 0: so far
/// out that their distances leave 32 bits.
void check_extent(const Bounds& box, const std::string& layer, double farthest = largest_number);

bool has_environment(const EnvironmentParams& params);

/// Whether the scene's camera has a position, or keyframes of it.
bool has_camera_places(const Scene& scene);

/// Whether a layer's stars lie along the camera's path.
bool follows_camera(const SourceParams& source);

/// The layer whose picture a layer's stars are of (source.like); null: none, or none with a picture.
const LayerParams* like_layer(const Scene& scene, const LayerParams& layer);

/// Scene units per parsec of a layer's stars: its own, else by scene.light_years_per_unit, else 1, as of
/// layers without stars of a catalogue.
double parsec_of(const Scene& scene, const LayerParams& layer);

/// layer.source, of stars with a unit of their own, along the camera with its path, of those of a picture
/// with the rest of its layer's.
SourceParams source_of(const Scene& scene, const LayerParams& layer);

/// The files that a source names: meshes, textures, pictures of masks, splats, catalogues.
/// Not what is built in.
std::vector<fs::path> named_files(const SourceParams& source);
/// The same with what an OBJ brings of its own: material libraries and their pictures. Reads it.
std::vector<fs::path> all_files(const SourceParams& source);
/// A mesh from a file that takes the pictures its own materials name.
bool has_own_pictures(const MeshInput& input);

/// Those of a scene besides its layers' sources: thickness maps and pictures of the sky.
std::vector<fs::path> picture_files(const Scene& scene);

}  // namespace astrosplat

// Pictures of the window against the references in tests/gui/references: what is drawn where, in which
// colour. They are drawn schematically, glyphs as boxes and textures as their coordinates, so that
// neither the rasteriser of fonts nor a rendered picture shows in them.
#pragma once

#include "gui/software_draw.h"

namespace astrosplat {

/// Fails the test where the picture differs from the reference of that name, or has none. What was drawn
/// and where it differs then lie in test-output/gui-references of the build folder; a picture that is
/// right is made the new reference by copying it from there.
void expect_like_reference(const std::string& name, const Picture8& drawn);

}  // namespace astrosplat

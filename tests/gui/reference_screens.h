// Pictures of the window against the references in tests/gui/references: what is drawn where, in which
// colour. They are drawn schematically, glyphs as boxes and textures as their coordinates, so that
// neither the rasteriser of fonts nor a rendered picture shows in them.
#pragma once

#include "gui/software_draw.h"

namespace astrosplat {

/// Compares what ImGui drew last, or a part of it, with the reference of that name. Fails the test where it
/// differs, where there is no reference, where lines along an axis do not cover whole pixels
/// (unsnapped_lines), and where another processor would draw something else: ImGui takes reciprocal roots
/// from an instruction (rsqrtss) whose last eleven bits are each maker's own, which moves the corners of
/// strokes and of round shapes by up to a thousandth of their width. What was drawn and where it differs then
/// lie in test-output/gui-references of the build folder; a picture that is right is made the new reference
/// by copying it from there.
void expect_like_reference(const std::string& name, std::optional<Part> part = std::nullopt);

}  // namespace astrosplat

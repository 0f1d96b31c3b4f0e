// Which structure suits a picture. In: its light. Out: a kind, and the reason in words.
#pragma once

#include <glm/vec2.hpp>
#include <string>

#include "core/image.h"
#include "source/source.h"

namespace astrosplat {

struct StructureChoice {
    StructureKind kind = StructureKind::sheet;
    std::string why;  // "its light gathers in the middle, which is redder than what is around it"
};

/// disk for what has a bright middle that is at least as red as its surroundings (in a grey picture: with
/// light all around it), walls for what stands alone on a dark sky and is bright all over or at its rim,
/// sheet for everything else. `light`: RGB, linear, >= 0.
StructureChoice choose_structure(const Image& light);

/// Where a picture is brightest over wide areas, its stars left out: from the top left corner, in shares of
/// its width and height. The middle, where it is too small to tell or dark.
glm::dvec2 subject_of(const Image& light);

/// Share of a picture's rim, 0 to 1, that shows more than a dark sky: there what it shows goes on beyond.
double lit_share_of_rim(const Image& light);

}  // namespace astrosplat

// Which structure suits a picture. In: its light. Out: a kind, and the reason in words.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "core/image.h"
#include "source/source.h"

namespace astrosplat {

enum class SkyObject {
    galaxy,
    nebula,
    remnant,
    field,  // of many small things: a cluster of stars or of galaxies, a deep field
};

struct StructureChoice {
    StructureKind kind = StructureKind::sheet;
    SkyObject object = SkyObject::nebula;
    std::string why;  // "its light goes on to the picture's edges"; empty where the object was given
};

/// disk for what has a bright middle that is at least as red as its surroundings and has the colours of stars
/// (in a grey picture: with light all around it), walls for what stands alone on a dark sky, sheet for a
/// field and for what goes on to the picture's edges. `light`: RGB, linear, >= 0. `shown`: what it is known
/// to show; a nebula may be either of the latter.
StructureChoice choose_structure(const Image& light, std::optional<SkyObject> shown = {});

/// Where a picture is brightest over wide areas, its stars left out: from the top left corner, in shares of
/// its width and height. The middle, where it is too small to tell or dark.
glm::dvec2 subject_of(const Image& light);

/// Mean of the brightest channel, 0 to 1 of the displayed white.
double mean_light(const Image& light);

/// Share of a picture's rim, 0 to 1, that shows more than a dark sky: there what it shows goes on beyond.
double lit_share_of_rim(const Image& light);

}  // namespace astrosplat

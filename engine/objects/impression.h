// The kinds of object that a picture may show, as far as they are given depth in different ways, and which it
// shows by its light alone. In: the light. Out: plain numbers, each without a unit and of the order of 1, and
// what they are like.
#pragma once

#include <glm/vec2.hpp>

#include "core/image.h"
#include "core/text.h"
#include "source/source.h"

namespace astrosplat {

enum class SkyObject {
    galaxy,      // with a disk
    elliptical,  // a galaxy without
    nebula,
    planetary,  // a nebula about an axis
    remnant,    // a shell
    field,      // of many small things: an open cluster, a cluster of galaxies, a deep field
    cluster,    // a globular one
    thin,       // a comet, a star: nothing whose depth shows
};
constexpr auto names_of(SkyObject) {
    return names_up_to<SkyObject::thin>("galaxy", "elliptical", "nebula", "planetary", "remnant", "field",
                                        "cluster", "thin");
}
inline constexpr std::size_t sky_object_count = names_of(SkyObject{}).size();

/// Light is that of the brightest channel above the sky, which is the darkest tenth; the middle is the
/// brightest place of it under a blur of .02 widths, stars left out; radii are from there.
struct Impression {
    bool lit = false, grey = false;  // anywhere above its sky; has no colours
    glm::dvec2 middle{0.5};          // from the top left corner, in shares of width and height
    double peak = 0.0;               // ln: in the middle over at the half-light radius
    double redness = 0.0;            // ln: red over blue, of the middle against its surroundings
    double edge = 0.0;               // at the picture's edges over the mean
    double sides = 1.0;              // difference between opposite sides: 0 alike .. 1
    double small = 0.0;              // share in things smaller than .012 widths
    double stars = 0.0;              // share in round points
    double red = 0.0, blue = 0.0;    // ln: of its colour, over green
    double colours = 0.0;            // how far colours differ from that one, light by light
    double gas = 0.0;                // share whose colour no stars have
    double size = 0.0;               // half-light radius, of the width
    double detail = 0.0;             // deviation from a blur of 3 px of 256, over it
    double roundness = 1.0;          // axis ratio of what is within 1.5 half-light radii
    double dark = 0.0;               // share of the pixels under 3 % of the brightest hundredth
    double together = 0.0;           // ln: spread of its brightest fifth over that of all light
    double like_colors = 1.0;        // correlation of red and blue, from place to place
    double star_spread = 0.0;        // ln: the brightest twentieth of the stars over their median
    double balance = 1.0;            // as sides, about the centre of all light in place of the middle
};

/// `light`: RGB, linear, >= 0; one of less than 16 px a side is not lit.
Impression impression_of(const Image& light);

/// For each kind, the share that it has of pictures with such measures; objects that stand for nothing else
/// in the list have no share. They add up to 1. `why` says in words what speaks most for the likeliest.
struct Likeness {
    std::array<double, sky_object_count> share{};
    std::string why;
};
Likeness likeness_of(const Impression& seen);

/// How such an object is given depth. A nebula is a shell where it stands alone on a dark sky, else a sheet.
StructureKind structure_of(SkyObject object, const Impression& seen);

/// Mean of the brightest channel, 0 to 1 of the displayed white.
double mean_light(const Image& light);

/// Share of a picture's rim, 0 to 1, that shows more than a dark sky: there what it shows goes on beyond.
double lit_share_of_rim(const Image& light);

}  // namespace astrosplat

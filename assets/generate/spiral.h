// Where things are in the demo galaxy: an unequal two-armed spiral whose arms fork, with spurs and dust
// lanes. In: a place on the disk, the unit circle. Out: densities there, which the pictures in whirlpool.cpp
// are painted from.
#pragma once

#include <glm/vec2.hpp>

namespace astrosplat::assets {

struct DiskPlace {
    float r = 0.0f;      // after warping
    float young = 0.0f;  // young stars, about 0..1: narrow arms, sharp inside, frayed outside
    float broad = 0.0f;  // the arms as old stars follow them
    float ridge = 0.0f;  // crest of the arms, where stars form
    float lane = 0.0f;   // dust lane along the inner edges
    float angle = 0.0f;  // radians, after warping
};

/// `p` on the disk, y up; the disk ends at about |p| = 0.95.
DiskPlace disk_place(glm::vec2 p);

/// Noise stretched along spirals of `pitch_deg`: `cells` of them around, each `stretch` times as long as
/// wide. `ridges` gives filaments 0..1, else fractal noise -1..1.
float along_spiral(const DiskPlace& place, float pitch_deg, int cells, float stretch, unsigned seed,
                   bool ridges);

/// Optical depth of dust face on, about 0..3.
float dust_depth(glm::vec2 p, const DiskPlace& place);

}  // namespace astrosplat::assets

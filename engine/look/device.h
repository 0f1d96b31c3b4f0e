// What else can apply a look: a graphics card, to a set that stays in its memory, so that a dragged look
// costs no copy of the splats. app/gl has one.
#pragma once

#include "look/kernel.h"

namespace astrosplat {

/// What a look left of a set in a device's memory.
struct DeviceLook {
    std::int64_t kept = 0;
    float largest_light = 0.0f, largest_star_light = 0.0f;  // alpha * brightest channel; of is_star() ids
};

class LookDevice {
  public:
    virtual ~LookDevice() = default;
    /// Applies a prepared look to a set; what it draws as splats of this `stamp` from then on, row by row
    /// with alpha 0 where one is dropped. `set_stamp`: another number for every set there was. `map`: raw
    /// values, read where there are several stops. None where it has not the memory, or for a look with
    /// outlines.
    virtual std::optional<DeviceLook> shade(const SplatSet& set, std::uint64_t set_stamp,
                                            const PreparedLook& look, const Image* map,
                                            std::uint64_t stamp) = 0;
};

}  // namespace astrosplat

// The kinds of object that a picture may show, as far as they are given depth in different ways.
#pragma once

#include "core/text.h"

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

}  // namespace astrosplat

// The look over a run of splats, compiled once per instruction set with the same bits on each.
#pragma once

#include "core/image.h"
#include "look/shared_uniforms.h"
#include "splats/shaded_splats.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// The arrays of a set that looks read.
struct LookColumns {
    explicit LookColumns(const SplatSet& set);

    const glm::vec3 *position, *color;
    const float *alpha, *distance;
    const std::uint64_t* id;
    const glm::vec2* uv;  // read where there is a map
    const float* radius;  // read where own_radius is set
};

struct LookRun {
    LookColumns in;
    const PreparedLook& uniforms;
    const Image* map;   // raw values; read where there are several stops
    ShadedSplats& out;  // arrays at least as long as the set's
};

/// Shades splats [begin, end) of the set and writes those kept to out[begin], out[begin + 1], ...; returns
/// how many. The arrays written may be those read (radius: also the distances), because a splat is read
/// before anything is written to its place.
std::int64_t shade_run(const LookRun& run, std::int64_t begin, std::int64_t end);

}  // namespace astrosplat

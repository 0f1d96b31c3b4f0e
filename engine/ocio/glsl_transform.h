// A display transform as GLSL: the text of a function and the tables it reads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace astrosplat {

/// A table that the text reads by a sampler of this name.
struct GlslTable {
    std::string sampler;
    int dimensions = 1;         // of the texture: 1, 2 or 3
    int width = 1, height = 1;  // texels; a cube has `width` on each side
    int channels = 3;           // 1 or 3
    bool smooth = true;         // interpolated linearly by the sampler
    std::vector<float> values;  // x fastest
};

struct GlslTransform {
    std::string text;  // of "vec4 ocio_display(vec4)", GLSL 4.0
    std::vector<GlslTable> tables;
};

}  // namespace astrosplat

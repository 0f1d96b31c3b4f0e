// What moves in a glTF animation: a place, a turn or a size over time. In: a sampler of the file. Out: its
// value at any frame.
#pragma once

#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "gltf/gltf_file.h"

namespace astrosplat {

/// Vectors of 3 or turns, quaternions x y z w.
struct GltfCurve {
    std::vector<double> frames;  // ascending, at least one
    std::vector<float> values;   // cubic: what arrives, the value, what leaves
    double fps = 24.0;
    int components = 3;
    enum class Between { linear, step, cubic } between = Between::linear;
};

/// Reads a sampler; a second is `fps` frames. Throws InputError and nlohmann's exceptions.
GltfCurve gltf_curve(GltfFile& file, const nlohmann::json& sampler, int components, double fps);

/// Its first or last value before and after its times; turns have length 1.
glm::dvec4 value_of(const GltfCurve& curve, double frame);

}  // namespace astrosplat

// The look of a layer: every number an artist tunes between a SplatSet and what is drawn (DESIGN 5). Plain values;
// SCENE.md's defaults are the defaults here. apply.h turns them into ShadedSplats.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace astrosplat {

/// Probability density over x = distance / reach.
struct DensityCurve {
    enum class Shape { constant, linear, quadratic, exponential, gaussian, smooth, curve };
    Shape shape = Shape::constant;
    float rate = 3.0f;              // exponential: e^(-rate x)
    float sigma = 0.35f;            // gaussian: e^(-x^2 / 2 sigma^2), of reach
    std::vector<glm::vec2> points;  // curve: (x, y), ascending x
    bool operator==(const DensityCurve&) const = default;
};

struct ThicknessKey {
    glm::vec3 color{1.0f};  // raw map value this key stands for
    float scale = 1.0f;     // of reach
    DensityCurve pdf;       // shape, rate, sigma, points
    bool operator==(const ThicknessKey&) const = default;
};

struct Thickness {
    std::filesystem::path map;  // empty: none
    std::vector<ThicknessKey> keys;
    bool operator==(const Thickness&) const = default;
};

struct Noise {
    float frequency = 1.0f;  // per scene unit
    int octaves = 4;
    float lacunarity = 2.0f;
    float gain = 0.5f;
    int seed = 1;
    float cull = 0.0f;        // 0..1: how much of the density the noise takes
    float silhouette = 0.0f;  // 0..1: how much of the reach the noise takes
    float jitter = 0.0f;      // scene units along the layer's axis
    float alpha = 0.0f;       // alpha *= 1 + alpha * n
    float brightness = 0.0f;  // colour *= 1 + brightness * n
    bool operator==(const Noise&) const = default;
};

struct HorizontalAlpha {
    float power = 1.0f;
    float threshold = 0.95f;
    bool unpremultiply = false;
    float gain = 1.0f;
    bool operator==(const HorizontalAlpha&) const = default;
};

struct VerticalAlpha {
    enum class Shape { none, constant, linear, exponential, s106, curve };
    enum class Match { automatic, none, sum, coverage };
    Shape shape = Shape::none;
    float rate = 3.0f;
    std::vector<glm::vec2> points;
    float reach = 0.0f;  // scene units; 0: the layer's reach
    Match match = Match::automatic;
    bool operator==(const VerticalAlpha&) const = default;
};

struct Radius {
    float min = 0.0f, max = 0.0f;  // scene units; 0, 0: the file's, or 0.6 voxel diagonals
    float horizontal_scale = 1.0f;
    float vertical_scale = 1.0f;
    bool operator==(const Radius&) const = default;
};

struct Grade {
    float gain = 1.0f;
    glm::vec3 tint{1.0f};
    float saturation = 1.0f;
    float gamma = 1.0f;
    float black = 0.0f;
    bool operator==(const Grade&) const = default;
};

struct Look {
    float density = 1.0f;
    float reach = 0.0f;  // scene units; 0: the set's max_distance
    DensityCurve pdf;
    Thickness thickness;
    std::vector<Noise> noise;  // empty: none
    HorizontalAlpha alpha;
    VerticalAlpha vertical;
    Radius radius;
    Grade grade;
    bool operator==(const Look&) const = default;
};

}  // namespace astrosplat

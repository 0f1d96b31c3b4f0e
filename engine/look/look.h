// The look of a layer: every number an artist tunes between a SplatSet and what is drawn (DESIGN 5). Plain
// values; what a scene file leaves out has the defaults here. apply.h turns them into ShadedSplats.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/text.h"
#include "source/source.h"

namespace astrosplat {

/// Probability density over x = distance / reach.
struct DensityCurve {
    enum class Shape { constant, linear, quadratic, exponential, gaussian, smooth, curve };
    friend constexpr auto names_of(Shape) {
        return names_up_to<Shape::curve>("constant", "linear", "quadratic", "exponential", "gaussian",
                                         "smooth", "curve");
    }
    Shape shape = Shape::constant;
    float rate = 3.0f;              // exponential: e^(-rate x)
    float sigma = 0.35f;            // gaussian: e^(-x^2 / 2 sigma^2), of reach
    std::vector<glm::vec2> points;  // curve: (x, y), ascending x, at most 16; none: constant 1
    bool operator==(const DensityCurve&) const = default;
};

/// Several stops need a map to choose between them; without one the first is used. Without stops there is one
/// stop of scale 1 with the look's own pdf. At most 8.
struct ThicknessStop {
    glm::vec3 color{1.0f};  // raw map value this stop stands for
    float scale = 1.0f;     // of reach
    DensityCurve pdf;       // shape, rate, sigma, points
    bool operator==(const ThicknessStop&) const = default;
};

struct Thickness {
    fs::path map;                      // empty: none
    Derived derive = Derived::none;    // reads this map of the picture, as grey, in its place
    std::vector<ThicknessStop> stops;  // "keys" in the file
    bool operator==(const Thickness&) const = default;
};

/// Fractal noise n(p) at the splat's place before jitter (silhouette: at its projection onto the plane across
/// the axis). In a list the entries work together: what culls, bites the silhouette or varies alpha and
/// brightness multiplies, jitter adds. At most 4 entries with any amount. `seed` alone makes the field, so
/// layers may share one.
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
    float power = 1.0f;          // where alpha < threshold
    float threshold = 0.95f;     // 0..1
    bool unpremultiply = false;  // where alpha < threshold
    float gain = 1.0f;  // after the power, on every alpha, clamped to 0..1; so `match` aims at the result
    bool operator==(const HorizontalAlpha&) const = default;
};

/// f(x) and how it is matched to the picture's alpha. coverage: the blend of a column shows alpha (DESIGN 5).
/// sum: the alphas of a column, one splat a lattice plane, add up to alpha; planes lie one lattice step apart
/// along the axis, and the sum is the mean over all places the surface may have between two of them, 2 reach
/// / step * Integral p f. Both count only where there are splats: up to max_distance, should reach go beyond.
/// picture: coverage, and every small part of a front view has the opacity and the light of the picture
/// there, whatever the blend, the splats' width, and which of the positions became splats (picture_fit.h).
struct VerticalAlpha {
    enum class Shape { none, constant, linear, exponential, s106, curve };
    friend constexpr auto names_of(Shape) {
        return names_up_to<Shape::curve>("none", "constant", "linear", "exponential", "s106", "curve");
    }
    enum class Match { automatic, none, sum, coverage, picture };
    friend constexpr auto names_of(Match) {
        return names_up_to<Match::picture>("auto", "none", "sum", "coverage", "picture");
    }
    Shape shape = Shape::none;
    float rate = 3.0f;              // exponential: e^(-rate x)
    std::vector<glm::vec2> points;  // curve: (x, y), ascending x, at most 16; none: constant 1
    float reach = 0.0f;             // scene units; 0: the layer's reach
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

/// A volume of layer space outside of which (or within it) splats are cut away, before they are displaced.
/// Opacity falls over a band of `soft` scene units that lies half inside. Of several, all hold. At
/// most 8 boxes and spheres and 64 outlines. An outline is drawn in a view, and the volume is what lies
/// behind it: seen from `center` along -z as `rotate` turns it, at any depth. Its lines close polygons,
/// inside of which is what they go around an odd number of times, or with a `width` they are the middles of
/// strokes.
struct Crop {
    enum class Shape { box, sphere, outline };
    friend constexpr auto names_of(Shape) { return names_up_to<Shape::outline>("box", "sphere", "outline"); }
    enum class Keep { inside, outside };
    friend constexpr auto names_of(Keep) { return names_up_to<Keep::outside>("inside", "outside"); }
    Shape shape = Shape::box;
    glm::vec3 center{0.0f};  // scene units
    glm::vec3 size{1.0f};    // scene units, of a box from side to side, > 0
    glm::vec3 rotate{0.0f};  // of a box, degrees about x, then y, then z
    float radius = 1.0f;     // scene units, of a sphere, > 0
    std::string outline;     // lines: outline_lines()
    float width = 0.0f;      // of strokes, as the points of the lines; 0: polygons
    bool parallel = false;   // an outline's rays do not meet in `center`
    float soft = 0.0f;       // scene units
    Keep keep = Keep::inside;
    bool operator==(const Crop&) const = default;
};

/// Each costs every splat about what a box does.
inline constexpr std::size_t most_outlines = 64;

/// The lines of an outline: SVG path data of straight lines, "M 0.1 0.2 0.3 0.2 0.3 0.4 M ...", where M
/// begins a line. Points are places right of and above the view's line, per unit of depth; in scene units
/// where rays are parallel. Throws InputError for anything else, for a line of less than two points and for
/// more than 4096 points.
std::vector<std::vector<glm::vec2>> outline_lines(std::string_view outline);
/// The reverse, with as many digits as a picture's pixels need.
std::string outline_text(std::span<const std::vector<glm::vec2>> lines);

struct Look {
    float density = 1.0f;
    float reach = 0.0f;  // scene units; 0: the set's max_distance
    DensityCurve pdf;
    Thickness thickness;
    std::vector<Noise> noise;  // empty: none
    std::vector<Crop> crop;    // empty: none
    HorizontalAlpha alpha;
    VerticalAlpha vertical;
    Radius radius;
    Grade grade;
    bool operator==(const Look&) const = default;
};

}  // namespace astrosplat

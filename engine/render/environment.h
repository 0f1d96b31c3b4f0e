// The environment behind everything: an equirectangular picture or six cube faces, as mip-mapped linear
// light. In: EnvironmentParams. Out: colour along a direction.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera/camera.h"
#include "core/image.h"
#include "core/progress.h"
#include "source/tiled_sky.h"

namespace astrosplat {

struct EnvironmentParams {
    fs::path image;              // equirectangular; empty: none
    std::vector<fs::path> cube;  // or six: +x -x +y -y +z -z
    fs::path tile;               // or a part of the sky, of which the whole is made
    SkyTiling tiling;            // how
    float gain = 1.0f;
    glm::dvec3 rotation{0.0};  // degrees about x, then y, then z
    double behind = 0.0;       // scene units from the origin; 0: infinitely far
    bool visible = true;
    bool operator==(const EnvironmentParams&) const = default;
};

/// [face][mip level]: 1 face (equirectangular) or 6; RGB, linear.
using EnvironmentFaces = std::vector<std::vector<Image>>;

/// Copies share the pictures.
struct Environment {
    std::shared_ptr<const EnvironmentFaces> faces;  // never null once loaded; empty: nothing to be seen
    glm::dmat3 environment_from_world{1.0};
    double behind = 0.0;
    float gain = 1.0f;
    float largest_texel = 0.0f;  // largest channel value of the pictures
    float largest = 0.0f;        // the same times gain
};

/// The parameters that load_environment() reads, alone.
EnvironmentParams pictures_of(const EnvironmentParams& params);

/// Loads the pictures and builds their mip levels (box filter). Throws InputError, Cancelled. The picture
/// part is independent of gain and rotation, which may be animated: see set_environment_params.
Environment load_environment(const EnvironmentParams& params, const Progress& progress = {},
                             const SkyMaker& make_sky = tiled_sky_of);
void set_environment_params(Environment& environment, const EnvironmentParams& params);

/// Where an equirectangular picture shows a unit direction (environment space), from its upper left corner,
/// 0 to 1: OpenEXR's latlong, latitude +90 degrees on top, longitude +180 on the left, 0 towards +z, 90
/// towards +x.
glm::dvec2 latlong_place(const glm::dvec3& direction);

/// The unit direction from the origin to what a ray from `eye` meets: the ray's own, or of an environment on
/// a sphere about the origin where it leaves that. An eye beyond .99 of its radius is taken to be there.
/// `distance`: of that place from the eye over the radius, 1 for one infinitely far away.
struct SeenPlace {
    glm::dvec3 direction;
    double distance = 1.0;
};
SeenPlace seen_place(const Environment& environment, const glm::dvec3& eye, const glm::dvec3& ray);

/// Colour that a ray from an eye meets; `spread` is the angle in radians between neighbouring pixels.
glm::vec3 sample_environment(const Environment& environment, const glm::dvec3& eye, const glm::dvec3& ray,
                             double spread);

/// Colour seen along a unit direction in world space; `spread` is the angle in radians between neighbouring
/// pixels, which picks the mip level (trilinear).
glm::vec3 sample_environment(const Environment& environment, const glm::dvec3& direction, double spread);

/// The environment as one camera sees it, for frames in motion: a ready image that render() puts behind the
/// splats instead of asking the environment at every pixel, where exact directions cost more than all splats
/// of a preview. Four floats a pixel, of which the last means nothing, as sample_environment has them but for
/// two things: places on an equirectangular picture are exact at every eighth pixel only and interpolated in
/// between, and the nearest mip level is taken, not a mix of two. Uses the image's memory again where the
/// size stays.
void draw_backdrop(const Environment& environment, const Camera& camera, std::int64_t width,
                   std::int64_t height, Image& image);

}  // namespace astrosplat

// A galaxy as a body about the plane of its picture (INCLINED): what the picture shows stays on its lines of
// sight, and its depth along them is drawn from the galaxy's Gaussians in space. A Gaussian's distribution
// along a line of sight is a Gaussian again, so one formula serves from face-on to edge-on. In: a galaxy's
// light as a sum of Gaussians, and how it lies. Out: depths, in texels towards the viewer from the picture's
// plane, which goes through the galaxy's centre.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "bodies/depth_kernel.h"
#include "bodies/galaxy_light.h"
#include "core/image.h"

namespace astrosplat {

/// Parts of a galaxy that are thick in ways of their own: the smooth disk, what is small in it, the dust, and
/// the spheroid with the sky around.
enum class GalaxyPart { disk, fine, dust, spheroid };
inline constexpr int galaxy_parts = 4;

/// Clouds that light above the smooth galaxy gathers in where its disk is seen from the edge, each at one
/// depth: or every bright place would be a spoke along its line of sight (INCLINED 3). A lattice about the
/// galaxy's centre, along its axes.
inline constexpr float cloud_flat = 0.4f;  // of a cloud's length, its width across the major axis
struct GalaxyClouds {
    float length = 0.0f;  // texels
    std::int64_t columns = 0, rows = 0;
    std::vector<float> z;  // texels, row by row; of those that nothing reaches 0
    /// The cloud at a place along and across the major axis; empty beyond the lattice.
    std::optional<std::size_t> at(glm::vec2 uv) const;
    /// Its middle.
    glm::vec2 middle(std::size_t cloud) const;
};

/// Of what is small in a disk, texels.
inline constexpr float least_disk_thickness = 2.0f;

struct GalaxyBody {
    glm::vec2 center{0.0f};       // texels from the picture's top left corner
    glm::vec2 major{1.0f, 0.0f};  // unit, in texels: along the major axis
    glm::vec2 near{0.0f, -1.0f};  // and across it towards the near side
    float cos_i = 1.0f, sin_i = 0.0f;
    float radius = 1.0f;     // texels, rms width of the disk's light
    float thickness = 1.0f;  // texels, standard deviation of what is small in the disk
    float hidden = 0.0f;     // 0..1: how much of its plane the picture cannot tell, from 66 degrees on
    std::array<std::vector<LineGaussian>, galaxy_parts> parts;
    std::optional<float> ring;  // of dust: its radius, texels
    // What the picture tells of a place, 0..1; one channel each, of the picture without its margin:
    Image share;      // of the light that is this galaxy's; without pixels: all
    Image spheroid;   // of its light that is the spheroid's, or the sky's around
    Image excess;     // of its light that is above the smooth galaxy's
    Image lit;        // how far stars there are the galaxy's
    Image roughness;  // of its light around, by which depths gather in clouds and what is invented counts
    float to_field = 1.0f, field_begins = 0.0f;  // pixels of these a texel; texels of the margin
    GalaxyClouds clouds;
    Image plane;  // what is invented: logarithms of how likely matter is, over +-3 radii of the disk's plane

    /// Of one of these fields.
    float value_at(const Image& field, float x, float y) const;
    /// Along the major axis, across it in the disk towards the near side, and above the disk towards the
    /// viewer; texels. In: a place of the picture and a depth.
    glm::vec3 in_disk(float x, float y, float z) const;
    /// A place of the picture (x, y) and a depth (z).
    glm::vec3 in_picture(const glm::vec3& in_disk) const;
};

/// What a galaxy's scene says of it besides how it lies.
struct GalaxyShape {
    double thicker = 1.0;         // times the usual
    double flare = 0.0;           // how much thicker at the rim than in the middle, less 1
    std::optional<double> bulge;  // 0..1, share of the spheroid in the light; empty: as found
    double roughness = 1.0;       // 0..1, of its light: in a smooth galaxy what is sharp is no thinner
};

/// `width`: of the picture the light was fitted in, texels. Without the images.
GalaxyBody make_galaxy_body(const GalaxyLight& light, const GalaxyPlane& plane, const GalaxyShape& shape,
                            double width);

/// Light of the smooth galaxy's disk and spheroid at a place of the picture.
struct GalaxyLightAt {
    float disk, spheroid;
};
GalaxyLightAt light_at(const GalaxyBody& body, float x, float y);

/// For body.plane, of strength 1: two arms and clouds in their direction. `radius`: the body's.
Image invented_plane(float radius, std::uint32_t seed);

/// A depth of one part there: the share (0..1) of its light along the line of sight that is counted before
/// it, Gaussian by Gaussian.
float depth_of(const GalaxyBody& body, GalaxyPart part, float x, float y, float share);

/// (u, v) along and across the major axis of a place of the picture, and the other way.
glm::vec2 along_and_across(const GalaxyBody& body, float x, float y);
glm::vec2 place_of(const GalaxyBody& body, glm::vec2 uv);

/// Takes splats whose light is above the smooth galaxy's to the depths of clouds, as far as the picture
/// cannot tell.
void gather_in_clouds(const GalaxyBody& body, DepthBlock& block);
/// Those of its clouds that this may take splats of a picture of that size to, texels: a tenth of them, most
/// often.
std::vector<std::size_t> reached_clouds(const GalaxyBody& body, float width, float height);

/// The depth below which the share `u` of a place's stars lies, of which `in_disk` (0..1) are the disk's and
/// the others about the spheroid.
float star_depth(const GalaxyBody& body, float x, float y, float u, float in_disk);

/// Candidates of one part for every splat of a block, weighed by what is invented, `force` times; and the
/// splats' heights, about which fine candidates are drawn. Of dust, what absorbs stands in front.
void set_candidates(const GalaxyBody& body, GalaxyPart part, float force, DepthBlock& block,
                    DepthCandidates& candidates);

}  // namespace astrosplat

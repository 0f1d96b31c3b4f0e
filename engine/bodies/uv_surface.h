// A mesh as the ground its picture lies on. In: a mesh with texture coordinates. Out: for any place of the
// picture, where it is in the scene, which way is up and how large a texel is there.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera/camera.h"
#include "source/textured_mesh.h"

namespace astrosplat {

struct SurfacePlace {
    glm::vec3 position;         // scene units
    glm::vec3 normal;           // unit, smooth over the mesh
    float units_per_texel = 0;  // scene units
    /// Where heights go: the normal, or along the ray to the camera, as long as brings it nearer by 1.
    glm::vec3 rise{0.0f};
    float approach = 0.0f;  // share of `depth` by which a texel of height is nearer where rays meet; else 0
    float depth = 0.0f;     // scene units before the camera, if there is one
};

/// Depth along the rays to a camera, of one along parallel rays, texels: the projective map by which what is
/// plane stays plane; never as far as the camera, and no farther than four times that behind the picture.
float along_rays(const SurfacePlace& place, float z);
/// The other way.
float along_parallels(const SurfacePlace& place, float z);

class UvSurface {
  public:
    /// The faces of one material under a picture of width x height texels. `repeats`: the picture goes on
    /// beyond 0..1; else places beyond it belong to no texel. `camera`: that took the picture, by which the
    /// mesh has its coordinates.
    UvSurface(const Mesh& mesh, std::uint32_t material, std::int64_t width, std::int64_t height, bool repeats,
              const Camera* camera = nullptr);

    /// Calls visit for every face over this place of the picture, in the order of the faces: none where the
    /// mesh does not show it, several where it does more than once; with a camera only for the face nearest
    /// to it, so that it sees its picture once. An edge belongs to one of its two faces.
    void at(glm::vec2 uv, const std::function<void(const SurfacePlace&)>& visit) const;

    /// How many faces at() visits.
    int faces_at(glm::vec2 uv) const;

    /// Texels over scene units, by the areas of all faces; 0 for a mesh without area.
    double texels_per_unit() const { return texels_per_unit_; }
    /// Whether all faces lie in one plane, up to a thousandth of the mesh's extent.
    bool flat() const { return flat_; }

  private:
    struct Edge {
        glm::dvec2 from, along;
        double sign;  // of the area that a place within the face has with it; 0 of a face without area
        bool owned;   // the face has the places on it
    };
    struct Face {
        glm::dvec2 uv[3];  // shifted by whole pictures so that it lies over 0..1
        std::uint32_t triangle;
        Edge edges[3];  // across from the corners
    };

    void measure(const Mesh& mesh, std::uint32_t material, glm::dvec2 texels);
    static void set_edges(Face& face);
    void fill_grid();
    int cell_at(double v) const;  // along either side
    template <class Visit>
    void for_each_cell(const Face& face, Visit visit) const;

    /// visit(face, the place's weights of its corners)
    template <class Visit>
    void for_each_face_at(glm::vec2 uv, Visit visit) const;

    SurfacePlace place_on(const Face& face, const glm::dvec3& weights) const;
    SurfacePlace seen_on(const Face& face, const glm::dvec3& weights) const;

    const Mesh& mesh_;
    const Camera* camera_;
    double texel_at_depth_1_ = 0.0;       // scene units, if there is a camera
    std::vector<double> depths_;          // before it, of the mesh's positions
    std::vector<glm::vec3> normals_;      // of the mesh's positions
    std::vector<float> units_per_texel_;  // of the same
    double texels_per_unit_ = 0.0;
    bool flat_ = true;
    std::vector<Face> faces_;
    int cells_ = 1;                          // a side, over 0..1
    std::vector<std::uint32_t> first_face_;  // of each cell, in cell_faces_; one more at the end
    std::vector<std::uint32_t> cell_faces_;
};

/// The faces of a mesh under the picture of one of its materials.
UvSurface surface_of(const TexturedMesh& mesh, std::uint32_t material);

}  // namespace astrosplat

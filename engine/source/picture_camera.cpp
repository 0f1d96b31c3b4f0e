// Everything in double; a face's coordinates are affine in the picture, not on the face.
#include "source/picture_camera.h"

#include <cassert>
#include <glm/matrix.hpp>
#include <vector>

#include "camera/projection.h"
#include "core/real.h"

namespace astrosplat {

Camera picture_camera(const UvCamera& params, double aspect) {
    assert(params.position && aspect > 0.0);
    CameraParams camera;
    camera.projection = params.height > 0.0 ? Projection::orthographic : Projection::perspective;
    camera.position = params.position;
    camera.target = params.target;
    camera.up = params.up;
    camera.fov = params.fov;
    camera.height = params.height;
    camera.near = 1e-9;
    return make_camera(camera, aspect, 1.0, {});
}

CameraParams params_of(const Camera& camera) {
    const bool parallel = exact::has_parallel_rays(make_exact_lens(camera));
    CameraParams params;
    params.projection = camera.projection;
    params.position = camera.eye;
    params.target = camera.eye - camera.world_from_camera[2];
    params.up = camera.world_from_camera[1];
    params.near = camera.near;
    if (parallel)
        params.height = picture_height_at(camera, 1.0);
    else
        params.fov = 2.0 * real::degrees(real::atan2(0.5, camera.focal_px));
    return params;
}

std::optional<PlaceInPicture> place_in_picture(const Camera& camera, const glm::dvec3& point) {
    const ExactLens lens = make_exact_lens(camera);
    const glm::dvec3 p = glm::transpose(camera.world_from_camera) * (point - camera.eye);
    if (!exact::is_in_range(lens, -p.z)) return std::nullopt;
    const auto seen = exact::instance_of(lens, p);
    return PlaceInPicture{{seen.x_px / camera.aspect, 1.0 - seen.y_px}, -p.z};
}

double picture_height_at(const Camera& camera, double depth) {
    const bool parallel = exact::has_parallel_rays(make_exact_lens(camera));
    return (parallel ? 1.0 : depth) / camera.focal_px;
}

Camera widened(Camera camera, glm::dvec2 times) {
    camera.focal_px /= times.y;
    camera.aspect *= times.x / times.y;
    camera.center_x_px = 0.5 * camera.aspect;
    return camera;
}

void apply_camera_uv(Mesh& mesh, const Camera& camera) {
    std::vector<bool> seen;
    mesh.uvs.clear();
    for (const glm::vec3& position : mesh.positions) {
        const std::optional<PlaceInPicture> place = place_in_picture(camera, glm::dvec3(position));
        seen.push_back(place.has_value());
        mesh.uvs.push_back(place ? glm::vec2(place->uv) : glm::vec2(0.0f));
    }
    for (Mesh::Triangle& triangle : mesh.triangles) {
        const auto& [a, b, c] = triangle.position;
        triangle.uv = triangle.position;
        if (!(seen[a] && seen[b] && seen[c])) triangle.uv = {Mesh::no_uv, Mesh::no_uv, Mesh::no_uv};
    }
}

}  // namespace astrosplat

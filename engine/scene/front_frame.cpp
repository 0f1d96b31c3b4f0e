#include "scene/front_frame.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "source/textured_mesh.h"

namespace astrosplat {
namespace {

// Sums over all faces, seen along an axis: gradients of u and of v times the area, and the largest that
// they could be.
struct PictureDirections {
    glm::dvec3 u{0.0}, v{0.0};
    double most = 0.0;
};

glm::dvec3 corner_of(const Mesh& mesh, const Mesh::Triangle& face, std::size_t k) {
    return glm::dvec3(mesh.positions[face.position[k]]);
}

PictureDirections picture_directions(std::span<const TexturedMesh> meshes, int thin) {
    const int x = (thin + 1) % 3, y = (thin + 2) % 3;
    PictureDirections sums;
    for (const TexturedMesh& textured : meshes)
        for (const Mesh::Triangle& face : textured.mesh.triangles) {
            if (face.uv[0] == Mesh::no_uv) continue;
            const glm::dvec3 a = corner_of(textured.mesh, face, 0),
                             ab = corner_of(textured.mesh, face, 1) - a,
                             ac = corner_of(textured.mesh, face, 2) - a;
            const double twice_area = ab[x] * ac[y] - ab[y] * ac[x], sign = twice_area < 0.0 ? -1.0 : 1.0;
            const auto uv = [&](std::size_t k) { return glm::dvec2(textured.mesh.uvs[face.uv[k]]); };
            const glm::dvec2 by_b = uv(1) - uv(0), by_c = uv(2) - uv(0);
            for (int channel = 0; channel < 2; ++channel) {
                glm::dvec3 gradient(0.0);
                gradient[x] = sign * (by_b[channel] * ac[y] - by_c[channel] * ab[y]);
                gradient[y] = sign * (by_c[channel] * ab[x] - by_b[channel] * ac[x]);
                (channel == 0 ? sums.u : sums.v) += gradient;
                sums.most += glm::length(gradient);
            }
        }
    return sums;
}

int thinnest_axis(const glm::dvec3& extent) {
    int thin = 1;
    for (const int axis : {2, 0})
        if (extent[axis] < 0.999 * extent[thin]) thin = axis;
    return thin;
}

// As the planar projections of a picture are seen (source/mesh.h).
void face_viewer(FrontFrame& frame, int thin) {
    const glm::dvec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), z(0.0, 0.0, 1.0);
    frame.right = thin == 0 ? -z : x;
    frame.up = thin == 1 ? -z : y;
}

// The directions along the box's sides that fit the texture coordinates best; those of the planar
// projections where these do not say, as on closed surfaces.
void turn_upright(FrontFrame& frame, const PictureDirections& picture) {
    const glm::dvec3 x = frame.right, y = frame.up;
    const auto fit = [&](const glm::dvec3& right, const glm::dvec3& up) {
        return glm::dot(picture.u, right) + glm::dot(picture.v, up);
    };
    double best = fit(x, y) + 0.2 * picture.most;
    for (const glm::dvec3& right : {x, -x, y, -y})
        for (const glm::dvec3& up : {y, -y, x, -x}) {
            if (glm::dot(right, up) != 0.0 || !(fit(right, up) > best)) continue;
            best = fit(right, up);
            frame.right = right;
            frame.up = up;
        }
}

}  // namespace

FrontFrame front_frame(std::span<const TexturedMesh> meshes) {
    Bounds box;
    for (const TexturedMesh& textured : meshes) box.add(bounds(textured.mesh));
    if (box.empty()) throw InputError("expected a mesh with vertices, found none");
    const int thin = thinnest_axis(box.extent());
    FrontFrame frame;
    frame.center = box.center();
    face_viewer(frame, thin);
    turn_upright(frame, picture_directions(meshes, thin));
    frame.toward = glm::cross(frame.right, frame.up);
    frame.width = std::fabs(glm::dot(box.extent(), frame.right));
    frame.height = std::fabs(glm::dot(box.extent(), frame.up));
    if (!(frame.width > 0.0 && frame.height > 0.0))
        throw InputError("expected a mesh with an area to be seen from the front, found a line or a point");
    frame.camera = meshes.front().camera;
    if (frame.camera) frame.height = frame.width / frame.camera->aspect;
    return frame;
}

FrontFrame in_world(const FrontFrame& frame, const RenderLayer& layer) {
    FrontFrame world = frame;
    world.center = layer.world_from_layer * (layer.scale * frame.center) + layer.translate;
    world.right = layer.world_from_layer * frame.right;
    world.up = layer.world_from_layer * frame.up;
    world.toward = layer.world_from_layer * frame.toward;
    world.width = layer.scale * frame.width;
    world.height = layer.scale * frame.height;
    if (!frame.camera) return world;
    world.camera->eye = layer.world_from_layer * (layer.scale * frame.camera->eye) + layer.translate;
    world.camera->world_from_camera = layer.world_from_layer * frame.camera->world_from_camera;
    world.camera->near *= layer.scale;
    if (frame.camera->projection == Projection::orthographic) world.camera->focal_px /= layer.scale;
    return world;
}

CameraParams judging_camera(const FrontFrame& frame, JudgingView view, double aspect) {
    if (view == JudgingView::front && frame.camera) return params_of(*frame.camera);
    constexpr double distance = 2.0;  // widths
    const double half_root_3 = std::sqrt(0.75);
    const glm::dvec3 from = view == JudgingView::front  ? frame.toward
                            : view == JudgingView::side ? 0.5 * frame.toward - half_root_3 * frame.up
                                                        : -frame.up;
    CameraParams camera;
    camera.projection = Projection::orthographic;
    camera.target = frame.center;
    camera.position = frame.center + distance * frame.width * from;
    camera.up = view == JudgingView::front ? frame.up : frame.toward;
    camera.height = frame.width / aspect;
    return camera;
}

}  // namespace astrosplat

#include "viewer/camera_overlay.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "camera/projection.h"
#include "core/error.h"
#include "edit/project_line.h"
#include "scene/animate.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

/// Of a scene all that its camera's path depends on, to notice when that changes; the rest at its defaults.
Scene camera_part(const Scene& scene) {
    Scene part;
    part.camera = scene.camera;
    part.output.width = scene.output.width;
    part.output.height = scene.output.height;
    part.output.frames = scene.output.frames;
    part.imported = scene.imported;
    for (const Track& track : scene.animation)
        if (track.key.is_below("camera")) part.animation.push_back(track);
    return part;
}

/// Places of the scene's camera over the frames of [output], at most 256 of them; one where it does not move.
std::vector<glm::dvec3> camera_path(const Scene& scene, const Bounds& box) {
    constexpr double most = 256.0;
    const std::vector<std::int64_t> frames = parse_frames(scene.output.frames, "output.frames");
    const auto first = static_cast<double>(frames.front()), last = static_cast<double>(frames.back());
    const double step = std::max(1.0, (last - first) / (most - 1.0));
    std::vector<glm::dvec3> path;
    for (double frame = first; frame <= last; frame += step) {
        const Scene now = scene_at(scene, frame);
        const glm::dvec3 eye = make_camera(now.camera, static_cast<double>(now.output.width),
                                           static_cast<double>(now.output.height), box)
                                   .eye;
        if (path.empty() || path.back() != eye) path.push_back(eye);
    }
    return path;
}

/// Edges of the pyramid that `camera` sees, out to `length` scene units: lines of the four corners, then the
/// frame with a mark above its upper side.
std::vector<std::vector<glm::dvec3>> frustum(const Camera& camera, double width_px, double height_px,
                                             double length) {
    const auto corner = [&](double x_px, double y_px) {
        return camera.eye +
               camera.world_from_camera * exact::point_at_depth(make_exact_lens(camera), x_px, y_px, length);
    };
    const glm::dvec3 corners[] = {corner(0, 0), corner(width_px, 0), corner(width_px, height_px),
                                  corner(0, height_px)};
    std::vector<std::vector<glm::dvec3>> lines;
    for (const glm::dvec3& c : corners) lines.push_back({camera.eye, c});
    lines.push_back({corners[0], corners[1], corners[2], corners[3], corners[0]});
    lines.push_back({corner(0.4 * width_px, -0.04 * height_px), corner(0.5 * width_px, -0.16 * height_px),
                     corner(0.6 * width_px, -0.04 * height_px), corner(0.4 * width_px, -0.04 * height_px)});
    return lines;
}

}  // namespace

std::vector<CameraOverlay::Line> CameraOverlay::lines(const Scene& scene, const Scene& now, const Bounds& box,
                                                      const ViewRequest& request, const Rect& place) {
    std::vector<Line> result;
    try {
        const bool same_box = path_box_.lo == box.lo && path_box_.hi == box.hi;
        if (Scene part = camera_part(scene); !same_box || part != path_of_) {
            path_ = camera_path(part, box);
            path_of_ = std::move(part);
            path_box_ = box;
        }
        const Camera seen_through = camera_of(request);
        const double width = static_cast<double>(now.output.width),
                     height = static_cast<double>(now.output.height);
        const Camera camera = make_camera(now.camera, width, height, box);
        const double size = box.empty() ? 10.0 : glm::length(box.extent());
        std::vector<std::vector<glm::dvec3>> in_world = frustum(camera, width, height, 0.08 * size);
        in_world.push_back(path_);
        const float scale = place.width / static_cast<float>(request.width);
        for (const std::vector<glm::dvec3>& line : in_world)
            for (Line& part : project_line(seen_through, line)) {
                for (glm::vec2& p : part) p = glm::vec2(place.x, place.y) + scale * p;
                result.push_back(std::move(part));
            }
    } catch (const InputError&) {
        result.clear();
    }
    return result;
}

}  // namespace astrosplat

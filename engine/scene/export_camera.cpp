#include "scene/export_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "camera/camera.h"
#include "camera_files/formats.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/real.h"
#include "core/text.h"
#include "scene/animate.h"
#include "scene/camera_file.h"
#include "scene/layer_setup.h"

namespace astrosplat {
namespace {

/// camera.position, camera.rotation and the lens as tracks with a keyframe at each sample.
std::string table_of(const CameraTrack& track) {
    Track position, rotation, lens;
    position.key = "camera.position";
    rotation.key = "camera.rotation";
    lens.key = track.orthographic ? "camera.height" : "camera.fov";
    const auto add = [](Track& to, double frame, std::vector<double> value) {
        to.keyframes.push_back({frame, std::move(value), Interpolation::linear, {}, {}});
    };
    for (const TrackSample& sample : track.samples) {
        const glm::dvec3& p = sample.eye;
        const glm::dvec4& q = sample.rotation;
        add(position, sample.frame, {p.x, p.y, p.z});
        add(rotation, sample.frame, {q.x, q.y, q.z, q.w});
        add(lens, sample.frame, {track.orthographic ? sample.height : sample.fov_deg});
    }
    std::vector<Track> tracks{std::move(position), std::move(rotation)};
    if (track.has_fov || track.orthographic) tracks.push_back(std::move(lens));
    return csv_text(tracks);
}

}  // namespace

CameraTrack camera_track(const Scene& scene, std::span<const std::int64_t> frames) {
    if (!has_camera_places(scene))
        throw InputError(
            fmt::format("{}: camera.position: expected a position, or keyframes of it, found none: such a "
                        "camera frames its layers",
                        scene.file.string()));
    const auto width = static_cast<double>(scene.output.width),
               height = static_cast<double>(scene.output.height);
    CameraTrack track;
    track.fps = scene.output.fps;
    std::size_t perspective = 0, orthographic = 0;
    for (const std::int64_t frame : frames) {
        CameraParams params = scene_at(scene, static_cast<double>(frame)).camera;
        params.eye = Eye::centre;
        params.fisheye_tilt = 0.0;
        const Camera camera = make_camera(params, width, height, {});
        TrackSample sample;
        sample.frame = static_cast<double>(frame);
        sample.eye = camera.eye;
        quaternion_from_axes(camera.world_from_camera, sample.rotation);
        // The same turn on the side where the one before is, so that other programs go the short way.
        if (!track.samples.empty() && glm::dot(sample.rotation, track.samples.back().rotation) < 0.0)
            sample.rotation = -sample.rotation;
        if (params.projection == Projection::perspective) {
            sample.fov_deg = real::degrees(2.0 * real::atan2(0.5 * height, camera.focal_px));
            ++perspective;
        }
        if (params.projection == Projection::orthographic) {
            sample.height = height / camera.focal_px;
            ++orthographic;
        }
        track.samples.push_back(sample);
    }
    track.has_fov = perspective == frames.size();
    track.orthographic = orthographic == frames.size();
    if (perspective + orthographic > 0 && !track.has_fov && !track.orthographic)
        throw InputError(
            fmt::format("{}: camera.projection: expected one projection at all frames, found several",
                        scene.file.string()));
    return track;
}

std::string camera_text(const CameraTrack& track, const Scene& scene, const std::filesystem::path& file) {
    const FileFormat* const format = format_by_name(file, FileUse::camera_written);
    const std::string_view id = format ? format->id : "";
    if (id == "table") return table_of(track);
    const double aspect = static_cast<double>(scene.output.width) / static_cast<double>(scene.output.height);
    if (id == "usda") return usda_text(track, {aspect, scene.camera.near, scene.camera.far});
    if (id == "gltf") {
        const auto other_lens = [&](const TrackSample& sample) {
            return sample.fov_deg != track.samples[0].fov_deg || sample.height != track.samples[0].height;
        };
        if (std::ranges::any_of(track.samples, other_lens))
            log_warning(fmt::format("{}: the lens changes, which glTF cannot say: it is that of frame {}",
                                    printable(file.string()), shortest(track.samples[0].frame)));
        return gltf_text(track, aspect, scene.camera.near, scene.camera.far);
    }
    if (id == "chan" && track.orthographic)
        throw InputError(
            fmt::format("{}: expected a perspective camera, for .chan has no other, found orthographic",
                        printable(file.string())));
    if (id == "chan") return chan_text(track);
    bad_input(file.string(), "", "a name ending in " + alternatives(endings_of(FileUse::camera_written)),
              "'" + printable(file.extension().string()) + "'");
}

}  // namespace astrosplat

#include "scene/camera_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera_files/read_camera.h"
#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/text.h"
#include "scene/csv_tracks.h"
#include "scene/parameter.h"
#include "scene/value.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

bool is_table(const fs::path& file) {
    const FileFormat* const format = format_by_name(file);
    return format && format->id == "table";
}

/// Where z is up it becomes y: x stays, y goes to -z.
glm::dvec3 y_up(const glm::dvec3& v) { return {v.x, v.z, -v.y}; }
glm::dvec4 y_up(const glm::dvec4& q) {
    // A quarter turn about -x before what the camera did.
    const double h = std::sqrt(0.5);
    return {h * (q.x - q.w), h * (q.y + q.z), h * (q.z - q.y), h * (q.w + q.x)};
}

/// Frames, units and axes of a file made into those of a scene.
struct FilePlacement {
    double scale, offset;
    bool z_up;
    glm::dvec3 place(const glm::dvec3& v) const { return (z_up ? y_up(v) : v) * scale; }
    glm::dvec4 turn(const glm::dvec4& q) const { return z_up ? y_up(q) : q; }
};

FilePlacement placement_of(const CameraParams& camera, FileUp of_file) {
    const bool z_up =
        camera.file_up == CameraFileUp::automatic ? of_file == FileUp::z : camera.file_up == CameraFileUp::z;
    return {camera.file_scale, camera.file_offset, z_up};
}

Track track_of(const char* key, double first_frame, std::vector<double> value) {
    Track track;
    track.key = key;
    track.keyframes.push_back({first_frame, std::move(value), Interpolation::linear, {}, {}});
    return track;
}

void check_sizes(const std::vector<double>& numbers, const char* key, const fs::path& file, double frame) {
    for (const double x : numbers)
        if (!(std::fabs(x) <= largest_number))
            bad_input(file.string(), fmt::format("frame {}", short_number(frame)),
                      fmt::format("{} within {:.4g}", key, largest_number),
                      fmt::format("{:.4g}", x) + " (camera.file_scale makes it smaller)");
}

std::vector<Track> tracks_of(const CameraTrack& file_track, const CameraParams& camera,
                             const fs::path& file) {
    const FilePlacement placement = placement_of(camera, file_track.up);
    Track position, rotation, fov, height;
    position.key = "camera.position";
    rotation.key = "camera.rotation";
    fov.key = "camera.fov";
    height.key = "camera.height";
    const auto add = [](Track& track, double frame, std::vector<double> value) {
        track.keyframes.push_back({frame, std::move(value), Interpolation::linear, {}, {}});
    };
    for (const TrackSample& sample : file_track.samples) {
        const double frame = sample.frame + placement.offset;
        const glm::dvec3 p = placement.place(sample.eye);
        const glm::dvec4 q = placement.turn(sample.rotation);
        check_sizes({p.x, p.y, p.z}, "camera.position", file, frame);
        add(position, frame, {p.x, p.y, p.z});
        add(rotation, frame, {q.x, q.y, q.z, q.w});
        if (file_track.has_fov) add(fov, frame, {sample.fov_deg});
        if (file_track.orthographic) {
            check_sizes({sample.height * placement.scale}, "camera.height", file, frame);
            add(height, frame, {sample.height * placement.scale});
        }
    }
    const double first = position.keyframes.front().frame;
    std::vector<Track> tracks{std::move(position), std::move(rotation)};
    if (file_track.has_fov) {
        tracks.push_back(std::move(fov));
        tracks.push_back(
            track_of("camera.focal_length", first, {0.0}));  // or it would replace the file's fov
    }
    if (file_track.orthographic) {
        tracks.push_back(std::move(height));
        // A scene that asks for a dome or a panorama gets one along this path too.
        if (camera.projection == Projection::perspective)
            tracks.push_back(
                track_of("camera.projection", first, {static_cast<double>(Projection::orthographic)}));
    }
    return tracks;
}

/// Tables hold places and turns of the camera under their keys.
void place_table(std::vector<Track>& tracks, const CameraParams& camera, const fs::path& file) {
    const FilePlacement placement = placement_of(camera, FileUp::y);
    for (Track& track : tracks) {
        const bool place = track.key == "camera.position" || track.key == "camera.target";
        const bool direction = track.key == "camera.up";
        for (auto& keyframe : track.keyframes) {
            keyframe.frame += placement.offset;
            std::vector<double>& v = keyframe.value;
            if (place || direction) {
                const glm::dvec3 read(v[0], v[1], v[2]);
                const glm::dvec3 p = place ? placement.place(read) : placement.z_up ? y_up(read) : read;
                v = {p.x, p.y, p.z};
                check_sizes(v, track.key.text().c_str(), file, keyframe.frame);
            } else if (track.key == "camera.rotation") {
                const glm::dvec4 q = placement.turn({v[0], v[1], v[2], v[3]});
                v = {q.x, q.y, q.z, q.w};
            } else if (track.key == "camera.height") {
                v[0] *= placement.scale;
            }
        }
    }
}

ImportedCamera::Source source_of(const Scene& scene) {
    const CameraParams& c = scene.camera;
    return {c.file, c.file_scale, c.file_offset, c.file_fps, c.file_up, scene.output.fps, c.projection};
}

}  // namespace

std::vector<Track> camera_file_tracks(Scene& scene, const fs::path& file) {
    const FrameRate rate{scene.output.fps, scene.camera.file_fps};
    if (is_table(file)) {
        std::vector<Track> tracks = read_csv_tracks(file, rate, scene);
        place_table(tracks, scene.camera, file);
        return tracks;
    }
    const CameraTrack track = read_camera(file, rate);
    for (const std::string& warning : track.warnings) log_warning(warning);
    return tracks_of(track, scene.camera, file);
}

void attach_camera_file(Scene& scene, const std::string& place) {
    scene.imported.camera.reset();
    const fs::path& file = scene.camera.file;
    if (file.empty()) return;
    if (!is_camera_file(file) && !is_table(file))
        throw InputError(fmt::format(
            "{}camera.file: expected a name ending in {}, found '{}'", place.empty() ? "" : place + ": ",
            alternatives(endings_of(FileUse::camera_read)), printable(file.string())));
    try {
        require_readable(file);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}camera.file: {}", place.empty() ? "" : place + ": ", error.what()));
    }
    auto imported = std::make_shared<ImportedCamera>();
    imported->tracks = camera_file_tracks(scene, file);
    std::erase_if(imported->tracks, [&](const Track& track) {
        return std::ranges::find(scene.imported.overruled, track.key) != scene.imported.overruled.end();
    });
    imported->source = source_of(scene);
    scene.imported.camera = std::move(imported);
}

void refresh_camera_file(Scene& scene, const std::string& place) {
    const bool has = scene.imported.camera != nullptr;
    if (scene.camera.file.empty() ? !has : has && scene.imported.camera->source == source_of(scene)) return;
    attach_camera_file(scene, place);
}

}  // namespace astrosplat

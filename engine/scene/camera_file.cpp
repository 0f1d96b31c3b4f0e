#include "scene/camera_file.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "camera/camera.h"
#include "camera_files/formats.h"
#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/real.h"
#include "core/text.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"

namespace astrosplat {
namespace {

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
    double scale = 1.0, offset = 0.0;
    bool z_up = false;
    double aspect = 1.0;  // of the scene's frames
    glm::dvec3 place(const glm::dvec3& v) const { return (z_up ? y_up(v) : v) * scale; }
    glm::dvec4 turn(const glm::dvec4& q) const { return z_up ? y_up(q) : q; }
};

double aspect_of(const Scene& scene) { return double(scene.output.width) / double(scene.output.height); }

FilePlacement placement_of(const Scene& scene, FileUp of_file) {
    const CameraParams& camera = scene.camera;
    const bool z_up =
        camera.file_up == CameraFileUp::automatic ? of_file == FileUp::z : camera.file_up == CameraFileUp::z;
    return {camera.file_scale, camera.file_offset, z_up, aspect_of(scene)};
}

void add_keyframe(Track& track, double frame, std::vector<double> value) {
    track.keyframes.push_back({frame, std::move(value), Interpolation::linear, {}, {}});
}

void check_sizes(const std::vector<double>& numbers, const char* key, const fs::path& file, double frame) {
    for (const double x : numbers)
        if (!(std::fabs(x) <= largest_number))
            bad_input(file, fmt::format("frame {}", short_number(frame)),
                      fmt::format("{} within {:.4g}", key, largest_number),
                      fmt::format("{:.4g}", x) + " (camera.file_scale makes it smaller)");
}

/// camera.position, camera.rotation and, where the samples have one, the lens,
/// with a keyframe at each sample.
std::vector<Track> sampled_tracks(const CameraTrack& from, const FilePlacement& placement,
                                  const fs::path& file) {
    Track position, rotation, lens, shift;
    position.key = "camera.position";
    rotation.key = "camera.rotation";
    shift.key = "camera.shift";
    lens.key = from.orthographic()                          ? "camera.height"
               : from.projection == Projection::perspective ? "camera.fov"
                                                            : "camera.fisheye_fov";
    for (const TrackSample& sample : from.samples) {
        const double frame = sample.frame + placement.offset;
        const glm::dvec3 p = placement.place(sample.eye);
        const glm::dvec4 q = placement.turn(sample.rotation);
        const double height = sample.height * placement.scale;
        check_sizes({p.x, p.y, p.z}, "camera.position", file, frame);
        if (from.orthographic()) check_sizes({height}, "camera.height", file, frame);
        check_sizes({sample.shift.x, sample.shift.y}, "camera.shift", file, frame);
        add_keyframe(position, frame, {p.x, p.y, p.z});
        add_keyframe(rotation, frame, {q.x, q.y, q.z, q.w});
        add_keyframe(lens, frame, {from.orthographic() ? height : sample.fov_deg});
        add_keyframe(shift, frame, {sample.shift.x / placement.aspect, sample.shift.y});
    }
    std::vector<Track> tracks{std::move(position), std::move(rotation)};
    if (from.has_fov || from.orthographic()) tracks.push_back(std::move(lens));
    if (from.has_shift) tracks.push_back(std::move(shift));
    return tracks;
}

std::vector<Track> tracks_of(const CameraTrack& from, const Scene& scene, const fs::path& file) {
    std::vector<Track> tracks = sampled_tracks(from, placement_of(scene, from.up), file);
    const auto hold = [&](const char* key, double value) {
        const double first = tracks.front().keyframes.front().frame;
        tracks.emplace_back().key = key;
        add_keyframe(tracks.back(), first, {value});
    };
    if (from.has_fov) hold("camera.focal_length", 0.0);  // or it would replace the file's fov
    // A scene that asks for a dome or a panorama gets one along this path too.
    if (from.projection != Projection::perspective && scene.camera.projection == Projection::perspective) {
        hold("camera.projection", double(from.projection));
        if (from.projection == Projection::equirectangular) hold("camera.panorama_fov", 360.0);
    }
    return tracks;
}

/// Tables hold places and turns of the camera under their keys.
void place_table(std::vector<Track>& tracks, const Scene& scene, const fs::path& file) {
    const FilePlacement placement = placement_of(scene, FileUp::y);
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
    return {c.file,           c.file_scale, c.file_offset,    c.file_fps,
            aspect_of(scene), c.file_up,    scene.output.fps, c.projection};
}

/// For a scene that has its keys camera.file_*; its lists grow where a table names their next element.
std::vector<Track> camera_file_tracks(Scene& scene, const fs::path& file) {
    const FrameRate rate{scene.output.fps, scene.camera.file_fps};
    if (is_table(file)) {
        std::vector<Track> tracks = read_csv_tracks(file, rate, scene);
        place_table(tracks, scene, file);
        return tracks;
    }
    const CameraTrack track = read_camera(file, rate);
    for (const std::string& warning : track.warnings) log_warning(warning);
    return tracks_of(track, scene, file);
}

}  // namespace

void attach_camera_file(Scene& scene, const std::string& place) {
    scene.imported.camera.reset();
    const fs::path& file = scene.camera.file;
    if (file.empty()) return;
    const std::string key = (place.empty() ? "" : place + ": ") + "camera.file: ";
    if (!is_camera_file(file) && !is_table(file))
        throw InputError(fmt::format("{}expected a name ending in {}, found '{}'", key,
                                     alternatives(endings_of(FileUse::camera_read)),
                                     printable(file.string())));
    try {
        require_readable(file);
    } catch (const InputError& error) {
        throw InputError(key + error.what());
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
    const auto& camera = scene.imported.camera;
    ImportedCamera::Source wanted = source_of(scene);
    if (camera &&
        std::ranges::find(camera->tracks, ParameterKey("camera.shift"), &Track::key) == camera->tracks.end())
        wanted.aspect = camera->source.aspect;  // only shifts depend on it
    if (scene.camera.file.empty() ? !camera : camera && camera->source == wanted) return;
    attach_camera_file(scene, place);
}

std::string missed_camera_frames(const Scene& scene, std::span<const std::int64_t> frames) {
    if (!scene.imported.camera || frames.empty()) return {};
    double first = 0.0, last = 0.0;
    for (const Track& track : scene.imported.camera->tracks)
        if (track.keyframes.size() > 1)
            first = track.keyframes.front().frame, last = track.keyframes.back().frame;
    const auto [from, to] = std::ranges::minmax(frames);
    if (!(first < last) || (first <= double(to) && double(from) <= last)) return {};
    return fmt::format(
        "{}: its camera stands still, for it moves at frames {} to {}, outside of {} to {}; "
        "camera.file_offset "
        "= {} would fit",
        printable(scene.camera.file.string()), shortest(first), shortest(last), from, to,
        shortest(scene.camera.file_offset + double(from) - first));
}

CameraTrack camera_track(const Scene& scene, std::span<const std::int64_t> frames) {
    if (!has_camera_places(scene))
        throw InputError(
            fmt::format("{}: camera.position: expected a position, or keyframes of it, found none: such a "
                        "camera frames its layers",
                        scene.file.string()));
    const auto width = double(scene.output.width), height = double(scene.output.height);
    CameraTrack track;
    track.fps = scene.output.fps;
    std::size_t perspective = 0, orthographic = 0;
    for (const std::int64_t frame : frames) {
        CameraParams params = scene_at(scene, double(frame)).camera;
        params.eye = Eye::centre;
        params.fisheye_tilt = 0.0;
        const Camera camera = make_camera(params, width, height, {});
        TrackSample sample;
        sample.frame = double(frame);
        sample.eye = camera.eye;
        quaternion_from_axes(camera.world_from_camera, sample.rotation);
        // The same turn on the side where the one before is, so that other programs go the short way.
        if (!track.samples.empty() && glm::dot(sample.rotation, track.samples.back().rotation) < 0.0)
            sample.rotation = -sample.rotation;
        if (params.projection == Projection::perspective) {
            sample.fov_deg = real::degrees(2.0 * real::atan2(0.5 * height, camera.focal_px));
            sample.shift = {(0.5 * width - camera.center_x_px) / height,
                            (camera.center_y_px - 0.5 * height) / height};
            track.has_shift |= params.shift != glm::dvec2(0.0);
            ++perspective;
        }
        if (params.projection == Projection::orthographic) {
            sample.height = height / camera.focal_px;
            ++orthographic;
        }
        track.samples.push_back(sample);
    }
    track.has_fov = perspective == frames.size();
    if (orthographic == frames.size()) track.projection = Projection::orthographic;
    if (perspective + orthographic > 0 && !track.has_fov && !track.orthographic())
        throw InputError(
            fmt::format("{}: camera.projection: expected one projection at all frames, found several",
                        scene.file.string()));
    return track;
}

std::string camera_text(const CameraTrack& track, const Scene& scene, const fs::path& file) {
    const FileFormat* const format = format_by_name(file, FileUse::camera_written);
    const std::string_view id = format ? format->id : "";
    const double aspect = aspect_of(scene);
    if (!id.empty() && !track.has_fov && !track.orthographic())
        log_warning(fmt::format("{}: places and turns alone are written: the camera is no perspective one",
                                printable(file.string())));
    if (id == "table") return csv_text(sampled_tracks(track, {.aspect = aspect}, file));
    if (track.has_shift && (id == "gltf" || id == "chan"))
        log_warning(fmt::format("{}: camera.shift is left out, for {} cannot say it",
                                printable(file.string()), id == "gltf" ? "glTF" : ".chan"));
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
    if (id == "chan" && track.orthographic())
        throw InputError(
            fmt::format("{}: expected a perspective camera, for .chan has no other, found orthographic",
                        printable(file.string())));
    if (id == "chan") return chan_text(track);
    bad_input(file, "a name ending in " + alternatives(endings_of(FileUse::camera_written)),
              "'" + printable(file.extension().string()) + "'");
}

}  // namespace astrosplat

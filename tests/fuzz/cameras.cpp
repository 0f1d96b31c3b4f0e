#include "fuzz/cameras.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>

#include "camera_files/camera_track.h"
#include "camera_files/formats.h"
#include "fuzz/targets.h"
#include "scene/camera_file.h"

namespace astrosplat::fuzz {
namespace {

/// A file of this process that holds the bytes while the object lives.
struct CameraFile {
    std::filesystem::path path;
    CameraFile(std::string_view bytes, const std::string& ending)
        : path(std::filesystem::temp_directory_path() /
               ("astrosplat_fuzz_" + std::to_string(::getpid()) + ending)) {
        std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
    ~CameraFile() { std::filesystem::remove(path); }
};

std::string ending_of(std::string_view bytes) {
    const auto has = [&](std::string_view part) { return bytes.find(part) != std::string_view::npos; };
    if (bytes.starts_with("glTF")) return ".glb";
    if (bytes.starts_with("{")) return has("transform_matrix") ? ".json" : ".gltf";
    if (bytes.starts_with("#usda")) return ".usda";
    if (bytes.starts_with("OpenSpace")) return ".osrectxt";
    if (bytes.starts_with("frame")) return ".csv";
    return has("1548767330626") ? ".gsc" : ".chan";
}

std::string little_endian(std::size_t n) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(n >> 8 * i & 255);
    return bytes;
}

std::string binary_gltf(std::string json) {
    while (json.size() % 4) json += ' ';
    return "glTF" + little_endian(2) + little_endian(20 + json.size()) + little_endian(json.size()) + "JSON" +
           json;
}

std::size_t check(const CameraTrack& track) {
    demand(!track.samples.empty(), "a sample");
    for (const TrackSample& sample : track.samples) {
        demand(std::isfinite(sample.frame) && std::isfinite(sample.fov_deg) && std::isfinite(sample.height),
               "finite numbers");
        for (int i = 0; i < 3; ++i) demand(std::isfinite(sample.eye[i]), "a finite place");
        demand(std::fabs(glm::length(sample.rotation) - 1.0) < 1e-6, "a rotation of length 1");
    }
    for (std::size_t i = 1; i < track.samples.size(); ++i)
        demand(track.samples[i].frame > track.samples[i - 1].frame, "frames that ascend");
    return track.samples.size();
}

}  // namespace

std::vector<std::string> camera_seeds() {
    CameraTrack track;
    track.fps = 24.0;
    track.has_fov = true;
    track.samples = {{1.0, {0.0, 1.0, 2.0}, {0.0, 0.0, 0.0, 1.0}, 40.0, 0.0},
                     {2.0, {3.0, 1.0, 2.0}, {0.0, 0.6, 0.0, 0.8}, 40.0, 0.0}};
    const std::string gltf = gltf_text(track, 1.5, 0.1, 0.0);
    return {
        "# frame\n1 0 0 9 0 0 0 40\n2 0.5 -0.25 8 10 20 -30 42.5\n",
        "1548767330626 1 2 3 1 0 0 0 1 0\n1548767330626 2 2 3 0 0 -2 0.5 3 0\n",
        "OpenSpace_record/playback03.00A\nscript 0 0 1 x()\ncamera 0.5 7 1 2 3 0.8 0 0.6 0 0.1 - Venus\n"
        "camera 1.5 8 1e12 2 3 0.8 0 0.6 0 0.1 F Mars\n",
        "frame,camera.position.x,camera.position.y,camera.position.z,camera.fov\n1,0,0,9,40\n2,1,0,8,41\n",
        gltf,
        binary_gltf(gltf),
        usda_text(track, {}),
        "#usda 1.0\n(\n upAxis = \"Z\"\n metersPerUnit = 0.01\n)\ndef Xform \"a\" (\n kind = 'x'\n)\n{\n"
        " float3 xformOp:rotateXYZ.timeSamples = { 0: (1, 2, 3), 4: (5, 6, 7) }\n"
        " double3 xformOp:translate = (1, 2, 3)\n"
        " uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateXYZ\"]\n"
        " def Camera \"c\"\n {\n float focalLength = 35\n rel r = </a>\n"
        " quatf xformOp:orient = (1, 0, 0, 0)\n uniform token[] xformOpOrder = [\"xformOp:orient\"]\n }\n}\n",
        R"({"camera_angle_x":0.7,"w":8,"h":6,"frames":[{"transform_matrix":[[0,0,-1,1],[-1,0,0,2],[0,1,0,3]]},)"
        R"({"fl_y":5,"transform_matrix":[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}]})"};
}

std::size_t read_camera_bytes(std::string_view bytes) {
    const std::string ending = ending_of(bytes);
    const CameraFile file(bytes, ending);
    const FrameRate rate{24.0, 0.0};
    if (ending != ".csv") return check(read_camera(file.path, rate));
    Scene scene;
    std::size_t keyframes = 0;
    for (const Track& read : read_csv_tracks(file.path, rate, scene))
        for (const auto& keyframe : read.keyframes) {
            ++keyframes;
            demand(std::isfinite(keyframe.frame), "finite frames");
            for (const double number : keyframe.value) demand(std::isfinite(number), "finite values");
        }
    return keyframes;
}

}  // namespace astrosplat::fuzz

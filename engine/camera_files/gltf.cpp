#include "camera_files/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <optional>

#include "camera/camera.h"
#include "camera_files/gltf_curve.h"
#include "core/base64.h"
#include "core/error.h"
#include "core/real.h"
#include "core/text.h"
#include "gltf/gltf_file.h"

namespace astrosplat {
namespace {

using Json = nlohmann::json;

struct Node {
    std::optional<glm::dmat4> matrix;
    glm::dvec3 translation{0.0}, scale{1.0};
    glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};
    std::optional<GltfCurve> translation_curve, rotation_curve, scale_curve;
};

glm::dvec4 numbers_of(const GltfFile& file, const Json& node, const char* name, std::size_t count,
                      const glm::dvec4& otherwise) {
    if (!node.contains(name)) return otherwise;
    const auto list = node.at(name).get<std::vector<double>>();
    if (list.size() != count)
        file.fail(fmt::format("{} numbers as a node's {}", count, name), std::to_string(list.size()));
    glm::dvec4 v(0.0);
    for (std::size_t i = 0; i < count; ++i) v[static_cast<int>(i)] = list[i];
    return v;
}

Node node_of(const GltfFile& file, const Json& json) {
    Node node;
    node.translation = glm::dvec3(numbers_of(file, json, "translation", 3, glm::dvec4(0.0)));
    node.scale = glm::dvec3(numbers_of(file, json, "scale", 3, glm::dvec4(1.0)));
    node.rotation = numbers_of(file, json, "rotation", 4, {0.0, 0.0, 0.0, 1.0});
    if (!json.contains("matrix")) return node;
    const auto list = json.at("matrix").get<std::vector<double>>();
    if (list.size() != 16) file.fail("16 numbers as a node's matrix", std::to_string(list.size()));
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = list[static_cast<std::size_t>(i)];
    node.matrix = matrix;
    return node;
}

glm::dmat4 matrix_at(const Node& node, double frame) {
    if (node.matrix) return *node.matrix;
    const glm::dvec3 place =
        node.translation_curve ? glm::dvec3(value_of(*node.translation_curve, frame)) : node.translation;
    const glm::dvec4 turn = node.rotation_curve ? value_of(*node.rotation_curve, frame) : node.rotation;
    const glm::dvec3 scale = node.scale_curve ? glm::dvec3(value_of(*node.scale_curve, frame)) : node.scale;
    const glm::dmat3 axes = rotation_from_quaternion(turn);
    return {glm::dvec4(axes[0] * scale.x, 0.0), glm::dvec4(axes[1] * scale.y, 0.0),
            glm::dvec4(axes[2] * scale.z, 0.0), glm::dvec4(place, 1.0)};
}

/// The node of the camera and its parents, from the root down, as their numbers in the file.
std::vector<std::int64_t> way_to_camera(const GltfFile& file) {
    const Json nodes = file.json().value("nodes", Json::array());
    std::vector<std::int64_t> parent(nodes.size(), -1);
    std::int64_t camera = -1;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (camera < 0 && nodes[i].contains("camera")) camera = static_cast<std::int64_t>(i);
        for (const Json& child : nodes[i].value("children", Json::array())) {
            file.element("nodes", child);
            parent[child.get<std::size_t>()] = static_cast<std::int64_t>(i);
        }
    }
    if (camera < 0) file.fail("a node with a camera", "none");
    std::vector<std::int64_t> way;
    for (std::int64_t i = camera; i >= 0; i = parent[static_cast<std::size_t>(i)]) {
        if (way.size() > nodes.size()) file.fail("nodes that are not their own children", "a circle");
        way.insert(way.begin(), i);
    }
    return way;
}

/// Gives the nodes of `way` the curves of the first animation that moves any of them.
void attach_curves(GltfFile& file, const std::vector<std::int64_t>& way, double fps,
                   std::vector<Node>& nodes) {
    for (const Json& animation : file.json().value("animations", Json::array())) {
        bool moves = false;
        for (const Json& channel : animation.at("channels")) {
            const Json& target = channel.at("target");
            const auto found = std::ranges::find(way, target.value("node", std::int64_t(-1)));
            const std::string path = target.value("path", "");
            if (found == way.end() || path == "weights") continue;
            Node& node = nodes[static_cast<std::size_t>(found - way.begin())];
            std::optional<GltfCurve>* const curve = path == "translation" ? &node.translation_curve
                                                    : path == "rotation"  ? &node.rotation_curve
                                                    : path == "scale"     ? &node.scale_curve
                                                                          : nullptr;
            if (!curve) continue;  // of an extension
            const auto sampler = channel.at("sampler").get<std::int64_t>();
            const Json& samplers = animation.at("samplers");
            if (sampler < 0 || sampler >= std::ssize(samplers))
                file.fail("a number of one of its samplers", std::to_string(sampler));
            *curve = gltf_curve(file, samplers[static_cast<std::size_t>(sampler)], path == "rotation" ? 4 : 3,
                                fps);
            node.matrix.reset();
            moves = true;
        }
        if (moves) return;
    }
}

/// First and last frame of what moves; nothing where nothing does.
std::optional<std::pair<double, double>> span_of(const std::vector<Node>& nodes) {
    std::optional<std::pair<double, double>> span;
    for (const Node& node : nodes)
        for (const auto* curve : {&node.translation_curve, &node.rotation_curve, &node.scale_curve})
            if (*curve) {
                const double first = (*curve)->frames.front(), last = (*curve)->frames.back();
                span = span ? std::pair(std::min(span->first, first), std::max(span->second, last))
                            : std::pair(first, last);
            }
    return span;
}

void set_lens(const GltfFile& file, const Json& camera, CameraTrack& track) {
    track.orthographic = camera.value("type", "") == "orthographic";
    const Json& lens = camera.at(track.orthographic ? "orthographic" : "perspective");
    const double value = lens.at(track.orthographic ? "ymag" : "yfov").get<double>();
    if (!(value > 0.0 && (track.orthographic || value < real::pi)))
        file.fail(track.orthographic ? "a ymag above 0" : "a yfov between 0 and pi",
                  fmt::format("{:.4g}", value));
    track.has_fov = !track.orthographic;
    for (TrackSample& sample : track.samples)
        (track.orthographic ? sample.height : sample.fov_deg) =
            track.orthographic ? 2.0 * value : real::degrees(value);
}

CameraTrack read_checked(const std::filesystem::path& path, const FrameRate& rate) {
    GltfFile file(path);
    const std::vector<std::int64_t> way = way_to_camera(file);
    std::vector<Node> nodes;
    for (const std::int64_t i : way) nodes.push_back(node_of(file, file.element("nodes", i)));
    attach_curves(file, way, rate.output_fps, nodes);
    const auto span = span_of(nodes).value_or(std::pair(0.0, 0.0));
    const double first = std::floor(span.first), last = std::ceil(span.second);
    if (!(last - first < double(most_camera_samples)) || !(std::fabs(first) < 1e9))
        file.fail(fmt::format("at most {} frames", most_camera_samples), fmt::format("{:.4g}", last - first));
    CameraTrack track;
    track.fps = rate.output_fps;
    for (double frame = first; frame <= std::max(first, last); frame += 1.0) {
        glm::dmat4 world(1.0);
        for (const Node& node : nodes) world = world * matrix_at(node, frame);
        TrackSample sample;
        sample.frame = frame;
        sample.eye = glm::dvec3(world[3]);
        if (!quaternion_from_axes(glm::dmat3(world), sample.rotation))
            file.fail("a camera with axes", fmt::format("none at frame {}", frame));
        track.samples.push_back(sample);
    }
    set_lens(file, file.element("cameras", file.element("nodes", way.back()).at("camera")), track);
    return track;
}

void add_floats(std::string& bytes, std::initializer_list<double> values) {
    for (const double value : values) {
        const auto number = static_cast<float>(value);
        char raw[sizeof number];
        std::memcpy(raw, &number, sizeof number);
        bytes.append(raw, sizeof number);
    }
}

}  // namespace

CameraTrack read_gltf(const std::filesystem::path& file, const FrameRate& rate) {
    try {
        return read_checked(file, rate);
    } catch (const Json::exception& error) {  // a value of another type than glTF says
        bad_input(file.string(), "", "a glTF 2.0 file", printable(error.what()));
    }
}

std::string gltf_text(const CameraTrack& track, double aspect, double near, double far) {
    const TrackSample& first = track.samples.front();
    if (first.frame < 0.0)
        throw InputError(
            fmt::format("--frames: expected frames from 0 on, for glTF's time begins there, found {}",
                        shortest(first.frame)));
    std::string bytes;
    for (const TrackSample& sample : track.samples) add_floats(bytes, {sample.frame / track.fps});
    for (const TrackSample& sample : track.samples)
        add_floats(bytes, {sample.eye.x, sample.eye.y, sample.eye.z});
    for (const TrackSample& sample : track.samples)
        add_floats(bytes, {sample.rotation.x, sample.rotation.y, sample.rotation.z, sample.rotation.w});
    const std::size_t n = track.samples.size();
    const Json lens = track.orthographic ? Json{{"xmag", 0.5 * first.height * aspect},
                                                {"ymag", 0.5 * first.height},
                                                {"znear", near},
                                                {"zfar", far > 0.0 ? far : 1e9}}
                                         : Json{{"yfov", real::radians(track.has_fov ? first.fov_deg : 45.0)},
                                                {"aspectRatio", aspect},
                                                {"znear", near}};
    const char* kind = track.orthographic ? "orthographic" : "perspective";
    const auto accessor = [&](int view, const char* type) {
        return Json{{"bufferView", view}, {"componentType", 5126}, {"count", n}, {"type", type}};
    };
    Json times = accessor(0, "SCALAR");
    times["min"] = {static_cast<float>(first.frame / track.fps)};
    times["max"] = {static_cast<float>(track.samples.back().frame / track.fps)};
    const Json file = {
        {"asset", {{"version", "2.0"}, {"generator", "astrosplat " ASTROSPLAT_VERSION}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"name", "camera"}, {"camera", 0}}}},
        {"cameras", {{{"type", kind}, {kind, lens}}}},
        {"animations",
         {{{"samplers", {{{"input", 0}, {"output", 1}}, {{"input", 0}, {"output", 2}}}},
           {"channels",
            {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
             {{"sampler", 1}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}}}},
        {"accessors", {times, accessor(1, "VEC3"), accessor(2, "VEC4")}},
        {"bufferViews",
         {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 4 * n}},
          {{"buffer", 0}, {"byteOffset", 4 * n}, {"byteLength", 12 * n}},
          {{"buffer", 0}, {"byteOffset", 16 * n}, {"byteLength", 16 * n}}}},
        {"buffers",
         {{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}}}};
    return file.dump(1) + "\n";
}

}  // namespace astrosplat

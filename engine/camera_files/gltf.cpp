#include "camera_files/formats.h"

#include <fmt/format.h>

#include <cstring>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "core/error.h"
#include "core/real.h"
#include "core/text.h"
#include "gltf/gltf_file.h"

namespace astrosplat {
namespace {

using Json = nlohmann::json;

// ---- what moves: a place, a turn or a size over time

/// Vectors of 3 or turns, quaternions x y z w.
struct GltfCurve {
    std::vector<double> frames;  // ascending, at least one
    std::vector<float> values;   // cubic: what arrives, the value, what leaves
    double fps = 24.0;
    int components = 3;
    enum class Between { linear, step, cubic } between = Between::linear;
};

/// Times are floats: what lies within a thousandth of a whole frame is meant to lie on it.
double frame_of(double seconds, double fps) {
    const double frame = seconds * fps, whole = std::floor(frame + 0.5);
    return std::fabs(frame - whole) < 1e-3 ? whole : frame;
}

/// Turns go the short way round, at even speed (glTF 2.0, appendix C.3).
glm::dvec4 turned_between(const glm::dvec4& a, glm::dvec4 b, double t) {
    double cosine = glm::dot(a, b);
    if (cosine < 0.0) b = -b, cosine = -cosine;
    if (cosine > 1.0 - 1e-9) return glm::normalize(a + t * (b - a));
    const double angle = real::acos(cosine), sine = real::sin(angle);
    return (real::sin((1.0 - t) * angle) / sine) * a + (real::sin(t * angle) / sine) * b;
}

/// Reads a sampler; a second is `fps` frames. Throws InputError and nlohmann's exceptions.
GltfCurve gltf_curve(GltfFile& file, const nlohmann::json& sampler, int components, double fps) {
    GltfCurve curve;
    curve.components = components;
    const std::string between = sampler.value("interpolation", "LINEAR");
    constexpr std::string_view ways[] = {"LINEAR", "STEP", "CUBICSPLINE"};  // by Between
    const auto* const way = std::ranges::find(ways, between);
    if (way == std::end(ways)) file.fail("LINEAR, STEP or CUBICSPLINE", "'" + printable(between) + "'");
    curve.between = static_cast<GltfCurve::Between>(way - ways);
    curve.fps = fps;
    for (const float seconds : file.numbers(sampler.at("input"), 1))
        curve.frames.push_back(frame_of(double(seconds), fps));
    curve.values = file.numbers(sampler.at("output"), components);
    const std::size_t each = curve.between == GltfCurve::Between::cubic ? 3 : 1;
    if (curve.values.size() != curve.frames.size() * each * std::size_t(components))
        file.fail(fmt::format("{} values for {} times", curve.frames.size() * each, curve.frames.size()),
                  std::to_string(curve.values.size() / std::size_t(components)));
    if (std::adjacent_find(curve.frames.begin(), curve.frames.end(), std::greater_equal<>()) !=
        curve.frames.end())
        file.fail("times that ascend", "others");
    return curve;
}

/// Its first or last value before and after its times; turns have length 1.
glm::dvec4 value_of(const GltfCurve& curve, double frame) {
    const auto after = std::ranges::upper_bound(curve.frames, frame);
    const auto next = std::size_t(after - curve.frames.begin());
    const bool cubic = curve.between == GltfCurve::Between::cubic;
    // Part 0 arrives, 1 is the value, 2 leaves.
    const auto value = [&](std::size_t key, std::size_t part) {
        glm::dvec4 v(0.0);
        const std::size_t at = (cubic ? 3 * key + part : key) * std::size_t(curve.components);
        for (int c = 0; c < curve.components; ++c) v[c] = double(curve.values[at + std::size_t(c)]);
        return v;
    };
    const bool turn = curve.components == 4;
    const auto unit = [&](const glm::dvec4& v) { return turn ? glm::normalize(v) : v; };
    if (next == 0) return unit(value(0, 1));
    if (next == curve.frames.size() || curve.between == GltfCurve::Between::step)
        return unit(value(next - 1, 1));
    const double from = curve.frames[next - 1], length = curve.frames[next] - from,
                 t = (frame - from) / length;
    const glm::dvec4 a = value(next - 1, 1), b = value(next, 1);
    if (!cubic) return turn ? turned_between(unit(a), unit(b), t) : a + t * (b - a);
    const glm::dvec4 leaving = length / curve.fps * value(next - 1, 2),
                     arriving = length / curve.fps * value(next, 0);
    const double t2 = t * t, t3 = t2 * t;
    return unit((2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * leaving + (3 * t2 - 2 * t3) * b +
                (t3 - t2) * arriving);
}

// ---- nodes

constexpr std::array<std::string_view, 3> moved_paths = {"translation", "rotation", "scale"};

struct MovedNode {
    GltfNode rest;
    std::array<std::optional<GltfCurve>, 3> curves{};  // by moved_paths

    glm::dmat4 matrix_at(double frame) const {
        GltfNode node = rest;
        const auto& [translation, rotation, scale] = curves;
        if (translation) node.translation = glm::dvec3(value_of(*translation, frame));
        if (rotation) node.rotation = value_of(*rotation, frame);
        node.rotation /= glm::length(node.rotation);
        if (scale) node.scale = glm::dvec3(value_of(*scale, frame));
        return node.parent_from_node();
    }
};

/// The node of the camera and its parents, from the root down, as their numbers in the file.
std::vector<std::int64_t> way_to_camera(const GltfFile& file) {
    const Json nodes = file.json().value("nodes", Json::array());
    std::vector<std::int64_t> parent(nodes.size(), -1);
    std::int64_t camera = -1;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (camera < 0 && nodes[i].contains("camera")) camera = std::int64_t(i);
        for (const Json& child : nodes[i].value("children", Json::array())) {
            file.element("nodes", child);
            parent[child.get<std::size_t>()] = std::int64_t(i);
        }
    }
    if (camera < 0) file.fail("a node with a camera", "none");
    std::vector<std::int64_t> way;
    for (std::int64_t i = camera; i >= 0; i = parent[i]) {
        if (way.size() > nodes.size()) file.fail("nodes that are not their own children", "a circle");
        way.insert(way.begin(), i);
    }
    return way;
}

/// Gives the nodes of `way` the curves of the first animation that moves any of them.
void attach_curves(GltfFile& file, const std::vector<std::int64_t>& way, double fps,
                   std::vector<MovedNode>& nodes) {
    for (const Json& animation : file.json().value("animations", Json::array())) {
        bool moves = false;
        for (const Json& channel : animation.at("channels")) {
            const Json& target = channel.at("target");
            const auto found = std::ranges::find(way, target.value("node", std::int64_t(-1)));
            const std::string path = target.value("path", "");
            const auto* const moved = std::ranges::find(moved_paths, path);
            if (found == way.end() || moved == moved_paths.end()) continue;  // weights, or of an extension
            MovedNode& node = nodes[found - way.begin()];
            const auto sampler = channel.at("sampler").get<std::int64_t>();
            const Json& samplers = animation.at("samplers");
            if (sampler < 0 || sampler >= std::ssize(samplers))
                file.fail("a number of one of its samplers", std::to_string(sampler));
            node.curves[moved - moved_paths.begin()] =
                gltf_curve(file, samplers[sampler], path == "rotation" ? 4 : 3, fps);
            node.rest.matrix.reset();
            moves = true;
        }
        if (moves) return;
    }
}

/// First and last frame of what moves; nothing where nothing does.
std::optional<std::pair<double, double>> span_of(const std::vector<MovedNode>& nodes) {
    std::optional<std::pair<double, double>> span;
    for (const MovedNode& node : nodes)
        for (const std::optional<GltfCurve>& curve : node.curves)
            if (curve) {
                const double first = curve->frames.front(), last = curve->frames.back();
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

void add_floats(std::string& bytes, std::initializer_list<double> values) {
    for (const double value : values) {
        const auto number = float(value);
        char raw[sizeof number];
        std::memcpy(raw, &number, sizeof number);
        bytes.append(raw, sizeof number);
    }
}

}  // namespace

CameraTrack read_gltf(const fs::path& path, const FrameRate& rate) try {
    GltfFile file(path);
    const std::vector<std::int64_t> way = way_to_camera(file);
    std::vector<MovedNode> nodes;
    for (const std::int64_t i : way) nodes.push_back({node_of(file, file.element("nodes", i))});
    attach_curves(file, way, rate.output_fps, nodes);
    const auto span = span_of(nodes).value_or(std::pair(0.0, 0.0));
    const double first = std::floor(span.first), last = std::ceil(span.second);
    if (!(last - first < double(most_camera_samples)) || !(std::fabs(first) < 1e9))
        file.fail(fmt::format("at most {} frames", most_camera_samples), fmt::format("{:.4g}", last - first));
    CameraTrack track;
    track.fps = rate.output_fps;
    for (double frame = first; frame <= std::max(first, last); frame += 1.0) {
        glm::dmat4 world(1.0);
        for (const MovedNode& node : nodes) world = world * node.matrix_at(frame);
        TrackSample sample;
        sample.frame = frame;
        sample.eye = glm::dvec3(world[3]);
        if (!quaternion_from_axes(glm::dmat3(world), sample.rotation))
            file.fail("a camera with axes", fmt::format("none at frame {}", frame));
        track.samples.push_back(sample);
    }
    set_lens(file, file.element("cameras", file.element("nodes", way.back()).at("camera")), track);
    return track;
} catch (const Json::exception& error) {  // a value of another type than glTF says
    bad_input(path, "a glTF 2.0 file", printable(error.what()));
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
    times["min"] = {float(first.frame / track.fps)};
    times["max"] = {float(track.samples.back().frame / track.fps)};
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

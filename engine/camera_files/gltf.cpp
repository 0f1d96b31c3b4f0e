#include "camera_files/formats.h"

#include <fmt/format.h>

#include <cstring>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "core/error.h"
#include "core/real.h"
#include "core/rotation.h"
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
    // glTF 2.0, appendix C.3
    if (!cubic) return turn ? quaternion_between(unit(a), unit(b), t) : a + t * (b - a);
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
        if (std::ranges::any_of(curves, [](const auto& curve) { return curve.has_value(); }))
            node.matrix.reset();
        const auto& [translation, rotation, scale] = curves;
        if (translation) node.translation = glm::dvec3(value_of(*translation, frame));
        if (rotation) node.rotation = value_of(*rotation, frame);
        node.rotation /= glm::length(node.rotation);
        if (scale) node.scale = glm::dvec3(value_of(*scale, frame));
        return node.parent_from_node();
    }
};

/// Its name for a message.
std::string called(const Json& element, const char* otherwise) {
    return shown(element.value("name", std::string(otherwise)));
}

/// The node of the camera and its parents, from the root down, as their numbers in the file: the first camera
/// whose root the scene that is shown has, else the first of all. `warnings` tell of others.
std::vector<std::int64_t> way_to_camera(const GltfFile& file, std::vector<std::string>& warnings) {
    const Json nodes = file.json().value("nodes", Json::array());
    std::vector<std::int64_t> parent(nodes.size(), -1), cameras;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].contains("camera")) cameras.push_back(std::int64_t(i));
        for (const Json& child : nodes[i].value("children", Json::array())) {
            file.element("nodes", child);
            parent[child.get<std::size_t>()] = std::int64_t(i);
        }
    }
    if (cameras.empty()) file.fail("a node with a camera", "none");
    const auto way_to = [&](std::int64_t camera) {
        std::vector<std::int64_t> way;
        for (std::int64_t i = camera; i >= 0; i = parent[i]) {
            if (way.size() > nodes.size()) file.fail("nodes that are not their own children", "a circle");
            way.push_back(i);
        }
        std::ranges::reverse(way);
        return way;
    };
    Json roots = Json::array();
    if (file.json().contains("scene"))
        roots = file.element("scenes", file.json().at("scene")).value("nodes", Json::array());
    const auto in_scene = [&](std::int64_t i) {
        return std::ranges::find(roots, Json(way_to(i).front())) != roots.end();
    };
    const auto found = std::ranges::find_if(cameras, in_scene);
    const std::int64_t camera = found == cameras.end() ? cameras.front() : *found;
    std::erase(cameras, camera);
    std::string others;
    for (std::size_t i = 0; i < std::min<std::size_t>(cameras.size(), 3); ++i)
        others += (i ? ", " : "") + called(nodes[cameras[i]], "a camera without a name");
    if (!cameras.empty())
        warnings.push_back(fmt::format("{}: of {} cameras {} is read, not {}{}", file.path().string(),
                                       cameras.size() + 1, called(nodes[camera], "the first"), others,
                                       cameras.size() > 3 ? ", ..." : ""));
    return way_to(camera);
}

/// What animations may move, by its JSON pointer, and where its curve goes.
using CurvePlaces = std::map<std::string, std::optional<GltfCurve>*>;

/// What a channel moves, as animations of the core and of KHR_animation_pointer say it.
std::string pointer_of(const Json& target) {
    const std::string path = target.value("path", "");
    if (path != "pointer") return fmt::format("/nodes/{}/{}", target.value("node", std::int64_t(-1)), path);
    return target.value("/extensions/KHR_animation_pointer/pointer"_json_pointer, "");
}

int components_of(const std::string& pointer) {
    if (pointer.starts_with("/cameras/")) return 1;
    return pointer.ends_with("/rotation") ? 4 : 3;
}

/// The curves of all animations; those that move again what one before moves are left out and told.
void attach_curves(GltfFile& file, double fps, const CurvePlaces& places,
                   std::vector<std::string>& warnings) {
    for (const Json& animation : file.json().value("animations", Json::array())) {
        std::vector<std::pair<const Json*, CurvePlaces::const_iterator>> moved;
        for (const Json& channel : animation.at("channels"))
            if (const auto place = places.find(pointer_of(channel.at("target"))); place != places.end())
                moved.emplace_back(&channel, place);
        if (std::ranges::any_of(moved, [](const auto& move) { return move.second->second->has_value(); })) {
            warnings.push_back(fmt::format("{}: animation {} moves what one before it moves and is left out",
                                           file.path().string(), called(animation, "without a name")));
            continue;
        }
        for (const auto& [channel, place] : moved) {
            const auto sampler = channel->at("sampler").get<std::int64_t>();
            const Json& samplers = animation.at("samplers");
            if (sampler < 0 || sampler >= std::ssize(samplers))
                file.fail("a number of one of its samplers", std::to_string(sampler));
            *place->second = gltf_curve(file, samplers[sampler], components_of(place->first), fps);
        }
    }
}

/// First and last frame of what moves; of frame 0 where nothing does.
std::pair<double, double> span_of(const CurvePlaces& places) {
    std::optional<std::pair<double, double>> span;
    for (const auto& [pointer, curve] : places)
        if (*curve) {
            const double first = (*curve)->frames.front(), last = (*curve)->frames.back();
            span = span ? std::pair(std::min(span->first, first), std::max(span->second, last))
                        : std::pair(first, last);
        }
    return span.value_or(std::pair(0.0, 0.0));
}

void set_lens(const GltfFile& file, const Json& camera, const std::optional<GltfCurve>& curve,
              CameraTrack& track) {
    const bool flat = track.orthographic();
    const double still =
        camera.at(flat ? "orthographic" : "perspective").at(flat ? "ymag" : "yfov").get<double>();
    track.has_fov = !flat;
    for (TrackSample& sample : track.samples) {
        const double value = curve ? value_of(*curve, sample.frame).x : still;
        if (!(value > 0.0 && (flat || value < real::pi)))
            file.fail(flat ? "a ymag above 0" : "a yfov between 0 and pi", fmt::format("{:.4g}", value));
        (flat ? sample.height : sample.fov_deg) = flat ? 2.0 * value : real::degrees(value);
    }
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
    // Besides what is followed, those of meshes and their surfaces.
    file.require_only({"KHR_animation_pointer", "KHR_materials_", "KHR_texture_", "EXT_texture_",
                       "KHR_lights_punctual", "KHR_mesh_quantization", "KHR_draco_mesh_compression",
                       "KHR_gaussian_"});
    CameraTrack track;
    const std::vector<std::int64_t> way = way_to_camera(file, track.warnings);
    const Json& camera_number = file.element("nodes", way.back()).at("camera");
    const Json& camera = file.element("cameras", camera_number);
    if (camera.value("type", "") == "orthographic") track.projection = Projection::orthographic;
    std::vector<MovedNode> nodes;
    for (const std::int64_t i : way) nodes.push_back({node_of(file, file.element("nodes", i))});
    std::optional<GltfCurve> lens;
    CurvePlaces places;
    for (std::size_t i = 0; i < way.size(); ++i)
        for (std::size_t k = 0; k < moved_paths.size(); ++k)
            places[fmt::format("/nodes/{}/{}", way[i], moved_paths[k])] = &nodes[i].curves[k];
    places[fmt::format("/cameras/{}/{}", camera_number.get<std::int64_t>(),
                       track.orthographic() ? "orthographic/ymag" : "perspective/yfov")] = &lens;
    attach_curves(file, rate.output_fps, places, track.warnings);
    const auto span = span_of(places);
    const double first = std::floor(span.first), last = std::ceil(span.second);
    if (!(last - first < double(most_camera_samples)) || !(std::fabs(first) < 1e9))
        file.fail(fmt::format("at most {} frames", most_camera_samples), fmt::format("{:.4g}", last - first));
    track.fps = rate.output_fps;
    for (double frame = first; frame <= std::max(first, last); frame += 1.0) {
        glm::dmat4 world(1.0);
        for (const MovedNode& node : nodes) world = world * node.matrix_at(frame);
        TrackSample sample;
        sample.frame = frame;
        sample.eye = glm::dvec3(world[3]);
        if (!set_axes(glm::dmat3(world), path.string(), sample, track))
            file.fail("a camera with axes", fmt::format("none at frame {}", frame));
        track.samples.push_back(sample);
    }
    set_lens(file, camera, lens, track);
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
    const Json lens = track.orthographic()
                          ? Json{{"xmag", 0.5 * first.height * aspect},
                                 {"ymag", 0.5 * first.height},
                                 {"znear", near},
                                 {"zfar", far > 0.0 ? far : 1e9}}
                          : Json{{"yfov", real::radians(track.has_fov ? first.fov_deg : 45.0)},
                                 {"aspectRatio", aspect},
                                 {"znear", near}};
    const char* kind = track.orthographic() ? "orthographic" : "perspective";
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

#include "splat_files/formats.h"

#include <fmt/format.h>

#include <glm/mat4x4.hpp>

#include "core/text.h"
#include "gltf/gltf_file.h"
#include "splat_files/gaussian_rows.h"
#include "splats/harmonics.h"

namespace astrosplat {
namespace {

using Json = nlohmann::json;

const std::string extension(gltf_gaussians);

/// Some Gaussians and where their node puts them.
struct Part {
    Json attributes;
    bool display = true;
    int degree = 0;
    std::int64_t count = 0;
    glm::dmat4 world{1.0};
};

std::string harmonic_name(int degree, int number) {
    return fmt::format("{}:SH_DEGREE_{}_COEF_{}", extension, degree, number);
}

int degree_of(const GltfFile& file, const Json& attributes) {
    int degree = 0;
    for (int l = 1; l <= 3; ++l) {
        int found = 0;
        for (int n = 0; n < 2 * l + 1; ++n) found += attributes.contains(harmonic_name(l, n));
        if (found == 0) continue;
        if (found < 2 * l + 1 || degree < l - 1)
            file.fail(fmt::format("all coefficients up to degree {}", l), "some of them");
        degree = l;
    }
    return degree;
}

void add_parts_of_mesh(const GltfFile& file, const Json& mesh, const glm::dmat4& world,
                       std::vector<Part>& parts) {
    for (const Json& primitive : mesh.value("primitives", Json::array())) {
        const Json extensions = primitive.value("extensions", Json::object());
        if (!extensions.contains(extension)) continue;
        const Json& own = extensions.at(extension);
        if (own.contains("extensions") && !own.at("extensions").empty())
            file.fail("Gaussians that are not compressed", printable(own.at("extensions").begin().key()));
        const auto kernel = own.value("kernel", "ellipse"),
                   space = own.value("colorSpace", "srgb_rec709_display");
        if (kernel != "ellipse") file.fail("the kernel ellipse", "'" + printable(kernel) + "'");
        if (space != "srgb_rec709_display" && space != "lin_rec709_display")
            file.fail("the colorSpace srgb_rec709_display or lin_rec709_display",
                      "'" + printable(space) + "'");
        Part part;
        part.attributes = primitive.value("attributes", Json::object());
        part.display = space.starts_with("srgb");
        part.degree = degree_of(file, part.attributes);
        const Json& accessor = file.element("accessors", part.attributes.value("POSITION", Json()));
        part.count = accessor.value("count", std::int64_t{0});
        part.world = world;
        parts.push_back(part);
    }
}

/// Nodes are visited from the scene's roots down; each once, as glTF wants trees.
void add_parts(const GltfFile& file, const Json& index, const glm::dmat4& parent, int depth,
               std::vector<bool>& seen, std::vector<Part>& parts) {
    constexpr int deepest = 256;
    const Json& node = file.element("nodes", index);
    const auto i = index.get<std::size_t>();
    if (seen[i]) file.fail("nodes that are trees", fmt::format("node {} twice", i));
    if (depth > deepest) file.fail(fmt::format("at most {} nodes one below the other", deepest), "more");
    seen[i] = true;
    const glm::dmat4 world = parent * node_of(file, node).parent_from_node();
    if (node.contains("mesh")) add_parts_of_mesh(file, file.element("meshes", node.at("mesh")), world, parts);
    for (const Json& child : node.value("children", Json::array()))
        add_parts(file, child, world, depth + 1, seen, parts);
}

std::vector<Json> roots_of(const GltfFile& file) {
    const Json& json = file.json();
    if (json.contains("scenes")) {
        const Json& scene = file.element("scenes", json.value("scene", Json(0)));
        return scene.value("nodes", Json::array()).get<std::vector<Json>>();
    }
    const std::size_t count = json.value("nodes", Json::array()).size();
    std::vector<bool> is_child(count, false);
    for (std::size_t i = 0; i < count; ++i)
        for (const Json& child : json.at("nodes")[i].value("children", Json::array())) {
            file.element("nodes", child);
            is_child[child.get<std::size_t>()] = true;
        }
    std::vector<Json> roots;
    for (std::size_t i = 0; i < count; ++i)
        if (!is_child[i]) roots.emplace_back(i);
    return roots;
}

std::vector<Part> parts_of(const GltfFile& file) {
    file.require_only({extension, "KHR_mesh_quantization"});
    std::vector<Part> parts;
    std::vector<bool> seen(file.json().value("nodes", Json::array()).size(), false);
    for (const Json& root : roots_of(file)) add_parts(file, root, glm::dmat4(1.0), 0, seen, parts);
    if (parts.empty()) file.fail("Gaussians (" + extension + ") in a node of its scene", "none");
    for (const Part& part : parts)
        if (part.display != parts[0].display) file.fail("Gaussians of one colorSpace", "two");
    return parts;
}

/// The numbers of an attribute, as many as the part has Gaussians.
std::vector<float> column_of(GltfFile& file, const Part& part, const std::string& name, int components) {
    if (!part.attributes.contains(name)) file.fail("an attribute " + name, "none");
    const Json& index = part.attributes.at(name);
    const Json& accessor = file.element("accessors", index);
    const std::string type = components == 1 ? "SCALAR" : fmt::format("VEC{}", components);
    if (accessor.value("type", "") != type)
        file.fail(name + " as " + type, "'" + printable(accessor.value("type", "")) + "'");
    if (accessor.value("count", std::int64_t{0}) != part.count)
        file.fail(fmt::format("{} of {}", part.count, name),
                  std::to_string(accessor.value("count", std::int64_t{0})));
    return file.numbers(index, components);
}

void read_part(GltfFile& file, const Part& part, std::size_t first, SplatSet& set) {
    const std::optional<GaussianPlacement> placement = gaussian_placement(part.world);
    if (!placement) file.fail("nodes that scale Gaussians alike along all axes", "others");
    const auto count = std::size_t(part.count);
    {
        const std::vector<float> position = column_of(file, part, "POSITION", 3),
                                 scale = column_of(file, part, extension + ":SCALE", 3),
                                 rotation = column_of(file, part, extension + ":ROTATION", 4),
                                 opacity = column_of(file, part, extension + ":OPACITY", 1);
        for (std::size_t i = 0; i < count; ++i) {
            set.position[first + i] = {position[3 * i], position[3 * i + 1], position[3 * i + 2]};
            set.scale[first + i] = {scale[3 * i], scale[3 * i + 1], scale[3 * i + 2]};
            set.rotation[first + i] = {rotation[4 * i], rotation[4 * i + 1], rotation[4 * i + 2],
                                       rotation[4 * i + 3]};
            set.alpha[first + i] = opacity[i];
        }
    }
    for (int l = 0; l <= part.degree; ++l)
        for (int n = 0; n < 2 * l + 1; ++n) {
            const std::vector<float> values = column_of(file, part, harmonic_name(l, n), 3);
            for (std::size_t i = 0; i < count; ++i) {
                const glm::vec3 c(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
                (set.harmonics.empty() ? set.color[first + i] : set.harmonics[first + i].c[l * l + n]) = c;
            }
        }
    place_gaussians(set, first, first + count, *placement);
}

// What the file's asset says of it, where that is text.
std::string text_at(const GltfFile& file, const char* pointer) {
    const Json found = file.json().value(Json::json_pointer(pointer), Json());
    return found.is_string() ? found.get<std::string>() : std::string();
}

SplatSet read_parts(GltfFile& file, const Progress& progress) {
    const std::vector<Part> parts = parts_of(file);
    for (const Part& part : parts)
        column_of(file, part, "POSITION", 3);  // its count is of numbers that are there
    SplatSet set = read_gaussian_parts(
        parts, {.trained = false, .display = parts[0].display}, file.path(), progress,
        [&](const Part& part, std::size_t first, SplatSet& out) { read_part(file, part, first, out); });
    set.credit = text_at(file, "/asset/copyright");
    set.origin = text_at(file, "/asset/extras/origin");
    return set;
}

/// The result of `read` for the file; wrong types in its JSON are reported in our words.
template <class Read>
auto read_json(const fs::path& path, const Read& read) {
    GltfFile file(path);
    try {
        return read(file);
    } catch (const Json::exception& error) {
        file.fail("glTF as its specification says", printable(error.what()));
    }
}

}  // namespace

SplatSet read_gltf_splats(const fs::path& file, const Progress& progress) {
    return read_json(file, [&](GltfFile& gltf) { return read_parts(gltf, progress); });
}

SplatColumns gltf_splat_columns(const fs::path& file) {
    return read_json(file,
                     [](GltfFile& gltf) { return gaussian_set_columns(is_directional(parts_of(gltf))); });
}

}  // namespace astrosplat

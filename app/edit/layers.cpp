// Layers are found by their place, tracks by the layer's name in their key. New scenes of pictures go
// through engine/scene/new_scene.h; meshes and splats get a short text of their own.
#include "edit/layers.h"

#include <fmt/format.h>

#include <sstream>

#include "camera/framing.h"
#include "core/error.h"
#include "core/file.h"
#include "edit/edits.h"
#include "scene/animate.h"
#include "scene/check.h"
#include "scene/load.h"
#include "scene/new_scene.h"
#include "scene/parameter.h"
#include "scene/save.h"
#include "sets/load_source.h"
#include "source/mesh.h"
#include "source/picture.h"
#include "splat_files/splat_file.h"
#include "splats/splat_set.h"
#include "stars/catalogue.h"

namespace astrosplat {
namespace {

bool belongs_to(const Track& track, const std::string& layer) { return track.key.layer() == layer; }

fs::path place_of(const Scene& scene) {
    return scene.file.empty() ? fs::absolute("untitled.toml") : scene.file;
}

/// Those of a scene's text, under names that are free; gives the place of the first.
std::size_t add_layers(Scene& scene, const std::string& text, const fs::path& place) {
    const std::size_t first = scene.layers.size();
    std::vector<LayerParams> layers = parse_scene(text, place).layers;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::string name = free_layer_name(scene, layers[i].name);
        for (std::size_t k = i + 1; k < layers.size(); ++k)
            if (layers[k].source.stars.like == layers[i].name) layers[k].source.stars.like = name;
        layers[i].name = name;
        scene.layers.push_back(std::move(layers[i]));
    }
    return first;
}

void rekey(Track& track, const std::string& from, const std::string& to) {
    track.key = track.key.moved(layer_key(from), layer_key(to));
}

}  // namespace

const LayerParams* find_layer(const Scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.layers, name, &LayerParams::name);
    return found == scene.layers.end() ? nullptr : &*found;
}

std::string free_layer_name(const Scene& scene, const std::string& wanted) {
    const std::string name = layer_name_of(wanted);
    if (!find_layer(scene, name)) return name;
    for (int number = 2;; ++number) {
        const std::string numbered = fmt::format("{}_{}", name, number);
        if (!find_layer(scene, numbered)) return numbered;
    }
}

std::size_t add_layer(Scene& scene, const fs::path& file) {
    const fs::path place = place_of(scene);
    return add_layers(scene, scene_text_for(file, place), place);
}

std::size_t add_shape(Scene& scene, const std::string& shape) {
    return add_layers(scene, shape_scene_text(shape), place_of(scene));
}

std::size_t duplicate_layer(Scene& scene, std::size_t index) {
    LayerParams copy = scene.layers.at(index);
    const std::string original = copy.name;
    copy.name = free_layer_name(scene, original);
    std::vector<Track> tracks;
    for (const Track& track : scene.animation) {
        if (!belongs_to(track, original)) continue;
        tracks.push_back(track);
        rekey(tracks.back(), original, copy.name);
    }
    scene.animation.insert(scene.animation.end(), tracks.begin(), tracks.end());
    scene.layers.insert(scene.layers.begin() + static_cast<std::ptrdiff_t>(index) + 1, std::move(copy));
    return index + 1;
}

void remove_layer(Scene& scene, std::size_t index) {
    const std::string name = scene.layers.at(index).name;
    std::erase_if(scene.animation, [&](const Track& track) { return belongs_to(track, name); });
    scene.layers.erase(scene.layers.begin() + static_cast<std::ptrdiff_t>(index));
}

void move_layer(Scene& scene, std::size_t from, std::size_t to) {
    LayerParams moved = scene.layers.at(from);
    scene.layers.erase(scene.layers.begin() + static_cast<std::ptrdiff_t>(from));
    to = std::min(to, scene.layers.size());
    scene.layers.insert(scene.layers.begin() + static_cast<std::ptrdiff_t>(to), std::move(moved));
}

void rename_layer(Scene& scene, std::size_t index, const std::string& name) {
    LayerParams& layer = scene.layers.at(index);
    if (layer.name == name) return;
    check_layer_name(name, layer.name);
    if (find_layer(scene, name))
        throw InputError(
            fmt::format("{}: layer.name: expected each name once, found '{}' twice", layer.name, name));
    for (Track& track : scene.animation)
        if (belongs_to(track, layer.name)) rekey(track, layer.name, name);
    for (LayerParams& other : scene.layers)
        if (other.source.stars.like == layer.name) other.source.stars.like = name;
    layer.name = name;
}

namespace {

// First lines, which tell copied text from any other.
constexpr std::array copied_heads{"# A layer of astrosplat", "# A look of astrosplat",
                                  "# A camera of astrosplat"};
const fs::path copied_place = "/copied.toml";  // so that paths are written from the root

/// What of a layer its look is.
bool is_of_look(const ParameterKey& key, const std::string& layer) {
    return key.is_below(layer_key(layer) / "look") || key.is_below(layer_key(layer) / "render");
}

bool is_copied(const Track& track, CopiedKind kind, const std::string& layer) {
    if (kind == CopiedKind::camera) return track.key.is_below("camera");
    return kind == CopiedKind::layer ? belongs_to(track, layer) : is_of_look(track.key, layer);
}

}  // namespace

std::string copied_text(const Scene& scene, CopiedKind kind, std::size_t layer) {
    Scene alone;
    std::string name;
    if (kind == CopiedKind::camera) {
        alone.camera = scene.camera;
    } else {
        alone.layers = {scene.layers.at(layer)};
        name = alone.layers[0].name;
    }
    if (kind == CopiedKind::look) {
        LayerParams bare;
        bare.name = name;
        bare.look = alone.layers[0].look;
        bare.render = alone.layers[0].render;
        alone.layers[0] = bare;
    }
    for (const Track& track : scene.animation)
        if (is_copied(track, kind, name)) alone.animation.push_back(track);
    return std::string(copied_heads[std::size_t(kind)]) + "\n" + save_text(alone, "", copied_place);
}

std::optional<CopiedKind> copied_kind(std::string_view text) {
    for (std::size_t i = 0; i < copied_heads.size(); ++i)
        if (text.starts_with(copied_heads[i])) return CopiedKind(i);
    return std::nullopt;
}

std::size_t paste_text(Scene& scene, const std::string& text, std::size_t layer) {
    const std::optional<CopiedKind> kind = copied_kind(text);
    if (!kind)
        throw InputError("Paste: expected a layer, look or camera that was copied, found another text");
    const Scene copied = parse_unchecked(text, copied_place);
    const std::string from = copied.layers.empty() ? "" : copied.layers[0].name;
    if (*kind != CopiedKind::camera && from.empty())
        throw InputError("Paste: expected a layer in the copied text, found none");
    if (*kind == CopiedKind::look && layer >= scene.layers.size())
        throw InputError("Paste: expected a layer that takes the look, found none");
    std::string to = from;
    if (*kind == CopiedKind::layer) {
        LayerParams pasted = copied.layers.at(0);
        to = pasted.name = free_layer_name(scene, from);
        layer = scene.layers.empty() ? 0 : std::min(layer, scene.layers.size() - 1) + 1;
        scene.layers.insert(scene.layers.begin() + std::ptrdiff_t(layer), std::move(pasted));
    } else if (*kind == CopiedKind::look) {
        LayerParams& target = scene.layers.at(layer);
        to = target.name;
        target.look = copied.layers.at(0).look;
        target.render = copied.layers[0].render;
    } else {
        scene.camera = copied.camera;
    }
    std::erase_if(scene.animation, [&](const Track& track) { return is_copied(track, *kind, to); });
    for (Track track : copied.animation) {
        if (*kind != CopiedKind::camera) rekey(track, from, to);
        scene.animation.push_back(std::move(track));
    }
    return layer;
}

bool is_visible(const Scene& scene, std::size_t index, double frame) {
    return scene_at(scene, frame).layers.at(index).visible;
}

void apply_preset(LayerParams& layer, const fs::path& preset) {
    const fs::path file = fs::absolute(preset);
    const std::string text =
        fmt::format("astrosplat = 1\n[[layer]]\nname = \"preset\"\npreset = {}\n", to_toml(file.string()));
    const LayerParams loaded = parse_unchecked(text, file).layers.at(0);
    layer.look = loaded.look;
    layer.render = loaded.render;
}

namespace {

/// Tables of a preset, and none of a scene.
bool is_look(const fs::path& file) {
    std::istringstream text(read_beginning(file, std::size_t{1} << 20));
    bool found = false;
    for (std::string line; std::getline(text, line);) {
        line.erase(std::remove_if(line.begin(), line.end(), [](char c) { return c == ' ' || c == '\t'; }),
                   line.end());
        const auto begins = [&](const char* with) { return line.rfind(with, 0) == 0; };
        if (begins("astrosplat=") || begins("[[layer") || begins("layer=")) return false;
        found = found || begins("[look") || begins("[render");
    }
    return found;
}

/// The file as seen from the scene's folder, absolute where it lies elsewhere.
std::string path_from(const fs::path& file, const fs::path& place) {
    const fs::path full = fs::absolute(file).lexically_normal();
    const fs::path relative = full.lexically_relative(fs::absolute(place).lexically_normal().parent_path());
    const bool below = !relative.empty() && *relative.begin() != "..";
    return to_toml((below ? relative : full).string());
}

/// The beginning of every scene, up to the comment of its camera.
std::string head_text(const std::string& name, const char* what) {
    return fmt::format(R"(# {}: {}. 'astrosplat parameters' lists every key.
astrosplat = 1

[output]
resolution = [1920, 1080]         # px
frames     = "1"                  # such as "1-240" or "1-100,120,200-300x2"
path       = {}  # the ending chooses the format: .exr .tif .png

[camera] )",
                       name, what, to_toml("frames/" + name + ".####.exr"));
}

std::string scene_text(const std::string& name, const std::string& layer) {
    return head_text(name, "a first scene") +
           "                         # without a position it frames everything, from 35 degrees above\n"
           "fov = 40.0                        # degrees, vertical\n" +
           layer;
}

std::string scene_text(const fs::path& file, const std::string& layer) {
    const std::string name = layer_name_of(file.stem().string());
    return scene_text(name, fmt::format("\n[[layer]]\nname = \"{}\"\n{}", name, layer));
}

bool has_own_pictures(const Mesh& mesh) {
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Mesh::Triangle& face) {
        return face.material < mesh.maps.size() && !mesh.maps[face.material].empty();
    });
}

/// "disk.png" beside "disk.obj", else the only picture of the folder; empty when there is none.
fs::path picture_beside(const fs::path& mesh) {
    std::vector<fs::path> pictures;
    for (const fs::path& entry : entries_of(fs::absolute(mesh).parent_path()))
        if (kind_of_file(entry) == FileKind::picture) pictures.push_back(entry);
    for (const fs::path& picture : pictures)
        if (picture.stem() == mesh.stem()) return picture;
    return pictures.size() == 1 ? pictures[0] : fs::path();
}

/// Where the mesh has no texture coordinates, its picture is seen along the thinnest side of its box.
std::string projection_lines(const Mesh& mesh) {
    const bool complete = std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                                      [](const Mesh::Triangle& face) { return face.uv[0] != Mesh::no_uv; });
    if (complete) return "";
    const glm::dvec3 side = bounds(mesh).extent();
    const char* why = "  # the mesh has no texture coordinates";
    if (side.y <= side.x && side.y <= side.z) return fmt::format("uv     = \"planar-xz\"{}\n", why);
    return fmt::format("uv     = \"{}\"{}\n", side.z <= side.x ? "planar-xy" : "planar-yz", why);
}

std::string mesh_scene_text(const fs::path& file, const fs::path& place) {
    const Mesh mesh = load_obj(file);
    fs::path picture;
    if (!has_own_pictures(mesh)) picture = picture_beside(file);
    return scene_text(
        file, fmt::format("\n[layer.source]\nmeshes = [ {{ mesh = {}, texture = {} }} ]\n{}",
                          path_from(file, place), picture.empty() ? "\"\"" : path_from(picture, place),
                          projection_lines(mesh)));
}

/// Half the mean distance of neighbours, were they spread evenly through the box: in space, or where that
/// is thinner than the distance, over its area or along its length.
double typical_radius(const SplatSet& set) {
    const glm::dvec3 extent = glm::max(bounds(set).extent(), glm::dvec3(0.0));
    std::array<double, 3> side{extent.x, extent.y, extent.z};
    std::sort(side.begin(), side.end(), std::greater<>());
    const double n = static_cast<double>(std::max<std::int64_t>(1, set.size()));
    double spacing = std::cbrt(side[0] * side[1] * side[2] / n);
    if (spacing >= side[2]) spacing = std::sqrt(side[0] * side[1] / n);
    if (spacing >= side[1]) spacing = side[0] / n;
    return spacing > 0.0 ? 0.5 * spacing : 1.0;
}

/// Where the middle nine tenths of the splats lie, axis by axis: captures have some far outside.
Bounds middle_box(const SplatSet& set) {
    constexpr std::int64_t sampled = 100000;
    const std::int64_t count = std::min(sampled, set.size());
    Bounds box;
    if (count == 0) return box;
    glm::dvec3 lo, hi;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<float> values;
        for (std::int64_t i = 0; i < count; ++i)
            values.push_back(set.position[sampled_row(set.size(), count, i)][axis]);
        std::sort(values.begin(), values.end());
        const std::size_t outside = values.size() / 20;
        lo[axis] = values[outside];
        hi[axis] = values[values.size() - 1 - outside];
    }
    box.add(lo);
    box.add(hi);
    return box;
}

/// The camera that frames this box as one without a position would frame the whole scene.
std::string camera_lines(const Bounds& box) {
    const auto [eye, middle, height] = frame_box(box, 40.0, 16.0 / 9.0);
    return fmt::format("position = [{:.4g}, {:.4g}, {:.4g}]\ntarget = [{:.4g}, {:.4g}, {:.4g}]\n", eye.x,
                       eye.y, eye.z, middle.x, middle.y, middle.z);
}

/// Captures are mixed as they were trained.
std::string capture_scene_text(const fs::path& file, const std::string& source) {
    const SplatSet set = read_splats(file);
    warn_of_no_splats(set, file.string());
    std::string layer = source +
                        "\n[layer.transform]\nrotate = [0.0, 0.0, 0.0]  # captures often have y down: "
                        "[0.0, 0.0, 180.0] turns them\n\n[layer.render]\nisolate = true\n";
    if (set.display_harmonics)
        layer += "space = \"display\"  # mixed as a display shows it, as in training\n";
    std::string text = scene_text(file, layer);
    const Bounds box = middle_box(set);
    const std::string fov = "fov = 40.0";
    if (!box.empty()) text.insert(text.find(fov), camera_lines(box));
    return text;
}

std::string splat_scene_text(const fs::path& file, const fs::path& place) {
    const std::string source =
        fmt::format("\n[layer.source]\nkind = \"splats\"\nfile = {}\n", path_from(file, place));
    const std::vector<std::string> attributes = splat_attributes(file);
    const auto has = [&](const char* name) {
        return std::find(attributes.begin(), attributes.end(), name) != attributes.end();
    };
    if (has("scale")) return capture_scene_text(file, source);
    if (has("radius")) return scene_text(file, source);
    const std::string radius = fmt::format("{:.3g}", typical_radius(read_splats(file)));
    return scene_text(
        file,
        source + fmt::format("\n[layer.look]\nradius = {{ min = {0}, max = {0} }}  # the file has none\n",
                             radius));
}

constexpr const char* sky_format =
    R"(                         # at the origin, where the stars are as bright as the catalogue says
position = [0, 0, 0]
target   = [0, 0, -10]            # declination 0, right ascension 90 degrees
fov      = 60.0                   # degrees, vertical

[scene]
light_years_per_unit = 3.261564   # a unit is a parsec

[[layer]]
name = "{name}"

[layer.source]
kind       = "stars"
catalogue  = {catalogue}
unit       = 1.0                  # scene units per parsec
limit      = 12.0                 # fainter stars are left out
zero_point = 2.0                  # magnitude of a star whose light is that of one white pixel
psf        = 0.8                  # px, standard deviation of their images
)";

std::string sky_scene_text(const fs::path& file, const fs::path& place) {
    const std::string name = layer_name_of(file.stem().string());
    return head_text(name, "the stars of a catalogue") +
           fmt::format(sky_format, fmt::arg("name", name), fmt::arg("catalogue", path_from(file, place)));
}

PictureScene scene_of_picture(const fs::path& file) {
    require_picture(file);
    Identification found;
    return picture_scene(file, {}, found);
}

/// Stars of a picture come with it: prepare writes both into one folder.
std::string catalogue_scene_text(const fs::path& file, CatalogueKind kind, const fs::path& place) {
    if (kind == CatalogueKind::sky) return sky_scene_text(file, place);
    const fs::path picture = file.parent_path() / "picture.exr";
    std::error_code ignored;
    if (!fs::is_regular_file(picture, ignored))
        bad_input(file.string(), "", "picture.exr beside the stars of a picture", "none");
    PictureScene scene = scene_of_picture(picture);
    take_stars(scene, file);
    return picture_scene_text(scene, place);
}

}  // namespace

FileKind kind_of_file(const fs::path& file) {
    const FileFormat* const format = format_of_file(file);
    const FileKind kind = kind_of(format);
    if (kind == FileKind::splats && !may_hold_splats(file)) return FileKind::unknown;
    return kind == FileKind::scene && is_look(file) ? FileKind::look : kind;
}

bool lacks_picture(const LayerParams& layer) {
    const SourceParams& source = layer.source;
    if (source.kind != SourceKind::mesh || source.meshes.empty() || !source.meshes[0].texture.empty())
        return false;
    const fs::path& mesh = source.meshes[0].mesh;
    return is_builtin_mesh(mesh) || !has_own_pictures(load_obj(mesh));
}

std::string empty_scene_text() { return scene_text(std::string("scene"), ""); }

std::string shape_scene_text(const std::string& shape) {
    return scene_text(
        shape, fmt::format("\n[[layer]]\nname = \"{0}\"\n\n[layer.source]\nmeshes = [ {{ mesh = \"{0}\" }} ]"
                           "  # texture = \"picture.jpg\" colours it\ncount = 500000\n",
                           shape));
}

std::string scene_text_for(const fs::path& file, const fs::path& place) {
    require_readable(file);
    const FileKind kind = kind_of_file(file);
    switch (kind == FileKind::picture && is_fits_catalogue(file) ? FileKind::unknown : kind) {
        case FileKind::picture:
            return picture_scene_text(scene_of_picture(file), place);
        case FileKind::mesh:
            return mesh_scene_text(file, place);
        case FileKind::splats:
            return splat_scene_text(file, place);
        case FileKind::look:
            bad_input(file.string(), "", "a scene with at least one [[layer]]",
                      "a look, which File > Apply look gives to a layer");
        default:
            if (const CatalogueKind stars = kind_of_catalogue(file); stars != CatalogueKind::none)
                return catalogue_scene_text(file, stars, place);
            bad_input(file.string(), "",
                      fmt::format("a picture ({}), a mesh ({}), splats ({}) or a star catalogue",
                                  names_of(FileKind::picture), names_of(FileKind::mesh),
                                  names_of(FileKind::splats)),
                      "another kind of file");
    }
}

}  // namespace astrosplat

// Texts of first scenes, written to be read and edited: every key a person is likely to touch, each with its
// one line.
#include "scene/new_scene.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <system_error>

#include "bodies/bodies.h"
#include "bodies/galaxy_fit.h"
#include "bodies/picture_light.h"
#include "bodies/picture_splats.h"
#include "bodies/stars.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/text.h"
#include "objects/impression.h"
#include "prepare/star_removal.h"
#include "render/frame.h"
#include "scene/parameter.h"
#include "scene/parameter_key.h"
#include "source/stored_picture.h"
#include "source/texture.h"
#include "stars/catalogue.h"

namespace astrosplat {
namespace {

const std::vector<std::string> shapes{"plane", "relief", "disk", "sphere"};

constexpr const char* scene_format =
    R"(# {title}: a picture as a volume of soft splats. 'astrosplat parameters' lists every key.
astrosplat = 1

[output]
resolution = [1920, 1080]         # px
frames     = "1"                  # such as "1-240" or "1-100,120,200-300x2"
path       = {path}  # the ending chooses the format: .exr .tif .png
exposure   = 0.0                  # stops; acts in .png and .tif, exr holds scene light

[camera]                          # without a position it frames everything, from 35 degrees above
fov = 40.0                        # degrees, vertical
{scale}
[[layer]]
name = {name}

[layer.source]
meshes       = [ {{ mesh = {shape}, texture = {picture}{relief} }} ]
count        = 5000000            # about how many splats are made; more are finer and take longer
max_distance = 0.08               # how far splats lie from the surface, on either side; the picture is 10 wide
stretch      = "auto"             # from data values to display values: asinh for FITS; or linear, asinh, log
black        = "auto"             # data value shown as black
white        = "auto"             # data value shown as white

[layer.look]
density  = 1.0                                   # share of the splats that is kept
pdf      = {{ shape = "constant" }}                # how the number of splats falls with their distance: constant, linear, gaussian
noise    = {{ frequency = 1.0, cull = 0.0, silhouette = 0.0, jitter = {jitter} }}  # cull thins out, silhouette frays the edge, jitter lifts and sinks
alpha    = {{ power = 1.0, threshold = 0.95 }}     # opacity at soft edges: above 1 they fade, below 1 they fill
vertical = {{ shape = "linear" }}                  # how their opacity falls with it: none, linear, exponential
grade    = {{ gain = 1.0, tint = [1.0, 1.0, 1.0], saturation = 1.0, gamma = 1.0 }}

[layer.render]
falloff = "gaussian"              # profile of a splat: {falloffs}
blend   = "over"                  # over hides what lies behind; add, screen, lighten glow; hybrid: over face-on, screen edge-on
opacity = 1.0                     # of the whole layer

# A camera move: give keyframes and set output.frames to "1-240".
# [animation]
# "camera.position" = {{ keys = [[1, [0, 12, 12]], [240, [0, 2, 6]]], interpolation = "smooth" }}
)";

constexpr double longest_side = 10.0;  // scene units, of the built-in plane

// How long a scene unit is, where the picture's pixels have a length; 0: none.
std::string scale_text(double light_years_per_px, double width_px, double height_px) {
    if (light_years_per_px == 0.0) return "";
    return fmt::format(
        "\n[scene]\nlight_years_per_unit = {:.6g}   # the picture is {} wide, by its scale on the sky\n",
        light_years_per_px * std::max(width_px, height_px) / longest_side,
        light_years_text(light_years_per_px * width_px));
}

/// The path of a picture as a scene in `file` writes it.
std::string picture_path(const fs::path& image, const fs::path& file) {
    const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
    const fs::path picture = fs::absolute(image).lexically_normal();
    const fs::path relative = picture.lexically_relative(folder);
    return relative.empty() ? picture.string() : relative.string();
}

}  // namespace

std::string scale_text_of(const fs::path& image) {
    const ImageRows rows = open_stored(image, {}, {}).rows;
    const auto width = double(rows.width), height = double(rows.height);
    return scale_text(light_years_per_px(said_of(clues_of(image)), width, height).value_or(0.0), width,
                      height);
}

std::string new_scene_text(const fs::path& image, const std::string& shape, const fs::path& file,
                           const std::string& scale) {
    if (std::ranges::find(shapes, shape) == shapes.end())
        throw InputError(fmt::format("--shape: expected plane, relief, disk or sphere, found '{}'{}", shape,
                                     did_you_mean(shape, shapes)));
    const std::string name = layer_name_of(image.stem().string(), "picture");
    return fmt::format(scene_format, fmt::arg("title", name), fmt::arg("name", to_toml(name)),
                       fmt::arg("path", to_toml("frames/" + name + ".####.exr")), fmt::arg("scale", scale),
                       fmt::arg("shape", to_toml(shape)),
                       fmt::arg("picture", to_toml(picture_path(image, file))),
                       fmt::arg("relief", shape == "relief" ? ", relief = 0.15" : ""),
                       // Jitter moves along one axis: depth for a flat picture, a smear on a sphere's sides.
                       fmt::arg("jitter", shape == "sphere" ? "0.0" : "0.1"),
                       fmt::arg("falloffs", fmt::join(names_of(Falloff::Shape{}), ", ")));
}

std::string layer_name_of(const std::string& text, const char* otherwise) {
    std::string name;
    for (const char c : text) {
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        const bool later = (c >= '0' && c <= '9') || c == '_';
        if (letter || (later && !name.empty())) name += c;
        if (!letter && !later && !name.empty() && name.back() != '_') name += '_';
    }
    while (!name.empty() && name.back() == '_') name.pop_back();
    return name.empty() ? otherwise : name;
}

namespace {

constexpr std::int64_t longest_px = 1920;
constexpr double field_of_view = 40.0;  // degrees
// Of what is as deep as it is wide: from near by its front would be large and its back small.
constexpr double field_of_view_of_deep = 12.0;
constexpr double deep_from_deg = 35.0;  // inclination
constexpr double points_within = 0.8;   // of the distance to the picture's camera: no star is as near to it
constexpr double wall_depth = 0.26;     // whole depth of a shell, of the picture's width

constexpr const char* text_format =
    R"(# {title}: a picture as bodies in depth. 'astrosplat parameters' lists every key.
astrosplat = 1

[output]
resolution = [{width}, {height}]         # px, as wide and high as the picture
frames     = {frames}
fps        = 24
path       = {path}  # the ending chooses the format: .exr .tif .png
exposure   = 0.0                  # stops; acts in .png and .tif, exr holds scene light

[camera]                          # that of the picture, see uv_camera below
position = [0, {distance}, 0]
target   = [0, 0, 0]
up       = [0, 0, -1]
fov      = {fov}                   # degrees, vertical
{scale}
[[layer]]
name = {name}

[layer.source]
meshes    = [ {{ mesh = "plane", texture = {picture} }} ]  # 10 units along its longer side
uv        = "camera"              # depth goes along the rays to this camera, so that from there one sees the picture:
uv_camera = {{ position = [0, {distance}, 0], up = [0, 0, -1], fov = {fov} }}
structure = {{ kind = {kind}, {galaxies}clumps = {clumps}, {extent}, {opacity}, {edges}{stars} }}  # {because}
stretch   = "auto"                # from data values to display values: asinh for FITS; or linear, asinh, log
black     = "auto"                # data value shown as black
white     = "auto"                # data value shown as white
{prepare}
[layer.look]
density  = 1.0                    # share of the splats that is kept
grade    = {{ gain = 1.0, tint = [1.0, 1.0, 1.0], saturation = 1.0, gamma = 1.0 }}

[layer.render]
opacity = 1.0                     # of the whole layer
lod     = {{ max_px = {split}, star_distance = {points} }}  # splats that look larger, close by, are divided; nearer stars stay points
)";

constexpr const char* stars_format = R"(
[[layer]]                         # the stars that were taken out of the picture
name = {name}

[layer.source]
kind      = "stars"
catalogue = {table}
like      = {picture}  # the layer whose picture they are of: they lie in its depth, and look from its camera as there
depth     = "layer"               # as deep as that layer; "magnitude": the brighter the nearer
slab      = 0.0                   # scene units within which they lie instead
psf       = {psf}                  # px, standard deviation of their images
)";

struct CameraKeyframe {
    int frame;
    glm::dvec3 position, target, up;
    double exposure = 0.0;  // stops
};

// From where the picture is seen as it is, the camera tilts by 45 degrees and comes a little nearer. Eight
// frames are between two keyframes.
void tilt(double distance, double exposure, std::vector<CameraKeyframe>& keyframes) {
    constexpr int first = 36, last = 100, step = 8;
    for (int frame = first; frame <= last; frame += step) {
        const double t = double(frame - first) / (last - first), eased = real::smoothstep(t);
        const double angle = real::radians(45.0 * eased);
        keyframes.push_back(
            {frame,
             (1.0 - 0.12 * eased) * distance * glm::dvec3(0.06 * eased, real::cos(angle), real::sin(angle)),
             glm::dvec3(0.0),
             {0.0, eased, -1.0 + 0.5 * eased},
             eased * exposure});
    }
}

// The close pass of a flight, seen from what it passes by, and what comes after it.
struct CloseViews {
    glm::dvec3 close, leaving;
    glm::dvec3 away;
    double darker;  // stops, at the most
};

// Over a disk low along its plane, over a cloud higher, and around a shell, which is thick. A cloud goes on
// to its picture's edges: the flight ends so near that they stay out of sight. The more oblique the view of a
// disk or a shell, the more of it shines in each pixel: the exposure goes down with the camera, or it would
// burn out. A shell that is mostly dark would not.
CloseViews close_views(double distance, StructureKind kind, double mean_light) {
    constexpr double dark = 0.06, bright = 0.2;  // mean light of pictures
    if (kind == StructureKind::disk)
        return {{1.0, 1.0, 2.7}, {-1.2, 0.5, 0.55 * distance}, {-2.4, 0.35, 0.9 * distance}, -1.0};
    if (kind == StructureKind::walls)
        return {{1.4, 2.3, 3.1},
                {-1.2, 2.2, 0.6 * distance},
                {-2.4, 0.3 * distance, 0.9 * distance},
                -0.6 * std::clamp((mean_light - dark) / (bright - dark), 0.0, 1.0)};
    return {{0.9, 1.9, 2.2},
            {-1.6, 0.3 * distance, 0.34 * distance},
            {-0.8, 0.62 * distance, 0.44 * distance},
            0.0};
}

// Ten seconds at 24 frames/s: the front, a slow tilt, a pass close by the subject, and on: to the edge of a
// disk, else up and away.
std::vector<CameraKeyframe> flight(double distance, const PictureScene& scene, const glm::dvec3& subject) {
    const CloseViews views = close_views(distance, scene.structure, scene.mean_light);
    const glm::dvec3 middle(0.0), above(0.0, 1.0, 0.0);
    std::vector<CameraKeyframe> keyframes;
    tilt(distance, 0.4 * views.darker, keyframes);
    keyframes.insert(keyframes.begin(), keyframes.front());
    keyframes.front().frame = 1;
    keyframes.push_back({160, subject + views.close, subject, above, 1.1 * views.darker});
    keyframes.push_back({205, 0.5 * subject + views.leaving, 0.5 * subject, above, 0.9 * views.darker});
    keyframes.push_back({240, views.away, middle, above, 0.5 * views.darker});
    return keyframes;
}

bool is_tilted(const GalaxyParams& galaxy) { return galaxy.inclination.value_or(0.0) >= deep_from_deg; }

bool is_deep(const PictureScene& scene) {
    return scene.axis || std::ranges::any_of(scene.galaxies, is_tilted);
}

glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& about, double angle) {  // Rodrigues' formula
    const double c = real::cos(angle), s = real::sin(angle);
    return c * v + s * glm::cross(about, v) + (1.0 - c) * glm::dot(about, v) * about;
}

// An axis that a film goes about.
struct OwnAxis {
    double from_front;  // radians
    double angle;       // radians in the picture, of where it leans away from
    glm::dvec3 center;  // scene units
    double away;        // times as far as the picture's camera
    double stops_above, stops_aside;
};

// Of a nebula, or of the first galaxy. From above and from its edge less of an inclined one shines in each
// pixel than in its picture, which the exposure makes up for (INCLINED 6).
OwnAxis own_axis(const PictureScene& scene, double height) {
    const double width = height * double(scene.width_px) / double(scene.height_px);
    if (scene.axis) {
        constexpr double reach_share = 0.77;  // that shines
        const AxisFit& fit = *scene.axis;
        return {real::radians(90.0 - fit.tilt_deg),
                fit.angle + real::pi,
                glm::dvec3(fit.x * width - 0.5 * width, 0.0, fit.y * width - 0.5 * height),
                std::clamp(2.0 * reach_share * fit.reach * width / height, 0.8, 1.6),
                0.0,
                0.0};
    }
    constexpr double away = 0.78, stops_above = 0.9, stops_at_edge = 0.3;
    const auto tilted = std::ranges::find_if(scene.galaxies, is_tilted);
    const GalaxyParams& galaxy = tilted == scene.galaxies.end() ? scene.galaxies.front() : *tilted;
    const double i = real::radians(*galaxy.inclination), dim = real::sin(i);
    return {i,
            real::radians(*galaxy.near_side),
            glm::dvec3((galaxy.center->x - 0.5) * width, 0.0, (0.5 - galaxy.center->y) * height),
            away,
            dim * stops_above,
            dim * stops_at_edge};
}

// Ten seconds at 24 frames/s about an own axis: the front, a turn until one looks along the axis, and down to
// its side while the camera goes round.
std::vector<CameraKeyframe> orbit(double distance, const OwnAxis& own) {
    constexpr int first = 30, above = 120, last = 230, step = 10;
    constexpr double lowest_deg = 86.0, round_deg = 70.0;
    const auto& [i, near, center, farther, stops_above, stops_aside] = own;
    const glm::dvec3 front(0.0, 1.0, 0.0), up_in_picture(0.0, 0.0, -1.0);
    const glm::dvec3 axis = glm::cross(front, glm::dvec3(real::cos(near), 0.0, -real::sin(near)));
    const glm::dvec3 normal = turned(front, axis, -i);
    std::vector<CameraKeyframe> keyframes;
    for (int frame = first; frame <= last; frame += step) {
        const double over = real::smoothstep(std::min(1.0, double(frame - first) / (above - first)));
        const double down = real::smoothstep(std::max(0.0, double(frame - above) / (last - above)));
        const glm::dvec3 away = turned(front, axis, -over * i), up = turned(up_in_picture, axis, -over * i);
        const auto lowered = [&](const glm::dvec3& v) {
            const glm::dvec3 low = turned(v, glm::cross(up, away), real::radians(down * lowest_deg));
            return turned(low, normal, real::radians(down * round_deg));
        };
        keyframes.push_back({frame, over * center + std::lerp(1.0, farther, over) * distance * lowered(away),
                             over * center, lowered(up),
                             (1.0 - down) * over * stops_above + down * stops_aside});
    }
    keyframes.insert(keyframes.begin(), keyframes.front());
    keyframes.front().frame = 1;
    return keyframes;
}

// In scene units on the plane, no nearer to the picture's edges than a fifth of its sides.
glm::dvec3 subject_in_scene(const PictureScene& scene, double height) {
    const double width = height * double(scene.width_px) / double(scene.height_px);
    const glm::dvec2 from_middle = glm::clamp(scene.subject - 0.5, glm::dvec2(-0.3), glm::dvec2(0.3));
    return {from_middle.x * width, 0.0, from_middle.y * height};
}

std::string text_of(double value) { return fmt::format("{:.3g}", value + 0.0); }  // 0, not -0

std::string text_of(const glm::dvec3& v) {
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x + 0.0, v.y + 0.0, v.z + 0.0);
}

// Leaves out keyframes that are like both of their neighbours.
template <class Value>
std::string track_text(const char* key, const std::vector<CameraKeyframe>& keyframes,
                       Value CameraKeyframe::*value) {
    std::string text;
    for (std::size_t i = 0; i < keyframes.size(); ++i) {
        const Value& here = keyframes[i].*value;
        const bool inside = i > 0 && i + 1 < keyframes.size();
        if (inside && here == keyframes[i - 1].*value && here == keyframes[i + 1].*value) continue;
        text += fmt::format("{}    [{}, {}]", text.empty() ? "" : ",\n", keyframes[i].frame, text_of(here));
    }
    return fmt::format("\"{}\" = {{ interpolation = \"smooth\", keys = [\n{}\n] }}\n", key, text);
}

std::string animation_text(const std::vector<CameraKeyframe>& keyframes) {
    const bool exposed =
        std::any_of(keyframes.begin(), keyframes.end(), [](const auto& k) { return k.exposure != 0.0; });
    return "\n[animation]                       # [frame, value]\n" +
           track_text("camera.position", keyframes, &CameraKeyframe::position) +
           track_text("camera.target", keyframes, &CameraKeyframe::target) +
           track_text("camera.up", keyframes, &CameraKeyframe::up) +
           (exposed ? track_text("output.exposure", keyframes, &CameraKeyframe::exposure) : "");
}

// Even, as films want it.
std::int64_t side_px(std::int64_t side, std::int64_t longest) {
    return std::max<std::int64_t>(2, 2 * std::llround(double(longest_px * side) / (2.0 * double(longest))));
}

// Sigma of the widest splats, of the picture's longest side.
double widest_sigma(StructureKind structure, std::int64_t longest) {
    if (structure == StructureKind::disk) return widest_in_galaxy_px / double(longest);
    if (structure == StructureKind::axis) return widest_about_axis / double(longest_px);
    const double in_sheet = widest_sigma_share * sheet_thickness;
    return structure == StructureKind::walls ? std::max(in_sheet, widest_glow_share * 0.5 * wall_depth)
                                             : in_sheet;
}

// Pixels at 1080 lines that the widest splats have from the front, and a little more: there they stay whole.
double split_above_px(StructureKind structure, double longest_over_height, std::int64_t longest) {
    return 1.1 * 2.0 * double(radius_sigmas) * widest_sigma(structure, longest) * longest_over_height *
           1080.0;
}

// Low powers of brightness and a dense disk: its dim parts are then not as bright as its middle from the
// edge, and the middle does not burn out at an angle. A shell is thin: one looks through its front wall at
// the back one.
std::string_view opacity_of(StructureKind structure) {
    if (structure == StructureKind::walls) return "opacity = 0.4, density = 0.4";
    if (structure == StructureKind::axis) return "opacity = 0.4, density = 0.3";
    return structure == StructureKind::disk ? "opacity = 0.42, density = 0.8" : "opacity = 0.55";
}

std::string galaxy_text(const GalaxyParams& g) {
    return fmt::format(
        "inclination = {:.1f}, position_angle = {:.1f}, center = [{:.4f}, {:.4f}], near_side = {:.0f}{}",
        *g.inclination, *g.position_angle, g.center->x, g.center->y, *g.near_side,
        g.bulge ? fmt::format(", bulge = {:.2f}", *g.bulge) : "");
}

// Of one its keys, of several a list.
std::string galaxies_text(const PictureScene& scene) {
    if (scene.galaxies.empty()) return "";
    if (scene.galaxies.size() == 1) return galaxy_text(scene.galaxies.front()) + ", ";
    std::string list;
    for (const GalaxyParams& g : scene.galaxies)
        list += fmt::format("{}{{ {} }}", list.empty() ? "" : ", ", galaxy_text(g));
    return fmt::format("galaxies = [ {} ], ", list);
}

// How far bodies reach along the line of sight. What lies between the things of a field is a thin, flat
// sheet: folds of it would be drawn as lines across the sky.
std::string extent_of(const PictureScene& scene) {
    if (scene.structure == StructureKind::disk) return "flare = 0.25, warp = 0.01";
    if (scene.structure == StructureKind::axis && scene.axis)
        return fmt::format("axis_angle = {:.1f}, tilt = {:.0f}", real::degrees(scene.axis->angle),
                           scene.axis->tilt_deg);
    if (scene.structure == StructureKind::walls) return fmt::format("depth = {}", wall_depth);
    if (scene.object == SkyObject::thin) return "height = 0.02, depth = 0.0";
    return scene.object == SkyObject::field ? "height = 0.05, depth = 0.01" : "depth = 0.15";
}

// Of a body of revolution; what is none becomes walls.
void find_axis(const Image& light, PictureScene& scene) {
    constexpr double area_px = 640.0 * 400.0;  // more than the fit looks at, and enough to find stars
    Image small = at_area(light, area_px, 1.0);
    StructureParams params;
    params.kind = StructureKind::axis;
    if (scene.stars.empty()) take_picture_stars(small, params);
    AxisFit fit = fit_axis(small);
    scene.lies_by = symmetry_words(fit);
    if (!is_about_axis(fit)) {
        scene.structure = StructureKind::walls;
        log_info(std::exchange(scene.lies_by, "") + ", too little: it becomes walls");
        return;
    }
    if (!fit.tilt_is_sure())
        scene.lies_by += fmt::format("; how it is tilted is a guess: {:.0f} to {:.0f} degrees look alike",
                                     fit.tilt_from_deg, fit.tilt_to_deg);
    scene.axis = std::move(fit);
}

// The table that `prepare` writes beside a picture that it took stars from. Another table of that name says
// nothing about this picture.
void find_stars(PictureScene& scene, const Progress& progress) {
    const fs::path table = scene.image.parent_path() / "stars.csv";
    if (read_beginning(table, star_table_mark.size()) == star_table_mark)
        take_stars(scene, table, progress);
    else if (std::error_code ignored; fs::is_regular_file(table, ignored))
        log_info(fmt::format("{}: not a table of prepare's, and left alone", printable(table.string())));
}

std::string stars_text(const PictureScene& scene, const std::string& picture, double frame_px_per_px,
                       const fs::path& file) {
    constexpr double least_px = 0.6;
    return fmt::format(
        stars_format, fmt::arg("name", picture == "stars" ? "\"more_stars\"" : "\"stars\""),
        fmt::arg("table", to_toml(picture_path(scene.stars, file))), fmt::arg("picture", to_toml(picture)),
        fmt::arg("psf", fmt::format("{:.2f}", std::max(least_px, scene.star_px * frame_px_per_px))));
}

// Of the picture's width: room for a galaxy to end round, and for a cloud to fray. An object alone on a
// dark sky needs it where but an arm leaves the picture, or that would be cut off straight. One of many
// pixels fades within its own edges: a margin would need too much memory.
double margin_of(const PictureScene& scene) {
    constexpr std::int64_t most_px = std::int64_t{24} << 20;
    constexpr double lit = 0.1;
    if (scene.structure == StructureKind::axis) return 0.0;  // what is mirrored does not turn about its axis
    if (scene.lit_rim <= lit || scene.width_px * scene.height_px > most_px) return 0.0;
    if (scene.structure != StructureKind::disk) return 0.16;  // a cloud does not grow dim outward
    return is_deep(scene) ? 0.2 : 0.08;  // seen from above, an inclined one was cut off nearer to its middle
}

GalaxyParams as_params(const GalaxyPlane& plane, double height_over_width) {
    const double axis_deg = real::degrees(plane.angle), near_deg = axis_deg + 90.0 * plane.near_side;
    return {plane.inclination_deg, axis_deg, glm::dvec2(plane.x, 1.0 - plane.y / height_over_width),
            near_deg - 360.0 * std::floor(near_deg / 360.0), std::nullopt};
}

// How the galaxies of a picture lie, and because of what. The table's inclination is better than the light's.
void find_galaxies(const Image& light, const Identification& found, PictureScene& scene) {
    const double height_over_width = double(light.height) / double(light.width);
    const bool round = scene.object == SkyObject::elliptical || scene.object == SkyObject::cluster;
    const std::vector<GalaxyFit> fits = fit_galaxies(light, round ? Galaxies::one : Galaxies::all);
    for (const GalaxyFit& fit : fits) scene.galaxies.push_back(as_params(fit.plane, height_over_width));
    GalaxyParams& galaxy = scene.galaxies.front();
    scene.lies_by = "its light: " + words_of(fits.front());
    if (round) {
        galaxy.inclination = 90.0;
        galaxy.bulge = 1.0;
        scene.lies_by = "a spheroid: no disk, as flat in depth as it is seen";
    } else if (fits.size() > 1) {
        scene.lies_by = fmt::format("{} galaxies, by their light", fits.size());
        for (std::size_t k = 0; k < fits.size(); ++k) {
            if (!is_unsure(fits[k])) continue;
            scene.galaxies[k].inclination = 0.0;
            scene.lies_by += fmt::format("; how number {} lies is unsure: in the picture's plane", k + 1);
        }
    } else if (found.known && found.known->inclination_deg) {
        galaxy.inclination = *found.known->inclination_deg;
        scene.lies_by = fmt::format("{} in the table: {:.0f} degrees; {}", found.known->names.front(),
                                    *galaxy.inclination, scene.lies_by);
    } else if (is_unsure(fits.front())) {
        galaxy.inclination = 0.0;
        scene.lies_by = "how it lies is unsure: in the picture's plane";
    }
}

}  // namespace

void take_stars(PictureScene& scene, const fs::path& table, const Progress& progress) {
    const PictureTable stars = read_picture_table(table, progress);
    if (stars.stars.empty()) return;
    scene.stars = table;
    scene.star_px = median_sigma_px(stars);
}

PictureScene picture_scene(const fs::path& image, const PictureRequest& request, Identification& found,
                           const Progress& progress) {
    const StoppableLoops stops(progress);
    TextureSettings settings;
    settings.prepare.starless = request.starless;
    if (!request.starless.empty()) settings.prepare.stars = PrepareParams::Stars::remove;
    const Texture texture = load_texture({image}, settings, TextureSettings::Wrap::clamp, progress.silent(),
                                         {make_prepared, {}, request.most_texels});
    const bool reduced = texture.file_width > 0;
    PictureScene scene{image, reduced ? texture.file_width : texture.image.width,
                       reduced ? texture.file_height : texture.image.height};
    const Image light = picture_light(texture, 0.0).light;
    scene.starless = request.starless;
    scene.lit_rim = lit_share_of_rim(light);
    if (request.stars.empty())
        find_stars(scene, progress.silent());
    else
        take_stars(scene, request.stars, progress.silent());
    scene.mean_light = mean_light(light);
    ObjectClues clues = clues_of(request.starless.empty() ? image : request.starless);
    clues.named = request.named;
    progress.at(0.4);  // by how long it takes, about
    found = identify(clues, light, request.as);
    scene.structure = found.structure;
    progress.at(0.6);
    if (scene.structure == StructureKind::axis) find_axis(light, scene);
    scene.object = found.guesses.front().object;
    scene.subject = found.middle;
    if (scene.structure == StructureKind::disk) find_galaxies(light, found, scene);
    scene.light_years_per_px =
        light_years_per_px(found, double(scene.width_px), double(scene.height_px)).value_or(0.0);
    return scene;
}

namespace {

std::string prepare_text(const PictureScene& scene, const fs::path& file) {
    if (scene.parted) return "prepare   = { stars = \"remove\" }  # they are a layer of their own\n";
    if (scene.starless.empty()) return "";
    return fmt::format(
        "prepare   = {{ starless = {}, stars = \"remove\" }}  # without the stars that the texture shows\n",
        to_toml(picture_path(scene.starless, file)));
}

}  // namespace

std::string picture_scene_text(const PictureScene& scene, const fs::path& file) {
    const fs::path& named = scene.starless.empty() ? scene.image : scene.starless;
    const std::string name = layer_name_of(named.stem().string(), "picture");
    const std::int64_t longest = std::max(scene.width_px, scene.height_px);
    const double height = longest_side * double(scene.height_px) / double(longest);
    const double fov = is_deep(scene) ? field_of_view_of_deep : field_of_view;
    const double distance = 0.5 * height / real::tan(real::radians(0.5 * fov));
    const double margin = margin_of(scene);
    std::string text = fmt::format(
        text_format, fmt::arg("title", name), fmt::arg("name", to_toml(name)),
        fmt::arg("width", side_px(scene.width_px, longest)),
        fmt::arg("height", side_px(scene.height_px, longest)),
        fmt::arg("frames", scene.film
                               ? "\"1-240\""
                               : "\"1\"                  # such as \"1-240\" or \"1-100,120,200-300x2\""),
        fmt::arg("path", to_toml("frames/" + name + ".####.exr")),
        fmt::arg("distance", fmt::format("{:.6g}", distance)), fmt::arg("fov", fmt::format("{:.1f}", fov)),
        fmt::arg("scale",
                 scale_text(scene.light_years_per_px, double(scene.width_px), double(scene.height_px))),
        fmt::arg("picture", to_toml(picture_path(scene.image, file))),
        fmt::arg("kind", to_toml(std::string(name_of(scene.structure)))),
        fmt::arg("galaxies", galaxies_text(scene)),
        fmt::arg("because",
                 scene.lies_by.empty() ? "disk, sheet, walls, axis; columns extrudes it" : scene.lies_by),
        fmt::arg("split", std::lround(split_above_px(scene.structure, longest_side / height,
                                                     std::max(scene.width_px, scene.height_px)))),
        fmt::arg("points", fmt::format("{:.3g}", points_within * distance)),
        fmt::arg("edges", margin > 0.0 ? fmt::format("margin = {}", margin) : "border = 0.03"),
        fmt::arg("stars", scene.stars.empty() ? "" : ", stars = false"), fmt::arg("extent", extent_of(scene)),
        fmt::arg("clumps", scene.object == SkyObject::thin ? "0.0" : "1.0"),
        fmt::arg("opacity", opacity_of(scene.structure)), fmt::arg("prepare", prepare_text(scene, file)));
    if (!scene.stars.empty()) {
        const double frame_px = double(side_px(longest, longest));
        text += stars_text(scene, name, frame_px / double(longest), file);
    }
    if (!scene.film) return text;
    return text + animation_text(is_deep(scene) ? orbit(distance, own_axis(scene, height))
                                                : flight(distance, scene, subject_in_scene(scene, height)));
}

}  // namespace astrosplat

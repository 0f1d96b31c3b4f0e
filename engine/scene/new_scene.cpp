// The text is written to be read and edited: every key a person is likely to touch, each with its one line.
#include "scene/new_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "scene/suggest.h"
#include "scene/value.h"

namespace astrosplat {
namespace fs = std::filesystem;
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
falloff = "gaussian"              # profile of a splat: constant, linear, trapezoid, gaussian, exponential
blend   = "over"                  # over hides what lies behind; add, screen, lighten glow; hybrid: over face-on, screen edge-on
opacity = 1.0                     # of the whole layer

# A camera move: give keyframes and set output.frames to "1-240".
# [animation]
# "camera.position" = {{ keys = [[1, [0, 12, 12]], [240, [0, 2, 6]]], interpolation = "smooth" }}
)";

}  // namespace

std::string new_scene_text(const fs::path& image, const std::string& shape, const fs::path& file) {
    if (std::ranges::find(shapes, shape) == shapes.end())
        throw InputError(fmt::format("--shape: expected plane, relief, disk or sphere, found '{}'{}", shape,
                                     did_you_mean(shape, shapes)));
    const std::string name = layer_name_of(image.stem().string(), "picture");
    return fmt::format(scene_format, fmt::arg("title", name), fmt::arg("name", to_toml(name)),
                       fmt::arg("path", to_toml("frames/" + name + ".####.exr")),
                       fmt::arg("shape", to_toml(shape)),
                       fmt::arg("picture", to_toml(picture_path(image, file))),
                       fmt::arg("relief", shape == "relief" ? ", relief = 0.15" : ""),
                       // Jitter moves along one axis: depth for a flat picture, a smear on a sphere's sides.
                       fmt::arg("jitter", shape == "sphere" ? "0.0" : "0.1"));
}

std::string picture_path(const fs::path& image, const fs::path& file) {
    const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
    const fs::path picture = fs::absolute(image).lexically_normal();
    const fs::path relative = picture.lexically_relative(folder);
    return relative.empty() ? picture.string() : relative.string();
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

}  // namespace astrosplat

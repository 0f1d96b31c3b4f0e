// Scenes for the tests of editing.
#pragma once

#include "edit/document.h"
#include "edit/edits.h"
#include "scene/describe.h"
#include "support/bits.h"
#include "support/temp_folder.h"

namespace astrosplat::test {

inline const char* const edit_scene = R"toml(# by hand, keep this
astrosplat = 1

[output]
resolution = [640, 360]  # px
frames = "1-48"
fps = 24.0

[camera]
position = [0.0, 4.0, 10.0]
fov = 40.0  # a comment

[[layer]]
name = "dust"
[layer.source]
meshes = [ { mesh = "plane", texture = "Bilder/m 51 ä.png" } ]
[layer.look]
noise = [ { frequency = 2.0, cull = 0.5 }, { jitter = 0.1 } ]
thickness = { map = "map.png", keys = [ { scale = 0.5 }, { scale = 2.0, shape = "linear" } ] }
alpha = { power = 2.0 }  # soft

# the second layer
[[layer]]
name = "stars"
[layer.source]
kind = "splats"
file = "stars.ply"
[layer.render]
blend = "screen"
opacity = 0.5

[animation]
"layer.stars.render.core" = { keys = [[1, 1.0], [24, 0.5]], interpolation = "smooth" }
"layer.dust.look.noise.1.jitter" = { keys = [[1, 0.0], [48, 0.2]] }
)toml";

/// A galaxy's disk, in a picture of 10 x 6.25 units that its camera sees whole from 20 units before it.
inline const char* const inclined_scene = R"toml(astrosplat = 1
[output]
resolution = [1600, 1000]
[camera]
position = [0, 20, 0]
up = [0, 0, -1]
fov = 17.762
[[layer]]
name = "m77"
[layer.source]
meshes = [ { mesh = "plane" } ]
uv = "camera"
uv_camera = { position = [0, 20, 0], up = [0, 0, -1], fov = 17.762 }
structure = { kind = "disk", inclination = 60.0, position_angle = 30.0, center = [0.6, 0.4], near_side = 120 }
)toml";

/// A parameter of edit_scene that the file gives and no track moves.
inline const std::string opacity = "layer.stars.render.opacity";

/// A folder with edit_scene as "szene ä.toml".
struct SceneFolder {
    TempFolder folder;
    fs::path file = folder.file("szene ä.toml", edit_scene);

    std::string text() const { return test::bytes_of(file); }
};

inline Value value_of(const Document& document, const std::string& key) {
    Scene scene = document.scene();
    const Description description = describe(scene);
    return find_parameter(description, key)->get();
}

inline LayerParams& layer(Scene& scene, const std::string& name) {
    for (LayerParams& one : scene.layers)
        if (one.name == name) return one;
    throw std::out_of_range(name);
}

/// Of the parameter's keyframes, in their order.
inline std::vector<double> frames_of(const Scene& scene, const std::string& key) {
    std::vector<double> frames;
    if (const Track* track = find_track(scene, key))
        for (const auto& keyframe : track->keyframes) frames.push_back(keyframe.frame);
    return frames;
}

}  // namespace astrosplat::test

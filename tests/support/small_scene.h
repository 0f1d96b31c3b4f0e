// A scene that is quick to generate and to render: a sphere and a plane with a small picture, in a folder of
// its own.
#pragma once

#include "scene/scene.h"
#include "support/pixmap.h"
#include "support/temp_folder.h"

namespace astrosplat {

struct SmallScene {
    TempFolder folder;
    Scene scene;

    SmallScene() {
        folder.file("picture.ppm", picture());
        scene.output.width = 160;
        scene.output.height = 100;
        scene.camera.position = glm::dvec3(4.0, 6.0, 12.0);
        add_layer("gas", "sphere", 20000);
        add_layer("dust", "plane", 10000);
        scene.layers[1].look.grade.gain = 0.4f;
        scene.layers[1].render.blend = Blend::screen;
    }

    void add_layer(const std::string& name, const std::string& mesh, std::int64_t count) {
        LayerParams layer;
        layer.name = name;
        layer.source.meshes = {{mesh, {folder / "picture.ppm"}, 0.15}};
        layer.source.count = count;
        layer.source.max_distance = 0.3;
        scene.layers.push_back(layer);
    }

    /// Binary PPM, 64x64 px, in which no two quarters are alike.
    static std::string picture() {
        return test::pixmap(64, 64, [](int x, int y, int k) {
            return k == 0 ? 40 + 3 * x : k == 1 ? 250 - 3 * y : 60 + x + y;
        });
    }
};

}  // namespace astrosplat

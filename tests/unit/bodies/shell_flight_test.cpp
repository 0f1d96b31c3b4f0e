// Flights near the walls of a shell: no frame changes more than its neighbours do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bodies/bodies.h"
#include "camera/camera.h"
#include "render/render.h"
#include "support/painted_picture.h"

namespace astrosplat {
namespace {

constexpr int frames = 12, width = 96, height = 60;

ShadedSplats remnant_bodies() {
    const Image light = painted::remnant(320, 200);
    TexturedMesh mesh;
    mesh.mesh = builtin_mesh("plane", 1.6);
    Texture texture;
    texture.image = make_image(light.width, light.height, 4, 1.0f);
    for (std::int64_t i = 0; i < light.width * light.height; ++i)
        std::copy_n(light.pixels.data() + 3 * i, 3, texture.image.pixels.data() + 4 * i);
    mesh.textures.push_back(std::move(texture));
    StructureParams params;
    params.kind = StructureKind::walls;
    params.depth = 0.26;
    SplatSet set = make_bodies({mesh}, params, 9u, "shell");
    ShadedSplats splats;
    splats.position = std::move(set.position);
    splats.color = std::move(set.color);
    splats.alpha = std::move(set.alpha);
    splats.radius = std::move(set.radius);
    splats.id = std::move(set.id);
    return splats;
}

/// Sum of |f_t - f_(t-1)| of every frame but the first, the eye going from `from` by `step` a frame.
std::vector<double> changes(const ShadedSplats& splats, const glm::dvec3& from, const glm::dvec3& step) {
    RenderLayer layer;
    layer.name = "shell";
    layer.splats = &splats;
    layer.render.lod.max_px = 250.0f;
    layer.render.lod.noise = 0.75f;
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    RenderCache cache;
    std::vector<double> found;
    Image before;
    for (int t = 0; t < frames; ++t) {
        CameraParams params;
        params.position = from + static_cast<double>(t) * step;
        params.target = *params.position + glm::dvec3(0.2, -1.0, -0.8);
        params.fov = 40.0;
        Image now =
            render({&layer, 1}, make_camera(params, width, height, {}), nullptr, settings, {}, &cache).beauty;
        double sum = 0.0;
        for (std::size_t i = 0; t > 0 && i < now.pixels.size(); ++i)
            sum += std::fabs(static_cast<double>(now.pixels[i]) - static_cast<double>(before.pixels[i]));
        if (t > 0) found.push_back(sum);
        before = std::move(now);
    }
    return found;
}

TEST(ShellFlight, HasNeitherFlickerNorPops) {
    const ShadedSplats splats = remnant_bodies();
    for (const glm::dvec3& step : {glm::dvec3(0.01, -0.05, -0.04), glm::dvec3(0.05, 0.0, 0.0)}) {
        const std::vector<double> change = changes(splats, {0.0, 2.4, 1.9}, step);
        for (std::size_t t = 1; t + 1 < change.size(); ++t)
            EXPECT_LE(change[t], 1.05 * 0.5 * (change[t - 1] + change[t + 1])) << "frame " << t + 1;
    }
}

}  // namespace
}  // namespace astrosplat

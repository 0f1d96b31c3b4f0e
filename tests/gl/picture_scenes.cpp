#include "gl/picture_scenes.h"

#include "core/real.h"
#include "core/shared_maths.h"
#include "output/format.h"
#include "output/write.h"
#include "render/render.h"
#include "support/temp_folder.h"

namespace astrosplat::test {
namespace {

float random(std::uint32_t seed, std::uint32_t id, std::uint32_t purpose) {
    return shared::as_uniform(shared::as_hash(seed, id, 0, 1000u + purpose));
}

CameraParams params() {
    CameraParams camera;
    camera.position = glm::dvec3(0.6, 1.4, 2.2);
    camera.fov = 50.0;
    return camera;
}

}  // namespace

std::shared_ptr<const SplatSet> cloud(std::int64_t count, std::uint32_t seed) {
    auto set = std::make_shared<SplatSet>();
    for (std::uint32_t i = 0; i < std::uint32_t(count); ++i) {
        const auto r = [&](std::uint32_t purpose) { return random(seed, i, purpose); };
        set->position.push_back({2.0f * r(0) - 1.0f, 0.4f * r(1) - 0.2f, 2.0f * r(2) - 1.0f});
        set->color.push_back({0.2f + 0.8f * r(3), 0.2f + 0.6f * r(4), 0.1f + 0.9f * r(5)});
        set->alpha.push_back(0.02f + 0.9f * r(6) * r(6));
        set->distance.push_back(0.2f * r(7));
        set->id.push_back(i + (std::uint64_t{i % 3} << 32));
        set->uv.push_back({r(8), r(9)});
        set->normal.push_back({0.0f, 1.0f, 0.0f});
        set->mesh.push_back(0);
        set->radius.push_back(0.01f + 0.02f * r(10));
    }
    set->spacing = glm::dvec3(0.05);
    set->max_distance = 0.2;
    return set;
}

PreviewLayer cloud_layer(std::int64_t count, std::uint32_t seed, float radius, const LayerRender& render) {
    PreviewLayer layer;
    layer.set = cloud(count, seed);
    layer.look.radius.min = 0.5f * radius;
    layer.look.radius.max = radius;
    layer.layer.render = render;
    layer.layer.name = "cloud" + std::to_string(seed);
    layer.inputs.seed = layer.layer.seed = seed;
    return layer;
}

Camera perspective_camera(int width, int height) { return make_camera(params(), width, height, {}); }

Camera orthographic_camera(int width, int height) {
    CameraParams camera = params();
    camera.projection = Projection::orthographic;
    camera.height = 2.4;
    return make_camera(camera, width, height, {});
}

Environment small_sky(int faces) {
    const TempFolder folder;
    EnvironmentParams params;
    for (int face = 0; face < faces; ++face) {
        RenderedFrame frame;
        frame.beauty = make_image(faces == 1 ? 64 : 32, 32, 4, 1.0f);
        Buffer<float>& pixels = frame.beauty.pixels;
        for (std::uint32_t i = 0; i < pixels.size(); ++i)
            if (i % 4 != 3) pixels[i] = random(11, i / 12, std::uint32_t(face * 3) + i % 4);
        const fs::path file = folder / ("sky" + std::to_string(face) + ".exr");
        write_frame({file, {}, frame.beauty.width, frame.beauty.height}, frame, {});
        if (faces == 1)
            params.image = file;
        else
            params.cube.push_back(file);
    }
    params.gain = 0.4f;
    params.rotation = {10.0, 70.0, -20.0};
    return load_environment(params);
}

Image offline(const std::vector<PreviewLayer>& layers, const Camera& camera, const Environment* environment,
              int width, int height) {
    std::vector<ShadedSplats> shaded;
    for (const PreviewLayer& layer : layers)
        shaded.push_back(layer.layer.splats ? ShadedSplats(*layer.layer.splats)
                                            : apply_look(*layer.set, layer.look, layer.inputs));
    std::vector<RenderLayer> render_layers;
    for (std::size_t l = 0; l < layers.size(); ++l) {
        render_layers.push_back(layers[l].layer);
        render_layers.back().splats = &shaded[l];
    }
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    return render(render_layers, camera, environment, settings).beauty;
}

Likeness compare_shown(const Image& a, const Image& b) {
    std::vector<double> differences;
    double squares = 0.0, light_a = 0.0, light_b = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const bool alpha = i % 4 == 3;
        const auto shown = [&](float value) {
            return alpha ? value : apply_view(OutputParams::View::srgb, value);
        };
        const double difference = std::fabs(double(shown(a.pixels[i])) - double(shown(b.pixels[i])));
        differences.push_back(difference);
        squares += difference * difference;
        if (!alpha) light_a += double(a.pixels[i]), light_b += double(b.pixels[i]);
    }
    Likeness likeness;
    const double mean = squares / double(differences.size());
    likeness.psnr_db = mean > 0.0 ? -10.0 * real::log(mean) / real::log(10.0) : 200.0;
    const auto place = std::ptrdiff_t(double(differences.size()) * 0.999);
    std::nth_element(differences.begin(), differences.begin() + place, differences.end());
    likeness.difference_999 = differences[std::size_t(place)];
    likeness.brightness = light_b > 0.0 ? light_a / light_b : 1.0;
    return likeness;
}

}  // namespace astrosplat::test

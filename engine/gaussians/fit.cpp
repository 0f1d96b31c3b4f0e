// Our own renderer lays the encoded Gaussians over each other as their readers do, and every Gaussian's light
// is multiplied by the ratio of wanted to rendered light where its centre is seen; several times, because
// alphas that were raised hide more of what lies behind.
#include "gaussians/gaussians.h"

#include <algorithm>
#include <cmath>

#include "core/color.h"
#include "core/parallel.h"
#include "core/rotation.h"
#include "render/project.h"
#include "render/render.h"
#include "render/shared_render.h"

namespace astrosplat {
namespace {

constexpr int rounds = 8;
constexpr float reach_sigmas = 4.0f;      // where a Gaussian of 0.03 % is cut off
constexpr float least_encoded = 1.0e-3f;  // of a display's range: darker pixels say nothing
constexpr float most_step = 2.0f;         // by which light grows or shrinks in a round

bool is_round(const glm::vec3& scale) { return scale.x == scale.y && scale.y == scale.z; }

/// The Gaussians as splats of one layer; their arrays are copies.
ShadedSplats as_splats(const Gaussians& gaussians) {
    ShadedSplats splats;
    splats.position = gaussians.position;
    splats.color = gaussians.color;
    splats.alpha = gaussians.alpha;
    splats.radius.resize(gaussians.position.size());
    splats.id.resize(gaussians.position.size());
    for (std::size_t i = 0; i < splats.id.size(); ++i) {
        const glm::vec3& scale = gaussians.scale[i];
        splats.radius[i] = reach_sigmas * std::max({scale.x, scale.y, scale.z});
        splats.id[i] = i;
    }
    if (std::ranges::all_of(gaussians.scale, is_round)) return splats;
    for (std::size_t i = 0; i < splats.id.size(); ++i) {
        glm::dmat3 shape = matrix_of_quaternion(glm::dvec4(gaussians.rotation[i]));
        for (int k = 0; k < 3; ++k)
            shape[k] *= double(reach_sigmas) * double(gaussians.scale[i][k]) / double(splats.radius[i]);
        splats.stretch.push_back(glm::mat3(shape));
    }
    return splats;
}

Image encoded(const Image& linear) {
    Image display = linear;
    for (float& value : display.pixels) value = display_srgb(value);
    return display;
}

/// Factor of a Gaussian's light, per channel, for the pixel that its centre is seen in.
glm::vec3 step_at(const Image& wanted, const Image& found, std::int64_t x, std::int64_t y) {
    glm::vec3 step(1.0f);
    for (int k = 0; k < 3; ++k) {
        const float is = found.at(x, y)[k], should = wanted.at(x, y)[k];
        if (is + should > 2.0f * least_encoded)
            step[k] =
                std::clamp((should + least_encoded) / (is + least_encoded), 1.0f / most_step, most_step);
    }
    return step;
}

}  // namespace

void fit_to_view(Gaussians& gaussians, const Image& wanted, const Camera& camera,
                 const RenderSettings& settings) {
    const Image goal = encoded(wanted);
    ShadedSplats splats = as_splats(gaussians);
    RenderLayer layer;
    layer.splats = &splats;
    layer.render.falloff.sharpness = 0.5f * reach_sigmas * reach_sigmas;
    const LayerProjection projection = make_projection(layer, 0, camera, settings);
    RenderCache cache;
    for (int round = 0; round < rounds; ++round) {
        const Image found = render({&layer, 1}, camera, nullptr, settings, {}, &cache).beauty;
        parallel_each(splats.position.size(), 1 << 12, [&](std::size_t i) {
            const shared::Instance at =
                shared::instance_of(projection.lens, to_camera(projection, splats.position[i]));
            if (!(at.depth > projection.lens.near)) return;
            if (!(at.x_px >= 0.0f && at.y_px >= 0.0f && at.x_px < float(settings.width) &&
                  at.y_px < float(settings.height)))
                return;
            glm::vec3 light = splats.alpha[i] * splats.color[i];
            light *=
                step_at(goal, found, static_cast<std::int64_t>(at.x_px), static_cast<std::int64_t>(at.y_px));
            splats.alpha[i] = std::min(1.0f, std::max({splats.alpha[i], light.x, light.y, light.z}));
            splats.color[i] = glm::min(light / splats.alpha[i], glm::vec3(1.0f));
        });
    }
    gaussians.color = std::move(splats.color);
    gaussians.alpha = std::move(splats.alpha);
}

}  // namespace astrosplat

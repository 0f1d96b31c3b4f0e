#include "look/one_splat.h"

#include <algorithm>
#include <cmath>

#include "look/shared_look.h"

namespace astrosplat {
namespace {

// A map's value as the kernel and the preview read it.
glm::vec3 map_value(const Image& map, const glm::vec2& uv) {
    const int width = static_cast<int>(map.width), height = static_cast<int>(map.height);
    const float x = shared::look_texel(uv.x, width), y = shared::look_texel(1.0f - uv.y, height);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
    glm::vec3 value;
    for (int c = 0; c < 3; ++c) {
        const int from = map.channels >= 3 ? c : 0;
        value[c] = shared::look_bilinear(map.at(x0, y0)[from], map.at(x1, y0)[from], map.at(x0, y1)[from],
                                         map.at(x1, y1)[from], x - std::floor(x), y - std::floor(y));
    }
    return value;
}

}  // namespace

OneSplat look_at(const LookRun& run, const LookUniforms& uniforms, std::int64_t i) {
    const LookColumns& in = run.in;
    shared::LookInput s{};
    s.position = in.position[i];
    s.color = in.color[i];
    s.alpha = in.alpha[i];
    s.from_surface = in.distance[i];
    s.radius = uniforms.radius.own ? in.radius[i] : 0.0f;
    s.map_value = uniforms.stop_count > 1 ? map_value(*run.map, in.uv[i]) : glm::vec3(0.0f);
    s.id_low = static_cast<std::uint32_t>(in.id[i]);
    s.id_high = static_cast<std::uint32_t>(in.id[i] >> 32);
    const shared::LookOutput look = shared::look_splat(uniforms, s);
    return {look.keep, look.probability, look.color, look.alpha, look.radius};
}

}  // namespace astrosplat

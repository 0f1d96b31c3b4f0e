// std140: numbers where they come, vectors of three and four on 16 bytes, structures (so also those in
// arrays) begin and end on 16 bytes. The members follow the order of look_uniforms.glsl.
#include "gl/look_block.h"

#include <algorithm>
#include <cstring>
#include <initializer_list>

namespace astrosplat {
namespace {

using namespace shared_types;

class Std140 {
  public:
    void put(float value) { append(&value, sizeof value); }
    void put(int value) { append(&value, sizeof value); }
    void put(uint value) { append(&value, sizeof value); }
    void put(const vec3& v) {
        align();
        append(&v.x, 3 * sizeof(float));
    }
    void put(const vec4& v) {
        align();
        append(&v.x, 4 * sizeof(float));
    }
    /// Before and after a structure.
    void align() { bytes_.resize((bytes_.size() + 15) / 16 * 16); }
    std::vector<std::byte> take() {
        align();
        return std::move(bytes_);
    }

  private:
    void append(const void* value, std::size_t size) {
        const std::size_t at = bytes_.size();
        bytes_.resize(at + size);
        std::memcpy(bytes_.data() + at, value, size);
    }
    std::vector<std::byte> bytes_;
};

void put(Std140& out, const LookCurve& curve, const LookLimits& limits) {
    out.align();
    out.put(curve.count);
    for (int k = 0; k < limits.points; ++k) out.put(curve.knots[k]);
    out.align();
}

void put(Std140& out, const LookProfile& profile, const LookLimits& limits) {
    out.align();
    out.put(profile.shape);
    out.put(profile.rate);
    put(out, profile.curve, limits);
}

void put(Std140& out, const LookKey& key, const LookLimits& limits) {
    out.align();
    out.put(key.color);
    out.put(key.scale);
    out.put(key.column);
    put(out, key.pdf, limits);
}

void put(Std140& out, const LookNoise& noise) {
    out.align();
    for (float value : {noise.frequency, noise.lacunarity, noise.gain, noise.scale}) out.put(value);
    out.put(noise.octaves);
    out.put(noise.seed);
    for (float value : {noise.cull, noise.silhouette, noise.jitter, noise.alpha, noise.brightness})
        out.put(value);
    out.align();
}

/// The smallest of a few steps that is large enough.
int step_up(int value, std::initializer_list<int> steps) {
    for (int step : steps)
        if (value <= step) return step;
    return value;
}

}  // namespace

LookLimits limits_for(const LookUniforms& look) {
    bool curve = look.vertical.shape == PROFILE_CURVE;
    for (int k = 0; k < look.key_count; ++k) curve = curve || look.keys[k].pdf.shape == PROFILE_CURVE;
    int octaves = 0;
    for (int k = 0; k < look.noise_count; ++k) octaves = std::max(octaves, look.noises[k].octaves);
    return {step_up(look.key_count, {1, 3, LOOK_MAX_KEYS}),
            step_up(look.noise_count, {1, 2, LOOK_MAX_NOISES}), curve ? LOOK_MAX_POINTS : 1,
            step_up(octaves, {0, 4, 6, 16})};
}

std::vector<std::byte> look_block(const LookUniforms& look, const LookLimits& limits) {
    Std140 out;
    out.put(look.seed);
    out.put(look.axis);
    out.put(look.reach);
    out.put(look.density);
    out.put(look.key_count);
    for (int k = 0; k < limits.keys; ++k) put(out, look.keys[k], limits);
    out.put(look.noise_count);
    for (int k = 0; k < limits.noises; ++k) put(out, look.noises[k]);
    out.put(look.unpremultiply);
    for (float value : {look.alpha_threshold, look.alpha_power, look.alpha_gain}) out.put(value);
    put(out, look.vertical, limits);
    out.put(look.vertical_reach);
    out.put(look.match);
    out.put(look.own_radius);
    for (float value :
         {look.radius_min, look.radius_max, look.horizontal_scale, look.vertical_scale, look.black})
        out.put(value);
    out.put(look.tint);
    out.put(look.saturation);
    out.put(look.inverse_gamma);
    return out.take();
}

}  // namespace astrosplat

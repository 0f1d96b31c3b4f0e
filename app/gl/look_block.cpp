// std140: numbers where they come, vectors of three and four on 16 bytes, structures (so also those in
// arrays) begin and end on 16 bytes. The members follow the order of look_uniforms.glsl.
#include "gl/look_block.h"

#include <cstring>

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

void put(Std140& out, const LookCurve& curve) {
    out.align();
    out.put(curve.count);
    for (const vec4& knot : curve.knots) out.put(knot);
    out.align();
}

void put(Std140& out, const LookProfile& profile) {
    out.align();
    out.put(profile.shape);
    out.put(profile.rate);
    put(out, profile.curve);
}

void put(Std140& out, const LookKey& key) {
    out.align();
    out.put(key.color);
    out.put(key.scale);
    out.put(key.column);
    put(out, key.pdf);
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

}  // namespace

std::vector<std::byte> look_block(const LookUniforms& look) {
    Std140 out;
    out.put(look.seed);
    out.put(look.axis);
    out.put(look.reach);
    out.put(look.density);
    out.put(look.key_count);
    for (const LookKey& key : look.keys) put(out, key);
    out.put(look.noise_count);
    for (const LookNoise& noise : look.noises) put(out, noise);
    out.put(look.unpremultiply);
    for (float value : {look.alpha_threshold, look.alpha_power, look.alpha_gain}) out.put(value);
    put(out, look.vertical);
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

// shaders/shared/look.glsl over blocks of splats, one step at a time: each step is a plain loop over arrays
// that the compiler turns into vectors, once per instruction set (Highway's foreach_target includes this file
// again for each). What a look does not use is skipped for a whole block, and nothing is worked out for
// splats already dropped; the bits are those of look_splat (a test compares them). Here are steps 4 to 7 over
// the splats that are kept: alpha, radius, colour.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "look/kernel.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

#include <cstring>

#include "look/kernel.h"
#include "look/kernel_keep-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

// --- 4, 5: alpha ---

ASTROSPLAT_LOOP horizontal_power(Block& b, LookAlpha step) {
    for (int i = 0; i < b.count; ++i) b.alpha[i] = look_horizontal(b.alpha[i], step);
}

ASTROSPLAT_LOOP horizontal_gain(Block& b, LookAlpha step) {
    for (int i = 0; i < b.count; ++i) b.alpha[i] = look_gain(b.alpha[i], step);
}

ASTROSPLAT_LOOP horizontal_radius(Block& b, LookRadius step) {
    for (int i = 0; i < b.count; ++i) b.radius_factor[i] = look_horizontal_radius(b.alpha[i], step);
}

ASTROSPLAT_LOOP own_vertical_x(const Block& b, float reach, float* HWY_RESTRICT x) {
    for (int i = 0; i < b.count; ++i) x[i] = b.distance[i] / reach;
}

template <int match>
ASTROSPLAT_LOOP matched(Block& b) {
    for (int i = 0; i < b.count; ++i) {
        const float mean = look_column(match, b.column[i], b.reach[i], b.radius_factor[i]);
        b.alpha[i] = look_matched(match, b.alpha[i], b.f[i], mean);
    }
}

ASTROSPLAT_LOOP finish_alpha(const Block& b, float* HWY_RESTRICT out) {
    for (int i = 0; i < b.count; ++i) out[i] = clamp(b.alpha[i] * b.alpha_factor[i], 0.0f, 1.0f);
}

void alphas(const LookUniforms& u, Block& b, float* out) {
    if (u.alpha.power != 1.0f) {
        horizontal_power(b, u.alpha);
    } else {
        horizontal_gain(b, u.alpha);
    }
    horizontal_radius(b, u.radius);
    if (u.vertical_reach > 0.0f) {
        own_vertical_x(b, u.vertical_reach, b.sum);
        profile(u.vertical, b.sum, b.f, b.count);
    } else {
        profile(u.vertical, b.x, b.f, b.count);
    }
    if (u.match == MATCH_NONE) matched<MATCH_NONE>(b);
    if (u.match == MATCH_PLANES) matched<MATCH_PLANES>(b);
    if (u.match == MATCH_LIGHT) matched<MATCH_LIGHT>(b);
    if (u.match == MATCH_TRANSMITTANCE) matched<MATCH_TRANSMITTANCE>(b);
    if (u.match == MATCH_SCREEN) matched<MATCH_SCREEN>(b);
    fill(b.alpha_factor, 1.0f, b.count);
    for (int j = 0; j < u.noise_count; ++j)
        if (u.noises[j].alpha != 0.0f) vary(u.noises[j].alpha, b.n[j], b.alpha_factor, b.count);
    finish_alpha(b, out);
}

// Last of all, and of splats that absorb, too.
ASTROSPLAT_LOOP fade_at_crops(const Block& b, float* HWY_RESTRICT alpha) {
    for (int i = 0; i < b.count; ++i) alpha[i] = alpha[i] * b.cropped[i];
}

// --- 6: radius ---

ASTROSPLAT_LOOP uniform_radii(Block& b, LookRadius step, uint seed) {
    for (int i = 0; i < b.count; ++i)
        b.radius[i] = look_uniform_radius(step, seed, b.id_low[i], b.id_high[i]);
}

ASTROSPLAT_LOOP finish_radii(const Block& b, LookRadius step, float* HWY_RESTRICT out) {
    for (int i = 0; i < b.count; ++i)
        out[i] = b.radius[i] * b.radius_factor[i] * look_vertical_radius(b.x[i], step);
}

void radii(const LookRun& run, std::int64_t begin, Block& b, float* out) {
    const LookUniforms& u = run.uniforms;
    if (u.radius.own) {
        for (int i = 0; i < b.count; ++i) b.radius[i] = run.in.radius[begin + b.from[i]];
    } else if (u.radius.smallest == u.radius.largest) {
        fill(b.radius, u.radius.smallest, b.count);
    } else {
        uniform_radii(b, u.radius, u.seed);
    }
    finish_radii(b, u.radius, out);
}

// --- 7: colour ---

ASTROSPLAT_LOOP unpremultiply(Block& b, LookAlpha step) {
    for (int i = 0; i < b.count; ++i) {
        const float undo = look_unpremultiply(b.alpha[i], step);
        b.r[i] = b.r[i] * undo;
        b.g[i] = b.g[i] * undo;
        b.b[i] = b.b[i] * undo;
    }
}

ASTROSPLAT_LOOP levels(Block& b, LookGrade step) {
    for (int i = 0; i < b.count; ++i) {
        b.r[i] = look_levels(b.r[i] * b.color_factor[i], step) * step.tint.x;
        b.g[i] = look_levels(b.g[i] * b.color_factor[i], step) * step.tint.y;
        b.b[i] = look_levels(b.b[i] * b.color_factor[i], step) * step.tint.z;
    }
}

ASTROSPLAT_LOOP saturate_and_bend(Block& b, LookGrade step) {
    for (int i = 0; i < b.count; ++i) {
        const float luminance = look_luminance(b.r[i], b.g[i], b.b[i]);
        b.r[i] = look_finish(b.r[i], luminance, step);
        b.g[i] = look_finish(b.g[i], luminance, step);
        b.b[i] = look_finish(b.b[i], luminance, step);
    }
}

// Of alphas before step 4.
ASTROSPLAT_LOOP screened(Block& b, LookAlpha step) {
    for (int i = 0; i < b.count; ++i) {
        const float alpha = look_horizontal(b.alpha[i], step);
        b.r[i] = look_screened(alpha, b.r[i]);
        b.g[i] = look_screened(alpha, b.g[i]);
        b.b[i] = look_screened(alpha, b.b[i]);
    }
}

ASTROSPLAT_LOOP write_colors(const Block& b, glm::vec3* HWY_RESTRICT out) {
    for (int i = 0; i < b.count; ++i) {
        out[i].x = b.r[i];
        out[i].y = b.g[i];
        out[i].z = b.b[i];
    }
}

void read_colors(const glm::vec3* color, const float* alpha, Block& b) {
    for (int i = 0; i < b.count; ++i) {
        const glm::vec3 c = color[b.from[i]];
        b.r[i] = c.x;
        b.g[i] = c.y;
        b.b[i] = c.z;
        b.alpha[i] = alpha[b.from[i]];
    }
}

// Splats that absorb, kept aside before the steps that do not act on them.
struct Absorbers {
    int count = 0;
    int at[block_size];
    glm::vec3 color[block_size];
    float alpha[block_size];
};

void note_absorbers(const Block& b, Absorbers& absorbers) {
    absorbers.count = 0;
    for (int i = 0; i < b.count; ++i) {
        if (!(b.r[i] < 0.0f)) continue;
        const int n = absorbers.count++;
        absorbers.at[n] = i;
        absorbers.color[n] = {b.r[i], b.g[i], b.b[i]};
        absorbers.alpha[n] = b.alpha[i];
    }
}

void restore(const Absorbers& absorbers, glm::vec3* color, float* alpha) {
    for (int n = 0; n < absorbers.count; ++n) {
        color[absorbers.at[n]] = absorbers.color[n];
        alpha[absorbers.at[n]] = absorbers.alpha[n];
    }
}

void colors(const LookUniforms& u, Block& b, glm::vec3* out) {
    if (u.alpha.unpremultiply) unpremultiply(b, u.alpha);
    fill(b.color_factor, 1.0f, b.count);
    for (int j = 0; j < u.noise_count; ++j)
        if (u.noises[j].brightness != 0.0f) vary(u.noises[j].brightness, b.n[j], b.color_factor, b.count);
    levels(b, u.grade);
    if (look_finishes(u.grade)) saturate_and_bend(b, u.grade);
    if (u.match == MATCH_SCREEN) screened(b, u.alpha);
    write_colors(b, out);
}

// Splats [begin, begin + b.count) of the set to out[at], ...; b.count becomes the number kept.
void shade_block(const LookRun& run, std::int64_t begin, std::int64_t at, Block& b) {
    const PreparedLook& u = run.uniforms;
    const bool positions = u.noise_count > 0 || u.is_cropped(), moved = any(u, &LookNoise::jitter);
    read_ids(run.in.id + begin, b);
    std::memcpy(b.distance, run.in.distance + begin, sizeof(float) * std::size_t(b.count));
    if (positions) read_positions(run.in.position + begin, b);
    thickness(run, begin, b);
    probabilities(u, b);
    decide(b, u.density, u.seed);
    if (u.is_cropped()) crop(u, b);
    compact(u, positions, b);
    remaining_noise(u, b);
    read_colors(run.in.color + begin, run.in.alpha + begin, b);
    Absorbers absorbers;
    if (u.absorbs) note_absorbers(b, absorbers);
    ShadedSplats& out = run.out;
    if (moved) {
        jitter(u, b, out.position.data() + at);
    } else {
        for (int i = 0; i < b.count; ++i) out.position[at + i] = run.in.position[begin + b.from[i]];
    }
    colors(u, b, out.color.data() + at);  // before alphas: step 4 divides by the alpha it finds
    alphas(u, b, out.alpha.data() + at);
    if (u.absorbs) restore(absorbers, out.color.data() + at, out.alpha.data() + at);
    if (u.is_cropped()) fade_at_crops(b, out.alpha.data() + at);
    radii(run, begin, b, out.radius.data() + at);
    for (int i = 0; i < b.count; ++i) out.id[at + i] = std::uint64_t(b.id_high[i]) << 32 | b.id_low[i];
}

}  // namespace

std::int64_t shade_run_target(const LookRun& run, std::int64_t begin, std::int64_t end) {
    Block b{};
    std::int64_t at = begin;
    for (std::int64_t i = begin; i < end; i += block_size) {
        b.count = int(end - i < block_size ? end - i : block_size);
        shade_block(run, i, at, b);
        at += b.count;
    }
    return at - begin;
}

}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(shade_run_target);

LookColumns::LookColumns(const SplatSet& set)
    : position(set.position.data()),
      color(set.color.data()),
      alpha(set.alpha.data()),
      distance(set.distance.data()),
      id(set.id.data()),
      uv(set.uv.data()),
      radius(set.radius.data()) {}

std::int64_t shade_run(const LookRun& run, std::int64_t begin, std::int64_t end) {
    return HWY_DYNAMIC_DISPATCH(shade_run_target)(run, begin, end);
}

}  // namespace astrosplat
#endif

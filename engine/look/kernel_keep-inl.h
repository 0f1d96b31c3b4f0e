// A block of splats on its way through the look, what several steps use (reading, noise, profiles), and steps
// 1 to 3: how thick the layer is there, which splats are kept and where they move. Included once per
// instruction set.
#if defined(ASTROSPLAT_LOOK_KERNEL_KEEP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROSPLAT_LOOK_KERNEL_KEEP_INL_H
#undef ASTROSPLAT_LOOK_KERNEL_KEEP_INL_H
#else
#define ASTROSPLAT_LOOK_KERNEL_KEEP_INL_H
#endif

#include <hwy/highway.h>

#include "look/kernel.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

using namespace astrosplat::shared_types;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "maths.glsl"
// after maths
#include "noise.glsl"
// after noise
#include "look.glsl"
#pragma GCC diagnostic pop

// Every loop calls shared functions; flatten inlines them all, without which nothing becomes a vector.
#undef ASTROSPLAT_LOOP
#define ASTROSPLAT_LOOP HWY_FLATTEN void

constexpr int block_size = 256;
using Lane = float[block_size];

// Splats on their way through the steps: first those read, from `compact` on those kept. 40 kB.
struct Block {
    int count;
    int from[block_size];  // index within the block's part of the set
    uint id_low[block_size], id_high[block_size];
    Lane px, py, pz;  // position; read where noise is used
    Lane distance, x, reach, column;
    Lane n[LOOK_MAX_NOISES];           // noise values
    Lane weight[LOOK_MAX_STOPS], sum;  // of the thickness stops
    Lane r, g, b;                      // map value, later colour
    Lane probability, bites;
    Lane cropped;  // what the crops leave of alpha; read where there are any
    Lane seen_x, seen_y, seen_scale, distance2, inside;  // in an outline's view
    int beyond[block_size], crossed[block_size];
    Lane alpha, alpha_factor, color_factor, radius_factor, radius, f;
    int keep[block_size];
};

bool any(const LookUniforms& u, float LookNoise::*amount) {
    for (int j = 0; j < u.noise_count; ++j)
        if (u.noises[j].*amount != 0.0f) return true;
    return false;
}

ASTROSPLAT_LOOP fill(float* HWY_RESTRICT y, float value, int count) {
    for (int i = 0; i < count; ++i) y[i] = value;
}

// --- reading ---

ASTROSPLAT_LOOP read_ids(const std::uint64_t* HWY_RESTRICT id, Block& b) {
    for (int i = 0; i < b.count; ++i) {
        b.id_low[i] = uint(id[i]);
        b.id_high[i] = uint(id[i] >> 32);
    }
}

ASTROSPLAT_LOOP read_positions(const glm::vec3* HWY_RESTRICT position, Block& b) {
    for (int i = 0; i < b.count; ++i) {
        b.px[i] = position[i].x;
        b.py[i] = position[i].y;
        b.pz[i] = position[i].z;
    }
}

// One channel, or the first three; what lies beyond the third is not read.
void read_map(const Image& map, const glm::vec2* uv, Block& b) {
    const int width = int(map.width), height = int(map.height);
    const int green = map.channels >= 3 ? 1 : 0, blue = map.channels >= 3 ? 2 : 0;
    for (int i = 0; i < b.count; ++i) {
        const float x = look_texel(uv[i].x, width), y = look_texel(1.0f - uv[i].y, height);
        const int x0 = int(x), y0 = int(y);
        const int x1 = min(x0 + 1, width - 1), y1 = min(y0 + 1, height - 1);
        const float tx = x - floor(x), ty = y - floor(y);
        const float *c00 = map.at(x0, y0), *c10 = map.at(x1, y0), *c01 = map.at(x0, y1),
                    *c11 = map.at(x1, y1);
        b.r[i] = look_bilinear(c00[0], c10[0], c01[0], c11[0], tx, ty);
        b.g[i] = look_bilinear(c00[green], c10[green], c01[green], c11[green], tx, ty);
        b.b[i] = look_bilinear(c00[blue], c10[blue], c01[blue], c11[blue], tx, ty);
    }
}

// --- noise ---

ASTROSPLAT_LOOP add_octave(const float* HWY_RESTRICT x, const float* HWY_RESTRICT y,
                           const float* HWY_RESTRICT z, float* HWY_RESTRICT sum, float amplitude,
                           float frequency, uint seed, int octave, int count) {
    for (int i = 0; i < count; ++i)
        sum[i] = sum[i] + amplitude * as_noise_octave(x[i], y[i], z[i], frequency, seed, octave);
}

// as_fbm with its two loops exchanged.
void fbm(const LookNoise& noise, const float* x, const float* y, const float* z, float* sum, int count) {
    float amplitude = noise.scale, frequency = noise.frequency;
    fill(sum, 0.0f, count);
    for (int i = 0; i < noise.octaves; ++i) {
        add_octave(x, y, z, sum, amplitude, frequency, noise.seed, i, count);
        amplitude = amplitude * noise.gain;
        frequency = frequency * noise.lacunarity;
    }
}

ASTROSPLAT_LOOP positions_across(const Block& b, vec3 axis, float* HWY_RESTRICT x, float* HWY_RESTRICT y,
                                 float* HWY_RESTRICT z) {
    for (int i = 0; i < b.count; ++i) {
        const vec3 p = look_across(vec3(b.px[i], b.py[i], b.pz[i]), axis);
        x[i] = p.x;
        y[i] = p.y;
        z[i] = p.z;
    }
}

ASTROSPLAT_LOOP bite(float amount, const float* HWY_RESTRICT n, float* HWY_RESTRICT factor, int count) {
    for (int i = 0; i < count; ++i) factor[i] = factor[i] * look_bite(amount, n[i]);
}

ASTROSPLAT_LOOP vary(float amount, const float* HWY_RESTRICT n, float* HWY_RESTRICT factor, int count) {
    for (int i = 0; i < count; ++i) factor[i] = factor[i] * look_vary(amount, n[i]);
}

// --- profiles ---

template <int shape>
ASTROSPLAT_LOOP formula(float rate, const float* HWY_RESTRICT x, float* HWY_RESTRICT y, int count) {
    for (int i = 0; i < count; ++i) y[i] = look_formula(shape, rate, x[i]);
}

// look_curve with its two loops exchanged.
ASTROSPLAT_LOOP curve_piece(vec4 first, vec4 second, const float* HWY_RESTRICT x, float* HWY_RESTRICT y,
                            int count) {
    for (int i = 0; i < count; ++i) {
        const float value = look_curve_piece(first, second, x[i]);
        y[i] = x[i] >= first.x ? value : y[i];
    }
}

void curve(const LookCurve& c, const float* x, float* y, int count) {
    fill(y, c.knots[0].y, count);
    for (int k = 0; k + 1 < c.count; ++k) curve_piece(c.knots[k], c.knots[k + 1], x, y, count);
}

void profile(const LookProfile& p, const float* x, float* y, int count) {
    switch (p.shape) {
        case PROFILE_CONSTANT:
            return formula<PROFILE_CONSTANT>(p.rate, x, y, count);
        case PROFILE_LINEAR:
            return formula<PROFILE_LINEAR>(p.rate, x, y, count);
        case PROFILE_QUADRATIC:
            return formula<PROFILE_QUADRATIC>(p.rate, x, y, count);
        case PROFILE_EXPONENTIAL:
            return formula<PROFILE_EXPONENTIAL>(p.rate, x, y, count);
        case PROFILE_GAUSSIAN:
            return formula<PROFILE_GAUSSIAN>(p.rate, x, y, count);
        case PROFILE_SMOOTH:
            return formula<PROFILE_SMOOTH>(p.rate, x, y, count);
        case PROFILE_S106:
            return formula<PROFILE_S106>(p.rate, x, y, count);
        default:
            return curve(p.curve, x, y, count);
    }
}

// --- 1: thickness ---

ASTROSPLAT_LOOP weigh(Block& b, vec3 color, float* HWY_RESTRICT weight) {
    for (int i = 0; i < b.count; ++i) weight[i] = look_weight(b.r[i], b.g[i], b.b[i], color);
}

ASTROSPLAT_LOOP add(const float* HWY_RESTRICT term, float* HWY_RESTRICT sum, int count) {
    for (int i = 0; i < count; ++i) sum[i] = sum[i] + term[i];
}

ASTROSPLAT_LOOP add_scaled(float scale, const float* HWY_RESTRICT term, float* HWY_RESTRICT sum, int count) {
    for (int i = 0; i < count; ++i) sum[i] = sum[i] + term[i] * scale;
}

ASTROSPLAT_LOOP add_product(const float* HWY_RESTRICT a, const float* HWY_RESTRICT c, float* HWY_RESTRICT sum,
                            int count) {
    for (int i = 0; i < count; ++i) sum[i] = sum[i] + a[i] * c[i];
}

ASTROSPLAT_LOOP divide(float* HWY_RESTRICT y, const float* HWY_RESTRICT by, int count) {
    for (int i = 0; i < count; ++i) y[i] = y[i] / by[i];
}

void weigh_stops(const LookUniforms& u, Block& b) {
    fill(b.sum, 0.0f, b.count);
    for (int k = 0; k < u.stop_count; ++k) {
        weigh(b, u.stops[k].color, b.weight[k]);
        add(b.weight[k], b.sum, b.count);
    }
    fill(b.reach, 0.0f, b.count);
    fill(b.column, 0.0f, b.count);
    for (int k = 0; k < u.stop_count; ++k) {
        divide(b.weight[k], b.sum, b.count);
        add_scaled(u.stops[k].scale, b.weight[k], b.reach, b.count);
        add_scaled(u.stops[k].column, b.weight[k], b.column, b.count);
    }
}

ASTROSPLAT_LOOP finish_reach(float reach, const float* HWY_RESTRICT bites, Block& b) {
    for (int i = 0; i < b.count; ++i) {
        b.reach[i] = reach * b.reach[i] * bites[i];
        b.x[i] = look_x(b.distance[i], b.reach[i]);
    }
}

void thickness(const LookRun& run, std::int64_t begin, Block& b) {
    const LookUniforms& u = run.uniforms;
    if (u.stop_count > 1) {
        read_map(*run.map, run.in.uv + begin, b);
        weigh_stops(u, b);
    } else {
        fill(b.reach, u.stops[0].scale, b.count);
        fill(b.column, u.stops[0].column, b.count);
    }
    fill(b.bites, 1.0f, b.count);
    for (int j = 0; j < u.noise_count; ++j) {
        const LookNoise& noise = u.noises[j];
        if (noise.silhouette == 0.0f) continue;
        // Colour arrays are free until colours are read.
        positions_across(b, u.axis, b.r, b.g, b.b);
        fbm(noise, b.r, b.g, b.b, b.n[j], b.count);
        bite(noise.silhouette, b.n[j], b.bites, b.count);
    }
    finish_reach(u.reach, b.bites, b);
}

// --- 2: density ---

void probabilities(const LookUniforms& u, Block& b) {
    if (u.stop_count == 1) {
        profile(u.stops[0].pdf, b.x, b.probability, b.count);
    } else {
        fill(b.probability, 0.0f, b.count);
        for (int k = 0; k < u.stop_count; ++k) {
            profile(u.stops[k].pdf, b.x, b.f, b.count);
            add_product(b.weight[k], b.f, b.probability, b.count);
        }
    }
    fill(b.bites, 1.0f, b.count);
    for (int j = 0; j < u.noise_count; ++j) {
        if (u.noises[j].cull == 0.0f) continue;
        fbm(u.noises[j], b.px, b.py, b.pz, b.n[j], b.count);
        bite(u.noises[j].cull, b.n[j], b.bites, b.count);
    }
}

ASTROSPLAT_LOOP decide(Block& b, float density, uint seed) {
    for (int i = 0; i < b.count; ++i) {
        const float probability = density * b.probability[i] * b.bites[i];
        b.keep[i] = look_keep(b.x[i], probability, seed, b.id_low[i], b.id_high[i]) ? 1 : 0;
    }
}

ASTROSPLAT_LOOP crop_away(LookCrop crop, Block& b) {
    for (int i = 0; i < b.count; ++i)
        b.cropped[i] = b.cropped[i] * look_crop(crop, b.px[i], b.py[i], b.pz[i]);
}

ASTROSPLAT_LOOP see_from(LookOutline outline, Block& b) {
    for (int i = 0; i < b.count; ++i) {
        const vec3 place = look_outline_place(outline, b.px[i], b.py[i], b.pz[i]);
        b.seen_x[i] = place.x;
        b.seen_y[i] = place.y;
        b.seen_scale[i] = place.z;
        b.beyond[i] = look_beyond_outline(outline, place.x, place.y, place.z) ? 1 : 0;
        b.distance2[i] = 3.0e38f;
        b.crossed[i] = 0;
    }
}

ASTROSPLAT_LOOP measure_edge(LookEdge edge, Block& b) {
    for (int i = 0; i < b.count; ++i) {
        b.distance2[i] = min(b.distance2[i], look_edge_distance2(edge, b.seen_x[i], b.seen_y[i]));
        b.crossed[i] = b.crossed[i] + look_edge_crossed(edge, b.seen_x[i], b.seen_y[i]);
    }
}

ASTROSPLAT_LOOP join_outline(LookOutline outline, Block& b) {
    for (int i = 0; i < b.count; ++i)
        b.inside[i] = max(b.inside[i], look_inside_outline(outline, b.distance2[i], b.crossed[i],
                                                           b.seen_scale[i], b.beyond[i] != 0));
}

ASTROSPLAT_LOOP outline_away(bool outside, Block& b) {
    for (int i = 0; i < b.count; ++i)
        b.cropped[i] = b.cropped[i] * (outside ? 1.0f - b.inside[i] : b.inside[i]);
}

// Most blocks lie beyond most outlines, which then cost no edge.
void crop_by_outlines(const PreparedLook& u, Block& b) {
    bool begins = true;
    for (const LookOutline& outline : u.outlines) {
        if (begins) fill(b.inside, 0.0f, b.count);
        see_from(outline, b);
        if (std::any_of(b.beyond, b.beyond + b.count, [](int beyond) { return beyond == 0; })) {
            for (int k = 0; k < outline.edge_count; ++k) measure_edge(u.edges[outline.first_edge + k], b);
            join_outline(outline, b);
        }
        begins = outline.goes_on == 0;
        if (begins) outline_away(outline.outside != 0, b);
    }
}

void crop(const PreparedLook& u, Block& b) {
    fill(b.cropped, 1.0f, b.count);
    crop_by_outlines(u, b);
    for (int j = 0; j < u.crop_count; ++j) crop_away(u.crops[j], b);
    for (int i = 0; i < b.count; ++i) b.keep[i] = b.keep[i] && b.cropped[i] > 0.0f ? 1 : 0;
}

template <class T>
void gather(T* values, const int* from, int count) {
    for (int i = 0; i < count; ++i) values[i] = values[from[i]];  // from[i] >= i
}

// Moves the kept splats to the front of every array that is still needed.
void compact(const PreparedLook& u, bool positions, Block& b) {
    int kept = 0;
    for (int i = 0; i < b.count; ++i) {
        b.from[kept] = i;
        kept += b.keep[i];
    }
    const bool all = kept == b.count;
    b.count = kept;
    if (all) return;
    gather(b.id_low, b.from, kept);
    gather(b.id_high, b.from, kept);
    gather(b.distance, b.from, kept);
    gather(b.x, b.from, kept);
    gather(b.reach, b.from, kept);
    gather(b.column, b.from, kept);
    if (u.is_cropped()) gather(b.cropped, b.from, kept);
    if (!positions) return;
    gather(b.px, b.from, kept);
    gather(b.py, b.from, kept);
    gather(b.pz, b.from, kept);
    for (int j = 0; j < u.noise_count; ++j)
        if (u.noises[j].cull != 0.0f) gather(b.n[j], b.from, kept);
}

// Noise that the density did not need, for the splats that are left.
void remaining_noise(const LookUniforms& u, Block& b) {
    for (int j = 0; j < u.noise_count; ++j) {
        const LookNoise& noise = u.noises[j];
        const bool used = noise.jitter != 0.0f || noise.alpha != 0.0f || noise.brightness != 0.0f;
        if (used && noise.cull == 0.0f) fbm(noise, b.px, b.py, b.pz, b.n[j], b.count);
    }
}

// --- 3: jitter ---

ASTROSPLAT_LOOP move_along(const Block& b, vec3 axis, const float* HWY_RESTRICT along,
                           glm::vec3* HWY_RESTRICT out) {
    for (int i = 0; i < b.count; ++i) {
        const vec3 p = vec3(b.px[i], b.py[i], b.pz[i]) + axis * along[i];
        out[i].x = p.x;
        out[i].y = p.y;
        out[i].z = p.z;
    }
}

void jitter(const LookUniforms& u, Block& b, glm::vec3* out) {
    float* along = b.bites;
    fill(along, 0.0f, b.count);
    for (int j = 0; j < u.noise_count; ++j)
        if (u.noises[j].jitter != 0.0f) add_scaled(u.noises[j].jitter, b.n[j], along, b.count);
    move_along(b, u.axis, along, out);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#endif  // toggle

// Steps 1 to 3 of the look over a block: how thick the layer is there, which splats are kept and where they
// move. Included once per instruction set.
#if defined(ASTROSPLAT_LOOK_KERNEL_KEEP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROSPLAT_LOOK_KERNEL_KEEP_INL_H
#undef ASTROSPLAT_LOOK_KERNEL_KEEP_INL_H
#else
#define ASTROSPLAT_LOOK_KERNEL_KEEP_INL_H
#endif

#include "look/kernel_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

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

void crop(const LookUniforms& u, Block& b) {
    fill(b.cropped, 1.0f, b.count);
    for (int j = 0; j < u.crop_count; ++j) crop_away(u.crops[j], b);
    for (int i = 0; i < b.count; ++i) b.keep[i] = b.keep[i] && b.cropped[i] > 0.0f ? 1 : 0;
}

template <class T>
void gather(T* values, const int* from, int count) {
    for (int i = 0; i < count; ++i) values[i] = values[from[i]];  // from[i] >= i
}

// Moves the kept splats to the front of every array that is still needed.
void compact(const LookUniforms& u, bool positions, Block& b) {
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
    if (u.crop_count > 0) gather(b.cropped, b.from, kept);
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

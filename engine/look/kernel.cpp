// shaders/shared/look.glsl over blocks of splats, one step at a time: each step is a plain loop over arrays
// that the compiler turns into vectors, once per instruction set (Highway's foreach_target includes this file
// again for each). What a look does not use is skipped for a whole block, and nothing is worked out for
// splats already dropped; the bits are those of look_splat (a test compares them).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "look/kernel.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

#include <cstring>

#include "look/kernel.h"
#include "look/kernel_keep-inl.h"
#include "look/kernel_shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

// Splats [begin, begin + b.count) of the set to out[at], ...; b.count becomes the number kept.
void shade_block(const LookRun& run, std::int64_t begin, std::int64_t at, Block& b) {
    const LookUniforms& u = run.uniforms;
    const bool positions = u.noise_count > 0 || u.crop_count > 0, moved = any(u, &LookNoise::jitter);
    read_ids(run.in.id + begin, b);
    std::memcpy(b.distance, run.in.distance + begin, sizeof(float) * std::size_t(b.count));
    if (positions) read_positions(run.in.position + begin, b);
    thickness(run, begin, b);
    probabilities(u, b);
    decide(b, u.density, u.seed);
    if (u.crop_count > 0) crop(u, b);
    compact(u, positions, b);
    remaining_noise(u, b);
    read_colors(run.in.color + begin, run.in.alpha + begin, b);
    Absorbers absorbers;
    if (u.absorbs) note_absorbers(b, absorbers);
    ShadedSplats& out = run.out;
    if (moved) {
        jitter(u, b, out.position.data() + at);
    } else {
        for (int i = 0; i < b.count; ++i)
            out.position[std::size_t(at + i)] = run.in.position[begin + b.from[i]];
    }
    colors(u, b, out.color.data() + at);  // before alphas: step 4 divides by the alpha it finds
    alphas(u, b, out.alpha.data() + at);
    if (u.absorbs) restore(absorbers, out.color.data() + at, out.alpha.data() + at);
    if (u.crop_count > 0) fade_at_crops(b, out.alpha.data() + at);
    radii(run, begin, b, out.radius.data() + at);
    for (int i = 0; i < b.count; ++i)
        out.id[std::size_t(at + i)] = std::uint64_t(b.id_high[i]) << 32 | b.id_low[i];
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

// Level of detail, as far as it needs no tables: which levels, and the structure of their light. Needs maths.glsl, noise.glsl,
// blend.glsl and child_types.glsl.

const int CHILD_FIRST_LEVEL = 2;  // four children (level 1) would be as large as their parent
const int CHILD_ALPHA_STEPS = 32;  // of a table over alpha in [0, 1]
const int CHILD_FADE_STEPS = 16;   // over fade in [0, 1]
const int CHILD_RADIUS_STEPS = 512;
const int CHILD_RADII = CHILD_RADIUS_STEPS + 1;  // numbers of a level
const int CHILD_ALPHAS = CHILD_ALPHA_STEPS + 1;
const int CHILD_FADES = CHILD_FADE_STEPS + 1;
const float CHILD_OCTAVE_GAIN = 0.75f;           // amplitude of an octave over that of the one twice as wide
const float CHILD_UNIT_GAIN = 0.66143783f;       // sqrt(1 - gain^2): all octaves have variance 1 together
const float CHILD_NOISE_DEVIATION = 0.260521f;   // of as_noise over space
const float CHILD_FARTHEST_CELL = 1073741824.0f;  // as_noise counts cells in 32 bits
const float CHILD_LARGEST_EXPONENT = 3.5f;  // times the strength; rarer than once in 2000 children

// Level for a projected diameter, of those up to `finest`; limit_px is lod.max_px scaled to the frame's height. The
// finer level fades in over a factor 1.5 in size.
LevelChoice choose_levels(float diameter_px, float limit_px, int finest) {
    if (!(limit_px > 0.0f) || !(diameter_px > limit_px) || finest < CHILD_FIRST_LEVEL) return LevelChoice(0, 0, 0.0f);
    float threshold_px = limit_px;  // above it, level `fine`
    int fine = CHILD_FIRST_LEVEL;
    for (int k = 0; k < CHILD_FINEST_LEVEL; ++k) {
        float next_px = 2.0f * threshold_px;
        if (diameter_px > next_px && fine < finest) {
            threshold_px = next_px;
            fine = fine + 1;
        }
    }
    float over = as_div(min(diameter_px, 1.0e30f), threshold_px);
    return LevelChoice(fine == CHILD_FIRST_LEVEL ? 0 : fine - 1, fine, min(1.0f, (over - 1.0f) * 2.0f));
}

// Radius of the children over that of the parent: 2 / sqrt(N).
float child_radius_scale(int level) { return level == 0 ? 1.0f : as_div(2.0f, float(1 << level)); }

float child_lerp(float a, float b, float t) { return a + (b - a) * t; }

const float NEAR_STAR_LEAST = 0.25f;  // has brightest_near_star times the light per area
// As near_star_size() of lod.h; nearness in (0, 1].
float near_star_size(float nearness) {
    float root = sqrt(nearness);
    return max(NEAR_STAR_LEAST, root * sqrt(root));
}

// How much structure (`strength`: lod.noise) the children of a splat get: those of dust half of it. Light that screen
// saturates has no room for it, and would be lost. h: of the hybrid blend.
float child_structure(float strength, int blend, float h, float alpha, vec3 color) {
    if (blend_absorbs(blend, color.x)) return 0.5f * strength;
    if (blend != BLEND_SCREEN && blend != BLEND_HYBRID) return strength;
    float screened = blend == BLEND_SCREEN ? 1.0f : h;
    float brightest = max(max(color.x, color.y), color.z);
    return strength * (1.0f - screened * min(1.0f, alpha * brightest));
}

// ln of the mean of e^(x N) over space, N = as_noise over its deviation: by its cumulants of order 2, 4 and 6, within
// 0.002 for x <= 1.3.
float child_log_mean(float x) {
    float x2 = x * x;
    return x2 * (0.5f + x2 * (-0.019142f + x2 * 0.00179f));
}

// 2^e; beyond the normal numbers the last one.
float child_power_of_two(int e) { return intBitsToFloat((min(max(e, -126), 127) + 127) << 23); }

// Octave i, of CHILD_OCTAVES, of the noise for the children of a splat at one level; `radius` in layer space, > 0.
// Octaves have cells from the splat's diameter down to that of the children, (level - 1) octaves below, and less over
// one octave beyond either, so that a growing splat takes octaves up and drops them smoothly.
ChildOctave child_octave(float strength, float radius, int level, uint seed, int i) {
    float size = 1.44269504f * as_log(2.0f * radius), widest = floor(-1.0f - size);  // 1 / ln 2
    int octave = int(widest) + 1 + i;
    float t = float(octave) + size, last = float(level - 2);
    float share = clamp(min(t + 1.0f, last + 1.0f - t), 0.0f, 1.0f);
    if (!(share > 0.0f)) return ChildOctave(1.0f, 0.0f, vec3(0.0f, 0.0f, 0.0f), 0u, 0.0f);
    float deviation = strength * share * CHILD_UNIT_GAIN * as_exp(t * as_log(CHILD_OCTAVE_GAIN));
    vec3 shift = vec3(as_uniform(as_hash(seed, uint(octave), 0u, PURPOSE_CHILD_NOISE)),
                      as_uniform(as_hash(seed, uint(octave), 1u, PURPOSE_CHILD_NOISE)),
                      as_uniform(as_hash(seed, uint(octave), 2u, PURPOSE_CHILD_NOISE)));
    return ChildOctave(child_power_of_two(octave), as_div(deviation, CHILD_NOISE_DEVIATION), shift,
                       as_hash(seed, uint(octave), 3u, PURPOSE_CHILD_NOISE), child_log_mean(deviation));
}

// What the octave adds to the exponent of the light of a child at p in layer space.
float child_noise(ChildOctave octave, vec3 p) {
    float f = octave.frequency, far = CHILD_FARTHEST_CELL;
    float x = clamp(p.x * f + octave.shift.x, -far, far), y = clamp(p.y * f + octave.shift.y, -far, far),
          z = clamp(p.z * f + octave.shift.z, -far, far);
    return octave.amplitude * as_noise(x, y, z, octave.seed);
}

// Factor of the child's light: the octaves' sum held below what `strength` allows, less the sum of their offsets.
float child_factor(float strength, float exponent, float offset) {
    return as_exp(min(exponent, CHILD_LARGEST_EXPONENT * strength) + offset);
}

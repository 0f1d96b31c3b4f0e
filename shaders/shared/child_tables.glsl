// Level of detail, as far as it needs the tables of a falloff (LodTable of engine/render/lod.h): child_radius[level][CHILD_RADII],
// child_fading[level][CHILD_ALPHAS][CHILD_FADES] and, in double, child_steady[level][CHILD_ALPHAS]. A card has them in
// buffers; in C++ this is the inside of a struct that has them. Needs children.glsl and on_circle().

ChildAlphas child_alphas(LevelChoice choice, float a) {
    float x = clamp(a, 0.0f, 1.0f) * float(CHILD_ALPHA_STEPS), y = choice.fade * float(CHILD_FADE_STEPS);
    int i = min(int(x), CHILD_ALPHA_STEPS - 1), j = min(int(y), CHILD_FADE_STEPS - 1);
    float u = x - float(i), v = y - float(j);
    int at = choice.coarse * CHILD_ALPHAS + i, row = (choice.fine * CHILD_ALPHAS + i) * CHILD_FADES + j;
    double from = child_steady[at], rise = child_steady[at + 1] - from;
    float steady = float(from + rise * double(u)), here = child_lerp(child_fading[row], child_fading[row + 1], v);
    row = row + CHILD_FADES;
    return ChildAlphas(steady * (1.0f - choice.fade), child_lerp(here, child_lerp(child_fading[row], child_fading[row + 1], v), u));
}

// The same for add, where light is the sum of alphas: a (R / r)^2 / N with r = 2 R / sqrt(N) is a / 4 at every level.
ChildAlphas child_alphas_for_add(LevelChoice choice, float a) {
    return ChildAlphas((choice.coarse == 0 ? a : 0.25f * a) * (1.0f - choice.fade), 0.25f * a * choice.fade);
}

vec3 child_offset(int level, uint child, uint seed, uint id_low, uint id_high) {
    uint mixed = as_mix(seed + child * 0x9e3779b9u + uint(level) * 0x85ebca6bu);
    float x = as_uniform(as_hash(mixed, id_low, id_high, PURPOSE_CHILD)) * float(CHILD_RADIUS_STEPS);
    int i = int(x), at = level * CHILD_RADII + i;
    float r = child_lerp(child_radius[at], child_radius[at + 1], x - float(i));
    float z = 1.0f - 2.0f * as_uniform(as_hash(mixed, id_low, id_high, PURPOSE_CHILD + 1u));
    float ring = sqrt(max(0.0f, 1.0f - z * z));
    vec2 around = on_circle(as_uniform(as_hash(mixed, id_low, id_high, PURPOSE_CHILD + 2u)));
    return vec3(r * (ring * around.x), r * (ring * around.y), r * z);
}

// Alphas and colours of the two levels for the layer's blend. Under screen and hybrid the light of a channel depends on s
// o with its own occlusion o, so each channel is solved by itself and the colour takes up the difference: exact for
// screen, to first order for hybrid.
LevelShade channel_shade(float alpha, vec3 own, vec3 o, vec3 color) {
    if (!(alpha > 0.0f)) return LevelShade(alpha, color);
    return LevelShade(alpha, vec3(color.x * as_div(as_div(own.x, o.x), alpha), color.y * as_div(as_div(own.y, o.y), alpha),
                                  color.z * as_div(as_div(own.z, o.z), alpha)));
}

LevelShades shade_levels(int blend, float h, LevelChoice choice, float alpha, vec3 color) {
    ChildAlphas whole = child_alphas_for_add(choice, alpha);
    if (blend != BLEND_ADD) whole = child_alphas(choice, alpha);
    if (blend != BLEND_SCREEN && blend != BLEND_HYBRID)
        return LevelShades(LevelShade(whole.coarse, color), LevelShade(whole.fine, color));
    float least = 1.0e-3f;  // occlusion below which light is proportional to alpha
    vec3 o = vec3(clamp(blend_occlusion(blend, color.x, h), least, 1.0f), clamp(blend_occlusion(blend, color.y, h), least, 1.0f),
                  clamp(blend_occlusion(blend, color.z, h), least, 1.0f));
    float mean = as_div(o.x + o.y + o.z, 3.0f);
    ChildAlphas middle = child_alphas(choice, alpha * mean);
    ChildAlphas r = child_alphas(choice, alpha * o.x), g = child_alphas(choice, alpha * o.y), b = child_alphas(choice, alpha * o.z);
    return LevelShades(channel_shade(as_div(middle.coarse, mean), vec3(r.coarse, g.coarse, b.coarse), o, color),
                       channel_shade(as_div(middle.fine, mean), vec3(r.fine, g.fine, b.fine), o, color));
}

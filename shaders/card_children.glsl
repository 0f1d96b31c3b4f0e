// What card_project.glsl leaves of a layer: splats that level of detail divides, and stars that stay points close by. PASS 0:
// how many splats each becomes; 1: those, projected, splat by splat, of which some do not show. As project_rows() of
// engine/render/project.cpp. Needs card_layer.glsl and child_tables.glsl.
layout(local_size_x = 256) in;
layout(std430, binding = 5) buffer Begins { uint begin[]; };  // counts; in pass 1 where those of each splat begin
layout(std430, binding = 6) buffer Total { uint total_low, total_high; };
layout(std430, binding = 7) writeonly buffer Given { uint given[]; };  // ScreenSplat of engine/render/screen_splat.h
uniform uint count, layer, seed;
uniform uint wanted;  // splats, all of them
uniform int finest, blend, own_blend;  // blend: over for a holdout
uniform bool keeps_opaque;             // splats of alpha over .5 are not divided
uniform float noise, star_distance;

LevelChoice levels_of(uint i, vec3 place, float radius, float alpha) {
    float px_per_unit = instance_of(lens, beyond_near(lens, place)).px_per_unit;
    LevelChoice choice = choose_levels(2.0f * radius * px_per_unit, lod_limit_px, finest);
    bool whole = keeps_opaque && alpha > 0.5f;
    if (noise > 0.0f) whole = whole || is_star(i);
    if (whole) choice = LevelChoice(0, 0, 0.0f);
    return choice;
}

// A splat's levels, and how many splats the coarser one has.
struct Levels {
    LevelChoice choice;
    LevelShades shades;
    uint coarse, fine;
};
Levels shaded_levels(uint i, vec3 place, float radius) {
    float alpha = alpha_of[i], h = as_div(float(h_bits_at(place)), 65535.0f);
    vec3 color = splat_color(i);
    LevelChoice choice = levels_of(i, place, radius, alpha);
    LevelShade own = LevelShade(alpha, color), none = LevelShade(0.0f, color);
    if (choice.fine == 0) return Levels(choice, LevelShades(own, none), 1u, 0u);
    LevelShades shades = shade_levels(blend, h, choice, alpha, color);
    return Levels(choice, shades, shades.coarse.alpha > 0.0f ? 1u << (2 * choice.coarse) : 0u,
                  shades.fine.alpha > 0.0f ? 1u << (2 * choice.fine) : 0u);
}

#if PASS == 0
void main() {
    uint i = group_number() * GROUP + gl_LocalInvocationIndex, own = 0u;
    if (i < count) {
        vec3 place = camera_place(dvec3(splat_place(i)));
        float radius = radius_of[i] * radius_scale;
        if (is_left_star(i)) {
            own = 1u;
        } else if (is_large(place, radius) && !is_out_of_sight(place, instance_of(lens, place), radius)) {
            Levels levels = shaded_levels(i, place, radius);
            own = levels.coarse + levels.fine;
        }
        begin[i] = own;
    }
    if (own == 0u) return;
    uint before = atomicAdd(total_low, own);
    if (before + own < before) atomicAdd(total_high, 1u);
}
#else
// The splat that number n was made of: the last one whose own begin no later.
uint parent_of(uint n) {
    uint first = 0u, last = count - 1u;
    for (int k = 0; k < 32 && first < last; ++k) {
        uint middle = first + (last - first + 1u) / 2u;
        if (begin[middle] <= n) first = middle;
        else last = middle - 1u;
    }
    return first;
}

float light_of(uint i, vec3 place, int level, vec3 p) {
    float h = as_div(float(h_bits_at(place)), 65535.0f);
    float strength = child_structure(noise, own_blend, h, alpha_of[i], splat_color(i));
    if (!(strength > 0.0f) || level == 0) return 1.0f;
    float exponent = 0.0f, offset = 0.0f;
    for (int k = 0; k < CHILD_OCTAVES; ++k) {
        ChildOctave octave = child_octave(strength, radius_of[i], level, seed, k);
        if (octave.amplitude > 0.0f) exponent = exponent + child_noise(octave, p);
        offset = offset - octave.offset;
    }
    return child_factor(strength, exponent, offset);
}

Splat splat_of(uint i, uint n) {
    vec3 p = splat_place(i), place = camera_place(dvec3(p)), color = splat_color(i);
    float radius = radius_of[i] * radius_scale;
    if (is_left_star(i)) {
        float nearness = as_div(max(instance_of(lens, place).depth, lens.near), star_distance);
        float size = near_star_size(min(1.0f, nearness)), area = size * size;
        color = vec3(as_div(color.x, area), as_div(color.y, area), as_div(color.z, area));
        return ball_at(place, radius, alpha_of[i], color, size, i);
    }
    Levels levels = shaded_levels(i, place, radius);
    bool is_fine = n >= levels.coarse;
    int level = is_fine ? levels.choice.fine : levels.choice.coarse;
    LevelShade shade = levels.shades.coarse;
    if (is_fine) shade = levels.shades.fine;
    vec3 child_place = place;
    if (level > 0) {
        vec3 offset = child_offset(level, is_fine ? n - levels.coarse : n, seed, id_of[i].x, id_of[i].y);
        p = p + radius_of[i] * offset;
        child_place = camera_place(dvec3(p));
    }
    Splat child = ball_at(child_place, radius * child_radius_scale(level), shade.alpha, shade.color, 1.0f, i);
    if (child.shows && noise > 0.0f) {
        float light = light_of(i, place, level, p);
        child.color = vec3(shade.color.x * light, shade.color.y * light, shade.color.z * light);
    }
    return child;
}

void main() {
    uint n = group_number() * GROUP + gl_LocalInvocationIndex;
    if (n >= wanted) return;
    uint i = parent_of(n), at = 10u * n;
    Splat splat = splat_of(i, n - begin[i]);
    given[at] = floatBitsToUint(splat.x_px);
    given[at + 1u] = floatBitsToUint(splat.y_px);
    given[at + 2u] = floatBitsToUint(splat.radius_px);
    given[at + 3u] = splat.shows ? floatBitsToUint(splat.opacity) : 0u;
    given[at + 4u] = floatBitsToUint(splat.color.x);
    given[at + 5u] = floatBitsToUint(splat.color.y);
    given[at + 6u] = floatBitsToUint(splat.color.z);
    given[at + 7u] = splat.key;
    given[at + 8u] = i;
    given[at + 9u] = splat.h_bits << 16 | layer;
}
#endif

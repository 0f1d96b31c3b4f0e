// A layer's splats onto the frame, and those that touch the region into records: slab by slab of depth from near to far, in
// a slab in the order of the splats. PASS 0: between which depths a sample lies; 1: how many of it each bin of depth has; 2:
// how many splats each group of 256 leaves in each slab; 3: the records, of all slabs or of the `only` one. As
// engine/render/project_vector.cpp and fold_prepare-inl.h. Needs card_layer.glsl and footprint.glsl. ANY: records with what
// any mix of layers asks for. GIVEN: splats that card_children.glsl or the processor has projected. RANKS: places in the order
// of ties are kept.
layout(local_size_x = 256) in;
#ifdef GIVEN
layout(std430, binding = 1) readonly buffer Splats { uint given[]; };  // ScreenSplat of engine/render/screen_splat.h
layout(std430, binding = 2) readonly buffer Shapes { vec4 shapes[]; };  // of those that are not round: three each
uniform uint first_given;
uniform bool in_order;  // ties are in order already
#endif
layout(std430, binding = 5) buffer Begins { uint begin[]; };  // [slab][group of all layers]: counts, in the end begins
layout(std430, binding = 6) writeonly buffer Records { vec4 record[]; };
layout(std430, binding = 7) writeonly buffer Keys { uint key_of[]; };
layout(std430, binding = 8) writeonly buffer Order { uint record_at[]; };
layout(std430, binding = 9) writeonly buffer Rects { uvec2 rect_of[]; };
layout(std430, binding = 10) readonly buffer Moments { vec4 moments[]; };  // three a node
layout(std430, binding = 11) readonly buffer Cosines { float cosines[256]; };
layout(std430, binding = 12) writeonly buffer Tags { uvec2 tag_of[]; };  // layer and node; bits of hybrid's h
layout(std430, binding = 13) writeonly buffer Ranks { uint rank_of[]; };   // the place in (layer, splat)
uniform uint first_rank;
uniform uint count, first_group, all_groups, every, slabs, only;
const uint ALL_SLABS = 0xffffffffu;
uniform ivec2 tiles;
uniform float core, integral;  // of its footprints
uniform bool linear_in_distance, flat_core;
uniform uint layer, table;

#ifdef GIVEN
Splat splat_at(uint i) {
    uint at = 10u * (first_given + i), radius_bits = given[at + 2u];
    int shape = radius_bits > 0x80000000u ? int(radius_bits - 0x80000001u) : -1;
    float radius_px = shape < 0 ? uintBitsToFloat(radius_bits) : shapes[3 * shape + 2].w;
    vec3 color = vec3(uintBitsToFloat(given[at + 4u]), uintBitsToFloat(given[at + 5u]), uintBitsToFloat(given[at + 6u]));
    uint rank = first_rank + (in_order ? i : given[at + 8u]);
    float opacity_here = uintBitsToFloat(given[at + 3u]);  // 0: it does not show
    return Splat(opacity_here > 0.0f, given[at + 7u], uintBitsToFloat(given[at]), uintBitsToFloat(given[at + 1u]), radius_px,
                 opacity_here, color, given[at + 9u] >> 16, rank, shape);
}
#else
Splat splat_at(uint i) {
    vec3 place = camera_place(dvec3(splat_place(i)));
    float radius = radius_of[i] * radius_scale;
    Splat splat = ball_at(place, radius, alpha_of[i], splat_color(i), 1.0f, first_rank + i);
    splat.shows = splat.shows && !is_large(place, radius) && !is_left_star(i);
    return splat;
}
#endif

uint bin_of(uint key) {
    uint wide = counts.highest - counts.lowest;
    int shift = wide < 1024u ? 0 : findMSB(wide) - 9;
    uint inside = key < counts.lowest ? counts.lowest : min(key, counts.highest);
    return min((inside - counts.lowest) >> shift, 1023u);
}

float pixel_cosine(float px) {
    float inside = min(max(px, -1.0e6f), 1.0e6f) * 256.0f;
    return cosines[int(inside) & 255];
}

// What footprint_at makes of a radius and a place.
struct Profile {
    int node;
    float share, lo, scale, edge_gain, amplitude;
};
Profile profile_at(float radius_px, float x_px, float y_px) {
    NodePlace place = node_of_radius(radius_px);
    int first_node = int(table) * NODE_COUNT, node = first_node + place.first;
    int a = 3 * node, b = 3 * (first_node + min(place.first + 1, NODE_COUNT - 1));
    float tabulated_px = max(radius_px, SMALLEST_RADIUS_PX);
    ProfileRange range = profile_range(core, reach, margin_px, tabulated_px);
    float cx = pixel_cosine(x_px), cy = pixel_cosine(y_px);
    vec4 plain = moments[a] + (moments[b] - moments[a]) * place.share;
    vec4 first = vec4(0.0f);
    if (linear_in_distance) first = moments[a + 2] + (moments[b + 2] - moments[a + 2]) * place.share;
    float mass = profile_mass(linear_in_distance, range, plain.x, first.x);
    float found = mass * (1.0f + pixel_ripple(plain.y, plain.z, plain.w, cx, cy));
    float edge_found = 1.0f;
    if (flat_core) {
        vec4 edge = moments[a + 1] + (moments[b + 1] - moments[a + 1]) * place.share;
        float of_edge = edge_mass(linear_in_distance, range, edge.x, first.y);
        edge_found = of_edge * (1.0f + pixel_ripple(edge.y, edge.z, edge.w, cx, cy));
    }
    float wanted = integral * tabulated_px * tabulated_px;
    FootprintGains gains =
        footprint_gains(flat_core, is_tabulated(place), shrink_of_radius(radius_px), wanted, found, edge_found);
    float scale = as_div(16.0f, profile_width(linear_in_distance, range));
    float lo = profile_begin(linear_in_distance, range);
    return Profile(node, place.share, lo, scale, gains.edge_gain, gains.amplitude);
}

// Columns and rows of tiles that a splat may touch; rounding must not lose one.
uvec2 rect_at(float x_px, float y_px, float support_px) {
    float wide = support_px * 1.0001f;
    vec2 within = vec2(x_px, y_px) - region.xy, first = (within - wide) * 0.0625f, last = (within + wide) * 0.0625f;
    ivec2 from = ivec2(floor(first)), to = ivec2(floor(last));
    uvec2 lo = uvec2(min(max(from.x, 0), tiles.x - 1), min(max(from.y, 0), tiles.y - 1));
    uvec2 hi = uvec2(min(max(to.x, 0), tiles.x - 1), min(max(to.y, 0), tiles.y - 1));
    return uvec2(lo.x | lo.y << 16, hi.x | hi.y << 16);
}

void write_record(uint at, Splat splat) {
    float x_px = splat.x_px, y_px = splat.y_px, radius_px = splat.radius_px;
    Profile profile = profile_at(radius_px, x_px, y_px);
    float support_px = max(radius_px, SMALLEST_RADIUS_PX) * reach + margin_px;
    vec3 stretch = vec3(1.0f, 0.0f, 1.0f);  // symmetric: xx, xy, yy
#ifdef GIVEN
    if (splat.shape >= 0) {
        vec4 a = shapes[3 * splat.shape], b = shapes[3 * splat.shape + 1], c = shapes[3 * splat.shape + 2];
        profile = Profile(int(table) * NODE_COUNT + int(c.y), a.w, a.x, c.x, a.y, a.z);
        stretch = b.xyz;
        support_px = c.z;
    }
#endif
    float weighted = splat.opacity * profile.amplitude;
#ifdef ANY
    record[4u * at] = vec4(x_px, y_px, support_px, weighted);
    record[4u * at + 1u] = vec4(splat.color, profile.scale);
    record[4u * at + 2u] = vec4(profile.lo, profile.edge_gain, profile.amplitude, profile.share);
    float axis_depth_here = axis_depth(lens, x_px, y_px, uintBitsToFloat(splat.key));
    record[4u * at + 3u] = vec4(axis_depth_here, stretch);
    tag_of[at] = uvec2(layer << 16 | uint(profile.node), splat.h_bits);
#else
    record[2u * at] = vec4(x_px, y_px, radius_px, weighted);
    record[2u * at + 1u] = vec4(splat.color, profile.scale);
#endif
#ifdef RANKS
    rank_of[at] = splat.rank;
#endif
    key_of[at] = splat.key;
    record_at[at] = at;
    rect_of[at] = rect_at(x_px, y_px, support_px);
}

void add_area(uint sum) {
    uint before = atomicAdd(counts.area_low, sum);
    if (before + sum < before) atomicAdd(counts.area_high, 1u);
}

shared uint words[GROUP];  // by slab: which of the group's splats it has
#if PASS == 0 || PASS == 2
shared uint least, most;
#elif PASS == 1
shared uint bins[1024];
#endif

void main() {
    uint t = gl_LocalInvocationIndex, group = group_number() * every, i = group * GROUP + t;
    words[t] = 0u;
#if PASS == 0 || PASS == 2
    if (t == 0u) {
        least = 0xffffffffu;
        most = 0u;
    }
#elif PASS == 1
    for (uint k = t; k < 1024u; k += GROUP) bins[k] = 0u;
#endif
    Splat splat;
    splat.shows = false;
    splat.radius_px = 0.0f;
    splat.key = 0u;
    if (i < count) splat = splat_at(i);
    barrier();
#if PASS == 0 || PASS == 2
    if (splat.shows) {
        atomicMin(least, splat.key);
        atomicMax(most, splat.key);
    }
    barrier();
#endif
#if PASS == 0
    if (t != 0u || most < least) return;
    atomicMin(counts.lowest, least);
    atomicMax(counts.highest, most);
#elif PASS == 1
    if (splat.shows) atomicAdd(bins[bin_of(splat.key)], 1u);
    barrier();
    for (uint k = t; k < 1024u; k += GROUP)
        if (bins[k] != 0u) atomicAdd(counts.bins[k], bins[k]);
#else
    uint slab = 0u;
    if (slabs > 1u) slab = counts.bins[bin_of(splat.key)];
    if (splat.shows) atomicOr(words[slab * 8u + (t >> 5)], 1u << (t & 31u));
#endif
#if PASS == 2
    float area = splat.radius_px * splat.radius_px * (16.0f * FOOTPRINT_PI) + 0.5f;
    bool is_wide = area >= 8388608.0f;  // of those a group's sum would not fit
    scan_group(splat.shows && !is_wide ? uint(area) : 0u);
    if (splat.shows && is_wide) add_area(uint(min(area, 4294967040.0f)));
    if (group * GROUP >= count) return;
    if (t < slabs) {
        uint sum = 0u;
        for (uint w = 0u; w < 8u; ++w) sum += uint(bitCount(words[t * 8u + w]));
        begin[t * all_groups + first_group + group] = sum;
    }
    if (t == 0u && most >= least) {
        atomicMin(counts.first_key, least);
        atomicMax(counts.last_key, most);
        add_area(group_sums[255]);
    }
#elif PASS == 3
    barrier();
    if (!splat.shows || (only != ALL_SLABS && slab != only)) return;
    uint at = begin[slab * all_groups + first_group + group];
    if (only != ALL_SLABS) at -= counts.slab_begin[only];
    for (uint w = 0u; w < (t >> 5); ++w) at += uint(bitCount(words[slab * 8u + w]));
    at += uint(bitCount(words[slab * 8u + (t >> 5)] & ((1u << (t & 31u)) - 1u)));
    write_record(at, splat);
#endif
}

// A layer's splats onto the frame, and those that touch the region into records: slab by slab of depth from near to far, in
// a slab in the order of the splats. PASS 0: between which depths a sample lies; 1: how many of it each bin of depth has; 2:
// how many splats each group of 256 leaves in each slab; 3: the records, of all slabs or of the `only` one; 4: which splats
// are left to the processor, because level of detail divides them or they are stars that stay points. As
// engine/render/project_vector.cpp and fold_prepare-inl.h. Needs projection.glsl, blend.glsl and footprint.glsl. ANY: records with what any mix of layers asks
// for. GIVEN: splats that the processor has projected. RANKS: places in the order of ties are kept.
layout(local_size_x = 256) in;
#ifdef GIVEN
layout(std430, binding = 1) readonly buffer Splats { uint given[]; };  // ScreenSplat of engine/render/screen_splat.h
layout(std430, binding = 2) readonly buffer Shapes { vec4 shapes[]; };  // of those that are not round: three each
uniform uint first_given;
uniform bool in_order;  // ties are in order already
#else
layout(std430, binding = 1) readonly buffer Positions { float position[]; };  // layer space
layout(std430, binding = 2) readonly buffer Radii { float radius_of[]; };
layout(std430, binding = 3) readonly buffer Alphas { float alpha_of[]; };
layout(std430, binding = 4) readonly buffer Colors { float color_of[]; };
layout(std430, binding = 14) readonly buffer Stars { uint star_bits[]; };
uniform float lod_limit_px;  // > 0: wider splats are divided
uniform float child_reach;
uniform bool leaves_stars;
#if PASS == 4
layout(std430, binding = 15) buffer Rest { uint rest_count, rest[]; };
#endif
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
uniform dvec4 camera_row[3];  // camera from layer, and the layer's origin
uniform Lens lens;
uniform float opacity, radius_scale;  // of the layer
uniform vec4 region;                  // x0, y0, x1, y1 px
uniform ivec2 tiles;
uniform float reach, margin_px, core, integral;  // of its footprints
uniform bool linear_in_distance, flat_core;
uniform uint layer, table;
uniform bool is_hybrid;
uniform vec3 axis;  // camera space
uniform float hybrid_from_deg, hybrid_to_deg;

// Doubles until it is relative to the camera; their sums and products are the processor's.
float camera_coordinate(dvec4 row, dvec3 p) {
    double sum = row.x * p.x + row.y * p.y;
    sum = (sum + row.z * p.z) + row.w;
    return float(sum);
}

vec3 camera_place(dvec3 p) {
    return vec3(camera_coordinate(camera_row[0], p), camera_coordinate(camera_row[1], p),
                camera_coordinate(camera_row[2], p));
}

struct Splat {
    bool shows;
    uint key;  // of depth
    float x_px, y_px, radius_px, opacity;
    vec3 color;
    uint h_bits;  // of hybrid
    uint rank;
    int shape;  // < 0: it is round
};

#ifdef GIVEN
Splat splat_at(uint i) {
    uint at = 10u * (first_given + i), radius_bits = given[at + 2u];
    int shape = radius_bits > 0x80000000u ? int(radius_bits - 0x80000001u) : -1;
    float radius_px = shape < 0 ? uintBitsToFloat(radius_bits) : shapes[3 * shape + 2].w;
    vec3 color = vec3(uintBitsToFloat(given[at + 4u]), uintBitsToFloat(given[at + 5u]), uintBitsToFloat(given[at + 6u]));
    uint rank = first_rank + (in_order ? i : given[at + 8u]);
    return Splat(true, given[at + 7u], uintBitsToFloat(given[at]), uintBitsToFloat(given[at + 1u]), radius_px,
                 uintBitsToFloat(given[at + 3u]), color, given[at + 9u] >> 16, rank, shape);
}
#else
bool is_large(vec3 place, float radius) {
    float wide_px = 2.0f * radius * instance_of(lens, beyond_near(lens, place)).px_per_unit;
    return lod_limit_px > 0.0f && wide_px > lod_limit_px;
}

// Of large ones: neither it nor its children may show.
bool is_out_of_sight(vec3 place, Instance at, float radius) {
    float wide = radius * child_reach, px = reach_px(lens, place, wide, margin_px);
    float back = at.depth + wide, front = at.depth - wide;
    bool before = front > lens.near;
    return back < lens.near ||
           (before && !touches_rect(at.x_px, at.y_px, px, region.x, region.y, region.z, region.w));
}

bool is_left_star(uint i) { return leaves_stars && (star_bits[i >> 5] >> (i & 31u) & 1u) != 0u; }

Splat splat_at(uint i) {
    dvec3 p = dvec3(position[3u * i], position[3u * i + 1u], position[3u * i + 2u]);
    vec3 place = camera_place(p);
    float alpha = alpha_of[i], radius = radius_of[i] * radius_scale;
    Instance at = instance_of(lens, place);
    float radius_px = radius * at.px_per_unit;
    float x_px = snap_px(at.x_px), y_px = snap_px(at.y_px);
    float support_px = radius_px * reach + margin_px;
    float shown = alpha * opacity * near_fade(lens, at.depth, radius);
    bool shows = is_in_range(lens, at.depth) && alpha > 0.0f && shown > 0.0f &&
                 touches_rect(x_px, y_px, support_px, region.x, region.y, region.z, region.w);
    shows = shows && !is_large(place, radius) && !is_left_star(i);
    float depth = sort_depth(lens, place), h = 0.0f;
    if (is_hybrid) h = hybrid_amount(axis_cosine(lens, axis, place), hybrid_from_deg, hybrid_to_deg);
    float of_65535 = h * 65535.0f + 0.5f;
    vec3 color = vec3(color_of[3u * i], color_of[3u * i + 1u], color_of[3u * i + 2u]);
    return Splat(shows, floatBitsToUint(depth), x_px, y_px, radius_px, shown, color, uint(of_65535), first_rank + i, -1);
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

shared uint words[GROUP];  // by slab: which of the group's splats it has
#if PASS == 0 || PASS == 2
shared uint least, most;
#elif PASS == 1
shared uint bins[1024];
#endif

#if PASS == 4
void main() {
    uint i = group_number() * GROUP + gl_LocalInvocationIndex;
    if (i >= count) return;
    dvec3 p = dvec3(position[3u * i], position[3u * i + 1u], position[3u * i + 2u]);
    vec3 place = camera_place(p);
    float radius = radius_of[i] * radius_scale;
    bool large = is_large(place, radius) && !is_out_of_sight(place, instance_of(lens, place), radius);
    if (large || is_left_star(i)) rest[atomicAdd(rest_count, 1u)] = i;
}
#else
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
    scan_group(splat.shows ? uint(min(area, 8388608.0f)) : 0u);
    if (group * GROUP >= count) return;
    if (t < slabs) {
        uint sum = 0u;
        for (uint w = 0u; w < 8u; ++w) sum += uint(bitCount(words[t * 8u + w]));
        begin[t * all_groups + first_group + group] = sum;
    }
    if (t == 0u && most >= least) {
        atomicMin(counts.first_key, least);
        atomicMax(counts.last_key, most);
        uint sum = group_sums[255], before = atomicAdd(counts.area_low, sum);
        if (before + sum < before) atomicAdd(counts.area_high, 1u);
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
#endif

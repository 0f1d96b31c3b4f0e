// The fold, as engine/render/fold_blend-inl.h: a tile of 16 x 16 px a group, a pixel a thread, its splats of one slab from
// near to far, going on from where the slab before left the pixels. 32 splats at a time are read and their cubics
// interpolated; then parts of 4 x 4 px fold those that touch them. KIND is the number of the FoldKind; ANY: records of any
// mix of layers, SHAPED: some are not round. Else records are plain: SCREEN: all are screens, LINEAR: profiles run over the
// distance. Needs maths.glsl, blend.glsl, lens.glsl and footprint.glsl.
layout(local_size_x = 256) in;
layout(std430, binding = 1) readonly buffer Records { vec4 record[]; };
layout(std430, binding = 2) readonly buffer Entries { uint entry[]; };
layout(std430, binding = 3) readonly buffer Ranges { uint range[]; };
layout(std430, binding = 4) readonly buffer Nodes { vec4 node[]; };  // [node][segment]: by powers
layout(std430, binding = 5) buffer Light { vec4 light_of[]; };      // r, g, b, alpha
layout(std430, binding = 6) buffer Through { vec4 through_of[]; };  // transmittances
uniform uint slab, slabs;        // of those whose entries are there
uniform bool begins, ends;       // it is the first of all, the last
uniform ivec2 corner_px, size_px;  // of the region
uniform int tile_columns;
uniform float stop;
uniform bool alone;  // the light is the frame
#ifdef ANY
layout(std430, binding = 7) buffer More { vec4 more_of[]; };  // held, depth sum, uncovered, count
layout(std430, binding = 8) readonly buffer Tags { uvec2 tag_of[]; };
struct FoldLayer {
    vec4 absorb;  // exponents
    ivec4 kind;   // blend, 1: holdout, 1: linear in distance
};
layout(std430, binding = 9) readonly buffer Layers { FoldLayer layers[]; };
layout(std430, binding = 10) buffer LayerLight { vec4 layer_light[]; };  // [layer][pixel]
uniform bool keeps_layers, aovs;
#else
uniform float reach, margin_px;
#endif

const uint BATCH = 32u, PARTS = 16u;
const uint OUTSIDE = 0xffffffffu;     // of the region: its pixel is not kept
const float TO_WHOLE = 12582912.0f;  // 1.5 * 2^23: a number added to it is rounded to a whole one

shared vec4 cubic[BATCH * 16u];
shared vec4 disc[BATCH];   // x, y, scale, opacity
shared vec4 color[BATCH];  // and the share of the second node
shared int node_of[BATCH];
shared uint touching[PARTS];  // splats, by part
shared uint open_parts;
#ifdef SCREEN
shared float hides[BATCH];  // of alpha; < 0: brighter than white
#endif
#ifdef ANY
const int PLAIN = 0, PROPORTIONAL = 1, CLAMPED = 2, ABSORBING = 3;
shared vec4 occlusion[BATCH];  // r, g, b, alpha
shared vec4 profile[BATCH];    // lo, edge gain, amplitude, depth
#ifdef SHAPED
shared vec3 stretch[BATCH];    // what offsets are mapped by: xx, xy, yy
#endif
shared uint facts[BATCH];      // layer, hiding << 16, holdout << 18, linear << 19
#endif

#ifdef ANY
// As prepare_occlusion.
void prepare_hiding(uint place, vec3 c, uvec2 tag) {
    FoldLayer by = layers[tag.x >> 16];
    bool holdout = by.kind.y != 0;
    int blend = holdout ? BLEND_OVER : by.kind.x;
    float h = float(tag.y) * (1.0f / 65535.0f);
    bool absorbs = !holdout && blend_absorbs(blend, c.x);
    bool bright = blend == BLEND_SCREEN && (c.x > 1.0f || c.y > 1.0f || c.z > 1.0f);
    float r = absorbs ? blend_exponent(blend, c.x, by.absorb.x) : blend_occlusion(blend, c.x, h);
    float g = absorbs ? blend_exponent(blend, c.y, by.absorb.y) : blend_occlusion(blend, c.y, h);
    float b = absorbs ? blend_exponent(blend, c.z, by.absorb.z) : blend_occlusion(blend, c.z, h);
    float mean = as_div((r + g) + b, 3.0f);
    occlusion[place] = vec4(r, g, b, mean);
    int hiding = blend == BLEND_OVER && !absorbs ? PLAIN : absorbs ? ABSORBING : bright ? CLAMPED : PROPORTIONAL;
    if (holdout || absorbs) color[place].rgb = vec3(0.0f);
    facts[place] = (tag.x >> 16) | uint(hiding) << 16 | (holdout ? 1u << 18 : 0u) | (by.kind.z != 0 ? 1u << 19 : 0u);
}
#endif

// A record; it is read a batch ahead.
struct Record {
    vec4 a, b;
#ifdef ANY
    vec4 c, d;
    uvec2 tag;
#endif
};
Record read_record(uint at) {
#ifdef ANY
    return Record(record[4u * at], record[4u * at + 1u], record[4u * at + 2u], record[4u * at + 3u], tag_of[at]);
#else
    return Record(record[2u * at], record[2u * at + 1u]);
#endif
}

// Takes a splat up, and finds the parts that it may touch: `aside` of eight threads does every eighth of them.
void prepare(uint place, Record from, ivec2 corner, uint aside) {
    vec4 a = from.a, b = from.b;
#ifdef ANY
    vec4 c = from.c;
    float support_px = a.z;
#else
    float support_px = max(a.z, SMALLEST_RADIUS_PX) * reach + margin_px;
#endif
    if (aside == 0u) {
        disc[place] = vec4(a.xy, b.w, a.w);
#ifdef ANY
        color[place] = vec4(b.rgb, c.w);
        node_of[place] = int(from.tag.x & 0xffffu);
        profile[place] = vec4(c.xyz, from.d.x);
#ifdef SHAPED
        stretch[place] = from.d.yzw;
#endif
        prepare_hiding(place, b.rgb, from.tag);
#else
        NodePlace between = node_of_radius(a.z);
        color[place] = vec4(b.rgb, between.share);
        node_of[place] = between.first;
#endif
#ifdef SCREEN
        float third = as_div((b.r + b.g) + b.b, 3.0f);
        hides[place] = b.r > 1.0f || b.g > 1.0f || b.b > 1.0f ? -1.0f : third;
#endif
    }
    float wide = support_px * 1.0002f;  // rounding must not lose a pixel
    for (uint part = aside; part < PARTS; part += 8u) {
        vec2 middle = vec2(corner + ivec2(part % 4u, part / 4u) * 4) + 2.0f;
        vec2 away = abs(a.xy - middle) - 1.5f;
        float x = max(away.x, 0.0f), y = max(away.y, 0.0f), apart = x * x + y * y, most = wide * wide;
        if (apart <= most) atomicOr(touching[part], 1u << place);
    }
}

// What a pixel has, going on from slab to slab.
struct Pixel {
    float r, g, b, alpha;
    float through_r, through_g, through_b, through;
    float held, depth_sum, uncovered, count;
};

bool is_open(Pixel p) {
#if KIND == 0
    return p.through >= stop;
#elif KIND == 2
    return max(max(p.through_r, p.through_g), max(p.through_b, p.through)) >= stop;
#else
    return true;
#endif
}

// The splat's weight at the pixel over its amplitude.
float weight_at(uint i, float x, float y) {
    float dx = x - disc[i].x, dy = y - disc[i].y;
#ifdef SHAPED
    vec3 by = stretch[i];
    float along = by.x * dx + by.y * dy;
    dy = by.y * dx + by.z * dy;
    dx = along;
#endif
    float u = dx * dx + dy * dy;
#ifdef ANY
    if ((facts[i] & 1u << 19) != 0u) u = sqrt(u);
    u = u - profile[i].x;
    u = u * disc[i].z;
    u = max(u, 0.0f);
#else
#ifdef LINEAR
    u = sqrt(u);
#endif
    u = u * disc[i].z;
#endif
    float segment = (u - 0.5f) + TO_WHOLE;
    float within = u - (segment - TO_WHOLE);
    vec4 q = cubic[i * 16u + (floatBitsToUint(segment) & 15u)];
    float w = ((q.w * within + q.z) * within + q.y) * within + q.x;
    w = segment < TO_WHOLE + 16.0f ? w : 0.0f;
#ifdef ANY
    w = w + profile[i].y * (w * (1.0f - w));
#endif
    return w;
}

#ifdef ANY
void fold_more(inout Pixel p, uint i, float s, float weight, float share, bool open) {
    float depth_share = share * profile[i].w;
    p.depth_sum = p.depth_sum + depth_share;
    bool touched = s > 0.0f && open;
    p.count = p.count + (touched ? 1.0f : 0.0f);
    float rest = p.uncovered * (1.0f - min(max(weight, 0.0f), 1.0f));
    p.uncovered = touched ? rest : p.uncovered;
}

// GeneralPixels of fold_blend-inl.h.
void fold_any(inout Pixel p, uint i, float s, float weight, uint pixel) {
    vec3 c = color[i].rgb;
    uint hiding = facts[i] >> 16 & 3u;
    float r = s, g = s, b = s, a = s;
    if (hiding != uint(PLAIN)) {
        vec4 o = occlusion[i];
        r = s * o.r;
        g = s * o.g;
        b = s * o.b;
        a = s * o.a;
        if (hiding == uint(CLAMPED)) {
            r = min(r, 1.0f);
            g = min(g, 1.0f);
            b = min(b, 1.0f);
        }
        if (hiding == uint(ABSORBING)) {
            float rest = 1.0f - s, logarithm = as_log(rest);
            r = 1.0f - (o.r == 1.0f ? rest : as_exp(o.r * logarithm));
            g = 1.0f - (o.g == 1.0f ? rest : as_exp(o.g * logarithm));
            b = 1.0f - (o.b == 1.0f ? rest : as_exp(o.b * logarithm));
        }
        if (hiding != uint(PROPORTIONAL)) a = as_div((r + g) + b, 3.0f);
    }
    bool open = is_open(p);
    float light_r = (open ? p.through_r * s : 0.0f) * c.r, light_g = (open ? p.through_g * s : 0.0f) * c.g,
          light_b = (open ? p.through_b * s : 0.0f) * c.b;
    p.r = p.r + light_r;
    p.g = p.g + light_g;
    p.b = p.b + light_b;
    p.through_r = p.through_r * (1.0f - r);
    p.through_g = p.through_g * (1.0f - g);
    p.through_b = p.through_b * (1.0f - b);
    float share = open ? p.through * a : 0.0f;
    float shown = (facts[i] & 1u << 18) != 0u ? share * 0.0f : share * 1.0f;
    float taken = share - shown;
    p.held = p.held + taken;
    p.alpha = p.alpha + shown;
    p.through = p.through * (1.0f - a);
    if (keeps_layers && pixel != OUTSIDE) {
        uint at = (facts[i] & 0xffffu) * uint(size_px.x * size_px.y) + pixel;
        vec4 kept = layer_light[at] + vec4(light_r, light_g, light_b, shown);
        layer_light[at] = kept;
    }
    if (aovs) fold_more(p, i, s, weight, shown, open);
}
#endif

void fold_splat(inout Pixel p, uint i, float x, float y, uint pixel) {
    float w = weight_at(i, x, y);
    float s = max(disc[i].w * w, 0.0f);
    s = min(s, 1.0f);
    vec4 c = color[i];
#if KIND == 0
    float share = is_open(p) ? p.through * s : 0.0f;
    p.r = p.r + share * c.r;
    p.g = p.g + share * c.g;
    p.b = p.b + share * c.b;
    p.alpha = p.alpha + share;
    p.through = p.through * (1.0f - s);
#elif KIND == 1
    p.r = p.r + s * c.r;
    p.g = p.g + s * c.g;
    p.b = p.b + s * c.b;
#elif KIND == 3
    p.r = max(p.r, s * c.r);
    p.g = max(p.g, s * c.g);
    p.b = max(p.b, s * c.b);
    float share = p.through * s;
    p.alpha = p.alpha + share;
    p.through = p.through * (1.0f - s);
#ifdef ANY
    float weight = w * profile[i].z;
    if (aovs) fold_more(p, i, s, weight, share, true);
#endif
#elif defined(SCREEN)
    float hidden = s * hides[i], r = s * c.r, g = s * c.g, b = s * c.b;
    bool open = is_open(p);
    p.r = p.r + (open ? p.through_r * s : 0.0f) * c.r;
    p.g = p.g + (open ? p.through_g * s : 0.0f) * c.g;
    p.b = p.b + (open ? p.through_b * s : 0.0f) * c.b;
    if (hides[i] < 0.0f) {
        r = min(r, 1.0f);
        g = min(g, 1.0f);
        b = min(b, 1.0f);
        hidden = as_div((r + g) + b, 3.0f);
    }
    p.through_r = p.through_r * (1.0f - r);
    p.through_g = p.through_g * (1.0f - g);
    p.through_b = p.through_b * (1.0f - b);
    p.alpha = p.alpha + (open ? p.through * hidden : 0.0f);
    p.through = p.through * (1.0f - hidden);
#else
    float weight = w * profile[i].z;
    fold_any(p, i, s, weight, pixel);
#endif
}

Pixel load_pixel(uint at) {
    Pixel p = Pixel(0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f, 1.0f, 0.0f, 0.0f, 1.0f, 0.0f);
    if (begins) return p;
    vec4 light = light_of[at], through = through_of[at];
    p.r = light.r, p.g = light.g, p.b = light.b, p.alpha = light.a;
    p.through_r = through.r, p.through_g = through.g, p.through_b = through.b, p.through = through.a;
#ifdef ANY
    vec4 more = more_of[at];
    p.held = more.x, p.depth_sum = more.y, p.uncovered = more.z, p.count = more.w;
#endif
    return p;
}

void store_pixel(uint at, Pixel p) {
    if (ends && !is_open(p)) {  // closed
        p.alpha = 1.0f - p.held;
        p.through_r = p.through_g = p.through_b = p.through = 0.0f;
    }
    if (ends && alone) p.alpha = min(max(p.alpha, 0.0f), 1.0f);
    light_of[at] = vec4(p.r, p.g, p.b, p.alpha);
#if KIND == 0
    p.through_r = p.through_g = p.through_b = p.through;
#endif
    if (!ends || !alone) through_of[at] = vec4(p.through_r, p.through_g, p.through_b, p.through);
#ifdef ANY
    if (!ends || !alone) more_of[at] = vec4(p.held, p.depth_sum, p.uncovered, p.count);
#endif
}

void main() {
    uint t = gl_LocalInvocationIndex, tile = group_number(), part = t / 16u;
    uint first = range[tile * (slabs + 1u) + slab], end = range[tile * (slabs + 1u) + slab + 1u];
    if (!begins && !ends && first == end) return;
    ivec2 within = ivec2(int(tile) % tile_columns, int(tile) / tile_columns) * 16, corner = corner_px + within;
    within += ivec2(part % 4u, part / 4u) * 4 + ivec2(t % 4u, t % 16u / 4u);
    bool inside = within.x < size_px.x && within.y < size_px.y;
    uint pixel = inside ? uint(within.y * size_px.x + within.x) : OUTSIDE;
    float x = float(corner_px.x + within.x) + 0.5f, y = float(corner_px.y + within.y) + 0.5f;
    Pixel p = load_pixel(inside ? pixel : 0u);
    if (t == 0u) open_parts = 0u;
    barrier();
    if (inside && is_open(p)) atomicOr(open_parts, 1u << part);
    barrier();
    if (open_parts == 0u) end = first;
    uint mine = t / 8u, aside = t % 8u;  // the splat of a batch that this thread helps to prepare
    Record next;
    if (first + mine < end) next = read_record(entry[first + mine]);
    for (uint base = first; base < end; base += BATCH) {
        uint n = min(end - base, BATCH);
        if (t < PARTS) touching[t] = 0u;
        bool folds = (open_parts >> part & 1u) != 0u;
        barrier();
        if (t == 0u) open_parts = 0u;
        if (mine < n) prepare(mine, next, corner, aside);
        if (base + BATCH + mine < end) next = read_record(entry[base + BATCH + mine]);
        barrier();
        for (uint k = t; k < n * 16u; k += GROUP) {
            uint i = k / 16u, a = uint(node_of[i]), segment = k % 16u;
            uint b = a % uint(NODE_COUNT) == uint(NODE_COUNT - 1) ? a : a + 1u;
            vec4 from = node[a * 16u + segment], to = node[b * 16u + segment];
            vec4 between = from + (to - from) * color[i].w;
            cubic[k] = between;
        }
        barrier();
        if (folds) {
            for (uint rest = touching[part]; rest != 0u; rest &= rest - 1u)
                fold_splat(p, uint(findLSB(rest)), x, y, pixel);
            if (inside && is_open(p)) atomicOr(open_parts, 1u << part);
        }
        barrier();
        if (open_parts == 0u) break;
    }
    if (inside) store_pixel(pixel, p);
}

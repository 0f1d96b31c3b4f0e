// A layer's splats in the card's memory, and what card_project.glsl and card_children.glsl ask of one. GIVEN: the splats are
// those that card_children.glsl or the processor has projected. Needs blend.glsl and projection.glsl.
#ifndef GIVEN
layout(std430, binding = 1) readonly buffer Positions { float position[]; };  // layer space
layout(std430, binding = 2) readonly buffer Radii { float radius_of[]; };
layout(std430, binding = 3) readonly buffer Alphas { float alpha_of[]; };
layout(std430, binding = 4) readonly buffer Colors { float color_of[]; };
layout(std430, binding = 14) readonly buffer Ids { uvec2 id_of[]; };  // read where they are asked for
uniform float lod_limit_px;  // > 0: wider splats are divided
uniform float child_reach;
uniform bool leaves_stars;
#endif
uniform dvec4 camera_row[3];  // camera from layer, and the layer's origin
uniform Lens lens;
uniform float opacity, radius_scale;  // of the layer
uniform vec4 region;                  // x0, y0, x1, y1 px
uniform float reach, margin_px;       // of its footprints
uniform bool is_hybrid;
uniform vec3 axis;  // camera space
uniform float hybrid_from_deg, hybrid_to_deg;

struct Splat {
    bool shows;
    uint key;  // of depth
    float x_px, y_px, radius_px, opacity;
    vec3 color;
    uint h_bits;  // of hybrid
    uint rank;
    int shape;  // < 0: it is round
};

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

uint h_bits_at(vec3 place) {
    float h = 0.0f;
    if (is_hybrid) h = hybrid_amount(axis_cosine(lens, axis, place), hybrid_from_deg, hybrid_to_deg);
    float of_65535 = h * 65535.0f + 0.5f;
    return uint(of_65535);
}

// A ball, whose image is `size` times as large. As project_one() of engine/render/project.cpp.
Splat ball_at(vec3 place, float radius, float alpha, vec3 color, float size, uint rank) {
    Instance at = instance_of(lens, place);
    float radius_px = radius * at.px_per_unit * size, x_px = snap_px(at.x_px), y_px = snap_px(at.y_px);
    float support_px = radius_px * reach + margin_px, shown = alpha * opacity * near_fade(lens, at.depth, radius);
    bool shows = is_in_range(lens, at.depth) && alpha > 0.0f && shown > 0.0f &&
                 touches_rect(x_px, y_px, support_px, region.x, region.y, region.z, region.w);
    float depth = sort_depth(lens, place);
    return Splat(shows, floatBitsToUint(depth), x_px, y_px, radius_px, shown, color, h_bits_at(place), rank, -1);
}

#ifndef GIVEN
vec3 splat_place(uint i) { return vec3(position[3u * i], position[3u * i + 1u], position[3u * i + 2u]); }
vec3 splat_color(uint i) { return vec3(color_of[3u * i], color_of[3u * i + 1u], color_of[3u * i + 2u]); }

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

bool is_star(uint i) { return (id_of[i].y >> 16 & 255u) == 255u; }
bool is_left_star(uint i) {
    if (!leaves_stars) return false;
    return is_star(i);
}
#endif

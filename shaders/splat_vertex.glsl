// A shaded splat onto the frame, as engine/render/project.cpp and footprint.cpp do: a point, or with QUADS the corner
// of a square. Needs blend.glsl, projection.glsl and footprint.glsl. KIND is the number of the group's FoldKind.

const int MAX_LAYERS = 64;

struct DrawLayer {
    vec4 right;    // rows of camera_from_layer: camera x, y, z from (p - eye); w: the eye in layer space,
    vec4 up;       // x, y, z of it
    vec4 back;
    vec4 eye_low;  // what the eye's floats leave over; w: scene units per unit of radius
    vec4 axis;     // of the layer, camera space; w: opacity
    vec4 blend;    // blend, hybrid from, to in degrees, 1: holdout
    vec4 falloff;  // number of its footprint table, reach, core, 1: flat inside
    vec4 absorb;   // exponents of blend absorb
};

layout(std140) uniform DrawBlock {
    Lens lens;
    vec4 target;       // width, height, margin, 4 pixel filters in px
    ivec4 layers_used;
    ivec4 first_splat[MAX_LAYERS / 4];
    DrawLayer layers[MAX_LAYERS];
};

uniform sampler2D footprint_nodes;  // a row of radii; two rows a table

#ifdef QUADS
uniform samplerBuffer places;
uniform samplerBuffer colors;
layout(location = 2) in uint splat_index;
#else
layout(location = 0) in vec4 splat_place;
layout(location = 1) in vec4 splat_color;
#endif

flat out vec4 disc_place;  // centre in px; profile coordinate = z + w * distance
flat out vec4 disc_table;  // row, table, edge gain, largest s
flat out vec4 disc_light;  // colour, opacity
#if KIND == 2
flat out vec4 disc_occlusion;  // r, g, b; 0: shows no alpha (holdout), 2: absorbs, with these exponents
#endif

const float PROFILE_SAMPLES = 256.0;

int layer_of(int index) {
    int layer = 0;
    for (int i = 1; i < layers_used.x; ++i) layer = index >= first_splat[i >> 2][i & 3] ? i : layer;
    return layer;
}

// cos of the phase of a coordinate relative to the pixel centres.
float pixel_cosine(float px) { return -cos(6.28318531 * fract(px)); }

void main() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside: not shown
#ifdef QUADS
    int index = int(splat_index);
    vec4 place = texelFetch(places, index);
    vec4 color = texelFetch(colors, index);
#else
    int index = gl_VertexID;
    vec4 place = splat_place;
    vec4 color = splat_color;
    gl_PointSize = 1.0;
#endif
    DrawLayer layer = layers[layers_used.x > 1 ? layer_of(index) : 0];
    vec3 from_eye = (place.xyz - vec3(layer.right.w, layer.up.w, layer.back.w)) - layer.eye_low.xyz;
    vec3 p = vec3(dot(layer.right.xyz, from_eye), dot(layer.up.xyz, from_eye), dot(layer.back.xyz, from_eye));
    Instance at = instance_of(lens, p);
    bool shows = color.a > 0.0 && is_in_range(lens, at.depth);

    float radius = place.w * layer.eye_low.w;
    float radius_px = radius * at.px_per_unit;
    vec2 centre = vec2(snap_px(at.x_px), snap_px(at.y_px));
    float tabulated_px = max(radius_px, SMALLEST_RADIUS_PX);
    ProfileRange profile = profile_range(layer.falloff.z, layer.falloff.y, target.w, tabulated_px);
    float support_px = profile.hi;
    shows = shows && touches_rect(centre.x, centre.y, support_px, 0.0, 0.0, target.x, target.y);

    NodePlace node = node_of_radius(tabulated_px);
    float node_x = (min(float(node.first) + node.share, float(NODE_COUNT - 1)) + 0.5) / float(NODE_COUNT);
    vec2 node_at = vec2(node_x, 0.5 / float(textureSize(footprint_nodes, 0).y));
    vec4 mass = textureLod(footprint_nodes, node_at * vec2(1.0, 4.0 * layer.falloff.x + 1.0), 0.0);
    vec4 edge = textureLod(footprint_nodes, node_at * vec2(1.0, 4.0 * layer.falloff.x + 3.0), 0.0);
    float cx = pixel_cosine(centre.x);
    float cy = pixel_cosine(centre.y);
    FootprintGains gains =
        footprint_gains(layer.falloff.w != 0.0, is_tabulated(node), shrink_of_radius(radius_px), 1.0,
                        mass.x * (1.0 + pixel_ripple(mass.y, mass.z, mass.w, cx, cy)),
                        edge.x * (1.0 + pixel_ripple(edge.y, edge.z, edge.w, cx, cy)));

    float per_px = (1.0 - 1.0 / PROFILE_SAMPLES) / (profile.hi - profile.lo);
    disc_place = vec4(centre, 0.5 / PROFILE_SAMPLES - profile.lo * per_px, per_px);
    disc_table = vec4(node_x, layer.falloff.x, gains.edge_gain, max(1.0, color.a));
    float opacity = color.a * layer.axis.w * near_fade(lens, at.depth, radius) * gains.amplitude;
    bool holdout = layer.blend.w != 0.0;
    int blend = holdout ? BLEND_OVER : int(layer.blend.x);
    bool absorbs = !holdout && blend_absorbs(blend, color.r);
    disc_light = vec4(holdout || absorbs ? vec3(0.0) : color.rgb, opacity);
#if KIND == 2
    float cosine = axis_cosine(lens, layer.axis.xyz, p);
    float h = blend == BLEND_HYBRID ? hybrid_amount(cosine, layer.blend.y, layer.blend.z) : 0.0;
    disc_occlusion = vec4(blend_occlusion(blend, color.r, h), blend_occlusion(blend, color.g, h),
                         blend_occlusion(blend, color.b, h), holdout ? 0.0 : 1.0);
    if (absorbs)
        disc_occlusion = vec4(blend_exponent(blend, color.r, layer.absorb.r),
                             blend_exponent(blend, color.g, layer.absorb.g),
                             blend_exponent(blend, color.b, layer.absorb.b), 2.0);
#endif
    if (!shows || !(opacity > 0.0)) return;

    vec2 corner = centre;
#ifdef QUADS
    corner += support_px * vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID & 2) - 1);
#else
    gl_PointSize = 2.0 * support_px;
#endif
    gl_Position = vec4((corner + target.z) / (target.xy + 2.0 * target.z) * 2.0 - 1.0, 0.0, 1.0);
}

// A shaded splat onto the picture, as engine/render/project.cpp and footprint.cpp do: a point, or with QUADS the corner
// of a square. Needs maths.glsl and blend.glsl. KIND is the number of the group's FoldKind.

const int MAX_LAYERS = 64;

struct DrawLayer {
    vec4 right;    // rows of camera_from_layer: camera x, y, z from (p - eye); w: the eye in layer space,
    vec4 up;       // x, y, z of it
    vec4 back;
    vec4 eye_low;  // what the eye's floats leave over; w: scene units per unit of radius
    vec4 axis;     // of the layer, camera space; w: opacity
    vec4 blend;    // blend, hybrid from, to in degrees, 1: holdout
    vec4 falloff;  // number of its footprint table, reach, core, 1: flat inside
};

layout(std140) uniform DrawBlock {
    vec4 camera;       // focal px, centre x, y px, 1: orthographic
    vec4 range;        // near, far, near fade, 4 pixel filters in px
    vec4 target;       // width, height, margin in px
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

flat out vec4 dot_place;  // centre in px; profile coordinate = z + w * distance
flat out vec4 dot_table;  // row, table, edge gain, largest s
flat out vec4 dot_light;  // colour, opacity
#if KIND == 2
flat out vec4 dot_occlusion;  // r, g, b; 0: shows no alpha (holdout)
#endif

const float NODES = 513.0;
const float SMALLEST_PX = 1.0 / 64.0;
const float PROFILE_SAMPLES = 256.0;

int layer_of(int index) {
    int layer = 0;
    for (int i = 1; i < layers_used.x; ++i) layer = index >= first_splat[i >> 2][i & 3] ? i : layer;
    return layer;
}

float snap(float px) { return floor(px * 256.0 + 0.5) * (1.0 / 256.0); }

// cos of the phase of a coordinate relative to the pixel centres.
float pixel_cosine(float px) { return -cos(6.28318531 * fract(px)); }

// Relative excess of the sum over all pixels, from the spectrum at three frequencies.
float ripple(vec3 spectrum, float cx, float cy) {
    float c2 = (2.0 * cx * cx - 1.0) + (2.0 * cy * cy - 1.0);
    return 2.0 * spectrum.x * (cx + cy) + 4.0 * spectrum.y * (cx * cy) + 2.0 * spectrum.z * c2;
}

// Rises from 0 at the near plane to 1 where the splat is a radius (or the camera's near fade) behind it.
float near_fade(float z, float radius) {
    float t = min(1.0, (z - range.x) / max(range.z, radius));
    return t * t * (3.0 - 2.0 * t);
}

float hybrid_of(DrawLayer layer, vec3 p) {
    float along = abs(dot(layer.axis.xyz, p));
    float cosine = camera.w != 0.0 ? abs(layer.axis.z) : along / sqrt(dot(p, p));
    return hybrid_amount(cosine, layer.blend.y, layer.blend.z);
}

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
    float z = -p.z;
    bool shows = color.a > 0.0 && z > range.x && (range.y <= 0.0 || z <= range.y);

    float radius = place.w * layer.eye_low.w;
    float px_per_unit = camera.w != 0.0 ? camera.x : camera.x / z;
    float radius_px = radius * px_per_unit;
    vec2 centre = vec2(snap(camera.y + p.x * px_per_unit), snap(camera.z - p.y * px_per_unit));

    float tabulated_px = max(radius_px, SMALLEST_PX);
    float shrink = radius_px < SMALLEST_PX ? (radius_px / SMALLEST_PX) * (radius_px / SMALLEST_PX) : 1.0;
    float support_px = tabulated_px * layer.falloff.y + range.w;
    shows = shows && centre.x + support_px > 0.0 && centre.x - support_px < target.x &&
            centre.y + support_px > 0.0 && centre.y - support_px < target.y;

    // 32 nodes per octave from 2^-6 px on, linear between: the upper bits of the float.
    float node = clamp(float(floatBitsToInt(tabulated_px) - (121 << 23)) / 262144.0, 0.0, NODES - 1.0);
    vec2 node_at = vec2((node + 0.5) / NODES, 0.5 / float(textureSize(footprint_nodes, 0).y));
    vec4 mass = textureLod(footprint_nodes, node_at * vec2(1.0, 4.0 * layer.falloff.x + 1.0), 0.0);
    vec4 edge = textureLod(footprint_nodes, node_at * vec2(1.0, 4.0 * layer.falloff.x + 3.0), 0.0);
    float cx = pixel_cosine(centre.x);
    float cy = pixel_cosine(centre.y);
    float found = mass.x * (1.0 + ripple(mass.yzw, cx, cy));
    bool flat_core = layer.falloff.w != 0.0;
    bool tabulated = node < NODES - 1.0;
    float amplitude = tabulated && !flat_core ? shrink / found : shrink;
    float edge_gain = tabulated && flat_core ? (1.0 - found) / (edge.x * (1.0 + ripple(edge.yzw, cx, cy))) : 0.0;

    float lo = max(0.0, tabulated_px * layer.falloff.z - range.w);
    float per_px = (1.0 - 1.0 / PROFILE_SAMPLES) / (support_px - lo);
    dot_place = vec4(centre, 0.5 / PROFILE_SAMPLES - lo * per_px, per_px);
    dot_table = vec4((node + 0.5) / NODES, layer.falloff.x, edge_gain, max(1.0, color.a));
    float opacity = color.a * layer.axis.w * near_fade(z, radius) * amplitude;
    bool holdout = layer.blend.w != 0.0;
    dot_light = vec4(holdout ? vec3(0.0) : color.rgb, opacity);
#if KIND == 2
    int blend = holdout ? BLEND_OVER : int(layer.blend.x);
    float h = blend == BLEND_HYBRID ? hybrid_of(layer, p) : 0.0;
    dot_occlusion = vec4(blend_occlusion(blend, color.r, h), blend_occlusion(blend, color.g, h),
                         blend_occlusion(blend, color.b, h), holdout ? 0.0 : 1.0);
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

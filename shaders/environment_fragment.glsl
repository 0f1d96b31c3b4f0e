// The environment behind everything, as sample_environment in engine/render/environment.cpp: two mip levels of one
// equirectangular picture or of six faces, each stored with a border of one texel. Needs projection.glsl.

uniform sampler2DArray fine_level;
uniform sampler2DArray coarse_level;
uniform float coarse_share;
uniform float gain;
uniform mat3 environment_from_world;
uniform mat3 world_from_camera;
uniform bool is_near;  // on a sphere about the origin
uniform vec3 eye;      // over its radius
uniform Lens lens;

layout(location = 0) out vec4 light;

const float PI = 3.14159265;

// Face and place in [0, 1], (0, 0) the upper left corner. OpenEXR's latlong: longitude 0 towards +z, pi / 2 towards +x.
vec3 latlong_place(vec3 d) {
    float longitude = atan(d.x, d.z);
    float latitude = asin(clamp(d.y, -1.0, 1.0));
    return vec3(0.5 - longitude / (2.0 * PI), 0.5 - latitude / PI, 0.0);
}

// +x -x +y -y +z -z; +y and -y are seen tilting the head from -z.
vec3 cube_place(vec3 d) {
    vec3 a = abs(d);
    vec3 on;  // right, up, along
    float face;
    if (a.x >= a.y && a.x >= a.z) {
        on = d.x > 0.0 ? vec3(d.z, d.y, a.x) : vec3(-d.z, d.y, a.x);
        face = d.x < 0.0 ? 1.0 : 0.0;
    } else if (a.y >= a.z) {
        on = d.y > 0.0 ? vec3(d.x, d.z, a.y) : vec3(d.x, -d.z, a.y);
        face = d.y < 0.0 ? 3.0 : 2.0;
    } else {
        on = d.z > 0.0 ? vec3(-d.x, d.y, a.z) : vec3(d.x, d.y, a.z);
        face = d.z < 0.0 ? 5.0 : 4.0;
    }
    return vec3(0.5 + 0.5 * on.x / on.z, 0.5 - 0.5 * on.y / on.z, face);
}

vec3 read_level(sampler2DArray level, vec3 place) {
    vec2 stored = vec2(textureSize(level, 0).xy);
    vec2 at = (place.xy * (stored - 2.0) + 1.0) / stored;
    return textureLod(level, vec3(at, place.z), 0.0).rgb;
}

// As seen_place in engine/render/environment.h.
vec3 seen_place(vec3 ray) {
    if (!is_near) return ray;
    vec3 e = eye * min(1.0, 0.99 / max(length(eye), 1e-6));
    float along = dot(e, ray);
    float t = sqrt(max(0.0, along * along + 1.0 - dot(e, e))) - along;
    return normalize(e + t * ray);
}

void main() {
    vec3 ray = normalize(ray_through(lens, gl_FragCoord.x, gl_FragCoord.y));
    vec3 d = environment_from_world * seen_place(world_from_camera * ray);
    vec3 place = textureSize(fine_level, 0).z == 1 ? latlong_place(d) : cube_place(d);
    vec3 color = read_level(fine_level, place);
    if (coarse_share > 0.0) color = mix(color, read_level(coarse_level, place), coarse_share);
    light = vec4(color * gain, 1.0);
}

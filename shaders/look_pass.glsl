// The look of one splat, captured by transform feedback. Needs the shared look.

layout(std140) uniform LookBlock { LookUniforms look; };
uniform sampler2D thickness_map;  // raw values, top row first

layout(location = 0) in vec3 raw_position;
layout(location = 1) in vec3 raw_color;
layout(location = 2) in float raw_alpha;
layout(location = 3) in float raw_distance;
layout(location = 4) in uvec2 raw_id;
layout(location = 5) in vec2 raw_uv;
layout(location = 6) in float raw_radius;

out vec4 shaded_place;  // position in layer space, radius; radius -1: dropped
out vec4 shaded_color;  // straight colour, alpha

vec3 read_map(vec2 uv) {
    ivec2 size = textureSize(thickness_map, 0);
    float x = look_texel(uv.x, size.x);
    float y = look_texel(1.0 - uv.y, size.y);
    ivec2 first = ivec2(int(x), int(y));
    ivec2 second = min(first + 1, size - 1);
    float tx = x - floor(x);
    float ty = y - floor(y);
    vec3 c00 = texelFetch(thickness_map, first, 0).rgb;
    vec3 c10 = texelFetch(thickness_map, ivec2(second.x, first.y), 0).rgb;
    vec3 c01 = texelFetch(thickness_map, ivec2(first.x, second.y), 0).rgb;
    vec3 c11 = texelFetch(thickness_map, second, 0).rgb;
    return vec3(look_bilinear(c00.x, c10.x, c01.x, c11.x, tx, ty),
                look_bilinear(c00.y, c10.y, c01.y, c11.y, tx, ty),
                look_bilinear(c00.z, c10.z, c01.z, c11.z, tx, ty));
}

void main() {
    vec3 map_value = look.stop_count > 1 ? read_map(raw_uv) : vec3(0.0);
    LookOutput o = look_splat(look, LookInput(raw_position, raw_color, raw_alpha, raw_distance, raw_radius, map_value,
                                              raw_id.x, raw_id.y));
    shaded_place = vec4(o.position, o.keep ? o.radius : -1.0);
    shaded_color = vec4(o.color, o.keep ? o.alpha : 0.0);
    gl_Position = vec4(0.0);
}

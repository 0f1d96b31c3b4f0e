// The look over a set in the card's memory, row by row, into what card_project.glsl reads: alpha is 0 where the look drops a
// splat. Needs the shared look.
layout(local_size_x = 256) in;
layout(std140, binding = 0) uniform LookBlock { LookUniforms look; };
layout(std430, binding = 1) readonly buffer RawPositions { float raw_position[]; };
layout(std430, binding = 2) readonly buffer RawColors { float raw_color[]; };
layout(std430, binding = 3) readonly buffer RawAlphas { float raw_alpha[]; };
layout(std430, binding = 4) readonly buffer RawDistances { float raw_distance[]; };
layout(std430, binding = 5) readonly buffer RawIds { uvec2 raw_id[]; };
layout(std430, binding = 6) readonly buffer RawRadii { float raw_radius[]; };  // read where they are the look's
layout(std430, binding = 7) readonly buffer RawUvs { vec2 raw_uv[]; };         // read where there is a map
layout(std430, binding = 8) readonly buffer Map { float map_value[]; };        // raw values, top row first
layout(std430, binding = 9) writeonly buffer Positions { float position[]; };
layout(std430, binding = 10) writeonly buffer Radii { float radius_of[]; };
layout(std430, binding = 11) writeonly buffer Alphas { float alpha_of[]; };
layout(std430, binding = 12) writeonly buffer Colors { float color_of[]; };
layout(std430, binding = 13) buffer Totals { uint kept, largest, largest_of_stars; };  // light: bits, which order as it does
uniform uint splats;
uniform ivec3 map_size;  // width, height, channels

vec3 map_texel(int x, int y) {
    int at = (y * map_size.x + x) * map_size.z, green = map_size.z >= 3 ? 1 : 0, blue = map_size.z >= 3 ? 2 : 0;
    return vec3(map_value[at], map_value[at + green], map_value[at + blue]);
}

vec3 read_map(vec2 uv) {
    float x = look_texel(uv.x, map_size.x), y = look_texel(1.0f - uv.y, map_size.y);
    int x0 = int(x), y0 = int(y), x1 = min(x0 + 1, map_size.x - 1), y1 = min(y0 + 1, map_size.y - 1);
    float tx = x - floor(x), ty = y - floor(y);
    vec3 c00 = map_texel(x0, y0), c10 = map_texel(x1, y0), c01 = map_texel(x0, y1), c11 = map_texel(x1, y1);
    return vec3(look_bilinear(c00.x, c10.x, c01.x, c11.x, tx, ty), look_bilinear(c00.y, c10.y, c01.y, c11.y, tx, ty),
                look_bilinear(c00.z, c10.z, c01.z, c11.z, tx, ty));
}

shared uint group_kept, group_largest, group_largest_of_stars;

void shade(uint i) {
    vec3 place = vec3(raw_position[3u * i], raw_position[3u * i + 1u], raw_position[3u * i + 2u]);
    vec3 color = vec3(raw_color[3u * i], raw_color[3u * i + 1u], raw_color[3u * i + 2u]);
    vec3 chosen = vec3(0.0f);
    if (look.stop_count > 1) chosen = read_map(raw_uv[i]);
    float radius = 0.0f;
    if (look.radius.own != 0) radius = raw_radius[i];
    uvec2 id = raw_id[i];
    LookInput raw = LookInput(place, color, raw_alpha[i], raw_distance[i], radius, chosen, id.x, id.y, 1.0f);
    LookOutput o = look_splat(look, raw);
    position[3u * i] = o.position.x;
    position[3u * i + 1u] = o.position.y;
    position[3u * i + 2u] = o.position.z;
    color_of[3u * i] = o.color.x;
    color_of[3u * i + 1u] = o.color.y;
    color_of[3u * i + 2u] = o.color.z;
    radius_of[i] = o.radius;
    alpha_of[i] = o.keep ? o.alpha : 0.0f;
    if (!o.keep) return;
    atomicAdd(group_kept, 1u);
    float light = o.alpha * max(max(o.color.x, o.color.y), o.color.z);
    if (!(light > 0.0f)) return;
    bool star = (id.y >> 16 & 255u) == 255u;
    if (star) atomicMax(group_largest_of_stars, floatBitsToUint(light));
    else atomicMax(group_largest, floatBitsToUint(light));
}

void main() {
    if (gl_LocalInvocationIndex == 0u) group_kept = group_largest = group_largest_of_stars = 0u;
    barrier();
    uint i = group_number() * GROUP + gl_LocalInvocationIndex;
    if (i < splats) shade(i);
    barrier();
    if (gl_LocalInvocationIndex != 0u || group_kept == 0u) return;
    atomicAdd(kept, group_kept);
    atomicMax(largest, group_largest);
    atomicMax(largest_of_stars, group_largest_of_stars);
}

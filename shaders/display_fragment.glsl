// A pixel of the screen: background, picture A or B through exposure and view transform, or their difference. The
// transform is that of engine/output/encode.cpp for frames without alpha; display.cpp sets the uniforms.

const int MODE_A = 0;
const int MODE_WIPE = 1;
const int MODE_B = 2;
const int MODE_DIFFERENCE = 3;
const int VIEW_LINEAR = 0;
const int VIEW_SRGB = 1;
const int VIEW_SOFT = 2;

uniform sampler2D picture_a;  // linear light, premultiplied, top row first
uniform sampler2D picture_b;
uniform int taps_a;  // reads per axis and pixel
uniform int taps_b;
uniform vec4 place;  // upper left corner of the picture in px from the target's lower left; 1 / size
uniform int mode;
uniform int view;
uniform float gain;  // 2^exposure
uniform float wipe;  // share of the picture's width that shows A
uniform float difference_gain;
uniform int b_is_display;
uniform int dithered;
uniform vec3 background;

layout(location = 0) out vec4 shown;

// Mean over the pixel of the target, whose corner is uv and whose size is step.
vec3 read_picture(sampler2D picture, int taps, vec2 uv, vec2 step) {
    if (taps == 1) return textureLod(picture, uv + 0.5 * step, 0.0).rgb;
    vec3 sum = vec3(0.0);
    for (int j = 0; j < taps; ++j)
        for (int i = 0; i < taps; ++i)
            sum += textureLod(picture, uv + step * (vec2(i, j) + 0.5) / float(taps), 0.0).rgb;
    return sum / float(taps * taps);
}

vec3 soft_curve(vec3 x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }

vec3 srgb_curve(vec3 x) {
    vec3 bent = 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055;
    return mix(bent, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

// Negative values and NaN give 0.
vec3 apply_view(vec3 light) {
    vec3 x = mix(vec3(0.0), light * gain, greaterThan(light, vec3(0.0)));
    if (view == VIEW_SOFT) x = soft_curve(min(x, vec3(1.0e6)));
    x = clamp(x, 0.0, 1.0);
    return view == VIEW_LINEAR ? x : srgb_curve(x);
}

vec3 shown_a(vec2 uv, vec2 step) { return apply_view(read_picture(picture_a, taps_a, uv, step)); }

vec3 shown_b(vec2 uv, vec2 step) {
    vec3 value = read_picture(picture_b, taps_b, uv, step);
    if (b_is_display != 0) return clamp(value, 0.0, 1.0);
    return apply_view(value);
}

// As dither() in engine/output/encode.cpp, in levels of 8 bits.
vec3 dither(uvec2 px) {
    uvec3 lattice = uvec3(px.x * 0xC13FA9A9u + px.y * 0x91E10DA5u) + uvec3(0u, 0x9E3779B9u, 0x3C6EF372u);
    uvec3 whole = (lattice >> 8) + uvec3(notEqual(lattice & 255u, uvec3(0u)));
    uvec3 level = (lattice - whole) >> 24;  // lattice * 255 / 2^32 in 32 bits
    return (vec3(level) - 127.0) / 256.0;
}

void main() {
    vec2 px = vec2(gl_FragCoord.x - place.x, place.y - gl_FragCoord.y);
    vec2 step = place.zw;
    vec2 uv = (px - 0.5) * step;
    vec2 middle = px * step;
    vec3 color = background;
    if (all(greaterThanEqual(middle, vec2(0.0))) && all(lessThan(middle, vec2(1.0)))) {
        bool right = mode == MODE_B || (mode == MODE_WIPE && middle.x >= wipe);
        if (mode == MODE_DIFFERENCE) {
            color = abs(shown_a(uv, step) - shown_b(uv, step)) * difference_gain;
        } else if (right) {
            color = shown_b(uv, step);
        } else {
            color = shown_a(uv, step);
        }
        if (dithered != 0) color += dither(uvec2(max(px, vec2(0.0)))) / 255.0;
        // The line between the two is one pixel wide, light where the picture is dark.
        bool on_line = floor(px.x) == floor(wipe / step.x) && wipe > 0.0 && wipe < 1.0;
        if (mode == MODE_WIPE && on_line)
            color = vec3(dot(color, vec3(1.0 / 3.0)) < 0.5 ? 0.9 : 0.1);
    }
    shown = vec4(color, 1.0);
}

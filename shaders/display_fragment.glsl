// A pixel of an image on the screen: through exposure and view transform, alone, under another one or less another one.
// The transform is that of engine/output/format.cpp for frames without alpha. What is chosen per image comes as defines
// (a software rasteriser runs both sides of a branch): VIEW and VIEW_B of the images, TAPS_A and TAPS_B reads per axis,
// DITHER; CHANNEL what is seen of a pixel, GAMMA bends it; OVER lays B over A, DIFFERENCE takes it from A; MASKED: alpha
// is 1 where B lies, else 0.

const int VIEW_LINEAR = 0;
const int VIEW_SRGB = 1;
const int VIEW_SOFT = 2;
const int VIEW_NONE = 3;  // the image holds display values
const int VIEW_OCIO = 4;  // with WITH_OCIO: vec4 ocio_display(vec4), which stands before this file
const float NOT_COMPARED = 0.25;  // a grey darker than that of no difference

uniform sampler2D image_a;  // linear light, premultiplied, top row first
#if defined(DIFFERENCE) || defined(OVER)
#define WITH_B
uniform sampler2D image_b;
uniform vec2 b_origin, b_right, b_down;  // place in B of A's upper left corner, and steps of a px
uniform float b_opacity;
uniform float difference_gain;
#endif
uniform vec4 place;  // upper left corner of the image in px from the target's lower left; 1 / size
uniform float gain;  // 2^exposure
uniform float bend;  // 1 / gamma
uniform float codes;  // the target's largest of a channel; 0: it holds numbers

layout(location = 0) out vec4 shown;

// Mean over the pixel of the target, whose upper left corner is uv and whose sides are right and down.
vec4 read_image(sampler2D image, int taps, vec2 uv, vec2 right, vec2 down) {
    vec4 sum = vec4(0.0);
    for (int j = 0; j < taps; ++j)
        for (int i = 0; i < taps; ++i) {
            vec2 at = (vec2(i, j) + 0.5) / float(taps);
            sum += textureLod(image, uv + right * at.x + down * at.y, 0.0);
        }
    return sum / float(taps * taps);
}

vec3 soft_curve(vec3 x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }

vec3 srgb_curve(vec3 x) {
    vec3 bent = 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055;
    return mix(bent, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

// Negative values and NaN give 0.
vec3 apply_view(int view, vec3 light) {
    if (view == VIEW_NONE) return clamp(light, 0.0, 1.0);
#ifdef WITH_OCIO
    if (view == VIEW_OCIO) {
        vec3 shown = ocio_display(vec4(light * gain, 1.0)).rgb;
        return mix(vec3(0.0), min(shown, 1.0), greaterThan(shown, vec3(0.0)));
    }
#endif
    vec3 x = mix(vec3(0.0), light * gain, greaterThan(light, vec3(0.0)));
    if (view == VIEW_SOFT) x = soft_curve(min(x, vec3(1.0e6)));
    x = clamp(x, 0.0, 1.0);
    return view == VIEW_LINEAR ? x : srgb_curve(x);
}

float luminance(vec3 light) { return dot(light, vec3(0.2126, 0.7152, 0.0722)); }

// CHANNEL as Inspection::Channel.
vec3 shown_of(int view, vec4 read) {
#if CHANNEL == 6
    vec3 light = view != VIEW_NONE ? read.rgb * gain
                                   : mix(pow((max(read.rgb, 0.0) + 0.055) / 1.055, vec3(2.4)), read.rgb / 12.92,
                                         lessThanEqual(read.rgb, vec3(0.04045)));
    return band_color(band_of(luminance(light)));
#else
#if CHANNEL == 0
    vec3 value = apply_view(view, read.rgb);
#elif CHANNEL == 4
    vec3 value = vec3(clamp(read.a, 0.0, 1.0));
#elif CHANNEL == 5
    vec3 value = apply_view(view, vec3(luminance(read.rgb)));
#else
    vec3 value = apply_view(view, vec3(read[CHANNEL - 1]));
#endif
#ifdef GAMMA
    value = pow(value, vec3(bend));
#endif
    return value;
#endif
}

// As dither() in engine/output/format.cpp, in levels of 8 bits.
vec3 dither(uvec2 px) {
    uvec3 lattice = uvec3(px.x * 0xC13FA9A9u + px.y * 0x91E10DA5u) + uvec3(0u, 0x9E3779B9u, 0x3C6EF372u);
    uvec3 whole = (lattice >> 8) + uvec3(notEqual(lattice & 255u, uvec3(0u)));
    uvec3 level = (lattice - whole) >> 24;  // lattice * 255 / 2^32 in 32 bits
    return (vec3(level) - 127.0) / 256.0;
}

void main() {
    vec2 px = vec2(gl_FragCoord.x - place.x, place.y - gl_FragCoord.y);
    vec2 uv = (px - 0.5) * place.zw;
    vec3 color = shown_of(VIEW, read_image(image_a, TAPS_A, uv, vec2(place.z, 0.0), vec2(0.0, place.w)));
    float compared = 1.0;
#ifdef WITH_B
    vec2 uv_b = b_origin + b_right * (px.x - 0.5) + b_down * (px.y - 0.5);
    vec2 middle_b = uv_b + 0.5 * (b_right + b_down);
    compared = all(greaterThanEqual(middle_b, vec2(0.0))) && all(lessThanEqual(middle_b, vec2(1.0))) ? 1.0 : 0.0;
    vec3 other = shown_of(VIEW_B, read_image(image_b, TAPS_B, uv_b, b_right, b_down));
#endif
#ifdef OVER
    color = mix(color, other, b_opacity * compared);
#endif
#ifdef DIFFERENCE
    color = compared > 0.0 ? 0.5 + 0.5 * difference_gain * (color - other) : vec3(NOT_COMPARED);
#endif
#ifdef DITHER
    color += dither(uvec2(px)) / 255.0;
#endif
#ifdef MASKED
    shown = vec4(color, compared);
#else
    // A card's own rounding may be .6 of a code off.
    shown = vec4(codes > 0.0 ? floor(clamp(color, 0.0, 1.0) * codes + 0.5) / codes : color, 1.0);
#endif
}

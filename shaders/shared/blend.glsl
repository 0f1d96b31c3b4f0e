// Blending: how one splat hides what lies behind it. Per channel a splat adds s c and multiplies what is behind by
// B = 1 - min(1, s o), with s its opacity at the pixel, c its colour, o the occlusion colour from here. One that absorbs
// adds nothing and multiplies by B = (1 - s)^a, with an exponent a a channel. Needs maths.glsl.

const int BLEND_OVER = 0;
const int BLEND_ADD = 1;
const int BLEND_SCREEN = 2;
const int BLEND_LIGHTEN = 3;
const int BLEND_HYBRID = 4;
const int BLEND_ABSORB = 5;

// Angle in degrees, 0..90, whose cosine is c in [0, 1]. Abramowitz and Stegun 4.4.46; absolute error below 2e-6 deg.
float as_acos_deg(float c) {
    float p = -0.0012624911f;
    p = p * c + 0.0066700901f;
    p = p * c - 0.0170881256f;
    p = p * c + 0.0308918810f;
    p = p * c - 0.0501743046f;
    p = p * c + 0.0889789874f;
    p = p * c - 0.2145988016f;
    p = p * c + 1.5707963050f;
    return sqrt(max(0.0f, 1.0f - c)) * p * 57.2957795f;
}

// h of the hybrid blend: 0 (over) up to from_deg, 1 (screen) from to_deg on; cosine: |cos| of the angle between the
// layer's axis line and the ray to the splat.
float hybrid_amount(float cosine, float from_deg, float to_deg) {
    float theta = as_acos_deg(min(cosine, 1.0f));
    float span = to_deg - from_deg;
    float t = span > 0.0f ? clamp(as_div(theta - from_deg, span), 0.0f, 1.0f) : (theta >= to_deg ? 1.0f : 0.0f);
    return as_smooth(t);
}

// Occlusion colour o of one channel.
float blend_occlusion(int blend, float c, float h) {
    if (blend == BLEND_ADD) return 0.0f;
    if (blend == BLEND_SCREEN) return c;
    if (blend == BLEND_HYBRID) return mix(1.0f, min(1.0f, c), h);
    return 1.0f;
}

// Colours below 0 are exponents: a splat of such a colour absorbs, whatever its layer's blend.
bool blend_absorbs(int blend, float c) { return blend == BLEND_ABSORB || c < 0.0f; }

// The exponent of one channel of a splat that absorbs; `exponent` is its layer's.
float blend_exponent(int blend, float c, float exponent) { return blend == BLEND_ABSORB ? exponent : -c; }

// Elementary functions and hashing that C++ and GLSL compile alike (C++: core/shared_maths.h supplies the GLSL names). No
// fused multiply-add on the C++ side, so the bits are the same on every processor. Literals are 1.0f; no out
// parameters; loops have constant bounds.

// e^x. Range reduction by ln 2 in two parts, Cephes polynomial; relative error below 2e-7. 0 below -87, inf above 88.
float as_exp(float x) {
    float n = floor(x * 1.44269504f + 0.5f);
    float r = (x - n * 0.693359375f) + n * 2.12194440e-4f;
    float p = 1.9875691500e-4f;
    p = p * r + 1.3981999507e-3f;
    p = p * r + 8.3334519073e-3f;
    p = p * r + 4.1665795894e-2f;
    p = p * r + 1.6666665459e-1f;
    p = p * r + 5.0000001201e-1f;
    p = p * (r * r) + r + 1.0f;
    float m = clamp(n, -126.0f, 127.0f);
    float scale = intBitsToFloat((int(m) + 127) << 23);
    float y = p * scale;
    y = x < -87.0f ? 0.0f : y;
    return x > 88.0f ? intBitsToFloat(0x7f800000) : y;
}

// Natural logarithm of x > 0 (normal numbers); relative error below 2e-7. x <= 0 gives -1e30.
float as_log(float x) {
    int bits = floatBitsToInt(x);
    int e = (bits >> 23) - 126;
    float m = intBitsToFloat((bits & 0x007fffff) | 0x3f000000);  // in [0.5, 1)
    bool small = m < 0.707106781f;
    e = small ? e - 1 : e;
    m = small ? m + m - 1.0f : m - 1.0f;
    float z = m * m;
    float p = 7.0376836292e-2f;
    p = p * m - 1.1514610310e-1f;
    p = p * m + 1.1676998740e-1f;
    p = p * m - 1.2420140846e-1f;
    p = p * m + 1.4249322787e-1f;
    p = p * m - 1.6668057665e-1f;
    p = p * m + 2.0000714765e-1f;
    p = p * m - 2.4999993993e-1f;
    p = p * m + 3.3333331174e-1f;
    float fe = float(e);
    float y = m * (z * p);
    y = y + fe * -2.12194440e-4f;
    y = y - 0.5f * z;
    y = (m + y) + fe * 0.693359375f;
    return x > 0.0f ? y : -1.0e30f;
}

// x^y for x >= 0; 0^0 = 1, 0^y = 0 for y > 0; x^1 is exactly x.
float as_pow(float x, float y) {
    float r = as_exp(y * as_log(x));
    r = x > 0.0f ? r : (y == 0.0f ? 1.0f : 0.0f);
    return y == 1.0f ? x : r;
}

// 0 to 1 with an even end on either side, of t in [0, 1].
float as_smooth(float t) { return t * t * (3.0f - 2.0f * t); }

// One round of a 32-bit mixer (Wellons' lowbias32: https://nullprogram.com/blog/2018/07/31/).
uint as_mix(uint x) {
    x = x ^ (x >> 16);
    x = x * 0x7feb352du;
    x = x ^ (x >> 15);
    x = x * 0x846ca68bu;
    return x ^ (x >> 16);
}

// Hash of (seed, id as two words, purpose): every random number of the program. Purposes are listed below so that no
// two decisions share one.
uint as_hash(uint seed, uint id_low, uint id_high, uint purpose) {
    uint h = as_mix(seed ^ (purpose * 0x9e3779b9u));
    h = as_mix(h ^ id_low);
    return as_mix(h + id_high * 0x85ebca6bu);
}

// Uniform in [0, 1) with 24 bits.
float as_uniform(uint h) { return float(h >> 8) * 5.9604644775390625e-8f; }

const uint PURPOSE_JITTER_X = 1u;
const uint PURPOSE_JITTER_Y = 2u;
const uint PURPOSE_JITTER_Z = 3u;
const uint PURPOSE_DENSITY = 4u;
const uint PURPOSE_RADIUS = 5u;
const uint PURPOSE_CHILD = 6u;        // level of detail: 6, 7, 8
const uint PURPOSE_CHILD_NOISE = 9u;  // its octaves
const uint PURPOSE_NAME = 16u;  // seeds from names
const uint PURPOSE_NOISE = 17u;
const uint PURPOSE_DEPTH = 18u;  // of a splat of a picture
const uint PURPOSE_KNOT = 19u;
const uint PURPOSE_STAR_PLACE = 20u;
const uint PURPOSE_STAR_KIND = 21u;
const uint PURPOSE_SKY_PATCH = 22u;  // of a tiled sky
const uint PURPOSE_SHEET = 25u;      // depths that dust has in a cell
const uint PURPOSE_EVEN = 23u;       // depths of bodies
const uint PURPOSE_DETAIL = 26u;     // noise below a picture's pixels
const uint PURPOSE_ROUNDING = 28u;      // of what files hold in few steps
const uint PURPOSE_DETAIL_PATCH = 27u;  // where details are looked for that are copied there

// Arithmetic with the bits that the processor has, for what decides a pixel on a graphics card. GLSL leaves a division
// 2.5 units in the last place, a square root what an inverse one has, and the order of min, mix and dot to the driver.
// NATIVE_DIVISION: the driver's own are IEEE 754's, as where it has no fused multiply-add.
#ifdef NATIVE_DIVISION
float as_div(float a, float b) { return a / b; }
float as_sqrt(float x) { return sqrt(x); }
#else
// Markstein: Computation of elementary functions on the IBM RISC System/6000 processor, 1990. Operands are brought to
// the middle of the exponents first, by powers of two; quotients that over- or underflow are not covered.
float as_div(float a, float b) {
    float size = abs(b);
    float power = size > 1.0e18f ? 5.421010862427522e-20f : (size < 1.0e-18f ? 1.8446744073709552e19f : 1.0f);
    float divisor = b * power;
    float inverse = 1.0f / divisor;
    inverse = fma(inverse, fma(-divisor, inverse, 1.0f), inverse);
    float quotient = a * inverse;
    quotient = fma(fma(-divisor, quotient, a), inverse, quotient);
    quotient = fma(fma(-divisor, quotient, a), inverse, quotient);
    float result = quotient * power;
    return b == 0.0f ? a / b : result;
}
float as_sqrt(float x) {
    bool tiny = x < 1.0e-30f;
    float square = tiny ? x * 1.8446744073709552e19f : x;
    float inverse = inversesqrt(square);
    float root = square * inverse;
    float half_inverse = 0.5f * inverse;
    float error = fma(-half_inverse, root, 0.5f);
    root = fma(root, error, root);
    half_inverse = fma(half_inverse, error, half_inverse);
    root = fma(fma(-root, root, square), half_inverse, root);
    root = fma(fma(-root, root, square), half_inverse, root);
    float result = tiny ? root * 2.3283064365386963e-10f : root;
    return x > 0.0f ? result : 0.0f;
}
#endif

// As vector instructions order them: the second where neither is less.
float as_min(float a, float b) { return a < b ? a : b; }
float as_max(float a, float b) { return a > b ? a : b; }
int as_min(int a, int b) { return a < b ? a : b; }
int as_max(int a, int b) { return a > b ? a : b; }
uint as_min(uint a, uint b) { return a < b ? a : b; }
float as_clamp(float x, float lo, float hi) { return as_min(as_max(x, lo), hi); }
float as_mix(float a, float b, float t) { return a * (1.0f - t) + b * t; }
float as_mix(float a, float b, bool take_b) { return take_b ? b : a; }
float as_dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
#define sqrt as_sqrt
#define min as_min
#define max as_max
#define clamp as_clamp
#define mix as_mix
#define dot as_dot

// One operation of those that decide a pixel, for many inputs: whether this card has the processor's bits. Needs maths.glsl.
layout(local_size_x = 256) in;
layout(std430, binding = 1) readonly buffer Inputs { vec4 inputs[]; };
layout(std430, binding = 2) writeonly buffer Results { float results[]; };
uniform uint count;

void main() {
    uint i = group_number() * GROUP + gl_LocalInvocationIndex;
    if (i >= count) return;
    float a = inputs[i].x, b = inputs[i].y, c = inputs[i].z;
    float result = 0.0f;
#if OPERATION == 0
    result = as_div(a, b);
#elif OPERATION == 1
    result = as_sqrt(abs(a));
#elif OPERATION == 2
    result = a * b + c;
#elif OPERATION == 3
    result = as_exp(c);
#elif OPERATION == 4
    result = as_log(abs(a));
#elif OPERATION == 5
    double sum = double(a) * double(b) + double(b) * double(c);
    sum = (sum + double(a) * double(c)) + double(c);
    result = float(sum);
#elif OPERATION == 6
    float near_whole = (c - 0.5f) + 12582912.0f;
    result = (c - (near_whole - 12582912.0f)) * floor(c * 256.0f + 0.5f);
#else
    result = a * 1.0e-30f + b * 1.0e-30f;
#endif
    results[i] = result;
}

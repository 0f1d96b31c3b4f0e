// Falloffs: the profile of a splat, w(t) with t = distance / radius; w(0) = 1 and zero from t = 1 on. Needs maths.glsl.

const int FALLOFF_CONSTANT = 0;
const int FALLOFF_LINEAR = 1;
const int FALLOFF_TRAPEZOID = 2;
const int FALLOFF_GAUSSIAN = 3;
const int FALLOFF_EXPONENTIAL = 4;

// core: fraction of the radius that is flat (trapezoid). sharpness: gaussian e^(-sharpness t^2), exponential
// e^(-sharpness t), both shifted and scaled so that w(0) = 1 and w(1) = 0.
float falloff_weight(int shape, float core, float sharpness, float t) {
    float w = 1.0f;
    if (shape == FALLOFF_LINEAR) {
        w = 1.0f - t;
    } else if (shape == FALLOFF_TRAPEZOID) {
        w = t <= core ? 1.0f : (1.0f - t) / (1.0f - core);
    } else if (shape == FALLOFF_GAUSSIAN || shape == FALLOFF_EXPONENTIAL) {
        float edge = as_exp(-sharpness);
        float x = shape == FALLOFF_GAUSSIAN ? t * t : t;
        w = (as_exp(-sharpness * x) - edge) / (1.0f - edge);
    }
    return t < 1.0f ? clamp(w, 0.0f, 1.0f) : 0.0f;
}

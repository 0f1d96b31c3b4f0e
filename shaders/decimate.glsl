// A share q of a layer that looks like the whole (DESIGN 10), as engine/look/decimate.h: alpha * radius^2 per splat
// grows by 1 / q.

float decimated_alpha(float alpha, float share, bool additive) {
    float full = alpha / share;
    return additive ? full : min(max(0.5, alpha), full);
}

// What the radius is multiplied by.
float decimated_radius(float alpha, float share, float shown_alpha) {
    return shown_alpha > 0.0 ? sqrt(alpha / (share * shown_alpha)) : 1.0;
}

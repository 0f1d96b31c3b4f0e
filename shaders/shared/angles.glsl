// Angles as floats or vectors of lanes, for projections onto spheres; where projections are compiled with doubles,
// core/real.h stands in. Absolute error below 3e-7.

// Of (x, y) from the x axis, -pi to pi; (0, 0) gives 0.
Float angle_of(Float y, Float x) {
    Float wide = abs(x), high = abs(y);
    Float larger = max(max(wide, high), 1e-37f), smaller = min(wide, high);
    // Tangents beyond pi / 8 are measured from pi / 4.
    Float t = as_div(smaller, larger);
    Bool far = t > 0.41421356f;
    t = mix(t, as_div(smaller - larger, smaller + larger), far);
    Float z = t * t;
    Float angle = (((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z - 3.33329491539e-1f) * z * t + t;
    angle = mix(angle, angle + 0.785398163f, far);
    angle = mix(angle, 1.57079633f - angle, high > wide);
    angle = mix(angle, 3.14159265f - angle, x < 0.0f);
    return mix(angle, -angle, y < 0.0f);
}

// Sine of `turns` quarter turns and the angle's rest to the nearest whole number of them, `rest_turns`. Cephes'
// polynomials within pi / 4.
Float sine_from(Float angle, Float rest_turns, Float turns) {
    Float r = (angle - rest_turns * 1.5703125f) - rest_turns * 4.83826794897e-4f;
    Float z = r * r;
    Float sine = ((-1.9515295891e-4f * z + 8.3321608736e-3f) * z - 1.6666654611e-1f) * z * r + r;
    Float cosine =
        ((2.443315711809948e-5f * z - 1.388731625493765e-3f) * z + 4.166664568298827e-2f) * z * z - 0.5f * z + 1.0f;
    Float which = turns - 4.0f * floor(turns * 0.25f);  // 0, 1, 2 or 3
    Float odd = which - 2.0f * floor(which * 0.5f);
    Float value = mix(sine, cosine, odd > 0.5f);
    return mix(value, -value, which > 1.5f);
}

// Of angles up to +-100.
Float sine_of(Float angle) {
    Float turns = floor(angle * 0.636619772f + 0.5f);
    return sine_from(angle, turns, turns);
}
Float cosine_of(Float angle) {
    Float turns = floor(angle * 0.636619772f + 0.5f);
    return sine_from(angle, turns, turns + 1.0f);
}

// False colours of light: bands of stops about middle grey (0.18), and of what is white and beyond it. Light is linear,
// 1 the white of the display.

const int BAND_COUNT = 9;

// Where a band begins: 0.18 * 2^stops for -6, -4, -2, -1/2, 1/2 and 3/2 stops; white, and two stops more.
float band_begin(int band) {
    if (band == 1) return 0.0028125f;
    if (band == 2) return 0.01125f;
    if (band == 3) return 0.045f;
    if (band == 4) return 0.12727922f;
    if (band == 5) return 0.25455844f;
    if (band == 6) return 0.50911688f;
    if (band == 7) return 1.0f;
    return band == 8 ? 4.0f : 0.0f;
}

// Of a display: from violet over blue, grey in the middle and yellow to red.
vec3 band_color(int band) {
    if (band == 1) return vec3(0.28f, 0.16f, 0.62f);
    if (band == 2) return vec3(0.13f, 0.4f, 0.86f);
    if (band == 3) return vec3(0.1f, 0.68f, 0.66f);
    if (band == 4) return vec3(0.46f, 0.46f, 0.46f);
    if (band == 5) return vec3(0.36f, 0.74f, 0.26f);
    if (band == 6) return vec3(0.96f, 0.88f, 0.25f);
    if (band == 7) return vec3(0.98f, 0.52f, 0.12f);
    return band == 8 ? vec3(0.9f, 0.12f, 0.14f) : vec3(0.1f, 0.04f, 0.18f);
}

int band_of(float light) {
    int band = 0;
    for (int i = 1; i < BAND_COUNT; ++i)
        if (light >= band_begin(i)) band = i;
    return band;
}

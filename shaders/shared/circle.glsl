// The place on the unit circle after so many turns in [0, 1], to the last bit of float: by Taylor's series in double up to pi
// / 4. circle_numbers: pi / 2; those of the sine from x^3 on; those of the cosine from x^4 on (engine/core/real.h).
vec2 on_circle(float turns) {
    double quarters = 4.0f * double(turns), rounded = quarters + 0.5f;
    int quadrant = int(rounded);  // 0..4
    double x = (quarters - double(quadrant)) * circle_numbers[0];
    double z = x * x, sine = circle_numbers[6], cosine = circle_numbers[13];
    for (int i = 5; i >= 1; --i) sine = sine * z + circle_numbers[i];
    for (int i = 12; i >= 7; --i) cosine = cosine * z + circle_numbers[i];
    double straight = 1.0f - 0.5f * z + z * z * cosine, up = x - x * z * sine;
    bool odd = (quadrant & 1) != 0;
    double across = odd ? up : straight;
    double along = odd ? straight : up;
    if (quadrant == 1 || quadrant == 2) across = -across;
    if (quadrant == 2 || quadrant == 3) along = -along;
    return vec2(float(across), float(along));
}

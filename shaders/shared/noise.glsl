// Gradient noise and its fractal sum, without tables or branches: the same integer hash on every side, so the field
// is a pure function of position and seed. Needs maths.glsl.

// Offset in [-1, 1] times a gradient chosen by hash h from the twelve directions to a cube's edges: h picks the
// component that is missing (thirds of 30 bits) and two signs.
float as_noise_corner(uint h, float x, float y, float z) {
    int missing = int(h & 0x3fffffffu);
    float a = missing < 0x15555555 ? y : x;
    float b = missing < 0x2aaaaaaa ? z : y;
    a = intBitsToFloat(floatBitsToInt(a) ^ int(h & 0x80000000u));
    b = intBitsToFloat(floatBitsToInt(b) ^ int((h << 1) & 0x80000000u));
    return a + b;
}

// Quintic fade (Perlin, Improving Noise, 2002): first and second derivatives vanish at 0 and 1.
float as_noise_fade(float t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); }

float as_noise_lerp(float a, float b, float t) { return a + t * (b - a); }

// Largest sum eight gradients can make anywhere in a cell is 1.0364 (a test climbs to it); 1 over a little more.
const float AS_NOISE_SCALE = 0.9645f;

// Odd multipliers near 2^32 over powers of the plastic number spread lattice points before mixing.
const uint AS_NOISE_KEY_X = 0xd1b54a33u, AS_NOISE_KEY_Y = 0xabc98389u, AS_NOISE_KEY_Z = 0x8cb92ba7u;

// Contribution of the lattice points of one plane z = const at (dx, dy) in a cell and dz above the plane; keys are
// those of the cell's corner. Linear in dz.
float as_noise_plane(uint key_x, uint key_y, uint key_z, float dx, float dy, float dz) {
    uint next_x = key_x + AS_NOISE_KEY_X;
    uint next_y = key_y + AS_NOISE_KEY_Y;
    float g00 = as_noise_corner(as_mix(key_x + key_y + key_z), dx, dy, dz);
    float g10 = as_noise_corner(as_mix(next_x + key_y + key_z), dx - 1.0f, dy, dz);
    float g01 = as_noise_corner(as_mix(key_x + next_y + key_z), dx, dy - 1.0f, dz);
    float g11 = as_noise_corner(as_mix(next_x + next_y + key_z), dx - 1.0f, dy - 1.0f, dz);
    float sx = as_noise_fade(dx);
    float sy = as_noise_fade(dy);
    return as_noise_lerp(as_noise_lerp(g00, g10, sx), as_noise_lerp(g01, g11, sx), sy);
}

// Gradient noise in [-1, 1], mean 0, one feature per unit; 0 on the integer lattice. |x|, |y|, |z| < 2^31.
float as_noise(float x, float y, float z, uint seed) {
    float x0 = floor(x);
    float y0 = floor(y);
    float z0 = floor(z);
    uint key_x = uint(int(x0)) * AS_NOISE_KEY_X;
    uint key_y = uint(int(y0)) * AS_NOISE_KEY_Y;
    uint key_z = uint(int(z0)) * AS_NOISE_KEY_Z + seed;
    float dz = z - z0;
    float near_z = as_noise_plane(key_x, key_y, key_z, x - x0, y - y0, dz);
    float far_z = as_noise_plane(key_x, key_y, key_z + AS_NOISE_KEY_Z, x - x0, y - y0, dz - 1.0f);
    return as_noise_lerp(near_z, far_z, as_noise_fade(dz)) * AS_NOISE_SCALE;
}

// Where octave i of a fractal sum is: its own field, shifted by less than a cell so that the zeros of the lattices of
// several octaves do not fall together (all of them would in the plane through the origin, where thin layers lie).
uint as_noise_field(uint seed, int octave) { return as_hash(seed, uint(octave), 3u, PURPOSE_NOISE); }
float as_noise_shift(uint seed, int octave, uint axis) {
    return as_uniform(as_hash(seed, uint(octave), axis, PURPOSE_NOISE));
}

float as_noise_octave(float x, float y, float z, float frequency, uint seed, int octave) {
    return as_noise(x * frequency + as_noise_shift(seed, octave, 0u), y * frequency + as_noise_shift(seed, octave, 1u),
                    z * frequency + as_noise_shift(seed, octave, 2u), as_noise_field(seed, octave));
}

const int AS_NOISE_MAX_OCTAVES = 16;

// fBm: sum over octaves of gain^i N_i(frequency lacunarity^i p), times `scale` = 1 / sum of gain^i: in [-1, 1], mean 0.
float as_fbm(float x, float y, float z, float frequency, int octaves, float lacunarity, float gain, float scale,
             uint seed) {
    float sum = 0.0f;
    float amplitude = scale;
    for (int i = 0; i < AS_NOISE_MAX_OCTAVES; ++i) {
        if (i < octaves) {
            sum = sum + amplitude * as_noise_octave(x, y, z, frequency, seed, i);
            amplitude = amplitude * gain;
            frequency = frequency * lacunarity;
        }
    }
    return sum;
}

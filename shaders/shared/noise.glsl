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

// Gradient noise in [-1, 1], mean 0, one feature per unit; 0 on the integer lattice. |x|, |y|, |z| < 2^31.
float as_noise(float x, float y, float z, uint seed) {
    float x0 = floor(x);
    float y0 = floor(y);
    float z0 = floor(z);
    float dx = x - x0;
    float dy = y - y0;
    float dz = z - z0;
    // Odd multipliers near 2^32 over powers of the plastic number spread lattice points before mixing.
    uint kx0 = uint(int(x0)) * 0xd1b54a33u;
    uint ky0 = uint(int(y0)) * 0xabc98389u;
    uint kz0 = uint(int(z0)) * 0x8cb92ba7u + seed;
    uint kx1 = kx0 + 0xd1b54a33u;
    uint ky1 = ky0 + 0xabc98389u;
    uint kz1 = kz0 + 0x8cb92ba7u;
    float g000 = as_noise_corner(as_mix(kx0 + ky0 + kz0), dx, dy, dz);
    float g100 = as_noise_corner(as_mix(kx1 + ky0 + kz0), dx - 1.0f, dy, dz);
    float g010 = as_noise_corner(as_mix(kx0 + ky1 + kz0), dx, dy - 1.0f, dz);
    float g110 = as_noise_corner(as_mix(kx1 + ky1 + kz0), dx - 1.0f, dy - 1.0f, dz);
    float g001 = as_noise_corner(as_mix(kx0 + ky0 + kz1), dx, dy, dz - 1.0f);
    float g101 = as_noise_corner(as_mix(kx1 + ky0 + kz1), dx - 1.0f, dy, dz - 1.0f);
    float g011 = as_noise_corner(as_mix(kx0 + ky1 + kz1), dx, dy - 1.0f, dz - 1.0f);
    float g111 = as_noise_corner(as_mix(kx1 + ky1 + kz1), dx - 1.0f, dy - 1.0f, dz - 1.0f);
    float sx = as_noise_fade(dx);
    float sy = as_noise_fade(dy);
    float near_z = as_noise_lerp(as_noise_lerp(g000, g100, sx), as_noise_lerp(g010, g110, sx), sy);
    float far_z = as_noise_lerp(as_noise_lerp(g001, g101, sx), as_noise_lerp(g011, g111, sx), sy);
    return as_noise_lerp(near_z, far_z, as_noise_fade(dz)) * AS_NOISE_SCALE;
}

// Octave i of a fractal sum: its own field, shifted by less than a cell so that the zeros of the lattices of several
// octaves do not fall together (all of them would in the plane through the origin, where thin layers lie).
float as_noise_octave(float x, float y, float z, float frequency, uint seed, int octave) {
    float shift_x = as_uniform(as_hash(seed, uint(octave), 0u, PURPOSE_NOISE));
    float shift_y = as_uniform(as_hash(seed, uint(octave), 1u, PURPOSE_NOISE));
    float shift_z = as_uniform(as_hash(seed, uint(octave), 2u, PURPOSE_NOISE));
    uint field = as_hash(seed, uint(octave), 3u, PURPOSE_NOISE);
    return as_noise(x * frequency + shift_x, y * frequency + shift_y, z * frequency + shift_z, field);
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

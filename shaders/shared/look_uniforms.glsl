// What the look of one layer is made of once its scene keys are resolved: plain numbers in fixed-size arrays, the
// same struct in C++ and in a shader. engine/look/prepare.h fills it; look.glsl reads it.

const int LOOK_MAX_KEYS = 8;     // thickness keys
const int LOOK_MAX_NOISES = 4;   // entries of the noise list
const int LOOK_MAX_POINTS = 16;  // points of one curve

// Shapes of a profile over x = distance / reach.
const int PROFILE_CONSTANT = 0;
const int PROFILE_LINEAR = 1;
const int PROFILE_QUADRATIC = 2;
const int PROFILE_EXPONENTIAL = 3;
const int PROFILE_GAUSSIAN = 4;
const int PROFILE_SMOOTH = 5;
const int PROFILE_S106 = 6;
const int PROFILE_CURVE = 7;

// How the vertical profile is scaled to the picture's alpha.
const int MATCH_NONE = 0;
const int MATCH_PLANES = 1;         // the sum over lattice planes
const int MATCH_LIGHT = 2;          // coverage, for blends that add
const int MATCH_TRANSMITTANCE = 3;  // coverage, for blends that cover

// Monotone cubic through points; constant outside.
struct LookCurve {
    int count;                    // 1 .. LOOK_MAX_POINTS
    vec4 knots[LOOK_MAX_POINTS];  // x, y, tangent, unused; x ascending
};

struct LookProfile {
    int shape;
    float rate;  // exponential: e^(-rate x); gaussian: e^(-rate x^2), that is 1 / (2 sigma^2)
    LookCurve curve;
};

struct LookKey {
    vec3 color;    // raw map value
    float scale;   // of reach
    float column;  // mean of a front-view column per scene unit of reach, before the horizontal radius factor
    LookProfile pdf;
};

struct LookNoise {
    float frequency;
    float lacunarity;
    float gain;
    float scale;  // 1 / sum of gain^i
    int octaves;
    uint seed;
    float cull;
    float silhouette;
    float jitter;
    float alpha;
    float brightness;
};

struct LookUniforms {
    uint seed;
    vec3 axis;      // unit vector
    float reach;    // scene units
    float density;
    int key_count;  // at least 1; weights come from the map where it is more
    LookKey keys[LOOK_MAX_KEYS];
    int noise_count;
    LookNoise noises[LOOK_MAX_NOISES];
    int unpremultiply;  // 0 or 1
    float alpha_threshold;
    float alpha_power;
    float alpha_gain;
    LookProfile vertical;
    float vertical_reach;  // scene units; 0: as the layer's
    int match;
    int own_radius;  // 1: the splat's own radius, 0: uniform between the two
    float radius_min;
    float radius_max;
    float horizontal_scale;
    float vertical_scale;
    float black;
    vec3 tint;  // gain * tint
    float saturation;
    float inverse_gamma;
};

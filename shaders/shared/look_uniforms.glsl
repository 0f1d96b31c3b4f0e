// The look of one layer once its scene keys are resolved: plain numbers in fixed-size arrays, the
// same struct in C++ and in a shader. engine/look/prepare.h fills it; look.glsl reads it. Members stand in rows of
// four words, vec3 before its float, and every struct is whole rows: so std140 places them as C++ does, and the
// card gets the struct as it is. engine/look/shared_uniforms.h checks the rows.

const int LOOK_MAX_STOPS = 8;     // thickness stops
const int LOOK_MAX_NOISES = 4;   // entries of the noise list
const int LOOK_MAX_POINTS = 16;  // points of one curve
const int LOOK_MAX_CROPS = 8;

// Shapes of a profile over x = distance / reach.
const int PROFILE_CONSTANT = 0;
const int PROFILE_LINEAR = 1;
const int PROFILE_QUADRATIC = 2;
const int PROFILE_EXPONENTIAL = 3;
const int PROFILE_GAUSSIAN = 4;
const int PROFILE_SMOOTH = 5;
const int PROFILE_CURVE = 6;
const int PROFILE_S106 = 7;

// How the vertical profile is scaled to the picture's alpha.
const int MATCH_NONE = 0;
const int MATCH_PLANES = 1;         // the sum over lattice planes
const int MATCH_LIGHT = 2;          // coverage, for blends that add
const int MATCH_TRANSMITTANCE = 3;  // coverage, for blends that cover
const int MATCH_SCREEN = 4;         // the same, and colours whose screened column shows the picture's light

// Monotone cubic through points; constant outside.
struct LookCurve {
    vec4 knots[LOOK_MAX_POINTS];  // x, y, tangent, unused; x ascending
    int count;                    // 1 .. LOOK_MAX_POINTS
    int unused_0;
    int unused_1;
    int unused_2;
};

struct LookProfile {
    LookCurve curve;
    int shape;
    float rate;  // exponential: e^(-rate x); gaussian: e^(-rate x^2), that is 1 / (2 sigma^2)
    int unused_0;
    int unused_1;
};

struct LookStop {
    vec3 color;    // raw map value
    float scale;   // of reach
    LookProfile pdf;
    float column;  // mean of a front-view column per scene unit of reach, before the horizontal radius factor
    int unused_0;
    int unused_1;
    int unused_2;
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
    int unused_0;
};

// A box with rounded edges: of a sphere nothing but the rounding is left.
struct LookCrop {
    vec3 center;   // layer space
    float radius;  // of the rounding

    vec3 x;  // unit vectors along the box's sides, and half of their lengths
    float half_x;

    vec3 y;
    float half_y;

    vec3 z;
    float half_z;

    float soft;   // scene units, width of the band over which opacity falls
    int outside;  // 1: what lies outside is kept
    int unused_0;
    int unused_1;
};

// What lies behind lines that were drawn in a view: one stroke, or polygons. Not in the uniforms: their block stays small, and what applies
// a look on a card leaves looks with outlines to the processor.
struct LookOutline {
    vec3 eye;          // layer space
    float half_width;  // of a stroke; 0: its edges close a polygon

    vec3 right;  // unit vectors of the view; forward is the line of sight
    float soft;  // scene units

    vec3 up;
    int outside;

    vec3 forward;
    int parallel;  // 1: rays do not meet in the eye

    vec4 bounds;  // of its points: least x and y, largest x and y
    int first_edge;
    int edge_count;
    int goes_on;  // 1: the next one is of the same crop, inside of which is what is inside of either
    int unused_0;
};

// Between two points of an outline.
struct LookEdge {
    float x;
    float y;
    float dx;  // to its end
    float dy;
    float per_length2;  // 1 / (dx^2 + dy^2), 0 where that is 0
    float slope;        // dx / dy, 0 where it is level
    float end_y;        // as the next edge has it
    int unused_0;
};

// Step 4.
struct LookAlpha {
    float threshold;
    float power;
    float gain;
    int unpremultiply;  // 0 or 1
};

// Step 6.
struct LookRadius {
    float smallest;  // scene units; uniform between the two
    float largest;
    float horizontal_scale;
    float vertical_scale;

    int own;  // 1: the splat's own radius instead
    int unused_0;
    int unused_1;
    int unused_2;
};

// Step 7.
struct LookGrade {
    vec3 tint;  // gain * tint
    float black;

    float saturation;
    float inverse_gamma;
    int unused_0;
    int unused_1;
};

struct LookUniforms {
    vec3 axis;    // unit vector
    float reach;  // scene units

    float density;
    uint seed;
    int stop_count;  // at least 1; weights come from the map where it is more
    int noise_count;

    int crop_count;
    int absorbs;  // 1: colours below 0 mean splats that absorb, whose colour and alpha stay
    int match;
    float vertical_reach;  // scene units; 0: as the layer's

    LookAlpha alpha;
    LookRadius radius;
    LookGrade grade;
    LookProfile vertical;
    LookStop stops[LOOK_MAX_STOPS];
    LookNoise noises[LOOK_MAX_NOISES];
    LookCrop crops[LOOK_MAX_CROPS];
};

// Level of detail: how a splat that is too large on screen becomes smaller ones (engine/render/lod.h).

// Levels to draw for one splat. Level 0 is the splat itself, level n has 4^n children. `fade` is the share of the finer
// one, in [0, 1]; when it is 1 only the finer level is drawn, when both levels are 0 the splat is drawn as it is.
struct LevelChoice {
    int coarse;
    int fine;
    float fade;
};

// Alphas of one splat of each level.
struct ChildAlphas {
    float coarse;
    float fine;
};

struct LevelShade {
    float alpha;
    vec3 color;
};
struct LevelShades {
    LevelShade coarse;
    LevelShade fine;
};

// One octave of the noise that children's light has.
struct ChildOctave {
    float frequency;  // per scene unit, a power of two: the same field for splats of every size
    float amplitude;  // factor of the noise in the exponent; 0: there is no such octave
    vec3 shift;       // of the field, cells
    uint seed;
    float offset;  // of the exponent: makes the mean over space 1
};

const int CHILD_OCTAVES = 12;
const int CHILD_FINEST_LEVEL = 12;

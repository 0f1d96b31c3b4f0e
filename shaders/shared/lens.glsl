// A camera as projection needs it: the kind of projection and its numbers. C++ compiles it with floats, for splats, and
// with doubles, for rays.

#ifndef __cplusplus
#define Real float
#endif

const int PROJECTION_PERSPECTIVE = 0;
const int PROJECTION_ORTHOGRAPHIC = 1;

struct Lens {
    int projection;    // one of the above
    Real focal_px;     // px per unit of x / z; with parallel rays px per scene unit
    Real center_x_px;  // where the optical axis meets the frame, y down
    Real center_y_px;
    Real near;         // scene units, of what the projection calls depth
    Real far;          // 0: none
    Real near_fade;    // scene units; 0: one radius of the splat
};

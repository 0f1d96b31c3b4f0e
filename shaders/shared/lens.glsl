// A camera as projection needs it: the kind of projection and its numbers. C++ compiles it with floats, for splats, and
// with doubles, for rays.

#ifndef __cplusplus
#define Real float
#define Float float
#define Int int
#define Bool bool
#define Vec3 vec3
#endif

const Real SPHERE_TURN = Real(6.283185307179586);  // radians all the way round

struct Lens {
    int projection;    // the number of its file
    Real focal_px;     // px per unit of x / z; with parallel rays px per scene unit; onto the sphere px per radian
    Real center_x_px;  // where the optical axis meets the frame, y down
    Real center_y_px;
    Real near;         // scene units, of what the projection calls depth
    Real far;          // 0: none
    Real near_fade;    // scene units; 0: one radius of the splat
    Real edge;         // radians from the middle to where the picture ends: a fisheye's cone, a panorama's width; else 0
    Real parallax;     // scene units to the left of the middle between two eyes, of a panorama's; else 0
};

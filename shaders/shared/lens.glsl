// A camera as projection needs it: the kind of projection and its numbers. C++ compiles it with floats, for splats, and
// with doubles, for rays.

#ifndef __cplusplus
#define Real float
#define Float float
#define Int int
#define Bool bool
#define Vec3 vec3
#endif

// In the order of Projection in engine/camera/camera.h. Those from the fisheye on are onto the sphere.
const int PROJECTION_PERSPECTIVE = 0;
const int PROJECTION_ORTHOGRAPHIC = 1;
const int PROJECTION_FISHEYE = 2;
const int PROJECTION_EQUIRECTANGULAR = 3;
const int PROJECTION_CYLINDRICAL = 4;

const Real SPHERE_TURN = Real(6.283185307179586);  // radians all the way round

struct Lens {
    int projection;    // one of the above
    Real focal_px;     // px per unit of x / z; with parallel rays px per scene unit; onto the sphere px per radian
    Real center_x_px;  // where the optical axis meets the frame, y down
    Real center_y_px;
    Real near;         // scene units, of what the projection calls depth
    Real far;          // 0: none
    Real near_fade;    // scene units; 0: one radius of the splat
    Real edge;         // radians from the middle to where the picture ends: a fisheye's cone, a panorama's width; else 0
    Real parallax;     // scene units to the left of the middle between two eyes, of a panorama's; else 0
};

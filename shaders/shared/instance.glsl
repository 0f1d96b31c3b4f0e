// A splat on the frame, as projection places it. Compiled as GLSL and as C++, one by one and by lanes: there Float, Int, Bool and
// Vec3 are vectors of lanes.

// One appearance of a splat in the frame. A ball's footprint is a circle.
struct Instance {
    Float x_px;         // centre, y down
    Float y_px;
    Float px_per_unit;  // px per scene unit of the splat's radius
    Float depth;        // what near, far and near fade mean, scene units
};

// The camera: what [camera] says (CameraParams) and the resolved double-precision camera made of it; and its
// samples for motion blur and depth of field. Camera space: x right, y up, looking along -z.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "camera/lens.h"
#include "core/bounds.h"
#include "core/text.h"

namespace astrosplat {

enum class Projection { perspective, orthographic, fisheye, equirectangular, cylindrical };
constexpr auto names_of(Projection) {
    return names_up_to<Projection::cylindrical>("perspective", "orthographic", "fisheye", "equirectangular",
                                                "cylindrical");
}

/// The frame shows directions, not points of a plane.
constexpr bool is_onto_sphere(Projection projection) { return projection >= Projection::fisheye; }

/// Whether a projection has a left and a right eye.
constexpr bool has_two_eyes(Projection projection) {
    return projection == Projection::perspective || projection == Projection::equirectangular ||
           projection == Projection::cylindrical;
}

/// The eye of a stereo pair that a frame is seen with.
enum class Eye { centre, left, right };
constexpr auto names_of(Eye) { return names_up_to<Eye::right>("centre", "left", "right"); }

/// Which axis of a camera file is up; auto: the file's own word, or its format's habit.
enum class CameraFileUp { automatic, y, z };
constexpr auto names_of(CameraFileUp) { return names_up_to<CameraFileUp::z>("auto", "y", "z"); }

struct CameraParams {
    Projection projection = Projection::perspective;
    std::optional<glm::dvec3> position;  // empty: frame all visible layers from 35 degrees above +z
    glm::dvec3 target{0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    /// Quaternion x y z w, world from camera; replaces target, up and roll.
    std::optional<glm::dvec4> rotation;
    double roll = 0.0;          // degrees; > 0 turns the camera clockwise as seen from behind it
    double fov = 45.0;          // degrees, vertical
    double focal_length = 0.0;  // mm; > 0 replaces fov, with film_width
    double film_width = 36.0;   // mm
    glm::dvec2 shift{0.0};  // of what the frame shows, its widths to the right and heights up; perspective
    double fisheye_fov = 180.0;  // degrees, full cone: the frame's shorter side
    /// Degrees by which a fisheye's axis points above the target; at 90 the target lies on the lower rim of
    /// a dome that is level.
    double fisheye_tilt = 0.0;
    double panorama_fov = 360.0;  // degrees, from the left to the right of a panorama
    double height = 10.0;         // scene units, orthographic
    double shutter = 0.0;   // degrees of a frame's 360, half before and half after it; 0: no motion blur
    double f_number = 0.0;  // > 0: depth of field; perspective
    double focus_distance = 0.0;    // scene units along the view axis; 0: to the target
    double unit_mm = 1000.0;        // mm of a scene unit, for depth of field
    Eye eye = Eye::centre;          // perspective and panoramas have two
    double eye_separation = 0.065;  // scene units
    double convergence = 0.0;       // scene units along the view axis; 0: to the target
    double near = 0.01;             // scene units
    double far = 0.0;               // scene units; 0: none
    double near_fade = 0.0;         // scene units; 0: one radius of the splat
    fs::path file;                  // another program's camera (scene/camera_file.h); "": none
    double file_scale = 1.0;        // scene units per unit of the file
    CameraFileUp file_up = CameraFileUp::automatic;
    double file_offset = 0.0;  // frames added to those of the file
    double file_fps = 0.0;     // 1/s; 0: as the file says
    bool operator==(const CameraParams&) const = default;
};

struct Camera {
    Projection projection = Projection::perspective;
    glm::dvec3 eye{0.0};
    glm::dmat3 world_from_camera{1.0};  // rotation only; columns are the camera's x, y, z axes in world space
    /// Perspective: px per unit of x/z; orthographic: px per scene unit; onto the sphere: px per radian.
    double focal_px = 1.0;
    double center_x_px = 0.0, center_y_px = 0.0;  // where the optical axis meets the frame (y down)
    double near = 0.01, far = 0.0, near_fade = 0.0;
    double edge = 0.0;      // as in Lens
    double parallax = 0.0;  // as in Lens
    double aspect = 1.0;    // width / height
    /// Scene units to the point that it looks at: along the view axis, of a camera with a rotation in a
    /// straight line. What convergence and focus are measured to where they are 0.
    double target_distance = 0.0;
};

/// Resolves the parameters for a frame of width x height px. `scene_box` (may be empty) is what a camera
/// without position frames: its place, target and (orthographic) height then come from frame_box; a rotation
/// is kept. Where the view is parallel to up, -z is up, else +x. Throws InputError for values out of range,
/// and a zero view direction.
Camera make_camera(const CameraParams& params, double width_px, double height_px, const Bounds& scene_box);

/// The camera as the projections of shaders/shared take it (camera/projection.h).
Lens make_lens(const Camera& camera);
ExactLens make_exact_lens(const Camera& camera);

/// Where the camera looks: a unit vector in world space.
inline glm::dvec3 view_direction(const Camera& camera) { return -camera.world_from_camera[2]; }
/// The unit direction in which it sees a place; where it looks if rays are parallel or the eye is there.
glm::dvec3 direction_to(const Camera& camera, const glm::dvec3& place);

/// Whether the camera shows anything at a point of the frame: outside a fisheye's circle it does not.
bool shows(const Camera& camera, double x_px, double y_px);
/// Unit direction in world space through a point of the frame (px, y down), for environments.
glm::dvec3 ray_direction(const Camera& camera, double x_px, double y_px);
/// Angle between the rays of neighbouring pixels in the middle of the frame, radians;
/// 0 where rays are parallel.
double pixel_spread(const Camera& camera);

/// 4x4 row-major matrices as OpenEXR defines them (row vectors: p * M): camera space is left-handed with z
/// forward; NDC, after division by w, runs from (0, 0) at the upper left to (1, 1) at the lower right of the
/// whole frame.
struct ExrMatrices {
    float world_to_camera[16];
    float world_to_ndc[16];
};
ExrMatrices exr_matrices(const Camera& camera, double width_px, double height_px);

/// Rotation matrix from a quaternion x y z w of any length (0: InputError).
glm::dmat3 rotation_from_quaternion(const glm::dvec4& q);

/// Whether a frame is more than one rendering: motion blur or depth of field.
inline bool is_blurred(const CameraParams& params) {
    return params.shutter > 0.0 || (params.f_number > 0.0 && params.projection == Projection::perspective);
}
/// One of the renderings that a blurred frame is the mean of.
struct CameraSample {
    double frames = 0.0;   // after the frame's own time
    glm::dvec2 lens{0.0};  // place on the aperture, in the unit disc
};
/// Sample i of n: moments evenly spread over the open shutter, places on a sunflower's (Vogel's) spiral over
/// the aperture, in an order that does not depend on the moments.
CameraSample camera_sample(const CameraParams& params, int i, int n);
/// The camera moved to a place of the aperture (unit disc) and shifted so that the plane of focus, which lies
/// across the view axis, stays where it is on the frame. `params` are those that make_camera
/// made `camera` of.
Camera through_lens(const Camera& camera, const CameraParams& params, const glm::dvec2& lens,
                    double width_px);

}  // namespace astrosplat

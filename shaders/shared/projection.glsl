// Projection: camera space (x right, y up, in front is -z) to the frame. To the renderer and to cards all
// projections are alike. Each is a file of its number and functions with its name in front, listed in projections.inc,
// lines in the table below, and what make_camera makes of its parameters. Numbers are those of Projection in
// engine/camera/camera.h, from the fisheye on onto the sphere.
//
// Projections onto the sphere draw a splat as a disc there, round in the chord between directions: a pixel's distance is
// focal_px * |direction of the pixel - direction of the splat|, whatever the frame makes of the sphere, so there are no
// seams and no poles. Chords make the light right at every size, for a cap with the chord c has the solid angle pi c^2.
// Needs lens.glsl, instance.glsl, angles.glsl and the files of the projections.

// Rays do not come from the eye but are parallel to the view axis.
bool has_parallel_rays(Lens lens) { return lens.projection == PROJECTION_ORTHOGRAPHIC; }

// The frame shows directions, all of one length, not points of a plane.
bool is_onto_sphere(Lens lens) { return lens.projection >= PROJECTION_FISHEYE; }

// Both panoramas: what leaves the frame to the right comes back on the left where it is wide enough.
bool is_panorama(Lens lens) {
    return lens.projection == PROJECTION_EQUIRECTANGULAR || lens.projection == PROJECTION_CYLINDRICAL;
}

// The table: what is different from projection to projection. A projection without lines here is drawn as perspective,
// and camera_test.cpp says so.

// Where a splat at p appears.
Instance instance_of(Lens lens, Vec3 p) {
    if (lens.projection == PROJECTION_ORTHOGRAPHIC) return orthographic_instance(lens, p);
    if (lens.projection == PROJECTION_FISHEYE) return fisheye_instance(lens, p);
    if (is_panorama(lens)) return panorama_instance(lens, p);
    return perspective_instance(lens, p);
}

// Direction through a point of the frame, of any length.
Vec3 ray_through(Lens lens, Float x_px, Float y_px) {
    if (has_parallel_rays(lens)) return Vec3(0.0f, 0.0f, -1.0f);
    if (lens.projection == PROJECTION_FISHEYE) return fisheye_ray(lens, x_px, y_px);
    if (is_panorama(lens)) return panorama_ray(lens, x_px, y_px);
    return perspective_ray(lens, x_px, y_px);
}

// Whether anything can be seen there.
Bool shows(Lens lens, Float x_px, Float y_px) {
    if (lens.projection == PROJECTION_FISHEYE) return fisheye_shows(lens, x_px, y_px);
    if (is_panorama(lens)) return panorama_shows(lens, x_px, y_px);
    return x_px < 3e38f;
}

// Half the width of a square around a place on the frame that holds all within reach_px of it, those px measured in the
// middle of the frame.
Float frame_reach_px(Lens lens, Float x_px, Float y_px, Float reach_px) {
    if (!is_onto_sphere(lens)) return reach_px;
    Float half_chord = min(as_div(0.5f * reach_px, lens.focal_px), 1.0f);
    Float angle = 2.0f * angle_of(half_chord, sqrt(max(1.0f - half_chord * half_chord, 0.0f)));
    // A px more, for places are rounded.
    if (is_panorama(lens)) return panorama_reach_px(lens, y_px, angle) + 1.0f;
    return fisheye_reach_px(lens, x_px, y_px, angle) + 1.0f;
}

// The point that appears there at a depth.
Vec3 point_at_depth(Lens lens, Float x_px, Float y_px, Float depth) {
    if (lens.projection == PROJECTION_ORTHOGRAPHIC) return orthographic_point(lens, x_px, y_px, depth);
    if (is_onto_sphere(lens)) {
        if (lens.parallax != 0.0f) x_px = x_px - panorama_parallax(lens, depth) * lens.focal_px;
        Vec3 ray = ray_through(lens, x_px, y_px);
        Float scale = as_div(depth, sqrt(dot(ray, ray)));
        return Vec3(ray.x * scale, ray.y * scale, ray.z * scale);
    }
    return perspective_point(lens, x_px, y_px, depth);
}

// Angle between the rays of neighbouring pixels, radians.
Real pixel_spread(Lens lens) { return has_parallel_rays(lens) ? 0.0f : perspective_spread(lens); }

// Depth of a splat along the view axis (onto the sphere: from the eye) from its place in the frame and its sort depth.
Float axis_depth(Lens lens, Float x_px, Float y_px, Float depth) {
    if (has_parallel_rays(lens)) return depth;
    if (is_onto_sphere(lens)) return sqrt(depth);
    return perspective_axis_depth(lens, x_px, y_px, depth);
}

// The same for all of them.

// Sorts as the distance from the eye (parallel rays: from the plane through it) does.
Float sort_depth(Lens lens, Vec3 p) {
    if (has_parallel_rays(lens)) return -p.z;
    return dot(p, p);
}

// |cos| of the angle between a layer's axis and the ray to p.
Float axis_cosine(Lens lens, Vec3 axis, Vec3 p) {
    if (has_parallel_rays(lens)) return abs(axis.z);
    return as_div(abs(dot(axis, p)), sqrt(dot(p, p)));
}

// To the raster that footprints are normalised for.
Float snap_px(Float px) { return floor(px * 256.0f + 0.5f) * (1.0f / 256.0f); }

// Px after which the frame shows the same again, to the right, on that raster; 0: never.
Real period_px(Lens lens) {
    Real turn_px = SPHERE_TURN * lens.focal_px;
    return is_panorama(lens) ? floor(turn_px * 256.0f + 0.5f) * (1.0f / 256.0f) : 0.0f;
}

Bool is_in_range(Lens lens, Float depth) {
    Real far = lens.far > 0.0f ? lens.far : 3.4e38f;
    return depth > lens.near && depth <= far;
}

// Rises from 0 at the near plane to 1 where the splat is a radius (or near_fade) behind it.
Float near_fade(Lens lens, Float depth, Float radius) {
    Float t = min(1.0f, as_div(depth - lens.near, max(lens.near_fade, radius)));
    return t * t * (3.0f - 2.0f * t);
}

// p, or where it would be were it no nearer than near.
Vec3 beyond_near(Lens lens, Vec3 p) {
    if (is_onto_sphere(lens)) {
        Float scale = max(as_div(lens.near, max(sqrt(dot(p, p)), 1e-18f)), 1.0f);
        return Vec3(p.x * scale, p.y * scale, p.z * scale);
    }
    return Vec3(p.x, p.y, min(p.z, -lens.near));
}

// How far from where p appears anything within `reach` scene units of it can, with a margin; all of it lies beyond near.
Float reach_px(Lens lens, Vec3 p, Float reach, Float margin_px) {
    Instance at = instance_of(lens, p);
    if (is_onto_sphere(lens)) {
        // The chord of the angle whose sine is reach / distance.
        Float sine = min(as_div(reach * at.px_per_unit, lens.focal_px), 1.0f);
        Float chord = sqrt(max(2.0f - 2.0f * sqrt(max(1.0f - sine * sine, 0.0f)), 0.0f));
        if (lens.parallax != 0.0f)
            chord = chord + abs(panorama_parallax(lens, max(sqrt(dot(p, p)) - reach, Float(lens.near))));
        return frame_reach_px(lens, at.x_px, at.y_px, chord * lens.focal_px + margin_px);
    }
    Instance nearest = instance_of(lens, Vec3(p.x, p.y, p.z + reach));
    Float moved_px = abs(nearest.x_px - at.x_px) + abs(nearest.y_px - at.y_px);
    return reach * nearest.px_per_unit + margin_px + moved_px;
}

// Whether a square around a splat touches a rectangle from (x0, y0) to (x1, y1).
Bool touches_rect(Float x_px, Float y_px, Float reach_px, float x0, float y0, float x1, float y1) {
    Float right = x_px + reach_px, left = x_px - reach_px, bottom = y_px + reach_px, top = y_px - reach_px;
    return right > x0 && left < x1 && bottom > y0 && top < y1;
}

// The same for all places at which the frame shows it.
Bool appears_in_rect(Lens lens, Float x_px, Float y_px, Float reach_px, float x0, float y0, float x1, float y1) {
    Bool touches = touches_rect(x_px, y_px, reach_px, x0, y0, x1, y1);
    Real period = period_px(lens);
    if (period == 0.0f) return touches;
    return touches || touches_rect(x_px - period, y_px, reach_px, x0, y0, x1, y1) ||
           touches_rect(x_px + period, y_px, reach_px, x0, y0, x1, y1);
}

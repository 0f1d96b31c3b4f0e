// Fisheye, equidistant: px from the middle = focal_px * the angle from the view axis.

const int PROJECTION_FISHEYE = 2;

Instance fisheye_instance(Lens lens, Vec3 p) {
    // Straight behind there is no direction across: one is as good as another.
    Float tiny = 1e-18f;
    Float across = sqrt(p.x * p.x + p.y * p.y);
    Float x = mix(p.x, tiny, across < tiny);
    across = max(across, tiny);
    Float px_per_across = as_div(lens.focal_px * angle_of(across, -p.z), across);
    Float distance = sqrt(dot(p, p));
    return Instance(lens.center_x_px + x * px_per_across, lens.center_y_px - p.y * px_per_across, as_div(lens.focal_px, distance),
                    distance);
}

Vec3 fisheye_ray(Lens lens, Float x_px, Float y_px) {
    Float x = as_div(x_px - lens.center_x_px, lens.focal_px);
    Float y = as_div(lens.center_y_px - y_px, lens.focal_px);
    Float angle = max(sqrt(x * x + y * y), 1e-18f);
    Float across = as_div(sine_of(angle), angle);
    return Vec3(x * across, y * across, -cosine_of(angle));
}

Bool fisheye_shows(Lens lens, Float x_px, Float y_px) {
    Float x = as_div(x_px - lens.center_x_px, lens.focal_px);
    Float y = as_div(lens.center_y_px - y_px, lens.focal_px);
    return x * x + y * y <= lens.edge * lens.edge;
}

// Half the width of a square around a place on the frame that holds all within an angle of it: angles across are drawn
// t / sin t times as wide at t from the axis.
Float fisheye_reach_px(Lens lens, Float x_px, Float y_px, Float angle) {
    Float x = as_div(x_px - lens.center_x_px, lens.focal_px);
    Float y = as_div(lens.center_y_px - y_px, lens.focal_px);
    Float farthest = sqrt(x * x + y * y) + angle;
    Bool around = farthest > 2.8f;  // all the way round what lies behind
    Float reach = as_div(angle * farthest, max(sine_of(mix(farthest, 1.0f, around)), 1e-6f));
    return lens.focal_px * mix(reach, 8.0f, around);
}

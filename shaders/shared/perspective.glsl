// Perspective: px from the optical axis = focal_px * x / z. Camera space: x right, y up, in front is -z.

const int PROJECTION_PERSPECTIVE = 0;

Instance perspective_instance(Lens lens, Vec3 p) {
    Float depth = -p.z;
    Float px_per_unit = as_div(lens.focal_px, depth);
    return Instance(lens.center_x_px + p.x * px_per_unit, lens.center_y_px - p.y * px_per_unit, px_per_unit, depth);
}

Vec3 perspective_ray(Lens lens, Float x_px, Float y_px) {
    return Vec3(as_div(x_px - lens.center_x_px, lens.focal_px), as_div(lens.center_y_px - y_px, lens.focal_px), -1.0f);
}

Vec3 perspective_point(Lens lens, Float x_px, Float y_px, Float depth) {
    Vec3 ray = perspective_ray(lens, x_px, y_px);
    return Vec3(ray.x * depth, ray.y * depth, -depth);
}

Float perspective_axis_depth(Lens lens, Float x_px, Float y_px, Float depth) {
    Float x = as_div(x_px - lens.center_x_px, lens.focal_px);
    Float y = as_div(y_px - lens.center_y_px, lens.focal_px);
    return sqrt(as_div(depth, 1.0f + x * x + y * y));
}

Real perspective_spread(Lens lens) { return as_div(1.0f, lens.focal_px); }

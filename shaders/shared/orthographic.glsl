// Orthographic: px from the optical axis = focal_px * x; all rays are parallel to the axis.

const int PROJECTION_ORTHOGRAPHIC = 1;

Instance orthographic_instance(Lens lens, Vec3 p) {
    return Instance(lens.center_x_px + p.x * lens.focal_px, lens.center_y_px - p.y * lens.focal_px, lens.focal_px, -p.z);
}

Vec3 orthographic_point(Lens lens, Float x_px, Float y_px, Float depth) {
    return Vec3(as_div(x_px - lens.center_x_px, lens.focal_px), as_div(lens.center_y_px - y_px, lens.focal_px), -depth);
}

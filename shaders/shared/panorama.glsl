// Panoramas, equirectangular and cylindrical: px from the middle = focal_px * the longitude, to the right, and upwards
// focal_px * the latitude or its tangent. The view axis is at (0, 0); up is the pole.

const int PROJECTION_EQUIRECTANGULAR = 3;
const int PROJECTION_CYLINDRICAL = 4;

// Of a direction of any length: what lies across the pole's axis.
Float from_pole(Vec3 p) { return max(sqrt(p.x * p.x + p.z * p.z), 1e-18f); }

// By how much farther to the right an eye of a stereo pair sees what is this far away, radians (camera.cpp, move_to_eye).
Float panorama_parallax(Lens lens, Float distance) {
    Float sine = max(min(as_div(lens.parallax, distance), 1.0f), -1.0f);
    return angle_of(sine, sqrt(max(1.0f - sine * sine, 0.0f)));
}

Instance panorama_instance(Lens lens, Vec3 p) {
    Float longitude = angle_of(p.x, -p.z);
    Float height = angle_of(p.y, from_pole(p));
    if (lens.projection == PROJECTION_CYLINDRICAL) height = as_div(p.y, from_pole(p));
    Float distance = sqrt(dot(p, p));
    if (lens.parallax != 0.0f) longitude = longitude + panorama_parallax(lens, distance);
    return Instance(lens.center_x_px + lens.focal_px * longitude, lens.center_y_px - lens.focal_px * height,
                    as_div(lens.focal_px, distance), distance);
}

Vec3 panorama_ray(Lens lens, Float x_px, Float y_px) {
    Float longitude = as_div(x_px - lens.center_x_px, lens.focal_px);
    Float height = as_div(lens.center_y_px - y_px, lens.focal_px);
    if (lens.projection == PROJECTION_CYLINDRICAL) return Vec3(sine_of(longitude), height, -cosine_of(longitude));
    Float across = cosine_of(height);
    return Vec3(across * sine_of(longitude), sine_of(height), -across * cosine_of(longitude));
}

Bool panorama_shows(Lens lens, Float x_px, Float y_px) {
    Float quarter = 0.25f * SPHERE_TURN;
    if (lens.projection == PROJECTION_CYLINDRICAL) quarter = 1e30f;
    return abs(x_px - lens.center_x_px) <= lens.edge * lens.focal_px * 1.000001f &&
           abs(y_px - lens.center_y_px) <= quarter * lens.focal_px * 1.000001f;
}

// As fisheye_reach_px.
Float panorama_reach_px(Lens lens, Float y_px, Float angle) {
    Float height = as_div(abs(lens.center_y_px - y_px), lens.focal_px);
    Float latitude = height;
    if (lens.projection == PROJECTION_CYLINDRICAL) latitude = angle_of(height, Float(1.0f));
    Float highest = latitude + angle;
    Bool around = highest > 0.25f * SPHERE_TURN - 0.01f;  // all round a pole
    Float sine = sine_of(min(angle, Float(1.5f))), cosine = cosine_of(latitude);
    Float wide = angle_of(sine, sqrt(max(cosine * cosine - sine * sine, 1e-12f)));
    wide = mix(wide, 0.5f * SPHERE_TURN, around);
    if (lens.projection == PROJECTION_CYLINDRICAL) {
        Float top = mix(highest, Float(0.0f), around);
        Float high = mix(as_div(sine_of(top), cosine_of(top)) - height, 1e6f, around);
        return lens.focal_px * max(wide, high);
    }
    return lens.focal_px * max(wide, angle);
}

// Cameras that show the sphere, directions, and light by solid angle.
#pragma once

#include "unit/render/scenes.h"

namespace astrosplat::test {

inline constexpr int wide_px = 512, high_px = 256;

/// Those onto the sphere.
inline constexpr auto projections =
    std::span(all_values<Projection>).subspan<std::size_t(Projection::fisheye)>();

inline CameraParams params_of(Projection projection) {
    CameraParams params;
    params.projection = projection;
    params.position = glm::dvec3(0.0);
    params.target = {0.0, 0.0, -1.0};
    params.fisheye_fov = projection == Projection::fisheye ? 360.0 : 180.0;
    params.near = 1e-4;
    return params;
}

inline Camera camera_of(Projection projection) {
    return make_camera(params_of(projection), wide_px, high_px, {});
}

/// A fisheye sees more than a half of all directions, but not all.
inline Camera wide_camera(Projection projection) {
    CameraParams params = params_of(projection);
    params.fisheye_fov = 240.0;
    return make_camera(params, wide_px, high_px, {});
}

/// From longitude, to the right of -z, and latitude.
inline glm::dvec3 direction(double longitude_deg, double latitude_deg) {
    const double l = real::radians(longitude_deg), b = real::radians(latitude_deg);
    return {real::cos(b) * real::sin(l), real::sin(b), -real::cos(b) * real::cos(l)};
}

/// Solid angle of a pixel in px of the middle of the frame, by how far apart the directions at its sides are;
/// 0 where nothing is shown.
inline double solid_angle(const Camera& camera, std::int64_t x, std::int64_t y) {
    const double x_px = double(x) + 0.5, y_px = double(y) + 0.5;
    if (!shows(camera, x_px, y_px)) return 0.0;
    constexpr double half = 0.5;
    const auto toward = [&](double right, double down) {
        return ray_direction(camera, x_px + half * right, y_px + half * down);
    };
    const glm::dvec3 wide = toward(1.0, 0.0) - toward(-1.0, 0.0), high = toward(0.0, 1.0) - toward(0.0, -1.0);
    return camera.focal_px * camera.focal_px * glm::length(glm::cross(wide, high));
}

/// Whether the frame shows all within so many degrees of a place; a cylinder's ends above and below.
inline bool fits(const Camera& camera, double latitude_deg, double within_deg) {
    return camera.projection != Projection::cylindrical || std::fabs(latitude_deg) + within_deg <= 38.0;
}

/// Of every pixel, row by row: for pictures of one camera after the other.
inline std::vector<double> solid_angles(const Camera& camera) {
    std::vector<double> angles;
    for (std::int64_t y = 0; y < std::int64_t(2.0 * camera.center_y_px); ++y)
        for (std::int64_t x = 0; x < std::int64_t(2.0 * camera.center_x_px); ++x)
            angles.push_back(solid_angle(camera, x, y));
    return angles;
}

inline double light_on_sphere(const Image& picture, const std::vector<double>& angles, int channel) {
    EXPECT_EQ(picture.pixels.size(), 4 * angles.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < angles.size(); ++i)
        sum += picture.pixels[4 * i + std::size_t(channel)] * angles[i];
    return sum;
}

/// A case whose light is measured.
struct SphereCase {
    Projection projection;
    Falloff::Shape shape;
};
inline void PrintTo(const SphereCase& c, std::ostream* out) {
    *out << name_of(c.projection) << ", " << name_of(c.shape);
}
inline std::vector<SphereCase> sphere_cases() {
    std::vector<SphereCase> cases;
    for (const Projection projection : projections)
        for (const Falloff::Shape shape : all_shapes) cases.push_back({projection, shape});
    return cases;
}

/// Two splats, of this stretch where it is none of 0, through a fisheye that is narrow: the sphere is as good
/// as flat.
inline void expect_narrow_fisheye_is_flat(const glm::mat3& stretch, double tolerance) {
    CameraParams params = params_of(Projection::fisheye);
    params.fisheye_fov = 1.0;
    ShadedSplats splats =
        make_splats({{{0.03f, -0.02f, -10.0f}, 0.02f, 0.7f}, {{-0.05f, 0.01f, -9.0f}, 0.004f}});
    if (stretch != glm::mat3(0.0f)) splats.stretch = {stretch, stretch};
    const RenderLayer layer = layer_of("two", splats, Blend::over, Falloff::Shape::gaussian);
    const auto picture = [&] {
        return render({&layer, 1}, make_camera(params, high_px, high_px, {}), nullptr,
                      settings_of(high_px, high_px))
            .beauty;
    };
    const Image fisheye = picture();
    params.projection = Projection::perspective;
    params.fov = 1.0;
    const Image flat = picture();
    EXPECT_GT(*std::ranges::max_element(flat.pixels), 0.5f);
    for (std::size_t i = 0; i < flat.pixels.size(); ++i)
        ASSERT_NEAR(fisheye.pixels[i], flat.pixels[i], tolerance);
}

/// A cloud all around the eye looks the same where one projection has its middle and the other its seam.
template <class Draw>
void expect_no_seam(const Draw& draw, double tolerance) {
    for (const Projection projection : {Projection::equirectangular, Projection::cylindrical}) {
        CameraParams params = params_of(projection);
        const Image ahead = draw(make_camera(params, wide_px, high_px, {}));
        params.target = {0.0, 0.0, 1.0};
        const Image behind = draw(make_camera(params, wide_px, high_px, {}));
        double worst = 0.0, brightest = 0.0;
        for (std::int64_t y = 0; y < high_px; ++y)
            for (std::int64_t x = 0; x < wide_px; ++x)
                for (int k = 0; k < 4; ++k) {
                    const double a = ahead.at(x, y)[k], b = behind.at((x + wide_px / 2) % wide_px, y)[k];
                    worst = std::max(worst, std::fabs(a - b));
                    brightest = std::max(brightest, a);
                }
        EXPECT_GT(brightest, 0.5);
        EXPECT_LT(worst, tolerance) << name_of(projection);
    }
}

}  // namespace astrosplat::test

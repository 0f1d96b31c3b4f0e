#include "support/ewa_reference.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

namespace astrosplat::test {
namespace {

glm::dmat3 axes_of(const glm::dvec4& q) {
    // The images of the axes under v -> q v q*.
    const auto turn = [&](const glm::dvec3& v) {
        const glm::dvec3 u(q.x, q.y, q.z), t = 2.0 * glm::cross(u, v);
        return v + q.w * t + glm::cross(u, t);
    };
    return {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1})};
}

/// The colour in a direction, by products of Cartesian coordinates.
glm::dvec3 color_of(const std::array<glm::dvec3, 16>& c, const glm::dvec3& d) {
    const double x = d.x, y = d.y, z = d.z;
    glm::dvec3 sum = 0.28209479177387814 * c[0];
    sum += 0.4886025119029199 * (-y * c[1] + z * c[2] - x * c[3]);
    sum += 1.0925484305920792 * (x * y * c[4] - y * z * c[5] - x * z * c[7]);
    sum += 0.31539156525252005 * (3 * z * z - 1) * c[6] + 0.5462742152960396 * (x * x - y * y) * c[8];
    sum += -0.5900435899266435 * (y * (3 * x * x - y * y) * c[9] + x * (x * x - 3 * y * y) * c[15]);
    sum += 2.890611442640554 * x * y * z * c[10] + 1.445305721320277 * z * (x * x - y * y) * c[14];
    sum += -0.4570457994644658 * (5 * z * z - 1) * (y * c[11] + x * c[13]);
    sum += 0.3731763325901154 * z * (5 * z * z - 3) * c[12];
    return glm::max(sum + 0.5, glm::dvec3(0.0));
}

}  // namespace

Image ewa_reference(std::vector<Trained> capture, const Camera& camera, std::int64_t width,
                    std::int64_t height, const EwaSettings& settings) {
    std::ranges::stable_sort(capture, {},
                             [&](const Trained& g) { return glm::distance(g.position, camera.eye); });
    std::vector<glm::dvec4> sums(static_cast<std::size_t>(width * height), glm::dvec4(0.0, 0.0, 0.0, 1.0));
    const glm::dmat3 view = glm::transpose(camera.world_from_camera);
    for (const Trained& g : capture) {
        const glm::dvec3 p = view * (g.position - camera.eye);
        const double depth = -p.z, f = camera.focal_px;
        if (depth < 0.05) continue;
        glm::dmat3 m = view * axes_of(g.rotation);
        for (int k = 0; k < 3; ++k) m[k] *= g.scale[k];
        const glm::dmat3 covariance = m * glm::transpose(m);
        // Rows of the Jacobian of (f x / -z, -f y / -z).
        const glm::dvec3 jx(f / depth, 0.0, f * p.x / (depth * depth)),
            jy(0.0, -f / depth, -f * p.y / (depth * depth));
        const double xx = glm::dot(jx, covariance * jx), xy = glm::dot(jx, covariance * jy),
                     yy = glm::dot(jy, covariance * jy);
        const double before = std::max(xx * yy - xy * xy, 0.0);
        const double wide_xx = xx + settings.filter_variance, wide_yy = yy + settings.filter_variance;
        const double after = wide_xx * wide_yy - xy * xy;
        const double peak = g.opacity * (settings.conserves_light ? std::sqrt(before / after) : 1.0);
        const glm::dvec3 color = color_of(g.harmonics, glm::normalize(g.position - camera.eye));
        const double cx = camera.center_x_px + f * p.x / depth, cy = camera.center_y_px - f * p.y / depth;
        for (std::int64_t y = 0; y < height; ++y)
            for (std::int64_t x = 0; x < width; ++x) {
                const double dx = double(x) + 0.5 - cx, dy = double(y) + 0.5 - cy;
                const double d = (wide_yy * dx * dx - 2.0 * xy * dx * dy + wide_xx * dy * dy) / after;
                if (d > 60.0) continue;  // 1e-13 of the peak
                const double alpha = peak * std::exp(-0.5 * d);
                if (alpha < settings.least_alpha) continue;
                glm::dvec4& sum = sums[static_cast<std::size_t>(y * width + x)];
                sum += glm::dvec4(sum.w * alpha * color, -sum.w * alpha);
            }
    }
    Image image = make_image(width, height, 4);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            image.pixels[4 * i + static_cast<std::size_t>(k)] = static_cast<float>(sums[i][k]);
        image.pixels[4 * i + 3] = static_cast<float>(1.0 - sums[i].w);
    }
    return image;
}

}  // namespace astrosplat::test

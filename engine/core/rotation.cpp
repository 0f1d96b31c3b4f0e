#include "core/rotation.h"

#include <glm/geometric.hpp>

#include "core/real.h"

namespace astrosplat {

glm::dmat3 matrix_of_quaternion(const glm::dvec4& q) {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    return {1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z),       2.0 * (x * z - w * y),
            2.0 * (x * y - w * z),       1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x),
            2.0 * (x * z + w * y),       2.0 * (y * z - w * x),       1.0 - 2.0 * (x * x + y * y)};
}

glm::dvec4 quaternion_of_matrix(const glm::dmat3& m) {
    // Four times the squares of x, y, z, w; the largest gives the others from products with it.
    const std::array<double, 4> squares = {
        1.0 + m[0][0] - m[1][1] - m[2][2], 1.0 - m[0][0] + m[1][1] - m[2][2],
        1.0 - m[0][0] - m[1][1] + m[2][2], 1.0 + m[0][0] + m[1][1] + m[2][2]};
    const auto largest = std::ranges::max_element(squares) - squares.begin();
    const double xy = m[0][1] + m[1][0], yz = m[1][2] + m[2][1], zx = m[2][0] + m[0][2];
    const double wx = m[1][2] - m[2][1], wy = m[2][0] - m[0][2], wz = m[0][1] - m[1][0];
    const double square = squares[largest];
    glm::dvec4 q = largest == 0   ? glm::dvec4(square, xy, zx, wx)
                   : largest == 1 ? glm::dvec4(xy, square, yz, wy)
                   : largest == 2 ? glm::dvec4(zx, yz, square, wz)
                                  : glm::dvec4(wx, wy, wz, square);
    q /= std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return q.w < 0.0 ? -q : q;
}

glm::dvec4 quaternion_between(const glm::dvec4& a, glm::dvec4 b, double t) {
    double cosine = glm::dot(a, b);
    if (cosine < 0.0) b = -b, cosine = -cosine;
    if (cosine > 1.0 - 1e-9) return glm::normalize(a + t * (b - a));
    const double angle = real::acos(cosine), sine = real::sin(angle);
    return (real::sin((1.0 - t) * angle) / sine) * a + (real::sin(t * angle) / sine) * b;
}

glm::dvec4 quaternion_product(const glm::dvec4& a, const glm::dvec4& b) {
    return {a.w * b.x + b.w * a.x + a.y * b.z - a.z * b.y, a.w * b.y + b.w * a.y + a.z * b.x - a.x * b.z,
            a.w * b.z + b.w * a.z + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

glm::dmat3 rotation_from_degrees(const glm::dvec3& degrees) {
    const double cx = real::cos(real::radians(degrees.x)), sx = real::sin(real::radians(degrees.x));
    const double cy = real::cos(real::radians(degrees.y)), sy = real::sin(real::radians(degrees.y));
    const double cz = real::cos(real::radians(degrees.z)), sz = real::sin(real::radians(degrees.z));
    const glm::dmat3 about_x(1.0, 0.0, 0.0, 0.0, cx, sx, 0.0, -sx, cx);
    const glm::dmat3 about_y(cy, 0.0, -sy, 0.0, 1.0, 0.0, sy, 0.0, cy);
    const glm::dmat3 about_z(cz, sz, 0.0, -sz, cz, 0.0, 0.0, 0.0, 1.0);
    return about_z * about_y * about_x;
}

}  // namespace astrosplat

// An axis-aligned box in double precision.
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "core/standard.h"

namespace astrosplat {

struct Bounds {
    glm::dvec3 lo{std::numeric_limits<double>::infinity()};
    glm::dvec3 hi{-std::numeric_limits<double>::infinity()};

    bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
    glm::dvec3 extent() const { return hi - lo; }
    glm::dvec3 center() const { return (lo + hi) * 0.5; }
    bool contains(const glm::dvec3& p) const { return p == glm::clamp(p, lo, hi); }
    /// One of the eight: bits 0 to 2 of `number` choose hi in x, y and z.
    glm::dvec3 corner(int number) const {
        return {number & 1 ? hi.x : lo.x, number & 2 ? hi.y : lo.y, number & 4 ? hi.z : lo.z};
    }
    void add(const glm::dvec3& p) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    void add(const Bounds& b) {
        lo = glm::min(lo, b.lo);
        hi = glm::max(hi, b.hi);
    }
};

}  // namespace astrosplat

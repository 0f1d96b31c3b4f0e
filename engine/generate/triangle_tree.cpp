// Closest points by Ericson's regions of a triangle; one without a usable inside counts as its three edges.
// Bounds come from a triangle's smallest circle, its unit normal and its corners. Triangles are sorted so
// that neighbours lie together, eight to a box, eight boxes to the next; a search takes the
// nearest boxes first.
#include "generate/triangle_tree.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "core/bounds.h"
#include "core/error.h"
#include "core/parallel.h"

namespace astrosplat {
namespace {

double squared(const glm::dvec3& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }
double dot(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

ClosestPoint at(const glm::dvec3& ap, const TriangleShape& s, double v, double w) {
    return {squared(ap - s.ab * v - s.ac * w), 0, {v, w}};
}

// Parameter in [0, 1] of the closest point on the segment from the origin along `edge`; 0 for a segment
// of no length.
double along(const glm::dvec3& p, const glm::dvec3& edge) {
    const double length_squared = squared(edge);
    return length_squared > 0.0 ? std::clamp(dot(p, edge) / length_squared, 0.0, 1.0) : 0.0;
}

ClosestPoint closest_on_edges(const glm::dvec3& ap, const TriangleShape& s) {
    const double t_ab = along(ap, s.ab), t_ac = along(ap, s.ac), t_bc = along(ap - s.ab, s.ac - s.ab);
    ClosestPoint best = at(ap, s, t_ab, 0.0);
    for (const ClosestPoint& other : {at(ap, s, 0.0, t_ac), at(ap, s, 1.0 - t_bc, t_bc)}) {
        if (other.distance_squared < best.distance_squared) best = other;
    }
    return best;
}

}  // namespace

ClosestPoint closest_on_triangle(const glm::dvec3& p, const TriangleShape& s) {
    const glm::dvec3 ap = p - s.a;
    const double d1 = dot(s.ab, ap), d2 = dot(s.ac, ap);  // from a; from b and c the same dot products follow
    const double d3 = d1 - s.ab_ab, d4 = d2 - s.ab_ac;
    const double d5 = d1 - s.ab_ac, d6 = d2 - s.ac_ac;
    if (has_no_inside(s)) return closest_on_edges(ap, s);
    if (d1 <= 0.0 && d2 <= 0.0) return at(ap, s, 0.0, 0.0);
    if (d3 >= 0.0 && d4 <= d3) return at(ap, s, 1.0, 0.0);
    if (d6 >= 0.0 && d5 <= d6) return at(ap, s, 0.0, 1.0);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return at(ap, s, d1 / s.ab_ab, 0.0);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return at(ap, s, 0.0, d2 / s.ac_ac);
    const double va = d3 * d6 - d5 * d4;
    const double to_c = d4 - d3, to_b = d5 - d6;
    if (va <= 0.0 && to_c >= 0.0 && to_b >= 0.0) {
        const double w = to_c / (to_c + to_b);
        return at(ap, s, 1.0 - w, w);
    }
    const double scale = 1.0 / (va + vb + vc);
    return at(ap, s, vb * scale, vc * scale);
}

namespace {

struct TriangleBox {
    glm::vec3 lo, hi;
};

// The middle of the smallest circle around a triangle, from its first corner: the circumcentre where all
// angles are acute, else the middle of the longest side.
glm::dvec3 circle_middle(const TriangleShape& s) {
    const double at_b = s.ab_ab - s.ab_ac, at_c = s.ac_ac - s.ab_ac;
    if (has_no_inside(s) || s.ab_ac <= 0.0 || at_b <= 0.0 || at_c <= 0.0) {
        const double bc_bc = at_b + at_c;
        if (s.ab_ab >= s.ac_ac && s.ab_ab >= bc_bc) return s.ab * 0.5;
        return s.ac_ac >= bc_bc ? s.ac * 0.5 : (s.ab + s.ac) * 0.5;
    }
    const double area_squared = s.ab_ab * s.ac_ac - s.ab_ac * s.ab_ac;
    return (s.ab * (s.ac_ac * at_b) + s.ac * (s.ab_ab * at_c)) / (2.0 * area_squared);
}

// How far closest_on_triangle may place a point outside the triangle, as a part of its size.
double overshoot(const TriangleShape& s) {
    const double corners = s.ab_ab * s.ac_ac;
    const double sine_squared = corners > 0.0 ? (corners - s.ab_ac * s.ab_ac) / corners : 0.0;
    return 1e-6 + (sine_squared > 1e-14 ? 1e-15 / sine_squared : 0.0);
}

// Unit, or 0 for triangles that have no plane worth a bound.
glm::dvec3 usable_normal(const TriangleShape& s) {
    const glm::dvec3 normal = glm::cross(s.ab, s.ac);
    const double length = std::sqrt(squared(normal));
    return length > 0.0 && !is_narrow(s) ? normal / length : glm::dvec3(0.0);
}

TriangleBox triangle_box(const TriangleShape& s, const glm::dvec3& origin) {
    const glm::dvec3 a = s.a - origin, b = a + s.ab, c = a + s.ac;
    const glm::dvec3 lo = glm::min(glm::min(a, b), c), hi = glm::max(glm::max(a, b), c);
    const glm::dvec3 more = (hi - lo) * overshoot(s);
    return {glm::vec3(lo - more), glm::vec3(hi + more)};
}

TriangleDisc triangle_disc(const TriangleShape& s, const glm::dvec3& origin) {
    const glm::dvec3 middle = circle_middle(s);
    const double radius =
        std::sqrt(std::max({squared(middle), squared(middle - s.ab), squared(middle - s.ac)}));
    return {glm::vec3(s.a - origin + middle), glm::vec3(usable_normal(s)),
            float(radius * (1.0 + overshoot(s)))};
}

constexpr std::size_t fan = TriangleTree::fan;
constexpr std::int64_t triangles_per_chunk = 4096;
constexpr std::size_t most_triangles = ClosestPoint::none;  // so that it is no triangle's number or slot

// Of all triangles, by number.
Buffer<TriangleCorners> corners_of(std::span<const Mesh* const> meshes) {
    std::size_t count = 0;
    for (const Mesh* mesh : meshes) count += mesh->triangles.size();
    if (count > most_triangles) {
        bad_input("meshes", fmt::format("at most {} triangles", most_triangles), fmt::format("{}", count));
    }
    Buffer<TriangleCorners> corners(count);
    std::size_t first = 0;
    for (const Mesh* mesh : meshes) {
        parallel_each(mesh->triangles.size(), triangles_per_chunk, [&](std::size_t t) {
            const auto& [a, b, c] = mesh->triangles[t].position;
            corners[first + t] = {mesh->positions[a], mesh->positions[b], mesh->positions[c]};
        });
        first += mesh->triangles.size();
    }
    return corners;
}

void place_origin(std::span<const Mesh* const> meshes, TriangleTree& tree) {
    Bounds box;
    for (const Mesh* mesh : meshes) box.add(bounds(*mesh));
    if (box.empty()) return;
    tree.origin = box.center();
    const glm::dvec3 half = box.extent() * 0.5;
    tree.reach = std::max({half.x, half.y, half.z});
}

struct Middle {
    glm::vec3 at;
    std::uint32_t number;
};

// Brings neighbours together: cuts across the longest side of the middles' box, at whole boxes of the highest
// level there is, and both parts again. visit() gets the parts of at most `most` middles that are left.
template <class Visit>
void cut(std::span<Middle> middles, std::size_t most, const Visit& visit) {
    if (middles.size() <= most) return visit(middles);
    glm::vec3 lo = middles[0].at, hi = lo;
    for (const Middle& middle : middles) lo = glm::min(lo, middle.at), hi = glm::max(hi, middle.at);
    const glm::vec3 side = hi - lo;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    std::size_t box = 1;
    while (box * fan < middles.size()) box *= fan;
    const std::size_t half = (middles.size() + box - 1) / box / 2 * box;
    std::nth_element(middles.begin(), middles.begin() + std::ptrdiff_t(half), middles.end(),
                     [&](const Middle& a, const Middle& b) { return a.at[axis] < b.at[axis]; });
    cut(middles.first(half), most, visit);
    cut(middles.subspan(half), most, visit);
}

Buffer<Middle> place_order(const Buffer<TriangleCorners>& corners, const TriangleTree& tree) {
    Buffer<Middle> order(corners.size());
    parallel_each(corners.size(), triangles_per_chunk, [&](std::size_t i) {
        const auto& [a, b, c] = corners[i];
        const glm::dvec3 middle = (glm::dvec3(a) + glm::dvec3(b) + glm::dvec3(c)) / 3.0 - tree.origin;
        order[i] = {glm::vec3(middle), std::uint32_t(i)};
    });
    std::vector<std::span<Middle>> parts;  // one task each
    cut(order, std::size_t{1} << 15, [&](std::span<Middle> part) { parts.push_back(part); });
    parallel_for(std::int64_t(parts.size()),
                 [&](std::int64_t part, int) { cut(parts[part], fan, [](std::span<Middle>) {}); });
    return order;
}

// Boxes to be set, and behind them zeros, for groups are read whole.
TreeLevel level_of(std::size_t count) {
    TreeLevel level{count, {}, {}, {}, {}, {}, {}};
    for (auto* side : {&level.lo_x, &level.lo_y, &level.lo_z, &level.hi_x, &level.hi_y, &level.hi_z}) {
        side->resize(count + fan);
        std::fill_n(side->end() - fan, fan, 0.0f);
    }
    return level;
}

TreeLevel level_above(const TreeLevel& below) {
    TreeLevel level = level_of((below.count + fan - 1) / fan);
    parallel_each(level.count, triangles_per_chunk, [&](std::size_t i) {
        const auto first = std::ptrdiff_t(i * fan);
        const auto last = std::ptrdiff_t(std::min((i + 1) * fan, below.count));
        const auto least = [&](const Buffer<float>& side) {
            return *std::min_element(side.begin() + first, side.begin() + last);
        };
        const auto most = [&](const Buffer<float>& side) {
            return *std::max_element(side.begin() + first, side.begin() + last);
        };
        level.lo_x[i] = least(below.lo_x), level.hi_x[i] = most(below.hi_x);
        level.lo_y[i] = least(below.lo_y), level.hi_y[i] = most(below.hi_y);
        level.lo_z[i] = least(below.lo_z), level.hi_z[i] = most(below.hi_z);
    });
    return level;
}

// Squared distances of a point from the eight boxes from `first` on.
std::array<float, fan> box_distances(const TreeLevel& level, std::size_t first, const glm::vec3& p) {
    std::array<float, fan> squared;
    for (std::size_t i = 0; i < fan; ++i) {
        const float x = std::max(std::max(level.lo_x[first + i] - p.x, p.x - level.hi_x[first + i]), 0.0f);
        const float y = std::max(std::max(level.lo_y[first + i] - p.y, p.y - level.hi_y[first + i]), 0.0f);
        const float z = std::max(std::max(level.lo_z[first + i] - p.z, p.z - level.hi_z[first + i]), 0.0f);
        squared[i] = x * x + y * y + z * z;
    }
    return squared;
}

// The search of one position. The limit is that of distances that may still matter.
class PointSearch {
  public:
    PointSearch(const TriangleTree& tree, const glm::dvec3& p, double max_distance)
        : tree_(tree),
          p_(p),
          local_(p - tree.origin),
          slack_(tree.slack(p - tree.origin)),
          best_{{max_distance * max_distance, ClosestPoint::none, {}}, ClosestPoint::none} {
        update_limit();
    }

    void offer(std::uint32_t slot) {
        ClosestPoint other = closest_on_triangle(p_, tree_.shape(slot));
        other.triangle = tree_.triangles[slot].number;
        if (!nearer(other, best_.closest)) return;
        best_ = {other, slot};
        update_limit();
    }

    // The children of a box, or what a level begins with, nearest first.
    void visit(std::size_t level, std::size_t group) {
        const TreeLevel& boxes = tree_.levels[level];
        const std::size_t first = group * fan, count = std::min(fan, boxes.count - first);
        const std::array<float, fan> squared = box_distances(boxes, first, local_);
        std::array<std::uint8_t, fan> order;
        std::size_t found = 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (squared[i] > limit_ * limit_) continue;
            std::size_t at = found++;
            for (; at > 0 && squared[order[at - 1]] > squared[i]; --at) order[at] = order[at - 1];
            order[at] = std::uint8_t(i);
        }
        for (std::size_t i = 0; i < found && !(squared[order[i]] > limit_ * limit_); ++i) {
            const std::size_t child = first + order[i];
            level == 0 ? offer(std::uint32_t(child)) : visit(level - 1, child);
        }
    }

    const NearTriangle& best() const { return best_; }

  private:
    void update_limit() { limit_ = widened(std::sqrt(best_.closest.distance_squared), slack_); }

    const TriangleTree& tree_;
    glm::dvec3 p_;
    glm::vec3 local_;
    double slack_;
    NearTriangle best_;
    float limit_ = 0.0f;
};

}  // namespace

TriangleTree make_triangle_tree(std::span<const Mesh* const> meshes) {
    const Buffer<TriangleCorners> corners = corners_of(meshes);
    TriangleTree tree;
    place_origin(meshes, tree);
    const Buffer<Middle> order = place_order(corners, tree);
    tree.triangles.resize(order.size());
    TreeLevel level = level_of(order.size());
    parallel_each(order.size(), triangles_per_chunk, [&](std::size_t slot) {
        const std::uint32_t number = order[slot].number;
        const TriangleShape shape = triangle_shape(corners[number]);
        tree.triangles[slot] = {corners[number], number, triangle_disc(shape, tree.origin)};
        const auto [lo, hi] = triangle_box(shape, tree.origin);
        level.lo_x[slot] = lo.x, level.lo_y[slot] = lo.y, level.lo_z[slot] = lo.z;
        level.hi_x[slot] = hi.x, level.hi_y[slot] = hi.y, level.hi_z[slot] = hi.z;
    });
    tree.levels.push_back(std::move(level));
    while (tree.levels.back().count > fan) tree.levels.push_back(level_above(tree.levels.back()));
    return tree;
}

NearTriangle closest_point(const TriangleTree& tree, const glm::dvec3& p, double max_distance,
                           std::uint32_t hint) {
    PointSearch search(tree, p, max_distance);
    if (hint != ClosestPoint::none) search.offer(hint);
    search.visit(tree.levels.size() - 1, 0);
    return search.best();
}

}  // namespace astrosplat

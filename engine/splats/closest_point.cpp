// Closest points. In: meshes and query points. Out: ClosestPoint. Triangles that lie together form clusters,
// and Embree's bounding volumes are built over the clusters' boxes, in float and moved to the middle of all
// meshes; every query radius is widened by more than those roundings can amount to, and each triangle
// proposed is measured in double from the unrounded vertices.
#include "splats/closest_point.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/buffer.h"
#include "core/error.h"
#include "core/parallel.h"
#include "splats/cluster_filter.h"
#include "splats/curve_order.h"

namespace astrosplat {
namespace {

constexpr std::size_t most_triangles = ClosestPoint::none / 3;  // numbers and clusters fit into 32 bits

double squared(const glm::dvec3& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }
double dot(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

ClosestPoint at(const glm::dvec3& ap, const TriangleShape& s, double v, double w) {
    return {squared(ap - s.ab * v - s.ac * w), 0, {v, w}};
}

// Parameter in [0, 1] of the closest point on the segment from the origin along `edge`; 0 for a segment of no
// length.
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

double sine_squared(const TriangleShape& s) {
    const double corners = s.ab_ab * s.ac_ac;
    return corners > 0.0 ? (corners - s.ab_ac * s.ab_ac) / corners : 0.0;
}

// How far closest_on_triangle may place a point outside the triangle, as a part of its size.
double overshoot(const TriangleShape& s) {
    const double sine = sine_squared(s);
    return 1e-6 + (sine > 1e-14 ? 1e-15 / sine : 0.0);
}

TriangleBound triangle_bound(const TriangleShape& s, const glm::dvec3& origin) {
    const glm::dvec3 middle = circle_middle(s), normal = glm::cross(s.ab, s.ac);
    const double length = std::sqrt(squared(normal));
    const bool flat = length > 0.0 && !is_narrow(s);
    const double radius =
        std::sqrt(std::max({squared(middle), squared(middle - s.ab), squared(middle - s.ac)}));
    return {glm::vec3(s.a - origin + middle), flat ? glm::vec3(normal / length) : glm::vec3(0.0f),
            static_cast<float>(radius * (1.0 + overshoot(s)))};
}

void extend(ClusterBox& box, const TriangleShape& s, const glm::dvec3& origin) {
    const glm::dvec3 a = s.a - origin, b = a + s.ab, c = a + s.ac;
    const glm::dvec3 lo = glm::min(glm::min(a, b), c), hi = glm::max(glm::max(a, b), c);
    const glm::dvec3 more = (hi - lo) * overshoot(s);
    box.lo = glm::min(box.lo, glm::vec3(lo - more));
    box.hi = glm::max(box.hi, glm::vec3(hi + more));
}

TriangleEdges triangle_edges(const TriangleShape& s) {
    const glm::dvec3 normal = glm::cross(s.ab, s.ac), middle = circle_middle(s);
    const double length = std::sqrt(squared(normal));
    TriangleEdges edges{};
    if (!(length > 0.0) || is_narrow(s)) return edges;
    const glm::dvec3 from[3] = {glm::dvec3(0.0), s.ab, s.ac}, along_edge[3] = {s.ab, s.ac - s.ab, -s.ac};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 outward = glm::cross(along_edge[i], normal);
        const double outward_length = std::sqrt(squared(outward));
        if (!(outward_length > 0.0)) continue;  // a plane that bounds nothing
        const glm::dvec3 unit = outward / outward_length;
        edges.normal_x[i] = static_cast<float>(unit.x);
        edges.normal_y[i] = static_cast<float>(unit.y);
        edges.normal_z[i] = static_cast<float>(unit.z);
        edges.offset[i] = static_cast<float>(dot(unit, from[i] - middle));
    }
    return edges;
}

// Squares of at most the distances of p from a cluster's triangles; `rounding` is more than theirs amounts
// to.
struct DiscDistances {
    std::array<float, TriangleCluster::size> least;   // as said
    std::array<float, TriangleCluster::size> middle;  // of the discs' middles, square scene units
};
DiscDistances disc_distances(const TriangleCluster& c, const glm::vec3& p, float rounding) {
    DiscDistances squared;
    for (std::size_t i = 0; i < TriangleCluster::size; ++i) {
        const float x = p.x - c.center_x[i], y = p.y - c.center_y[i], z = p.z - c.center_z[i];
        const float height = x * c.normal_x[i] + y * c.normal_y[i] + z * c.normal_z[i];
        squared.middle[i] = x * x + y * y + z * z;
        const float flat = squared.middle[i] * (1.0f - 4e-6f) - height * height;
        const float off = rounding + 2e-6f * c.radius[i];
        const float outside = std::max(std::sqrt(std::max(flat, 0.0f)) - c.radius[i] - off, 0.0f);
        const float above = std::max(std::fabs(height) - off, 0.0f);
        squared.least[i] = outside * outside + above * above;
    }
    return squared;
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

ClosestPoint closest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                                 const glm::dvec3& c) {
    return closest_on_triangle(p, triangle_shape(a, b, c));
}

struct ClosestPointIndex::State {
    Buffer<ClusteredTriangle> triangles;
    Buffer<std::uint32_t> slots;  // by number
    Buffer<TriangleCluster> clusters;
    Buffer<ClusterBox> boxes;  // of the clusters
    glm::dvec3 center{0.0};    // Embree's origin, scene units
    double reach = 0.0;        // largest coordinate of a vertex relative to center
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }

    void place_origin(std::span<const Mesh* const> meshes);
    void make_clusters(const Buffer<TriangleCorners>& corners);
    void make_cluster(std::size_t cluster, const Buffer<TriangleCorners>& corners,
                      const Buffer<std::uint64_t>& order);
    void build(std::span<const Mesh* const> meshes);
    TriangleShape shape(std::uint32_t slot) const { return triangle_shape(triangles[slot].corners); }
    template <class Visit>
    void query(const glm::dvec3& p, double distance, Visit visit) const;

    // Embree's vertices and its query point are each off by up to 2^-24 of their coordinates, per axis: along
    // any direction by less than 1.1e-7 of their sum. Four times that also covers Embree's own subtractions,
    // and the factor in `widened` its squares.
    double slack(const glm::dvec3& local) const {
        const glm::dvec3 size = glm::abs(local);
        return 4e-7 * (reach + std::max({size.x, size.y, size.z}));
    }
    static float widened(double distance, double slack) {
        return static_cast<float>(1.00001 * distance + slack);
    }
};

// Of all triangles, by number.
static Buffer<TriangleCorners> corners_of(std::span<const Mesh* const> meshes) {
    std::size_t count = 0;
    for (const Mesh* mesh : meshes) count += mesh->triangles.size();
    if (count > most_triangles) {
        bad_input("meshes", "", fmt::format("at most {} triangles", most_triangles),
                  fmt::format("{}", count));
    }
    Buffer<TriangleCorners> corners(count);
    std::size_t first = 0;
    for (const Mesh* mesh : meshes) {
        const auto triangles = static_cast<std::int64_t>(mesh->triangles.size());
        parallel_chunks(triangles, 4096, [&](std::int64_t begin, std::int64_t end, int) {
            for (auto t = static_cast<std::size_t>(begin); t < static_cast<std::size_t>(end); ++t) {
                const auto corner = [&](std::size_t k) {
                    return mesh->positions[mesh->triangles[t].position[k]];
                };
                corners[first + t] = {corner(0), corner(1), corner(2)};
            }
        });
        first += mesh->triangles.size();
    }
    return corners;
}

void ClosestPointIndex::State::place_origin(std::span<const Mesh* const> meshes) {
    Bounds box;
    for (const Mesh* mesh : meshes) {
        for (const Mesh::Triangle& t : mesh->triangles)
            for (const std::uint32_t corner : t.position) box.add(glm::dvec3(mesh->positions[corner]));
    }
    if (box.empty()) return;
    center = box.center();
    const glm::dvec3 half = box.extent() * 0.5;
    reach = std::max({half.x, half.y, half.z});
}

// Eight at a time along a Hilbert curve through the middles of the triangles.
void ClosestPointIndex::State::make_clusters(const Buffer<TriangleCorners>& corners) {
    const auto count = static_cast<std::int64_t>(corners.size());
    Buffer<std::uint64_t> order(corners.size());  // place on the curve, then number
    parallel_chunks(count, 4096, [&](std::int64_t begin, std::int64_t end, int) {
        CurvePlaces places;
        const auto last = static_cast<std::size_t>(end);
        for (auto first = static_cast<std::size_t>(begin); first < last; first += CurvePlaces::most) {
            const std::size_t stop = std::min(first + CurvePlaces::most, last);
            for (std::size_t i = first; i < stop; ++i) {
                const TriangleCorners& t = corners[i];
                places.add((glm::dvec3(t.a) + glm::dvec3(t.b) + glm::dvec3(t.c)) / 3.0 - center, reach);
            }
            const CurvePlaces::Numbers& place = places.finish();
            for (std::size_t i = first; i < stop; ++i) order[i] = std::uint64_t{place[i - first]} << 32 | i;
        }
    });
    sort_by_place(order);
    constexpr std::size_t size = TriangleCluster::size;
    clusters.resize((corners.size() + size - 1) / size);
    boxes.resize(clusters.size());
    triangles.resize(corners.size());
    slots.resize(corners.size());
    parallel_chunks(static_cast<std::int64_t>(clusters.size()), 512,
                    [&](std::int64_t begin, std::int64_t end, int) {
                        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
                            make_cluster(i, corners, order);
                    });
}

void ClosestPointIndex::State::make_cluster(std::size_t cluster, const Buffer<TriangleCorners>& corners,
                                            const Buffer<std::uint64_t>& order) {
    constexpr float far = std::numeric_limits<float>::infinity();
    boxes[cluster] = {glm::vec3(far), glm::vec3(-far)};
    for (std::size_t i = 0; i < TriangleCluster::size; ++i) {
        const std::size_t slot = std::min(cluster * TriangleCluster::size + i, order.size() - 1);
        const auto number = static_cast<std::uint32_t>(order[slot]);
        const TriangleShape shape = triangle_shape(corners[number]);
        clusters[cluster].set(i, static_cast<std::uint32_t>(slot), triangle_bound(shape, center));
        extend(boxes[cluster], shape, center);
        triangles[slot] = {corners[number], number, triangle_edges(shape)};
        slots[number] = static_cast<std::uint32_t>(slot);
    }
}

void ClosestPointIndex::State::build(std::span<const Mesh* const> meshes) {
    place_origin(meshes);
    make_clusters(corners_of(meshes));
    device = rtcNewDevice("threads=1");  // keeps Embree off TBB's pool
    if (!device) throw std::runtime_error("Embree gave no device");
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);  // serial work; a better tree saves less
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(clusters.size()));
    rtcSetGeometryUserData(geometry, boxes.data());
    const auto on_bounds = [](const RTCBoundsFunctionArguments* args) {
        const ClusterBox& from = static_cast<const ClusterBox*>(args->geometryUserPtr)[args->primID];
        RTCBounds& box = *args->bounds_o;
        box.lower_x = from.lo.x, box.lower_y = from.lo.y, box.lower_z = from.lo.z;
        box.upper_x = from.hi.x, box.upper_y = from.hi.y, box.upper_z = from.hi.z;
    };
    rtcSetGeometryBoundsFunction(geometry, on_bounds, nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) throw std::bad_alloc();
}

// Runs Embree around p. `visit(cluster number)` is called for at least every cluster with a triangle within
// `distance`; it returns the distance that still matters, which may only shrink, or a negative number to
// stop.
template <class Visit>
void ClosestPointIndex::State::query(const glm::dvec3& p, double distance, Visit visit) const {
    const glm::dvec3 local = p - center;
    struct Call {
        Visit visit;
        double distance, slack;
    } call{std::move(visit), distance, slack(local)};
    RTCPointQuery query{};
    query.x = static_cast<float>(local.x);
    query.y = static_cast<float>(local.y);
    query.z = static_cast<float>(local.z);
    query.radius = widened(distance, call.slack);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const auto on_cluster = [](RTCPointQueryFunctionArguments* args) {
        Call& c = *static_cast<Call*>(args->userPtr);
        const double left = c.visit(args->primID);
        if (left >= c.distance) return false;
        c.distance = left;
        args->query->radius = left < 0.0 ? 0.0f : widened(left, c.slack);
        return true;
    };
    rtcPointQuery(scene, &query, &context, on_cluster, &call);
}

ClosestPointIndex::ClosestPointIndex(std::span<const Mesh* const> meshes)
    : state_(std::make_unique<State>()) {
    state_->build(meshes);
}

ClosestPointIndex::ClosestPointIndex(std::span<const Mesh> meshes) : state_(std::make_unique<State>()) {
    std::vector<const Mesh*> pointers;
    for (const Mesh& mesh : meshes) pointers.push_back(&mesh);
    state_->build(pointers);
}

ClosestPointIndex::~ClosestPointIndex() = default;

// The search of one point, cluster by cluster.
struct ClosestPointIndex::Search {
    const State& state;
    glm::dvec3 p;
    glm::vec3 local;
    double slack;
    ClosestPoint best;
    float limit = 0.0f;  // of bounds that may still matter

    Search(const State& all, const glm::dvec3& point, double max_distance)
        : state(all),
          p(point),
          local(point - all.center),
          slack(all.slack(point - all.center)),
          best{max_distance * max_distance, ClosestPoint::none, {}} {
        update_limit();
    }
    void update_limit() { limit = State::widened(std::sqrt(best.distance_squared), slack); }
    void offer(std::uint32_t slot) {
        ClosestPoint other = closest_on_triangle(p, state.shape(slot));
        other.triangle = state.triangles[slot].number;
        if (!nearer(other, best)) return;
        best = other;
        update_limit();
    }
    void offer_cluster(const TriangleCluster& cluster) {
        const auto rounding = static_cast<float>(slack) + 2e-6f * limit;
        const auto squared = disc_distances(cluster, local, rounding);
        for (std::size_t i = 0; i < TriangleCluster::size; ++i)
            if (!(squared.least[i] > limit * limit)) offer(cluster.slot[i]);
    }
};

ClosestPoint ClosestPointIndex::closest(const glm::dvec3& p, double max_distance, std::uint32_t hint) const {
    Search search(*state_, p, max_distance);
    if (hint != ClosestPoint::none) search.offer(state_->slots[hint]);
    state_->query(p, std::sqrt(search.best.distance_squared), [&](std::uint32_t cluster) {
        search.offer_cluster(state_->clusters[cluster]);
        return std::sqrt(search.best.distance_squared);
    });
    return search.best;
}

// The search of a near place. The middle of a small triangle's disc, which lies on the triangle, will do: its
// record need not be fetched.
struct ClosestPointIndex::Approach {
    const State& state;
    glm::dvec3 p;
    glm::vec3 local;
    double slack, tolerance;
    NearPlace best;
    float limit;  // of bounds that may still matter

    Approach(const State& all, const glm::dvec3& point, double max_distance, double tolerated)
        : state(all),
          p(point),
          local(point - all.center),
          slack(all.slack(point - all.center)),
          tolerance(tolerated),
          best{ClosestPoint::none, max_distance, {}},
          limit(State::widened(max_distance, slack)) {}

    // What is left to look for, or a negative number.
    double left() const {
        return best.slot == ClosestPoint::none ? best.distance : best.distance - tolerance;
    }
    void take(const NearPlace& place) {
        best = place;
        limit = left() < 0.0 ? -1.0f : State::widened(left(), slack);
    }
    void offer(std::uint32_t slot) {
        const TriangleShape s = state.shape(slot);
        const ClosestPoint c = closest_on_triangle(p, s);
        const double distance = std::sqrt(c.distance_squared);
        if (distance < best.distance || (best.slot == ClosestPoint::none && distance == best.distance))
            take({slot, distance, s.a + s.ab * c.barycentric.x + s.ac * c.barycentric.y});
    }
    void offer_cluster(const TriangleCluster& cluster) {
        const auto rounding = static_cast<float>(slack) + 2e-6f * std::max(limit, 0.0f);
        const DiscDistances squared = disc_distances(cluster, local, rounding);
        for (std::size_t i = 0; i < TriangleCluster::size; ++i) {
            if (limit < 0.0f || squared.least[i] > limit * limit) continue;
            const double middle = std::sqrt(squared.middle[i]);
            if (cluster.bound(i).normal == glm::vec3(0.0f) ||
                middle - std::sqrt(squared.least[i]) > tolerance)
                offer(cluster.slot[i]);
            else if (best.slot == ClosestPoint::none || middle < best.distance)
                take({cluster.slot[i], middle, glm::dvec3(cluster.bound(i).center) + state.center});
        }
    }
    void start(std::uint32_t hint) {
        if (hint != ClosestPoint::none) offer_cluster(state.clusters[hint / TriangleCluster::size]);
    }
};

NearPlace ClosestPointIndex::near_place(const glm::dvec3& p, double max_distance, double tolerance,
                                        std::uint32_t hint) const {
    Approach approach(*state_, p, max_distance, tolerance);
    approach.start(hint);
    if (approach.left() < 0.0) return approach.best;
    state_->query(p, approach.left(), [&](std::uint32_t cluster) {
        approach.offer_cluster(state_->clusters[cluster]);
        return approach.left();
    });
    return approach.best;
}

NearPlace ClosestPointIndex::near_place(ClusterList& list, const glm::dvec3& p, double max_distance,
                                        double tolerance, std::uint32_t hint) const {
    Approach approach(*state_, p, max_distance, tolerance);
    measure_boxes(list, approach.local);
    approach.start(hint);
    for (std::size_t i = 0; i < list.count && approach.limit >= 0.0f; ++i) {
        if (!(list.squared[i] > approach.limit * approach.limit))
            approach.offer_cluster(state_->clusters[list.cluster[i]]);
    }
    return approach.best;
}

ClosestPoint ClosestPointIndex::closest_brute_force(const glm::dvec3& p, double max_distance) const {
    ClosestPoint best{max_distance * max_distance, ClosestPoint::none, {}};
    for (std::uint32_t triangle = 0; triangle < state_->slots.size(); ++triangle) {
        const ClosestPoint other = closest_of(triangle, p);
        if (nearer(other, best)) best = other;
    }
    return best;
}

void ClosestPointIndex::collect(const glm::dvec3& center, double radius,
                                std::vector<std::uint32_t>& clusters) const {
    clusters.clear();
    state_->query(center, radius, [&](std::uint32_t cluster) {
        clusters.push_back(cluster);
        return radius;
    });
}

bool ClosestPointIndex::collect(const glm::dvec3& center, double radius, ClusterList& list) const {
    bool fits = true;
    list.count = 0;
    state_->query(center, radius, [&](std::uint32_t cluster) {
        fits = list.add(cluster, state_->boxes[cluster]);
        return fits ? radius : -1.0;
    });
    return fits;
}

const glm::dvec3& ClosestPointIndex::origin() const { return state_->center; }

double ClosestPointIndex::slack(const glm::dvec3& center, double radius) const {
    return state_->slack(glm::abs(center - state_->center) + radius);
}

ClosestPoint ClosestPointIndex::closest_of(std::uint32_t triangle, const glm::dvec3& p) const {
    ClosestPoint closest = closest_on_triangle(p, shape(triangle));
    closest.triangle = triangle;
    return closest;
}

TriangleShape ClosestPointIndex::shape(std::uint32_t triangle) const {
    return state_->shape(state_->slots[triangle]);
}
const ClusteredTriangle* ClosestPointIndex::triangles() const { return state_->triangles.data(); }
const TriangleCluster* ClosestPointIndex::clusters() const { return state_->clusters.data(); }

bool ClosestPointIndex::has_plane(std::uint32_t slot) const {
    const TriangleCluster& cluster = state_->clusters[slot / TriangleCluster::size];
    return cluster.bound(slot % TriangleCluster::size).normal != glm::vec3(0.0f);
}

std::int64_t ClosestPointIndex::triangle_count() const {
    return static_cast<std::int64_t>(state_->slots.size());
}

}  // namespace astrosplat

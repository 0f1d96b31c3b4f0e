// Clusters: the corners of all triangles, their places on the curve, and then eight at a time.
#include "generate/triangle_clusters.h"

#include <fmt/format.h>

#include <cstddef>
#include <limits>
#include <vector>

#include "core/bounds.h"
#include "core/error.h"
#include "core/parallel.h"
#include "generate/curve_order.h"
#include "generate/triangle_bounds.h"

namespace astrosplat {
namespace {

constexpr std::size_t most_triangles = ClosestPoint::none;  // so that it is no triangle's number or slot
constexpr std::int64_t triangles_per_chunk = 4096;

// Of all triangles, by number.
Buffer<TriangleCorners> corners_of(std::span<const Mesh* const> meshes) {
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
        parallel_chunks(triangles, triangles_per_chunk, [&](std::int64_t begin, std::int64_t end, int) {
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

Bounds box_of(const Buffer<TriangleCorners>& corners) {
    const auto count = static_cast<std::int64_t>(corners.size());
    std::vector<Bounds> boxes(
        static_cast<std::size_t>((count + triangles_per_chunk - 1) / triangles_per_chunk));
    parallel_chunks(count, triangles_per_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        Bounds box;
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            for (const glm::vec3& p : {corners[i].a, corners[i].b, corners[i].c}) box.add(glm::dvec3(p));
        boxes[static_cast<std::size_t>(begin / triangles_per_chunk)] = box;
    });
    Bounds all;
    for (const Bounds& box : boxes) {
        all.add(box.lo);
        all.add(box.hi);
    }
    return all;
}

void place_origin(const Buffer<TriangleCorners>& corners, TriangleClusters& to) {
    if (corners.empty()) return;
    const Bounds box = box_of(corners);
    to.center = box.center();
    const glm::dvec3 half = box.extent() * 0.5;
    to.reach = std::max({half.x, half.y, half.z});
}

// Places of the triangles' middles on the curve, in the upper halves, and numbers; in order.
Buffer<std::uint64_t> curve_order(const Buffer<TriangleCorners>& corners, const glm::dvec3& center,
                                  double reach) {
    const auto count = static_cast<std::int64_t>(corners.size());
    Buffer<std::uint64_t> order(corners.size());
    parallel_chunks(count, triangles_per_chunk, [&](std::int64_t begin, std::int64_t end, int) {
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
    return order;
}

// The slot of a cluster's i-th triangle. One that has fewer repeats its last.
std::size_t slot_of(std::size_t cluster, std::size_t i, std::size_t triangles) {
    return std::min(cluster * TriangleCluster::size + i, triangles - 1);
}

void place_cluster(std::size_t cluster, const Buffer<TriangleCorners>& corners,
                   const Buffer<std::uint64_t>& order, TriangleClusters& to) {
    constexpr float far = std::numeric_limits<float>::infinity();
    ClusterBox& box = to.boxes[cluster];
    box.lo = glm::vec3(far), box.hi = glm::vec3(-far);
    for (std::size_t i = 0; i < TriangleCluster::size; ++i) {
        const std::size_t slot = slot_of(cluster, i, order.size());
        const auto number = static_cast<std::uint32_t>(order[slot]);
        to.triangles[slot].corners = corners[number];
        to.triangles[slot].number = number;
        to.slots[number] = static_cast<std::uint32_t>(slot);
        const TriangleBox triangle = triangle_box(triangle_shape(corners[number]), to.center);
        box.lo = glm::min(box.lo, triangle.lo), box.hi = glm::max(box.hi, triangle.hi);
    }
}

// The place is on a triangle from the middle of the cluster, where that has a plane.
void bound_cluster(std::size_t cluster, TriangleClusters& to) {
    ClusterBox& box = to.boxes[cluster];
    box.place = glm::vec3(std::numeric_limits<float>::quiet_NaN()), box.slot = 0;
    bool placed = false;
    for (std::size_t i = 0; i < TriangleCluster::size; ++i) {
        const std::size_t slot = slot_of(cluster, i, to.triangles.size());
        const TriangleBounds bounds = triangle_bounds(triangle_shape(to.triangles[slot].corners), to.center);
        to.clusters[cluster].set(i, static_cast<std::uint32_t>(slot), bounds.disc);
        to.triangles[slot].edges = bounds.edges;
        if (bounds.disc.normal == glm::vec3(0.0f) || (placed && i > TriangleCluster::size / 2)) continue;
        box.place = bounds.disc.center, box.slot = static_cast<std::uint32_t>(slot);
        placed = true;
    }
}

}  // namespace

TriangleClusters place_clusters(std::span<const Mesh* const> meshes) {
    const Buffer<TriangleCorners> corners = corners_of(meshes);
    TriangleClusters to;
    place_origin(corners, to);
    const Buffer<std::uint64_t> order = curve_order(corners, to.center, to.reach);
    constexpr std::size_t size = TriangleCluster::size;
    to.clusters.resize((corners.size() + size - 1) / size);
    to.boxes.resize(to.clusters.size());
    to.triangles.resize(corners.size());
    to.slots.resize(corners.size());
    parallel_chunks(static_cast<std::int64_t>(to.clusters.size()), triangles_per_chunk / std::int64_t{size},
                    [&](std::int64_t begin, std::int64_t end, int) {
                        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
                            place_cluster(i, corners, order, to);
                    });
    return to;
}

void bound_clusters(std::size_t begin, std::size_t end, TriangleClusters& clusters) {
    for (std::size_t i = begin; i < end; ++i) bound_cluster(i, clusters);
}

}  // namespace astrosplat

// Bounds, order and consistency of splat sets.
#include "splats/splat_set.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <vector>

#include "core/parallel.h"

namespace astrosplat {
namespace {

constexpr std::int64_t chunk = 1 << 16;

template <class T>
void permute(Buffer<T>& values, const Buffer<std::int64_t>& from) {
    if (values.empty()) return;
    Buffer<T> sorted;
    sorted.resize(values.size());
    parallel_chunks(
        static_cast<std::int64_t>(from.size()), chunk, [&](std::int64_t begin, std::int64_t end, int) {
            for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
                sorted[i] = values[static_cast<std::size_t>(from[i])];
            }
        });
    values = std::move(sorted);
}

template <class T>
void give_back(Buffer<T>& values) {
    values = Buffer<T>();  // clear() would keep the memory
}

template <class Visit>
void for_each_array(SplatSet& set, Visit visit) {
    visit(set.position);
    visit(set.color);
    visit(set.alpha);
    visit(set.distance);
    visit(set.id);
    visit(set.uv);
    visit(set.normal);
    visit(set.mesh);
    visit(set.radius);
}

}  // namespace

void drop_splats(SplatSet& set) {
    for_each_array(set, [](auto& values) { give_back(values); });
}

void drop_columns(SplatSet& set, const OptionalColumns& wanted) {
    if (!wanted.uv) give_back(set.uv);
    if (!wanted.normal) give_back(set.normal);
    if (!wanted.mesh) give_back(set.mesh);
}

Bounds bounds(const SplatSet& set) {
    const std::int64_t chunks = (set.size() + chunk - 1) / chunk;
    std::vector<Bounds> parts(static_cast<std::size_t>(chunks));
    parallel_for(chunks, [&](std::int64_t part, int) {
        Bounds box;  // kept apart from its neighbours in `parts`, which other threads write
        const std::int64_t end = std::min(set.size(), (part + 1) * chunk);
        for (std::int64_t i = part * chunk; i < end; ++i) {
            box.add(glm::dvec3(set.position[static_cast<std::size_t>(i)]));
        }
        parts[static_cast<std::size_t>(part)] = box;
    });
    Bounds box;
    for (const Bounds& part : parts) box.add(part);
    return box;
}

void sort_by_id(SplatSet& set) {
    check_consistent(set);
    if (std::is_sorted(set.id.begin(), set.id.end())) return;
    Buffer<std::int64_t> order;
    order.resize(set.id.size());
    std::iota(order.begin(), order.end(), std::int64_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) {
        return set.id[static_cast<std::size_t>(a)] < set.id[static_cast<std::size_t>(b)];
    });
    for_each_array(set, [&](auto& values) { permute(values, order); });
}

void check_consistent([[maybe_unused]] const SplatSet& set) {
    [[maybe_unused]] const std::size_t size = set.position.size();
    [[maybe_unused]] const auto known_or_empty = [&](std::size_t n) { return n == size || n == 0; };
    assert(set.color.size() == size && set.alpha.size() == size);
    assert(set.distance.size() == size && set.id.size() == size);
    assert(known_or_empty(set.uv.size()) && known_or_empty(set.normal.size()));
    assert(known_or_empty(set.mesh.size()) && known_or_empty(set.radius.size()));
}

}  // namespace astrosplat

// Radix sort of (inverted depth bits, index), as SplatSorter in the engine; equal depths by layer and id.
#include "gl/order.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "camera/projection.h"
#include "core/radix_sort.h"

namespace astrosplat {
namespace {

/// ~depth in the upper half, so that ascending is far to near; the splat's index below.
using Key = std::uint64_t;

std::uint32_t depth_bits(const OrderLayer& layer, const glm::vec4& place, const Lens& lens) {
    const glm::vec3 p(layer.camera_from_layer * glm::dvec3(place) + layer.origin_in_camera);
    const float key = shared::sort_key(lens, p);
    return key > 0.0f ? std::bit_cast<std::uint32_t>(key) : 0u;
}

void make_keys(const OrderJob& job, Buffer<Key>& keys) {
    keys.clear();
    keys.reserve(job.places->size());
    for (const OrderLayer& layer : job.layers) {
        for (std::int64_t i = layer.first; i < layer.first + layer.count; ++i) {
            const glm::vec4& place = (*job.places)[static_cast<std::size_t>(i)];
            if (place.w < 0.0f) continue;
            keys.push_back(Key{~depth_bits(layer, place, job.lens)} << 32 | Key(i));
        }
    }
}

/// Layer and id of a splat: larger is farther at equal depth.
struct TieBreak {
    const OrderJob& job;
    std::pair<std::size_t, std::uint64_t> of(Key key) const {
        const auto i = static_cast<std::int64_t>(key & 0xffffffffu);
        std::size_t l = job.layers.size() - 1;
        while (l > 0 && i < job.layers[l].first) --l;
        return {l, job.layers[l].set->id[static_cast<std::size_t>(i - job.layers[l].first)]};
    }
    bool operator()(Key a, Key b) const { return of(a) > of(b); }
};

void break_ties(const OrderJob& job, Buffer<Key>& keys) {
    for (std::size_t i = 0; i < keys.size();) {
        std::size_t end = i + 1;
        while (end < keys.size() && keys[end] >> 32 == keys[i] >> 32) ++end;
        if (end - i > 1)
            std::sort(keys.begin() + std::ptrdiff_t(i), keys.begin() + std::ptrdiff_t(end), TieBreak{job});
        i = end;
    }
}

}  // namespace

Order sort_far_to_near(const OrderJob& job, OrderScratch& scratch) {
    Buffer<Key>& keys = scratch.keys;
    make_keys(job, keys);
    scratch.other.resize(keys.size());
    const Key* const sorted = radix_sort<11>(
        keys.data(), scratch.other.data(), keys.size(), 32, 64, [](Key key) { return key; }, [] {});
    if (sorted != keys.data()) keys.swap(scratch.other);
    break_ties(job, keys);
    Order order;
    order.version = job.version;
    order.splats.resize(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) order.splats[i] = static_cast<std::uint32_t>(keys[i]);
    const float limit = shared::key_of_distance(job.lens, static_cast<float>(job.far_from));
    const Key nearest_far = Key{~std::bit_cast<std::uint32_t>(std::max(limit, 0.0f))} << 32;
    order.far_count = std::lower_bound(keys.begin(), keys.end(), nearest_far) - keys.begin();
    return order;
}

void OrderThread::submit(std::size_t slot, OrderJob job) {
    {
        const auto held = worker_.lock();
        jobs_[slot] = std::move(job);
    }
    worker_.wake();
}

std::optional<Order> OrderThread::take(std::size_t slot) {
    const auto held = worker_.lock();
    const auto found = orders_.find(slot);
    if (found == orders_.end()) return std::nullopt;
    std::optional<Order> order(std::move(found->second));
    orders_.erase(found);
    return order;
}

bool OrderThread::busy() const {
    const auto held = worker_.lock();
    return worker_.working() || !jobs_.empty();
}

bool OrderThread::wait(std::chrono::microseconds at_most) {
    return worker_.wait_for(at_most, [this] { return !worker_.working() && jobs_.empty(); });
}

Worker::Task OrderThread::next_job() {
    if (jobs_.empty()) return {};
    const std::size_t slot = jobs_.begin()->first;
    return [this, slot, job = std::move(jobs_.extract(slot).mapped())] {
        Order order = sort_far_to_near(job, scratch_);
        const auto held = worker_.lock();
        orders_[slot] = std::move(order);
    };
}

}  // namespace astrosplat

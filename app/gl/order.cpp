// Radix sort of (inverted depth bits, index), as SplatSorter in the engine; equal depths by layer and id.
#include "gl/order.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "camera/projection.h"
#include "core/sorting.h"

namespace astrosplat {
namespace {

/// ~depth in the upper half, so that ascending is far to near; the splat's index below.
using Code = std::uint64_t;

std::uint32_t depth_bits(const OrderLayer& layer, const glm::vec4& place, const Lens& lens) {
    const glm::vec3 p(layer.camera_from_layer * glm::dvec3(place) + layer.origin_in_camera);
    const float code = shared::sort_depth(lens, p);
    return code > 0.0f ? std::bit_cast<std::uint32_t>(code) : 0u;
}

void make_codes(const OrderJob& job, Buffer<Code>& codes) {
    codes.clear();
    codes.reserve(job.places->size());
    for (const OrderLayer& layer : job.layers) {
        for (std::int64_t i = layer.first; i < layer.first + layer.count; ++i) {
            const glm::vec4& place = (*job.places)[static_cast<std::size_t>(i)];
            if (place.w < 0.0f) continue;
            codes.push_back(Code{~depth_bits(layer, place, job.lens)} << 32 | Code(i));
        }
    }
}

/// Layer and id of a splat: larger is farther at equal depth.
struct TieBreak {
    const OrderJob& job;
    std::pair<std::size_t, std::uint64_t> of(Code code) const {
        const auto i = static_cast<std::int64_t>(code & 0xffffffffu);
        std::size_t l = job.layers.size() - 1;
        while (l > 0 && i < job.layers[l].first) --l;
        const auto row = static_cast<std::size_t>(i - job.layers[l].first);
        return {l, job.layers[l].set ? job.layers[l].set->id[row] : row};
    }
    bool operator()(Code a, Code b) const { return of(a) > of(b); }
};

void break_ties(const OrderJob& job, Buffer<Code>& codes) {
    for (std::size_t i = 0; i < codes.size();) {
        std::size_t end = i + 1;
        while (end < codes.size() && codes[end] >> 32 == codes[i] >> 32) ++end;
        if (end - i > 1)
            std::sort(codes.begin() + std::ptrdiff_t(i), codes.begin() + std::ptrdiff_t(end), TieBreak{job});
        i = end;
    }
}

}  // namespace

Order sort_far_to_near(const OrderJob& job, OrderScratch& scratch) {
    Buffer<Code>& codes = scratch.codes;
    make_codes(job, codes);
    scratch.other.resize(codes.size());
    const Code* const sorted = radix_sort<11>(
        codes.data(), scratch.other.data(), codes.size(), 32, 64, [](Code code) { return code; }, [] {});
    if (sorted != codes.data()) codes.swap(scratch.other);
    break_ties(job, codes);
    Order order;
    order.version = job.version;
    order.splats.resize(codes.size());
    for (std::size_t i = 0; i < codes.size(); ++i) order.splats[i] = static_cast<std::uint32_t>(codes[i]);
    const float limit = shared::sort_depth_of(job.lens, static_cast<float>(job.far_from));
    const Code nearest_far = Code{~std::bit_cast<std::uint32_t>(std::max(limit, 0.0f))} << 32;
    order.far_count = std::lower_bound(codes.begin(), codes.end(), nearest_far) - codes.begin();
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

// The order in which splats are blended, worked out beside the frame: places of all layers of a blend group
// and a camera -> indices, farthest first, by the engine's total order (render/screen_splat.h).
#pragma once

#include <chrono>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "camera/lens.h"
#include "core/buffer.h"
#include "core/worker.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// One layer's splats within the places, and how camera space is reached from layer space.
struct OrderLayer {
    std::int64_t first = 0, count = 0;
    glm::dmat3 camera_from_layer{1.0};
    glm::dvec3 origin_in_camera{0.0};
    std::shared_ptr<const SplatSet> set;  // its ids decide ties; null: their order does
};

struct OrderJob {
    std::shared_ptr<const Buffer<glm::vec4>> places;  // layer space; w < 0: not drawn
    std::vector<OrderLayer> layers;
    Lens lens;  // by whose sort_depth they are ordered
    /// Distance, as the sort depth measures it, beyond which `far_count` counts; scene units.
    double far_from = 0.0;
    std::uint64_t version = 0;  // the caller's number for this job
};

struct Order {
    Buffer<std::uint32_t> splats;  // indices into the places, farthest first
    std::int64_t far_count = 0;    // so many of them lie beyond far_from
    std::uint64_t version = 0;
};

/// Memory that sorting uses again; page faults cost as much as sorting.
struct OrderScratch {
    Buffer<std::uint64_t> codes, other;
};

/// With the bits the offline renderer sorts by.
Order sort_far_to_near(const OrderJob& job, OrderScratch& scratch);

/// A thread that sorts. Of the jobs for one slot only the newest is done.
class OrderThread {
  public:
    void submit(std::size_t slot, OrderJob job);
    /// The newest order of a slot, once.
    std::optional<Order> take(std::size_t slot);
    bool busy() const;
    /// Waits until nothing is left to do, at most so long. True when nothing is.
    bool wait(std::chrono::microseconds at_most);
    /// A number for a job, larger than any before.
    std::uint64_t next_version() { return ++last_version_; }

  private:
    Worker::Task next_job();

    std::uint64_t last_version_ = 0;  // of the caller's thread alone
    OrderScratch scratch_;            // of the worker's
    std::map<std::size_t, OrderJob> jobs_;
    std::map<std::size_t, Order> orders_;
    Worker worker_{[this] { return next_job(); }};
};

}  // namespace astrosplat

// Splats in GPU memory: those of a set as they are (RawSplats), and those of a blend group after their looks
// (ShadedBuffers), of all its layers one after the other; and the order in which these are blended, worked
// out beside the frame: places and a camera -> indices, farthest first, by the engine's total order
// (render/screen_splat.h).
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
#include "gl/objects.h"
#include "splats/shaded_splats.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// The splats of a set, as the look pass reads them.
class RawSplats {
  public:
    explicit RawSplats(std::shared_ptr<const SplatSet> set) : set_(std::move(set)) {}

    /// Uploads them; nothing where they are there already.
    void hold();
    const SplatSet& set() const { return *set_; }
    /// Layer space.
    const Bounds& box() {
        if (!box_) box_ = bounds(*set_);
        return *box_;
    }
    GLuint vertex_array() const { return vertices_.name(); }

  private:
    static constexpr int arrays = 7;  // locations of look_pass.glsl
    std::shared_ptr<const SplatSet> set_;
    std::optional<Bounds> box_;  // once it was asked for
    GlVertexArray vertices_;
    GlBuffer buffers_[arrays];
};

/// Position and radius, colour and alpha: 32 bytes a splat, and the order in which they are drawn.
class ShadedBuffers {
  public:
    /// Room for `count` splats; the contents are undefined where that changes anything.
    void resize(std::int64_t count);
    std::int64_t size() const { return size_; }
    GLuint places() const { return places_.name(); }
    GLuint colors() const { return colors_.name(); }

    /// Writes splats that are shaded already to [first], [first + 1], ...
    void upload(const ShadedSplats& splats, std::int64_t first);

    /// Position and radius of every splat, from the GPU; radius -1 was dropped.
    Buffer<glm::vec4> read_places() const;
    Buffer<glm::vec4> read_colors() const;

    /// Indices of splats, farthest first.
    void set_order(const Buffer<std::uint32_t>& order);
    /// Draws the splats [first, first + count) of the order, or of the buffers where `ordered` is false, as
    /// points, or as squares with the buffers as textures on units `unit` and `unit + 1`.
    void draw_points(bool ordered, std::int64_t first, std::int64_t count);
    void draw_quads(bool ordered, std::int64_t first, std::int64_t count, int unit);

  private:
    std::int64_t size_ = 0;
    GlBuffer places_, colors_, order_, counting_;
    std::int64_t counted_ = 0;  // counting_ holds 0, 1, 2, ... so many
    GlVertexArray points_, quads_;
    GlTexture place_texture_, color_texture_;
};

/// One layer's splats within the places, and how camera space is reached from layer space.
struct OrderLayer {
    std::int64_t first = 0, count = 0;
    glm::dmat3 camera_from_layer{1.0};
    glm::dvec3 origin_in_camera{0.0};
    std::shared_ptr<const SplatSet> set;  // its ids decide ties; null: their order does
    bool operator==(const OrderLayer&) const = default;
};

struct OrderJob {
    std::shared_ptr<const Buffer<glm::vec4>> places;  // layer space; w < 0: not drawn
    std::vector<OrderLayer> layers;
    Lens lens;  // by whose sort_depth they are ordered
    /// Distance, as the sort depth measures it, beyond which `far_count` counts; scene units.
    double far_from = 0.0;
    std::uint64_t version = 0;  // the caller's number for this job
    /// Their orders are equal; but for the kind of projection, lenses are not looked at.
    bool is_as(const OrderJob& other) const {
        return places == other.places && layers == other.layers && far_from == other.far_from &&
               lens.projection == other.lens.projection;
    }
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

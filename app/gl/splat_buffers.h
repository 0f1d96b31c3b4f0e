// Splats in GPU memory: those of a set as they are (RawSplats), and those of a blend group after their looks
// (ShadedBuffers), of all its layers one after the other.
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <memory>

#include "core/buffer.h"
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
    const std::shared_ptr<const SplatSet>& pointer() const { return set_; }
    GLuint vertex_array() const { return vertices_.name(); }

  private:
    static constexpr int arrays = 7;  // locations of look_pass.glsl
    std::shared_ptr<const SplatSet> set_;
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

}  // namespace astrosplat

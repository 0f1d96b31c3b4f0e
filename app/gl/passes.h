// How the preview is drawn on the GPU. The look: raw splats become the shaded splats of each blend group, in
// order, by look_splat of shaders/shared in transform feedback. Then what draws into the bound target: the
// environment as the bottom of the frame, and the splats, blended as the engine folds them, with the
// footprint tables (render/footprint.h) as textures. Out: linear premultiplied light.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/image.h"
#include "gl/objects.h"
#include "gl/preview_layer.h"
#include "gl/splat_buffers.h"
#include "look/shared_uniforms.h"
#include "render/environment.h"
#include "render/fold.h"
#include "render/footprint.h"
#include "render/project.h"

namespace astrosplat {

/// Values of a table for the vertex shader, besides its textures.
struct FootprintSlot {
    int table = 0;  // layer of the profiles, pair of rows of the nodes
    float reach = 1.0f;
    float core = 0.0f;
    bool flat_core = false;
};

/// Weight over distance for every falloff in use, and what normalises it.
class FootprintTextures {
  public:
    /// One slot per falloff, in order; tables that are not there yet are made (about 30 ms each).
    std::vector<FootprintSlot> prepare(const std::vector<Falloff>& falloffs, float pixel_filter_px);
    /// Weights: sampler2DArray of 256 x 513, linear; nodes: sampler2D, two rows a table.
    void bind(int profiles_unit, int nodes_unit) const;

  private:
    struct Entry {
        Falloff falloff;
        FootprintTable table;
    };
    void upload();
    std::vector<Entry> entries_;
    float pixel_filter_px_ = 0.0f;
    GlTexture profiles_, nodes_;
};

/// The vertex stage of what draws splats.
inline const std::vector<std::string> splat_vertex_files =
    after_projections({"maths.glsl", "blend.glsl", "footprint.glsl", "splat_vertex.glsl"});

/// One layer of a group: its constants for this frame, its footprints, and where its splats begin.
struct DrawLayer {
    LayerProjection projection;
    FootprintSlot footprint;
    std::int64_t first = 0;
};

struct DrawInput {
    const std::vector<DrawLayer>& layers;  // at most most_layers
    FoldKind kind = FoldKind::general;
    int width = 0, height = 0;     // px
    bool ordered = false;          // draw in the order of the buffers
    std::int64_t count = 0;        // splats
    std::int64_t point_count = 0;  // so many of them, from the first, are small enough for points
};

class DrawPass {
  public:
    static constexpr std::size_t most_layers = 64;  // MAX_LAYERS of splat_vertex.glsl
    DrawPass();
    /// Widest point, px.
    float widest_point_px() const { return widest_point_px_; }
    void draw(const DrawInput& input, ShadedBuffers& splats, const FootprintTextures& footprints);

  private:
    const GlProgram& program(FoldKind kind, bool quads);
    void upload_block(const DrawInput& input);

    std::map<int, std::unique_ptr<GlProgram>> programs_;  // compiled when first needed
    GlBuffer block_;
    float widest_point_px_ = 1.0f;
};

/// How the bound target takes what a group's shaders give, until end_blending().
void begin_blending(FoldKind kind);
void end_blending();

/// The fragment stage of what draws the environment.
inline const std::vector<std::string> environment_fragment_files =
    after_projections({"environment_fragment.glsl"});

class EnvironmentPass {
  public:
    EnvironmentPass();
    /// Fills the bound target: colour of the environment, alpha 1.
    void draw(const Environment& environment, const Camera& camera);

  private:
    /// One mip level of all faces, uploaded where it is not the one already there.
    struct Level {
        GlTexture texture;
        const float* pixels = nullptr;  // of the first face, and some of what they held
        float probe = 0.0f;
        void hold(const Environment& environment, std::size_t level);
    };
    GlProgram program_;
    WholeTarget triangle_;
    Level fine_, coarse_;
};

/// Bounds of the loops of a shader that is made for the look at hand; by default those of any look.
struct LookLimits {
    int stops = shared_types::LOOK_MAX_STOPS;
    int noises = shared_types::LOOK_MAX_NOISES;
    int points = shared_types::LOOK_MAX_POINTS;
    int octaves = 16;  // of a noise
    int crops = shared_types::LOOK_MAX_CROPS;
    auto operator<=>(const LookLimits&) const = default;
};

/// Small limits that hold this look, of few different ones, since each is a program to be compiled.
LookLimits limits_for(const LookUniforms& look);

struct LookPassInput {
    const LookUniforms& look;
    const Image* map = nullptr;  // raw values; read where there are several stops
};

class LookPass {
  public:
    LookPass();
    /// Writes all of `raw`, which holds them, to out[first], out[first + 1], ...
    void run(const RawSplats& raw, const LookPassInput& input, ShadedBuffers& out, std::int64_t first);

    /// The program for looks within these limits.
    static ProgramSource source_for(const LookLimits& limits);

  private:
    const GlProgram& program(const LookLimits& limits);
    void upload_map(const Image& map);

    std::map<LookLimits, std::unique_ptr<GlProgram>> programs_;  // compiled when first needed
    GlBuffer block_;
    GlTexture map_;
    GlTarget unused_;  // without a window OpenGL draws nothing where no target is bound
};

/// The raw splats of every set in use.
class RawSplatStore {
  public:
    RawSplats& of(const std::shared_ptr<const SplatSet>& set);
    /// Drops the sets not asked for since the last call.
    void drop_unused();

  private:
    struct Entry {
        std::unique_ptr<RawSplats> splats;
        bool used = true;
    };
    std::map<const SplatSet*, Entry> entries_;
};

/// The shaded splats of one blend group: a look is evaluated again only where look or inputs changed, and the
/// order only where places or camera did.
class GroupSplats {
  public:
    /// Brings the shaded splats of these layers up to date. Throws InputError as prepare_look does.
    void update(const std::vector<const PreviewLayer*>& layers, RawSplatStore& raw, LookPass& pass,
                bool ordered);
    /// Asks for the order seen by these projections if it is not the one there or on its way.
    void request_order(const std::vector<LayerProjection>& projections, double far_from, OrderThread& thread,
                       std::size_t slot);
    /// Takes the order if it has come.
    void take_order(OrderThread& thread, std::size_t slot);
    /// The order there is was made for these splats, perhaps seen from elsewhere.
    bool has_order() const { return first_version_ != 0 && order_version_ >= first_version_; }
    bool order_is_current() const { return order_version_ == requested_.version; }

    std::int64_t first_of(std::size_t layer) const { return parts_[layer].first; }
    std::int64_t shown() const { return buffers_.size(); }
    /// Largest radius of a layer, scene units of the layer.
    float largest_radius(std::size_t layer) const { return parts_[layer].largest_radius; }
    ShadedBuffers& buffers() { return buffers_; }
    std::int64_t ordered_count() const { return ordered_count_; }
    std::int64_t far_count() const { return far_count_; }

  private:
    /// A layer's splats and what they were made from.
    struct Part {
        std::shared_ptr<const SplatSet> set;  // null: its splats were given
        std::int64_t first = 0, count = 0;
        std::optional<Shading> shading;  // none: not shaded yet
        LookUniforms uniforms;
        float largest_radius = 0.0f;
    };

    bool lay_out(const std::vector<const PreviewLayer*>& layers);
    bool shade(Part& part, const PreviewLayer& layer, RawSplatStore& raw, LookPass& pass);

    std::vector<Part> parts_;
    ShadedBuffers buffers_;
    std::shared_ptr<const Buffer<glm::vec4>> places_;
    OrderJob requested_;
    std::uint64_t order_version_ = 0;
    /// Asked for since the layout last changed; older orders are for other splats.
    std::uint64_t first_version_ = 0;
    std::int64_t ordered_count_ = 0, far_count_ = 0;
};

}  // namespace astrosplat

// The passes that draw into the bound target. In: the environment, of which the two mip levels that a camera
// needs become textures, as the bottom of the frame; the shaded splats of one blend group, blended as the
// engine folds them, and its footprint tables (render/footprint.h), here as textures. Out: linear
// premultiplied light.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "gl/splat_buffers.h"
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

}  // namespace astrosplat

// Drawing the splats of one blend group into the bound target, blended as the engine folds them.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gl/footprint_textures.h"
#include "gl/program.h"
#include "gl/splat_buffers.h"
#include "render/fold.h"
#include "render/project.h"

namespace astrosplat {

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

}  // namespace astrosplat

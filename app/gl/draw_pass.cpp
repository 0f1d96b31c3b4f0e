#include "gl/draw_pass.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <string>

namespace astrosplat {
namespace {

// DrawBlock of splat_vertex.glsl; sixteens of bytes, so that std140 is how C++ lays it out.
struct LayerBlock {
    glm::vec4 right, up, back, eye_low, axis, blend, falloff, absorb;
};
struct Block {
    Lens lens;
    float to_sixteens[3];
    glm::vec4 target;
    std::int32_t layers_used[4];
    std::int32_t first_splat[DrawPass::most_layers];
    LayerBlock layers[DrawPass::most_layers];
};
static_assert(sizeof(LayerBlock) == 8 * 16 && sizeof(Lens) == 36 && offsetof(Block, target) == 3 * 16 &&
              sizeof(Block) == 5 * 16 + 64 * 4 + 64 * 8 * 16);

constexpr int profiles_unit = 0, nodes_unit = 1, places_unit = 2;  // and 3: colours
constexpr float widest_useful_px = 512.0f;

/// The eye in layer space, as two floats a coordinate: what is left of a splat's float position after
/// subtracting both is as exact as the double arithmetic of the engine.
LayerBlock layer_block(const DrawLayer& layer) {
    const LayerProjection& p = layer.projection;
    const glm::dmat3 rows = glm::transpose(p.camera_from_layer);
    const glm::dvec3 eye = -(glm::inverse(p.camera_from_layer) * p.origin_in_camera);
    const glm::vec3 eye_high(eye);
    const glm::vec3 eye_low(eye - glm::dvec3(eye_high));
    const auto row = [&](int i) { return glm::vec4(glm::vec3(rows[i]), eye_high[i]); };
    return {row(0),
            row(1),
            row(2),
            glm::vec4(eye_low, p.radius_scale),
            glm::vec4(p.axis_in_camera, p.opacity),
            {static_cast<float>(p.render.blend), p.render.hybrid_from_deg, p.render.hybrid_to_deg,
             p.render.holdout ? 1.0f : 0.0f},
            {static_cast<float>(layer.footprint.table), layer.footprint.reach, layer.footprint.core,
             layer.footprint.flat_core ? 1.0f : 0.0f},
            glm::vec4(p.render.absorb, 0.0f)};
}

}  // namespace

void begin_blending(FoldKind kind) {
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    switch (kind) {
        case FoldKind::over:
            glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
            break;
        case FoldKind::add:
            glBlendFunc(GL_ONE, GL_ONE);
            break;
        case FoldKind::general:
            glBlendFuncSeparate(GL_ONE, GL_SRC1_COLOR, GL_ONE, GL_SRC1_ALPHA);
            break;
        case FoldKind::lighten:
            glBlendEquationSeparate(GL_MAX, GL_FUNC_ADD);
            glBlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
            break;
    }
}

void end_blending() {
    glBlendEquation(GL_FUNC_ADD);
    glDisable(GL_BLEND);
}

DrawPass::DrawPass() {
    GLfloat range[2] = {1.0f, 1.0f};
    glGetFloatv(GL_POINT_SIZE_RANGE, range);
    widest_point_px_ = std::min(range[1], widest_useful_px);
}

const GlProgram& DrawPass::program(FoldKind kind, bool quads) {
    std::unique_ptr<GlProgram>& entry = programs_[static_cast<int>(kind) * 2 + (quads ? 1 : 0)];
    if (entry) return *entry;
    std::vector<std::string> defines = {"KIND " + std::to_string(static_cast<int>(kind))};
    if (quads) defines.push_back("QUADS");
    entry = std::make_unique<GlProgram>(
        ProgramSource{defines, splat_vertex_files, {"maths.glsl", "blend.glsl", "splat_fragment.glsl"}, {}});
    entry->set_block("DrawBlock", 0);
    entry->set_sampler("footprint_profiles", profiles_unit);
    entry->set_sampler("footprint_nodes", nodes_unit);
    entry->set_sampler("places", places_unit);
    entry->set_sampler("colors", places_unit + 1);
    return *entry;
}

void DrawPass::upload_block(const DrawInput& input) {
    assert(!input.layers.empty() && input.layers.size() <= most_layers);
    Block block;
    std::memset(&block, 0, sizeof block);
    const LayerProjection& p = input.layers[0].projection;
    block.lens = p.lens;
    block.target = {float(input.width), float(input.height), 0.5f * widest_point_px_, p.margin_px};
    block.layers_used[0] = static_cast<std::int32_t>(input.layers.size());
    for (std::size_t l = 0; l < input.layers.size(); ++l) {
        block.first_splat[l] = static_cast<std::int32_t>(input.layers[l].first);
        block.layers[l] = layer_block(input.layers[l]);
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, block_.get());
    glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
}

void DrawPass::draw(const DrawInput& input, ShadedBuffers& splats, const FootprintTextures& footprints) {
    if (input.count == 0) return;
    upload_block(input);
    footprints.bind(profiles_unit, nodes_unit);
    // Points whose centre is outside the view volume are not drawn, so the volume is wider than the frame.
    const float margin_px = 0.5f * widest_point_px_;
    glViewportIndexedf(0, -margin_px, -margin_px, float(input.width) + 2.0f * margin_px,
                       float(input.height) + 2.0f * margin_px);
    glEnable(GL_PROGRAM_POINT_SIZE);
    begin_blending(input.kind);
    if (input.point_count > 0) {
        program(input.kind, false).use();
        splats.draw_points(input.ordered, 0, input.point_count);
    }
    if (input.point_count < input.count) {
        program(input.kind, true).use();
        splats.draw_quads(input.ordered, input.point_count, input.count - input.point_count, places_unit);
    }
    end_blending();
    glDisable(GL_PROGRAM_POINT_SIZE);
    glViewport(0, 0, input.width, input.height);
}

}  // namespace astrosplat

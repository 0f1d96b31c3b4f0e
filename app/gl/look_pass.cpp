#include "gl/look_pass.h"

#include <algorithm>
#include <glm/vec4.hpp>

namespace astrosplat {
namespace {

/// The smallest of a few steps that is large enough.
int step_up(int value, std::initializer_list<int> steps) {
    for (int step : steps)
        if (value <= step) return step;
    return value;
}

}  // namespace

LookLimits limits_for(const LookUniforms& look) {
    using namespace shared_types;
    bool curve = look.vertical.shape == PROFILE_CURVE;
    for (int k = 0; k < look.stop_count; ++k) curve = curve || look.stops[k].pdf.shape == PROFILE_CURVE;
    int octaves = 0;
    for (int k = 0; k < look.noise_count; ++k) octaves = std::max(octaves, look.noises[k].octaves);
    return {step_up(look.stop_count, {1, 3, LOOK_MAX_STOPS}),
            step_up(look.noise_count, {1, 2, LOOK_MAX_NOISES}), curve ? LOOK_MAX_POINTS : 1,
            step_up(octaves, {0, 4, 6, 16}), step_up(look.crop_count, {0, 2, LOOK_MAX_CROPS})};
}

ProgramSource LookPass::source_for(const LookLimits& limits) {
    return {{},
            {"maths.glsl", "noise.glsl", "look_uniforms.glsl", "look.glsl", "look_pass.glsl"},
            {},
            {"shaded_place", "shaded_color"},
            {{"LOOK_STOPS", limits.stops},
             {"LOOK_NOISES", limits.noises},
             {"LOOK_POINTS", limits.points},
             {"LOOK_CROPS", limits.crops},
             {"AS_NOISE_MAX_OCTAVES", limits.octaves}}};
}

LookPass::LookPass() { upload_map(make_image(1, 1, 3)); }

// Loops in a shader cost what they could do at most: software rasterisers run every step of them.
const GlProgram& LookPass::program(const LookLimits& limits) {
    std::unique_ptr<GlProgram>& entry = programs_[limits];
    if (!entry) {
        entry = std::make_unique<GlProgram>(source_for(limits));
        entry->set_block("LookBlock", 0);
        entry->set_sampler("thickness_map", 0);
    }
    return *entry;
}

void LookPass::upload_map(const Image& map) {
    const GLenum format = map.channels == 1   ? GL_RED
                          : map.channels == 2 ? GL_RG
                          : map.channels == 3 ? GL_RGB
                                              : GL_RGBA;
    glBindTexture(GL_TEXTURE_2D, map_.get());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, static_cast<GLsizei>(map.width),
                 static_cast<GLsizei>(map.height), 0, format, GL_FLOAT, map.pixels.data());
    set_sampling(GL_TEXTURE_2D, GL_NEAREST);
    // One channel counts for all three, as the engine reads it.
    const bool gray = map.channels < 3;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_G, gray ? GL_RED : GL_GREEN);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_B, gray ? GL_RED : GL_BLUE);
}

void LookPass::run(const RawSplats& raw, const LookPassInput& input, ShadedBuffers& out, std::int64_t first) {
    const std::int64_t count = raw.set().size();
    if (count == 0) return;
    unused_.resize(1, 1, GL_RGBA8);
    unused_.bind();
    const GlProgram& program = this->program(limits_for(input.look));
    program.use();
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, block_.get());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(LookUniforms), &input.look, GL_STREAM_DRAW);
    if (input.map && input.look.stop_count > 1) upload_map(*input.map);
    bind_texture(0, GL_TEXTURE_2D, map_.name());
    const auto offset = static_cast<GLintptr>(sizeof(glm::vec4)) * first;
    const auto size = static_cast<GLsizeiptr>(sizeof(glm::vec4)) * count;
    glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, out.places(), offset, size);
    glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 1, out.colors(), offset, size);
    glEnable(GL_RASTERIZER_DISCARD);
    glBindVertexArray(raw.vertex_array());
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(count));
    glEndTransformFeedback();
    glBindVertexArray(0);
    glDisable(GL_RASTERIZER_DISCARD);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 1, 0);
}

}  // namespace astrosplat

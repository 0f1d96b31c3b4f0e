#include "gl/look_pass.h"

#include <algorithm>
#include <glm/vec4.hpp>

#include "look/prepare.h"

namespace astrosplat {
namespace {

/// The smallest of a few steps that is large enough.
int step_up(int value, std::initializer_list<int> steps) {
    for (int step : steps)
        if (value <= step) return step;
    return value;
}

/// No splat of the set is larger, whatever its random numbers and alpha are.
float radius_bound(const SplatSet& set, const LookUniforms& u) {
    float radius = std::max(u.radius.smallest, u.radius.largest);
    if (u.radius.own)
        for (const float own : set.radius) radius = std::max(radius, own);
    return radius * std::max(1.0f, u.radius.horizontal_scale) * std::max(1.0f, u.radius.vertical_scale);
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
    return {.vertex = {"maths.glsl", "noise.glsl", "look_uniforms.glsl", "look.glsl", "look_pass.glsl"},
            .feedback = {"shaded_place", "shaded_color"},
            .constants = {{"LOOK_STOPS", limits.stops},
                          {"LOOK_NOISES", limits.noises},
                          {"LOOK_POINTS", limits.points},
                          {"LOOK_CROPS", limits.crops},
                          {"AS_NOISE_MAX_OCTAVES", limits.octaves}},
            .samplers = {{"thickness_map", 0}},
            .block = "LookBlock"};
}

LookPass::LookPass() { upload_map(make_image(1, 1, 3)); }

// Loops in a shader cost what they could do at most: software rasterisers run every step of them.
const GlProgram& LookPass::program(const LookLimits& limits) {
    std::unique_ptr<GlProgram>& entry = programs_[limits];
    if (!entry) entry = std::make_unique<GlProgram>(source_for(limits));
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

RawSplats& RawSplatStore::of(const std::shared_ptr<const SplatSet>& set) {
    Entry& entry = entries_[set.get()];
    if (!entry.splats) entry.splats = std::make_unique<RawSplats>(set);
    entry.used = true;
    return *entry.splats;
}

void RawSplatStore::drop_unused() {
    std::erase_if(entries_, [](const auto& entry) { return !entry.second.used; });
    for (auto& entry : entries_) entry.second.used = false;
}

bool GroupSplats::lay_out(const std::vector<const PreviewLayer*>& layers) {
    bool same = parts_.size() == layers.size();
    for (std::size_t l = 0; l < layers.size() && same; ++l)
        same = !layers[l]->layer.splats && parts_[l].set == layers[l]->set;
    if (same) return false;
    parts_.clear();
    parts_.resize(layers.size());
    std::int64_t first = 0;
    for (std::size_t l = 0; l < layers.size(); ++l) {
        if (!layers[l]->layer.splats) parts_[l].set = layers[l]->set;
        parts_[l].first = first;
        parts_[l].count = shown_count(*layers[l]);
        first += parts_[l].count;
    }
    buffers_.resize(first);
    first_version_ = 0;
    return true;
}

bool GroupSplats::shade(Part& part, const PreviewLayer& layer, RawSplatStore& raw, LookPass& pass) {
    RawSplats& splats = raw.of(layer.set);
    Shading now = shading_of(layer);
    if (part.shading == now) return false;
    part.uniforms = prepare_look(*layer.set, layer.look, layer.inputs);
    part.shading = std::move(now);
    part.largest_radius = radius_bound(*layer.set, part.uniforms);
    splats.hold();
    pass.run(splats, {part.uniforms, layer.inputs.thickness_map}, buffers_, part.first);
    return true;
}

void GroupSplats::update(const std::vector<const PreviewLayer*>& layers, RawSplatStore& raw, LookPass& pass,
                         bool ordered) {
    bool changed = lay_out(layers);
    for (std::size_t l = 0; l < layers.size(); ++l) {
        if (parts_[l].count == 0) continue;
        if (const ShadedSplats* const splats = layers[l]->layer.splats) {
            parts_[l].largest_radius = *std::ranges::max_element(splats->radius);
            buffers_.upload(*splats, parts_[l].first);
        } else {
            changed = shade(parts_[l], *layers[l], raw, pass) || changed;
        }
    }
    if (changed) {
        places_.reset();
        requested_.places.reset();
    }
    if (ordered && !places_) places_ = std::make_shared<const Buffer<glm::vec4>>(buffers_.read_places());
}

void GroupSplats::request_order(const std::vector<LayerProjection>& projections, double far_from,
                                OrderThread& thread, std::size_t slot) {
    OrderJob job{places_, {}, {}, far_from, 0};
    if (!projections.empty()) job.lens.projection = projections[0].lens.projection;
    for (std::size_t l = 0; l < parts_.size(); ++l)
        job.layers.push_back({parts_[l].first, parts_[l].count, projections[l].camera_from_layer,
                              projections[l].origin_in_camera, parts_[l].set});
    if (job.is_as(requested_) && first_version_ != 0) return;
    job.version = thread.next_version();
    if (first_version_ == 0) first_version_ = job.version;
    requested_ = job;
    thread.submit(slot, std::move(job));
}

void GroupSplats::take_order(OrderThread& thread, std::size_t slot) {
    const std::optional<Order> order = thread.take(slot);
    if (!order || first_version_ == 0 || order->version < first_version_) return;
    buffers_.set_order(order->splats);
    ordered_count_ = static_cast<std::int64_t>(order->splats.size());
    far_count_ = order->far_count;
    order_version_ = order->version;
}

}  // namespace astrosplat

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

namespace {

/// No splat of the set is larger, whatever its random numbers and alpha are.
float radius_bound(const SplatSet& set, const LookUniforms& u) {
    float radius = std::max(u.radius.smallest, u.radius.largest);
    if (u.radius.own)
        for (const float own : set.radius) radius = std::max(radius, own);
    return radius * std::max(1.0f, u.radius.horizontal_scale) * std::max(1.0f, u.radius.vertical_scale);
}

}  // namespace

RawSplats& RawSplatStore::of(const std::shared_ptr<const SplatSet>& set) {
    Entry& entry = entries_[set.get()];
    if (!entry.splats) entry.splats = std::make_unique<RawSplats>(set);
    entry.used = true;
    return *entry.splats;
}

void RawSplatStore::drop_unused() {
    for (auto entry = entries_.begin(); entry != entries_.end();) {
        const bool used = std::exchange(entry->second.used, false);
        entry = used ? std::next(entry) : entries_.erase(entry);
    }
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
    order_valid_ = false;
    first_version_ = 0;
    return true;
}

void GroupSplats::upload(Part& part, const ShadedSplats& splats) {
    part.largest_radius = *std::max_element(splats.radius.begin(), splats.radius.end());
    buffers_.upload(splats, part.first);
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

void GroupSplats::read_places() {
    places_ = std::make_shared<const Buffer<glm::vec4>>(buffers_.read_places());
    ++places_version_;
}

void GroupSplats::update(const std::vector<const PreviewLayer*>& layers, RawSplatStore& raw, LookPass& pass,
                         bool ordered) {
    bool changed = lay_out(layers);
    for (std::size_t l = 0; l < layers.size(); ++l) {
        if (parts_[l].count == 0) continue;
        if (layers[l]->layer.splats)
            upload(parts_[l], *layers[l]->layer.splats);
        else
            changed = shade(parts_[l], *layers[l], raw, pass) || changed;
    }
    if (changed) places_.reset();
    if (ordered && !places_) read_places();
}

bool GroupSplats::request_order(const std::vector<LayerProjection>& projections, double far_from,
                                OrderThread& thread, std::size_t slot) {
    View view;
    for (const LayerProjection& p : projections) {
        view.camera_from_layer.push_back(p.camera_from_layer);
        view.origin.push_back(p.origin_in_camera);
    }
    if (!projections.empty()) view.projection = projections[0].lens.projection;
    view.far_from = far_from;
    view.places_version = places_version_;
    if (view == requested_ && first_version_ != 0) return false;
    requested_ = view;
    requested_version_ = thread.next_version();
    if (first_version_ == 0) first_version_ = requested_version_;
    OrderJob job{places_, {}, {}, far_from, requested_version_};
    job.lens.projection = view.projection;
    for (std::size_t l = 0; l < parts_.size(); ++l)
        job.layers.push_back(
            {parts_[l].first, parts_[l].count, view.camera_from_layer[l], view.origin[l], parts_[l].set});
    thread.submit(slot, std::move(job));
    return true;
}

void GroupSplats::take_order(OrderThread& thread, std::size_t slot) {
    const std::optional<Order> order = thread.take(slot);
    if (!order || first_version_ == 0 || order->version < first_version_) return;
    buffers_.set_order(order->splats);
    ordered_count_ = static_cast<std::int64_t>(order->splats.size());
    far_count_ = order->far_count;
    order_version_ = order->version;
    order_valid_ = true;
}

}  // namespace astrosplat

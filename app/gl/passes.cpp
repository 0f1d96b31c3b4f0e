#include "gl/passes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "core/parallel.h"
#include "core/real.h"
#include "look/prepare.h"

namespace astrosplat {

namespace {

constexpr int profile_samples = 256;  // as in splat_vertex.glsl
constexpr int node_count = shared::NODE_COUNT;
constexpr std::size_t most_tables = 16;  // more only while one frame needs them

/// Weights of one radius at equal steps of distance from the flat inside's end to the support's.
void sample_profile(const FootprintTable& table, int node, float* samples) {
    const float radius_px = node_radius_px(static_cast<std::size_t>(node));
    Footprint footprint;
    footprint_at(table, radius_px, 0.5f, 0.5f, footprint);
    footprint.amplitude = 1.0f;
    footprint.edge_gain = 0.0f;
    const auto [lo, hi] =
        shared::profile_range(table.core, table.reach, 4.0f * table.pixel_filter_px, radius_px);
    for (int i = 0; i < profile_samples; ++i)
        samples[i] = footprint_weight(table, footprint, lo + (hi - lo) * float(i) / (profile_samples - 1));
    samples[profile_samples - 1] = 0.0f;
}

/// Mass of the profile and of its edge, relative to the light the splat shall have, with their spectra.
struct NodeTexels {
    glm::vec4 mass, edge;
};
NodeTexels node_texels(const FootprintTable& table, int node) {
    const FootprintMoments& n = table.nodes[static_cast<std::size_t>(node)].moments;
    const bool linear = table.linear_in_distance;
    const double radius_px = node_radius_px(static_cast<std::size_t>(node));
    const exact::ProfileRange range =
        exact::profile_range(table.core, table.reach, 4.0 * double(table.pixel_filter_px), radius_px);
    const double mass = exact::profile_mass(linear, range, n.mean, n.first_moment);
    const double edge = exact::edge_mass(linear, range, n.edge_mean, n.edge_first_moment);
    const double wanted = double(table.integral) * radius_px * radius_px;
    return {{float(mass / wanted), n.ripple[0], n.ripple[1], n.ripple[2]},
            {float(edge / wanted), n.edge_ripple[0], n.edge_ripple[1], n.edge_ripple[2]}};
}

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
constexpr float widest_useful_px = 512.0f;                         // of a point: wider splats are squares

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

constexpr int fine_unit = 0, coarse_unit = 1;

/// Mip level, with its fraction, for pixels `spread` radians apart; as sample_environment.
double level_of(const Environment& environment, double spread) {
    const Image& first = (*environment.faces)[0][0];
    const double w = double(first.width - 2), h = double(first.height - 2);
    const double texels =
        spread * (environment.faces->size() == 1 ? std::fmax(w / (2.0 * real::pi), h / real::pi) : 0.5 * w);
    const auto last = static_cast<double>((*environment.faces)[0].size() - 1);
    return texels > 1.0 ? std::fmin(real::log(texels) / real::log(2.0), last) : 0.0;
}

}  // namespace

std::vector<FootprintSlot> FootprintTextures::prepare(const std::vector<Falloff>& falloffs,
                                                      float pixel_filter_px) {
    const auto find = [&](const Falloff& falloff) {
        return std::ranges::find(entries_, falloff, &Entry::falloff);
    };
    const auto missing = [&](const Falloff& falloff) { return find(falloff) == entries_.end(); };
    if (pixel_filter_px != pixel_filter_px_) entries_.clear();
    pixel_filter_px_ = pixel_filter_px;
    const auto unused = [&](const Entry& entry) {
        return std::ranges::find(falloffs, entry.falloff) == falloffs.end();
    };
    if (std::ranges::any_of(falloffs, missing)) {
        if (entries_.size() >= most_tables) std::erase_if(entries_, unused);
        for (const Falloff& falloff : falloffs)
            if (missing(falloff))
                entries_.push_back({falloff, make_footprint_table(falloff, pixel_filter_px)});
        upload();
    }
    std::vector<FootprintSlot> slots;
    for (const Falloff& falloff : falloffs) {
        const auto entry = find(falloff);
        slots.push_back({static_cast<int>(entry - entries_.begin()), entry->table.reach, entry->table.core,
                         entry->table.flat_core});
    }
    return slots;
}

void FootprintTextures::upload() {
    const auto tables = static_cast<std::int64_t>(entries_.size());
    std::vector<float> profiles(static_cast<std::size_t>(tables * node_count * profile_samples));
    std::vector<glm::vec4> nodes(static_cast<std::size_t>(tables * 2 * node_count));
    parallel_for(tables * node_count, [&](std::int64_t i, int) {
        const FootprintTable& table = entries_[static_cast<std::size_t>(i / node_count)].table;
        const auto node = static_cast<int>(i % node_count);
        sample_profile(table, node, &profiles[static_cast<std::size_t>(i * profile_samples)]);
        const NodeTexels texels = node_texels(table, node);
        const std::int64_t row = i / node_count * 2 * node_count;
        nodes[static_cast<std::size_t>(row + node)] = texels.mass;
        nodes[static_cast<std::size_t>(row + node_count + node)] = texels.edge;
    });
    glBindTexture(GL_TEXTURE_2D_ARRAY, profiles_.get());
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R32F, profile_samples, node_count, static_cast<GLsizei>(tables),
                 0, GL_RED, GL_FLOAT, profiles.data());
    set_sampling(GL_TEXTURE_2D_ARRAY, GL_LINEAR);
    glBindTexture(GL_TEXTURE_2D, nodes_.get());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, node_count, static_cast<GLsizei>(2 * tables), 0, GL_RGBA,
                 GL_FLOAT, nodes.data());
    set_sampling(GL_TEXTURE_2D, GL_LINEAR);
}

void FootprintTextures::bind(int profiles_unit, int nodes_unit) const {
    bind_texture(profiles_unit, GL_TEXTURE_2D_ARRAY, profiles_.name());
    bind_texture(nodes_unit, GL_TEXTURE_2D, nodes_.name());
}

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
        ProgramSource{.defines = defines,
                      .vertex = splat_vertex_files,
                      .fragment = {"maths.glsl", "blend.glsl", "splat_fragment.glsl"},
                      .samplers = {{"footprint_profiles", profiles_unit},
                                   {"footprint_nodes", nodes_unit},
                                   {"places", places_unit},
                                   {"colors", places_unit + 1}},
                      .block = "DrawBlock"});
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

void EnvironmentPass::Level::hold(const Environment& environment, std::size_t level) {
    const Image& first = (*environment.faces)[0][level];
    const float found = content_probe(first);
    if (texture.name() != 0 && pixels == first.pixels.data() && probe == found) return;
    pixels = first.pixels.data();
    probe = found;
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture.get());
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGB32F, static_cast<GLsizei>(first.width),
                 static_cast<GLsizei>(first.height), static_cast<GLsizei>(environment.faces->size()), 0,
                 GL_RGB, GL_FLOAT, nullptr);
    for (std::size_t face = 0; face < environment.faces->size(); ++face)
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, static_cast<GLint>(face),
                        static_cast<GLsizei>(first.width), static_cast<GLsizei>(first.height), 1, GL_RGB,
                        GL_FLOAT, (*environment.faces)[face][level].pixels.data());
    set_sampling(GL_TEXTURE_2D_ARRAY, GL_LINEAR);
}

EnvironmentPass::EnvironmentPass()
    : program_({.vertex = {"screen_vertex.glsl"},
                .fragment = environment_fragment_files,
                .samplers = {{"fine_level", fine_unit}, {"coarse_level", coarse_unit}}}) {}

void EnvironmentPass::draw(const Environment& environment, const Camera& camera) {
    const double level = level_of(environment, pixel_spread(camera));
    const auto fine = static_cast<std::size_t>(level);
    const std::size_t coarse = std::min(fine + 1, (*environment.faces)[0].size() - 1);
    fine_.hold(environment, fine);
    coarse_.hold(environment, coarse);
    bind_texture(fine_unit, GL_TEXTURE_2D_ARRAY, fine_.texture.name());
    bind_texture(coarse_unit, GL_TEXTURE_2D_ARRAY, coarse_.texture.name());
    program_.use();
    const glm::mat3 rotation(environment.environment_from_world);
    glUniformMatrix3fv(program_.uniform("environment_from_world"), 1, GL_FALSE, glm::value_ptr(rotation));
    const glm::vec3 eye(environment.behind > 0.0 ? camera.eye / environment.behind : glm::dvec3(0.0));
    glUniform1i(program_.uniform("is_near"), environment.behind > 0.0);
    glUniform3fv(program_.uniform("eye"), 1, glm::value_ptr(eye));
    const glm::mat3 from_camera(camera.world_from_camera);
    glUniformMatrix3fv(program_.uniform("world_from_camera"), 1, GL_FALSE, glm::value_ptr(from_camera));
    const Lens lens = make_lens(camera);
    glUniform1i(program_.uniform("lens.projection"), lens.projection);
    glUniform1f(program_.uniform("lens.focal_px"), lens.focal_px);
    glUniform1f(program_.uniform("lens.center_x_px"), lens.center_x_px);
    glUniform1f(program_.uniform("lens.center_y_px"), lens.center_y_px);
    glUniform1f(program_.uniform("lens.edge"), lens.edge);
    glUniform1f(program_.uniform("coarse_share"), float(level - double(fine)));
    glUniform1f(program_.uniform("gain"), environment.gain);
    glDisable(GL_BLEND);
    triangle_.draw();
}

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

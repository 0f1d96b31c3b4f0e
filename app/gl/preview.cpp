// The flow of a frame: looks where something changed, orders asked for, environment, then one blend group
// after the other from the farthest.
#include "gl/preview.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <map>

#include "camera/projection.h"
#include "core/log.h"
#include "gl/objects.h"
#include "gl/passes.h"
#include "render/resolve.h"

namespace astrosplat {
namespace {

using namespace std::chrono_literals;

/// How long a frame waits for a new order: a short sort is then exact in the very frame, a long one is used a
/// few frames later.
constexpr auto patience = 6ms;

/// One blend group of this frame.
struct FrameGroup {
    BlendGroup blend;
    std::vector<const PreviewLayer*> layers;
    std::vector<LayerProjection> projections;
    std::vector<Falloff> falloffs;
    bool ordered = false;
    double far_from = 0.0;  // beyond, every splat is small enough for a point
    bool all_far = false;
};

bool depends_on_order(FoldKind kind) { return kind == FoldKind::over || kind == FoldKind::general; }

/// Isolated layers that cover, add or absorb do the same drawn straight onto what is behind them.
bool needs_own_target(const BlendGroup& group) {
    if (!group.isolated || group.holdout || group.blend == Blend::absorb) return false;
    return group.absorbs || (group.blend != Blend::over && group.blend != Blend::add);
}

/// Distance, as splats are sorted, beyond which none that reaches the frame is wider than a point may be.
double far_distance(const LayerProjection& p, double radius, double widest_px, int width, int height) {
    const double room_px = 0.5 * widest_px - double(p.margin_px) - 1.0;
    const double diagonal_px = std::hypot(double(width), double(height)) + double(p.margin_px);
    return double(shared::small_from(p.lens, float(radius), float(room_px), float(diagonal_px)));
}

/// Distance from the eye to the nearest splat a layer can have; 0 inside.
double distance_to(const LayerProjection& p, const Bounds& box) {
    const glm::dvec3 eye = -(glm::inverse(p.camera_from_layer) * p.origin_in_camera);
    const glm::dvec3 outside = glm::max(glm::max(box.lo - eye, eye - box.hi), glm::dvec3(0.0));
    return std::sqrt(glm::dot(outside, outside)) * double(p.radius_scale);
}

/// Copies with the merged groups cut into pieces that one pass can draw.
std::vector<BlendGroup> drawable(std::vector<BlendGroup> groups) {
    std::vector<BlendGroup> result;
    for (BlendGroup& group : groups) {
        if (group.layers.size() > DrawPass::most_layers)
            log_warning(fmt::format("more than {} layers together: the preview sorts them in parts",
                                    DrawPass::most_layers));
        for (std::size_t at = 0; at < group.layers.size(); at += DrawPass::most_layers) {
            BlendGroup part = group;
            const std::size_t end = std::min(group.layers.size(), at + DrawPass::most_layers);
            part.layers.assign(group.layers.begin() + std::ptrdiff_t(at),
                               group.layers.begin() + std::ptrdiff_t(end));
            result.push_back(part);
        }
    }
    return result;
}

}  // namespace

struct GlPreview::State {
    LookPass look;
    DrawPass draw;
    EnvironmentPass environment;
    FootprintTextures footprints;
    RawSplatStore raw;
    std::map<std::size_t, GroupSplats> groups;  // by place in the frame
    OrderThread orders;
    GlTarget frame, own_target;
    GlProgram composite_covering{{{"BLEND 0"}, {"screen_vertex.glsl"}, {"composite_fragment.glsl"}}};
    GlProgram composite_screen{{{"BLEND 2"}, {"screen_vertex.glsl"}, {"composite_fragment.glsl"}}};
    WholeTarget triangle;
    std::int64_t shown = 0;
    bool sorting = false;

    std::vector<FrameGroup> make_frame(const std::vector<PreviewLayer>& layers, const PreviewView& view);
    void update(std::vector<FrameGroup>& frame_groups, int width, int height);
    void wait_for_orders(std::vector<FrameGroup>& frame_groups);
    void draw_group(const FrameGroup& group, GroupSplats& splats);
    void composite(const BlendGroup& group);
    void begin_frame(const Camera& camera, const Environment* sky);
};

std::vector<FrameGroup> GlPreview::State::make_frame(const std::vector<PreviewLayer>& layers,
                                                     const PreviewView& view) {
    const RenderSettings settings = settings_of(view);
    std::vector<RenderLayer> render_layers;
    for (const PreviewLayer& layer : layers) render_layers.push_back(layer.layer);
    std::vector<FrameGroup> frame_groups;
    for (const BlendGroup& group : drawable(make_groups(render_layers, false))) {
        FrameGroup& f = frame_groups.emplace_back();
        f.blend = group;
        f.ordered = depends_on_order(group.kind);
        for (std::size_t l : group.layers) {
            f.layers.push_back(&layers[l]);
            f.projections.push_back(
                make_projection(render_layers[l], static_cast<std::uint16_t>(l), view.camera, settings));
            f.falloffs.push_back(layers[l].layer.render.falloff);
        }
    }
    return frame_groups;
}

void GlPreview::State::update(std::vector<FrameGroup>& frame_groups, int width, int height) {
    shown = 0;
    groups.erase(groups.lower_bound(frame_groups.size()), groups.end());
    for (std::size_t g = 0; g < frame_groups.size(); ++g) {
        FrameGroup& group = frame_groups[g];
        GroupSplats& splats = groups[g];
        splats.update(group.layers, raw, look, group.ordered);
        shown += splats.shown();
        group.all_far = true;
        for (std::size_t l = 0; l < group.layers.size(); ++l) {
            const LayerProjection& p = group.projections[l];
            const double radius = double(splats.largest_radius(l)) * double(p.radius_scale);
            const double far_from = far_distance(p, radius, double(draw.widest_point_px()), width, height);
            group.far_from = std::max(group.far_from, far_from);
            if (!group.layers[l]->set) continue;
            double jitter = 0.0;
            for (const Noise& noise : group.layers[l]->look.noise) jitter += std::fabs(double(noise.jitter));
            const double nearest = std::max(
                0.0, distance_to(p, raw.of(group.layers[l]->set).box()) - jitter * double(p.radius_scale));
            group.all_far = group.all_far && nearest > far_from;
        }
        if (group.ordered) splats.request_order(group.projections, group.far_from, orders, g);
    }
    raw.drop_unused();
}

void GlPreview::State::wait_for_orders(std::vector<FrameGroup>& frame_groups) {
    bool missing = false;
    for (std::size_t g = 0; g < frame_groups.size(); ++g)
        missing = missing || (frame_groups[g].ordered && !groups[g].has_order());
    orders.wait(missing ? std::chrono::microseconds(1h) : std::chrono::microseconds(patience));
    sorting = false;
    for (std::size_t g = 0; g < frame_groups.size(); ++g) {
        if (!frame_groups[g].ordered) continue;
        groups[g].take_order(orders, g);
        sorting = sorting || !groups[g].order_is_current();
    }
}

void GlPreview::State::begin_frame(const Camera& camera, const Environment* sky) {
    frame.bind();
    glClearColor(0.0f, 0.0f, 0.0f, sky ? 1.0f : 0.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    if (sky && !sky->faces->empty()) environment.draw(*sky, camera);
}

void GlPreview::State::draw_group(const FrameGroup& group, GroupSplats& splats) {
    std::vector<DrawLayer> layers;
    const std::vector<FootprintSlot> slots =
        footprints.prepare(group.falloffs, group.projections[0].margin_px / 4.0f);
    for (std::size_t l = 0; l < group.layers.size(); ++l)
        layers.push_back({group.projections[l], slots[l], splats.first_of(l)});
    DrawInput input{layers, group.blend.kind, frame.width(), frame.height(), group.ordered, 0, 0};
    input.count = group.ordered ? splats.ordered_count() : splats.shown();
    input.point_count = group.all_far ? input.count : group.ordered ? splats.far_count() : 0;
    draw.draw(input, splats.buffers(), footprints);
}

void GlPreview::State::composite(const BlendGroup& group) {
    frame.bind();
    (group.blend == Blend::screen ? composite_screen : composite_covering).use();
    bind_texture(0, GL_TEXTURE_2D, own_target.texture());
    begin_blending(group.blend == Blend::lighten ? FoldKind::lighten : FoldKind::general);
    triangle.draw();
    end_blending();
}

GlPreview::GlPreview() : state_(std::make_unique<State>()) {}
GlPreview::~GlPreview() = default;

unsigned GlPreview::draw(const std::vector<PreviewLayer>& layers, const PreviewView& view) {
    State& state = *state_;
    const int width = static_cast<int>(view.width), height = static_cast<int>(view.height);
    std::vector<FrameGroup> frame_groups = state.make_frame(layers, view);
    state.update(frame_groups, width, height);
    // All falloffs at once, so that a group does not throw out another's.
    std::vector<Falloff> falloffs;
    for (const FrameGroup& group : frame_groups)
        falloffs.insert(falloffs.end(), group.falloffs.begin(), group.falloffs.end());
    state.footprints.prepare(falloffs, view.pixel_filter);
    state.frame.resize(width, height, GL_RGBA32F);
    state.begin_frame(view.camera, view.environment);
    state.wait_for_orders(frame_groups);
    for (std::size_t g = 0; g < frame_groups.size(); ++g) {
        const bool own = needs_own_target(frame_groups[g].blend);
        if (own) {
            state.own_target.resize(width, height, GL_RGBA32F);
            state.own_target.bind();
            glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
            glClear(GL_COLOR_BUFFER_BIT);
        } else {
            state.frame.bind();
        }
        state.draw_group(frame_groups[g], state.groups[g]);
        if (own) state.composite(frame_groups[g].blend);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return state.frame.texture();
}

bool GlPreview::sorting() const { return state_->sorting; }

void GlPreview::wait_for_order() { state_->orders.wait(std::chrono::hours(1)); }

Image GlPreview::read() const {
    const GlTarget& frame = state_->frame;
    Image image = make_image(frame.width(), frame.height(), 4);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame.framebuffer());
    glReadPixels(0, 0, frame.width(), frame.height(), GL_RGBA, GL_FLOAT, image.pixels.data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    return image;
}

std::int64_t GlPreview::shown() const { return state_->shown; }

}  // namespace astrosplat

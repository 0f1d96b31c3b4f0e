#include "viewer/session_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "scene/layer_setup.h"
#include "viewer/session_view.h"

namespace astrosplat {
namespace {

void fill_layers(Session& session, const Scene& now) {
    const std::vector<std::int64_t>&shown = session.view_frame.shown(), &kept = session.view_frame.kept();
    Status& status = session.status;
    const SetLoader& loader = session.sets.loader();
    status.layers.resize(now.layers.size());
    status.box = {};
    for (std::size_t i = 0; i < now.layers.size(); ++i) {
        status.layers[i] = loader.status(session.document.scene().layers[i]);
        if (i < shown.size()) status.layers[i].shown = shown[i];
        status.layers[i].kept = i < kept.size() ? kept[i] : -1;
        const auto loaded = loader.layer(now.layers[i].name);
        if (!loaded) continue;
        status.layers[i].box = loaded->box;
        if (now.layers[i].visible)
            status.box.add(world_bounds(loaded->box, render_layer(now, now.layers[i])));
    }
}

}  // namespace

void fill_status(Session& session) {
    fill_layers(session, evaluated(session.document.scene(), session.view));
    const ViewFrameStatus* refining = session.comparison.refining();
    session.status.view_frame = refining ? *refining : session.view_frame.status();
    session.status.threads = thread_count();
    const GlInfo& gl = session.gl;
    session.status.engine = draws_by_opengl(session)
                                ? fmt::format("OpenGL {}.{}, {}", gl.major, gl.minor, gl.renderer)
                                : "processor";
    session.comparison.fill(session.status);
    session.status.blink_shows_other =
        session.view.compare == CompareMode::blink && session.comparison.blink_shows_other();
    say_new_errors(session.status, session.said_errors);
}

void say_new_errors(Status& status, std::set<std::string>& said) {
    std::set<std::string> errors;
    if (status.view_frame.state == ViewFrameState::failed) errors.insert(status.view_frame.error);
    for (const LayerStatus& layer : status.layers) errors.insert(layer.error);
    if (status.reference) errors.insert(status.reference->error);
    if (status.color) errors.insert(status.color->error);
    errors.erase("");
    for (const std::string& error : errors)
        if (!said.count(error)) say(status, error, true);
    said = std::move(errors);
}

void forget_old_message(Status& status, MessageAge& age, double now) {
    constexpr double seen_s = 12.0;
    Message& message = status.message;
    if (message.number != age.number)
        age = {message.number, now};
    else if (!message.error && now - age.since >= seen_s)
        message.text.clear();
}

FramePixel frame_pixel(const Session& session, glm::dvec2 mouse_px) {
    const ViewRequest& request = session.request;
    const glm::vec2 port(session.viewport_px);
    const Rect place = place_frame(session.view, {0, 0, port.x, port.y}, request.width, request.height);
    const auto pixel = [](double px, float begin, float size, int count) {
        return static_cast<std::int64_t>(std::floor((px - begin) / size * count));
    };
    return {pixel(mouse_px.x, place.x, place.width, request.width),
            pixel(mouse_px.y, place.y, place.height, request.height)};
}

void probe(Session& session, glm::dvec2 mouse_px) {
    const ViewRequest& request = session.request;
    session.status.probe.reset();
    if (request.width <= 0 || session.view_frame.texture() == 0) return;
    if (!session.status.rendered_frame.empty()) return;  // another picture is seen
    const FramePixel at = frame_pixel(session, mouse_px);
    const Image* pixels = session.view_frame.pixels();
    if (!pixels) return;
    const std::shared_ptr<const RenderedFrame> final = session.view_frame.final_frame();
    session.status.probe = probe_of(*pixels, final ? &final->depth : nullptr, request.region, at.x, at.y);
}

std::optional<PixelProbe> probe_of(const Image& pixels, const Image* depth, const Region& region,
                                   std::int64_t x, std::int64_t y) {
    const std::int64_t px = x - region.x, py = y - region.y;
    if (px < 0 || py < 0 || px >= pixels.width || py >= pixels.height) return std::nullopt;
    PixelProbe found;
    found.x = static_cast<int>(x);
    found.y = static_cast<int>(y);
    std::copy_n(pixels.at(px, py), 4, found.rgba);
    const bool has_depth = depth && depth->width == pixels.width && depth->height == pixels.height;
    if (has_depth && *depth->at(px, py) != 0.0f) found.depth = *depth->at(px, py);
    return found;
}

}  // namespace astrosplat

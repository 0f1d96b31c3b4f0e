#include "viewer/session_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "scene/layer_setup.h"
#include "viewer/session_picture.h"

namespace astrosplat {
namespace {

void fill_layers(SessionState& state, const Scene& now) {
    const std::vector<std::int64_t>&shown = state.picture.shown(), &kept = state.picture.kept();
    Status& status = state.status;
    const SetLoader& loader = state.sets.loader();
    status.layers.resize(now.layers.size());
    status.box = {};
    for (std::size_t i = 0; i < now.layers.size(); ++i) {
        status.layers[i] = loader.status(state.document.scene().layers[i]);
        if (i < shown.size()) status.layers[i].shown = shown[i];
        status.layers[i].kept = i < kept.size() ? kept[i] : -1;
        const auto loaded = loader.layer(now.layers[i].name);
        if (loaded && now.layers[i].visible)
            status.box.add(world_bounds(loaded->box, render_layer(now.layers[i])));
    }
}

}  // namespace

void fill_status(SessionState& state) {
    fill_layers(state, evaluated(state.document.scene(), state.view));
    const PictureStatus* refining = state.comparison.refining();
    state.status.picture = refining ? *refining : state.picture.status();
    state.status.threads = thread_count();
    const GlInfo& gl = state.gl;
    state.status.engine = draws_by_opengl(state)
                              ? fmt::format("OpenGL {}.{}, {}", gl.major, gl.minor, gl.renderer)
                              : "processor";
    state.comparison.fill(state.status);
}

void probe(SessionState& state, glm::dvec2 mouse_px) {
    const PictureRequest& request = state.request;
    state.status.probe.reset();
    if (request.width <= 0 || state.picture.texture() == 0) return;
    const glm::vec2 port(state.viewport_px);
    const Rect place = place_picture(state.view, {0, 0, port.x, port.y}, request.width, request.height);
    const auto x =
        static_cast<std::int64_t>(std::floor((mouse_px.x - place.x) / place.width * request.width));
    const auto y =
        static_cast<std::int64_t>(std::floor((mouse_px.y - place.y) / place.height * request.height));
    const Image* pixels = state.picture.pixels();
    if (!pixels) return;
    const std::int64_t px = x - request.region.x, py = y - request.region.y;
    if (px < 0 || py < 0 || px >= pixels->width || py >= pixels->height) return;
    PixelProbe found;
    found.x = static_cast<int>(x);
    found.y = static_cast<int>(y);
    std::copy_n(pixels->at(px, py), 4, found.rgba);
    state.status.probe = found;
}

}  // namespace astrosplat

// Session: what the widgets are told. Layers, picture, machine, the pixel under the mouse, and what others
// did on the disk.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/memory.h"
#include "core/parallel.h"
#include "scene/layer_setup.h"
#include "viewer/session_impl.h"

namespace astrosplat {

void Session::Impl::fill_layers(const Scene& now) {
    const std::vector<std::int64_t>& shown = a.shown();
    status.layers.resize(now.layers.size());
    status.box = {};
    for (std::size_t i = 0; i < now.layers.size(); ++i) {
        status.layers[i] = loader.status(document.scene().layers[i]);
        if (i < shown.size()) status.layers[i].shown = shown[i];
        status.layers[i].kept = i < a.kept().size() ? a.kept()[i] : -1;
        const auto loaded = loader.layer(now.layers[i].name);
        if (loaded && now.layers[i].visible)
            status.box.add(world_bounds(loaded->box, render_layer(now.layers[i])));
    }
}

void Session::Impl::fill_status() {
    fill_layers(evaluated(document.scene()));
    status.picture = comparing && b.status().state == PictureState::refining ? b.status() : a.status();
    status.threads = thread_count();
    status.engine =
        view.engine == PreviewEngine::opengl || (view.engine == PreviewEngine::automatic && !gl.software)
            ? fmt::format("OpenGL {}.{}, {}", gl.major, gl.minor, gl.renderer)
            : "processor";
    status.snapshots.clear();
    for (const StoredPicture& stored : snapshots)
        status.snapshots.push_back({stored.look.name, to_handle(stored.thumbnail.handle()), stored.aspect,
                                    stored.splats, stored.seconds});
    status.b_snapshot = b_snapshot;
    status.b_name = b_snapshot >= 0 ? snapshots[static_cast<std::size_t>(b_snapshot)].look.name : "";
}

/// The linear pixel under the mouse.
void Session::Impl::probe(glm::dvec2 mouse_px) {
    status.probe.reset();
    if (request.width <= 0 || a.texture() == 0) return;
    const Rect port{0, 0, static_cast<float>(viewport_width), static_cast<float>(viewport_height)};
    const Rect place = place_picture(view, port, request.width, request.height);
    const auto x =
        static_cast<std::int64_t>(std::floor((mouse_px.x - place.x) / place.width * request.width));
    const auto y =
        static_cast<std::int64_t>(std::floor((mouse_px.y - place.y) / place.height * request.height));
    const Image* pixels = a.pixels();
    if (!pixels) return;
    const std::int64_t px = x - request.region.x, py = y - request.region.y;
    if (px < 0 || py < 0 || px >= pixels->width || py >= pixels->height) return;
    PixelProbe found;
    found.x = static_cast<int>(x);
    found.y = static_cast<int>(y);
    std::copy_n(pixels->at(px, py), 4, found.rgba);
    status.probe = found;
}

}  // namespace astrosplat

#include "viewer/session_select.h"

#include <fmt/format.h>

#include <algorithm>

#include "viewer/layers_at_pixel.h"
#include "viewer/session_status.h"

namespace astrosplat {

void select_layer_at(Session& session, glm::dvec2 mouse_px, bool behind) {
    const CompareMode compare = session.view.compare;
    if (compare == CompareMode::front || compare == CompareMode::other) return;  // no layers of A are seen
    const FramePixel at = frame_pixel(session, mouse_px);
    const std::vector<std::size_t> seen = seen_layers(session.view_frame.layer_light(at.x, at.y));
    const std::optional<std::size_t> clicked = clicked_layer(seen, session.view.layer, behind);
    const std::vector<LayerParams>& layers = session.document.scene().layers;
    session.view.selected_box = clicked.has_value();
    if (!clicked || *clicked >= layers.size()) return;
    session.view.layer = *clicked;
    session.view.handle_target = HandleTarget::layer;
    std::string text = layers[*clicked].name + " is selected";
    if (seen.size() > 1) {
        const auto place = std::ranges::find(seen, *clicked) - seen.begin() + 1;
        text += fmt::format(", {} of {} layers here; another click takes the next", place, seen.size());
    }
    say(session.status, text);
}

}  // namespace astrosplat

#include "viewer/session_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace astrosplat {
namespace {

/// The view's part of what the display shows, without what it is compared with; top row first.
Image view_pixels(Session& session, unsigned texture) {
    DisplaySettings shown = session.displayed;
    shown.b = texture;
    Image view = session.display.read_compared(shown, session.viewport_px.x, session.viewport_px.y).a;
    for (std::int64_t y = 0; y < view.height / 2; ++y)
        std::swap_ranges(view.at(0, y), view.at(0, y) + view.width * 4, view.at(0, view.height - 1 - y));
    return view;
}

}  // namespace

void begin_alignment(Session& session) {
    const ReferenceParams* reference = seen_reference(session.document.scene(), session.status);
    const Image* picture = session.comparison.reference().picture();
    if (!reference || !picture) throw InputError("the reference has not been read yet");
    AlignmentRequest request;
    request.view = view_pixels(session, session.comparison.reference().texture());
    if (request.view.pixels.empty()) throw InputError("there is no frame to align to yet");
    request.picture = *picture;
    const glm::vec2 port(session.viewport_px);
    request.frame = frame_on_screen(
        place_frame(session.view, {0, 0, port.x, port.y}, session.request.width, session.request.height));
    request.frame.middle -= glm::dvec2(std::max(0.0f, std::round(session.displayed.x)),
                                       std::max(0.0f, std::round(session.displayed.y)));
    request.reference = *reference;
    request.camera = session.request.scene.camera;
    session.alignment.begin(std::move(request));
    say(session.status, "Aligning the reference to this view");
}

void take_alignment(Session& session) {
    const std::shared_ptr<const AlignmentFound> found = session.alignment.take();
    if (!found) return;
    if (!found->error.empty()) return say(session.status, found->error, true);
    const AlignmentRequest& request = session.alignment.request();
    const std::string name = request.reference.file.filename().string();
    if (!found->reference)
        return say(session.status, "Nothing in the view is like " + name + ": it stays where it is", true);
    const ReferenceParams* now = seen_reference(session.document.scene(), session.status);
    if (!now || !(*now == request.reference) || !(session.request.scene.camera == request.camera))
        return say(session.status, "Not aligned: the view or the reference has been changed since", true);
    const std::size_t index = session.status.reference->index;
    session.document.edit("Align reference",
                          [&](Scene& scene) { scene.references[index] = *found->reference; });
    show_reference(session.view);
    say(session.status, fmt::format("Aligned {}, likeness {:.2f}", name, found->likeness));
}

}  // namespace astrosplat

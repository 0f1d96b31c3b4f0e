#include "viewer/session_prepare.h"

#include <optional>

#include "viewer/comparison.h"

namespace astrosplat {

void show_preparation(Session& session) {
    std::optional<PrepareStatus>& status = session.status.preparation;
    const std::vector<LayerParams>& layers = session.document.scene().layers;
    status.reset();
    if (!session.view.preparation_open || session.view.layer >= layers.size())
        return session.preparation.cancel();
    const auto request = prepare_request(layers[session.view.layer], session.disk.changes());
    if (!request) return session.preparation.cancel();
    session.preparation.want(*request);
    status.emplace();
    status->working = session.preparation.working();
    const auto found = session.preparation.found(*request);
    if (found) status->error = found->error;
    if (found && found->error.empty() && found != session.preparation_shown) {
        session.preparation_before.upload_smooth(found->before);
        session.preparation_after.upload_smooth(found->after);
        session.preparation_shown = found;
    }
    // While another is worked out, the last one stays.
    const auto& shown = session.preparation_shown;
    if (!shown || shown->files != request->files || !status->error.empty()) return;
    status->before = to_handle(session.preparation_before.handle());
    status->after = to_handle(session.preparation_after.handle());
    status->aspect = static_cast<float>(shown->after.width) / static_cast<float>(shown->after.height);
    status->stars = shown->stars;
}

}  // namespace astrosplat

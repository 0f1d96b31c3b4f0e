// One frame of the window: parts in their places, then the dialogs, then what was asked for.
#include "gui/gui.h"

#include <imgui.h>

#include <cmath>

#include "gui/actions.h"
#include "gui/command_flow.h"
#include "gui/move_dialog.h"
#include "gui/notices.h"
#include "gui/panel/panel.h"
#include "gui/parts.h"
#include "gui/queue_dialog.h"
#include "gui/render_dialog.h"
#include "gui/theme.h"
#include "gui/timeline.h"
#include "gui/viewport.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

// The one window everything but dialogs is in.
void begin_host() {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, color4(color::window));
    ImGui::Begin("astrosplat", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse |
                     ImGuiWindowFlags_NoNav);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(3);
}

// The parameter that K sets a keyframe of: of the panel's row that the mouse is on.
std::string parameter_under_mouse(const Panel& panel, const Rect& area) {
    constexpr float half_row = 13;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const ImVec2 end{area.x + area.width, area.y + area.height};
    if (!ImGui::IsMouseHoveringRect({area.x, area.y}, end, false)) return "";
    for (const DrawnRow& row : panel.rows())
        if (row.diamond.x >= 0 && std::fabs(mouse.y - row.value.y) <= px(half_row)) return row.key;
    return "";
}

bool keyboard_is_free() {
    return !ImGui::GetIO().WantTextInput && !ImGui::IsAnyItemActive() &&
           !ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

}  // namespace

struct Gui::State {
    Viewport viewport;
    Timeline timeline;
    StatusBar status_bar;
    Panel panel;
    CommandFlow flow;
    std::vector<DrawnItem> drawn;
    bool popup = false;

    void draw_parts(GuiFrame& frame, const Layout& layout, Commands& commands);
};

void Gui::State::draw_parts(GuiFrame& frame, const Layout& layout, Commands& commands) {
    constexpr ImGuiWindowFlags still = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
    draw_menu_bar(frame, layout.menu);
    draw_tool_row(frame, layout.tools);
    draw_notice(frame, layout.notice);
    if (begin_part("viewport", layout.viewport, still)) {
        viewport.draw(frame, layout.viewport);
        ImGui::EndChild();
    }
    draw_snapshots(frame, layout.snapshots);
    timeline.draw(frame, layout.timeline);
    if (begin_part("panel", layout.panel, still)) {
        panel.draw(frame.document, frame.view, frame.status, frame.requested);
        ImGui::EndChild();
    }
    frame.view.hovered_parameter = parameter_under_mouse(panel, layout.panel);
    if (begin_part("status", layout.status, still)) {
        status_bar.draw(frame, layout.status);
        ImGui::EndChild();
    }
    draw_splitters(frame, layout);
    draw_shortcut_sheet(frame);
    draw_log(frame);
    draw_render_dialog(frame);
    draw_queue(frame);
    draw_move_dialog(frame);
    draw_settings_dialog(frame);
    flow.run(frame, panel, commands);
}

Gui::Gui() : state_(std::make_unique<State>()) {}
Gui::~Gui() = default;

void Gui::draw(Document& document, ViewState& view, const Status& status, Commands& commands) {
    State& state = *state_;
    state.drawn.clear();
    Commands requested;  // begins with what came from elsewhere: dropped files
    requested.swap(commands);
    GuiFrame frame{document, view, status, requested, state.drawn};
    view.changed_on_disk = status.changed_on_disk;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    if (keyboard_is_free()) run_shortcuts(frame);
    begin_host();
    const Layout layout = make_layout(view, size.x, size.y, px(1));
    state.draw_parts(frame, layout, commands);
    ImGui::End();
    state.popup = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

const ViewportInput& Gui::viewport_input() const { return state_->viewport.input(); }

void Gui::ask_to_quit(const Document&) { state_->flow.ask({Command::Kind::quit, {}, {}, 0}); }

bool Gui::busy() const {
    return ImGui::IsAnyItemActive() || ImGui::GetIO().WantTextInput || state_->popup || state_->flow.busy() ||
           state_->timeline.busy() || state_->panel.busy();
}

bool Gui::opening() const {
    if (state_->flow.awaits_typing()) return true;
    const bool takes_text = ImGui::GetIO().WantTextInput || ImGui::IsAnyItemActive();
    return !takes_text && (state_->popup || state_->flow.busy() || state_->panel.busy());
}

const std::vector<DrawnItem>& Gui::drawn_items() const { return state_->drawn; }
const Panel& Gui::panel() const { return state_->panel; }

}  // namespace astrosplat

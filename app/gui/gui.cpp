// One frame of the window: parts in their places, then the dialogs, then what was asked for.
#include "gui/gui.h"

#include <unistd.h>

#include "gui/file_dialog.h"
#include "gui/panel/panel.h"
#include "gui/parts.h"
#include "gui/timeline.h"
#include "gui/viewport.h"

namespace astrosplat {
namespace {

// From a request to a complete command: asks for the file that is missing, and what to do with unsaved
// changes, or with another program's in the same file, that would be lost. In: what the widgets requested.
// Out: commands for the viewer.

class CommandFlow {
  public:
    /// A command that the next run() takes up as if a menu had asked for it.
    void ask(const Command& command) { asked_.push_back(command); }

    /// Takes frame.requested and the panel's wish, draws the dialogs they need, adds to `out`.
    void run(GuiFrame& frame, Panel& panel, Commands& out);
    /// A dialog is open, or an answer is waited for.
    bool busy() const;
    /// A text field is about to take what is typed.
    bool awaits_typing() const { return dialog_.awaits_typing(); }

  private:
    void take(GuiFrame& frame, Command command, Commands& out);
    void take_answer(GuiFrame& frame, Panel& panel, Commands& out);
    void draw_question(GuiFrame& frame, Commands& out);
    void draw_conflict(GuiFrame& frame, Commands& out);
    void draw_recovery(GuiFrame& frame, Commands& out);
    void finish_save(GuiFrame& frame, Commands& out);

    Commands asked_;
    FileDialog dialog_;

    std::optional<Command> needs_file_;          // waits for the dialog
    std::optional<ParameterKey> panel_request_;  // likewise
    FileDialog::Answer answer_;                  // until taken

    std::optional<Command> question_;  // would lose unsaved changes
    bool conflict_ = false;            // saving would lose what another program wrote there
    std::optional<Command> after_save_;
    int frames_since_save_ = 0;
    bool recovery_answered_ = false;
};

using Kind = Command::Kind;

bool replaces_scene(Kind kind) {
    return kind == Kind::quit || kind == Kind::open || kind == Kind::open_demo || kind == Kind::new_scene ||
           kind == Kind::recover;
}

// Saving can go where the scene lies; an installed demo's folder is read-only.
bool can_save_in_place(const Document& document) {
    return !document.file().empty() && ::access(document.file().c_str(), W_OK) == 0;
}

const char* before_what(Kind kind) {
    switch (kind) {
        case Kind::quit:
            return " before leaving?";
        case Kind::new_scene:
            return " before making a new scene?";
        default:
            return " before opening another scene?";
    }
}

bool CommandFlow::busy() const {
    return dialog_.is_open() || question_ || after_save_ || !asked_.empty() || answer_.done;
}

void CommandFlow::take(GuiFrame& frame, Command command, Commands& out) {
    if (command.kind == Kind::save && !can_save_in_place(frame.document)) command.kind = Kind::save_as;
    const std::optional<FileQuery> query = query_for(command.kind, frame.document);
    if (query && command.path.empty()) {
        needs_file_ = command;
        panel_request_.reset();
        dialog_.open(*query);
    } else if (command.kind == Kind::save && frame.document.changed_on_disk()) {
        conflict_ = true;
    } else if (replaces_scene(command.kind) && frame.document.edited()) {
        question_ = command;
    } else {
        out.push_back(command);
    }
}

void CommandFlow::take_answer(GuiFrame& frame, Panel& panel, Commands& out) {
    if (!answer_.done) return;
    const FileDialog::Answer answer = std::move(answer_);
    answer_ = {};
    const std::optional<Command> command = std::move(needs_file_);
    const std::optional<ParameterKey> asked_by_panel = std::move(panel_request_);
    needs_file_.reset();
    panel_request_.reset();
    if (!answer.file) {
        after_save_.reset();
        return;
    }
    if (asked_by_panel) {
        try_edit([&] { panel.answer(*asked_by_panel, *answer.file, frame); });
    } else if (command) {
        Command complete = *command;
        complete.path = *answer.file;
        take(frame, complete, out);
    }
}

// Commands that waited for the save go on once nothing is unsaved; where saving failed they do not.
void CommandFlow::finish_save(GuiFrame& frame, Commands& out) {
    if (!after_save_ || needs_file_ || conflict_) return;
    if (!frame.document.edited()) {
        out.push_back(*after_save_);
        after_save_.reset();
    } else if (++frames_since_save_ > 2) {
        after_save_.reset();
    }
}

// Index of the answer, the one in the middle is Cancel; -1: none yet.
int answer_to(GuiFrame& frame, bool open, const char* id, const std::string& title, const char* note,
              std::initializer_list<const char*> answers) {
    if (!begin_dialog(id, title, open, 460, 0)) return -1;
    dialog_note(note, 10);
    const int button = dialog_buttons(frame, id, answers, 1);
    end_dialog(button >= 0);
    return button;
}

void CommandFlow::draw_question(GuiFrame& frame, Commands& out) {
    const Command command = question_.value_or(Command{Kind::quit, {}, {}, 0});
    const int button = answer_to(frame, question_.has_value(), "unsaved",
                                 "Save the changes to " + frame.document.name() + before_what(command.kind),
                                 "Changes that are not saved are lost.", {"Don't save", "Cancel", "Save"});
    if (button >= 0) question_.reset();
    if (button == 0) out.push_back(command);
    if (button == 2) {
        after_save_ = command;
        frames_since_save_ = 0;
        take(frame, {Kind::save, {}, {}, 0}, out);
    }
}

// A file that was kept with the notice's button is decided already: then the file counts as seen.
void CommandFlow::draw_conflict(GuiFrame& frame, Commands& out) {
    if (!conflict_) return;
    const int button =
        answer_to(frame, true, "conflict", frame.document.name() + " was changed by another program",
                  "Saving replaces what is on disk now by the scene as it is here.",
                  {"Overwrite", "Cancel", "Save as..."});
    if (button >= 0) conflict_ = false;
    frames_since_save_ = 0;
    if (button == 1) after_save_.reset();
    if (button == 0) out.push_back({Kind::save, {}, {}, 0});
    if (button == 2) take(frame, {Kind::save_as, {}, {}, 0}, out);
}

void CommandFlow::draw_recovery(GuiFrame& frame, Commands& out) {
    const std::vector<RecoveryOffer>& offers = frame.status.recoveries;
    const bool open = !recovery_answered_ && !offers.empty();
    if (!begin_dialog("recovery", "The last session ended without saving", open, 520, 0)) return;
    dialog_note("An autosave of what was being edited is here. Its file on disk is untouched.", 6);
    for (const RecoveryOffer& offer : offers) {
        ImGui::PushID(offer.autosave.c_str());
        row_text(fitting(offer.scene + ", " + offer.time, px(300)), px(28), color::text);
        ImGui::SameLine();
        const int button = dialog_buttons(frame, "recovery", {"Discard", "Recover"}, -1, offers.size() == 1);
        if (button == 0) out.push_back({Kind::discard_recovery, offer.autosave, {}, 0});
        if (button == 1) take(frame, {Kind::recover, offer.autosave, {}, 0}, out);
        if (button == 1 || (button == 0 && offers.size() == 1)) recovery_answered_ = true;
        ImGui::PopID();
    }
    if (dialog_escape()) recovery_answered_ = true;
    end_dialog(recovery_answered_);
}

void CommandFlow::run(GuiFrame& frame, Panel& panel, Commands& out) {
    finish_save(frame, out);
    if (const std::optional<ParameterKey> wish = panel.take_request()) {
        needs_file_.reset();
        panel_request_ = wish;
        dialog_.open(query_for(*wish, frame.document));
    }
    take_answer(frame, panel, out);
    Commands wishes;
    wishes.swap(frame.requested);
    wishes.insert(wishes.end(), asked_.begin(), asked_.end());
    asked_.clear();
    for (const Command& command : wishes) take(frame, command, out);
    draw_recovery(frame, out);
    draw_question(frame, out);
    draw_conflict(frame, out);
    const FileDialog::Answer answer = dialog_.draw(frame);
    if (answer.done) answer_ = answer;
}

// The two edges that can be dragged, of the side panel and of the timeline: windows without a background,
// which change view.panel_width and view.timeline_height.

constexpr float thickness = 6;
constexpr float panel_least = 300, panel_most = 520;
constexpr float timeline_least = 96, timeline_most = 480;

struct Edge {
    const char* name;
    Rect zone;
    bool vertical;  // the line; it is dragged sideways
    float least, most, standard;
};

// The edge follows the mouse: `size` grows as the mouse goes left or up.
void draw_splitter(GuiFrame& frame, const Edge& edge, float& size) {
    constexpr ImGuiWindowFlags flags =
        ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoNav;
    if (!begin_part(edge.name, edge.zone, flags)) return;
    ImGui::InvisibleButton("edge", edge.zone.size());
    note_item(frame, edge.name);
    const bool active = ImGui::IsItemActive();
    if (active || ImGui::IsItemHovered())
        ImGui::SetMouseCursor(edge.vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    if (active) {
        const ImGuiIO& io = ImGui::GetIO();
        const float far_side = edge.vertical ? io.DisplaySize.x : io.DisplaySize.y;
        const float mouse = edge.vertical ? io.MousePos.x : io.MousePos.y;
        const float beyond = edge.vertical ? 0.0f : px(24);  // the status bar lies under the timeline
        size = std::clamp((far_side - beyond - mouse) / px(1), edge.least, edge.most);
    }
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) size = edge.standard;
    ImVec2 low = edge.zone.corner(), high = edge.zone.end();
    const ImVec2 middle = edge.zone.middle();
    if (edge.vertical)
        low.x = middle.x - px(1), high.x = middle.x;
    else
        low.y = middle.y - px(1), high.y = middle.y;
    fill_rect(low, high, active ? color::accent : color::line);
    ImGui::EndChild();
}

// After the parts, so that they lie over their edges.
void draw_splitters(GuiFrame& frame, const Layout& layout) {
    const ViewState standard;
    const float half = px(thickness) * 0.5f;
    if (layout.panel.width > 0) {
        const Rect zone{layout.panel.x - half, layout.panel.y, 2 * half, layout.panel.height};
        draw_splitter(frame, {"panel splitter", zone, true, panel_least, panel_most, standard.panel_width},
                      frame.view.panel_width);
    }
    if (layout.timeline.height > 0 && frame.view.timeline_open) {
        const Rect zone{layout.timeline.x, layout.timeline.y - half, layout.timeline.width, 2 * half};
        draw_splitter(
            frame,
            {"timeline splitter", zone, false, timeline_least, timeline_most, standard.timeline_height},
            frame.view.timeline_height);
    }
}

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
                     ImGuiWindowFlags_NoNavFocus);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(3);
}

/// The row of the panel; none: null.
const DrawnRow* row_under_mouse(const Panel& panel, const Rect& area) {
    constexpr float half_row = 13;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (!ImGui::IsMouseHoveringRect(area.corner(), area.end(), false)) return nullptr;
    for (const DrawnRow& row : panel.rows())
        if (std::fabs(mouse.y - row.value.y) <= px(half_row)) return &row;
    return nullptr;
}

bool keyboard_is_free() { return !ImGui::GetIO().WantTextInput && !ImGui::IsAnyItemActive() && !any_popup(); }

}  // namespace

struct Gui::State {
    Viewport viewport;
    TimelineState timeline;
    StatusBar status_bar;
    Finder finder;
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
    if (begin_part("viewport", layout.viewport, still | ImGuiWindowFlags_NoNav)) {
        viewport.draw(frame, layout.viewport);
        ImGui::EndChild();
    }
    draw_snapshots(frame, layout.snapshots);
    draw_timeline(timeline, frame, layout.timeline);
    if (begin_part("panel", layout.panel, still)) {
        panel.draw(frame);
        ImGui::EndChild();
    }
    const DrawnRow* const row = row_under_mouse(panel, layout.panel);
    frame.view.hovered_row = row ? row->key : "";
    frame.view.hovered_parameter = row && row->diamond.x >= 0 ? row->key : "";
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
    finder.draw(frame, panel);
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
    steer_by_keys();
    begin_host();
    const Layout layout = make_layout(view, size.x, size.y, px(1));
    state.draw_parts(frame, layout, commands);
    ImGui::End();
    draw_ring();
    state.popup = any_popup();
}

const ViewportInput& Gui::viewport_input() const { return state_->viewport.input(); }

void Gui::ask_to_quit() { state_->flow.ask({Command::Kind::quit, {}, {}, 0}); }

bool Gui::busy() const {
    return ImGui::IsAnyItemActive() || ImGui::GetIO().WantTextInput || state_->popup || state_->flow.busy() ||
           state_->timeline.drag != TimelineState::Drag::none || state_->panel.busy() || keys_steer();
}

bool Gui::opening() const {
    if (state_->flow.awaits_typing() || keys_steer() || state_->panel.awaits_ring()) return true;
    const bool takes_text = ImGui::GetIO().WantTextInput || ImGui::IsAnyItemActive();
    return !takes_text && (state_->popup || state_->flow.busy() || state_->panel.busy());
}

const std::vector<DrawnItem>& Gui::drawn_items() const { return state_->drawn; }
const Panel& Gui::panel() const { return state_->panel; }

}  // namespace astrosplat

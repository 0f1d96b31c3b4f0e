// Files asked for, unsaved changes and those of others asked about, autosaves offered.
#include "gui/command_flow.h"

#include <imgui.h>
#include <unistd.h>

#include "gui/dialog.h"
#include "gui/file_queries.h"
#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

using Kind = Command::Kind;

bool replaces_scene(Kind kind) {
    return kind == Kind::quit || kind == Kind::open || kind == Kind::open_demo ||
           kind == Kind::new_from_file || kind == Kind::new_scene || kind == Kind::recover;
}

// Saving can go where the scene lies; an installed demo's folder is read-only.
bool can_save_in_place(const Document& document) {
    return !document.file().empty() && ::access(document.file().c_str(), W_OK) == 0;
}

const char* before_what(Kind kind) {
    switch (kind) {
        case Kind::quit:
            return " before leaving?";
        case Kind::new_from_file:
        case Kind::new_scene:
            return " before making a new scene?";
        default:
            return " before opening another scene?";
    }
}

}  // namespace

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
        try_edit([&] { panel.answer(*asked_by_panel, *answer.file, frame.document, frame.view); });
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

void CommandFlow::draw_question(GuiFrame& frame, Commands& out) {
    const Kind kind = question_ ? question_->kind : Kind::quit;
    if (!begin_dialog("unsaved", "Save the changes to " + frame.document.name() + before_what(kind),
                      question_.has_value(), 460, 0))
        return;
    dialog_note("Changes that are not saved are lost.", 10);
    const int button = dialog_buttons(frame, "unsaved", {"Don't save", "Cancel", "Save"}, true);
    const Command command = *question_;
    if (button >= 0 || dialog_escape()) {
        question_.reset();
        ImGui::CloseCurrentPopup();
    }
    end_dialog();
    if (button == 0) out.push_back(command);
    if (button == 2) {
        after_save_ = command;
        frames_since_save_ = 0;
        take(frame, {Kind::save, {}, {}, 0}, out);
    }
}

// A file that was kept with the notice's button is decided already: then the file counts as seen.
void CommandFlow::draw_conflict(GuiFrame& frame, Commands& out) {
    if (!begin_dialog("conflict", frame.document.name() + " was changed by another program", conflict_, 460,
                      0))
        return;
    dialog_note("Saving replaces what is on disk now by the scene as it is here.", 10);
    const int button = dialog_buttons(frame, "conflict", {"Overwrite", "Cancel", "Save as..."}, true);
    const bool cancelled = button == 1 || dialog_escape();
    if (button >= 0 || cancelled) {
        conflict_ = false;
        ImGui::CloseCurrentPopup();
    }
    end_dialog();
    frames_since_save_ = 0;
    if (cancelled) after_save_.reset();
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
        const int button = dialog_buttons(frame, "recovery", {"Discard", "Recover"}, offers.size() == 1);
        if (button == 0) out.push_back({Kind::discard_recovery, offer.autosave, {}, 0});
        if (button == 1) take(frame, {Kind::recover, offer.autosave, {}, 0}, out);
        if (button == 1 || (button == 0 && offers.size() == 1)) recovery_answered_ = true;
        ImGui::PopID();
    }
    if (dialog_escape()) recovery_answered_ = true;
    if (recovery_answered_) ImGui::CloseCurrentPopup();
    end_dialog();
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

}  // namespace astrosplat

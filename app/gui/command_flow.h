// Between a wish and a command: asks for the file that is missing, and what to do with unsaved changes, or
// with another program's in the same file, that would be lost. In: what the widgets requested. Out: complete
// commands for the viewer.
#pragma once

#include <functional>
#include <optional>

#include "gui/file_dialog.h"
#include "gui/gui_frame.h"
#include "gui/panel/panel.h"

namespace astrosplat {

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

}  // namespace astrosplat

#include "gui/move_dialog.h"

#include <fmt/format.h>
#include <imgui.h>

#include "edit/camera_moves.h"
#include "gui/dialog.h"
#include "gui/theme.h"

namespace astrosplat {

void begin_move(GuiFrame& frame, CameraMove move) {
    if (camera_keyframes_after(frame.document.scene(), frame.view.frame) > 0) {
        frame.view.asked_move = move;
        return;
    }
    request(frame, Command::Kind::add_move, static_cast<std::size_t>(move));
}

void draw_move_dialog(GuiFrame& frame) {
    std::optional<CameraMove>& move = frame.view.asked_move;
    const char* const name = camera_move_names[static_cast<std::size_t>(move.value_or(CameraMove::orbit))];
    const std::string title = fmt::format("{} from frame {:g}", name, frame.view.frame);
    if (!begin_dialog("move", title, move.has_value(), 460, 0)) return;
    const std::size_t later = camera_keyframes_after(frame.document.scene(), frame.view.frame);
    const std::string note =
        fmt::format("The camera has keyframes at {} later {}.", later, later == 1 ? "frame" : "frames");
    dialog_note(note.c_str(), 4);
    constexpr std::array<const char*, 3> choices{"Keep those after the end of the move",
                                                 "Shift them to after the move", "Replace them by the move"};
    constexpr std::array<const char*, 3> words{"keep", "shift", "replace"};
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const auto choice = static_cast<LaterKeys>(i);
        if (ImGui::RadioButton(choices[i], frame.view.later_keys == choice)) frame.view.later_keys = choice;
        note_item(frame, std::string("move/") + words[i]);
    }
    ImGui::Dummy({0, px(8)});
    const int button = dialog_buttons(frame, "move", {"Cancel", "Add"}, true);
    if (button == 1) request(frame, Command::Kind::add_move, static_cast<std::size_t>(*move));
    if (button >= 0 || dialog_escape()) {
        move.reset();
        ImGui::CloseCurrentPopup();
    }
    end_dialog();
}

}  // namespace astrosplat

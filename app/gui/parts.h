// The parts of the window, each of which draws itself and puts what was asked for into the frame. Those with
// an area draw into the current ImGui window, over it. Only the status bar keeps something from one frame to
// the next.
#pragma once

#include <cstdint>
#include <string>

#include "gui/gui_frame.h"

namespace astrosplat {

/// The bar at the top: menus made of the table of actions, the scene's name in the middle.
void draw_menu_bar(GuiFrame& frame, const Rect& area);

/// The row of tools over the frame: from where it is seen, at what size, compared with what, and how shown.
void draw_tool_row(GuiFrame& frame, const Rect& area);

/// The one line under the tools: that the scene's file changed on disk, or the hint of the first start.
void draw_notice(GuiFrame& frame, const Rect& area);

/// The strip of snapshots under the frame: a thumbnail, its name, splats and time of each; clicked it
/// becomes B.
void draw_snapshots(GuiFrame& frame, const Rect& area);

/// The bar at the bottom: the last message, the pixel under the mouse, jobs, memory. Errors stay until they
/// are clicked.
class StatusBar {
  public:
    void draw(GuiFrame& frame, const Rect& area);

  private:
    void take_message(const Status& status);
    std::string last_;          // message seen before this frame
    std::uint64_t number_ = 0;  // of the last message
    std::string unread_;        // error that waits to be clicked
};

/// Edit > Settings: one row of choices for every setting of the window, while ViewState::settings_open. Every
/// choice acts at once or says when it does; closing asks for them to be kept (Command::keep_settings).
void draw_settings_dialog(GuiFrame& frame);

/// The sheet of shortcuts (F1) and the log: two dialogs that only show.
void draw_shortcut_sheet(GuiFrame& frame);
void draw_log(GuiFrame& frame);

/// Asks for the move; where keyframes of the camera come later the dialog asks first what becomes of them.
void begin_move(GuiFrame& frame, CameraMove move);
void draw_move_dialog(GuiFrame& frame);

/// The choice of frames to render to files, their size and place: a dialog that edits ViewState::render,
/// opened with what the scene says.
void open_render_dialog(const Document& document, ViewState& view, RenderKind kind);
void draw_render_dialog(GuiFrame& frame);

/// The queue of renderings: a dialog that shows Status::jobs, with the finished frames of one of them.
void draw_queue(GuiFrame& frame);

/// "2:05", "1:02:05".
std::string duration_text(double seconds);

}  // namespace astrosplat

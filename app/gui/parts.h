// The parts of the window, each of which draws itself and puts what was asked for into the frame: those with
// an area draw into the current ImGui window, over it; only the status bar keeps something from one frame to
// the next. Then the frame of every dialog, and the table of all that menus and shortcuts do.
#pragma once

#include <initializer_list>

#include "edit/layers.h"
#include "gui/gui_frame.h"
#include "gui/widgets.h"

namespace astrosplat {

class Panel;

/// In their order; Alt and the first letter opens one.
inline constexpr std::array<const char*, 7> menu_names{"File",   "Edit",   "View", "Layer",
                                                       "Camera", "Render", "Help"};

/// At the end of the open one: Left and Right, where they lead nowhere in it, open its neighbour
/// (keyboard.cpp).
void leave_menu_sideways(std::size_t menu);

/// The bar at the top: menus made of the table of actions, the scene's name in the middle.
void draw_menu_bar(GuiFrame& frame, const Rect& area);

/// The row of tools over the frame: from where it is seen, at what size, compared with what, and how shown.
void draw_tool_row(GuiFrame& frame, const Rect& area);

/// The one line under the tools: that the scene's file changed on disk, or the hint of the first start.
void draw_notice(GuiFrame& frame, const Rect& area);

/// "Looking at m51.png".
std::string starting_text(const StartingStatus& starting);

/// At the frame's top left, while ViewState::start: what the picture was taken for, what else it may be, a
/// film, its stars; before that, that it is looked at.
void draw_start_card(GuiFrame& frame, const Rect& viewport);

/// The strip of snapshots under the frame: a thumbnail, its name, splats and time of each; clicked it
/// becomes B.
void draw_snapshots(GuiFrame& frame, const Rect& area);

/// The bar at the bottom: the last message, the pixel under the mouse, jobs, memory. An error stays until it
/// is clicked, its cause is gone, or another scene is opened; what is said meanwhile is seen in its place.
class StatusBar {
  public:
    void draw(GuiFrame& frame, const Rect& area);

  private:
    void take_message(const Status& status);
    std::string last_;            // message seen before this frame
    std::uint64_t number_ = 0;    // of the last message
    std::string unread_;          // error that waits to be clicked
    bool unread_stands_ = false;  // its cause was there
    std::uint64_t scenes_ = 0;    // as Status
};

/// Edit > Settings: one row of choices for every setting of the window, while ViewState::settings_open. Every
/// choice acts at once or says when it does; closing asks for them to be kept (Command::keep_settings).
void draw_settings_dialog(GuiFrame& frame);

/// The sheet of shortcuts (F1) and the log: two dialogs that only show.
void draw_shortcut_sheet(GuiFrame& frame);
void draw_log(GuiFrame& frame);

/// Ctrl+K: a dialog, while ViewState::find_open, with a field whose words are looked for in all actions and
/// in the parameters that the panel shows. Enter runs the action, or shows the parameter and gives it the
/// ring.
class Finder {
  public:
    void draw(GuiFrame& frame, Panel& panel);

  private:
    std::string typed_;
    std::size_t chosen_ = 0;  // row
};

/// Asks for the move; where keyframes of the camera come later the dialog asks first what becomes of them.
void begin_move(GuiFrame& frame, CameraMove move);
void draw_move_dialog(GuiFrame& frame);

/// The choice of frames to render to files, their size and place: a dialog that edits ViewState::render,
/// opened with what was last rendered of the scene, else with what it says.
void open_render_dialog(const Document& document, ViewState& view, RenderKind kind);
void draw_render_dialog(GuiFrame& frame);

/// The queue of renderings: a dialog that shows Status::jobs, with the finished frames of one of them.
void draw_queue(GuiFrame& frame);

/// "2:05", "1:02:05".
std::string duration_text(double seconds);

/// "61 M splats, 9.9 GiB, 5:20", of so large a share of what is made.
std::string making_text(const Making& making, double share = 1.0);

/// Begins a modal dialog `width` px wide at scale 1 (`height` 0: as high as its content). `id` is opened when
/// `open` turns true. True while it is shown; then call end_dialog().
bool begin_dialog(const char* id, const std::string& title, bool open, float width, float height);
/// `closes`: it is not to be seen any more, and `open` will be false.
void end_dialog(bool closes);

/// A quiet line below the title, `gap` px at scale 1 above what follows.
void dialog_note(const char* text, float gap);

/// A button as wide as its text and at least `least` px at scale 1; the accent for what Enter would do.
bool dialog_button(const char* label, bool is_default, float least);

/// Escape was pressed in the dialog, with no text field to leave first.
bool dialog_escape();

/// Buttons at the right of the line, from left to right: index of the one chosen, else -1. Escape chooses the
/// one of index `escape` (-1: none); Enter, where it is taken, the last one.
int dialog_buttons(GuiFrame& frame, const char* id, std::initializer_list<const char*> labels, int escape,
                   bool enter = true);

/// Everything a menu or a shortcut does, once: the menus, the shortcuts and the sheet of shortcuts are loops
/// over a table of these. The row of tools does the same to the view by the functions below.
struct Action {
    const char* menu;  // "File"; "Camera/Add move" for a submenu; "" where only the shortcut does it
    const char* label;
    Shortcut shortcut = {};
    void (*run)(GuiFrame&);
    bool (*enabled)(const GuiFrame&) = nullptr;           // nullptr: always
    bool (*checked)(const GuiFrame&) = nullptr;           // nullptr: not a switch
    std::string (*label_now)(const GuiFrame&) = nullptr;  // in place of label where it says more
    bool line_above = false;
    bool repeats = false;  // while it is held
    Shortcut also = {};    // does the same
};

/// In the order of the menus.
std::span<const Action> actions();

/// Runs the shortcuts pressed this frame but for the keys of the ring. Call it only while no text is typed
/// and nothing is dragged.
void run_shortcuts(GuiFrame& frame);

/// Onto the clipboard; and into the scene, as one undo step.
void copy_part(GuiFrame& f, CopiedKind kind, std::size_t layer);
void paste_part(GuiFrame& f);

void toggle_one_to_one(GuiFrame& f);
void set_compare(GuiFrame& f, CompareMode mode);   // asks for a reference where there is none yet
void compare_with(GuiFrame& f, CompareWith with);  // likewise
bool compares_with_reference(const GuiFrame& f);
bool has_reference(const GuiFrame& f);
void toggle_placing(GuiFrame& f);

}  // namespace astrosplat

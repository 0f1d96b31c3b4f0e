// How the window looks, and what its parts share: colours, fonts and sizes, each said once; the places of
// the parts and of the frame; controls in the theme's manner; small signs drawn with lines, so that they are
// sharp at every scale and need no icon font; and the keys of the keyboard.
#pragma once

#include <imgui.h>

#include <initializer_list>

#include "edit/view_state.h"
#include "scene/reference_place.h"

namespace astrosplat {

// sRGB colours. The greys are neutral beside a picture; the accent is for what is selected or being touched.
// There is one window: set_contrast() changes them all.
namespace color {
inline ImU32 window = IM_COL32(0x1B, 0x1D, 0x20, 255);
inline ImU32 panel = IM_COL32(0x24, 0x27, 0x2B, 255);
inline ImU32 field = IM_COL32(0x2E, 0x32, 0x37, 255);
inline ImU32 hover = IM_COL32(0x3A, 0x3F, 0x45, 255);
inline ImU32 line = IM_COL32(0x15, 0x17, 0x1A, 255);
inline ImU32 text = IM_COL32(0xD6, 0xD8, 0xDB, 255);
inline ImU32 dim = IM_COL32(0x8D, 0x92, 0x98, 255);
inline ImU32 accent = IM_COL32(0x5B, 0x8F, 0xC9, 255);
inline ImU32 attention = IM_COL32(0xD9, 0xA4, 0x41, 255);  // keyframes of an animation, and what is unusual
inline ImU32 good = IM_COL32(0x6A, 0xA8, 0x7A, 255);
inline ImU32 error = IM_COL32(0xCF, 0x6B, 0x5B, 255);
inline constexpr ImU32 axes[] = {IM_COL32(0xC4, 0x6A, 0x60, 255), IM_COL32(0x7C, 0xA8, 0x66, 255),
                                 IM_COL32(0x62, 0x8F, 0xC4, 255)};  // x, y, z
inline constexpr ImU32 none = IM_COL32(0, 0, 0, 0);
/// `opacity` 0..1 replaces the colour's own.
constexpr ImU32 with_opacity(ImU32 c, float opacity) {
    return (c & ~IM_COL32_A_MASK) | (static_cast<ImU32>(opacity * 255.0f + 0.5f) << IM_COL32_A_SHIFT);
}
inline ImU32 selection = with_opacity(accent, 0.28f);
inline ImU32 fill = with_opacity(accent, 0.25f);
}  // namespace color

/// Fonts, colours, spacing: once after ImGui::CreateContext. `content_scale`: of the monitor; `contrast` as
/// set_contrast() has it.
void apply_theme(float content_scale, int contrast = 0);

/// For ImGui::PushStyleColor and the like that want floats.
inline ImVec4 color4(ImU32 c) { return ImGui::ColorConvertU32ToFloat4(c); }

// Fonts that apply_theme loaded into the current context, besides the regular one of 15 px.
ImFont* medium_font();  // 15 px, for heads
ImFont* small_font();   // 13 px, for plots and the status bar

/// 0: normal, 1: high: text at least 7 to 1 against what it stands on, borders that are seen.
void set_contrast(int contrast);
int theme_contrast();

/// Window pixels of a length given at content scale 1.
float px(float length);

/// A rectangle of the window, px from its upper left.
struct Rect {
    float x = 0, y = 0, width = 0, height = 0;

    Rect() = default;
    Rect(float x_, float y_, float width_, float height_) : x(x_), y(y_), width(width_), height(height_) {}
    Rect(ImVec2 corner, ImVec2 size) : Rect(corner.x, corner.y, size.x, size.y) {}
    ImVec2 corner() const { return {x, y}; }
    ImVec2 size() const { return {width, height}; }
    ImVec2 end() const { return {x + width, y + height}; }
    ImVec2 middle() const { return {x + width * 0.5f, y + height * 0.5f}; }
};

/// Where things lie for a window of this size. What is hidden has no height or width.
struct Layout {
    Rect menu, tools;
    Rect notice;  // one line under the tools: the hint, or that the file changed on disk
    Rect viewport;
    Rect snapshots;  // strip between viewport and timeline
    Rect panel, timeline, status;
};
Layout make_layout(const ViewState& view, float width_px, float height_px, float content_scale);

/// Where a frame of this size is shown, px of the window. Fit: as large as the viewport allows, in its
/// middle; 1:1: zoomed and moved as `view` says. It may reach beyond the viewport.
Rect place_frame(const ViewState& view, const Rect& viewport, int width_px, int height_px);

/// The same for what lies over it.
inline FrameOnScreen frame_on_screen(const Rect& frame) {
    return {{frame.x + 0.5 * frame.width, frame.y + 0.5 * frame.height}, std::max(1.0f, frame.height)};
}

/// A child window over `area`, without padding; false (and nothing to end) where there is none. The
/// keyboard's ring goes through all of them but those with ImGuiWindowFlags_NoNav.
bool begin_part(const char* name, const Rect& area, ImGuiWindowFlags flags = ImGuiWindowFlags_NoScrollbar);

/// A tooltip of the last item after a short wait: at the mouse, or beside the panel.
void tooltip(const char* text);
/// The next tooltip lies left of the side panel, its top at `y`, where the current window is in there: rows
/// below stay in sight.
void place_tooltip(float y);

struct Segment {
    const char* label;
    const char* tooltip;
};
/// Of the buttons of a segmented control (gui_frame.h).
float segmented_width(std::initializer_list<Segment> segments);

/// Makes fields and buttons so many px high, until ImGui::PopStyleVar.
void push_field_height(float height);

/// A menu, a list or a dialog is open.
bool any_popup();

/// In an open menu: Escape closes it.
void close_on_escape();

// The keyboard's way through the window (keyboard.cpp): Tab, F6, the arrows, Space and Enter move a ring from
// control to control and use the one it is on; until there is a ring these keys are the timeline's. Escape or
// a click takes it away. Alt, alone or with a letter, and F10 open menus, in which the arrows go on.

/// Takes the keys of this frame: at its beginning.
void steer_by_keys();
/// A control has the ring.
bool ring_shown();
void hide_ring();
/// The key is the ring's, and no shortcut.
bool takes_key(int code);
/// Enter is a dialog's answer: it is pressed in a text, or with no control that would use it.
bool enter_answers();
/// In a part, before its first control: the ring comes here where the keys ask for this part.
void enter_part(const char* name);
/// In a child window that the ring does not enter: it is no control of the window around it, either.
void pass_ring_by();
/// The keys ask for this menu.
bool opens_menu(const char* name);
/// The last item has the ring, and Enter was pressed.
bool entered_by_key();
/// What took text in the place of this control is gone: the ring, where there is one, is at the control
/// again.
void keep_ring_at(ImGuiID id);
/// The ring goes to the control that comes next.
void ring_to_next_item();
/// The ring is on its way: another frame is needed.
bool keys_steer();
/// Over everything: at the end of a frame.
void draw_ring();

// Drawn into the current window, px. What lies along an axis covers whole pixels at every scale: so it is
// sharp, and the same whatever rounds edges that lie in the middle of a pixel. Lines are at least
// a pixel wide.
void fill_rect(ImVec2 low, ImVec2 high, ImU32 ink, float radius = 0.0f);
void fill_rect(const Rect& area, ImU32 ink, float radius = 0.0f);
/// Around the pixel of `middle`, `half` px and half a pixel to either side.
void fill_square(ImVec2 middle, float half, ImU32 ink);
/// A line along the inside of the border.
void outline_rect(const Rect& area, ImU32 ink, float radius = 0.0f, float width = 1.0f);
/// From x0 to x1 over the pixels that `y` lies in, or from y0 to y1 over those of `x`.
void line_across(float x0, float x1, float y, ImU32 ink, float width = 1.0f);
void line_down(float x, float y0, float y1, ImU32 ink, float width = 1.0f);
/// In any other direction.
void draw_line(ImVec2 from, ImVec2 to, ImU32 ink, float width = 1.0f);
void draw_text(ImVec2 at, ImU32 ink, const std::string& text);

/// Text in the vertical middle of a row of this height, at the cursor.
void row_text(const std::string& text, float row_height, ImU32 text_color);

/// A share 0..1 of `width` px that is done; 4 px high at scale 1.
void progress_bar(ImVec2 corner, float width, float share);

/// A texture of this aspect (width / height) on black, as large as `area` allows; with none of either black
/// alone. `radius`: of the corners of the black, px at scale 1.
void image_box(const Rect& area, ImTextureID texture, float aspect, float radius);

/// ImGui's popup as a menu, which Escape closes; end_menu_popup only after true.
bool begin_menu_popup(const char* id);
void end_menu_popup();

/// Shortened in its middle ("whirl...final.toml") to fit `width` px of the current font.
std::string fitting(const std::string& text, float width);

enum class Icon {
    eye,
    eye_closed,
    diamond,        // a keyframe is here
    diamond_empty,  // animated, no keyframe here; or can be
    play,
    pause,
    chevron_right,
    chevron_down,
    chevron_up,
    plus,
    cross,
    ring,      // holdout off
    ring_cut,  // holdout on
    curve,
    warning,
    folder,
    file,
    dots,
    tick,
    pick  // from the picture
};

/// Draws an icon in a square of `size` px around `center`.
void draw_icon(ImDrawList* list, Icon icon, ImVec2 center, float size, ImU32 color);

/// The bracket at the left of layers that are composited as one, from y0 to y1 with its back at `x`.
void draw_bracket(ImDrawList* list, float x, float y0, float y1, ImU32 color);

/// A button without a frame that shows an icon of `icon_px`, `size` px in all; a faint field when hovered.
/// `says`, its tooltip, may be nullptr. True when clicked.
bool icon_button(const char* id, Icon icon, ImVec2 size, float icon_px, ImU32 color, const char* says);

/// Codes of keys that ImGui does not name itself, as they index ImGuiIO::KeysDown, also in versions that have
/// an enumeration of their own (1.87). They are GLFW's: letters and digits are their ASCII codes.
namespace key_code {
inline constexpr int space = 32, n0 = 48, n1 = 49, n3 = 51, n7 = 55, n9 = 57;
inline constexpr int escape = 256, enter = 257, tab = 258, backspace = 259, insert = 260, del = 261;
inline constexpr int right = 262, left = 263, down = 264, up = 265;
inline constexpr int page_up = 266, page_down = 267, home = 268, end = 269;
inline constexpr int f1 = 290, f6 = 295, f10 = 299, f11 = 300, f12 = 301;
inline constexpr int pad_enter = 335, left_alt = 342;
}  // namespace key_code

/// Whether the key went down in this frame, also by holding it where that `repeats`; whether it is down.
bool key_pressed(int code, bool repeats = false);
bool key_down(int code);

struct Shortcut {
    int code = 0;  // 0: none
    bool ctrl = false, shift = false;
};
/// As key_pressed, with these modifiers and no others.
bool shortcut_pressed(const Shortcut& shortcut, bool repeats);
/// "Ctrl+Shift+S", for menus and the sheet of shortcuts; "" for none.
std::string shortcut_text(const Shortcut& shortcut);

}  // namespace astrosplat

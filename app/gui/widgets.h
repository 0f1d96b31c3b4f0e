// Controls that several parts of the window share, in the theme's manner.
#pragma once

#include <initializer_list>
#include <string>

#include "gui/layout.h"
#include "gui/theme.h"

namespace astrosplat {

/// A child window over `area`, without padding; false (and nothing to end) where there is none.
bool begin_part(const char* name, const Rect& area, ImGuiWindowFlags flags = ImGuiWindowFlags_NoScrollbar);

/// A tooltip of the last item after a short wait.
void tooltip(const char* text);

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

/// In an open menu: Escape closes it (ImGui does so only with keyboard navigation, which the arrow keys
/// forbid).
void close_on_escape();

// Drawn into the current window, px.
void fill_rect(ImVec2 low, ImVec2 high, ImU32 ink, float radius = 0.0f);
void fill_rect(const Rect& area, ImU32 ink, float radius = 0.0f);
void draw_line(ImVec2 from, ImVec2 to, ImU32 ink, float width = 1.0f);
void draw_text(ImVec2 at, ImU32 ink, const std::string& text);

/// Text in the vertical middle of a row of this height, at the cursor.
void row_text(const std::string& text, float row_height, ImU32 text_color);

/// A share 0..1 of `width` px that is done; 4 px high at scale 1.
void progress_bar(ImVec2 corner, float width, float share);

/// A texture of this aspect (width / height) on black, as large as `area` allows; with none of either black
/// alone. `radius`: of the corners of the black, px at scale 1.
void picture_box(const Rect& area, ImTextureID texture, float aspect, float radius);

/// ImGui's popup as a menu, which Escape closes; end_menu_popup only after true.
bool begin_menu_popup(const char* id);
void end_menu_popup();

/// Shortened in its middle ("whirl...final.toml") to fit `width` px of the current font.
std::string fitting(const std::string& text, float width);

}  // namespace astrosplat

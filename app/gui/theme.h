// How the window looks: colours, fonts and sizes, each said once. In: the monitor's content scale and the
// contrast a person asked for. Out: ImGui's style set, and what hand-drawn widgets share.
#pragma once

#include <imgui.h>

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

}  // namespace astrosplat

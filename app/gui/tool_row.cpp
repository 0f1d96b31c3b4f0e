// Tools at the left are always there; those at the right move into a menu, the rarest first, where the row is
// too narrow for them.
#include "gui/tool_row.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "gui/action_functions.h"
#include "gui/icons.h"
#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float control_height = 24, gap = 12, small_gap = 4;

int choice(GuiFrame& frame, const char* id, std::initializer_list<Segment> segments, int chosen) {
    return noted_segments(frame, id, id, segments, chosen, control_height);
}

void view_choice(GuiFrame& frame) {
    const int clicked = choice(frame, "view",
                               {{"Camera", "Through the scene's camera (0)"},
                                {"Free", "A camera of the window, the scene's stays (drag in the view)"},
                                {"Front", "Along z, without perspective (1)"},
                                {"Top", "From above (7)"},
                                {"Side", "Along x (3)"}},
                               static_cast<int>(frame.view.view));
    if (clicked >= 0) frame.view.view = static_cast<ViewKind>(clicked);
}

void size_choice(GuiFrame& frame) {
    const int clicked =
        choice(frame, "size",
               {{"Fit", "The frame at the size of the window (Z)"},
                {"1:1", "The frame at the size of the output: wheel zooms, middle drag moves (Z)"}},
               static_cast<int>(frame.view.size));
    if (clicked >= 0 && clicked != static_cast<int>(frame.view.size)) toggle_one_to_one(frame);
}

// A field that opens a list of choices.
template <class Enum>
void combo(const char* id, Enum& value, const std::vector<const char*>& names, float width) {
    ImGui::SetNextItemWidth(width);
    const auto index = static_cast<std::size_t>(value);
    ImGui::PushStyleColor(ImGuiCol_Text, index == 0 ? color::dim : color::text);
    const bool open = ImGui::BeginCombo(id, names[index], ImGuiComboFlags_NoArrowButton);
    ImGui::PopStyleColor();
    if (!open) return;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (ImGui::Selectable(names[i], i == index)) value = static_cast<Enum>(i);
    close_on_escape();
    ImGui::EndCombo();
}

void compare_choice(GuiFrame& frame) {
    const int clicked = choice(frame, "compare",
                               {{"A", "The look as it is now (Tab)"},
                                {"A|B", "Wipe between now and B"},
                                {"B", "The stored look; B stores one (Tab)"},
                                {"Ref", "Over the reference picture"},
                                {"Diff", "Difference from the reference picture, or from B"}},
                               static_cast<int>(frame.view.compare));
    if (clicked >= 0) set_compare(frame, static_cast<CompareMode>(clicked));
    ViewState& view = frame.view;
    ImGui::SameLine(0, px(small_gap));
    if (view.compare != CompareMode::difference) return;
    const DifferenceFrom before = view.difference_from;
    combo("##from", view.difference_from, {"from Ref", "from B"}, px(76));
    note_item(frame, "difference from");
    tooltip("What the difference is taken from");
    if (view.difference_from != before) set_compare(frame, view.compare);
    ImGui::SameLine(0, px(small_gap));
    drag_field("##gain", view.difference_gain, 0.02f, 0.1f, 100, "x %.1f", px(52), color::text);
    tooltip("The difference is multiplied by this");
}

void display_control(GuiFrame& frame) {
    combo("##display", frame.view.display, {"As output", "Linear", "sRGB", "Soft"}, px(84));
    note_item(frame, "display");
    tooltip("How the frame's linear light is shown; rendered files follow [output] view");
}

void exposure_control(GuiFrame& frame) {
    float& stops = frame.view.inspect_exposure;
    drag_field("##exposure", stops, 0.02f, -20, 20, "%+.1f EV", px(72),
               stops != 0 ? color::attention : color::dim);
    note_item(frame, "exposure");
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) stops = 0.0f;
    tooltip("Exposure of this window only, to look into dark and bright parts. Never saved. Right click: 0");
}

// From as many dots as hold the frame rate to all splats.
void preview_control(GuiFrame& frame) {
    constexpr float least_percent = 0.5f;
    float percent = frame.view.preview_share * 100.0f;
    const float x = ImGui::GetCursorPosX();
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, color::dim);
    ImGui::TextUnformatted("Preview");
    ImGui::SameLine(x + px(58));
    ImGui::SetNextItemWidth(px(100));
    const char* format = percent > 0 ? "%.0f %%" : "Fluid";
    if (ImGui::SliderFloat("##preview", &percent, 0, 100, format, ImGuiSliderFlags_AlwaysClamp))
        frame.view.preview_share = percent < least_percent ? 0.0f : percent / 100.0f;
    ImGui::PopStyleColor();
    note_item(frame, "preview");
    tooltip(
        "What moves: at the left as many dots as hold 24 frames a second, each for many splats; to the right "
        "more dots and fewer frames, up to every splat");
}

void engine_control(GuiFrame& frame) {
    combo("##engine", frame.view.engine, {"Engine auto", "OpenGL", "Processor"}, px(96));
    note_item(frame, "engine");
    const std::string text = "What draws the preview. Now: " + frame.status.engine;
    tooltip(text.c_str());
}

struct Tool {
    float width;  // at scale 1
    void (*draw)(GuiFrame&);
};
constexpr std::array<Tool, 4> right_tools{
    {{84, display_control}, {72, exposure_control}, {158, preview_control}, {96, engine_control}}};

void rest_of_tools(GuiFrame& frame, std::size_t from) {
    const bool clicked = icon_button("more", Icon::dots, {px(control_height), px(control_height)}, px(12),
                                     color::dim, nullptr);
    note_item(frame, "more tools");
    if (clicked) ImGui::OpenPopup("rest");
    if (!ImGui::BeginPopup("rest")) return;
    for (std::size_t i = from; i < right_tools.size(); ++i) right_tools[i].draw(frame);
    close_on_escape();
    ImGui::EndPopup();
}

void draw_right_tools(GuiFrame& frame, const Rect& area, float left_end) {
    const float more = px(control_height) + px(small_gap);
    const float right = area.x + area.width - px(8);
    const auto width_of = [](std::size_t count) {
        float width = 0;
        for (std::size_t i = 0; i < count; ++i)
            width += px(right_tools[i].width) + (i > 0 ? px(small_gap) : 0);
        return width;
    };
    std::size_t fits = right_tools.size();
    while (fits > 0 && left_end + px(gap) + width_of(fits) + (fits < right_tools.size() ? more : 0) > right)
        --fits;
    const bool rest = fits < right_tools.size();
    ImGui::SetCursorScreenPos({std::floor(right - width_of(fits) - (rest ? more : 0)), area.y + px(4)});
    for (std::size_t i = 0; i < fits; ++i) {
        right_tools[i].draw(frame);
        ImGui::SameLine(0, px(small_gap));
    }
    if (rest) rest_of_tools(frame, fits);
}

}  // namespace

void draw_tool_row(GuiFrame& frame, const Rect& area) {
    if (!begin_part("tools", area)) return;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(px(8), (px(control_height) - ImGui::GetFontSize()) / 2));
    ImGui::SetCursorScreenPos({area.x + px(8), area.y + px(4)});
    view_choice(frame);
    ImGui::SameLine(0, px(gap));
    size_choice(frame);
    ImGui::SameLine(0, px(gap));
    compare_choice(frame);
    ImGui::SameLine(0, 0);
    draw_right_tools(frame, area, ImGui::GetCursorScreenPos().x);
    ImGui::PopStyleVar();
    ImGui::EndChild();
}

}  // namespace astrosplat

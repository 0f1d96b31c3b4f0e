// Tools at the left are always there; those at the right move into a menu, the rarest first, where the row is
// too narrow for them.
#include "gui/parts.h"

#include <array>
#include <cmath>
#include <vector>

#include "gui/actions.h"
#include "gui/icons.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float control_height = 24, gap = 12, small_gap = 4;

int choice(GuiFrame& frame, const char* id, std::initializer_list<Segment> segments, int chosen) {
    return segmented(frame, id, segments, chosen, control_height);
}

// A field that opens a list of choices.
template <class Enum>
void combo(GuiFrame& frame, const char* name, Enum& value, const std::vector<const char*>& names, float width,
           const std::string& says) {
    ImGui::SetNextItemWidth(px(width));
    const auto index = static_cast<std::size_t>(value);
    ImGui::PushStyleColor(ImGuiCol_Text, index == 0 ? color::dim : color::text);
    const bool open =
        ImGui::BeginCombo((std::string("##") + name).c_str(), names[index], ImGuiComboFlags_NoArrowButton);
    ImGui::PopStyleColor();
    if (open) {
        for (std::size_t i = 0; i < names.size(); ++i)
            if (ImGui::Selectable(names[i], i == index)) value = static_cast<Enum>(i);
        close_on_escape();
        ImGui::EndCombo();
    }
    note_item(frame, name);
    tooltip(says.c_str());
}

// A field in a narrow row.
void view_choice(GuiFrame& frame, bool is_narrow) {
    if (is_narrow)
        return combo(frame, "view", frame.view.view, {"Camera", "Free", "Front", "Top", "Side"}, 84,
                     "What is seen through (0, 1, 7, 3)");
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

void compare_choice(GuiFrame& frame) {
    const bool with_reference = compares_with_reference(frame);
    const char* const other = with_reference ? "Ref" : "B";
    const char* const both = with_reference ? "A|Ref" : "A|B";
    const int clicked =
        choice(frame, "compare",
               {{"A", "The look as it is now (Tab)"},
                {both, "Wipe between now and what it is compared with"},
                {other, "What it is compared with: the stored look, or the reference over the view (Tab)"},
                {"Blink", "One after the other (X)"},
                {"Diff", "Now minus what it is compared with; grey where they are equal"}},
               static_cast<int>(frame.view.compare));
    if (clicked >= 0) set_compare(frame, static_cast<CompareMode>(clicked));
}

// The settings of the chosen comparison, next to it; nothing while A is seen alone.
void compare_settings(GuiFrame& frame) {
    ViewState& view = frame.view;
    if (!compares(view)) return;
    CompareWith with = view.compare_with;
    combo(frame, "compare with", with, {"with B", "with Ref"}, 76,
          "What is compared with: the stored look B, or the reference picture (Shift+B)");
    if (with != view.compare_with) compare_with(frame, with);
    if (view.compare == CompareMode::difference) {
        ImGui::SameLine(0, px(small_gap));
        drag_field(frame, view.difference_gain,
                   {"difference gain", 0.02f, 0.1f, 100, "x %.1f", 52, color::text,
                    "The difference is multiplied by this"});
    }
    if (view.compare == CompareMode::blink) {
        ImGui::SameLine(0, px(small_gap));
        drag_field(frame, view.blink_hz,
                   {"blink rate", 0.02f, 0.25f, 10, "%.1f /s", 52, color::text, "Changes a second"});
    }
    if (!has_reference(frame) || !compares_with_reference(frame)) return;
    ImGui::SameLine(0, px(small_gap));
    if (choice(frame, "place", {{"Place", "Move, turn and scale the reference in the view (P)"}},
               view.placing ? 0 : -1) == 0)
        toggle_placing(frame);
}

float width_of_compare_settings(const GuiFrame& frame) {
    const CompareMode mode = frame.view.compare;
    if (!compares(frame.view)) return 0;
    const bool has_number = mode == CompareMode::difference || mode == CompareMode::blink;
    const bool has_place = has_reference(frame) && compares_with_reference(frame);
    return 76 + (has_number ? small_gap + 52 : 0) + (has_place ? small_gap + 52 : 0);
}

void display_control(GuiFrame& frame) {
    combo(frame, "display", frame.view.display, {"As output", "Linear", "sRGB", "Soft"}, 84,
          "How the frame's linear light is shown; rendered files follow the panel Output");
}

void exposure_control(GuiFrame& frame) {
    float& stops = frame.view.inspect_exposure;
    drag_field(
        frame, stops,
        {"exposure", 0.02f, -20, 20, "%+.1f EV", 72, stops != 0 ? color::attention : color::dim,
         "Exposure of this window only, to look into dark and bright parts. Never saved. Right click: 0"});
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) stops = 0.0f;
}

// From as many splats as hold the frame rate to all of them.
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
        "What moves: at the left as many splats as hold 24 frames a second, each in place of many; to the "
        "right more splats and fewer frames, up to every splat");
}

void engine_control(GuiFrame& frame) {
    combo(frame, "engine", frame.view.engine, {"Engine auto", "OpenGL", "Processor"}, 96,
          "What draws the preview. Now: " + frame.status.engine);
}

struct Tool {
    float width;  // at scale 1
    void (*draw)(GuiFrame&);
};
constexpr std::array<Tool, 4> right_tools{
    {{84, display_control}, {72, exposure_control}, {158, preview_control}, {96, engine_control}}};

// The tools that had no room: the settings of the comparison where `with_compare`, and the tools from one on.
void rest_of_tools(GuiFrame& frame, bool with_compare, std::size_t from) {
    const bool clicked = icon_button("more", Icon::dots, {px(control_height), px(control_height)}, px(12),
                                     color::dim, nullptr);
    note_item(frame, "more tools");
    if (clicked) ImGui::OpenPopup("rest");
    if (!ImGui::BeginPopup("rest")) return;
    if (with_compare) compare_settings(frame);
    for (std::size_t i = from; i < right_tools.size(); ++i) right_tools[i].draw(frame);
    close_on_escape();
    ImGui::EndPopup();
}

void draw_right_tools(GuiFrame& frame, const Rect& area) {
    const float more = px(control_height) + px(small_gap);
    const float right = area.end().x - px(8);
    const float settings_end =
        ImGui::GetCursorScreenPos().x + px(small_gap + width_of_compare_settings(frame));
    const bool has_settings = settings_end + px(gap) + more <= right;
    if (has_settings) {
        ImGui::SetCursorScreenPos({ImGui::GetCursorScreenPos().x + px(small_gap), area.y + px(4)});
        compare_settings(frame);
    }
    const float left_end = has_settings ? settings_end : ImGui::GetCursorScreenPos().x;
    const auto width_of = [](std::size_t count) {
        float width = 0;
        for (std::size_t i = 0; i < count; ++i)
            width += px(right_tools[i].width) + (i > 0 ? px(small_gap) : 0);
        return width;
    };
    std::size_t fits = right_tools.size();
    const auto has_rest = [&] { return !has_settings || fits < right_tools.size(); };
    while (fits > 0 && left_end + px(gap) + width_of(fits) + (has_rest() ? more : 0) > right) --fits;
    const bool rest = has_rest();
    ImGui::SetCursorScreenPos({std::floor(right - width_of(fits) - (rest ? more : 0)), area.y + px(4)});
    for (std::size_t i = 0; i < fits; ++i) {
        right_tools[i].draw(frame);
        ImGui::SameLine(0, px(small_gap));
    }
    if (rest) rest_of_tools(frame, !has_settings, fits);
}

}  // namespace

void draw_tool_row(GuiFrame& frame, const Rect& area) {
    if (!begin_part("tools", area)) return;
    push_field_height(px(control_height));
    ImGui::SetCursorScreenPos({area.x + px(8), area.y + px(4)});
    constexpr float narrow = 620;
    view_choice(frame, area.width < px(narrow));
    ImGui::SameLine(0, px(gap));
    size_choice(frame);
    ImGui::SameLine(0, px(gap));
    compare_choice(frame);
    ImGui::SameLine(0, 0);
    draw_right_tools(frame, area);
    ImGui::PopStyleVar();
    ImGui::EndChild();
}

}  // namespace astrosplat

// A splitter is a window 6 px thick without a background, over the edge of two parts.
#include "gui/parts.h"

#include <imgui.h>

#include <algorithm>

#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float thickness = 6;
constexpr float panel_least = 300, panel_most = 520;
constexpr float timeline_least = 96, timeline_most = 480;

struct Edge {
    const char* name;
    Rect zone;
    bool vertical;  // the line; it is dragged sideways
    float least, most, standard;
};

// The edge follows the mouse: `size` grows as the mouse goes left or up.
void draw_splitter(GuiFrame& frame, const Edge& edge, float& size) {
    if (!begin_part(edge.name, edge.zone, ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollbar))
        return;
    ImGui::InvisibleButton("edge", {edge.zone.width, edge.zone.height});
    note_item(frame, edge.name);
    const bool active = ImGui::IsItemActive();
    if (active || ImGui::IsItemHovered())
        ImGui::SetMouseCursor(edge.vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    if (active) {
        const ImGuiIO& io = ImGui::GetIO();
        const float far_side = edge.vertical ? io.DisplaySize.x : io.DisplaySize.y;
        const float mouse = edge.vertical ? io.MousePos.x : io.MousePos.y;
        const float beyond = edge.vertical ? 0.0f : px(24);  // the status bar lies under the timeline
        size = std::clamp((far_side - beyond - mouse) / px(1), edge.least, edge.most);
    }
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) size = edge.standard;
    const float x = edge.zone.x + edge.zone.width * 0.5f, y = edge.zone.y + edge.zone.height * 0.5f;
    const ImU32 c = active ? color::accent : color::line;
    if (edge.vertical)
        ImGui::GetWindowDrawList()->AddRectFilled({x - px(1), edge.zone.y},
                                                  {x, edge.zone.y + edge.zone.height}, c);
    else
        ImGui::GetWindowDrawList()->AddRectFilled({edge.zone.x, y - px(1)},
                                                  {edge.zone.x + edge.zone.width, y}, c);
    ImGui::EndChild();
}

}  // namespace

void draw_splitters(GuiFrame& frame, const Layout& layout) {
    const ViewState standard;
    const float half = px(thickness) * 0.5f;
    if (layout.panel.width > 0) {
        const Rect zone{layout.panel.x - half, layout.panel.y, 2 * half, layout.panel.height};
        draw_splitter(frame, {"panel splitter", zone, true, panel_least, panel_most, standard.panel_width},
                      frame.view.panel_width);
    }
    if (layout.timeline.height > 0 && frame.view.timeline_open) {
        const Rect zone{layout.timeline.x, layout.timeline.y - half, layout.timeline.width, 2 * half};
        draw_splitter(
            frame,
            {"timeline splitter", zone, false, timeline_least, timeline_most, standard.timeline_height},
            frame.view.timeline_height);
    }
}

}  // namespace astrosplat

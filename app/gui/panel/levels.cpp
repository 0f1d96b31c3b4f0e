// Black and white point, dragged over the spread of the picture's values.
#include "gui/panel/levels.h"

#include <algorithm>
#include <cmath>

#include "gui/panel/plot.h"
#include "gui/panel/words.h"
#include "gui/theme.h"

namespace astrosplat::panel {
namespace {

using Values = LayerHistograms::Values;

double value_or(Context& context, const ParameterKey& key, double automatic) {
    const Parameter* parameter = find(context, key);
    const Value value = parameter ? parameter->get() : Value();
    return value.is_number() ? value.number() : automatic;
}

float place(const Area& area, const Values& values, double value) {
    const double share = (value - values.lo) / std::max(values.hi - values.lo, 1e-30);
    return area.corner.x + area.size.x * static_cast<float>(std::clamp(share, 0.0, 1.0));
}

// One handle: a line with a foot; returns true while it is dragged, with the value under the mouse.
bool handle(Context& context, const Area& area, const Values& values, const char* id, double& value) {
    const float x = place(area, values, value), reach = px(6);
    ImGui::SetCursorScreenPos({x - reach, area.corner.y});
    ImGui::InvisibleButton(id, {reach * 2.0f, area.size.y});
    if (ImGui::IsItemActivated()) begin_gesture(context);
    const bool active = ImGui::IsItemActive(), near = active || ImGui::IsItemHovered();
    if (near) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 ink = near ? color::accent : color::text;
    list->AddLine({x, area.corner.y}, {x, area.end().y}, ink, px(1.5f));
    const float foot = area.end().y;
    list->AddTriangleFilled({x, foot - px(8)}, {x + px(5), foot}, {x - px(5), foot}, ink);
    if (!active || ImGui::GetIO().MouseDelta.x == 0.0f) return false;
    const double share =
        double(std::clamp((ImGui::GetIO().MousePos.x - area.corner.x) / area.size.x, 0.0f, 1.0f));
    const double range = values.hi - values.lo;
    value = rounded_to_step(values.lo + share * range, range * 1e-3);
    return true;
}

}  // namespace

void edit_levels(Context& context) {
    const auto& histograms = context.layer_status().histograms;
    if (!histograms || histograms->values.share.empty()) return;
    const Values& values = histograms->values;
    const ParameterKey source = context.layer_key() / "source";
    double black = value_or(context, source / "black", values.black);
    double white = value_or(context, source / "white", values.white);
    const Area area = begin_plot();
    const ImVec2 below = ImGui::GetCursorScreenPos();
    context.memory.plots[source / "black"] = {area.corner.x, area.corner.y, area.size.x, area.size.y};
    draw_bars(area, values.share);
    const ImU32 shade = color::with_opacity(color::window, 0.6f);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(area.corner, {place(area, values, black), area.end().y}, shade);
    list->AddRectFilled({place(area, values, white), area.corner.y}, area.end(), shade);
    const double least = (values.hi - values.lo) * 2e-3;
    if (handle(context, area, values, "black", black))
        set_value(context, source / "black", std::min(black, white - least), context.memory.gesture);
    if (handle(context, area, values, "white", white))
        set_value(context, source / "white", std::max(white, black + least), context.memory.gesture);
    ImGui::SetCursorScreenPos(below);
    captions(figures(values.lo), figures(values.hi));
}

}  // namespace astrosplat::panel

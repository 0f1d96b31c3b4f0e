// One area shows both pictures: left of the line before, right of it after.
#include "gui/panel/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "gui/panel/box.h"
#include "gui/panel/plot.h"
#include "gui/panel/section.h"
#include "gui/theme.h"

namespace astrosplat::panel {
namespace {

constexpr float tallest = 320.0f;  // px at scale 1

// As wide as the panel, or as tall as there is room for.
Area picture_area(float aspect) {
    const float room = ImGui::GetContentRegionAvail().x;
    const float height = std::floor(std::min(room / std::max(aspect, 0.01f), px(tallest)));
    const float width = std::floor(std::min(room, height * aspect));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    return {{corner.x + std::floor((room - width) * 0.5f), corner.y}, {width, height}};
}

void drag_line(Context& context, const Area& area) {
    ImGui::SetCursorScreenPos(area.corner);
    ImGui::InvisibleButton("before and after", area.size);
    const bool active = ImGui::IsItemActive();
    if (active || ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (active)
        context.memory.preparation_line =
            std::clamp((ImGui::GetIO().MousePos.x - area.corner.x) / area.size.x, 0.0f, 1.0f);
}

void draw_both(Context& context, const PrepareStatus& status) {
    const Area area = picture_area(status.aspect);
    context.memory.plots[context.layer_key() / "source.prepare"] = {area.corner.x, area.corner.y, area.size.x,
                                                                    area.size.y};
    drag_line(context, area);
    const float share = context.memory.preparation_line;
    const float x = std::round(area.corner.x + area.size.x * share);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(area.corner, area.end(), IM_COL32_BLACK);
    if (status.before) list->AddImage(status.before, area.corner, {x, area.end().y}, {0, 0}, {share, 1});
    if (status.after) list->AddImage(status.after, {x, area.corner.y}, area.end(), {share, 0}, {1, 1});
    list->AddLine({x, area.corner.y}, {x, area.end().y}, color::text, px(1));
    captions("before", "after");
}

std::string what_was_done(const PrepareStatus& status, const PrepareParams& params) {
    if (status.working) return "Preparing";
    if (!prepares(params)) return "Nothing is prepared: the picture is used as it is.";
    std::string text = "A quick look at reduced size";
    if (params.stars == PrepareParams::Stars::remove)
        text += ", " + counted(status.stars, "star") + " removed";
    return text + ".";
}

}  // namespace

void draw_preparation(Context& context) {
    context.view.preparation_open = true;
    const std::optional<PrepareStatus>& status = context.status.preparation;
    if (!status) return;
    ImGui::Dummy({0.0f, px(4)});
    if (status->before && status->after) draw_both(context, *status);
    if (status->error.empty())
        note(what_was_done(*status, context.layer().source.texture.prepare));
    else
        note(status->error, color::error);
    if (button_line({"Write to folder..."}) == 0)
        context.commands.push_back({Command::Kind::prepare_picture, {}, "", context.view.layer});
    ImGui::Dummy({0.0f, px(4)});
}

}  // namespace astrosplat::panel

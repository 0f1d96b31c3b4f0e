// The notice line.
#include "gui/notice.h"

#include <imgui.h>

#include <algorithm>

#include "gui/icons.h"
#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

bool small_button(GuiFrame& frame, const char* label, const char* tooltip) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(10), px(3)));
    const bool clicked = ImGui::Button(label, {0, px(22)});
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tooltip);
    ImGui::PopStyleVar();
    note_item(frame, std::string("notice/") + label);
    return clicked;
}

void draw_disk_notice(GuiFrame& frame, const Rect& area) {
    row_text(frame.document.name() + " changed on disk", area.height, color::attention);
    for (const bool reloads : {true, false}) {
        ImGui::SameLine(0, px(reloads ? 16 : 8));
        ImGui::SetCursorScreenPos({ImGui::GetCursorScreenPos().x, area.y + (area.height - px(22)) * 0.5f});
        const char* label = reloads ? "Reload" : "Keep";
        const char* tooltip = reloads ? "Take what is on disk; undo brings this back"
                                      : "Keep what is here; saving will replace what is on disk now";
        if (small_button(frame, label, tooltip))
            request(frame, reloads ? Command::Kind::reload : Command::Kind::keep);
    }
}

void draw_grey_notice(GuiFrame& frame, const Rect& area) {
    const std::vector<LayerParams>& layers = frame.document.scene().layers;
    const auto layer = std::ranges::find(layers, frame.view.grey_layer, &LayerParams::name);
    row_text(frame.view.grey_layer + " has no picture and is neutral grey", area.height, color::text);
    for (const bool chooses : {true, false}) {
        ImGui::SameLine(0, px(chooses ? 16 : 8));
        ImGui::SetCursorScreenPos({ImGui::GetCursorScreenPos().x, area.y + (area.height - px(22)) * 0.5f});
        const bool clicked =
            chooses ? small_button(frame, "Choose a picture...", "Colours the splats of this mesh")
                    : small_button(frame, "Keep grey", "A picture can be chosen under Source, too");
        if (clicked && chooses && layer != layers.end())
            request(frame, Command::Kind::choose_picture, static_cast<std::size_t>(layer - layers.begin()));
        if (clicked && !chooses) frame.view.grey_layer.clear();
    }
}

void draw_hint(GuiFrame& frame, const Rect& area) {
    row_text("Drop a picture, mesh or splat file here. F1 shows the keys.", area.height, color::text);
    ImGui::SetCursorScreenPos({area.x + area.width - area.height - px(4), area.y});
    if (icon_button("close hint", Icon::cross, {area.height, area.height}, px(10), color::dim, nullptr))
        frame.view.hint_open = false;
    note_item(frame, "close hint");
}

}  // namespace

void draw_notice(GuiFrame& frame, const Rect& area) {
    if (area.height <= 0) return;
    ImGui::SetCursorScreenPos({area.x, area.y});
    ImGui::PushStyleColor(ImGuiCol_ChildBg, color4(color::window));
    ImGui::BeginChild("notice", {area.width, area.height}, false, ImGuiWindowFlags_NoScrollbar);
    ImGui::SetCursorScreenPos({area.x + px(12), area.y});
    if (frame.view.changed_on_disk)
        draw_disk_notice(frame, area);
    else if (!frame.view.grey_layer.empty())
        draw_grey_notice(frame, area);
    else
        draw_hint(frame, area);
    ImGui::EndChild();
    ImGui::PopStyleColor();
}

}  // namespace astrosplat

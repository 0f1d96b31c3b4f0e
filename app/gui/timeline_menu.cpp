// What is done to the selected keyframes at once: their interpolation, the ends of their tracks, removing
// them.
#include "gui/timeline_menu.h"

#include <imgui.h>

#include "edit/keyframes.h"
#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {

void remove_selected(TimelineState& t, GuiFrame& frame) {
    const std::vector<KeyframePlace> places = std::move(t.selected);
    t.selected.clear();
    if (places.empty()) return;
    try_edit([&] {
        frame.document.edit(places.size() == 1 ? "Remove keyframe" : "Remove keyframes", [&](Scene& scene) {
            for (const KeyframePlace& place : places)
                if (has_keyframe_at(scene, place.key, place.frame))
                    remove_keyframe(scene, place.key, place.frame);
        });
    });
}

void draw_keyframe_menu(TimelineState& t, GuiFrame& frame) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(8), px(8)));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(12), px(8)));
    const bool open = ImGui::BeginPopup("keyframe menu");
    ImGui::PopStyleVar(2);
    if (!open) return;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(12), px(8)));
    const auto on_selected = [&](const char* name,
                                 const std::function<void(Scene&, const KeyframePlace&)>& change) {
        const std::vector<KeyframePlace> places = t.selected;
        try_edit([&] {
            frame.document.edit(name, [&](Scene& scene) {
                for (const KeyframePlace& place : places)
                    if (has_keyframe_at(scene, place.key, place.frame)) change(scene, place);
            });
        });
    };
    for (const Interpolation kind : {Interpolation::linear, Interpolation::smooth, Interpolation::step}) {
        const char* label = kind == Interpolation::linear   ? "Linear"
                            : kind == Interpolation::smooth ? "Smooth"
                                                            : "Step";
        if (ImGui::MenuItem(label))
            on_selected("Interpolation", [&](Scene& scene, const KeyframePlace& place) {
                set_interpolation(scene, place.key, place.frame, kind);
            });
        note_item(frame, std::string("keyframe menu/") + label);
    }
    ImGui::Separator();
    const Track* track =
        t.selected.empty() ? nullptr : find_track(frame.document.scene(), t.selected.front().key);
    const bool eased = track && track->ends == Ends::ease;
    if (ImGui::MenuItem("Rest at the ends", nullptr, eased))
        on_selected("Ends", [&](Scene& scene, const KeyframePlace& place) {
            set_ends(scene, place.key, eased ? Ends::through : Ends::ease);
        });
    ImGui::Separator();
    if (ImGui::MenuItem("Delete", "Del")) remove_selected(t, frame);
    note_item(frame, "keyframe menu/Delete");
    if (ImGui::MenuItem("Delete all keyframes of the row"))
        on_selected("Remove animation",
                    [](Scene& scene, const KeyframePlace& place) { remove_track(scene, place.key); });
    close_on_escape();
    ImGui::PopStyleVar();
    ImGui::EndPopup();
}

}  // namespace astrosplat

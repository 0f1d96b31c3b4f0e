// What is done to the selected keyframes at once: their interpolation, the ends of their tracks, removing
// them.
#include "gui/timeline_menu.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <functional>

#include "edit/keyframes.h"
#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

void on_selected(const TimelineState& t, GuiFrame& frame, const char* name,
                 const std::function<void(Scene&, const KeyframePlace&)>& change) {
    const std::vector<KeyframePlace> places = t.selected;
    try_edit([&] {
        frame.document.edit(name, [&](Scene& scene) {
            for (const KeyframePlace& place : places)
                if (has_keyframe_at(scene, place.key, place.frame)) change(scene, place);
        });
    });
}

/// Whether something holds for every selected keyframe: its track and its place in it.
bool all_selected(const TimelineState& t, const GuiFrame& frame,
                  const std::function<bool(const Track&, std::size_t)>& holds) {
    return std::ranges::all_of(t.selected, [&](const KeyframePlace& place) {
        const Track* const track = find_track(frame.document.scene(), place.key);
        if (!track) return false;
        for (std::size_t i = 0; i < track->keyframes.size(); ++i)
            if (track->keyframes[i].frame == place.frame) return holds(*track, i);
        return false;
    });
}

/// Rotations turn evenly, and values that step have no way between.
bool may_be_bezier(const TimelineState& t, const Track& track) {
    const auto spec = t.specs.find(track.key);
    return spec != t.specs.end() && spec->second.type != ParameterType::rotation &&
           spec->second.animation == Animation::yes;
}

void interpolation_items(const TimelineState& t, GuiFrame& frame) {
    constexpr std::array<const char*, 4> labels{"Linear", "Smooth", "Step", "Bezier"};  // by Interpolation
    const bool bezier =
        all_selected(t, frame, [&](const Track& track, std::size_t) { return may_be_bezier(t, track); });
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const auto kind = static_cast<Interpolation>(i);
        const bool set = all_selected(t, frame, [&](const Track& track, std::size_t at) {
            return track.keyframes[at].interpolation == kind;
        });
        if (ImGui::MenuItem(labels[i], nullptr, set, kind != Interpolation::bezier || bezier))
            on_selected(t, frame, "Interpolation", [&](Scene& scene, const KeyframePlace& place) {
                set_interpolation(scene, place.key, place.frame, kind);
            });
        note_item(frame, std::string("keyframe menu/") + labels[i]);
    }
}

/// Of keyframes beside a Bezier segment.
void handle_items(const TimelineState& t, GuiFrame& frame) {
    constexpr std::array<const char*, 3> labels{"Auto handles", "Flat handles", "Free handles"};
    const bool enabled = all_selected(t, frame, [](const Track& track, std::size_t i) {
        return has_handle(track, i, HandleSide::in) || has_handle(track, i, HandleSide::out);
    });
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const auto kind = static_cast<HandleKind>(i);
        const bool set = enabled && all_selected(t, frame, [&](const Track& track, std::size_t at) {
                             const auto& keyframe = track.keyframes[at];
                             const bool in = has_handle(track, at, HandleSide::in);
                             const bool out = has_handle(track, at, HandleSide::out);
                             return (!in || keyframe.in.kind == kind) && (!out || keyframe.out.kind == kind);
                         });
        if (ImGui::MenuItem(labels[i], nullptr, set, enabled))
            on_selected(t, frame, "Handles", [&](Scene& scene, const KeyframePlace& place) {
                set_handle_kind(scene, place.key, place.frame, kind);
            });
        note_item(frame, std::string("keyframe menu/") + labels[i]);
    }
    const bool broken = enabled && all_selected(t, frame, [](const Track& track, std::size_t at) {
                            return track.keyframes[at].broken;
                        });
    if (ImGui::MenuItem("Break handles", nullptr, broken, enabled))
        on_selected(t, frame, "Break handles", [&](Scene& scene, const KeyframePlace& place) {
            set_broken(scene, place.key, place.frame, !broken);
        });
    note_item(frame, "keyframe menu/Break handles");
}

}  // namespace

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
    interpolation_items(t, frame);
    ImGui::Separator();
    handle_items(t, frame);
    ImGui::Separator();
    const Track* track =
        t.selected.empty() ? nullptr : find_track(frame.document.scene(), t.selected.front().key);
    const bool eased = track && track->ends == Ends::ease;
    if (ImGui::MenuItem("Rest at the ends", nullptr, eased))
        on_selected(t, frame, "Ends", [&](Scene& scene, const KeyframePlace& place) {
            set_ends(scene, place.key, eased ? Ends::through : Ends::ease);
        });
    ImGui::Separator();
    if (ImGui::MenuItem("Delete", "Del")) remove_selected(t, frame);
    note_item(frame, "keyframe menu/Delete");
    if (ImGui::MenuItem("Delete all keyframes of the row"))
        on_selected(t, frame, "Remove animation",
                    [](Scene& scene, const KeyframePlace& place) { remove_track(scene, place.key); });
    close_on_escape();
    ImGui::PopStyleVar();
    ImGui::EndPopup();
}

}  // namespace astrosplat

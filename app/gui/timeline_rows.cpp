// The rows of keyframes, their menu and their drags.
#include <fmt/format.h>

#include <cctype>

#include "edit/edits.h"
#include "gui/timeline.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

using Drag = TimelineState::Drag;

// The menu of the selected keyframes: changes of all of them at once.

constexpr const char* menu_name = "keyframe menu";

void on_selected(const TimelineState& t, GuiFrame& frame, const char* name,
                 const std::function<void(Scene&, const KeyframePlace&)>& change) {
    try_edit([&] {
        frame.document.edit(name, [&](Scene& scene) {
            for (const KeyframePlace& place : t.selected) change(scene, place);
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

bool all_may_be_bezier(const TimelineState& t, const GuiFrame& frame) {
    return all_selected(t, frame, [&](const Track& track, std::size_t) { return may_be_bezier(t, track); });
}

void interpolation_items(const TimelineState& t, GuiFrame& frame) {
    constexpr std::array<const char*, 4> labels{"Linear", "Smooth", "Step", "Bezier"};  // by Interpolation
    const bool bezier = all_may_be_bezier(t, frame);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const auto kind = static_cast<Interpolation>(i);
        const bool set = all_selected(t, frame, [&](const Track& track, std::size_t at) {
            return track.keyframes[at].interpolation == kind;
        });
        if (noted_menu_item(frame, menu_name, labels[i], set, kind != Interpolation::bezier || bezier))
            on_selected(t, frame, "Interpolation", [&](Scene& scene, const KeyframePlace& place) {
                set_interpolation(scene, place.key, place.frame, kind);
            });
    }
}

/// Ready-made curves.
void ease_items(const TimelineState& t, GuiFrame& frame) {
    struct Preset {
        const char* label;
        std::vector<HandleSide> sides;
    };
    const bool bezier = all_may_be_bezier(t, frame);
    for (const auto& [label, sides] :
         {Preset{"Ease in and out", {HandleSide::in, HandleSide::out}}, Preset{"Ease in", {HandleSide::in}},
          Preset{"Ease out", {HandleSide::out}}})
        if (noted_menu_item(frame, menu_name, label, false, bezier))
            on_selected(t, frame, label, [&](Scene& scene, const KeyframePlace& place) {
                for (const HandleSide side : sides) ease(scene, place.key, place.frame, side);
            });
}

/// Of keyframes next to a Bezier segment.
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
        if (noted_menu_item(frame, menu_name, labels[i], set, enabled))
            on_selected(t, frame, "Handles", [&](Scene& scene, const KeyframePlace& place) {
                set_handle_kind(scene, place.key, place.frame, kind);
            });
    }
    const bool broken = enabled && all_selected(t, frame, [](const Track& track, std::size_t at) {
                            return track.keyframes[at].broken;
                        });
    if (noted_menu_item(frame, menu_name, "Break handles", broken, enabled))
        on_selected(t, frame, "Break handles", [&](Scene& scene, const KeyframePlace& place) {
            set_broken(scene, place.key, place.frame, !broken);
        });
}

void remove_selected(TimelineState& t, GuiFrame& frame) {
    on_selected(
        t, frame, t.selected.size() == 1 ? "Remove keyframe" : "Remove keyframes",
        [](Scene& scene, const KeyframePlace& place) { remove_keyframe(scene, place.key, place.frame); });
    t.selected.clear();
}

/// The popup "keyframe menu": interpolation, easing, handles, the ends of tracks, removal.
void draw_keyframe_menu(TimelineState& t, GuiFrame& frame) {
    if (!begin_menu_popup(menu_name)) return;
    interpolation_items(t, frame);
    ImGui::Separator();
    ease_items(t, frame);
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
    end_menu_popup();
}

constexpr float track_height = 26, keyframe_reach = 7, track_name_width = 160, value_gutter = 56;

// Diamond: linear; disc: smooth; square: step; hourglass: Bezier.
void draw_keyframe_mark(ImVec2 at, Interpolation interpolation, bool selected) {
    ImDrawList* const list = ImGui::GetWindowDrawList();
    const float half = px(5);
    const auto mark = [&](float size, ImU32 c) {
        if (interpolation == Interpolation::smooth)
            list->AddCircleFilled(at, size * 0.9f, c, 20);
        else if (interpolation == Interpolation::bezier)
            for (const float side : {-1.1f, 1.1f})
                list->AddTriangleFilled({at.x - side * 0.2f, at.y}, {at.x + side * size, at.y - size},
                                        {at.x + side * size, at.y + size}, c);
        else if (interpolation == Interpolation::step)
            fill_square(at, size * 0.8f, c);
        else
            list->AddQuadFilled({at.x, at.y - size * 1.1f}, {at.x + size * 1.1f, at.y},
                                {at.x, at.y + size * 1.1f}, {at.x - size * 1.1f, at.y}, c);
    };
    if (selected) mark(half + px(2.5f), color::text);
    mark(half + px(0.5f), color::line);
    mark(half - px(0.5f), color::attention);
}

std::string value_text(const std::vector<double>& numbers) {
    std::string text;
    for (const double n : numbers) text += (text.empty() ? "" : ", ") + fmt::format("{:.4g}", n);
    return text;
}

std::optional<KeyframePlace> keyframe_under_mouse(const TimelineState& t, const Scene& scene, float rows_y) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const int row = static_cast<int>(std::floor((mouse.y - rows_y) / px(track_height)));
    if (row < 0 || row >= static_cast<int>(scene.animation.size())) return std::nullopt;
    const Track& track = scene.animation[static_cast<std::size_t>(row)];
    float nearest = px(keyframe_reach);
    std::optional<KeyframePlace> found;
    for (const auto& keyframe : track.keyframes) {
        const float distance = std::fabs(t.scale.x_of(keyframe.frame) - mouse.x);
        if (distance > nearest) continue;
        nearest = distance;
        found = KeyframePlace{track.key, keyframe.frame};
    }
    return found;
}

void press_keyframe(TimelineState& t, GuiFrame& frame, const KeyframePlace& place) {
    select_keyframe(t, place);
    frame.view.graph_parameter = place.key;
    t.drag = Drag::keyframes;
    t.edit.begin(frame.document);
    t.picked = t.selected;
    t.grabbed_frame = t.scale.frame_at(ImGui::GetIO().MousePos.x);
    t.moved = 0.0;
}

void drag_keyframes(TimelineState& t, GuiFrame& frame) {
    const double delta = std::round(t.scale.frame_at(ImGui::GetIO().MousePos.x) - t.grabbed_frame);
    if (delta == t.moved) return;
    t.moved = delta;
    const bool copies = ImGui::GetIO().KeyCtrl;
    // The leading keyframe goes first, so that none lands on one that has still to move.
    std::vector<KeyframePlace> order = t.picked;
    std::sort(order.begin(), order.end(), [&](const KeyframePlace& a, const KeyframePlace& b) {
        return delta > 0 ? a.frame > b.frame : a.frame < b.frame;
    });
    try_edit([&] {
        frame.document.edit(
            copies ? "Copy keyframes" : "Move keyframes",
            [&](Scene& scene) {
                scene.animation = t.edit.before().animation;
                if (delta == 0.0) return;
                for (const KeyframePlace& place : order)
                    (copies ? copy_keyframe : move_keyframe)(scene, place.key, place.frame,
                                                             place.frame + delta);
            },
            t.edit.gesture());
    });
    t.selected = t.picked;
    for (KeyframePlace& place : t.selected) place.frame += delta;
}

void select_in_box(TimelineState& t, const Scene& scene, float rows_y) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const ImVec2 low{std::min(t.box_x, mouse.x), std::min(t.box_y, mouse.y)};
    const ImVec2 high{std::max(t.box_x, mouse.x), std::max(t.box_y, mouse.y)};
    t.selected.clear();
    for (std::size_t row = 0; row < scene.animation.size(); ++row) {
        const float y = rows_y + (static_cast<float>(row) + 0.5f) * px(track_height);
        if (y < low.y || y > high.y) continue;
        for (const auto& keyframe : scene.animation[row].keyframes) {
            const float x = t.scale.x_of(keyframe.frame);
            if (x >= low.x && x <= high.x) t.selected.push_back({scene.animation[row].key, keyframe.frame});
        }
    }
    fill_rect(low, high, color::with_opacity(color::accent, 0.12f));
    outline_rect({low, {high.x - low.x, high.y - low.y}}, color::with_opacity(color::accent, 0.6f));
}

/// "dust: Power", "Camera: Position".
std::string track_label(const std::string& key, const ParameterSpec& spec) {
    std::string group = ParameterKey(key).layer();
    if (group.empty() && !key.empty()) {
        group = ParameterKey(key).parts().front();
        group[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(group[0])));
    }
    return group + ": " + (spec.label.empty() ? key : spec.label);
}

void draw_name(TimelineState& t, GuiFrame& frame, const Track& track, float x, float y, float width) {
    ImGui::PushID(track.key.text().c_str());
    ImGui::SetCursorScreenPos({x, y});
    if (ImGui::InvisibleButton("name", {width, px(track_height)})) frame.view.graph_parameter = track.key;
    ImGui::SetItemAllowOverlap();
    note_item(frame, "track " + track.key.text());
    const ImVec2 low{x, y}, high{x + width, y + px(track_height)};
    const bool chosen = frame.view.graph_parameter == track.key;
    if (chosen)
        fill_rect(low, high, color::selection);
    else if (ImGui::IsItemHovered())
        fill_rect(low, high, color::hover);
    const auto spec = t.specs.find(track.key);
    const std::string whole = spec == t.specs.end() ? track.key.text() : track_label(track.key, spec->second);
    const bool has_channels = chosen && frame.view.graph_open && track.keyframes[0].value.size() > 1;
    const float room = has_channels ? channels_width(track) : 0.0f;
    const std::string text = fitting(whole, width - px(20) - room);
    const float text_y = y + std::floor((px(track_height) - ImGui::GetFontSize()) * 0.5f);
    draw_text({x + px(12), text_y}, chosen ? color::text : color::dim, text);
    tooltip((whole + "\n" + track.key.text()).c_str());
    if (has_channels && spec != t.specs.end())
        draw_channels(frame, track, spec->second, x + width - room, y, px(track_height));
    ImGui::PopID();
}

void draw_keyframes(TimelineState& t, GuiFrame& frame, const Track& track, float y) {
    const float middle = std::floor(y + px(track_height) * 0.5f) + 0.5f;
    if (track.keyframes.size() > 1)
        line_across(t.scale.x_of(track.keyframes.front().frame), t.scale.x_of(track.keyframes.back().frame),
                    middle, color::with_opacity(color::attention, 0.35f), px(2));
    for (const auto& keyframe : track.keyframes) {
        const ImVec2 at{t.scale.x_of(keyframe.frame), middle};
        draw_keyframe_mark(at, keyframe.interpolation, is_selected(t, {track.key, keyframe.frame}));
        note_item(frame, fmt::format("keyframe {} {:g}", track.key, keyframe.frame), {at.x, at.y});
    }
}

void handle_rows_mouse(TimelineState& t, GuiFrame& frame, const Rect& area) {
    const Scene& scene = frame.document.scene();
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::InvisibleButton("keyframes", {std::max(area.width, 1.0f), std::max(area.height, 1.0f)},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    const std::optional<KeyframePlace> under =
        hovered ? keyframe_under_mouse(t, scene, area.y) : std::nullopt;
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        if (under) {
            press_keyframe(t, frame, *under);
        } else {
            t.selected.clear();
            t.drag = Drag::box;
            t.box_x = ImGui::GetIO().MousePos.x;
            t.box_y = ImGui::GetIO().MousePos.y;
        }
    }
    if (hovered && under && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        if (!is_selected(t, *under)) t.selected = {*under};
        ImGui::OpenPopup(menu_name);
    }
    if (t.drag == Drag::keyframes) drag_keyframes(t, frame);
    if (t.drag == Drag::box) select_in_box(t, scene, area.y);
    if (under && t.drag == Drag::none) {
        ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
        const Track* track = find_track(scene, under->key);
        for (const auto& keyframe : track->keyframes)
            if (keyframe.frame == under->frame)
                tooltip(fmt::format("Frame {:g}, {}: {}", keyframe.frame, name_of(keyframe.interpolation),
                                    value_text(keyframe.value))
                            .c_str());
    }
}

void draw_playhead_line(const TimelineState& t, const GuiFrame& frame, const Rect& area) {
    const float x = t.scale.x_of(frame.view.frame);
    if (x >= t.scale.x0 - px(timeline_margin) && x <= t.scale.x1 + px(timeline_margin))
        line_down(x, area.y, area.end().y, color::accent);
}

}  // namespace

float names_width(const ViewState& view) {
    return px(track_name_width) + (view.graph_open ? px(value_gutter) : 0.0f);
}

void draw_rows(TimelineState& t, GuiFrame& frame, const Rect& area) {
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::BeginChild("rows", area.size());
    const float names = names_width(frame.view);
    const ImVec2 origin = ImGui::GetCursorScreenPos();  // moves while scrolled
    const std::vector<Track> tracks = frame.document.scene().animation;
    const float height = static_cast<float>(tracks.size()) * px(track_height);
    if (tracks.empty()) {
        ImGui::SetCursorScreenPos({origin.x + px(12), origin.y + px(4)});
        const std::string file = frame.document.scene().camera.file.filename().string();
        const std::string moves =
            file.empty() ? "Nothing moves yet. " : "The camera moves as " + file + " says. ";
        row_text(moves +
                     "The diamond beside a value sets a keyframe at this frame; K sets the "
                     "camera's.",
                 px(track_height), color::dim);
    } else if (frame.view.graph_open) {
        draw_graph(t, frame, {origin.x + names, area.y, area.width - names, area.height});
    } else {
        const Rect keyframes{origin.x + names, origin.y, area.width - names, std::max(height, area.height)};
        handle_rows_mouse(t, frame, keyframes);
    }
    float y = origin.y;
    for (const Track& track : tracks) {
        draw_name(t, frame, track, origin.x, y, px(track_name_width));
        if (!frame.view.graph_open) {
            line_across(origin.x, origin.x + area.width, y + px(track_height) - 0.5f,
                        color::with_opacity(color::line, 0.6f));
            ImGui::PushClipRect({origin.x + names, area.y}, area.end(), true);
            draw_keyframes(t, frame, track, y);
            ImGui::PopClipRect();
        }
        y += px(track_height);
    }
    if (!tracks.empty()) draw_playhead_line(t, frame, area);
    const bool here = ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
    if (here && !ImGui::GetIO().WantTextInput && key_pressed(key_code::del)) remove_selected(t, frame);
    draw_keyframe_menu(t, frame);
    ImGui::EndChild();
}

}  // namespace astrosplat

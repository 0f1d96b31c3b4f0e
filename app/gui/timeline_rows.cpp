// One row for every animated parameter, its keys as diamonds: selected by click or box, moved by dragging,
// copied with Ctrl, removed with Delete, and a menu for the rest.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "edit/keys.h"
#include "gui/icons.h"
#include "gui/key_codes.h"
#include "gui/theme.h"
#include "gui/timeline.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float row_height = 26, key_reach = 7;

// Diamond: linear; disc: smooth; square: step.
void draw_key_mark(ImDrawList* list, ImVec2 at, Interpolation interpolation, bool selected) {
    const float half = px(5);
    const auto mark = [&](float size, ImU32 c) {
        if (interpolation == Interpolation::smooth)
            list->AddCircleFilled(at, size * 0.9f, c, 20);
        else if (interpolation == Interpolation::step)
            list->AddRectFilled({at.x - size * 0.8f, at.y - size * 0.8f},
                                {at.x + size * 0.8f, at.y + size * 0.8f}, c);
        else
            list->AddQuadFilled({at.x, at.y - size * 1.1f}, {at.x + size * 1.1f, at.y},
                                {at.x, at.y + size * 1.1f}, {at.x - size * 1.1f, at.y}, c);
    };
    if (selected) mark(half + px(2.5f), color::text);
    mark(half + px(0.5f), color::line);
    mark(half - px(0.5f), color::key);
}

std::string value_text(const std::vector<double>& numbers) {
    std::string text;
    for (const double n : numbers) text += (text.empty() ? "" : ", ") + fmt::format("{:.4g}", n);
    return text;
}

}  // namespace

bool Timeline::is_selected(const KeyPlace& place) const {
    return std::find(selected_.begin(), selected_.end(), place) != selected_.end();
}

const Timeline::KeyPlace* Timeline::key_under_mouse(const Scene& scene, float rows_y) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const int row = static_cast<int>(std::floor((mouse.y - rows_y) / px(row_height)));
    if (row < 0 || row >= static_cast<int>(scene.animation.size())) return nullptr;
    const Track& track = scene.animation[static_cast<std::size_t>(row)];
    float nearest = px(key_reach);
    bool found = false;
    for (const auto& key : track.keys) {
        const float distance = std::fabs(scale_.x_of(key.frame) - mouse.x);
        if (distance > nearest) continue;
        nearest = distance;
        found_ = {track.key, key.frame};
        found = true;
    }
    return found ? &found_ : nullptr;
}

void Timeline::press_key(GuiFrame& frame, const KeyPlace& place) {
    if (ImGui::GetIO().KeyShift) {
        if (is_selected(place))
            std::erase(selected_, place);
        else
            selected_.push_back(place);
    } else if (!is_selected(place)) {
        selected_ = {place};
    }
    frame.view.graph_key = place.key;
    drag_ = Drag::keys;
    gesture_ = new_gesture();
    before_ = frame.document.scene().animation;
    picked_ = selected_;
    grabbed_frame_ = scale_.frame_at(ImGui::GetIO().MousePos.x);
    moved_ = 0.0;
}

void Timeline::drag_keys(GuiFrame& frame) {
    const double delta = std::round(scale_.frame_at(ImGui::GetIO().MousePos.x) - grabbed_frame_);
    if (delta == moved_) return;
    moved_ = delta;
    const bool copies = ImGui::GetIO().KeyCtrl;
    // The leading key goes first, so that none lands on one that has still to move.
    std::vector<KeyPlace> order = picked_;
    std::sort(order.begin(), order.end(), [&](const KeyPlace& a, const KeyPlace& b) {
        return delta > 0 ? a.frame > b.frame : a.frame < b.frame;
    });
    try_edit([&] {
        frame.document.edit(
            copies ? "Copy keys" : "Move keys",
            [&](Scene& scene) {
                scene.animation = before_;
                if (delta == 0.0) return;
                for (const KeyPlace& place : order)
                    (copies ? copy_key : move_key)(scene, place.key, place.frame, place.frame + delta);
            },
            gesture_);
    });
    selected_ = picked_;
    for (KeyPlace& place : selected_) place.frame += delta;
}

void Timeline::select_in_box(const Scene& scene, float rows_y) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const ImVec2 low{std::min(box_x_, mouse.x), std::min(box_y_, mouse.y)};
    const ImVec2 high{std::max(box_x_, mouse.x), std::max(box_y_, mouse.y)};
    selected_.clear();
    for (std::size_t row = 0; row < scene.animation.size(); ++row) {
        const float y = rows_y + (static_cast<float>(row) + 0.5f) * px(row_height);
        if (y < low.y || y > high.y) continue;
        for (const auto& key : scene.animation[row].keys) {
            const float x = scale_.x_of(key.frame);
            if (x >= low.x && x <= high.x) selected_.push_back({scene.animation[row].key, key.frame});
        }
    }
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(low, high, color::with_opacity(color::accent, 0.12f));
    list->AddRect(low, high, color::with_opacity(color::accent, 0.6f));
}

void Timeline::draw_name(GuiFrame& frame, const Track& track, float x, float y, float width) {
    ImGui::PushID(track.key.text().c_str());
    ImGui::SetCursorScreenPos({x, y});
    if (ImGui::InvisibleButton("name", {width, px(row_height)})) frame.view.graph_key = track.key;
    note_item(frame, "track " + track.key.text());
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 low{x, y}, high{x + width, y + px(row_height)};
    const bool chosen = frame.view.graph_key == track.key;
    if (chosen)
        list->AddRectFilled(low, high, color::selection);
    else if (ImGui::IsItemHovered())
        list->AddRectFilled(low, high, color::hover);
    const auto spec = specs_.find(track.key);
    const std::string whole = spec == specs_.end() ? track.key.text() : track_label(track.key, spec->second);
    const std::string text = fitting(whole, width - px(20));
    const float text_y = y + std::floor((px(row_height) - ImGui::GetFontSize()) * 0.5f);
    list->AddText({x + px(12), text_y}, chosen ? color::text : color::dim, text.c_str());
    tooltip((whole + "\n" + track.key.text()).c_str());
    ImGui::PopID();
}

void Timeline::draw_keys(GuiFrame& frame, const Track& track, float y) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float middle = std::floor(y + px(row_height) * 0.5f) + 0.5f;
    if (track.keys.size() > 1)
        list->AddLine({scale_.x_of(track.keys.front().frame), middle},
                      {scale_.x_of(track.keys.back().frame), middle}, color::with_opacity(color::key, 0.35f),
                      px(2));
    for (const auto& key : track.keys) {
        const ImVec2 at{scale_.x_of(key.frame), middle};
        draw_key_mark(list, at, key.interpolation, is_selected({track.key, key.frame}));
        note_item(frame, fmt::format("key {} {:g}", track.key, key.frame), {at.x, at.y});
    }
}

void Timeline::handle_rows_mouse(GuiFrame& frame, const Rect& keys) {
    const Scene& scene = frame.document.scene();
    ImGui::SetCursorScreenPos({keys.x, keys.y});
    ImGui::InvisibleButton("keys", {std::max(keys.width, 1.0f), std::max(keys.height, 1.0f)},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    const KeyPlace* under = hovered ? key_under_mouse(scene, keys.y) : nullptr;
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        if (under) {
            press_key(frame, *under);
        } else {
            selected_.clear();
            drag_ = Drag::box;
            box_x_ = ImGui::GetIO().MousePos.x;
            box_y_ = ImGui::GetIO().MousePos.y;
        }
    }
    if (hovered && under && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        if (!is_selected(*under)) selected_ = {*under};
        ImGui::OpenPopup("key menu");
    }
    if (drag_ == Drag::keys) drag_keys(frame);
    if (drag_ == Drag::box) select_in_box(scene, keys.y);
    if (under && drag_ == Drag::none) {
        ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
        const Track* track = find_track(scene, under->key);
        for (const auto& key : track->keys)
            if (key.frame == under->frame)
                tooltip(fmt::format("Frame {:g}, {}: {}", key.frame, name_of(key.interpolation),
                                    value_text(key.value))
                            .c_str());
    }
}

void Timeline::draw_rows(GuiFrame& frame, const Rect& area) {
    ImGui::SetCursorScreenPos({area.x, area.y});
    ImGui::BeginChild("rows", {area.width, area.height});
    const float names = names_width(frame.view);
    const ImVec2 origin = ImGui::GetCursorScreenPos();  // moves while scrolled
    const std::vector<Track> tracks = frame.document.scene().animation;
    const float height = static_cast<float>(tracks.size()) * px(row_height);
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (tracks.empty()) {
        ImGui::SetCursorScreenPos({origin.x + px(12), origin.y + px(4)});
        row_text("Nothing moves yet. The diamond beside a value keys it at this frame; K keys the camera.",
                 px(row_height), color::dim);
    } else if (frame.view.graph_open) {
        draw_graph(frame, {origin.x + names, area.y, area.width - names, area.height});
    } else {
        const Rect keys{origin.x + names, origin.y, area.width - names, std::max(height, area.height)};
        handle_rows_mouse(frame, keys);
    }
    float y = origin.y;
    for (const Track& track : tracks) {
        draw_name(frame, track, origin.x, y, px(160));
        if (!frame.view.graph_open) {
            list->AddLine({origin.x, y + px(row_height) - 0.5f},
                          {origin.x + area.width, y + px(row_height) - 0.5f},
                          color::with_opacity(color::line, 0.6f));
            ImGui::PushClipRect({origin.x + names, area.y}, {area.x + area.width, area.y + area.height},
                                true);
            draw_keys(frame, track, y);
            ImGui::PopClipRect();
        }
        y += px(row_height);
    }
    if (!tracks.empty()) draw_playhead_line(frame, area);
    const bool here = ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
    if (here && !ImGui::GetIO().WantTextInput && ImGui::IsKeyPressed(key_code::del, false))
        remove_selected(frame);
    draw_key_menu(frame);
    ImGui::EndChild();
}

}  // namespace astrosplat

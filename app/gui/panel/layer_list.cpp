// One row of 28 px a layer, a second one while it has something to say. Layers that are merged by depth hang
// on one bracket; the others stand on their own, and only for them the order matters.
#include "gui/panel/parts.h"

#include <fmt/format.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <set>

#include "core/color.h"
#include "edit/layer_steps.h"
#include "edit/layers.h"

namespace astrosplat::panel {
namespace {

constexpr float line_height = 28.0f;
constexpr float margin = 12.0f;  // left and right of a row

bool wants_second_line(const LayerStatus& status) {
    return status.loading || status.stale || !status.error.empty();
}

// Lines come and go only while no button is held: what is dragged stays under the mouse.
void choose_second_lines(const Context& context) {
    if (ImGui::IsAnyMouseDown()) return;
    std::set<std::string>& names = context.memory.second_lines;
    names.clear();
    for (std::size_t i = 0; i < context.scene().layers.size(); ++i)
        if (wants_second_line(context.layer_status(i))) names.insert(context.scene().layers[i].name);
}

bool has_second_line(const Context& context, std::size_t i) {
    return context.memory.second_lines.count(context.scene().layers[i].name) > 0;
}

/// Of the row of layer i, px.
float height_of(const Context& context, std::size_t i) {
    return px(has_second_line(context, i) ? line_height + row_height + 4.0f : line_height);
}

bool merged(const LayerParams& layer) {
    return !layer.render.isolate && layer.render.blend != Blend::lighten;
}

ParameterKey key_of(const Context& context, std::size_t i, const char* name) {
    return layer_key(context.scene().layers[i].name) / name;
}

ImU32 chip_color(const Context& context, std::size_t i) {
    const glm::vec3 own = context.layer_status(i).color.value_or(glm::vec3(1.0f));
    const glm::vec3 tinted = own * context.scene().layers[i].look.grade.tint;
    const float largest = std::max({tinted.x, tinted.y, tinted.z, 1e-6f});
    const auto byte = [&](float c) {
        return static_cast<int>(255.0 * real::linear_to_srgb(double(c / largest)) + 0.5);
    };
    return IM_COL32(byte(tinted.x), byte(tinted.y), byte(tinted.z), 255);
}

void switch_ground(ImVec2 corner, const SwitchColors& colors) {
    const float inset = px(1), height = px(20), top = corner.y + (px(line_height) - height) * 0.5f;
    fill_rect(Rect{corner.x + inset, top, px(20) - 2.0f * inset, height}, colors.ground, px(3));
}

// A letter that is a switch; quiet while off.
bool letter(const char* id, const char* text, ImVec2 corner, bool on, const char* says) {
    const ImVec2 size{px(20), px(line_height)};
    ImGui::SetCursorScreenPos(corner);
    const bool clicked = ImGui::InvisibleButton(id, size);
    const SwitchColors colors = switch_colors(on, ImGui::IsItemHovered());
    tooltip(says);
    switch_ground(corner, colors);
    ImGui::PushFont(medium_font());
    const ImVec2 extent = ImGui::CalcTextSize(text);
    draw_text({corner.x + (size.x - extent.x) * 0.5f, corner.y + (size.y - extent.y) * 0.5f}, colors.ink,
              text);
    ImGui::PopFont();
    return clicked;
}

void toggle(Context& context, std::size_t i, const char* name, bool on) {
    set_value(context, key_of(context, i, name), !on);
}

void switches(Context& context, std::size_t i, const Rect& row) {
    const LayerParams& layer = context.scene().layers[i];
    float x = row.end().x - px(margin) - px(20) + px(6);
    if (letter("isolate", "I", {x, row.y}, layer.render.isolate,
               "Isolate: rendered alone, then composited as a whole"))
        toggle(context, i, "render.isolate", layer.render.isolate);
    x -= px(20);
    ImGui::SetCursorScreenPos({x, row.y});
    const SwitchColors colors = switch_colors(layer.render.holdout, false);
    switch_ground({x, row.y}, colors);
    if (icon_button("holdout", layer.render.holdout ? Icon::ring_cut : Icon::ring, {px(20), px(line_height)},
                    px(11), colors.ink, "Holdout: hides what lies behind, shows nothing itself"))
        toggle(context, i, "render.holdout", layer.render.holdout);
    x -= px(20);
    const bool solo = context.view.solo.count(layer.name) > 0;
    if (letter("solo", "S", {x, row.y}, solo, "Solo: only layers with S are shown"))
        toggle_solo(context.view, layer.name);
}

void finish_renaming(Context& context, std::size_t i, bool take, const std::string& name) {
    context.memory.renaming.clear();
    if (!take || name == context.scene().layers[i].name) return;
    edit(context, key_of(context, i, "name"), "Rename layer",
         [&](Scene& scene) { rename_layer(scene, i, name); });
    if (context.memory.error.empty() && context.view.solo.erase(context.scene().layers[i].name) > 0)
        context.view.solo.insert(name);
}

void name_entry(Context& context, std::size_t i, const Rect& area) {
    Touch& touch = context.memory.touch;
    if (touch.entry_frames < 0) {
        ++touch.entry_frames;
        return;
    }
    ImGui::SetCursorScreenPos({area.x - px(4), area.y + px(2)});
    ImGui::SetNextItemWidth(area.width);
    if (touch.entry_frames == 0) ImGui::SetKeyboardFocusHere();
    ImGui::InputText("##name", &touch.text, ImGuiInputTextFlags_AutoSelectAll);
    ++touch.entry_frames;
    const bool done = ImGui::IsItemDeactivated();
    const bool lost = !done && touch.entry_frames > 4 && !ImGui::IsItemActive();
    const bool dropped = key_pressed(key_code::escape, true);
    if (done || lost) finish_renaming(context, i, !dropped && !lost, touch.text);
}

void begin_renaming(Context& context, std::size_t i) {
    ImGui::ClearActiveID();
    context.memory.renaming = context.scene().layers[i].name;
    context.memory.touch.text = context.memory.renaming;
    // Not in this frame: the click that asked for it, or its menu, still takes the focus.
    context.memory.touch.entry_frames = -2;
}

void layer_menu(Context& context, std::size_t i) {
    if (!begin_popup("layer")) return;
    if (ImGui::MenuItem("Rename")) begin_renaming(context, i);
    if (ImGui::MenuItem("Duplicate"))
        attempt(context, "", [&] { duplicate_layer(context.document, context.view, i); });
    if (ImGui::MenuItem("Delete"))
        attempt(context, "", [&] { remove_layer(context.document, context.view, i); });
    ImGui::Separator();
    if (ImGui::MenuItem("Frame", "Shift+F")) request(context, Command::Kind::frame_layer, i);
    if (ImGui::MenuItem("Regenerate")) request(context, Command::Kind::regenerate, i);
    ImGui::Separator();
    look_menu(context);
    end_menu_popup();
}

// Layer into whose place the mouse would drop: rows may be 28 or 56 px high.
int row_under(const std::vector<Rect>& rows, float y) {
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (y < rows[i].end().y) return static_cast<int>(i);
    return static_cast<int>(rows.size()) - 1;
}

void reorder(Context& context, const std::vector<Rect>& rows) {
    Memory& memory = context.memory;
    if (memory.dragged_layer < 0 || memory.dragged_layer >= static_cast<int>(rows.size())) return;
    const int to = row_under(rows, ImGui::GetIO().MousePos.y);
    const auto place = static_cast<std::size_t>(to);
    const float y = to > memory.dragged_layer ? rows[place].end().y : rows[place].y;
    line_across(rows[place].x + px(margin), rows[place].end().x - px(margin), y, color::accent, px(2));
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) return;
    const auto from = static_cast<std::size_t>(memory.dragged_layer);
    memory.dragged_layer = -1;
    if (from == place) return;
    attempt(context, "", [&] { move_layer(context.document, context.view, from, place); });
}

// Selecting, dragging, renaming and the menu: all of the row that is not a switch.
void row_body(Context& context, std::size_t i, const Rect& row) {
    if (context.memory.renaming == context.scene().layers[i].name) return;
    ImGui::SetCursorScreenPos({row.x + px(38), row.y});
    ImGui::InvisibleButton("row", {row.width - px(38 + 72), px(line_height)});
    const bool hovered = ImGui::IsItemHovered();
    if (ImGui::IsItemActivated()) context.view.layer = i;
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) begin_renaming(context, i);
    if (ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, px(5)) &&
        context.scene().layers.size() > 1)
        context.memory.dragged_layer = static_cast<int>(i);
    if (hovered && ImGui::IsMouseReleased(ImGuiMouseButton_Right)) {
        context.view.layer = i;
        ImGui::OpenPopup("layer");
    }
    if (hovered && context.view.layer != i) fill_rect(row, IM_COL32(255, 255, 255, 8));
    layer_menu(context, i);
}

void count_text(const Context& context, std::size_t i, const Rect& row, float& right) {
    const LayerStatus& status = context.layer_status(i);
    if (status.splats == 0 && !status.loading) return;
    const std::string text = short_count(status.loading ? status.found : status.splats);
    ImGui::PushFont(small_font());
    right -= ImGui::CalcTextSize(text.c_str()).x;
    draw_text({right, row.y + (px(line_height) - ImGui::GetFontSize()) * 0.5f}, color::dim, text);
    ImGui::PopFont();
}

void second_line(Context& context, std::size_t i, const Rect& row) {
    const LayerStatus& status = context.layer_status(i);
    const Rect line{row.x + px(42), row.y + px(line_height), row.width - px(42 + margin), px(row_height)};
    ImGui::SetCursorScreenPos(line.corner());
    if (!status.error.empty()) {
        clipped_text(line, 0.0f, color::error, status.error);
        ImGui::Dummy(line.size());
        tooltip(status.error.c_str());
    } else {
        load_line(context, i, line.width, fmt::format("{} %", static_cast<int>(status.progress * 100.0f)),
                  "Needs regeneration");
    }
}

void draw_layer(Context& context, std::size_t i, const Rect& row) {
    const LayerParams& layer = context.scene().layers[i];
    if (context.view.layer == i) fill_rect(row, color::selection);
    row_body(context, i, row);
    ImGui::SetCursorScreenPos({row.x + px(margin), row.y});
    const bool shown = context.view.solo.empty() ? layer.visible : context.view.solo.count(layer.name) > 0;
    if (icon_button("eye", layer.visible ? Icon::eye : Icon::eye_closed, {px(24), px(line_height)}, px(14),
                    shown ? color::text : color::dim, nullptr))
        attempt(context, key_of(context, i, "visible"),
                [&] { toggle_visible(context.document, context.view, i); });
    const float chip = px(10), middle = row.y + px(line_height) * 0.5f;
    const ImVec2 at{row.x + px(42), middle - chip * 0.5f};
    fill_rect(at, {at.x + chip, at.y + chip}, chip_color(context, i), px(2));
    float right = row.end().x - px(76);
    count_text(context, i, row, right);
    const Rect name{{row.x + px(60), row.y}, {right - row.x - px(64), px(line_height)}};
    if (context.memory.renaming == layer.name)
        name_entry(context, i, name);
    else
        clipped_text(name, 0.0f, shown ? color::text : color::dim, layer.name);
    switches(context, i, row);
    if (has_second_line(context, i) && wants_second_line(context.layer_status(i)))
        second_line(context, i, row);
}

// The bracket reaches from the first merged layer to the last; isolated ones between have no tick.
void draw_merge_bracket(const Context& context, const std::vector<Rect>& rows) {
    std::vector<float> ticks;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (merged(context.scene().layers[i])) ticks.push_back(rows[i].y + px(line_height) * 0.5f);
    if (ticks.size() < 2) return;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float x = rows.front().x + px(6);
    const ImU32 ink = color::with_opacity(color::dim, 0.7f);
    draw_bracket(list, x, ticks.front(), ticks.back(), ink);
    for (const float y : ticks) line_across(x, x + px(4), y, ink, px(1));
    const Rect zone{{x - px(6), ticks.front()}, {px(12), ticks.back() - ticks.front()}};
    if (ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(zone.corner(), zone.end()))
        ImGui::SetTooltip("Merged by depth: the order of these does not matter");
}

// A layer that was selected in the view comes into sight.
void scroll_to_selected(Context& context, const std::vector<Rect>& rows) {
    Memory& memory = context.memory;
    if (memory.layer_in_sight == context.view.layer || context.view.layer >= rows.size()) return;
    memory.layer_in_sight = context.view.layer;
    const Rect& row = rows[context.view.layer];
    const float top = ImGui::GetWindowPos().y;
    if (row.y < top || row.end().y > top + ImGui::GetWindowHeight()) ImGui::SetScrollFromPosY(row.y - top);
}

}  // namespace

SwitchColors switch_colors(bool on, bool hovered) {
    if (on) return {color::accent, color::window};
    return {hovered ? color::text : color::dim, color::none};
}

void load_line(Context& context, std::size_t i, float width, const std::string& loading,
               const std::string& stale) {
    const LayerStatus& status = context.layer_status(i);
    const bool clicked = status.loading
                             ? progress_line(width, std::max(status.progress, 0.001f), loading, "Cancel")
                             : progress_line(width, 0.0f, stale, "Regenerate");
    if (clicked) request(context, status.loading ? Command::Kind::cancel_load : Command::Kind::regenerate, i);
}

void add_layer_button(Context& context) {
    if (icon_button("add", Icon::plus, {px(26), px(24)}, px(11), color::text,
                    "Add a picture, mesh or splat file, or a shape"))
        ImGui::OpenPopup("add layer");
    if (!begin_popup("add layer")) return;
    if (ImGui::MenuItem("File...")) request(context, Command::Kind::import_file);
    ImGui::Separator();
    for (std::size_t i = 0; i < shape_names.size(); ++i)
        if (ImGui::MenuItem(shape_labels[i])) request_text(context, Command::Kind::add_shape, shape_names[i]);
    end_menu_popup();
}

float layer_list_height(const Context& context) {
    choose_second_lines(context);
    float height = 0.0f;
    for (std::size_t i = 0; i < context.scene().layers.size(); ++i) height += height_of(context, i);
    return height + px(context.scene().layers.empty() ? 28.0f : 6.0f);
}

void layer_list(Context& context, float height) {
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::BeginChild("layers", {width, height}, false,
                      ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NavFlattened);
    ImVec2 at = ImGui::GetCursorScreenPos();
    std::vector<Rect> rows;
    if (context.scene().layers.empty()) {
        ImGui::SetCursorScreenPos({at.x + px(margin), at.y});
        note("Drop a picture, mesh or splat file here.");
    }
    for (std::size_t i = 0; i < context.scene().layers.size(); ++i) {
        rows.push_back({at, {width, height_of(context, i)}});
        at.y = rows.back().end().y;
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        ImGui::PushID(context.scene().layers[i].name.c_str());
        draw_layer(context, i, rows[i]);
        ImGui::PopID();
    }
    scroll_to_selected(context, rows);
    if (!rows.empty()) draw_merge_bracket(context, rows);
    reorder(context, rows);
    ImGui::SetCursorScreenPos(at);
    ImGui::Dummy({1.0f, px(2)});
    ImGui::EndChild();
}

}  // namespace astrosplat::panel

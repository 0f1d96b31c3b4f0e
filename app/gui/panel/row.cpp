// The surroundings of a value: where things lie, label with tick, diamond, tooltip, menu, message.
#include <cmath>

#include "edit/keyframes.h"
#include "gui/icons.h"
#include "gui/panel/controls.h"
#include "gui/panel/panel.h"
#include "gui/panel/parts.h"
#include "gui/panel/words.h"
#include "gui/widgets.h"
#include "scene/load.h"

namespace astrosplat::panel {
namespace {

constexpr double tooltip_delay_s = 0.45;

bool mouse_over(const Rect& area) {
    return ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(area.corner(), area.end());
}

void draw_label(Context& context, const Row& row) {
    const ParameterSpec& spec = row.parameter.spec;
    const bool by_command = context.document.set_by_command_line(spec.key);
    if (by_command || !(row.value == default_of(context, spec))) {
        const ImVec2 corner{row.layout.label.x - px(6), row.layout.label.y + px(5)};
        fill_rect(corner, {corner.x + px(2), corner.y + px(14)},
                  by_command ? color::attention : color::accent);
    }
    clipped_text(row.layout.label, 0.0f, color::text, spec.row_label);
}

void show_tooltip(Context& context, const Row& row) {
    Memory& memory = context.memory;
    if (!mouse_over(row.layout.whole) || ImGui::IsAnyItemActive()) {
        if (memory.hovered == row.key()) memory.hovered = {};
        return;
    }
    if (memory.hovered != row.key()) {
        memory.hovered = row.key();
        memory.hovered_since = ImGui::GetTime();
    }
    if (ImGui::GetTime() - memory.hovered_since < tooltip_delay_s) return;
    std::string text = tooltip_text(row.parameter.spec, default_of(context, row.parameter.spec));
    if (context.document.set_by_command_line(row.key())) text += "\nSet by --set";
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(px(320));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void toggle_keyframe(Context& context, const Row& row) {
    const ParameterKey& key = row.key();
    const double frame = std::round(context.view.frame);
    const Value value = row.value;
    if (has_keyframe_at(context.document.scene(), key, frame))
        edit(context, key, "Remove keyframe of " + row.parameter.spec.label,
             [&](Scene& scene) { remove_keyframe(scene, key, frame); });
    else
        edit(context, key, "Set keyframe of " + row.parameter.spec.label,
             [&](Scene& scene) { set_keyframe(scene, key, frame, value); });
}

void animation_menu(Context& context, const Row& row) {
    if (row.parameter.spec.animation == Animation::no) return;
    const ParameterKey& key = row.key();
    const Scene& scene = context.document.scene();
    const bool here = has_keyframe_at(scene, key, std::round(context.view.frame));
    if (ImGui::MenuItem(here ? "Remove keyframe" : "Set keyframe")) toggle_keyframe(context, row);
    const bool animated = is_animated(scene, key);
    if (ImGui::MenuItem("Remove animation", nullptr, false, animated))
        edit(context, key, "Remove animation of " + row.parameter.spec.label,
             [&](Scene& changed) { remove_track(changed, key); });
    if (ImGui::MenuItem("Show in graph", nullptr, false, animated)) {
        context.view.timeline_open = context.view.graph_open = true;
        context.view.graph_parameter = key;
    }
    ImGui::Separator();
}

std::string without_shell_quotes(const std::string& text) {
    if (text.size() < 2 || text.front() != '\'' || text.back() != '\'') return text;
    std::string plain = text.substr(1, text.size() - 2);
    for (std::size_t at = 0; (at = plain.find("'\\''", at)) != std::string::npos; ++at)
        plain.replace(at, 4, "'");
    return plain;
}

/// The value of "key=value" or "--set key=value", or the value alone. A text may have a = of its own: only a
/// key of the scene, or of a row like this one in another, is taken off.
std::string pasted_value(const Context& context, const Row& row, std::string text) {
    constexpr std::string_view option = "--set ";
    if (text.starts_with(option)) text = without_shell_quotes(text.substr(option.size()));
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) return text;
    const ParameterKey head = text.substr(0, equals);
    const bool is_key = find(context, head) || head.generic() == row.parameter.spec.generic_key;
    return is_key ? text.substr(equals + 1) : text;
}

void paste(Context& context, const Row& row) {
    const char* const text = ImGui::GetClipboardText();
    if (!text || !*text) return;
    const std::string raw = pasted_value(context, row, text);
    const bool quoted = raw.size() >= 2 && raw.front() == '"' && raw.back() == '"';  // TOML, as it was copied
    set_value(context, row.key(), quoted ? typed_value(raw) : value_from_text(raw, row.parameter.spec));
}

void row_menu(Context& context, const Row& row) {
    if (mouse_over(row.layout.whole) && ImGui::IsMouseReleased(ImGuiMouseButton_Right))
        ImGui::OpenPopup("menu");
    if (!begin_popup("menu")) return;
    if (ImGui::MenuItem("Reset")) attempt(context, row.key(), [&] { context.document.reset(row.key()); });
    ImGui::Separator();
    animation_menu(context, row);
    const std::string set = set_option(row.key(), row.value);
    if (ImGui::MenuItem("Copy value")) ImGui::SetClipboardText(to_toml(row.value).c_str());
    if (ImGui::MenuItem("Copy key path")) ImGui::SetClipboardText(row.key().text().c_str());
    if (ImGui::MenuItem("Copy --set")) ImGui::SetClipboardText(set.c_str());
    if (ImGui::MenuItem("Paste")) paste(context, row);
    end_menu_popup();
}

void message_row(Context& context, const Row& row) {
    Memory& memory = context.memory;
    if (memory.error.empty() || memory.error_key != row.key()) return;
    memory.error_shown = true;
    note(memory.error, color::error);
}

/// The next row's, at the cursor.
RowLayout next_row() {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = px(row_height);
    const float label = std::floor(width * 0.38f), diamond = px(22);
    RowLayout layout;
    layout.whole = {corner, {width, height}};
    layout.label = {corner, {label - px(4), height}};
    layout.value = {{corner.x + label, corner.y}, {width - label - diamond, height}};
    layout.diamond = {corner.x + width - diamond * 0.5f + px(3), corner.y + height * 0.5f};
    return layout;
}

void note_row(Context& context, const Row& row) {
    const auto point = [](ImVec2 p) { return glm::vec2(p.x, p.y); };
    DrawnRow drawn{row.key(), point(row.layout.label.middle()), point(row.layout.value.middle())};
    if (row.parameter.spec.animation != Animation::no) drawn.diamond = point(row.layout.diamond);
    context.memory.rows.push_back(drawn);
}

void draw_diamond(Context& context, const Row& row) {
    if (row.parameter.spec.animation == Animation::no) return;
    const float size = px(18);
    const ImVec2 middle = row.layout.diamond;
    ImGui::SetCursorScreenPos({middle.x - size * 0.5f, middle.y - size * 0.5f});
    if (ImGui::InvisibleButton("diamond", {size, size})) toggle_keyframe(context, row);
    const Scene& scene = context.document.scene();
    const bool animated = is_animated(scene, row.key());
    const bool here = animated && has_keyframe_at(scene, row.key(), std::round(context.view.frame));
    const ImU32 quiet = ImGui::IsItemHovered() ? color::text : color::with_opacity(color::dim, 0.55f);
    draw_icon(ImGui::GetWindowDrawList(), here ? Icon::diamond : Icon::diamond_empty, middle, px(9),
              animated ? color::attention : quiet);
}

}  // namespace

void parameter_row(Context& context, const Parameter& parameter) {
    const Row row{parameter, parameter.get(), next_row()};
    note_row(context, row);
    ImGui::PushID(row.key().text().c_str());
    draw_label(context, row);
    draw_diamond(context, row);
    if (!value_field(context, row)) {
        ImGui::SetCursorScreenPos(row.layout.whole.corner());
        ImGui::Dummy({row.layout.whole.width, px(row_height)});
    }
    show_tooltip(context, row);
    row_menu(context, row);
    ImGui::PopID();
    message_row(context, row);
}

}  // namespace astrosplat::panel

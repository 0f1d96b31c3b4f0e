// Ctrl+K: one field over all actions and parameters.
#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "core/text.h"
#include "gui/panel/panel.h"
#include "gui/parts.h"

namespace astrosplat {
namespace {

constexpr std::size_t most_found = 12;
constexpr float found_height = 26;

struct Found {
    std::string label, detail;  // the shortcut, or the key path
    const Action* action = nullptr;
    ParameterKey parameter;
};

bool has_all_words(const std::string& text, const std::string& typed) {
    const std::string low = lower_case(text), words = lower_case(typed);
    for (std::size_t at = 0; at < words.size();) {
        const std::size_t end = std::min(words.find(' ', at), words.size());
        if (low.find(words.substr(at, end - at)) == std::string::npos) return false;
        at = end + 1;
    }
    return true;
}

std::vector<Found> find_all(const GuiFrame& frame, const Panel& panel, const std::string& typed) {
    std::vector<Found> found;
    for (const Action& action : actions()) {
        if (action.enabled && !action.enabled(frame)) continue;
        const std::string label = action.label_now ? action.label_now(frame) : action.label;
        const std::string whole = *action.menu ? fmt::format("{}: {}", action.menu, label) : label;
        if (has_all_words(whole, typed))
            found.push_back({whole, shortcut_text(action.shortcut), &action, {}});
    }
    for (const Parameter* parameter : panel.shown_parameters(frame)) {
        const ParameterSpec& spec = parameter->spec;
        const std::string whole = fmt::format("{}: {}, {}", spec.tab, spec.section, spec.label);
        const std::string key = spec.key.text();
        if (has_all_words(whole + " " + key, typed)) found.push_back({whole, key, nullptr, spec.key});
    }
    return found;
}

/// True when it was clicked.
bool found_row(GuiFrame& frame, const Found& row, bool chosen) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const Rect area{at, {ImGui::GetContentRegionAvail().x, px(found_height)}};
    const bool clicked = ImGui::InvisibleButton((row.label + row.detail).c_str(), area.size());
    note_item(frame, "find/" + (row.action ? row.action->label : row.detail));
    if (chosen || ImGui::IsItemHovered()) fill_rect(area, chosen ? color::selection : color::hover, px(3));
    const float y = area.y + std::floor((area.height - ImGui::GetFontSize()) * 0.5f);
    const float room = area.width - px(28), detail = ImGui::CalcTextSize(row.detail.c_str()).x;
    const std::string label = fitting(row.label, std::max(room - detail, 0.6f * room));
    draw_text({area.x + px(8), y}, color::text, label);
    const std::string shown = fitting(row.detail, room - ImGui::CalcTextSize(label.c_str()).x);
    draw_text({area.end().x - px(8) - ImGui::CalcTextSize(shown.c_str()).x, y}, color::dim, shown);
    return clicked;
}

}  // namespace

void Finder::draw(GuiFrame& frame, Panel& panel) {
    bool& open = frame.view.find_open;
    if (!begin_dialog("find", "Find a command or a value", open, 620, 460)) return;
    if (ImGui::IsWindowAppearing()) {
        typed_.clear();
        chosen_ = 0;
        ImGui::SetKeyboardFocusHere();
    }
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::InputTextWithHint("##find", "Words of its name", &typed_)) chosen_ = 0;
    note_item(frame, "find/text");
    std::vector<Found> found = find_all(frame, panel, typed_);
    const std::size_t left_out = found.size() - std::min(found.size(), most_found);
    found.resize(found.size() - left_out);
    const std::size_t last = found.empty() ? 0 : found.size() - 1;
    if (key_pressed(key_code::down, true)) ++chosen_;
    if (key_pressed(key_code::up, true) && chosen_ > 0) --chosen_;
    chosen_ = std::min(chosen_, last);
    std::optional<std::size_t> taken;
    for (std::size_t i = 0; i < found.size(); ++i)
        if (found_row(frame, found[i], i == chosen_)) taken = i;
    const bool enter = key_pressed(key_code::enter) || key_pressed(key_code::pad_enter);
    if (enter && !found.empty()) taken = chosen_;
    if (found.empty() || left_out > 0)
        dialog_note(found.empty() ? "Nothing has these words." : fmt::format("{} more", left_out).c_str(), 0);
    open = !taken && !dialog_escape();
    end_dialog(!open);
    if (!taken) return;
    if (const Action* action = found[*taken].action)
        action->run(frame);
    else
        panel.show(found[*taken].parameter, frame.view);
}

}  // namespace astrosplat

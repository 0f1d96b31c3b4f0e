// A check, a list to open, small switches side by side.
#include "gui/panel/choice_fields.h"

#include "gui/icons.h"
#include "gui/panel/words.h"
#include "gui/theme.h"
#include "scene/describer.h"

namespace astrosplat::panel {

void boolean_field(Context& context, const Row& row) {
    const bool* on = std::get_if<bool>(&row.value.data);
    const float size = px(16);
    const Area& area = row.layout.value;
    const Area box{{area.corner.x, area.middle().y - size * 0.5f}, {size, size}};
    ImGui::SetCursorScreenPos(area.corner);
    const bool clicked = ImGui::InvisibleButton("check", area.size);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 back = *on ? color::accent : ImGui::IsItemHovered() ? color::hover : color::field;
    list->AddRectFilled(box.corner, box.end(), back, px(3));
    if (*on) {
        const ImVec2 m = box.middle();
        const ImVec2 points[3] = {{m.x - px(4), m.y}, {m.x - px(1), m.y + px(3)}, {m.x + px(4), m.y - px(3)}};
        list->AddPolyline(points, 3, color::window, ImDrawFlags_None, px(1.8f));
    }
    if (clicked) set_value(context, row.key(), !*on);
}

namespace {

struct Choice {
    std::string label;
    Value value;
};

void list_field(Context& context, const Row& row, const std::string& shown,
                const std::vector<Choice>& choices) {
    const Area& area = row.layout.value;
    ImGui::SetCursorScreenPos(area.corner);
    ImGui::SetNextItemWidth(area.size.x);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(px(8), (area.size.y - ImGui::GetFontSize()) * 0.5f));
    const bool open = ImGui::BeginCombo("##choice", shown.c_str(),
                                        ImGuiComboFlags_NoArrowButton | ImGuiComboFlags_HeightLargest);
    if (!open)
        draw_icon(ImGui::GetWindowDrawList(), Icon::chevron_down, {area.end().x - px(12), area.middle().y},
                  px(8), color::dim);
    if (open) {
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(8), px(6)));
        for (const auto& [label, value] : choices) {
            const bool selected = row.value == value;
            if (ImGui::Selectable(label.c_str(), selected) && !selected) set_value(context, row.key(), value);
        }
        ImGui::PopStyleVar();
        ImGui::EndCombo();
    }
    ImGui::PopStyleVar();
}

}  // namespace

void choice_field(Context& context, const Row& row) {
    const ParameterSpec& spec = row.parameter.spec;
    std::vector<Choice> choices;
    for (const std::string& choice : spec.choices)
        choices.push_back({choice_label(choice), choice_value(choice)});
    list_field(context, row, in_words(spec, row.value), choices);
}

void name_field(Context& context, const Row& row, const std::vector<std::string>& names,
                const std::string& empty) {
    const std::string* text = row.value.text();
    const bool set = text && !text->empty();
    std::vector<Choice> choices{{set ? "Not chosen" : empty, ""}};
    for (const std::string& name : names) choices.push_back({name, name});
    list_field(context, row, set ? *text : empty, choices);
}

// Words of a list as small switches, in as many lines as they need.
bool words_field(Context& context, const Row& row) {
    const Area& area = row.layout.value;
    const Value::List& words = *row.value.list();
    ImVec2 at = area.corner;
    ImDrawList* list = ImGui::GetWindowDrawList();
    for (const std::string& choice : row.parameter.spec.choices) {
        const std::string label = choice_label(choice);
        const float width = ImGui::CalcTextSize(label.c_str()).x + px(14);
        if (at.x > area.corner.x && at.x + width > area.end().x)
            at = {area.corner.x, at.y + px(row_height + row_space)};
        const Area chip{at, {width, area.size.y}};
        ImGui::SetCursorScreenPos(at);
        const bool clicked = ImGui::InvisibleButton(choice.c_str(), chip.size);
        Value::List others;
        for (const Value& word : words)
            if (!(word == Value(choice))) others.push_back(word);
        const bool on = others.size() < words.size();
        list->AddRectFilled(chip.corner, chip.end(), on ? color::selection : color::field, px(3));
        clipped_text(list, chip, px(7), on ? color::text : color::dim, label);
        if (clicked) {
            if (!on) others.emplace_back(choice);
            set_value(context, row.key(), others);
        }
        at.x += width + px(3);
    }
    ImGui::SetCursorScreenPos(row.layout.whole.corner);
    ImGui::Dummy({row.layout.whole.size.x, at.y - area.corner.y + px(row_height)});
    return true;
}

}  // namespace astrosplat::panel

// A parameter's row: its value, one function per kind, and what is around it: label with tick, diamond,
// tooltip, menu, message.

#include "core/color.h"
#include "edit/edits.h"
#include "gui/panel/parts.h"
#include "scene/describer.h"
#include "scene/load.h"

namespace astrosplat::panel {
namespace {

// Values that are chosen: yes or no, one of several words, some of several words.

void boolean_field(Context& context, const Row& row) {
    const bool* on = std::get_if<bool>(&row.value.data);
    const float size = px(16);
    const Rect& area = row.layout.value;
    const Rect box{{area.x, area.middle().y - size * 0.5f}, {size, size}};
    ImGui::SetCursorScreenPos(area.corner());
    const bool clicked = ImGui::InvisibleButton("check", area.size());
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 back = *on ? color::accent : ImGui::IsItemHovered() ? color::hover : color::field;
    fill_rect(box, back, px(3));
    if (*on) {
        const ImVec2 m = box.middle();
        const ImVec2 points[3] = {
            {m.x - px(3.8f), m.y + px(0.1f)}, {m.x - px(1), m.y + px(3)}, {m.x + px(3.8f), m.y - px(2.8f)}};
        list->AddPolyline(points, 3, color::window, ImDrawFlags_None, px(1.8f));
    }
    if (clicked) set_value(context, row.key(), !*on);
}

struct Choice {
    std::string label;
    Value value;
};

void list_field(Context& context, const Row& row, const std::string& shown,
                const std::vector<Choice>& choices) {
    const Rect& area = row.layout.value;
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::SetNextItemWidth(area.width);
    push_field_height(area.height);
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
        close_on_escape();
        ImGui::PopStyleVar();
        ImGui::EndCombo();
    }
    ImGui::PopStyleVar();
}

void choice_field(Context& context, const Row& row) {
    const ParameterSpec& spec = row.parameter.spec;
    std::vector<Choice> choices;
    for (const std::string& choice : spec.choices)
        choices.push_back({choice_label(choice), choice_value(choice)});
    list_field(context, row, in_words(spec, row.value), choices);
}

/// A text that is one of these names, or empty, which `empty` says.
void name_field(Context& context, const Row& row, const std::vector<std::string>& names,
                const std::string& empty) {
    const std::string* text = row.value.text();
    const bool set = text && !text->empty();
    std::vector<Choice> choices{{set ? "Not chosen" : empty, ""}};
    for (const std::string& name : names) choices.push_back({name, name});
    list_field(context, row, set ? *text : empty, choices);
}

// Words of a list as small switches, in as many lines as they need; leaves the cursor below and returns true.
bool words_field(Context& context, const Row& row) {
    const Rect& area = row.layout.value;
    const Value::List& words = *row.value.list();
    ImVec2 at = area.corner();
    for (const std::string& choice : row.parameter.spec.choices) {
        const std::string label = choice_label(choice);
        const float width = ImGui::CalcTextSize(label.c_str()).x + px(14);
        if (at.x > area.x && at.x + width > area.end().x) at = {area.x, at.y + px(row_height + row_space)};
        const Rect chip{at, {width, area.height}};
        ImGui::SetCursorScreenPos(at);
        const bool clicked = ImGui::InvisibleButton(choice.c_str(), chip.size());
        Value::List others;
        for (const Value& word : words)
            if (!(word == Value(choice))) others.push_back(word);
        const bool on = others.size() < words.size();
        fill_rect(chip, on ? color::selection : color::field, px(3));
        clipped_text(chip, px(7), on ? color::text : color::dim, label);
        if (clicked) {
            if (!on) others.emplace_back(choice);
            set_value(context, row.key(), others);
        }
        at.x += width + px(3);
    }
    ImGui::SetCursorScreenPos(row.layout.whole.corner());
    ImGui::Dummy({row.layout.whole.width, at.y - area.y + px(row_height)});
    return true;
}

using Type = ParameterType;

double highest(const ParameterSpec& spec) {
    if (!spec.below_max) return spec.max;
    return spec.max - (spec.max - spec.slider_max) * 0.01 - 1e-3;
}

float share_of_slider(const ParameterSpec& spec, double value) {
    double lo = spec.slider_min, hi = spec.slider_max;
    if (!(hi > lo) || lo < 0.0) return -1.0f;
    if (spec.scale == Scale::logarithmic && lo > 0.0) {
        lo = std::log(lo);
        hi = std::log(hi);
        value = std::log(std::max(value, 1e-12));
    }
    return static_cast<float>((value - lo) / (hi - lo));
}

BoxContent number_content(const ParameterSpec& spec, double value) {
    BoxContent content;
    content.whole = spec.type == Type::integer || (spec.type == Type::vector && spec.unit == "px");
    content.shown = content.whole ? figures(std::int64_t(std::llround(value))) : figures(value);
    content.typed = short_number(value);
    content.value = value;
    content.step = drag_step(spec, value);
    content.min = spec.min;
    content.max = highest(spec);
    content.fill = share_of_slider(spec, value);
    return content;
}

// Black and white point go over the values of the picture, whose range the description cannot know.
void follow_data(const Context& context, const ParameterSpec& spec, BoxContent& content) {
    const auto& histograms = context.layer_status().histograms;
    const bool level = spec.generic_key == "layer.source.black" || spec.generic_key == "layer.source.white";
    if (!level || !histograms || histograms->values.share.empty()) return;
    ParameterSpec of_data = spec;
    of_data.slider_min = histograms->values.lo;
    of_data.slider_max = histograms->values.hi;
    content.step = drag_step(of_data, content.value);
    content.fill = share_of_slider(of_data, content.value);
}

/// The value that a box was dragged or typed to; none: it stays. Typed texts are read as `spec` has them.
std::optional<Value> changed_value(const BoxEvent& event, const BoxContent& content,
                                   const ParameterSpec& spec, bool whole) {
    const bool dragged = event.kind == BoxEvent::Kind::dragged;
    if (dragged && whole) return static_cast<std::int64_t>(std::llround(event.value));
    if (dragged) return event.value;
    if (event.kind == BoxEvent::Kind::none || event.text == content.typed) return std::nullopt;
    return value_from_text(event.text, spec);
}

Gesture gesture_of(const Context& context, const BoxEvent& event) {
    return event.kind == BoxEvent::Kind::dragged ? context.memory.gesture : 0;
}

// A field that takes any text the parameter can be made of.
void text_field(Context& context, const Row& row, const Rect& area) {
    const ParameterSpec& spec = row.parameter.spec;
    BoxContent content;
    content.shown = in_words(spec, row.value);
    const std::string* text = row.value.text();
    content.dimmed = content.shown == "Auto";
    if (content.shown.empty()) {
        content.dimmed = true;
        content.shown = empty_in_words(context, spec);
    }
    const bool empty = row.value.list() && row.value.list()->empty();
    const bool unset = content.dimmed || empty;  // what is typed begins anew
    content.typed = text && !unset ? *text : unset ? "" : to_toml(row.value);
    content.unit = content.dimmed || text ? "" : spec.unit;
    const BoxEvent event = value_box(context, "text", area, content);
    if (const auto value = changed_value(event, content, spec, false)) set_value(context, row.key(), *value);
}

void number_field(Context& context, const Row& row) {
    const ParameterSpec& spec = row.parameter.spec;
    const std::string words = unset_in_words(context, spec, row.value);
    if (words.empty() && !row.value.is_number()) return text_field(context, row, row.layout.value);
    BoxContent content =
        number_content(spec, words.empty() ? row.value.number() : first_value(context, spec));
    follow_data(context, spec, content);
    content.unit = spec.unit;
    if (!words.empty()) {
        content.shown = words;
        content.dimmed = true;
        content.fill = -1.0f;
        if (words.back() != ')') content.unit.clear();
    }
    const BoxEvent event = value_box(context, "number", row.layout.value, content);
    if (const auto value = changed_value(event, content, spec, spec.type == Type::integer))
        set_value(context, row.key(), *value, gesture_of(context, event));
}

Rect part(const Rect& area, int index, int count) {
    const float gap = px(3), n = float(count), width = (area.width - gap * (n - 1.0f)) / n;
    const auto left = [&](int i) { return std::round((width + gap) * float(i)); };
    return {{area.x + left(index), area.y}, {left(index + 1) - left(index) - gap, area.height}};
}

void component_field(Context& context, const Row& row, const Rect& area, std::size_t index) {
    const ParameterSpec& spec = row.parameter.spec;
    Value::List values = *row.value.list();
    ImGui::PushID(static_cast<int>(index));
    BoxContent content = number_content(spec, values[index].number());
    content.fill = -1.0f;
    if (!content.whole)
        content.shown =
            figures_that_fit(content.value, [&](const std::string& text) { return fits_box(area, text); });
    const BoxEvent event = value_box(context, "component", area, content);
    ImGui::PopID();
    const ParameterSpec number;  // one component, typed, is a number
    const bool whole = std::holds_alternative<std::int64_t>(values[index].data);
    const auto value = changed_value(event, content, number, whole);
    if (!value) return;
    values[index] = *value;
    set_value(context, row.key(), values, gesture_of(context, event));
}

void vector_field(Context& context, const Row& row, const Rect& area) {
    const Value::List* values = row.value.list();
    if (row.value.is_number()) return number_field(context, row);
    if (!values || values->empty()) return text_field(context, row, area);
    const int count = static_cast<int>(values->size());
    for (int i = 0; i < count; ++i)
        component_field(context, row, part(area, i, count), static_cast<std::size_t>(i));
}

void shape_popup(Context& context, const Row& row) {
    if (!begin_popup("shapes")) return;
    for (const std::string& choice : row.parameter.spec.choices)
        if (ImGui::MenuItem(choice_label(choice).c_str())) set_value(context, row.key(), choice);
    ImGui::Separator();
    if (ImGui::MenuItem("File...")) context.memory.request = row.key();
    end_menu_popup();
}

void file_field(Context& context, const Row& row) {
    const Rect& area = row.layout.value;
    const float button = px(24);
    text_field(context, row, {area.corner(), {area.width - button - px(2), area.height}});
    ImGui::SetCursorScreenPos({area.end().x - button, area.y});
    const bool shapes = !row.parameter.spec.choices.empty();
    if (icon_button("browse", Icon::folder, {button, area.height}, px(12), color::dim, "Choose a file")) {
        if (shapes)
            ImGui::OpenPopup("shapes");
        else
            context.memory.request = row.key();
    }
    shape_popup(context, row);
}

ImVec4 displayed(const Value::List& linear) {
    const auto encoded = [&](std::size_t i) {
        return static_cast<float>(real::linear_to_srgb(std::min(linear[i].number(), 1.0)));
    };
    return {encoded(0), encoded(1), encoded(2), 1.0f};
}

void color_picker(Context& context, const Row& row) {
    if (!begin_popup("picker")) return;
    const ImVec4 shown = displayed(*row.value.list());
    float rgb[3] = {shown.x, shown.y, shown.z};
    const ImGuiColorEditFlags flags = ImGuiColorEditFlags_NoSidePreview | ImGuiColorEditFlags_NoInputs |
                                      ImGuiColorEditFlags_PickerHueWheel | ImGuiColorEditFlags_NoLabel;
    ImGui::SetNextItemWidth(px(200));
    const bool changed = ImGui::ColorPicker3("##color", rgb, flags);
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) begin_gesture(context);
    if (changed) {
        Value::List linear;
        for (const float c : rgb) linear.emplace_back(rounded_to_step(real::srgb_to_linear(double(c)), 1e-4));
        set_value(context, row.key(), linear, context.memory.gesture);
    }
    end_menu_popup();
}

void color_field(Context& context, const Row& row) {
    const Rect& area = row.layout.value;
    const float size = area.height;
    ImGui::SetCursorScreenPos(area.corner());
    if (ImGui::InvisibleButton("swatch", {size, size})) ImGui::OpenPopup("picker");
    fill_rect(area.corner(), {area.x + size, area.end().y},
              ImGui::ColorConvertFloat4ToU32(displayed(*row.value.list())), px(3));
    color_picker(context, row);
    const float used = size + px(3);
    vector_field(context, row, {{area.x + used, area.y}, {area.width - used, area.height}});
}

}  // namespace

bool value_field(Context& context, const Row& row) {
    switch (row.parameter.spec.type) {
        case Type::words:
            return words_field(context, row);
        case Type::boolean:
            boolean_field(context, row);
            break;
        case Type::integer:
        case Type::number:
            number_field(context, row);
            break;
        case Type::choice:
            choice_field(context, row);
            break;
        case Type::file:
        case Type::files:
            file_field(context, row);
            break;
        case Type::vector:
        case Type::position:
        case Type::rotation:
            vector_field(context, row, row.layout.value);
            break;
        case Type::color:
            color_field(context, row);
            break;
        case Type::text:
        case Type::pattern:
        case Type::curve:
            if (const auto names = names_to_choose(context, row.parameter.spec))
                name_field(context, row, *names, empty_in_words(context, row.parameter.spec));
            else
                text_field(context, row, row.layout.value);
    }
    return false;
}

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
    constexpr double never = 1e30;  // until the mouse comes again: who changes a value looks at the picture
    const Rect& whole = row.layout.whole;
    if (ImGui::IsAnyItemActive()) {
        if (!ImGui::IsMouseHoveringRect(whole.corner(), whole.end())) return;
        memory.hovered = row.key();
        memory.hovered_since = never;
        return;
    }
    if (!mouse_over(whole)) {
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
    place_tooltip(row.layout.whole.y);
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

/// At the end of the field, which gives it room: what is in focus can be picked in the view.
void pick_button(Context& context, Rect& field) {
    const float size = px(24);
    field.width -= size + px(2);
    ImGui::SetCursorScreenPos({field.end().x + px(2), field.y});
    bool& picking = context.view.picking_focus;
    if (icon_button("pick focus", Icon::pick, {size, field.height}, px(13),
                    picking ? color::accent : color::dim, "Pick it in the view"))
        picking = !picking;
    note_item(context, "pick focus");
}

}  // namespace

void parameter_row(Context& context, const Parameter& parameter) {
    Row row{parameter, parameter.get(), next_row()};
    if (row.key() == "camera.focus_distance") pick_button(context, row.layout.value);
    note_row(context, row);
    ImGui::PushID(row.key().text().c_str());
    draw_label(context, row);
    draw_diamond(context, row);
    if (context.memory.wanted == row.key()) ring_to_next_item();
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

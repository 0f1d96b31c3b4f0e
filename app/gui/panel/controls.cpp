// Drag: Shift coarse, Alt fine. Typing: Enter, Tab or leaving takes the text, Escape drops it. Heads, notes
// and buttons are drawn to the grid of the rows. Numbers have as many figures as they need.
#include <fmt/format.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include "edit/command_lines.h"
#include "edit/edits.h"
#include "gui/panel/parts.h"

namespace astrosplat::panel {
namespace {

void begin_entry(Touch& touch, ImGuiID id, const std::string& text) {
    touch.entry = id;
    touch.entry_frames = 0;
    touch.text = text;
}

BoxEvent type_value(Context& context, const char* id, const Rect& area) {
    Touch& touch = context.memory.touch;
    touch.seen = true;
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::SetNextItemWidth(area.width);
    const float padding = std::floor((area.height - ImGui::GetFontSize()) * 0.5f);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(7), padding));
    ImGui::PushID(id);
    if (touch.entry_frames == 0) ImGui::SetKeyboardFocusHere();
    ImGui::InputText("##entry", &touch.text, ImGuiInputTextFlags_AutoSelectAll);
    ImGui::PopID();
    ImGui::PopStyleVar();
    const bool tab = ImGui::IsItemActive() && key_pressed(key_code::tab, true);
    if (tab) ImGui::ClearActiveID();
    const bool left = tab || ImGui::IsItemDeactivated();
    const bool dropped = key_pressed(key_code::escape, true);
    const bool never_active = !ImGui::IsItemActive() && ++touch.entry_frames > 4;
    if (ImGui::IsItemActive()) touch.entry_frames = 1;
    if (!left && !never_active) {
        touch.entry_frames = std::max(touch.entry_frames, 1);
        return {};
    }
    touch.entry = 0;
    touch.to_next = tab;
    if (dropped || never_active) return {};
    return {BoxEvent::Kind::typed, 0.0, touch.text};
}

float padding_of(const Rect& area) { return area.width < px(80) ? px(5) : px(8); }

/// In the small font at the right edge; returns the room it took, 0 where there was not enough.
float unit_text(const Rect& area, const std::string& unit, float needed) {
    if (unit.empty()) return 0.0f;
    ImGui::PushFont(small_font());
    const float width = ImGui::CalcTextSize(unit.c_str()).x + px(8);
    const bool fits = needed + width <= area.width;
    if (fits)
        draw_text({area.end().x - width, area.y + (area.height - ImGui::GetFontSize()) * 0.5f}, color::dim,
                  unit);
    ImGui::PopFont();
    return fits ? width : 0.0f;
}

void draw_box(const Rect& area, const BoxContent& content, bool hovered, bool active) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float radius = px(3);
    fill_rect(area, hovered || active ? color::hover : color::field, radius);
    if (content.fill > 0.0f) {
        const float width = std::max(std::round(area.width * std::min(content.fill, 1.0f)), radius);
        list->AddRectFilled(
            area.corner(), {area.x + width, area.end().y}, color::fill, radius,
            content.fill < 0.99f ? ImDrawFlags_RoundCornersLeft : ImDrawFlags_RoundCornersAll);
    }
    if (active) outline_rect(area, color::accent, radius);
    const float padding = padding_of(area);
    const float needed = ImGui::CalcTextSize(content.shown.c_str()).x + 2.0f * padding;
    const float unit = unit_text(area, content.unit, needed);
    const Rect rest{area.corner(), {area.width - unit, area.height}};
    clipped_text(rest, padding, content.dimmed ? color::dim : color::text, content.shown);
}

BoxEvent drag_value(Context& context, const BoxContent& content) {
    Touch& touch = context.memory.touch;
    if (ImGui::IsItemActivated()) {
        begin_gesture(context);
        touch.drag = ImGui::GetItemID();
        touch.value = content.value;
        touch.mouse_x = ImGui::GetIO().MousePos.x;
    }
    if (!ImGui::IsItemActive() || touch.drag != ImGui::GetItemID()) return {};
    touch.seen = true;
    const ImGuiIO& io = ImGui::GetIO();
    const float moved = io.MousePos.x - touch.mouse_x;
    if (!ImGui::IsMouseDragging(ImGuiMouseButton_Left, px(3)) || moved == 0.0f) return {};
    touch.mouse_x = io.MousePos.x;
    const double factor = io.KeyAlt ? 0.1 : io.KeyShift ? 10.0 : 1.0;
    const double step = content.step * factor;
    touch.value = std::clamp(touch.value + step * double(moved), content.min, content.max);
    const double fine = content.whole ? 1.0 : step;
    const double value = std::clamp(rounded_to_step(touch.value, fine), content.min, content.max);
    return {BoxEvent::Kind::dragged, value, ""};
}

constexpr float head_height = 28.0f;

void head_text(const Rect& area, float left, const char* title, const std::string& state) {
    ImGui::PushFont(medium_font());
    const float used = clipped_text(area, left, color::text, title) + left + px(8);
    ImGui::PopFont();
    if (state.empty()) return;
    ImGui::PushFont(small_font());
    const float width = std::min(ImGui::CalcTextSize(state.c_str()).x + px(8), area.width - used);
    const Rect rest{{area.end().x - width, area.y}, {width, area.height}};
    clipped_text(rest, px(4), color::dim, state);
    ImGui::PopFont();
}

// From edge to edge of the window, beyond the padding its contents are clipped to.
void edge_line(float y) {
    const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    ImGui::PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, false);
    line_across(corner.x, corner.x + size.x, y, color::line);
    ImGui::PopClipRect();
}

}  // namespace

BoxEvent value_box(Context& context, const char* id, const Rect& area, const BoxContent& content) {
    Touch& touch = context.memory.touch;
    const ImGuiID own = ImGui::GetID(id);
    if (touch.to_next) {
        touch.to_next = false;
        begin_entry(touch, own, content.typed);
    }
    if (touch.entry == own) {
        const BoxEvent event = type_value(context, id, area);
        if (touch.entry == 0) keep_ring_at(own);
        return event;
    }
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::InvisibleButton(id, area.size());
    const bool hovered = ImGui::IsItemHovered();
    const bool wants_text =
        entered_by_key() ||
        (hovered && (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) ||
                     (ImGui::IsItemActivated() && (ImGui::GetIO().KeyCtrl || content.step == 0.0))));
    draw_box(area, content, hovered, ImGui::IsItemActive());
    if (wants_text) {
        ImGui::ClearActiveID();
        touch.drag = 0;
        begin_entry(touch, own, content.typed);
        touch.seen = true;
        return {};
    }
    if (content.step == 0.0) return {};
    if (hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    return drag_value(context, content);
}

bool fits_box(const Rect& area, const std::string& text) {
    const float padding = padding_of(area);
    return ImGui::CalcTextSize(text.c_str()).x <= area.width - padding - std::min(padding, px(4));
}

float share_at_mouse(const Rect& area) {
    return std::clamp((ImGui::GetIO().MousePos.x - area.x) / area.width, 0.0f, 1.0f);
}

float clipped_text(const Rect& area, float padding, ImU32 color, const std::string& text) {
    const float y = area.y + (area.height - ImGui::GetFontSize()) * 0.5f;
    const ImVec2 from{area.x + padding, y};
    const float right = area.end().x - std::min(padding, px(4));
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::RenderTextEllipsis(ImGui::GetWindowDrawList(), from, {right, area.end().y}, right, right,
                              text.c_str(), text.c_str() + text.size(), &size);
    ImGui::PopStyleColor();
    return std::min(size.x, right - from.x);
}

bool section(Context& context, const char* title, const std::string& state, bool open_at_first) {
    Memory& memory = context.memory;
    bool& open = memory.open.emplace(std::pair(context.view.tab, title), open_at_first).first->second;
    open = open || memory.all_open;
    if (memory.after_open) ImGui::Dummy({0.0f, px(6)});
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const Rect area{corner, {ImGui::GetContentRegionAvail().x, px(head_height)}};
    if (ImGui::InvisibleButton(title, area.size())) open = !open;
    edge_line(corner.y);
    const ImU32 sign = ImGui::IsItemHovered() ? color::text : color::dim;
    draw_icon(ImGui::GetWindowDrawList(), open ? Icon::chevron_down : Icon::chevron_right,
              {corner.x + px(4), area.middle().y}, px(8), sign);
    head_text(area, px(16), title, open ? "" : state);
    memory.after_open = open;
    return open;
}

bool element_head(const char* title) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const Rect area{corner, {ImGui::GetContentRegionAvail().x, px(row_height)}};
    clipped_text(area, 0.0f, color::dim, title);
    ImGui::SetCursorScreenPos({area.end().x - px(20), corner.y});
    const bool removed =
        icon_button("remove", Icon::cross, {px(22), px(row_height)}, px(9), color::dim, "Remove");
    ImGui::SetCursorScreenPos(corner);
    ImGui::Dummy(area.size());
    return removed;
}

bool begin_popup(const char* id) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(8), px(7)));
    const bool open = ImGui::BeginPopup(id);
    if (!open) ImGui::PopStyleVar();
    return open;
}

void note(const std::string& text, ImU32 ink) {
    ImGui::PushFont(small_font());
    ImGui::PushStyleColor(ImGuiCol_Text, ink);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

bool text_button(const char* label, float width) {
    push_field_height(px(row_height));
    const bool clicked = ImGui::Button(label, {width, px(row_height)});
    ImGui::PopStyleVar();
    return clicked;
}

int button_line(Context& context, std::initializer_list<const char*> labels) {
    const float gap = px(4), count = static_cast<float>(labels.size());
    const float width = std::floor((ImGui::GetContentRegionAvail().x - gap * (count - 1.0f)) / count);
    int clicked = -1, index = 0;
    for (const char* label : labels) {
        if (index > 0) ImGui::SameLine(0.0f, gap);
        if (text_button(label, width)) clicked = index;
        note_item(context, std::string("panel/") + label);
        ++index;
    }
    return clicked;
}

bool add_line(const char* label) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const Rect area{corner, {px(28) + ImGui::CalcTextSize(label).x, px(row_height)}};
    const bool clicked = ImGui::InvisibleButton(label, area.size());
    const ImU32 ink = ImGui::IsItemHovered() ? color::text : color::dim;
    draw_icon(ImGui::GetWindowDrawList(), Icon::plus, {corner.x + px(5), area.middle().y}, px(9), ink);
    clipped_text(area, px(16), ink, label);
    return clicked;
}

bool progress_line(float width, float share, const std::string& text, const char* button) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float button_width = ImGui::CalcTextSize(button).x + px(16);
    const Rect bar{corner, {width - button_width - px(4), px(row_height)}};
    fill_rect(bar, color::window, px(3));
    if (share > 0.0f)
        fill_rect(bar.corner(), {corner.x + bar.width * std::min(share, 1.0f), bar.end().y}, color::fill,
                  px(3));
    clipped_text(bar, px(8), share > 0.0f ? color::text : color::attention, text);
    ImGui::SetCursorScreenPos({bar.end().x + px(4), corner.y});
    return text_button(button, button_width);
}

namespace {

// 2000000 -> "2 000 000"
std::string grouped(std::string digits) {
    const std::size_t first = digits.rfind('-', 0) == 0 ? 1 : 0;
    if (digits.size() - first < 5) return digits;
    for (std::size_t at = digits.size(); at > first + 3;) {
        at -= 3;
        digits.insert(at, " ");
    }
    return digits;
}

std::size_t places(const std::string& number) {
    const std::size_t point = number.find('.');
    return point == std::string::npos ? 0 : number.size() - point - 1;
}

std::string file_name(const std::string& text) {
    const fs::path path(text);
    return path.has_filename() ? path.filename().string() : text;
}

}  // namespace

std::string figures(double number) {
    const double size = std::fabs(number);
    if (size >= 1e15 || (size > 0.0 && size < 1e-6)) return short_number(number);
    const int magnitude = size > 0.0 ? static_cast<int>(std::floor(std::log10(size))) : 0;
    const std::string whole = short_number(number);
    const bool exponent = whole.find('e') != std::string::npos;
    const int wanted = std::clamp(2 - magnitude, 0, 6);
    const int own = exponent ? 6 : static_cast<int>(std::min<std::size_t>(places(whole), 6));
    const int most = std::min(wanted + 2, 6);  // five figures: more of an interpolated value only flicker
    const std::string text = fmt::format("{:.{}f}", number, std::clamp(own, wanted, most));
    return places(text) == 0 ? grouped(text) : text;
}

std::string figures(std::int64_t number) { return grouped(fmt::format("{}", number)); }

std::string figures_that_fit(double number, const std::function<bool(const std::string&)>& fits) {
    std::string shortest = figures(number);
    for (int count = 4; count >= 1 && !fits(shortest); --count) {
        std::string fewer = fmt::format("{:.{}g}", number, count);
        if (fewer.find('e') == std::string::npos && fewer.size() < shortest.size())
            shortest = std::move(fewer);
    }
    return shortest;
}

std::string percent(double share) {
    const double p = share * 100.0;
    return p > 0.0 && p < 1.0 ? fmt::format("{:.1f} %", p) : fmt::format("{:.0f} %", p);
}

std::string choice_label(const std::string& choice) {
    if (choice == "srgb") return "sRGB";
    if (choice == "s106") return "S106";
    if (choice == "") return "None";
    if (choice == "true") return "Yes";
    if (choice == "false") return "No";
    std::string label = choice;
    std::replace(label.begin(), label.end(), '-', ' ');
    if (label[0] >= 'a' && label[0] <= 'z') label[0] = static_cast<char>(label[0] - 'a' + 'A');
    return label;
}

std::string in_words(const ParameterSpec& spec, const Value& value) {
    const bool file = spec.type == ParameterType::file || spec.type == ParameterType::files;
    if (value == spec.nothing && spec.type != ParameterType::words && !file) return "Auto";
    if (const Value::List* list = value.list()) {
        if (spec.type == ParameterType::curve) return fmt::format("{} points", list->size());
        std::string text;
        for (const Value& element : *list) text += (text.empty() ? "" : ", ") + in_words(spec, element);
        return text;
    }
    if (const std::string* text = value.text()) {
        const bool named = std::find(spec.choices.begin(), spec.choices.end(), *text) != spec.choices.end();
        if (named || *text == "auto") return choice_label(*text);
        return file ? file_name(*text) : *text;
    }
    if (const bool* yes = std::get_if<bool>(&value.data)) return *yes ? "Yes" : "No";
    if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return figures(*integer);
    return figures(value.number());
}

std::string tooltip_text(const ParameterSpec& spec, const Value& standard) {
    std::string text = spec.label + ": " + spec.help;
    text += "\nTakes " + expectation(spec);
    if (!spec.unit.empty()) text += ", " + spec.unit;
    const bool says_nothing = standard.is_number() && standard.number() == 0.0 && !spec.zero.empty();
    text += "; default " +
            (says_nothing ? fmt::format("{} ({})", spec.zero, to_toml(standard)) : to_toml(standard));
    if (spec.animation == Animation::steps) text += "; animated in steps";
    return text + "\n" + spec.key.text();
}

std::string set_option(const std::string& key, const Value& value) {
    return "--set " + shell_word(key + "=" + to_toml(value));
}

double drag_step(const ParameterSpec& spec, double value) {
    constexpr double pixels = 250.0;  // from one end of a short range to the other
    const double range = spec.slider_max - spec.slider_min;
    const bool closed = spec.min >= spec.slider_min && spec.max <= spec.slider_max;
    const double size = std::fabs(value);
    if (spec.scale == Scale::logarithmic) return std::max(size * 0.01, spec.slider_min * 0.01);
    if (spec.type == ParameterType::integer) return std::max(std::min(range / pixels, size * 0.01), 0.05);
    if (closed) return range / pixels;
    if (spec.slider_min < 0.0) return std::min(range / pixels, std::max(size * 0.02, range / 1000.0));
    return std::min(range / pixels, std::max(size * 0.02, range / 5000.0));
}

}  // namespace astrosplat::panel

// Grounds, bars, curves and captions; the samples come from shaders/shared. The points of a curve that a
// person drags live in the document; the panel remembers only which one is selected.
#include "gui/panel/parts.h"

#include "edit/edits.h"
#include "look/shared_uniforms.h"
#include "scene/describer.h"

namespace astrosplat::panel {
Rect begin_plot(float height) {
    const Rect area{ImGui::GetCursorScreenPos(), {ImGui::GetContentRegionAvail().x, px(height)}};
    fill_rect(area, color::window, px(3));
    ImGui::Dummy(area.size());
    return area;
}

void draw_bars(const Rect& area, std::span<const float> shares, double stretch) {
    const float width = area.width * static_cast<float>(stretch) / static_cast<float>(shares.size());
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const float left = area.x + width * static_cast<float>(i);
        if (left >= area.end().x) break;
        const float gap = width >= px(4) ? 1.0f : 0.0f;
        const float right = std::min(left + width - gap, area.end().x);
        const float top = area.end().y - (area.height - px(4)) * std::clamp(shares[i], 0.0f, 1.0f);
        if (shares[i] > 0.0f) fill_rect({left, top}, {right, area.end().y}, color::hover);
    }
}

void draw_curve(const Rect& area, std::span<const float> values, float top, ImU32 color, float stretch) {
    if (values.size() < 2) return;
    std::vector<ImVec2> line;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float x = stretch * static_cast<float>(i) / static_cast<float>(values.size() - 1);
        if (x > 1.0f) break;
        const float y = std::clamp(values[i] / top, 0.0f, 1.0f);
        line.push_back({area.x + x * area.width, area.end().y - px(2) - y * (area.height - px(5))});
    }
    ImGui::GetWindowDrawList()->AddPolyline(line.data(), static_cast<int>(line.size()), color,
                                            ImDrawFlags_None, px(1.6f));
}

void captions(const std::string& left, const std::string& right) {
    ImGui::PushFont(small_font());
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    draw_text(corner, color::dim, left);
    draw_text({corner.x + width - ImGui::CalcTextSize(right.c_str()).x, corner.y}, color::dim, right);
    ImGui::Dummy({width, ImGui::GetFontSize() + px(4)});
    ImGui::PopFont();
}

namespace {

using Points = std::vector<glm::vec2>;
constexpr float gap = 0.002f;  // smallest distance of two points in x

// From the curve's 0..1 x 0..top to the window and back; as draw_curve has it.
struct Chart {
    Rect area;
    float top;
    ImVec2 at(glm::vec2 p) const {
        const float y = std::clamp(p.y / top, 0.0f, 1.0f);
        return {area.x + std::min(p.x, 1.0f) * area.width, area.end().y - px(2) - y * (area.height - px(5))};
    }
    glm::vec2 point(ImVec2 p) const {
        const float x = (p.x - area.x) / area.width;
        const float y = (area.end().y - px(2) - p.y) / (area.height - px(5)) * top;
        return {std::clamp(x, 0.0f, 1.0f), std::clamp(y, 0.0f, top)};
    }
};

int nearest(const Chart& chart, const Points& points, ImVec2 mouse) {
    int best = -1;
    float best_distance = px(9) * px(9);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ImVec2 p = chart.at(points[i]);
        const float dx = p.x - mouse.x, dy = p.y - mouse.y;
        if (dx * dx + dy * dy < best_distance) {
            best_distance = dx * dx + dy * dy;
            best = static_cast<int>(i);
        }
    }
    return best;
}

// Moves a point, keeping the order of x.
void place(Points& points, int index, glm::vec2 to) {
    const auto i = static_cast<std::size_t>(index);
    const float lo = i > 0 ? points[i - 1].x + gap : 0.0f;
    const float hi = i + 1 < points.size() ? points[i + 1].x - gap : std::max(1.0f, points[i].x);
    const auto rounded = [](float x) { return static_cast<float>(rounded_to_step(double(x), 1e-3)); };
    points[i] = {rounded(std::clamp(to.x, lo, std::max(lo, hi))), rounded(std::max(to.y, 0.0f))};
}

// Index of the new point; -1 where there is no room.
int insert(Points& points, glm::vec2 p) {
    if (points.size() >= static_cast<std::size_t>(shared_types::LOOK_MAX_POINTS)) return -1;
    const auto after = std::find_if(points.begin(), points.end(), [&](glm::vec2 q) { return q.x > p.x; });
    const int index = static_cast<int>(after - points.begin());
    points.insert(after, p);
    place(points, index, p);
    return index;
}

void press(Context& context, const ParameterKey& key, const Chart& chart, Points points) {
    Memory& memory = context.memory;
    begin_gesture(context);
    memory.selected_curve = key;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    memory.selected_point = nearest(chart, points, mouse);
    if (memory.selected_point >= 0) return;
    memory.selected_point = insert(points, chart.point(mouse));
    if (memory.selected_point >= 0) set_value(context, key, curve_value(points), memory.gesture);
}

void drag(Context& context, const ParameterKey& key, const Chart& chart, Points points) {
    const int index = context.memory.selected_point;
    if (index < 0 || index >= static_cast<int>(points.size())) return;
    place(points, index, chart.point(ImGui::GetIO().MousePos));
    set_value(context, key, curve_value(points), context.memory.gesture);
}

void remove(Context& context, const ParameterKey& key, const Chart& chart, Points points) {
    const int index = nearest(chart, points, ImGui::GetIO().MousePos);
    if (index < 0 || points.size() <= 2) return;
    points.erase(points.begin() + index);
    context.memory.selected_point = -1;
    set_value(context, key, curve_value(points));
}

void nudge(Context& context, const ParameterKey& key, const Chart& chart, Points points) {
    const int index = context.memory.selected_point;
    if (context.memory.selected_curve != key || index < 0 || index >= static_cast<int>(points.size())) return;
    if (!ImGui::IsWindowFocused() || ImGui::GetIO().WantTextInput) return;
    const auto pressed = [](int code) { return key_pressed(code, true) ? 1.0f : 0.0f; };
    const glm::vec2 steps{pressed(key_code::right) - pressed(key_code::left),
                          pressed(key_code::up) - pressed(key_code::down)};
    if (steps == glm::vec2(0.0f)) return;
    const float size = ImGui::GetIO().KeyShift ? 0.1f : 0.01f;
    place(points, index, points[static_cast<std::size_t>(index)] + steps * glm::vec2(1.0f, chart.top) * size);
    set_value(context, key, curve_value(points));
}

void draw_points(const Context& context, const ParameterKey& key, const Chart& chart, const Points& points) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const int under = nearest(chart, points, ImGui::GetIO().MousePos);
    for (int i = 0; i < static_cast<int>(points.size()); ++i) {
        const bool selected = context.memory.selected_curve == key && context.memory.selected_point == i;
        const ImVec2 p = chart.at(points[static_cast<std::size_t>(i)]);
        list->AddCircleFilled(p, px(selected || i == under ? 5.0f : 4.0f), color::window);
        list->AddCircleFilled(p, px(selected || i == under ? 4.0f : 3.0f),
                              selected ? color::accent : color::text);
    }
}

}  // namespace

void edit_curve(Context& context, const ParameterKey& key, const Rect& area, std::span<const float> samples) {
    const Parameter* parameter = find(context, key);
    if (!parameter) return;
    Points points = curve_of(parameter->get(), parameter->spec);
    if (points.size() < 2) points = {{0.0f, 1.0f}, {1.0f, 1.0f}};
    float top = 1.0f;
    for (const glm::vec2& p : points) top = std::max(top, p.y);
    const Chart chart{area, top};
    context.memory.plots[key] = area;
    ImGui::PushID(key.text().c_str());
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::InvisibleButton("curve", area.size());
    if (ImGui::IsItemActivated())
        press(context, key, chart, points);
    else if (ImGui::IsItemActive() &&
             (ImGui::GetIO().MouseDelta.x != 0.0f || ImGui::GetIO().MouseDelta.y != 0.0f))
        drag(context, key, chart, points);
    if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right))
        remove(context, key, chart, points);
    nudge(context, key, chart, points);
    draw_curve(area, samples, top, color::accent);
    draw_points(context, key, chart, points);
    ImGui::PopID();
}

}  // namespace astrosplat::panel

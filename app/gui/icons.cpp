// Icons as strokes in a unit square: one short function each, and a table from name to function.
#include "gui/icons.h"

#include <cmath>
#include <iterator>

#include "gui/widgets.h"

namespace astrosplat {
namespace {

// Icon coordinates run from -1 to 1, x right, y down.
struct Pen {
    ImDrawList* list;
    ImVec2 center;
    float half;
    ImU32 color;
    float width;

    ImVec2 at(float x, float y) const { return {center.x + x * half, center.y + y * half}; }
    void line(float x0, float y0, float x1, float y1) const {
        list->AddLine(at(x0, y0), at(x1, y1), color, width);
    }
    void triangle(float x0, float y0, float x1, float y1, float x2, float y2) const {
        list->AddTriangleFilled(at(x0, y0), at(x1, y1), at(x2, y2), color);
    }
    void path(std::initializer_list<ImVec2> points, bool closed) const {
        for (const ImVec2& p : points) list->PathLineTo(at(p.x, p.y));
        list->PathStroke(color, closed ? ImDrawFlags_Closed : ImDrawFlags_None, width);
    }
    void circle(float radius) const { list->AddCircle(center, radius * half, color, 0, width); }
    void arc(ImVec2 from, ImVec2 control, ImVec2 to) const {
        list->PathLineTo(at(from.x, from.y));
        list->PathBezierQuadraticCurveTo(at(control.x, control.y), at(to.x, to.y));
        list->PathStroke(color, ImDrawFlags_None, width);
    }
};

void eye(const Pen& pen) {
    for (const float lid : {-1.15f, 1.15f}) pen.arc({-1, 0}, {0, lid}, {1, 0});
    pen.list->AddCircleFilled(pen.center, 0.3f * pen.half, pen.color);
}
void eye_closed(const Pen& pen) { pen.arc({-1, -0.1f}, {0, 0.95f}, {1, -0.1f}); }
void diamond(const Pen& pen) {
    pen.list->AddQuadFilled(pen.at(0, -0.85f), pen.at(0.85f, 0), pen.at(0, 0.85f), pen.at(-0.85f, 0),
                            pen.color);
}
void diamond_empty(const Pen& pen) { pen.path({{0, -0.75f}, {0.75f, 0}, {0, 0.75f}, {-0.75f, 0}}, true); }
void play(const Pen& pen) { pen.triangle(-0.6f, -0.85f, 0.85f, 0.0f, -0.6f, 0.85f); }
void pause(const Pen& pen) {
    pen.list->AddRectFilled(pen.at(-0.7f, -0.8f), pen.at(-0.2f, 0.8f), pen.color);
    pen.list->AddRectFilled(pen.at(0.2f, -0.8f), pen.at(0.7f, 0.8f), pen.color);
}
void chevron_right(const Pen& pen) { pen.path({{-0.3f, -0.65f}, {0.4f, 0}, {-0.3f, 0.65f}}, false); }
void chevron_down(const Pen& pen) { pen.path({{-0.65f, -0.3f}, {0, 0.4f}, {0.65f, -0.3f}}, false); }
void chevron_up(const Pen& pen) { pen.path({{-0.65f, 0.3f}, {0, -0.4f}, {0.65f, 0.3f}}, false); }
void plus(const Pen& pen) {
    pen.line(-0.8f, 0, 0.8f, 0);
    pen.line(0, -0.8f, 0, 0.8f);
}
void cross(const Pen& pen) {
    pen.line(-0.6f, -0.6f, 0.6f, 0.6f);
    pen.line(-0.6f, 0.6f, 0.6f, -0.6f);
}
void ring(const Pen& pen) { pen.circle(0.7f); }
void ring_cut(const Pen& pen) {
    ring(pen);
    pen.list->PathArcTo(pen.center, 0.7f * pen.half, -0.785f, 2.356f);
    pen.list->PathFillConvex(pen.color);
}
void curve(const Pen& pen) {
    pen.list->PathLineTo(pen.at(-0.85f, 0.7f));
    pen.list->PathBezierCubicCurveTo(pen.at(0.1f, 0.7f), pen.at(-0.1f, -0.7f), pen.at(0.85f, -0.7f));
    pen.list->PathStroke(pen.color, ImDrawFlags_None, pen.width);
}
void warning(const Pen& pen) {
    pen.path({{0, -0.8f}, {0.9f, 0.75f}, {-0.9f, 0.75f}}, true);
    pen.line(0, -0.25f, 0, 0.25f);
    pen.line(0, 0.45f, 0, 0.55f);
}
void folder(const Pen& pen) {
    pen.path(
        {{-0.85f, -0.6f}, {-0.25f, -0.6f}, {0, -0.35f}, {0.85f, -0.35f}, {0.85f, 0.65f}, {-0.85f, 0.65f}},
        true);
}
void file(const Pen& pen) {
    pen.path({{-0.6f, -0.85f}, {0.2f, -0.85f}, {0.6f, -0.4f}, {0.6f, 0.85f}, {-0.6f, 0.85f}}, true);
}
void dots(const Pen& pen) {
    for (const float x : {-0.7f, 0.0f, 0.7f})
        pen.list->AddCircleFilled(pen.at(x, 0), 0.18f * pen.half, pen.color);
}

using Draw = void (*)(const Pen&);
constexpr Draw drawings[] = {eye,           eye_closed,   diamond,    diamond_empty, play,  pause,
                             chevron_right, chevron_down, chevron_up, plus,          cross, ring,
                             ring_cut,      curve,        warning,    folder,        file,  dots};
static_assert(std::size(drawings) == static_cast<std::size_t>(Icon::dots) + 1);

}  // namespace

void draw_icon(ImDrawList* list, Icon icon, ImVec2 center, float size, ImU32 color) {
    // Odd line centres fall on pixel centres and stay sharp.
    const ImVec2 snapped{std::floor(center.x) + 0.5f, std::floor(center.y) + 0.5f};
    drawings[static_cast<std::size_t>(icon)]({list, snapped, size * 0.5f, color, px(1.3f)});
}

void draw_bracket(ImDrawList* list, float x, float y0, float y1, ImU32 color) {
    const float tip = x + px(4.0f);
    for (const ImVec2 corner : {ImVec2(tip, y0), ImVec2(x, y0), ImVec2(x, y1), ImVec2(tip, y1)})
        list->PathLineTo(corner);
    list->PathStroke(color, ImDrawFlags_None, px(1.0f));
}

bool icon_button(const char* id, Icon icon, ImVec2 size, float icon_px, ImU32 color, const char* says) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const bool clicked = ImGui::InvisibleButton(id, size);
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (ImGui::IsItemHovered())
        list->AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, color::hover, px(3.0f));
    tooltip(says);
    draw_icon(list, icon, {corner.x + size.x * 0.5f, corner.y + size.y * 0.5f}, icon_px, color);
    return clicked;
}

}  // namespace astrosplat

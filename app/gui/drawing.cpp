// Lines along an axis are rectangles, which ImGui draws as they are; its strokes come with soft edges. Icons
// are strokes in a unit square: one short function each, and a table from name to function.
#include "gui/drawing.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

float whole(float length) { return std::max(1.0f, std::round(length)); }

/// The first of `width` pixels around the one that `at` lies in.
float first_pixel(float at, float width) { return std::floor(at - 0.5f * (width - 1.0f)); }

/// The border of two pixels that is nearest; the right or lower one of two.
ImVec2 border(ImVec2 p) { return {std::floor(p.x + 0.5f), std::floor(p.y + 0.5f)}; }

// Icon coordinates run from -1 to 1, x right, y down.
struct Pen {
    ImDrawList* list;
    ImVec2 center;  // the middle of a pixel
    float half;
    ImU32 color;
    float width;

    ImVec2 at(float x, float y) const { return {center.x + x * half, center.y + y * half}; }
    /// The middle of the pixel there: corners of strokes whose sides lie along an axis.
    ImVec2 pixel(float x, float y) const {
        const ImVec2 p = at(x, y);
        return {std::floor(p.x) + 0.5f, std::floor(p.y) + 0.5f};
    }
    void line(float x0, float y0, float x1, float y1) const {
        list->PathLineTo(at(x0, y0));
        list->PathLineTo(at(x1, y1));
        list->PathStroke(color, ImDrawFlags_None, width);
    }
    void across(float x0, float x1, float y) const {
        line_across(list, pixel(x0, y).x - 0.5f, pixel(x1, y).x + 0.5f, pixel(x0, y).y, color, width);
    }
    void down(float x, float y0, float y1) const {
        line_down(list, pixel(x, y0).x, pixel(x, y0).y - 0.5f, pixel(x, y1).y + 0.5f, color, width);
    }
    void path(std::initializer_list<ImVec2> points, bool closed) const {
        for (const ImVec2& p : points) list->PathLineTo(at(p.x, p.y));
        list->PathStroke(color, closed ? ImDrawFlags_Closed : ImDrawFlags_None, width);
    }
    /// A closed path with sides along an axis.
    void shape(std::initializer_list<ImVec2> points) const {
        for (const ImVec2& p : points) list->PathLineTo(pixel(p.x, p.y));
        list->PathStroke(color, ImDrawFlags_Closed, whole(width));
    }
    void circle(float x, float y, float radius) const {
        list->AddCircle(at(x, y), radius * half, color, 0, width);
    }
};

void eye(const Pen& pen) {
    pen.list->PathLineTo(pen.at(-1.0f, 0.0f));
    pen.list->PathBezierQuadraticCurveTo(pen.at(0.0f, -1.15f), pen.at(1.0f, 0.0f));
    pen.list->PathBezierQuadraticCurveTo(pen.at(0.0f, 1.15f), pen.at(-0.99f, 0.0f));
    pen.list->PathStroke(pen.color, ImDrawFlags_Closed, pen.width);
    pen.list->AddCircleFilled(pen.center, 0.3f * pen.half, pen.color);
}
void eye_closed(const Pen& pen) {
    pen.list->PathLineTo(pen.at(-1.0f, -0.1f));
    pen.list->PathBezierQuadraticCurveTo(pen.at(0.0f, 0.95f), pen.at(1.0f, -0.1f));
    pen.list->PathStroke(pen.color, ImDrawFlags_None, pen.width);
}
void diamond(const Pen& pen) {
    pen.list->AddQuadFilled(pen.at(0, -0.85f), pen.at(0.85f, 0), pen.at(0, 0.85f), pen.at(-0.85f, 0),
                            pen.color);
}
void diamond_empty(const Pen& pen) { pen.path({{0, -0.75f}, {0.75f, 0}, {0, 0.75f}, {-0.75f, 0}}, true); }
void play(const Pen& pen) {
    const ImVec2 top = border(pen.at(-0.6f, -0.85f));
    pen.list->AddTriangleFilled(top, pen.at(0.85f, 0.0f), {top.x, pen.at(0.0f, 0.85f).y}, pen.color);
}
void pause(const Pen& pen) {
    filled(pen.list, pen.at(-0.7f, -0.8f), pen.at(-0.2f, 0.8f), pen.color);
    filled(pen.list, pen.at(0.2f, -0.8f), pen.at(0.7f, 0.8f), pen.color);
}
void chevron_right(const Pen& pen) { pen.path({{-0.3f, -0.65f}, {0.4f, 0}, {-0.3f, 0.65f}}, false); }
void chevron_down(const Pen& pen) { pen.path({{-0.65f, -0.3f}, {0, 0.4f}, {0.65f, -0.3f}}, false); }
void chevron_up(const Pen& pen) { pen.path({{-0.65f, 0.3f}, {0, -0.4f}, {0.65f, 0.3f}}, false); }
void plus(const Pen& pen) {
    pen.across(-0.8f, 0.8f, 0);
    pen.down(0, -0.8f, 0.8f);
}
void cross(const Pen& pen) {
    pen.line(-0.58f, -0.58f, 0.58f, 0.58f);
    pen.line(-0.58f, 0.58f, 0.58f, -0.58f);
}
void ring(const Pen& pen) { pen.circle(0, 0, 0.7f); }
void ring_cut(const Pen& pen) {
    pen.circle(0, 0, 0.7f);
    pen.list->PathArcTo(pen.center, 0.7f * pen.half, -0.785f, 2.356f);
    pen.list->PathFillConvex(pen.color);
}
void curve(const Pen& pen) {
    pen.list->PathLineTo(pen.at(-0.85f, 0.7f));
    pen.list->PathBezierCubicCurveTo(pen.at(0.1f, 0.7f), pen.at(-0.1f, -0.7f), pen.at(0.85f, -0.7f));
    pen.list->PathStroke(pen.color, ImDrawFlags_None, pen.width);
}
void warning(const Pen& pen) {
    pen.shape({{0, -0.8f}, {0.9f, 0.75f}, {-0.9f, 0.75f}});
    pen.down(0, -0.25f, 0.2f);
    pen.down(0, 0.5f, 0.5f);
}
void folder(const Pen& pen) {
    pen.shape(
        {{-0.85f, -0.6f}, {-0.25f, -0.6f}, {0, -0.35f}, {0.85f, -0.35f}, {0.85f, 0.65f}, {-0.85f, 0.65f}});
}
void file(const Pen& pen) {
    pen.shape({{-0.6f, -0.85f}, {0.2f, -0.85f}, {0.6f, -0.4f}, {0.6f, 0.85f}, {-0.6f, 0.85f}});
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

void line_across(ImDrawList* list, float x0, float x1, float y, ImU32 color, float width) {
    const float w = whole(width), top = first_pixel(y, w);
    list->AddRectFilled({border({x0, 0}).x, top}, {border({x1, 0}).x, top + w}, color);
}

void line_down(ImDrawList* list, float x, float y0, float y1, ImU32 color, float width) {
    const float w = whole(width), left = first_pixel(x, w);
    list->AddRectFilled({left, border({0, y0}).y}, {left + w, border({0, y1}).y}, color);
}

void filled(ImDrawList* list, ImVec2 lo, ImVec2 hi, ImU32 color, float radius) {
    list->AddRectFilled(border(lo), border(hi), color, radius);
}

void outlined(ImDrawList* list, ImVec2 lo, ImVec2 hi, ImU32 color, float radius, float width) {
    const float w = whole(width), half = 0.5f * w;
    const ImVec2 from = border(lo), to = border(hi);
    list->PathRect({from.x + half, from.y + half}, {to.x - half, to.y - half}, radius);
    list->PathStroke(color, ImDrawFlags_Closed, w);
}

void square(ImDrawList* list, ImVec2 middle, float half, ImU32 color) {
    const float w = 2.0f * std::round(half) + 1.0f;
    const ImVec2 corner{first_pixel(middle.x, w), first_pixel(middle.y, w)};
    list->AddRectFilled(corner, {corner.x + w, corner.y + w}, color);
}

void draw_icon(ImDrawList* list, Icon icon, ImVec2 center, float size, ImU32 color) {
    // Odd line centres fall on pixel centres and stay sharp.
    const ImVec2 snapped{std::floor(center.x) + 0.5f, std::floor(center.y) + 0.5f};
    drawings[static_cast<std::size_t>(icon)]({list, snapped, size * 0.5f, color, px(1.3f)});
}

void draw_bracket(ImDrawList* list, float x, float y0, float y1, ImU32 color) {
    const float width = whole(px(1.0f)), tip = px(4.0f);
    const float top = first_pixel(y0, width), bottom = first_pixel(y1, width);
    line_down(list, x, top + width, bottom, color, width);
    line_across(list, x, x + tip, y0, color, width);
    line_across(list, x, x + tip, y1, color, width);
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

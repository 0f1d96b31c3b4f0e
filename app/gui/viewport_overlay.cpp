// Marks in the frame's plane are grey; those in depth fade towards the far end of the scene's box.
#include "gui/viewport_overlay.h"

#include <fmt/format.h>

#include <numeric>

#include "camera/framing.h"
#include "edit/placement.h"
#include "edit/view_camera.h"
#include "gui/widgets.h"
#include "scene/animate.h"

namespace astrosplat {
namespace {

constexpr float inset = 12;

Rect shrunk(const Rect& r, float share) {
    const float w = r.width * share, h = r.height * share;
    return {r.x + (r.width - w) * 0.5f, r.y + (r.height - h) * 0.5f, w, h};
}

// By ViewKind.
constexpr const char* view_names[] = {"Camera", "Free view, 0 returns to the camera", "Front", "Top", "Side"};

// The part of the frame that the output shows: as high as it, as the camera's angle is vertical.
Rect gate_of(const Scene& scene, const Rect& frame_area) {
    const float width = std::round(frame_area.height * static_cast<float>(aspect_of(scene.output)));
    return {std::round(frame_area.x + (frame_area.width - width) * 0.5f), frame_area.y, width,
            frame_area.height};
}

// Dims the frame at the left and right of the gate.
void dim_outside(const Rect& area, const Rect& gate) {
    const ImU32 shade = color::with_opacity(IM_COL32_BLACK, 0.55f);
    if (gate.x > area.x) fill_rect(area.corner(), {gate.x, area.end().y}, shade);
    if (gate.end().x < area.end().x) fill_rect({gate.end().x, area.y}, area.end(), shade);
}

// Text that can be read over black and over white.
void shadowed(ImVec2 at, ImU32 c, const std::string& text) {
    draw_text({at.x + 1, at.y + 1}, color::with_opacity(IM_COL32_BLACK, 0.8f), text);
    draw_text(at, c, text);
}

std::string name_of_other(const GuiFrame& frame) {
    if (frame.view.compare_with == CompareWith::b)
        return frame.status.b_name.empty() ? "B" : "B  " + frame.status.b_name;
    const ReferenceParams* reference = seen_reference(frame.document.scene(), frame.status);
    return reference ? reference->file.filename().string() : "Reference";
}

/// Which of the two is seen, where the tools do not tell.
std::string compare_text(const GuiFrame& frame) {
    switch (frame.view.compare) {
        case CompareMode::blink:
            return "   blinking: " + (frame.status.blink_shows_other ? name_of_other(frame) : "A");
        case CompareMode::difference:
            return "   A minus " + name_of_other(frame);
        default:
            return "";
    }
}

/// Inside the gate where one is seen, clear of its line.
Rect room_for_words(const GuiFrame& frame, const Rect& area, const Rect& frame_area) {
    const ViewState& view = frame.view;
    if (view.view != ViewKind::camera || !view.gate || view.compare == CompareMode::front) return area;
    const Rect gate = gate_of(frame.document.scene(), frame_area);
    const float left = std::max(area.x, gate.x), top = std::max(area.y, gate.y);
    return {left, top, std::min(area.end().x, gate.end().x) - left,
            std::min(area.end().y, gate.end().y) - top};
}

}  // namespace

std::string aspect_text(std::int64_t width, std::int64_t height) {
    const std::int64_t divisor = std::gcd(width, height);
    if (divisor > 0 && width / divisor < 30 && height / divisor < 30)
        return fmt::format("{}:{}", width / divisor, height / divisor);
    return fmt::format("{:.2f}:1", static_cast<double>(width) / static_cast<double>(height));
}

void draw_gate(const GuiFrame& frame, const Rect& area, const Rect& frame_area) {
    const ViewState& view = frame.view;
    const bool through_camera = view.view == ViewKind::camera;
    if (!through_camera || frame.status.view_frame.width <= 0 || view.compare == CompareMode::front) return;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Rect gate = gate_of(frame.document.scene(), frame_area);
    const ImU32 grey = color::with_opacity(color::dim, 0.7f);
    if (view.gate) {
        dim_outside(area, gate);
        outline_rect(gate, grey);
    }
    const CameraParams camera = scene_at(frame.document.scene(), view.frame).camera;
    const bool dome = camera.projection == Projection::fisheye;
    const float radius = 0.5f * std::min(gate.width, gate.height);
    const auto circle = [&](float share, ImU32 ink) {
        list->AddCircle(gate.middle(), share * radius, ink, 256);
    };
    if (view.gate && dome) circle(1.0f, grey);
    if (!view.safe_areas) return;
    // SMPTE ST 2046-1: 93 % for action, 90 % for titles.
    for (const float share : {0.93f, 0.9f}) {
        const ImU32 ink = color::with_opacity(color::dim, 0.45f);
        const Rect safe = shrunk(gate, share);
        if (dome)
            circle(share, ink);
        else
            outline_rect(safe, ink);
    }
}

void draw_overlay_lines(const GuiFrame& frame, const Rect& area) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    for (const auto& line : frame.status.overlay_lines) {
        if (line.size() == 1)
            list->AddCircleFilled({area.x + line[0].x, area.y + line[0].y}, px(2.4f), color::attention, 12);
        for (const glm::vec2& p : line) list->PathLineTo({area.x + p.x, area.y + p.y});
        list->PathStroke(color::with_opacity(color::attention, 0.75f), ImDrawFlags_None, px(1.2f));
    }
}

void draw_wipe(const GuiFrame& frame, const Rect& area, const Rect& frame_area) {
    if (frame.view.compare != CompareMode::wipe) return;
    const float x = std::round(frame_area.x + frame_area.width * frame.view.wipe);
    line_down(x, area.y, area.end().y, color::with_opacity(color::text, 0.8f));
    const ImVec2 grip{x, area.y + area.height * 0.5f};
    fill_rect({x - px(3), grip.y - px(18)}, {x + px(3) + 1.0f, grip.y + px(18)}, color::text, px(3));
    ImGui::PushFont(small_font());
    const std::string b = name_of_other(frame);
    const float y = area.y + px(inset);
    shadowed({x - px(inset) - ImGui::CalcTextSize("A").x, y}, color::text, "A");
    shadowed({x + px(inset), y}, color::text, b);
    ImGui::PopFont();
}

namespace {

/// "red alone   +1.0 EV   in this window only": what is not neutral.
std::string inspection_text(const Inspection& inspection) {
    constexpr std::array<const char*, 7> channels{
        "", "red alone   ", "green alone   ", "blue alone   ", "alpha alone   ", "luminance   ", "stops   "};
    std::string text = channels[static_cast<std::size_t>(inspection.channel)];
    if (inspection.exposure != 0.0f) text += fmt::format("{:+.1f} EV   ", inspection.exposure);
    if (inspection.gamma != 1.0f) text += fmt::format("gamma {:.2f}   ", inspection.gamma);
    return text.empty() ? text : text + "in this window only";
}

/// What the false colours mean, the brightest at the top; where a band begins, in stops about middle grey.
/// `corner`: the upper right.
void draw_stops(ImVec2 corner) {
    constexpr float height = 15, width = 22;
    constexpr std::array<const char*, shared::BAND_COUNT> begins{
        "below", "-6", "-4", "-2", "-\xC2\xBD", "+\xC2\xBD", "+1\xC2\xBD", "white", "white +2"};
    for (int band = 0; band < shared::BAND_COUNT; ++band) {
        const float y = corner.y + px(height) * static_cast<float>(shared::BAND_COUNT - 1 - band);
        const glm::vec3 c = shared::band_color(band);
        fill_rect(Rect{corner.x - px(width), y, px(width), px(height)},
                  ImGui::ColorConvertFloat4ToU32({c.x, c.y, c.z, 1.0f}));
        const char* const begin = begins[static_cast<std::size_t>(band)];
        shadowed({std::floor(corner.x - px(width + 6) - ImGui::CalcTextSize(begin).x), y}, color::text,
                 begin);
    }
}

}  // namespace

void draw_view_line(const GuiFrame& frame, const Rect& area, const Rect& frame_area) {
    const OutputParams& output = frame.document.scene().output;
    const bool difference = frame.view.compare == CompareMode::front;
    std::string text = view_names[static_cast<std::size_t>(frame.view.view)];
    text += fmt::format("   frame {:g}", frame.view.frame);
    if (frame.view.view == ViewKind::camera && frame.view.gate)
        text += "   " + aspect_text(output.width, output.height) + " gate";
    if (frame.view.lock_to_camera) text += "   locked to the camera";
    if (frame.view.size == SizeMode::one_to_one)
        text += fmt::format("   {}x{} at {:.0f} %", output.width, output.height, frame.view.zoom * 100.0);
    text += compare_text(frame);
    if (!frame.status.missing_frame.empty())
        text += "   " + frame.status.missing_frame + " is not rendered: preview";
    if (difference)
        text = "Front view: orange where it is brighter than the picture, blue where it is darker";
    if (frame.view.grid && frame.status.viewport_camera)
        text += "   grid " + length_text(grid_around(frame.status.box, frame.view.view).spacing,
                                         frame.document.scene().light_years_per_unit);
    ImGui::PushFont(small_font());
    const Rect room = room_for_words(frame, area, frame_area);
    shadowed({room.x + px(inset), room.y + px(inset)}, color::dim, text);
    const std::string looks = frame.view.picking_focus ? "Click what shall be in focus; Escape cancels"
                                                       : inspection_text(frame.view.inspection);
    const float right = room.end().x - px(inset), y = room.y + px(inset);
    shadowed({std::floor(right - ImGui::CalcTextSize(looks.c_str()).x), y}, color::attention, looks);
    if (frame.view.inspection.channel == Inspection::Channel::stops) draw_stops({right, y + px(20)});
    ImGui::PopFont();
}

void draw_scale_bar(const GuiFrame& frame, const Rect& area, const Rect& frame_area) {
    constexpr float longest = 160, above_badge = 48, tick = 4;  // px at scale 1
    const Scene& scene = frame.document.scene();
    const ViewState& view = frame.view;
    if (!view.scale_bar || !frame.status.viewport_camera || view.compare == CompareMode::front) return;
    const double aspect = aspect_of(scene.output);
    const auto seen =
        try_free_camera(view_camera(scene, view, frame.status.box, aspect), frame.status.box, aspect);
    if (!seen) return;
    const ScaleBar bar = scale_bar(units_per_px(*frame.status.viewport_camera, seen->pivot),
                                   scene.light_years_per_unit, double(px(longest)));
    const Rect room = room_for_words(frame, area, frame_area);
    const float right = std::floor(room.end().x - px(inset)), y = std::floor(room.end().y - px(above_badge));
    const float left = right - float(bar.length_px);
    for (const auto& [ink, width] : {std::pair(IM_COL32_BLACK, 4.0f), std::pair(color::text, 2.0f)}) {
        line_across(left, right, y, ink, px(width));
        for (const float x : {left, right}) line_down(x, y - px(tick), y + px(tick), ink, px(width));
    }
    ImGui::PushFont(small_font());
    const ImVec2 size = ImGui::CalcTextSize(bar.text.c_str());
    shadowed({std::floor(0.5f * (left + right - size.x)), y - px(tick + 2) - size.y}, color::text, bar.text);
    ImGui::PopFont();
}

namespace {

const ImU32 scale_ink = color::with_opacity(IM_COL32_WHITE, 0.22f), scale_text = IM_COL32(150, 154, 160, 255);

/// Lines at 0, 25, 50, 75 and 100 %, of which every other one is named at the left.
void draw_levels(const Rect& plot) {
    for (int percent = 0; percent <= 100; percent += 25) {
        const float y = std::floor(plot.end().y - 1.0f - (plot.height - 1.0f) * 0.01f * float(percent));
        const bool named = percent % 50 == 0;
        line_across(plot.x, plot.end().x, y, color::with_opacity(scale_ink, named ? 0.22f : 0.1f));
        if (!named) continue;
        const std::string text = std::to_string(percent);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        draw_text({std::floor(plot.x - size.x - px(4)), std::floor(y - 0.5f * size.y)}, scale_text, text);
    }
}

/// The same from left to right.
void draw_values(const Rect& plot) {
    for (int percent = 0; percent <= 100; percent += 25) {
        const float x = std::floor(plot.x + (plot.width - 1.0f) * 0.01f * float(percent));
        const bool named = percent % 50 == 0;
        line_down(x, plot.y, plot.end().y, color::with_opacity(scale_ink, named ? 0.22f : 0.1f));
        if (!named) continue;
        const std::string text = std::to_string(percent);
        const float width = ImGui::CalcTextSize(text.c_str()).x;
        draw_text({std::floor(x - 0.01f * float(percent) * width), plot.end().y + px(1)}, scale_text, text);
    }
}

/// Axes, the circle of the purest colours, the six colour bars at 75 %, and the hue of skin, which is that of
/// the I axis of NTSC.
void draw_hues(const Rect& plot) {
    constexpr float box = 4;
    constexpr glm::vec2 skin(-0.5446f, 0.8387f);  // at 123 degrees
    constexpr std::array<const char*, 6> names{"R", "Mg", "B", "Cy", "G", "Yl"};
    constexpr std::array<glm::vec3, 6> bars{glm::vec3(1, 0, 0), {1, 0, 1}, {0, 0, 1},
                                            {0, 1, 1},          {0, 1, 0}, {1, 1, 0}};
    const ImVec2 middle = plot.middle();
    const float scale = 0.5f * plot.width / vector_reach;
    const auto at = [&](glm::vec2 chroma) {
        return ImVec2{middle.x + scale * chroma.x, middle.y - scale * chroma.y};
    };
    line_across(plot.x, plot.end().x, middle.y, scale_ink);
    line_down(middle.x, plot.y, plot.end().y, scale_ink);
    ImGui::GetWindowDrawList()->AddCircle(middle, 0.5f * scale, scale_ink, 64);
    draw_line(middle, at(0.5f * skin), color::with_opacity(color::attention, 0.5f));
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const glm::vec2 chroma = chroma_of(0.75f * bars[i]);
        const ImVec2 bar = at(chroma), size = ImGui::CalcTextSize(names[i]);
        outline_rect({std::round(bar.x - px(box)), std::round(bar.y - px(box)), px(2 * box), px(2 * box)},
                     color::with_opacity(IM_COL32_WHITE, 0.45f));
        const float side = chroma.x < 0.0f ? -px(box + 3) - size.x : px(box + 3);
        draw_text({std::floor(bar.x + side), std::floor(bar.y - 0.5f * size.y)}, scale_text, names[i]);
    }
}

}  // namespace

void draw_scopes(const GuiFrame& frame, const Rect& area) {
    constexpr float head = 22, foot = 20, gap = 8, right = 10, above_badge = 46, full = 160;
    constexpr std::array<float, scope_count> left{10, 30, 10}, shape{1.6f, 1.6f, 1.0f};  // width / height
    const ViewState& view = frame.view;
    if (!view.scopes_open) return;
    float margins = 2 * inset, shapes = 0.0f;
    for (std::size_t i = 0; i < scope_count; ++i)
        if (view.scopes[i]) margins += left[i] + right + gap, shapes += shape[i];
    // As large as there is room for in one row.
    const float width = (area.width - px(margins)) / shapes;
    const float height = std::floor(std::clamp(std::min(width, 0.4f * area.height), px(40), px(full)));
    ImGui::PushFont(small_font());
    Rect box{area.x + px(inset), 0, 0, px(head + foot) + height};
    box.y = std::floor(area.end().y - px(above_badge) - box.height);
    for (std::size_t i = 0; i < scope_count; ++i) {
        if (!view.scopes[i]) continue;
        box.width = std::floor(px(left[i] + right) + shape[i] * height);
        const Rect plot{box.x + px(left[i]), box.y + px(head), std::floor(shape[i] * height), height};
        fill_rect(box, color::with_opacity(color::window, 0.92f), px(4));
        draw_text({box.x + px(10), box.y + px(4)}, scale_text, scope_names[i]);
        fill_rect(plot, IM_COL32_BLACK);
        if (frame.status.scopes[i])
            ImGui::GetWindowDrawList()->AddImage(frame.status.scopes[i], plot.corner(), plot.end());
        constexpr std::array scales{draw_values, draw_levels, draw_hues};
        scales[i](plot);
        box.x += box.width + px(gap);
    }
    ImGui::PopFont();
}

namespace {

constexpr float grid_width = 1.0f, box_width = 1.2f, axis_width = 1.6f;  // px at scale 1

/// Depths between which lines fade.
struct DepthRange {
    double near, far;
};

DepthRange depth_range(const Camera& camera, const Bounds& box) {
    const Bounds framed = box_to_frame(box);
    DepthRange range{1e300, -1e300};
    for (int corner = 0; corner < 8; ++corner) {
        const double depth = view_depth(camera, framed.corner(corner));
        range = {std::min(range.near, depth), std::max(range.far, depth)};
    }
    return range;
}

float opacity_at(const DepthRange& range, double depth) {
    constexpr float nearest = 0.9f, farthest = 0.25f;
    const double share = (depth - range.near) / std::max(1e-9, range.far - range.near);
    return nearest + (farthest - nearest) * static_cast<float>(std::clamp(share, 0.0, 1.0));
}

void draw_boxes(const GuiFrame& frame, const Rect& area) {
    const ViewState& view = frame.view;
    if (!view.selected_box && !view.all_boxes) return;
    const Scene now = scene_at(frame.document.scene(), view.frame);
    for (std::size_t i = 0; i < std::min(now.layers.size(), frame.status.layers.size()); ++i) {
        const bool selected = i == view.layer;
        if (!(selected ? view.selected_box || view.all_boxes : view.all_boxes && now.layers[i].visible))
            continue;
        for (const MarkLine& edge : box_edges(frame.status.layers[i].box, now.layers[i].transform))
            draw_deep_line(frame, area, edge.from, edge.to, selected ? color::accent : color::dim, box_width);
    }
}

void draw_grid(const GuiFrame& frame, const Rect& area) {
    for (const MarkLine& line : grid_around(frame.status.box, frame.view.view).lines)
        draw_deep_line(frame, area, line.from, line.to, color::with_opacity(color::dim, 0.45f), grid_width);
}

void draw_axes(const GuiFrame& frame, const Rect& area) {
    constexpr std::array<const char*, 3> names{"x", "y", "z"};
    const auto axes = axis_lines(frame.status.box);
    for (std::size_t i = 0; i < 3; ++i) {
        draw_deep_line(frame, area, axes[i].from, axes[i].to, color::axes[i], axis_width);
        if (const auto end = project_point(*frame.status.viewport_camera, axes[i].to))
            draw_text({area.x + end->x + px(4), area.y + end->y - px(8)}, color::axes[i], names[i]);
    }
}

}  // namespace

void draw_deep_line(const GuiFrame& frame, const Rect& area, const glm::dvec3& from, const glm::dvec3& to,
                    ImU32 ink, float width) {
    constexpr int pieces = 12;
    const Camera& camera = *frame.status.viewport_camera;
    const DepthRange range = depth_range(camera, frame.status.box);
    const float own = static_cast<float>(ink >> IM_COL32_A_SHIFT & 255) / 255.0f;
    for (int i = 0; i < pieces; ++i) {
        const auto at = [&](int n) { return from + (to - from) * (double(n) / pieces); };
        const ImU32 faded =
            color::with_opacity(ink, own * opacity_at(range, view_depth(camera, (at(i) + at(i + 1)) * 0.5)));
        for (const auto& part : project_line(camera, {at(i), at(i + 1)}))
            draw_line({area.x + part[0].x, area.y + part[0].y}, {area.x + part[1].x, area.y + part[1].y},
                      faded, px(width));
    }
}

void draw_view_marks(const GuiFrame& frame, const Rect& area) {
    if (!frame.status.viewport_camera || frame.view.compare == CompareMode::front) return;
    if (frame.view.grid) draw_grid(frame, area);
    if (frame.view.axes) draw_axes(frame, area);
    draw_boxes(frame, area);
}

}  // namespace astrosplat

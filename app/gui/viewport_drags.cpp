// Drags of the mouse in the view, other than the camera: the reference picture, handles, points of the path.
#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "camera/keyframe.h"
#include "edit/placement.h"
#include "gui/viewport.h"
#include "gui/viewport_overlay.h"
#include "gui/widgets.h"
#include "scene/animate.h"

namespace astrosplat {
namespace {

// The reference picture.

constexpr float corner_reach = 12, corner_half = 4;  // px at scale 1

const ReferenceParams& placed(const GuiFrame& frame) {
    return *seen_reference(frame.document.scene(), frame.status);
}

PicturePlace place_now(const GuiFrame& frame, const FrameOnScreen& frame_px) {
    return place_of(placed(frame), frame.status.reference->aspect, frame_px);
}

glm::dvec2 mouse_px() {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    return {mouse.x, mouse.y};
}

void set_place(GuiFrame& frame, const ReferenceParams& reference, Gesture gesture) {
    try_edit([&] {
        const std::size_t index = frame.status.reference->index;
        frame.document.edit(
            "Place reference", [&](Scene& scene) { scene.references[index] = rounded_place(reference); },
            gesture);
    });
}

}  // namespace

bool places_reference(const GuiFrame& frame) {
    const ViewState& view = frame.view;
    return view.placing && compares(view) && view.compare_with == CompareWith::reference &&
           seen_reference(frame.document.scene(), frame.status) && frame.status.reference->aspect > 0.0;
}

void ReferencePlacing::press(const GuiFrame& frame, const FrameOnScreen& frame_px, bool turn) {
    pressed_ = placed(frame);
    pressed_px_ = mouse_px();
    grip_ = turn ? PlaceGrip::turn : grip_at(place_now(frame, frame_px), pressed_px_, px(corner_reach));
    gesture_ = new_gesture();
}

void ReferencePlacing::read(GuiFrame& frame, const FrameOnScreen& frame_px, ViewportInput& input) {
    constexpr double wheel_pause_s = 0.5, notch = 1.05;  // notches in a row are one gesture
    if (input.drag == ViewportInput::Drag::place && !input.drag_begins)
        set_place(frame, dragged(pressed_, grip_, pressed_px_, mouse_px(), frame_px), gesture_);
    if (input.wheel == 0.0f || !input.hovered) return;
    const double now = ImGui::GetTime();
    if (now - wheeled_at_ > wheel_pause_s) wheel_gesture_ = new_gesture();
    wheeled_at_ = now;
    const double factor = std::pow(notch, static_cast<double>(input.wheel));
    set_place(frame, scaled_about(placed(frame), factor, mouse_px(), frame_px), wheel_gesture_);
    input.wheel = 0.0f;
}

void draw_placing(const GuiFrame& frame, const FrameOnScreen& frame_px) {
    const PicturePlace place = place_now(frame, frame_px);
    const glm::dvec2 end = place.corner + place.right + place.down;
    const std::array corners{place.corner, place.corner + place.right, end, place.corner + place.down};
    ImDrawList* list = ImGui::GetWindowDrawList();
    for (const glm::dvec2& c : corners) list->PathLineTo({static_cast<float>(c.x), static_cast<float>(c.y)});
    list->PathStroke(color::attention, ImDrawFlags_Closed, px(1.5f));
    for (const glm::dvec2& c : corners)
        fill_square({float(c.x), float(c.y)}, px(corner_half), color::attention);
}

namespace {

// Handles of the selected thing.

constexpr ImU32 shade = color::with_opacity(IM_COL32_BLACK, 0.55f);  // so that they are seen over white, too

HandleSizes sizes() {
    const HandleSizes standard;
    return {standard.length * double(px(1)), standard.reach * double(px(1))};
}

bool can_be_handled(const GuiFrame& frame) {
    return frame.view.tool != HandleTool::none && frame.status.viewport_camera &&
           frame.view.compare != CompareMode::front;
}

Scene scene_now(const GuiFrame& frame) { return scene_at(frame.document.scene(), frame.view.frame); }

/// The parts of a line that are seen, with a small square at the far end where that is grabbed.
void draw_handle(const Camera& camera, const Rect& area, const std::vector<glm::dvec3>& line, ImU32 ink,
                 bool has_square) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    ImVec2 end{};
    for (const auto& part : project_line(camera, line))
        for (const auto& [own, width] : {std::pair{shade, px(4)}, {ink, px(2)}}) {
            for (const glm::vec2& p : part) list->PathLineTo(end = {area.x + p.x, area.y + p.y});
            list->PathStroke(own, ImDrawFlags_None, width);
        }
    if (has_square) fill_square(end, px(4), ink);
}

void draw_crop(const GuiFrame& frame, const Rect& area, const Scene& now) {
    const ViewState& view = frame.view;
    if (view.handle_target != HandleTarget::crop || view.layer >= now.layers.size()) return;
    const LayerParams& layer = now.layers[view.layer];
    if (view.handle_crop >= layer.look.crop.size()) return;
    for (const auto& line : crop_outline(layer, view.handle_crop))
        for (std::size_t i = 1; i < line.size(); ++i)
            draw_deep_line(frame, area, line[i - 1], line[i], color::attention, 1.4f);
}

}  // namespace

bool Handles::press(const GuiFrame& frame, const glm::dvec2& mouse_px) {
    drag_ = {};
    if (!can_be_handled(frame)) return false;
    pressed_at_frame_ = scene_now(frame);
    const std::optional<Handled> handled = handled_in(pressed_at_frame_, frame.view);
    if (!handled) return false;
    camera_ = *frame.status.viewport_camera;
    drag_ = {grip_at(camera_, *handled, frame.view.tool, mouse_px, sizes()), mouse_px, mouse_px};
    if (drag_.grip == Grip::none) return false;
    edit_.begin(frame.document);
    return true;
}

void Handles::read(GuiFrame& frame, const glm::dvec2& mouse_px, bool dragged) {
    if (!dragged || (drag_.grip != Grip::none && edit_.taken_back(frame))) drag_.grip = Grip::none;
    if (drag_.grip == Grip::none || mouse_px == drag_.to_px) return;
    drag_.to_px = mouse_px;
    try_edit([&] {
        const NewValue value = dragged_value(pressed_at_frame_, frame.view, camera_, drag_);
        frame.document.set(value.key, value.value, frame.view.frame, edit_.gesture());
    });
}

void Handles::draw(const GuiFrame& frame, const Rect& area, const glm::dvec2& mouse_px) const {
    if (!can_be_handled(frame)) return;
    const Scene now = scene_now(frame);
    draw_crop(frame, area, now);
    const std::optional<Handled> handled = handled_in(now, frame.view);
    if (!handled) return;
    const Camera& camera = *frame.status.viewport_camera;
    const auto middle = project_point(camera, handled->origin);
    if (!middle) return;
    const bool drags = drag_.grip != Grip::none;
    const Grip lit = drags ? drag_.grip : grip_at(camera, *handled, frame.view.tool, mouse_px, sizes());
    const auto ink = [&](Grip grip, ImU32 own) { return grip == lit ? color::attention : own; };
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 at{area.x + middle->x, area.y + middle->y};
    const bool as_whole = frame.view.tool == HandleTool::scale && handled->uniform;
    if (as_whole) list->AddCircle(at, float(sizes().length), shade, 64, px(4));
    if (as_whole) list->AddCircle(at, float(sizes().length), ink(Grip::middle, color::text), 64, px(2));
    for (int axis = 0; axis < 3 && !as_whole; ++axis)
        draw_handle(camera, area, handle_line(camera, *handled, frame.view.tool, axis, sizes()),
                    ink(static_cast<Grip>(axis), color::axes[axis]), frame.view.tool != HandleTool::rotate);
    list->AddCircleFilled(at, px(7), shade);
    list->AddCircleFilled(at, px(5), ink(Grip::middle, color::text));
}

namespace {

// How bodies lie.

/// Those that are seen now.
std::vector<LyingRing> seen_rings(const GuiFrame& frame) {
    const ViewState& view = frame.view;
    if (!frame.status.viewport_camera || frame.status.starting || view.compare == CompareMode::front ||
        !frame.status.rendered_frame.empty())
        return {};
    std::vector<LyingRing> rings = lying_rings(scene_now(frame), view.layer);
    if (view.lying || view.start) return rings;
    std::erase_if(rings, [&](const LyingRing& ring) {
        const std::string& row = view.hovered_row;
        return !std::ranges::any_of(lying_keys,
                                    [&](const char* key) { return row == ParameterKey(ring.key) / key; });
    });
    return rings;
}

}  // namespace

bool LyingHandles::press(const GuiFrame& frame, const glm::dvec2& mouse_px) {
    grip_ = {};
    const std::vector<LyingRing> rings = seen_rings(frame);
    if (rings.empty()) return false;
    camera_ = *frame.status.viewport_camera;
    grip_ = grip_at(camera_, rings, mouse_px, sizes().reach);
    if (grip_.of == LyingGrip::Of::none) return false;
    pressed_ = rings[grip_.ring];
    from_px_ = to_px_ = mouse_px;
    edit_.begin(frame.document);
    return true;
}

void LyingHandles::read(GuiFrame& frame, const glm::dvec2& mouse_px, bool is_dragged) {
    if (grip_.of == LyingGrip::Of::none) return;
    const auto set = [&](const LyingRing& ring) {
        try_edit([&] {
            for (const NewValue& value : changed_values(pressed_, ring))
                frame.document.set(value.key, value.value, frame.view.frame, edit_.gesture());
        });
    };
    if (edit_.taken_back(frame)) {
        grip_ = {};
    } else if (!is_dragged) {
        if (grip_.is_mark() && to_px_ == from_px_) set(turned_over(pressed_));
        grip_ = {};
    } else if (mouse_px != to_px_) {
        to_px_ = mouse_px;
        set(dragged(pressed_, grip_.of, camera_, from_px_, to_px_));
    }
}

void LyingHandles::draw(GuiFrame& frame, const Rect& area, const glm::dvec2& mouse_px) const {
    using Of = LyingGrip::Of;
    const std::vector<LyingRing> rings = seen_rings(frame);
    if (rings.empty()) return;
    const Camera& camera = *frame.status.viewport_camera;
    const bool drags = grip_.of != Of::none;
    const LyingGrip lit = drags ? grip_ : grip_at(camera, rings, mouse_px, sizes().reach);
    ImDrawList* const list = ImGui::GetWindowDrawList();
    const auto line = [&](const LyingRing& ring, double from, double to, int pieces, ImU32 ink) {
        std::vector<glm::dvec3> points;
        for (int i = 0; i <= pieces; ++i)
            points.push_back(point_on(ring, from + (to - from) * double(i) / pieces));
        draw_handle(camera, area, points, ink, false);
    };
    for (std::size_t i = 0; i < rings.size(); ++i) {
        const LyingRing& ring = rings[i];
        constexpr ImU32 faint = color::with_opacity(IM_COL32_WHITE, 0.45f);
        line(ring, 180.0, 360.0, 48, faint);
        line(ring, 0.0, 180.0, 48, color::accent);  // the nearer half
        for (const double end : {0.0, 90.0}) {
            const std::vector<glm::dvec3> axis{point_on(ring, end), point_on(ring, end + 180.0)};
            draw_handle(camera, area, axis, faint, false);
        }
        if (ring.about_axis)
            draw_handle(camera, area, {0.5 * (point_on(ring, 0.0) + point_on(ring, 180.0)), axis_end(ring)},
                        color::accent, true);
        for (const SeenGrip& grip : grips_of(camera, ring)) {
            const ImVec2 at{area.x + float(grip.px.x), area.y + float(grip.px.y)};
            note_item(frame, fmt::format("lying {} {}", i, lying_grips[std::size_t(grip.of)].name),
                      {at.x, at.y});
            const bool is_lit = lit == LyingGrip{grip.of, i};
            const ImU32 ink = is_lit ? color::attention : grip.of == Of::near ? color::accent : color::text;
            list->AddCircleFilled(at, px(is_lit ? 8 : 7), shade, 16);
            if (grip.of == Of::near)
                list->AddNgonFilled(at, px(6), ink, 3);
            else if (grip.of == Of::far)
                list->AddNgon(at, px(5), ink, 3, px(1.5f));
            else
                list->AddCircleFilled(at, px(is_lit ? 6 : 5), ink, 16);
        }
    }
    if (lit.of == Of::none || lit.ring >= rings.size()) return;
    if (drags)
        ImGui::SetTooltip("%s", lying_in_words(rings[lit.ring]).c_str());
    else if (!ImGui::IsAnyItemActive() && ImGui::IsItemHovered())
        tooltip(rings[lit.ring].about_axis ? lying_grips[std::size_t(lit.of)].of_equator
                                           : lying_grips[std::size_t(lit.of)].of_disk);
}

// Parts that are selected.

bool Selecting::press(const GuiFrame& frame, const glm::dvec2& mouse_px) {
    const ViewState& view = frame.view;
    points_.clear();
    const bool can = view.select != SelectTool::none && frame.status.viewport_camera &&
                     view.layer < frame.document.scene().layers.size() && view.compare != CompareMode::front;
    if (!can) return false;
    tool_ = view.select;
    radius_px_ = double(px(view.brush_px));
    feather_px_ = double(px(view.feather_px));
    camera_ = *frame.status.viewport_camera;
    const LayerParams layer = scene_now(frame).layers[view.layer];
    layer_ = layer.name;
    placement_ = placement_of(layer.transform);
    points_ = {mouse_px};
    return true;
}

DrawnLine Selecting::drawn() const {
    const double radius = tool_ == SelectTool::brush ? radius_px_ : 0.0;
    if (tool_ != SelectTool::box) return {points_, radius, feather_px_};
    const glm::dvec2 &a = points_.front(), &b = points_.back();
    return {{a, {b.x, a.y}, b, {a.x, b.y}}, radius, feather_px_};
}

void Selecting::read(GuiFrame& frame, const glm::dvec2& mouse_px, bool dragged) {
    if (points_.empty()) return;
    if (key_pressed(key_code::escape)) return points_.clear();
    if (mouse_px != points_.back()) points_.push_back(mouse_px);
    if (dragged) return;
    const DrawnLine line = drawn();
    points_.clear();
    const ViewState& view = frame.view;
    const std::vector<LayerParams>& layers = frame.document.scene().layers;
    const auto layer = std::ranges::find(layers, layer_, &LayerParams::name);
    if (layer == layers.end()) return;
    const std::optional<Crop> crop = crop_behind(camera_, placement_, line);
    if (!crop && tool_ == SelectTool::brush)
        return request_text(frame, Command::Kind::say, "Too wide a part of the view to be drawn at once");
    if (!crop) return;  // a click
    constexpr std::array names{"Erase a part of ", "Keep a part of ", "Part off "};
    const auto index = std::size_t(layer - layers.begin());
    try_edit([&] {
        frame.document.edit(names[std::size_t(view.selection)] + layer_,
                            [&](Scene& scene) { select_part(scene, index, *crop, view.selection); });
    });
}

void Selecting::draw(const GuiFrame& frame, const Rect& area, const glm::dvec2& mouse_px,
                     bool hovered) const {
    if (frame.view.select == SelectTool::none) return;
    ImDrawList* const list = ImGui::GetWindowDrawList();
    const ImU32 ink = frame.view.selection == SelectionFate::erase ? color::error : color::attention;
    const auto at = [&](const glm::dvec2& p) { return ImVec2(area.x + float(p.x), area.y + float(p.y)); };
    const auto path = [&](const DrawnLine& line, ImU32 own, ImDrawFlags flags, float width) {
        for (const glm::dvec2& p : line.points) list->PathLineTo(at(p));
        list->PathStroke(own, flags, width);
    };
    if (!points_.empty() && tool_ == SelectTool::brush) {
        path(drawn(), color::with_opacity(ink, 0.35f), ImDrawFlags_None, 2.0f * float(radius_px_));
    } else if (!points_.empty()) {
        path(drawn(), shade, ImDrawFlags_Closed, px(4));
        path(drawn(), ink, ImDrawFlags_Closed, px(1.5f));
    }
    if (frame.view.select != SelectTool::brush || !(hovered || !points_.empty())) return;
    list->AddCircle(at(mouse_px), px(frame.view.brush_px), shade, 48, px(3));
    list->AddCircle(at(mouse_px), px(frame.view.brush_px), ink, 48, px(1.5f));
}

void draw_select_bar(GuiFrame& frame, const Rect& area) {
    ViewState& view = frame.view;
    if (view.select == SelectTool::none) return;
    constexpr float inset = 10, padding = 6, control = 22, field = 64, space = 8;
    static constexpr std::initializer_list<Segment> tools{
        {"Lasso", "Drag around what is meant (L)"},
        {"Box", "Drag from corner to corner (M)"},
        {"Brush", "Paint over what is meant; [ and ] change its size (Q)"}};
    static constexpr std::initializer_list<Segment> fates{
        {"Erase", "What is drawn around goes: all of it that lies behind, at any depth"},
        {"Keep", "All else goes"},
        {"To a layer", "What is drawn around becomes a layer of its own"}};
    const float whole = segmented_width(tools) + segmented_width(fates) + px(control + 2 * space) +
                        px(2 * (field + space)) + px(2 * padding);
    const float width = std::min(whole, area.width - px(2 * inset));
    if (width < px(100)) return;
    ImGui::SetCursorScreenPos({std::floor(area.x + 0.5f * (area.width - width)), area.y + px(inset)});
    ImGui::PushStyleColor(ImGuiCol_ChildBg, color4(color::with_opacity(color::window, 0.92f)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(padding), px(padding)));
    ImGui::BeginChild("select bar", {width, px(control + 2 * padding)}, false,
                      ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse |
                          ImGuiWindowFlags_AlwaysUseWindowPadding);
    enter_part("select bar");
    push_field_height(px(control));
    const int tool = segmented(frame, "select tool", tools, int(view.select) - 1, control);
    if (tool >= 0) view.select = SelectTool(tool + 1);
    ImGui::SameLine(0, px(space));
    const int fate = segmented(frame, "selection", fates, int(view.selection), control);
    if (fate >= 0) view.selection = SelectionFate(fate);
    ImGui::SameLine(0, px(space));
    drag_field(
        frame, view.brush_px,
        {"brush", 0.25f, 2, 400, "%.0f px", field,
         view.select == SelectTool::brush ? color::text : color::dim, "Radius of the brush ([ and ])"});
    ImGui::SameLine(0, px(space));
    drag_field(frame, view.feather_px,
               {"feather", 0.25f, 0, 400, "~ %.0f px", field, color::dim,
                "Width of the soft edge, at the middle of the layer"});
    ImGui::SameLine(0, px(space));
    if (icon_button("close selecting", Icon::cross, {px(control), px(control)}, px(10), color::dim,
                    "Done (Esc)"))
        view.select = SelectTool::none;
    note_item(frame, "close selecting");
    ImGui::PopStyleVar();
    ImGui::EndChild();
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
}

namespace {

// Points of the camera's path.

constexpr float path_reach = 8, least_handle = 6;  // px at scale 1
const std::string path_key = "camera.position";

Handle<glm::dvec3> handle_of(const std::vector<Keyframe<glm::dvec3>>& keyframes, std::size_t i,
                             HandleSide side, Ends ends) {
    return side == HandleSide::in ? handle_before(std::span(keyframes), i, ends)
                                  : handle_after(std::span(keyframes), i, ends);
}

/// The mouse's last move at a point of the world: in the plane of the view, or along its axis.
glm::dvec3 moved_by_mouse(const Camera& camera, const glm::dvec3& point) {
    const ImGuiIO& io = ImGui::GetIO();
    const double unit = units_per_px(camera, point);
    const double dx = static_cast<double>(io.MouseDelta.x), dy = static_cast<double>(io.MouseDelta.y);
    if (io.KeyShift) return camera.world_from_camera[2] * (dy * unit);
    return camera.world_from_camera[0] * (dx * unit) - camera.world_from_camera[1] * (dy * unit);
}

}  // namespace

std::vector<PathPoints::Place> PathPoints::places(const GuiFrame& frame, const Rect& area) {
    std::vector<Place> result;
    const ViewState& view = frame.view;
    const Track* const track = find_track(frame.document.scene(), path_key);
    if (!track || !frame.status.viewport_camera || view.view == ViewKind::camera || !view.camera_path)
        return result;
    const std::vector<Keyframe<glm::dvec3>> keyframes = position_keyframes(*track);
    const auto add = [&](const PathGrip& grip, const glm::dvec3& point, const glm::dvec3& from,
                         double frames) {
        const auto at = project_point(*frame.status.viewport_camera, point);
        const auto start = project_point(*frame.status.viewport_camera, from);
        const glm::vec2 corner(area.x, area.y);
        if (!at || !start) return;
        if (grip.side && glm::distance(*at, *start) < px(least_handle)) return;  // it lies on its keyframe
        result.push_back({grip, point, frames, corner + *at, corner + *start});
    };
    for (std::size_t i = 0; i < keyframes.size(); ++i) {
        const Keyframe<glm::dvec3>& k = keyframes[i];
        add({k.frame, {}}, k.value, k.value, 0.0);
        for (const HandleSide side : {HandleSide::in, HandleSide::out}) {
            if (!has_handle(*track, i, side)) continue;
            const Handle<glm::dvec3> h = handle_of(keyframes, i, side, track->ends);
            add({k.frame, side}, k.value + h.value, k.value, h.frames);
        }
    }
    return result;
}

const PathPoints::Place* PathPoints::nearest(const std::vector<Place>& places) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const Place* found = nullptr;
    float reach = px(path_reach);
    for (const Place& place : places) {
        const float distance = glm::distance(place.px, glm::vec2(mouse.x, mouse.y));
        if (distance > reach) continue;
        reach = distance;
        found = &place;
    }
    return found;
}

bool PathPoints::press(GuiFrame& frame, const Rect& area) {
    const std::vector<Place> all = places(frame, area);
    const Place* const found = nearest(all);
    if (!found) return false;
    held_ = found->grip;
    pressed_at_ = found->point;
    frames_ = found->frames;
    moved_ = glm::dvec3(0.0);
    edit_.begin(frame.document);
    frame.view.graph_parameter = path_key;
    return true;
}

void PathPoints::drag(GuiFrame& frame) {
    if (held_ && edit_.taken_back(frame)) held_.reset();
    if (!held_ || !frame.status.viewport_camera) return;
    const glm::dvec3 step = moved_by_mouse(*frame.status.viewport_camera, pressed_at_ + moved_);
    if (step == glm::dvec3(0.0)) return;
    moved_ += step;
    const glm::dvec3 at = pressed_at_ + moved_;
    try_edit([&] {
        frame.document.edit(
            held_->side ? "Bend camera path" : "Move camera keyframe",
            [&](Scene& scene) {
                if (!held_->side)
                    return set_keyframe(scene, path_key, held_->frame, Value::List{at.x, at.y, at.z});
                for (const auto& k : position_keyframes(*find_track(scene, path_key))) {
                    if (k.frame != held_->frame) continue;
                    const glm::dvec3 v = at - k.value;
                    set_handle(scene, path_key, k.frame, *held_->side, frames_, {v.x, v.y, v.z});
                }
            },
            edit_.gesture());
    });
}

void PathPoints::release(GuiFrame& frame) {
    if (held_ && !held_->side && moved_ == glm::dvec3(0.0)) frame.view.frame = held_->frame;
    held_.reset();
}

void PathPoints::draw(GuiFrame& frame, const Rect& area) const {
    const std::vector<Place> all = places(frame, area);
    const Place* const under = held_ ? nullptr : nearest(all);
    ImDrawList* const list = ImGui::GetWindowDrawList();
    for (const Place& place : all) {
        const ImVec2 at{place.px.x, place.px.y};
        const bool lit = held_ ? *held_ == place.grip : under == &place;
        const char* const side = !place.grip.side                     ? "point"
                                 : *place.grip.side == HandleSide::in ? "in"
                                                                      : "out";
        note_item(frame, fmt::format("path {} {:g}", side, place.grip.frame), place.px);
        if (place.grip.side) {
            draw_line({place.from.x, place.from.y}, at, color::with_opacity(color::text, 0.6f), px(1));
            list->AddCircleFilled(at, px(lit ? 5 : 3.5f), color::text, 16);
            continue;
        }
        const bool now = place.grip.frame == frame.view.frame;
        const float half = px(lit ? 6 : 4.5f);
        fill_square(at, half + px(1), color::line);
        fill_square(at, half, now || lit ? color::text : color::attention);
    }
    if (under && !ImGui::IsAnyItemActive() && !under->grip.side)
        tooltip(fmt::format("Frame {:g}. Drag moves it in the plane of the view, Shift along its axis",
                            under->grip.frame)
                    .c_str());
}

}  // namespace astrosplat

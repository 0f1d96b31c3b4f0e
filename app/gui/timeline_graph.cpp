// The graph: curves over the frames, keyframes and handles to drag, channels to hide.
#include <fmt/format.h>

#include "edit/edits.h"
#include "gui/timeline.h"
#include "gui/widgets.h"
#include "scene/animate.h"

namespace astrosplat {
namespace {

using Drag = TimelineState::Drag;
constexpr float key_reach = 7, sample_px = 3, margin_y = 10;

std::string axis_text(double value, double span) {
    return fmt::format("{:.{}f}", value, span >= 100 ? 0 : span >= 10 ? 1 : span >= 1 ? 2 : 3);
}

float y_of(const TimelineState& t, double value, const Rect& area) {
    const double share = (value - t.graph.low) / (t.graph.high - t.graph.low);
    return area.end().y - px(margin_y) - static_cast<float>(share) * (area.height - 2 * px(margin_y));
}

double value_at(const TimelineState& t, float y, const Rect& area) {
    const float share = (area.end().y - px(margin_y) - y) / (area.height - 2 * px(margin_y));
    return t.graph.low + static_cast<double>(share) * (t.graph.high - t.graph.low);
}

void fit_values(TimelineState& t) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t c = 0; c < t.graph.samples.size(); ++c) {
        if (t.graph.of.hidden[c]) continue;
        const auto [least, most] = std::ranges::minmax(t.graph.samples[c]);
        low = std::min(low, least);
        high = std::max(high, most);
    }
    if (!(low <= high)) low = 0.0, high = 1.0;
    const double least = std::max(1e-6, 1e-3 * std::max(std::fabs(low), std::fabs(high)));
    const double pad = std::max(least - (high - low), 0.0) * 0.5;
    t.graph.low = low - pad;
    t.graph.high = high + pad;
}

void sample_graph(TimelineState& t, const Track& track, const ParameterSpec& spec, const ViewState& view,
                  std::uint64_t revision) {
    TimelineState::Graph::Of of{track.key, revision, t.scale, {}};
    for (std::size_t c = 0; c < track.keyframes.front().value.size(); ++c)
        of.hidden.push_back(channel_hidden(view, track, c));
    if (t.graph.of == of) return;
    t.graph.zoomed = t.graph.zoomed && t.graph.of.key == of.key;
    t.graph.of = of;
    t.graph.samples.assign(track.keyframes.front().value.size(), {});
    const int count = std::max(2, static_cast<int>((t.scale.x1 - t.scale.x0) / px(sample_px)));
    for (int i = 0; i <= count; ++i) {
        const double frame = t.scale.first + (t.scale.last - t.scale.first) * i / count;
        const std::vector<double> numbers = track_at(track, spec, frame);
        for (std::size_t c = 0; c < t.graph.samples.size(); ++c) t.graph.samples[c].push_back(numbers[c]);
    }
    const bool dragged = t.drag == Drag::value || t.drag == Drag::handle;
    if (!dragged && !t.graph.zoomed) fit_values(t);  // the axis stands still under the mouse
}

void edit_by_drag(TimelineState& t, GuiFrame& frame, const std::string& name,
                  const std::function<void(Scene&)>& change) {
    if (t.edit.taken_back(frame))
        t.drag = Drag::none;
    else
        try_edit([&] { frame.document.edit(name, change, t.edit.gesture()); });
}

void drag_value(TimelineState& t, GuiFrame& frame, const Track& track, const Rect& area) {
    const double value = value_at(t, ImGui::GetIO().MousePos.y, area);
    const ParameterSpec& spec = t.specs.at(track.key);
    edit_by_drag(t, frame, "Keyframe of " + spec.label, [&](Scene& scene) {
        for (const auto& keyframe : track.keyframes) {
            if (keyframe.frame != t.graph.grabbed_keyframe) continue;
            std::vector<double> numbers = keyframe.value;
            numbers[t.graph.component] = value;
            set_keyframe(scene, track.key, keyframe.frame, from_numbers(spec, numbers));
        }
    });
}

/// The other channels of the handle keep their slopes; with Alt it is broken from the other one.
void drag_handle(TimelineState& t, GuiFrame& frame, const Track& track, const Rect& area) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto found =
        std::ranges::find(track.keyframes, t.graph.grabbed_keyframe, &Keyframe<std::vector<double>>::frame);
    if (found == track.keyframes.end()) return;
    const ParameterSpec& spec = t.specs.at(track.key);
    const TrackHandles handles =
        handles_of(track, spec)[static_cast<std::size_t>(found - track.keyframes.begin())];
    const Handle<std::vector<double>>& held = t.graph.side == HandleSide::in ? handles.in : handles.out;
    const double frames = t.scale.frame_at(io.MousePos.x) - found->frame;
    std::vector<double> numbers = held.value;
    if (held.frames != 0.0 && frames * held.frames > 0.0)
        for (double& number : numbers) number *= frames / held.frames;
    numbers[t.graph.component] = value_at(t, io.MousePos.y, area) - found->value[t.graph.component];
    edit_by_drag(t, frame, "Handle of " + spec.label, [&](Scene& scene) {
        if (io.KeyAlt) set_broken(scene, track.key, found->frame, true);
        set_handle(scene, track.key, found->frame, t.graph.side, frames, numbers);
    });
}

void grab(TimelineState& t, const GuiFrame& frame, Drag drag, double keyframe, std::size_t component) {
    t.drag = drag;
    t.edit.begin(frame.document);
    t.graph.grabbed_keyframe = keyframe;
    t.graph.component = component;
}

bool is_near(ImVec2 at) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    return std::hypot(at.x - mouse.x, at.y - mouse.y) <= px(key_reach);
}

/// Of the selected keyframes, where they have a Bezier segment.
void draw_handles(TimelineState& t, GuiFrame& frame, const Track& track, const Rect& area) {
    const bool hovered = ImGui::IsItemHovered();
    const std::vector<TrackHandles> handles = handles_of(track, t.specs.at(track.key));
    for (std::size_t i = 0; i < handles.size(); ++i) {
        const auto& keyframe = track.keyframes[i];
        if (!is_selected(t, {track.key, keyframe.frame})) continue;
        for (const HandleSide side : {HandleSide::in, HandleSide::out}) {
            if (!has_handle(track, i, side)) continue;
            const Handle<std::vector<double>>& h = side == HandleSide::in ? handles[i].in : handles[i].out;
            for (std::size_t c = 0; c < keyframe.value.size(); ++c) {
                if (t.graph.of.hidden[c]) continue;
                const ImVec2 from{t.scale.x_of(keyframe.frame), y_of(t, keyframe.value[c], area)};
                const ImVec2 at{t.scale.x_of(keyframe.frame + h.frames),
                                y_of(t, keyframe.value[c] + h.value[c], area)};
                const bool near = hovered && is_near(at);
                draw_line(from, at, color::with_opacity(color::text, 0.55f), px(1));
                fill_square(at, px(3), near ? color::attention : color::text);
                note_item(frame,
                          fmt::format("handle {} {:g} {} {}", track.key, keyframe.frame, c,
                                      side == HandleSide::in ? "in" : "out"),
                          {at.x, at.y});
                if (near && t.drag == Drag::none && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
                    grab(t, frame, Drag::handle, keyframe.frame, c);
                    t.graph.side = side;
                }
            }
        }
    }
}

/// Wheel: values; with Ctrl: frames. The middle button moves both, a double click shows all.
void zoom_and_pan(TimelineState& t, const Rect& area) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsItemHovered();
    if (hovered && io.MouseWheel != 0.0f) {
        const double factor = zoom_of(io.MouseWheel);
        const double middle = value_at(t, io.MousePos.y, area);
        if (io.KeyCtrl) {
            zoom_frames(t, t.scale.frame_at(io.MousePos.x), factor);
        } else if ((t.graph.high - t.graph.low) * factor > 1e-9) {
            t.graph.low = middle - (middle - t.graph.low) * factor;
            t.graph.high = middle + (t.graph.high - middle) * factor;
            t.graph.zoomed = true;
        }
    }
    if (hovered && t.drag == Drag::none && io.MouseDoubleClicked[ImGuiMouseButton_Left])
        t.graph.zoomed = t.zoomed = false;
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Middle)) t.drag = Drag::pan;
    if (t.drag != Drag::pan) return;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Middle)) {
        t.drag = Drag::none;
        return;
    }
    const double values =
        value_at(t, io.MousePos.y - io.MouseDelta.y, area) - value_at(t, io.MousePos.y, area);
    const double frames = t.scale.frame_at(io.MousePos.x - io.MouseDelta.x) - t.scale.frame_at(io.MousePos.x);
    t.graph.low += values;
    t.graph.high += values;
    t.scale.first += frames;
    t.scale.last += frames;
    t.graph.zoomed = t.zoomed = true;
}

void draw_graph_keyframes(TimelineState& t, GuiFrame& frame, const Track& track, const Rect& area) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const bool hovered = ImGui::IsItemHovered();
    for (const auto& keyframe : track.keyframes) {
        const KeyframePlace place{track.key, keyframe.frame};
        const bool selected = is_selected(t, place);
        for (std::size_t c = 0; c < keyframe.value.size(); ++c) {
            if (t.graph.of.hidden[c]) continue;
            const ImVec2 at{t.scale.x_of(keyframe.frame), y_of(t, keyframe.value[c], area)};
            const bool held =
                t.drag == Drag::value && t.graph.grabbed_keyframe == keyframe.frame && t.graph.component == c;
            const bool near = hovered && is_near(at);
            if (near && t.drag == Drag::none && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
                grab(t, frame, Drag::value, keyframe.frame, c);
                select_keyframe(t, place);
            }
            if (near && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
                if (!selected) t.selected = {place};
                ImGui::OpenPopup("keyframe menu");
            }
            list->AddCircleFilled(at, px(held || near ? 5.5f : 4.5f), selected ? color::text : color::line,
                                  16);
            list->AddCircleFilled(at, px(held || near ? 4.5f : 3.5f), color::attention, 16);
            note_item(frame, fmt::format("graph {} {:g} {}", track.key, keyframe.frame, c), {at.x, at.y});
            if (near && t.drag == Drag::none)
                tooltip(fmt::format("Frame {:g}: {:.4g}", keyframe.frame, keyframe.value[c]).c_str());
        }
    }
}

}  // namespace

void draw_graph(TimelineState& t, GuiFrame& frame, const Rect& area) {
    const Scene& scene = frame.document.scene();
    if (!find_track(scene, frame.view.graph_parameter))
        frame.view.graph_parameter = scene.animation.front().key;
    const Track track = *find_track(scene, frame.view.graph_parameter);
    const auto spec = t.specs.find(track.key);
    if (spec == t.specs.end()) return;
    sample_graph(t, track, spec->second, frame.view, frame.document.revision());
    ImDrawList* list = ImGui::GetWindowDrawList();
    fill_rect(area, color::window);
    ImGui::PushFont(small_font());
    for (const double value : {t.graph.low, 0.5 * (t.graph.low + t.graph.high), t.graph.high}) {
        const float y = y_of(t, value, area);
        const std::string text = axis_text(value, t.graph.high - t.graph.low);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        line_across(area.x, area.end().x, y, color::with_opacity(color::field, 0.8f));
        draw_text({area.x - px(8) - size.x, std::floor(y - size.y * 0.5f)}, color::dim, text);
    }
    ImGui::PopFont();
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::InvisibleButton("graph", {std::max(area.width, 1.0f), std::max(area.height, 1.0f)},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    note_item(frame, "graph area");
    zoom_and_pan(t, area);
    ImGui::PushClipRect(area.corner(), area.end(), true);
    for (std::size_t c = 0; c < t.graph.samples.size(); ++c) {
        if (t.graph.of.hidden[c]) continue;
        const std::vector<double>& samples = t.graph.samples[c];
        const auto last = static_cast<float>(samples.size() - 1);
        for (std::size_t i = 0; i < samples.size(); ++i)
            list->PathLineTo({t.scale.x0 + (t.scale.x1 - t.scale.x0) * static_cast<float>(i) / last,
                              y_of(t, samples[i], area)});
        list->PathStroke(channel_color(c, t.graph.samples.size()), ImDrawFlags_None, px(1.5f));
    }
    draw_handles(t, frame, track, area);
    draw_graph_keyframes(t, frame, track, area);
    ImGui::PopClipRect();
    if (t.drag == Drag::value) drag_value(t, frame, track, area);
    if (t.drag == Drag::handle) drag_handle(t, frame, track, area);
}

namespace {

constexpr float letter_width = 18;
constexpr std::size_t most_letters = 4;  // of curves the first ones

std::string channel_key(const Track& track, std::size_t channel) {
    return fmt::format("{} {}", track.key, channel);
}

std::size_t letters(const Track& track) { return std::min(track.keyframes[0].value.size(), most_letters); }

/// "X", "G"; numbered from 1 where they have no names.
std::string channel_name(const ParameterSpec& spec, std::size_t channel) {
    const char* const names = spec.type == ParameterType::color   ? "RGB"
                              : spec.type == ParameterType::curve ? ""
                                                                  : "XYZW";
    return channel < std::string(names).size() ? std::string(1, names[channel]) : std::to_string(channel + 1);
}

void show_alone_or_all(ViewState& view, const Track& track, std::size_t channel) {
    bool alone = !channel_hidden(view, track, channel);
    for (std::size_t other = 0; other < track.keyframes[0].value.size(); ++other)
        alone = alone && (other == channel || channel_hidden(view, track, other));
    for (std::size_t other = 0; other < track.keyframes[0].value.size(); ++other) {
        view.hidden_channels.erase(channel_key(track, other));
        if (!alone && other != channel) view.hidden_channels.insert(channel_key(track, other));
    }
}

}  // namespace

unsigned channel_color(std::size_t channel, std::size_t count) {
    constexpr ImU32 colors[4] = {IM_COL32(0xC9, 0x84, 0x7C, 255), IM_COL32(0x84, 0xB3, 0x8A, 255),
                                 IM_COL32(0x84, 0x9C, 0xC9, 255), IM_COL32(0xB0, 0xA0, 0xBE, 255)};
    return count == 1 ? color::text : colors[channel % 4];
}

bool channel_hidden(const ViewState& view, const Track& track, std::size_t channel) {
    return view.hidden_channels.contains(channel_key(track, channel));
}

float channels_width(const Track& track) { return px(letter_width) * static_cast<float>(letters(track)); }

void draw_channels(GuiFrame& frame, const Track& track, const ParameterSpec& spec, float x, float y,
                   float height) {
    const std::size_t count = track.keyframes[0].value.size();
    for (std::size_t c = 0; c < letters(track); ++c) {
        const std::string name = channel_name(spec, c), key = channel_key(track, c);
        const float left = x + px(letter_width) * static_cast<float>(c);
        ImGui::SetCursorScreenPos({left, y});
        if (ImGui::InvisibleButton(name.c_str(), {px(letter_width), height})) {
            if (ImGui::GetIO().KeyShift)
                show_alone_or_all(frame.view, track, c);
            else if (frame.view.hidden_channels.erase(key) == 0)
                frame.view.hidden_channels.insert(key);
        }
        note_item(frame, "channel " + key);
        const bool hidden = channel_hidden(frame.view, track, c);
        tooltip((hidden ? "Show " + name : "Hide " + name + ". Shift+click: it alone").c_str());
        const ImVec2 size = ImGui::CalcTextSize(name.c_str());
        const ImVec2 at{std::floor(left + 0.5f * (px(letter_width) - size.x)),
                        y + std::floor(0.5f * (height - size.y))};
        const ImU32 shade = channel_color(c, count);
        draw_text(at, hidden ? color::with_opacity(shade, 0.35f) : shade, name);
        if (hidden) line_across(at.x - px(2), at.x + size.x + px(2), at.y + 0.5f * size.y, color::dim);
    }
}

}  // namespace astrosplat

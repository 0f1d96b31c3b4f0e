#include "gui/timeline_channels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float letter_width = 18;
constexpr std::size_t most_letters = 4;  // of curves the first ones

std::string channel_key(const Track& track, std::size_t channel) {
    return fmt::format("{} {}", track.key, channel);
}

std::size_t letters(const Track& track) { return std::min(track.keyframes[0].value.size(), most_letters); }

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

std::string channel_name(const ParameterSpec& spec, std::size_t channel) {
    const char* const names = spec.type == ParameterType::color   ? "RGB"
                              : spec.type == ParameterType::curve ? ""
                                                                  : "XYZW";
    return channel < std::string(names).size() ? std::string(1, names[channel]) : std::to_string(channel + 1);
}

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
        ImDrawList* const list = ImGui::GetWindowDrawList();
        list->AddText(at, hidden ? color::with_opacity(shade, 0.35f) : shade, name.c_str());
        if (hidden)
            list->AddLine({at.x - px(2), at.y + 0.5f * size.y}, {at.x + size.x + px(2), at.y + 0.5f * size.y},
                          color::dim);
    }
}

}  // namespace astrosplat

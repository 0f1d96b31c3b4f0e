// Grounds, bars, curves and captions; the samples come from shaders/shared.
#include "gui/panel/plot.h"

#include <algorithm>
#include <cmath>

#include "gui/theme.h"
#include "look/prepare.h"
#include "look/shared_look.h"
#include "render/falloff.h"

namespace astrosplat::panel {
namespace {

constexpr int samples = 128;

template <class Function>
std::vector<float> sampled(Function function) {
    std::vector<float> values(samples);
    for (int i = 0; i < samples; ++i)
        values[static_cast<std::size_t>(i)] = function(static_cast<float>(i) / float(samples - 1));
    return values;
}

}  // namespace

Area begin_plot(float height) {
    const Area area{ImGui::GetCursorScreenPos(), {ImGui::GetContentRegionAvail().x, px(height)}};
    ImGui::GetWindowDrawList()->AddRectFilled(area.corner, area.end(), color::window, px(3));
    ImGui::Dummy(area.size);
    return area;
}

void draw_bars(const Area& area, std::span<const float> shares, double stretch) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float width = area.size.x * static_cast<float>(stretch) / static_cast<float>(shares.size());
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const float left = area.corner.x + width * static_cast<float>(i);
        if (left >= area.end().x) break;
        const float gap = width >= px(4) ? 1.0f : 0.0f;
        const float right = std::min(left + width - gap, area.end().x);
        const float top = area.end().y - (area.size.y - px(4)) * std::clamp(shares[i], 0.0f, 1.0f);
        if (shares[i] > 0.0f) list->AddRectFilled({left, top}, {right, area.end().y}, color::hover);
    }
}

void draw_curve(const Area& area, std::span<const float> values, float top, ImU32 color, float stretch) {
    if (values.size() < 2) return;
    std::vector<ImVec2> line;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float x = stretch * static_cast<float>(i) / static_cast<float>(values.size() - 1);
        if (x > 1.0f) break;
        const float y = std::clamp(values[i] / top, 0.0f, 1.0f);
        line.push_back({area.corner.x + x * area.size.x, area.end().y - px(2) - y * (area.size.y - px(5))});
    }
    ImGui::GetWindowDrawList()->AddPolyline(line.data(), static_cast<int>(line.size()), color,
                                            ImDrawFlags_None, px(1.6f));
}

void captions(const std::string& left, const std::string& right) {
    ImGui::PushFont(small_font());
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddText(corner, color::dim, left.c_str());
    list->AddText({corner.x + width - ImGui::CalcTextSize(right.c_str()).x, corner.y}, color::dim,
                  right.c_str());
    ImGui::Dummy({width, ImGui::GetFontSize() + px(4)});
    ImGui::PopFont();
}

std::vector<float> density_samples(const DensityCurve& pdf) {
    if (pdf.points.size() > std::size_t(shared::LOOK_MAX_POINTS)) return {};  // the look says why
    const LookProfile profile = density_profile(pdf, "points");
    return sampled([&](float x) { return shared::look_profile(profile, x); });
}

std::vector<float> vertical_samples(const VerticalAlpha& vertical) {
    if (vertical.points.size() > std::size_t(shared::LOOK_MAX_POINTS)) return {};
    const LookProfile profile = vertical_profile(vertical);
    return sampled([&](float x) { return shared::look_profile(profile, x); });
}

std::vector<float> alpha_samples(const HorizontalAlpha& alpha) {
    const LookAlpha step = horizontal_step(alpha);
    return sampled([&](float x) { return shared::look_horizontal(x, step); });
}

std::vector<float> falloff_samples(const Falloff& falloff) {
    return sampled([&](float t) { return static_cast<float>(falloff_value(falloff, double(t))); });
}

}  // namespace astrosplat::panel

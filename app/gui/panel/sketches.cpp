// Small sketches of what numbers mean: a dot, the angles of a hybrid, the field of a noise.
#include "gui/panel/sketches.h"

#include <algorithm>
#include <cmath>

#include "core/color.h"
#include "core/real.h"
#include "gui/panel/plot.h"
#include "gui/panel/words.h"
#include "gui/theme.h"
#include "look/shared_look.h"
#include "render/falloff.h"

namespace astrosplat::panel {
namespace {

// Linear light as an opaque grey of the screen.
ImU32 grey(double light) {
    const double encoded = real::linear_to_srgb(std::clamp(light, 0.0, 1.0));
    const int byte = static_cast<int>(std::lround(encoded * 255.0));
    return IM_COL32(byte, byte, byte, 255);
}

void draw_dot(const Area& area, const Falloff& falloff) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(area.corner, area.end(), IM_COL32_BLACK, px(3));
    const float radius = area.size.y * 0.5f - px(4);
    const int rings = static_cast<int>(radius);
    for (int i = 0; i < rings; ++i) {
        const double t = 1.0 - (double(i) + 0.5) / double(rings);
        list->AddCircleFilled(area.middle(), radius * static_cast<float>(1.0 - double(i) / double(rings)),
                              grey(falloff_value(falloff, t)), 48);
    }
}

ImVec2 on_arc(ImVec2 origin, float radius, double from_axis_deg) {
    const glm::dvec2 up = {real::sin(from_axis_deg * real::pi / 180.0),
                           real::cos(from_axis_deg * real::pi / 180.0)};
    return {origin.x + radius * static_cast<float>(up.x), origin.y - radius * static_cast<float>(up.y)};
}

void sector(ImVec2 origin, float radius, double from_deg, double to_deg, ImU32 color) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PathLineTo(origin);
    const int steps = std::max(2, static_cast<int>((to_deg - from_deg) / 3.0));
    for (int i = 0; i <= steps; ++i)
        list->PathLineTo(on_arc(origin, radius, from_deg + (to_deg - from_deg) * i / steps));
    list->PathFillConvex(color);
}

constexpr float cell = 4.0f;  // px at scale 1

// Field values at the corners of the cells, as greys.
std::vector<ImU32> noise_greys(const Noise& noise, int columns, int rows, double span) {
    float sum = 0.0f, amplitude = 1.0f;
    for (int i = 0; i < noise.octaves; ++i, amplitude *= noise.gain) sum += std::fabs(amplitude);
    const float step = static_cast<float>(span / columns);
    std::vector<ImU32> greys;
    for (int y = 0; y <= rows; ++y)
        for (int x = 0; x <= columns; ++x) {
            const float n =
                shared::as_fbm(float(x) * step, 0.0f, float(y) * step, noise.frequency,
                               std::min(noise.octaves, shared::AS_NOISE_MAX_OCTAVES), noise.lacunarity,
                               noise.gain, 1.0f / sum, static_cast<std::uint32_t>(noise.seed));
            const int byte =
                static_cast<int>(std::lround(128.0f + 127.0f * std::clamp(n * 1.4f, -1.0f, 1.0f)));
            greys.push_back(IM_COL32(byte, byte, byte, 255));
        }
    return greys;
}

bool same_field(const Noise& a, const Noise& b) {
    return a.frequency == b.frequency && a.octaves == b.octaves && a.lacunarity == b.lacunarity &&
           a.gain == b.gain && a.seed == b.seed;
}

}  // namespace

void draw_falloff(const Falloff& falloff) {
    const Area area = begin_plot();
    const Area dot{area.corner, {area.size.y, area.size.y}};
    draw_dot(dot, falloff);
    const Area curve{{dot.end().x + px(4), area.corner.y}, {area.size.x - dot.size.x - px(4), area.size.y}};
    draw_curve(curve, falloff_samples(falloff), 1.05f, color::accent);
    captions("", "rim");
}

void draw_hybrid(float from_deg, float to_deg) {
    const Area area = begin_plot(72.0f);
    const float radius = area.size.y - px(16);
    const ImVec2 origin{area.middle().x - radius * 0.5f, area.end().y - px(8)};
    const double from = std::clamp(double(from_deg), 0.0, 90.0), to = std::clamp(double(to_deg), from, 90.0);
    sector(origin, radius, 0.0, from, color::with_opacity(color::dim, 0.35f));
    constexpr int steps = 12;
    for (int i = 0; i < steps; ++i) {
        const double a = from + (to - from) * i / steps, b = from + (to - from) * (i + 1) / steps;
        sector(origin, radius, a, b, color::with_opacity(color::accent, 0.1f + 0.5f * float(i) / steps));
    }
    sector(origin, radius, to, 90.0, color::with_opacity(color::accent, 0.65f));
    ImGui::GetWindowDrawList()->AddLine({origin.x - radius, origin.y + px(3)},
                                        {origin.x + radius, origin.y + px(3)}, color::text, px(2));
    captions("over seen face-on", "screen seen edge-on");
}

void draw_noise(Context& context, std::size_t entry, const Noise& noise, double span) {
    const Area area = begin_plot(56.0f);
    const int columns = std::max(1, static_cast<int>(area.size.x / px(cell)));
    const int rows = static_cast<int>(area.size.y / px(cell));
    context.memory.noises.resize(std::max(context.memory.noises.size(), entry + 1));
    NoiseSketch& sketch = context.memory.noises[entry];
    if (sketch.columns != columns || sketch.span != span || !same_field(sketch.noise, noise))
        sketch = {noise, span, columns, noise_greys(noise, columns, rows, span)};
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 size{area.size.x / float(columns), area.size.y / float(rows)};
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const ImVec2 corner{area.corner.x + size.x * float(x), area.corner.y + size.y * float(y)};
            const auto at = static_cast<std::size_t>(y * (columns + 1) + x);
            const auto below = at + static_cast<std::size_t>(columns + 1);
            list->AddRectFilledMultiColor(corner, {corner.x + size.x, corner.y + size.y}, sketch.greys[at],
                                          sketch.greys[at + 1], sketch.greys[below + 1], sketch.greys[below]);
        }
    captions(figures(span) + " scene units across", "");
}

}  // namespace astrosplat::panel

// The drawings above rows: levels, profiles, a splat, sectors, a noise; and what stands for a value that is
// not set.
#include "gui/panel/parts.h"

#include <fmt/format.h>

#include <map>

#include "core/color.h"
#include "core/real.h"
#include "core/text.h"
#include "edit/edits.h"
#include "generate/lattice.h"
#include "look/prepare.h"
#include "look/shared_look.h"
#include "render/footprint.h"
#include "scene/detail_tiles.h"

namespace astrosplat::panel {
namespace {

// Histogram of the picture's values with black and white point to drag.

using Values = LayerHistograms::Values;

double value_or(Context& context, const ParameterKey& key, double automatic) {
    const Parameter* parameter = find(context, key);
    const Value value = parameter ? parameter->get() : Value();
    return value.is_number() ? value.number() : automatic;
}

float place(const Rect& area, const Values& values, double value) {
    const double share = (value - values.lo) / std::max(values.hi - values.lo, 1e-30);
    return area.x + area.width * static_cast<float>(std::clamp(share, 0.0, 1.0));
}

// One handle: a line with a foot; returns true while it is dragged, with the value under the mouse.
bool handle(Context& context, const Rect& area, const Values& values, const char* id, double& value) {
    const float x = place(area, values, value), reach = px(6);
    ImGui::SetCursorScreenPos({x - reach, area.y});
    ImGui::InvisibleButton(id, {reach * 2.0f, area.height});
    if (ImGui::IsItemActivated()) begin_gesture(context);
    const bool active = ImGui::IsItemActive(), near = active || ImGui::IsItemHovered();
    if (near) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 ink = near ? color::accent : color::text;
    line_down(x, area.y, area.end().y, ink, px(1));
    const float foot = std::floor(area.end().y);
    list->AddTriangleFilled({x, foot - px(8)}, {x + px(5), foot}, {x - px(5), foot}, ink);
    if (!active || ImGui::GetIO().MouseDelta.x == 0.0f) return false;
    const double range = values.hi - values.lo;
    value = rounded_to_step(values.lo + double(share_at_mouse(area)) * range, range * 1e-3);
    return true;
}

/// Spread of the picture's values; black and white are dragged on it.
void edit_levels(Context& context, const ParameterSpec&) {
    const auto& histograms = context.layer_status().histograms;
    if (!histograms || histograms->values.share.empty()) return;
    const Values& values = histograms->values;
    const ParameterKey source = context.layer_key() / "source";
    double black = value_or(context, source / "black", values.black);
    double white = value_or(context, source / "white", values.white);
    const Rect area = begin_plot();
    const ImVec2 below = ImGui::GetCursorScreenPos();
    context.memory.plots[source / "black"] = area;
    draw_bars(area, values.share);
    const ImU32 shade = color::with_opacity(color::window, 0.6f);
    fill_rect(area.corner(), {place(area, values, black), area.end().y}, shade);
    fill_rect({place(area, values, white), area.y}, area.end(), shade);
    const double least = (values.hi - values.lo) * 2e-3;
    if (handle(context, area, values, "black", black))
        set_value(context, source / "black", std::min(black, white - least), context.memory.gesture);
    if (handle(context, area, values, "white", white))
        set_value(context, source / "white", std::max(white, black + least), context.memory.gesture);
    ImGui::SetCursorScreenPos(below);
    captions(figures(values.lo), figures(values.hi));
}

// Samples for draw_curve: of the look and the renderer, not copies.

constexpr int samples = 128;

template <class Function>
std::vector<float> sampled(Function function) {
    std::vector<float> values(samples);
    for (int i = 0; i < samples; ++i)
        values[static_cast<std::size_t>(i)] = function(static_cast<float>(i) / float(samples - 1));
    return values;
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

// Sketches: a splat, the angles of a hybrid, a noise.

// Linear light as an opaque grey of the screen.
ImU32 grey(double light) {
    const double encoded = real::linear_to_srgb(std::clamp(light, 0.0, 1.0));
    const int byte = static_cast<int>(std::lround(encoded * 255.0));
    return IM_COL32(byte, byte, byte, 255);
}

void draw_splat(const Rect& area, const Falloff& falloff) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    fill_rect(area, IM_COL32_BLACK, px(3));
    const float radius = area.height * 0.5f - px(4);
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

/// The splat of a falloff and, beside it, its profile.
void draw_falloff(Context& context, const ParameterSpec&) {
    const Falloff& falloff = context.layer().render.falloff;
    const Rect area = begin_plot();
    const Rect splat{area.corner(), {area.height, area.height}};
    draw_splat(splat, falloff);
    const Rect curve{{splat.end().x + px(4), area.y}, {area.width - splat.width - px(4), area.height}};
    draw_curve(curve, falloff_samples(falloff), 1.05f, color::accent);
    captions("", "rim");
}

/// The angles at which a hybrid changes from over to screen, as sectors between face-on and edge-on.
void draw_hybrid(Context& context, const ParameterSpec&) {
    const LayerRender& render = context.layer().render;
    const Rect area = begin_plot(72.0f);
    const float radius = area.height - px(16);
    const ImVec2 origin{std::floor(area.middle().x - radius * 0.5f), std::floor(area.end().y - px(8))};
    const double from = std::clamp(double(render.hybrid_from_deg), 0.0, 90.0);
    const double to = std::clamp(double(render.hybrid_to_deg), from, 90.0);
    sector(origin, radius, 0.0, from, color::with_opacity(color::dim, 0.35f));
    constexpr int steps = 12;
    for (int i = 0; i < steps; ++i) {
        const double a = from + (to - from) * i / steps, b = from + (to - from) * (i + 1) / steps;
        sector(origin, radius, a, b, color::with_opacity(color::accent, 0.1f + 0.5f * float(i) / steps));
    }
    sector(origin, radius, to, 90.0, color::with_opacity(color::accent, 0.65f));
    line_across(origin.x - radius, origin.x + radius, origin.y + px(3), color::text, px(2));
    captions("over seen face-on", "screen seen edge-on");
}

/// The field of a noise over as much of the plane across y as the scene is large; computed when it changes.
void draw_noise(Context& context, const ParameterSpec& spec) {
    const std::size_t entry = place_in_list(spec.key);
    const Noise& noise = context.layer().look.noise[entry];
    const Bounds& box = context.status.box;
    const glm::dvec3 extent = box.empty() ? glm::dvec3(10.0) : glm::dvec3(box.hi - box.lo);
    const double span = std::max({extent.x, extent.y, extent.z});
    const Rect area = begin_plot(56.0f);
    const int columns = std::max(1, static_cast<int>(area.width / px(cell)));
    const int rows = static_cast<int>(area.height / px(cell));
    context.memory.noises.resize(std::max(context.memory.noises.size(), entry + 1));
    NoiseSketch& sketch = context.memory.noises[entry];
    if (sketch.columns != columns || sketch.span != span || sketch.noise != noise)
        sketch = {noise, span, columns, noise_greys(noise, columns, rows, span)};
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 size{area.width / float(columns), area.height / float(rows)};
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const ImVec2 corner{area.x + size.x * float(x), area.y + size.y * float(y)};
            const auto at = static_cast<std::size_t>(y * (columns + 1) + x);
            const auto below = at + static_cast<std::size_t>(columns + 1);
            list->AddRectFilledMultiColor(corner, {corner.x + size.x, corner.y + size.y}, sketch.greys[at],
                                          sketch.greys[at + 1], sketch.greys[below + 1], sketch.greys[below]);
        }
    captions(figures(span) + " scene units across", "");
}

/// Where the look has x = 1 for the selected layer, scene units; 0: not known.
double reach_of(const Context& context) {
    const Look& look = context.layer().look;
    if (look.reach > 0.0f) return widen(look.reach);
    const auto& histograms = context.layer_status().histograms;
    if (histograms && histograms->max_distance > 0.0) return histograms->max_distance;
    return context.layer().source.max_distance;
}

std::string reach_caption(double reach) { return reach > 0.0 ? "reach " + figures(reach) : "reach"; }

void draw_distances(const Context& context, const Rect& area, double reach) {
    const auto& histograms = context.layer_status().histograms;
    if (histograms && histograms->max_distance > 0.0 && reach > 0.0)
        draw_bars(area, histograms->distance, histograms->max_distance / reach);
}

/// The profile whose shape `spec` chooses, and its points to be dragged where it is a curve.
void draw_profile(Context& context, const Rect& area, const ParameterSpec& spec,
                  const std::vector<float>& curve, double reach) {
    const ImVec2 below = ImGui::GetCursorScreenPos();
    if (find(context, spec.key)->get() == Value("curve"))
        edit_curve(context, spec.key.parent() / "points", area, curve);
    else
        draw_curve(area, curve, 1.05f, color::accent);
    ImGui::SetCursorScreenPos(below);
    captions("surface", reach_caption(reach));
}

void density_plot(Context& context, const ParameterSpec& spec, const DensityCurve& pdf, double reach) {
    const Rect area = begin_plot();
    draw_distances(context, area, reach);
    draw_profile(context, area, spec, density_samples(pdf), reach);
}

void density_sketch(Context& context, const ParameterSpec& spec) {
    note("Density with distance");
    density_plot(context, spec, context.layer().look.pdf, reach_of(context));
}

void stop_density_sketch(Context& context, const ParameterSpec& spec) {
    const ThicknessStop& stop = context.layer().look.thickness.stops[place_in_list(spec.key)];
    density_plot(context, spec, stop.pdf, reach_of(context) * widen(stop.scale));
}

/// A map's colour, bright enough for a line on the plot's ground.
ImU32 stop_ink(const glm::vec3& color) {
    const auto byte = [](float c) { return static_cast<int>(105.0f + 125.0f * std::clamp(c, 0.0f, 1.0f)); };
    return IM_COL32(byte(color.x), byte(color.y), byte(color.z), 255);
}

/// The shapes of all thickness stops over distances, each in the colour it stands for.
void all_densities(Context& context, const ParameterSpec&) {
    const std::vector<ThicknessStop>& stops = context.layer().look.thickness.stops;
    if (stops.empty()) return;
    const Rect area = begin_plot();
    const double reach = reach_of(context);
    draw_distances(context, area, reach);
    for (const ThicknessStop& stop : stops)
        draw_curve(area, density_samples(stop.pdf), 1.05f, stop_ink(stop.color), stop.scale);
    captions("surface", reach_caption(reach));
    note("Each stop of the thickness map has its own shape.");
}

void alpha_sketch(Context& context, const ParameterSpec&) {
    draw_curve(begin_plot(56.0f), alpha_samples(context.layer().look.alpha), 1.05f, color::accent);
    captions("transparent", "opaque");
}

void vertical_sketch(Context& context, const ParameterSpec& spec) {
    note("Opacity with distance");
    const VerticalAlpha& vertical = context.layer().look.vertical;
    if (vertical.shape == VerticalAlpha::Shape::none) return;
    const double reach = vertical.reach > 0.0f ? widen(vertical.reach) : reach_of(context);
    draw_profile(context, begin_plot(), spec, vertical_samples(vertical), reach);
}

}  // namespace

void draw_above(Context& context, const ParameterSpec& spec) {
    using Draw = void (*)(Context&, const ParameterSpec&);
    static const std::map<std::string_view, Draw> sketches{
        {"layer.source.black", edit_levels},
        {"layer.look.pdf.shape", density_sketch},
        {"layer.look.density", all_densities},
        {"layer.look.alpha.power", alpha_sketch},
        {"layer.look.vertical.shape", vertical_sketch},
        {"layer.look.noise.frequency", draw_noise},
        {"layer.look.thickness.keys.shape", stop_density_sketch},
        {"layer.render.falloff", draw_falloff},
        {"layer.render.hybrid.from_deg", draw_hybrid}};
    if (const auto found = sketches.find(spec.generic_key); found != sketches.end())
        found->second(context, spec);
}

namespace {

/// What the program takes in place of a value that is not set, where that is known.
std::optional<double> value_in_use(const Context& context, const ParameterSpec& spec) {
    const ParameterKey& key = spec.generic_key;
    const LayerStatus& status = context.layer_status();
    const auto known = [](double value) { return value > 0.0 ? std::optional(value) : std::nullopt; };
    if (key == "layer.look.radius.min") return known(status.radius_min);
    if (key == "layer.look.radius.max") return known(status.radius_max);
    if (key == "layer.look.reach" || key == "layer.look.vertical.reach") return known(reach_of(context));
    if (key == "layer.source.seed") return double(resolved_seed(0, context.layer().name));
    if (key == "layer.source.structure.dust")
        return context.layer().source.structure.kind == StructureKind::disk ? 0.8 : 0.0;
    if (key == "camera.file_fps") return context.scene().output.fps;
    if (status.stale) return std::nullopt;
    if (key == "layer.source.splats" && has_bodies(context.layer())) return known(double(status.splats));
    if (key == "layer.source.structure.height") return known(status.body_height);
    if (key == "layer.source.uv_width") return known(status.uv_width);
    if (!status.histograms) return std::nullopt;
    if (key == "layer.source.max_distance") return known(status.histograms->max_distance);
    if (status.histograms->values.share.empty()) return std::nullopt;
    if (key == "layer.source.black") return status.histograms->values.black;
    if (key == "layer.source.white") return status.histograms->values.white;
    return std::nullopt;
}

std::string figures_of(const ParameterSpec& spec, double value) {
    return spec.type == ParameterType::integer ? figures(std::int64_t(value)) : figures(value);
}

}  // namespace

std::string unset_in_words(const Context& context, const ParameterSpec& spec, const Value& value) {
    const bool zero = value.is_number() && value.number() == 0.0 && !spec.zero.empty();
    if (!zero && (value.is_number() || !(value == spec.nothing))) return "";
    if (spec.generic_key.is_below("layer.look.radius")) {
        const Radius& radius = context.layer().look.radius;
        if (radius.min != 0.0f || radius.max != 0.0f) return "";  // then 0 is a size
    }
    const std::optional<double> used = value_in_use(context, spec);
    std::string word(zero ? spec.zero : "Auto");
    if (used && spec.generic_key == "layer.source.splats") word = "No limit";
    return used ? fmt::format("{} ({})", word, figures_of(spec, *used)) : word;
}

double first_value(const Context& context, const ParameterSpec& spec) {
    if (const std::optional<double> used = value_in_use(context, spec)) {
        std::string shown = figures_of(spec, *used);
        std::erase(shown, ' ');
        return parse_double(shown).value_or(*used);
    }
    const bool magnitudes = spec.scale == Scale::logarithmic && spec.slider_min > 0.0;
    return magnitudes ? std::sqrt(spec.slider_min * spec.slider_max)
                      : 0.5 * (spec.slider_min + spec.slider_max);
}

}  // namespace astrosplat::panel

#include "gui/panel/row_sketches.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "generate/lattice.h"
#include "gui/panel/companions.h"
#include "gui/panel/curve_plot.h"
#include "gui/panel/levels.h"
#include "gui/panel/plot.h"
#include "gui/panel/section.h"
#include "gui/panel/sketches.h"
#include "gui/panel/words.h"
#include "gui/theme.h"

namespace astrosplat::panel {
namespace {

/// Where the look has x = 1 for the selected layer, scene units; 0: not known.
double reach_of(const Context& context) {
    const Look& look = context.layer().look;
    if (look.reach > 0.0f) return widen(look.reach);
    const auto& histograms = context.layer_status().histograms;
    if (histograms && histograms->max_distance > 0.0) return histograms->max_distance;
    return context.layer().source.max_distance;
}

std::string reach_caption(double reach) { return reach > 0.0 ? "reach " + figures(reach) : "reach"; }

void draw_distances(const Context& context, const Area& area, double reach) {
    const auto& histograms = context.layer_status().histograms;
    if (histograms && histograms->max_distance > 0.0 && reach > 0.0)
        draw_bars(area, histograms->distance, histograms->max_distance / reach);
}

/// The profile whose shape `spec` chooses, and its points to be dragged where it is a curve.
void draw_profile(Context& context, const Area& area, const ParameterSpec& spec,
                  const std::vector<float>& samples, double reach) {
    const ImVec2 below = ImGui::GetCursorScreenPos();
    if (find(context, spec.key)->get() == Value("curve"))
        edit_curve(context, spec.key.parent() / "points", area, samples);
    else
        draw_curve(area, samples, 1.05f, color::accent);
    ImGui::SetCursorScreenPos(below);
    captions("surface", reach_caption(reach));
}

void density_plot(Context& context, const ParameterSpec& spec, const DensityCurve& pdf, double reach) {
    const Area area = begin_plot();
    draw_distances(context, area, reach);
    draw_profile(context, area, spec, density_samples(pdf), reach);
}

void density_sketch(Context& context, const ParameterSpec& spec) {
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

/// What the thickness stops make of it: each stop's shape in the colour it stands for, over distances.
void all_densities(Context& context, const ParameterSpec&) {
    const std::vector<ThicknessStop>& stops = context.layer().look.thickness.stops;
    if (stops.empty()) return;
    const Area area = begin_plot();
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
    const VerticalAlpha& vertical = context.layer().look.vertical;
    if (vertical.shape == VerticalAlpha::Shape::none) return;
    const double reach = vertical.reach > 0.0f ? widen(vertical.reach) : reach_of(context);
    draw_profile(context, begin_plot(), spec, vertical_samples(vertical), reach);
}

void noise_sketch(Context& context, const ParameterSpec& spec) {
    const Bounds& box = context.status.box;
    const glm::dvec3 size = box.empty() ? glm::dvec3(10.0) : glm::dvec3(box.hi - box.lo);
    const std::size_t place = place_in_list(spec.key);
    draw_noise(context, place, context.layer().look.noise[place], std::max({size.x, size.y, size.z}));
}

void falloff_sketch(Context& context, const ParameterSpec&) { draw_falloff(context.layer().render.falloff); }

void hybrid_sketch(Context& context, const ParameterSpec&) {
    const LayerRender& render = context.layer().render;
    draw_hybrid(render.hybrid_from_deg, render.hybrid_to_deg);
}

void levels_sketch(Context& context, const ParameterSpec&) { edit_levels(context); }

using Draw = void (*)(Context&, const ParameterSpec&);
using Sketches = std::map<std::string_view, Draw>;  // by generic key

void draw_of(const Sketches& sketches, Context& context, const ParameterSpec& spec) {
    const auto found = sketches.find(spec.generic_key);
    if (found != sketches.end()) found->second(context, spec);
}

}  // namespace

void draw_above(Context& context, const ParameterSpec& spec) {
    static const Sketches sketches{{"layer.source.black", levels_sketch},
                                   {"layer.look.pdf.shape", density_sketch},
                                   {"layer.look.density", all_densities},
                                   {"layer.look.alpha.power", alpha_sketch},
                                   {"layer.look.vertical.shape", vertical_sketch},
                                   {"layer.look.noise.frequency", noise_sketch},
                                   {"layer.look.thickness.keys.shape", stop_density_sketch},
                                   {"layer.render.falloff", falloff_sketch},
                                   {"layer.render.hybrid.from_deg", hybrid_sketch}};
    draw_of(sketches, context, spec);
}

std::string zero_in_words(const Context& context, const ParameterSpec& spec) {
    double used = 0.0;
    if (spec.generic_key.is_below("layer.look.radius")) {
        const Radius& radius = context.layer().look.radius;
        if (radius.min != 0.0f || radius.max != 0.0f) return "";  // then 0 is a size
        const LayerStatus& status = context.layer_status();
        used = spec.generic_key == "layer.look.radius.min" ? status.radius_min : status.radius_max;
    } else if (spec.generic_key == "layer.look.reach" || spec.generic_key == "layer.look.vertical.reach") {
        used = reach_of(context);
    } else if (spec.generic_key == "layer.source.max_distance") {
        const LayerStatus& status = context.layer_status();
        if (status.histograms && !status.stale) used = status.histograms->max_distance;
    } else if (spec.generic_key == "layer.source.structure.height") {
        if (!context.layer_status().stale) used = context.layer_status().body_height;
    } else if (spec.generic_key == "layer.source.uv_width") {
        if (!context.layer_status().stale) used = context.layer_status().uv_width;
    } else if (spec.generic_key == "layer.source.seed") {
        const std::uint32_t seed = resolved_seed(0, context.layer().name);
        return fmt::format("{} ({})", spec.zero, seed);
    }
    const std::string words(spec.zero);
    return used > 0.0 ? fmt::format("{} ({})", words, figures(used)) : words;
}

}  // namespace astrosplat::panel

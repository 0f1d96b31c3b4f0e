// Look: how the splats of the selected layer are thinned, faded, sized and coloured (DESIGN 5), in the order
// in which it happens.
#include "gui/panel/look_tab.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "gui/panel/curve_plot.h"
#include "gui/panel/pictures.h"
#include "gui/panel/plot.h"
#include "gui/panel/section.h"
#include "gui/panel/whole_look.h"
#include "gui/panel/words.h"
#include "gui/theme.h"

namespace astrosplat::panel {
namespace {

std::string reach_caption(const Context& context) {
    const double reach = reach_of(context);
    return reach > 0.0 ? "reach " + figures(reach) : std::string("reach");
}

void draw_distances(const Context& context, const Area& area, double reach) {
    const auto& histograms = context.layer_status().histograms;
    if (histograms && histograms->max_distance > 0.0 && reach > 0.0)
        draw_bars(area, histograms->distance, histograms->max_distance / reach);
}

// A map's colour, bright enough for a line on the plot's ground.
ImU32 key_ink(const glm::vec3& color) {
    const auto byte = [](float c) { return static_cast<int>(105.0f + 125.0f * std::clamp(c, 0.0f, 1.0f)); };
    return IM_COL32(byte(color.x), byte(color.y), byte(color.z), 255);
}

// The shape of a density: plot over the histogram of distances, then its rows. `key` ends in "shape".
void density_rows(Context& context, const DensityCurve& pdf, const std::string& head, double reach) {
    const Area area = begin_plot();
    const ImVec2 below = ImGui::GetCursorScreenPos();
    draw_distances(context, area, reach);
    const std::vector<float> samples = density_samples(pdf);
    const bool custom = pdf.shape == DensityCurve::Shape::curve;
    if (custom)
        edit_curve(context, context.prefix + head + "points", area, samples);
    else
        draw_curve(area, samples, 1.05f, color::accent);
    ImGui::SetCursorScreenPos(below);
    captions("surface", reach > 0.0 ? "reach " + figures(reach) : "reach");
    layer_row(context, head + "shape", "Shape");
    if (pdf.shape == DensityCurve::Shape::exponential) layer_row(context, head + "rate");
    if (pdf.shape == DensityCurve::Shape::gaussian) layer_row(context, head + "sigma");
    if (custom) layer_row(context, head + "points");
}

// What the thickness keys make of it: each key's shape in the colour it stands for, over distances.
void all_densities(Context& context) {
    const Area area = begin_plot();
    const double reach = reach_of(context);
    draw_distances(context, area, reach);
    for (const ThicknessKey& key : context.layer().look.thickness.keys)
        draw_curve(area, density_samples(key.pdf), 1.05f, key_ink(key.color), key.scale);
    captions("surface", reach_caption(context));
    note("Each key of the thickness map has its own shape.");
}

void density_section(Context& context) {
    const LayerStatus& status = context.layer_status();
    // Of a set that is still growing the preview knows too little.
    const bool is_known = status.splats > 0 && status.kept >= 0 && !status.loading;
    const std::string kept = is_known ? percent(double(status.kept) / double(status.splats)) + " kept" : "";
    if (!section(context, "Density with distance", kept, true)) return;
    const Look& look = context.layer().look;
    // With thickness keys each has a shape of its own, and this one is not used.
    if (look.thickness.keys.empty())
        density_rows(context, look.pdf, "look.pdf.", reach_of(context));
    else
        all_densities(context);
    layer_row(context, "look.density", "Density");
    layer_row(context, "look.reach");
    if (!kept.empty()) note(kept + " of " + splat_count(status.splats));
}

void alpha_section(Context& context) {
    const HorizontalAlpha& alpha = context.layer().look.alpha;
    const std::string state =
        alpha == HorizontalAlpha() ? "off" : "power " + short_number(widen(alpha.power));
    if (!section(context, "Opacity at soft edges", state, true)) return;
    const Area area = begin_plot(56.0f);
    draw_curve(area, alpha_samples(alpha), 1.05f, color::accent);
    captions("transparent", "opaque");
    layer_row(context, "look.alpha.power", "Power");
    layer_row(context, "look.alpha.threshold");
    layer_row(context, "look.alpha.gain");
    layer_row(context, "look.alpha.unpremultiply");
}

std::string vertical_state(const VerticalAlpha& vertical, const Parameter* shape) {
    if (vertical.shape == VerticalAlpha::Shape::none) return "off";
    return shape ? in_words(shape->spec, shape->get()) : "";
}

void vertical_section(Context& context) {
    const VerticalAlpha& vertical = context.layer().look.vertical;
    const Parameter* shape = find(context, context.prefix + "look.vertical.shape");
    if (!section(context, "Opacity with distance", vertical_state(vertical, shape))) return;
    const bool custom = vertical.shape == VerticalAlpha::Shape::curve;
    if (vertical.shape != VerticalAlpha::Shape::none) {
        const Area area = begin_plot();
        const ImVec2 below = ImGui::GetCursorScreenPos();
        const std::vector<float> samples = vertical_samples(vertical);
        if (custom)
            edit_curve(context, context.prefix + "look.vertical.points", area, samples);
        else
            draw_curve(area, samples, 1.05f, color::accent);
        ImGui::SetCursorScreenPos(below);
        captions("surface",
                 vertical.reach > 0.0f ? "reach " + figures(widen(vertical.reach)) : reach_caption(context));
    }
    layer_row(context, "look.vertical.shape", "Shape");
    if (vertical.shape == VerticalAlpha::Shape::exponential) layer_row(context, "look.vertical.rate");
    if (custom) layer_row(context, "look.vertical.points");
    layer_row(context, "look.vertical.reach");
    layer_row(context, "look.vertical.match");
}

std::string size_state(const Radius& radius) {
    if (radius.min == 0.0f && radius.max == 0.0f) return "auto";
    return short_number(widen(radius.min)) + " to " + short_number(widen(radius.max));
}

void size_section(Context& context) {
    const Radius& radius = context.layer().look.radius;
    if (!section(context, "Size", size_state(radius), true)) return;
    layer_row(context, "look.radius.min", "Smallest");
    layer_row(context, "look.radius.max", "Largest");
    const LayerStatus& status = context.layer_status();
    if (radius.min == 0.0f && radius.max == 0.0f && status.radius_max > 0.0)
        note(status.radius_min == status.radius_max
                 ? fmt::format("0, 0: {} scene units", figures(status.radius_max))
                 : fmt::format("0, 0: the file's own, {} to {}", figures(status.radius_min),
                               figures(status.radius_max)));
    layer_row(context, "look.radius.horizontal_scale", "At soft edges");
    layer_row(context, "look.radius.vertical_scale", "With distance");
}

// Scene units that a preview of the field shows across.
double noise_span(const Context& context) {
    const Bounds& box = context.status.box;
    if (box.empty()) return 10.0;
    const auto size = box.hi - box.lo;
    return std::max({double(size.x), double(size.y), double(size.z)});
}

void noise_entry(Context& context, std::size_t i) {
    const std::size_t layer = context.view.layer;
    ImGui::PushID(static_cast<int>(i));
    const std::string head = fmt::format("Noise {}", i + 1);
    const bool removed = element_head(head.c_str());
    draw_noise(context, i, context.layer().look.noise[i], noise_span(context));
    for (const char* name : {"frequency", "octaves", "lacunarity", "gain", "seed", "cull", "silhouette",
                             "jitter", "alpha", "brightness"})
        layer_row(context, fmt::format("look.noise.{}.{}", i, name));
    ImGui::PopID();
    if (removed)
        edit(context, context.prefix, "Remove noise", [&](Scene& scene) {
            auto& noise = scene.layers[layer].look.noise;
            noise.erase(noise.begin() + static_cast<std::ptrdiff_t>(i));
        });
}

void noise_section(Context& context) {
    const std::vector<Noise>& noise = context.layer().look.noise;
    const std::string state = noise.empty() ? "off" : fmt::format("{}", noise.size());
    if (!section(context, "Noise", state)) return;
    for (std::size_t i = 0; i < noise.size(); ++i) noise_entry(context, i);
    const std::size_t layer = context.view.layer;
    if (noise.size() < 4 && add_line("Add noise"))
        edit(context, context.prefix, "Add noise",
             [&](Scene& scene) { scene.layers[layer].look.noise.emplace_back(); });
}

void thickness_key(Context& context, std::size_t i) {
    const std::size_t layer = context.view.layer;
    const ThicknessKey& key = context.layer().look.thickness.keys[i];
    ImGui::PushID(static_cast<int>(i));
    const std::string title = fmt::format("Key {}", i + 1);
    const bool removed = element_head(title.c_str());
    const std::string head = fmt::format("look.thickness.keys.{}.", i);
    layer_row(context, head + "color");
    layer_row(context, head + "scale");
    density_rows(context, key.pdf, head, reach_of(context) * widen(key.scale));
    ImGui::PopID();
    if (removed)
        edit(context, context.prefix, "Remove thickness key", [&](Scene& scene) {
            auto& keys = scene.layers[layer].look.thickness.keys;
            keys.erase(keys.begin() + static_cast<std::ptrdiff_t>(i));
        });
}

void thickness_section(Context& context) {
    const Thickness& thickness = context.layer().look.thickness;
    const std::size_t count = thickness.keys.size();
    const std::string state = thickness.map.empty() && count == 0 ? "off"
                              : count == 1                        ? "1 key"
                                                                  : fmt::format("{} keys", count);
    if (!section(context, "Thickness map", state)) return;
    layer_row(context, "look.thickness.map", "Picture");
    for (std::size_t i = 0; i < count; ++i) thickness_key(context, i);
    const std::size_t layer = context.view.layer;
    if ((count == 0 || !thickness.map.empty()) && count < 8 && add_line("Add key"))
        edit(context, context.prefix, "Add thickness key", [&](Scene& scene) {
            Look& look = scene.layers[layer].look;
            ThicknessKey key;
            if (look.thickness.keys.empty()) key.pdf = look.pdf;  // the first one changes nothing
            look.thickness.keys.push_back(key);
        });
}

void color_section(Context& context) {
    const bool untouched = context.layer().look.grade == Grade();
    if (!section(context, "Colour", untouched ? "off" : "changed")) return;
    for (const char* name : {"gain", "tint", "saturation", "gamma", "black"})
        layer_row(context, std::string("look.grade.") + name);
}

}  // namespace

double reach_of(const Context& context) {
    const Look& look = context.layer().look;
    if (look.reach > 0.0f) return widen(look.reach);
    const auto& histograms = context.layer_status().histograms;
    if (histograms && histograms->max_distance > 0.0) return histograms->max_distance;
    return context.layer().source.max_distance;
}

void look_tab(Context& context) {
    density_section(context);
    alpha_section(context);
    vertical_section(context);
    size_section(context);
    noise_section(context);
    thickness_section(context);
    color_section(context);
    if (section(context, "Whole look", "export, apply, copy")) look_buttons(context);
}

}  // namespace astrosplat::panel

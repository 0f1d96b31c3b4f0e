// Render: the dot itself and how dots mix (DESIGN 7).
#include "gui/panel/render_tab.h"

#include "gui/panel/pictures.h"
#include "gui/panel/plot.h"
#include "gui/panel/section.h"
#include "gui/panel/words.h"
#include "gui/theme.h"

namespace astrosplat::panel {
namespace {

std::string state_of(const Context& context, const std::string& key) {
    const Parameter* parameter = find(context, context.prefix + key);
    return parameter ? in_words(parameter->spec, parameter->get()) : "";
}

void dot_section(Context& context) {
    using Shape = Falloff::Shape;
    const Falloff& falloff = context.layer().render.falloff;
    if (!section(context, "Dot profile", state_of(context, "render.falloff"), true)) return;
    draw_falloff(falloff);
    layer_row(context, "render.falloff", "Shape");
    if (falloff.shape == Shape::trapezoid) layer_row(context, "render.core");
    if (falloff.shape == Shape::gaussian || falloff.shape == Shape::exponential)
        layer_row(context, "render.sharpness");
}

void mixing_section(Context& context) {
    const LayerRender& render = context.layer().render;
    if (!section(context, "Mixing", state_of(context, "render.blend"), true)) return;
    layer_row(context, "render.blend");
    if (render.blend == Blend::hybrid) {
        draw_hybrid(render.hybrid_from_deg, render.hybrid_to_deg);
        layer_row(context, "render.hybrid.from_deg");
        layer_row(context, "render.hybrid.to_deg");
    }
    layer_row(context, "render.opacity");
    layer_row(context, "render.holdout");
    layer_row(context, "render.isolate");
    if (render.blend == Blend::lighten)
        note("Lighten is always composited as a whole, in the order of the list.");
}

void detail_section(Context& context) {
    const LevelOfDetail& lod = context.layer().render.lod;
    const std::string state = lod.max_px > 0.0f ? figures(widen(lod.max_px)) + " px" : "off";
    if (!section(context, "Level of detail", state)) return;
    layer_row(context, "render.lod.max_px");
    layer_row(context, "render.lod.max_children");
}

}  // namespace

void render_tab(Context& context) {
    dot_section(context);
    mixing_section(context);
    detail_section(context);
}

}  // namespace astrosplat::panel

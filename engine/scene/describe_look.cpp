// The description of [layer.look] and [layer.render], which are also what a preset holds. One line per
// parameter.
#include "scene/describer.h"

namespace astrosplat {
namespace {

using Type = ParameterType;

void describe_curve(const Describer& d, DensityCurve& curve) {
    d(spec("shape", "Density with distance", "", "How density falls from the surface to reach.")
          .shown_as("Shape"),
      curve.shape);
    d(spec("rate", "Rate", "", "Exponential: e^(-rate x).")
          .within(0, 1e6)
          .slider(0, 20)
          .only_with("shape", {"exponential"}),
      curve.rate);
    d(spec("sigma", "Sigma", "of reach", "Gaussian: standard deviation.")
          .within(1e-6, 1e6)
          .slider(0.01, 2)
          .only_with("shape", {"gaussian"}),
      curve.sigma);
    d(spec("points", "Points", "", "Curve: points (x, density) with x ascending.")
          .within(0, 1e6)
          .only_with("shape", {"curve"}),
      curve.points);
}

void describe_thickness_key(const Describer& d, ThicknessKey& key) {
    d(spec("color", "Map colour", "", "Colour of the thickness map that this key stands for.")
          .as(Type::color)
          .range(0, 1),
      key.color);
    d(spec("scale", "Thickness", "of reach", "Reach where the map has this colour.")
          .within(0, 1e6)
          .slider(0, 4),
      key.scale);
    describe_curve(d, key.pdf);
}

void describe_noise(const Describer& d, Noise& n) {
    d(spec("frequency", "Frequency", "per scene unit", "Lumps per scene unit of the coarsest octave.")
          .within(0, 1e6)
          .slider(0.01, 100)
          .logarithmic(),
      n.frequency);
    d(spec("octaves", "Octaves", "", "Layers of finer and finer noise.").range(1, 16), n.octaves);
    d(spec("lacunarity", "Lacunarity", "", "Frequency of an octave over the one before.")
          .within(0.01, 16)
          .slider(1, 4),
      n.lacunarity);
    d(spec("gain", "Gain", "", "Strength of an octave over the one before.").within(0, 16).slider(0, 1),
      n.gain);
    d(spec("seed", "Seed", "", "Another number gives another noise.").slider(0, 1000), n.seed);
    d(spec("cull", "Thins out", "", "How much of the density the noise takes.").range(0, 1), n.cull);
    d(spec("silhouette", "Frays the edge", "", "How much of the reach the noise takes.").range(0, 1),
      n.silhouette);
    d(spec("jitter", "Displaces", "scene units", "Moves splats along the layer's axis.").slider(0, 1),
      n.jitter);
    d(spec("alpha", "Varies opacity", "", "Opacity times 1 + this * noise.").within(-1e6, 1e6).slider(0, 1),
      n.alpha);
    d(spec("brightness", "Varies brightness", "", "Colour times 1 + this * noise.")
          .within(-1e6, 1e6)
          .slider(0, 1),
      n.brightness);
}

void describe_alpha(const Describer& d, HorizontalAlpha& a) {
    d(spec("power", "Opacity at soft edges", "", "Opacity below the threshold is raised to this power.")
          .within(0, 1e6)
          .slider(0.1, 10)
          .logarithmic()
          .shown_as("Power"),
      a.power);
    d(spec("threshold", "Threshold", "", "Opacity from here on is left alone.").range(0, 1), a.threshold);
    d(spec("unpremultiply", "Divide by alpha", "", "Divides colours below the threshold by their opacity."),
      a.unpremultiply);
    d(spec("gain", "Gain", "", "Multiplies opacity.").within(0, 1e6).slider(0, 4), a.gain);
}

void describe_vertical(const Describer& d, VerticalAlpha& v) {
    d(spec("shape", "Opacity with distance", "", "How opacity falls from the surface to reach.")
          .shown_as("Shape"),
      v.shape);
    d(spec("rate", "Rate", "", "Exponential: e^(-rate x).")
          .within(0, 1e6)
          .slider(0, 20)
          .only_with("shape", {"exponential"}),
      v.rate);
    d(spec("points", "Points", "", "Curve: points (x, opacity) with x ascending.")
          .within(0, 1e6)
          .only_with("shape", {"curve"}),
      v.points);
    d(spec("reach", "Reach", "scene units", "Where x = 1 for this alone; 0: the layer's reach.")
          .at_least(0)
          .slider(0, 10),
      v.reach);
    d(spec("match", "Match the picture", "",
           "Makes the front view show the picture's opacity; auto: coverage for meshes, none for splat "
           "files."),
      v.match);
}

void describe_radius(const Describer& d, Radius& r) {
    d(spec("min", "Smallest size", "scene units",
           "Smallest radius; with max 0 too: the file's, or 0.6 voxel diagonals.")
          .at_least(0)
          .slider(0, 1)
          .shown_as("Smallest"),
      r.min);
    d(spec("max", "Largest size", "scene units", "Largest radius.")
          .at_least(0)
          .slider(0, 1)
          .shown_as("Largest"),
      r.max);
    d(spec("horizontal_scale", "Size at soft edges", "", "Factor on the radius where opacity is 0.")
          .within(0, 1e6)
          .slider(0, 4)
          .shown_as("At soft edges"),
      r.horizontal_scale);
    d(spec("vertical_scale", "Size with distance", "", "Factor on the radius at reach.")
          .within(0, 1e6)
          .slider(0, 4)
          .shown_as("With distance"),
      r.vertical_scale);
}

void describe_grade(const Describer& d, Grade& g) {
    d(spec("gain", "Brightness", "", "Multiplies the colour.").within(0, 1e6).slider(0.01, 100).logarithmic(),
      g.gain);
    d(spec("tint", "Tint", "", "Multiplies the colour per channel.")
          .as(Type::color)
          .within(0, 1e6)
          .slider(0, 2),
      g.tint);
    d(spec("saturation", "Saturation", "", "0: grey, 1: as it is.").within(0, 1e6).slider(0, 3),
      g.saturation);
    d(spec("gamma", "Gamma", "", "Colour is raised to 1 / gamma.")
          .within(0.01, 100)
          .slider(0.2, 5)
          .logarithmic(),
      g.gamma);
    d(spec("black", "Black", "", "Subtracted from the colour, which is then stretched back.")
          .at_least(0)
          .below(1)
          .slider(0, 0.5),
      g.black);
}

}  // namespace

void describe_look(const Describer& d, Look& look) {
    const auto section = [&](const char* title) { return d.shown_in("Look", title); };
    const Describer density = section("Density with distance"), thickness = section("Thickness map");
    density(spec("density", "Density", "", "Share of the positions that become splats.")
                .within(0, 1e6)
                .slider(0, 1),
            look.density);
    density(spec("reach", "Reach", "scene units",
                 "Distance where x = 1; 0: max_distance, or a file's largest distance.")
                .at_least(0)
                .slider(0, 10),
            look.reach);
    describe_curve(density.in("pdf", true), look.pdf);
    thickness(spec("thickness.map", "Thickness map", "", "Picture whose colours choose among the keys.")
                  .shown_as("Picture"),
              look.thickness.map);
    thickness.list("thickness.keys", look.thickness.keys, describe_thickness_key);
    section("Noise").list("noise", look.noise, describe_noise);
    describe_alpha(section("Opacity at soft edges").in("alpha", true), look.alpha);
    describe_vertical(section("Opacity with distance").in("vertical", true), look.vertical);
    describe_radius(section("Size").in("radius", true), look.radius);
    describe_grade(section("Colour").in("grade", true), look.grade);
}

void describe_render(const Describer& d, LayerRender& r) {
    const Describer dot = d.shown_in("Render", "Dot profile"), mixing = d.shown_in("Render", "Mixing"),
                    detail = d.shown_in("Render", "Level of detail");
    dot(spec("falloff", "Dot profile", "", "How a dot fades from its centre to its rim.").shown_as("Shape"),
        r.falloff.shape);
    dot(spec("core", "Core", "of the radius", "Trapezoid: the flat part.")
            .range(0, 1)
            .only_with("falloff", {"trapezoid"}),
        r.falloff.core);
    dot(spec("sharpness", "Sharpness", "", "Gaussian and exponential: how fast the dot fades.")
            .within(1e-6, 1e6)
            .slider(0.5, 20)
            .only_with("falloff", {"gaussian", "exponential"}),
        r.falloff.sharpness);
    mixing(spec("blend", "Mixing", "", "How dots mix with what lies behind."), r.blend);
    mixing(spec("opacity", "Opacity", "", "Of the whole layer.").range(0, 1), r.opacity);
    mixing(spec("hybrid.from_deg", "Over up to", "degrees", "Hybrid: over up to this angle from the axis.")
               .range(0, 90)
               .only_with("blend", {"hybrid"}),
           r.hybrid_from_deg);
    mixing(spec("hybrid.to_deg", "Screen from", "degrees", "Hybrid: screen from this angle on.")
               .range(0, 90)
               .only_with("blend", {"hybrid"}),
           r.hybrid_to_deg);
    detail(spec("lod.max_px", "Split above", "px at 1080 lines", "Dots that look larger are split; 0: off.")
               .at_least(0)
               .slider(0, 200),
           r.lod.max_px);
    detail(spec("lod.max_children", "Most children", "", "Largest number of parts of one dot.")
               .range(1, 16777216)
               .slider(1, 65536)
               .logarithmic(),
           r.lod.max_children);
    mixing(spec("holdout", "Holdout", "", "Hides what lies behind and shows nothing itself."), r.holdout);
    mixing(spec("isolate", "Isolate", "", "Rendered alone, then composited as a whole."), r.isolate);
}

}  // namespace astrosplat

// The description of [layer.look] and [layer.render], which are also what a preset holds. One line per
// parameter.
#include "scene/describer.h"

namespace astrosplat {
namespace {

using Type = ParameterType;

void describe_curve(const Describer& d, DensityCurve& curve) {
    d(spec("shape", "Density with distance", "", "How density falls from the surface to reach.")
          .one_of({"constant", "linear", "quadratic", "exponential", "gaussian", "smooth", "curve"}),
      curve.shape);
    d(spec("rate", "Rate", "", "Exponential: e^(-rate x).").at_least(0).slider(0, 20), curve.rate);
    d(spec("sigma", "Sigma", "of reach", "Gaussian: standard deviation.").above(0).slider(0.01, 2),
      curve.sigma);
    d(spec("points", "Points", "", "Curve: points (x, density) with x ascending.").at_least(0), curve.points);
}

void describe_thickness_key(const Describer& d, ThicknessKey& key) {
    d(spec("color", "Map colour", "", "Colour of the thickness map that this key stands for.")
          .as(Type::color)
          .range(0, 1),
      key.color);
    d(spec("scale", "Thickness", "of reach", "Reach where the map has this colour.").at_least(0).slider(0, 4),
      key.scale);
    describe_curve(d, key.pdf);
}

void describe_noise(const Describer& d, Noise& n) {
    d(spec("frequency", "Frequency", "per scene unit", "Lumps per scene unit of the coarsest octave.")
          .at_least(0)
          .slider(0.01, 100)
          .logarithmic(),
      n.frequency);
    d(spec("octaves", "Octaves", "", "Layers of finer and finer noise.").range(1, 16), n.octaves);
    d(spec("lacunarity", "Lacunarity", "", "Frequency of an octave over the one before.")
          .above(0)
          .slider(1, 4),
      n.lacunarity);
    d(spec("gain", "Gain", "", "Strength of an octave over the one before.").at_least(0).slider(0, 1),
      n.gain);
    d(spec("seed", "Seed", "", "Another number gives another noise.").slider(0, 1000), n.seed);
    d(spec("cull", "Thins out", "", "How much of the density the noise takes.").range(0, 1), n.cull);
    d(spec("silhouette", "Frays the edge", "", "How much of the reach the noise takes.").range(0, 1),
      n.silhouette);
    d(spec("jitter", "Displaces", "scene units", "Moves splats along the layer's axis.").slider(0, 1),
      n.jitter);
    d(spec("alpha", "Varies opacity", "", "Opacity times 1 + this * noise.").slider(0, 1), n.alpha);
    d(spec("brightness", "Varies brightness", "", "Colour times 1 + this * noise.").slider(0, 1),
      n.brightness);
}

void describe_alpha(const Describer& d, HorizontalAlpha& a) {
    d(spec("power", "Opacity at soft edges", "", "Opacity below the threshold is raised to this power.")
          .at_least(0)
          .slider(0.1, 10)
          .logarithmic(),
      a.power);
    d(spec("threshold", "Threshold", "", "Opacity from here on is left alone.").range(0, 1), a.threshold);
    d(spec("unpremultiply", "Divide by alpha", "", "Divides colours below the threshold by their opacity."),
      a.unpremultiply);
    d(spec("gain", "Gain", "", "Multiplies opacity.").at_least(0).slider(0, 4), a.gain);
}

void describe_vertical(const Describer& d, VerticalAlpha& v) {
    d(spec("shape", "Opacity with distance", "", "How opacity falls from the surface to reach.")
          .one_of({"none", "constant", "linear", "exponential", "s106", "curve"}),
      v.shape);
    d(spec("rate", "Rate", "", "Exponential: e^(-rate x).").at_least(0).slider(0, 20), v.rate);
    d(spec("points", "Points", "", "Curve: points (x, opacity) with x ascending.").at_least(0), v.points);
    d(spec("reach", "Reach", "scene units", "Where x = 1 for this alone; 0: the layer's reach.")
          .at_least(0)
          .slider(0, 10),
      v.reach);
    d(spec(
          "match", "Match the picture", "",
          "Makes the front view show the picture's opacity; auto: coverage for meshes, none for splat files.")
          .one_of({"auto", "none", "sum", "coverage"}),
      v.match);
}

void describe_radius(const Describer& d, Radius& r) {
    d(spec("min", "Smallest size", "scene units",
           "Smallest radius; with max 0 too: the file's, or 0.6 voxel diagonals.")
          .at_least(0)
          .slider(0, 1),
      r.min);
    d(spec("max", "Largest size", "scene units", "Largest radius.").at_least(0).slider(0, 1), r.max);
    d(spec("horizontal_scale", "Size at soft edges", "", "Factor on the radius where opacity is 0.")
          .at_least(0)
          .slider(0, 4),
      r.horizontal_scale);
    d(spec("vertical_scale", "Size with distance", "", "Factor on the radius at reach.")
          .at_least(0)
          .slider(0, 4),
      r.vertical_scale);
}

void describe_grade(const Describer& d, Grade& g) {
    d(spec("gain", "Brightness", "", "Multiplies the colour.").at_least(0).slider(0.01, 100).logarithmic(),
      g.gain);
    d(spec("tint", "Tint", "", "Multiplies the colour per channel.").as(Type::color).at_least(0).slider(0, 2),
      g.tint);
    d(spec("saturation", "Saturation", "", "0: grey, 1: as it is.").at_least(0).slider(0, 3), g.saturation);
    d(spec("gamma", "Gamma", "", "Colour is raised to 1 / gamma.").above(0).slider(0.2, 5).logarithmic(),
      g.gamma);
    d(spec("black", "Black", "", "Subtracted from the colour, which is then stretched back.")
          .at_least(0)
          .below(1)
          .slider(0, 0.5),
      g.black);
}

}  // namespace

void describe_look(const Describer& d, Look& look) {
    d(spec("density", "Density", "", "Share of the positions that become splats.").at_least(0).slider(0, 1),
      look.density);
    d(spec("reach", "Reach", "scene units",
           "Distance where x = 1; 0: max_distance, or a file's largest distance.")
          .at_least(0)
          .slider(0, 10),
      look.reach);
    describe_curve(d.section("pdf", true), look.pdf);
    d(spec("thickness.map", "Thickness map", "", "Picture whose colours choose among the keys."),
      look.thickness.map);
    d.list("thickness.keys", look.thickness.keys, describe_thickness_key);
    d.list("noise", look.noise, describe_noise);
    describe_alpha(d.section("alpha", true), look.alpha);
    describe_vertical(d.section("vertical", true), look.vertical);
    describe_radius(d.section("radius", true), look.radius);
    describe_grade(d.section("grade", true), look.grade);
}

void describe_render(const Describer& d, LayerRender& r) {
    d(spec("falloff", "Dot profile", "", "How a dot fades from its centre to its rim.")
          .one_of({"constant", "linear", "trapezoid", "gaussian", "exponential"}),
      r.falloff.shape);
    d(spec("core", "Core", "of the radius", "Trapezoid: the flat part.").range(0, 1), r.falloff.core);
    d(spec("sharpness", "Sharpness", "", "Gaussian and exponential: how fast the dot fades.")
          .above(0)
          .slider(0.5, 20),
      r.falloff.sharpness);
    d(spec("blend", "Mixing", "", "How dots mix with what lies behind.")
          .one_of({"over", "add", "screen", "lighten", "hybrid"}),
      r.blend);
    d(spec("opacity", "Opacity", "", "Of the whole layer.").range(0, 1), r.opacity);
    d(spec("hybrid.from_deg", "Over up to", "degrees", "Hybrid: over up to this angle from the axis.")
          .range(0, 90),
      r.hybrid_from_deg);
    d(spec("hybrid.to_deg", "Screen from", "degrees", "Hybrid: screen from this angle on.").range(0, 90),
      r.hybrid_to_deg);
    d(spec("lod.max_px", "Split above", "px at 1080 lines", "Dots that look larger are split; 0: off.")
          .at_least(0)
          .slider(0, 200),
      r.lod.max_px);
    d(spec("lod.max_children", "Most children", "", "Largest number of parts of one dot.")
          .range(1, 16777216)
          .slider(1, 65536)
          .logarithmic(),
      r.lod.max_children);
    d(spec("holdout", "Holdout", "", "Hides what lies behind and shows nothing itself."), r.holdout);
    d(spec("isolate", "Isolate", "", "Rendered alone, then laid on whole."), r.isolate);
}

}  // namespace astrosplat

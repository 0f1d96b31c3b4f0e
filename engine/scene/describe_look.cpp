// The description of [layer.look] and [layer.render], one line per parameter, which are also what
// a preset holds.
#include "scene/describe_layer.h"

namespace astrosplat {

using Type = ParameterType;
using namespace traits;

namespace {

void describe_curve(const Describer& d, DensityCurve& curve) {
    d(curve.shape, "shape", "Density with distance", "", "How density falls from the surface to reach.",
      shown_as("Shape"));
    d(curve.rate, "rate", "Rate", "", "Exponential: e^(-rate x).", within(0, 1e6), slider(0, 20),
      only_with("shape", {"exponential"}));
    d(curve.sigma, "sigma", "Sigma", "of reach", "Gaussian: standard deviation.", within(1e-6, 1e6),
      slider(0.01, 2), only_with("shape", {"gaussian"}));
    d(curve.points, "points", "Points", "", "Curve: points (x, density) with x ascending.", within(0, 1e6),
      only_with("shape", {"curve"}));
}

void describe_thickness_stop(const Describer& d, ThicknessStop& stop) {
    d(stop.color, "color", "Map colour", "", "Colour of the thickness map that this stop stands for.",
      as(Type::color), range(0, 1));
    d(stop.scale, "scale", "Thickness of the stop", "of reach", "Reach where the map has this colour.",
      within(0, 1e6), slider(0, 4), shown_as("Thickness"));
    describe_curve(d, stop.pdf);
}

void describe_noise(const Describer& d, Noise& n) {
    d(n.frequency, "frequency", "Frequency", "per scene unit", "Lumps per scene unit of the coarsest octave.",
      within(0, 1e6), slider(0.01, 100), logarithmic());
    d(n.octaves, "octaves", "Octaves", "", "Layers of finer and finer noise.", range(1, 16));
    d(n.lacunarity, "lacunarity", "Lacunarity", "", "Frequency of an octave over the one before.",
      within(0.01, 16), slider(1, 4));
    d(n.gain, "gain", "Octave gain", "", "Strength of an octave over the one before.", within(0, 16),
      slider(0, 1));
    d(n.seed, "seed", "Noise seed", "", "Another number gives another noise.", slider(0, 1000));
    d(n.cull, "cull", "Thins out", "", "How much of the density the noise takes.", range(0, 1));
    d(n.silhouette, "silhouette", "Frays the edge", "", "How much of the reach the noise takes.",
      range(0, 1));
    d(n.jitter, "jitter", "Jitters positions", "scene units", "Moves splats along the layer's axis.",
      slider(0, 1));
    d(n.alpha, "alpha", "Varies opacity", "", "Opacity times 1 + this * noise.", within(-1e6, 1e6),
      slider(0, 1));
    d(n.brightness, "brightness", "Varies brightness", "", "Colour times 1 + this * noise.",
      within(-1e6, 1e6), slider(0, 1));
}

void describe_crop(const Describer& d, Crop& c) {
    d(c.shape, "shape", "Crop", "", "What is kept of the layer, or cut from it.", shown_as("Shape"));
    d(c.keep, "keep", "Keeps", "", "Which side of the shape stays.");
    d(c.center, "center", "Centre", "scene units",
      "Of the shape, in the layer's own space; the eye that an outline was drawn from.", as(Type::position),
      slider(-10, 10));
    d(c.size, "size", "Size", "scene units", "Of the box, from side to side.", within(1e-6, 1e12),
      slider(0, 10), only_with("shape", {"box"}));
    d(c.rotate, "rotate", "Rotation", "degrees", "Turns box or view about x, then y, then z.",
      within(-1e6, 1e6), slider(-180, 180), never_with("shape", {"sphere"}));
    d(c.radius, "radius", "Radius", "scene units", "Of the sphere.", within(1e-6, 1e12), slider(0, 10),
      only_with("shape", {"sphere"}));
    d(c.outline, "outline", "Drawn lines", "",
      "Drawn in a view: \"M x y x y x y M ...\", right of and above its line, per unit of depth.",
      only_with("shape", {"outline"}));
    d(c.width, "width", "Stroke", "",
      "Lines are the middles of strokes of this width; 0: they close polygons.", within(0, 1e6),
      slider(0, 0.2), only_with("shape", {"outline"}), zero_is("None"));
    d(c.parallel, "parallel", "Parallel", "",
      "The view has no eye: points are in scene units, and hold at any depth.",
      only_with("shape", {"outline"}));
    d(c.soft, "soft", "Soft edge", "scene units",
      "Width of the band at the surface over which opacity falls.", at_least(0), slider(0, 2));
}

void describe_alpha(const Describer& d, HorizontalAlpha& a) {
    d(a.power, "power", "Opacity at soft edges", "", "Opacity below the threshold is raised to this power.",
      within(0, 1e6), slider(0.1, 10), logarithmic(), shown_as("Power"));
    d(a.threshold, "threshold", "Threshold", "", "Opacity from here on is left alone.", range(0, 1));
    d(a.unpremultiply, "unpremultiply", "Full colour at edges", "",
      "Divides colours below the threshold by their opacity.");
    d(a.gain, "gain", "Opacity gain", "", "Multiplies opacity.", within(0, 1e6), slider(0, 4));
}

void describe_vertical(const Describer& d, VerticalAlpha& v) {
    d(v.shape, "shape", "Opacity with distance", "", "How opacity falls from the surface to reach.",
      shown_as("Shape"));
    d(v.rate, "rate", "Rate", "", "Exponential: e^(-rate x).", within(0, 1e6), slider(0, 20),
      only_with("shape", {"exponential"}));
    d(v.points, "points", "Points", "", "Curve: points (x, opacity) with x ascending.", within(0, 1e6),
      only_with("shape", {"curve"}));
    d(v.reach, "reach", "Reach of opacity", "scene units",
      "Where x = 1 for this alone; 0: the layer's reach.", at_least(0), slider(0, 10), zero_is("Auto"),
      shown_as("Reach"));
    d(v.match, "match", "Match the picture", "",
      "Makes the front view show the picture's opacity; picture: its light too, measured part by part; auto: "
      "coverage for meshes, none for splat files.");
}

void describe_radius(const Describer& d, Radius& r) {
    d(r.min, "min", "Smallest size", "scene units",
      "Smallest radius; with max 0 too: the file's, or 0.6 voxel diagonals.", at_least(0), slider(0, 1),
      shown_as("Smallest"), zero_is("Auto"));
    d(r.max, "max", "Largest size", "scene units", "Largest radius.", at_least(0), slider(0, 1),
      shown_as("Largest"), zero_is("Auto"));
    d(r.horizontal_scale, "horizontal_scale", "Size at soft edges", "",
      "Factor on the radius where opacity is 0.", within(0, 1e6), slider(0, 4), shown_as("At soft edges"));
    d(r.vertical_scale, "vertical_scale", "Size with distance", "", "Factor on the radius at reach.",
      within(0, 1e6), slider(0, 4), shown_as("With distance"));
}

void describe_grade(const Describer& d, Grade& g) {
    d(g.gain, "gain", "Colour gain", "", "Multiplies the colour.", within(0, 1e6), slider(0.01, 100),
      logarithmic());
    d(g.tint, "tint", "Tint", "", "Multiplies the colour per channel.", as(Type::color), within(0, 1e6),
      slider(0, 2));
    d(g.saturation, "saturation", "Saturation", "", "0: grey, 1: as it is.", within(0, 1e6), slider(0, 3));
    d(g.gamma, "gamma", "Gamma", "", "Colour is raised to 1 / gamma.", within(0.01, 100), slider(0.2, 5),
      logarithmic());
    d(g.black, "black", "Black", "", "Subtracted from the colour, which is then stretched back.", at_least(0),
      below(1), slider(0, 0.5));
}

}  // namespace

void describe_look(const Describer& d, Look& look) {
    const auto section = [&](const char* title) { return d.shown_in("Look", title); };
    const Describer density = section("With distance"), thickness = section("Thickness map");
    density(look.density, "density", "Density", "", "Share of the positions that become splats.",
            within(0, 1e6), slider(0, 1));
    density(look.reach, "reach", "Reach", "scene units",
            "Distance where x = 1; 0: max_distance, or a file's largest distance.", at_least(0),
            slider(0, 10), zero_is("Auto"));
    describe_curve(density.in("pdf", true), look.pdf);
    thickness(look.thickness.map, "thickness.map", "Thickness map", "",
              "Picture whose colours choose among the stops.", shown_as("Picture"));
    thickness.in("thickness", false)(look.thickness.derive, "derive", "Map of it", "",
                                     "Reads the picture as a grey map of it: dust, H-alpha, young stars.",
                                     never_with("map", {""}));
    thickness.list("thickness.keys", look.thickness.stops, describe_thickness_stop);
    section("Noise").list("noise", look.noise, describe_noise);
    section("Crop").list("crop", look.crop, describe_crop);
    describe_alpha(section("Opacity at soft edges").in("alpha", true), look.alpha);
    describe_vertical(density.in("vertical", true), look.vertical);
    describe_radius(section("Size").in("radius", true), look.radius);
    describe_grade(section("Colour").in("grade", true), look.grade);
}

void describe_render(const Describer& d, LayerRender& r) {
    const Describer splat = d.shown_in("Mixing", "Splat profile"), mixing = d.shown_in("Mixing", "Blend"),
                    detail = d.shown_in("Mixing", "Level of detail");
    splat(r.falloff.shape, "falloff", "Splat profile", "", "How a splat fades from its centre to its rim.",
          shown_as("Shape"));
    splat(r.falloff.core, "core", "Core", "of the radius", "Trapezoid: the flat part.", range(0, 1),
          only_with("falloff", {"trapezoid"}));
    splat(r.falloff.sharpness, "sharpness", "Sharpness", "",
          "Gaussian and exponential: how fast the splat fades.", within(1e-6, 1e6), slider(0.5, 20),
          only_with("falloff", {"gaussian", "exponential"}));
    mixing(r.blend, "blend", "Blend", "", "How splats mix with what lies behind.");
    mixing(r.opacity, "opacity", "Opacity", "", "Of the whole layer.", range(0, 1));
    mixing(r.hybrid_from_deg, "hybrid.from_deg", "Over up to", "degrees",
           "Hybrid: over up to this angle from the axis.", range(0, 90), only_with("blend", {"hybrid"}));
    mixing(r.hybrid_to_deg, "hybrid.to_deg", "Screen from", "degrees", "Hybrid: screen from this angle on.",
           range(0, 90), only_with("blend", {"hybrid"}));
    mixing(
        r.absorb, "absorb", "Absorption", "r, g, b",
        "Absorb: the layer shines not at all; of each channel it lets (1 - opacity) to this power through.",
        range(0, 10), slider(0, 3), only_with("blend", {"absorb"}));
    detail(r.lod.max_px, "lod.max_px", "Split above", "px at 1080 lines",
           "Splats that look larger are split; 0: off.", at_least(0), slider(0, 200), zero_is("Off"));
    detail(r.lod.max_children, "lod.max_children", "Most children", "",
           "Largest number of parts of one splat.", range(1, 16777216), slider(1, 65536), logarithmic());
    detail(r.lod.noise, "lod.noise", "Noise of parts", "",
           "How strongly the parts of a splat differ in light, as clouds do; stars of pictures stay whole.",
           range(0, 2));
    detail(r.lod.star_distance, "lod.star_distance", "Points within", "scene units",
           "Stars of pictures that are nearer to the camera hardly grow and get brighter instead, as points "
           "do; 0: they grow as all splats.",
           at_least(0), slider(0, 20), zero_is("Off"), only_with("blend", {"over", "add"}));
    mixing(r.holdout, "holdout", "Holdout", "", "Hides what lies behind and shows nothing itself.");
    mixing(r.isolate, "isolate", "Isolate", "", "Rendered alone, then composited as a whole.");
    mixing(r.space, "space", "Mixed in", "",
           "display: splats are mixed as a display shows them (sRGB), as captures are trained, and the "
           "image is made linear again; of isolated layers that mix by over.",
           only_with("isolate", {true}), only_with("blend", {"over"}));
}

}  // namespace astrosplat

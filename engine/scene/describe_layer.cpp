// The description of one layer, one line per parameter: [[layer]], transform and source, then [layer.look]
// and [layer.render], which are also what a preset holds.
#include "scene/describe_layer.h"

#include "core/file_format.h"
#include "core/text.h"
#include "scene/describe_prepare.h"
#include "source/mesh.h"

namespace astrosplat {

namespace {

using Type = ParameterType;
using namespace traits;

void describe_transform(const Describer& d, LayerTransform& t) {
    d(t.translate, "translate", "Position", "scene units", "Moves the layer after generation.",
      as(Type::position), slider(-100, 100));
    d(t.rotate, "rotate", "Rotation", "degrees", "Turns the layer about x, then y, then z.",
      slider(-180, 180));
    d(t.scale, "scale", "Scale", "", "Scales positions and radii about the layer's origin.",
      within(1e-9, 1e9), slider(0.01, 100), logarithmic());
}

/// Each measure is of one shape only.
void describe_shape(const Describer& d, ShapeParams& s) {
    const auto of = [](const char* shape) { return only_with("mesh", {shape}); };
    d(s.outline, "outline", "Outline", "scene units",
      "Points [r, y] from end to end, turned about the y axis.", within(-1e6, 1e6), in_any_order(),
      of("revolution"));
    d(s.width, "width", "Width", "of half the length", "Width of the lobes.", within(0.001, 100),
      slider(0.1, 1), of("hourglass"));
    d(s.waist, "waist", "Waist", "", "From a figure eight, 0, to a spheroid, 1.", range(0.01, 1),
      of("hourglass"));
    d(s.thickness, "thickness", "Thickness", "of the radius", "Between the outer and the inner wall.",
      range(0.001, 0.99), of("shell"));
    d(s.opening, "opening", "Opening", "degrees", "From the axis to the rim.", range(0, 170), of("bubble"));
    d(s.flattening, "flattening", "Flattening", "", "1 - height / width.", within(-10, 0.99), slider(0, 0.9),
      of("spheroid"));
    d(s.shells, "shells", "Shells", "", "How many shells are nested; more fill the inside.", range(1, 64),
      of("spheroid"));
    d(s.concentration, "concentration", "Concentration", "",
      "Shells gather towards the middle: their density falls as e^(-this r / R).", range(0, 20),
      of("spheroid"), never_with("shells", {std::int64_t(1)}));
    d(s.tube, "tube", "Tube", "of the radius", "Radius of the ring's tube.", range(0.001, 0.5), of("ring"));
    d(s.depth_map, "depth_map", "Depth map", "",
      "Grey picture of depths, black farthest; empty: the picture's brightness.", of("sheet"));
    d(s.depth, "depth", "Depth", "of the width", "From the farthest to the nearest place.", within(0, 1e6),
      slider(0, 1), of("sheet"));
    d(s.blur, "blur", "Blur", "of the longer side", "Smooths the depths; standard deviation.", range(0, 0.2),
      of("sheet"));
}

void describe_mesh(const Describer& d, MeshInput& mesh) {
    d(mesh.mesh, "mesh", "Mesh", "", "Mesh file, or a built-in shape.",
      one_of({builtin_meshes.begin(), builtin_meshes.end()}));
    d(mesh.texture, "texture", "Picture", "",
      "Picture on the mesh: empty for the mesh's own, three for red, green and blue.", or_no_text());
    d(mesh.relief, "relief", "Relief", "of the width", "Height of the built-in relief.", within(-1e6, 1e6),
      slider(0, 1), only_with("mesh", {"relief"}));
    describe_shape(d, mesh.shape);
}

void describe_texture(const Describer& d, TextureSettings& t) {
    d(t.colorspace, "colorspace", "Colour space", "",
      "How the picture's numbers are read; auto: 8 and 16 bit as sRGB, float as linear.");
    d(t.alpha, "alpha", "Alpha from", "",
      "Where opacity comes from; auto: the file's, else the largest channel.");
    d(t.unpremultiply, "unpremultiply", "Unpremultiply picture", "",
      "Stored colours are matted on black and are divided by alpha.", shown_as("Unpremultiply"));
    describe_fits(d, t);
    d(t.filter, "filter", "Filter", "", "How the picture is read between its pixels.");
    d(t.wrap, "wrap", "Outside the picture", "",
      "What lies beyond 0..1; auto: clamp for built-in and planar, repeat for the mesh's own uv.");
}

void describe_mask_terms(const Describer& d, MaskTerms& m) {
    d(m.luminance, "luminance", "Luminance", "",
      "From, to: displayed brightness, 0 to 1, or the map's value with derive; []: all.", range(0, 1));
    d(m.hue, "hue", "Hue", "degrees", "From, to: red 0, green 120, blue 240; may pass 360; []: all.",
      range(0, 360));
    d(m.saturation, "saturation", "Saturation", "", "From, to: 0 grey, 1 pure; []: all.", range(0, 1));
    d(m.ellipse, "ellipse", "Ellipse", "u, v, widths",
      "Centre (u, v from the bottom left) and half axes in picture widths; []: everywhere.",
      within(-100, 100), slider(0, 1));
    d(m.turn, "turn", "Turn", "degrees", "Turns the ellipse counter-clockwise.", slider(-180, 180),
      never_with("ellipse", {Value()}));
    d(m.image, "image", "Mask picture", "",
      "Grey picture that covers the texture: white shows, black hides.");
    d(m.derive, "derive", "Map", "", "Weighs by a map made of the picture: dust, H-alpha, young stars.");
    d(m.feather, "feather", "Feather", "",
      "Width of soft edges: share of the range, of all hues, of the picture's width.", range(0, 1));
    d(m.invert, "invert", "Invert", "", "Shows what it would hide.");
}

void describe_mask(const Describer& d, MaskParams& mask) {
    describe_mask_terms(d, mask);
    d.list("any", mask.any, describe_mask_terms);
}

void describe_rework(const Describer& d, TextureSettings& t) {
    d(t.derive, "derive", "Map", "", "Shows a map made of the picture: dust, H-alpha, young stars.");
    d(t.smooth, "smooth", "Smooth", "of the width", "Blurs the picture; standard deviation.", range(0, 0.2));
    d(t.detail, "detail", "Detail", "of the width",
      "Leaves only what a blur of this width takes away; 0: everything.", range(0, 0.2), zero_is("Off"));
    d.list("mask", t.mask, describe_mask);
}

/// One number stands for the same on every axis.
void describe_buffer(const Describer& d, std::optional<glm::dvec3>& buffer) {
    d.custom(
        spec("buffer", "Buffer", "scene units",
             "Room around the meshes' box: one number or x, y, z; auto: max_distance.", as(Type::vector),
             components(3), or_auto(), at_least(0), slider(0, 10)),
        [&buffer](const ParameterSpec& own) {
            const bool uniform = buffer && buffer->x == buffer->y && buffer->y == buffer->z;
            return uniform ? Value(buffer->x) : Field<std::optional<glm::dvec3>>::get(buffer, own);
        },
        [&buffer](const Value& value, const ParameterSpec& own) {
            buffer = value.is_number() ? glm::dvec3(number_of(value, own))
                                       : Field<std::optional<glm::dvec3>>::set(value, own);
        });
}

void describe_stars(const Describer& d, StarsParams& stars) {
    d(stars.catalogue, "catalogue", "Catalogue", "",
      "Stars: Hipparcos (hip_main.dat), HYG, or a table with ra, dec and mag; or with like the stars.csv of "
      "a "
      "prepared picture; .gz too.");
    d(stars.like, "like", "Stars of", "",
      "The layer whose picture the catalogue's stars were found in (prepare's stars.csv): its surface, "
      "camera, "
      "depths and transform are theirs, and from that camera they look as in the picture.");
    const Describer of_picture = d.never_with("like", {""});
    of_picture(
        stars.depth, "depth", "Depth by", "",
        "Where the stars of a picture lie in their layer's depth: layer spreads them as it spreads its "
        "own, magnitude sorts them, the brightest nearest.");
    of_picture(stars.slab, "slab", "Slab", "scene units",
               "The stars of a picture lie within this depth around the surface, evenly; 0: as deep as their "
               "layer's own.",
               at_least(0), slider(0, 20), zero_is("Auto"));
    d(stars.unit, "unit", "Parsec", "scene units", "Scene units per parsec.", within(1e-9, 1e9),
      slider(0.001, 1000), logarithmic());
    d(stars.limit, "limit", "Faintest star", "magnitude",
      "Stars fainter than this, seen from the layer's origin, are left out.", slider(-2, 20));
    d(stars.zero_point, "zero_point", "Zero point", "magnitude",
      "Magnitude of a star whose light, summed over all pixels, is that of one white pixel.",
      within(-100, 100), slider(-2, 20));
    d(stars.along, "along", "Along", "",
      "camera: count random stars around the camera's path, with the catalogue's magnitudes and colours, or "
      "without one those of the main sequence.",
      one_of({"", "camera"}));
    d(stars.spread, "spread", "Spread", "scene units",
      "Random stars lie within this distance of the path, evenly.", within(1e-9, 1e9), slider(0.1, 1000),
      logarithmic(), only_with("along", {"camera"}));
}

/// How stars look, which changes no set.
void describe_star_image(const Describer& d, StarsParams& stars) {
    d(stars.psf, "psf", "Star size", "px", "Standard deviation of a star's disc, in any frame size.",
      within(0.01, 100), slider(0.3, 5));
    const Describer wings = d.in("wings", true), spikes = d.in("spikes", true);
    wings(stars.wings.share, "share", "Wings", "",
          "Share of a star's light in the faint wings around its disc.", range(0, 1));
    const Describer winged = wings.never_with("share", {0.0});
    winged(stars.wings.px, "px", "Width of wings", "px", "The wings fall as (1 + (r / width)^2)^-power.",
           within(0.01, 1000), slider(0.5, 30));
    winged(stars.wings.power, "power", "Power of wings", "", "How steeply the wings fall.", within(1.01, 20),
           slider(1.1, 5));
    spikes(stars.spikes.share, "share", "Spikes", "", "Share of a star's light in diffraction spikes.",
           range(0, 1));
    const Describer spiked = spikes.never_with("share", {0.0});
    spiked(stars.spikes.vanes, "vanes", "Vanes", "",
           "That hold the telescope's secondary mirror: an odd number makes twice as many spikes.",
           range(1, 16));
    spiked(stars.spikes.angle, "angle", "Angle of spikes", "degrees", "Turns the spikes counter-clockwise.",
           slider(-90, 90));
    spiked(stars.spikes.px, "px", "Length of spikes", "px", "Where a spike has fallen to 1/e.",
           within(0.1, 10000), slider(1, 200));
}

void describe_structure(const Describer& d, StructureParams& s) {
    const Describer bodies = d.only_with("kind", {"disk", "sheet", "walls"});
    d(s.kind, "kind", "Structure", "",
      "How the picture gets depth: columns extrudes it; disk (galaxies), sheet (nebulae) and walls (shells) "
      "make bodies.");
    bodies(s.height, "height", "Scale height", "scene units",
           "Thickness; 0: 1.8 % of the picture's longest side for a disk, else 1.1 %.", at_least(0),
           slider(0, 1), zero_is("Auto"));
    d(s.depth, "depth", "Structure depth", "of the width",
      "Whole depth of walls, or of the relief of a flat sheet.", within(0, 10), slider(0, 0.5),
      only_with("kind", {"sheet", "walls"}), shown_as("Depth"));
    bodies(s.clumps, "clumps", "Clumps", "", "How strongly depths gather in clouds.", within(0, 100),
           slider(0, 3));
    const Describer disk = d.only_with("kind", {"disk"});
    disk(s.flare, "flare", "Flare", "", "How much thicker the disk is at its rim than in the middle, less 1.",
         within(-0.9, 10), slider(-0.5, 2));
    disk(s.warp, "warp", "Warp", "of the width",
         "How far the disk's plane rises at the rim, and sinks on the other side.", within(-1, 1),
         slider(-0.1, 0.1));
    bodies(s.stars, "stars", "Stars apart", "",
           "Stars are found and become single splats; auto: unless prepare removes them.");
    bodies(s.dust, "dust", "Dust", "",
           "Share of the dark details that becomes dust; auto: four fifths in a disk, else none.", or_auto(),
           range(0, 1));
    bodies(s.opacity, "opacity", "Opacity power", "",
           "Power of brightness that opacity grows with; low makes dim parts denser.", within(0.01, 10),
           slider(0.2, 1.5));
    bodies(s.density, "density", "Body density", "", "Opacity of white.", within(0, 1), slider(0.1, 0.98));
    bodies(s.border, "border", "Soft border", "of the width",
           "Light fades over this share towards the picture's edges.", within(0, 0.5), slider(0, 0.2));
    bodies(
        s.margin, "margin", "Picture margin", "of the width",
        "How far a picture on a plane goes on beyond its edges, mirrored and fading: without straight edges "
        "from aslant, and whole from the front.",
        within(0, 0.5), slider(0, 0.3));
}

void describe_uv_camera(const Describer& d, UvCamera& c) {
    d(c.position, "position", "Picture's camera", "scene units",
      "Where the camera stood that took the picture, in the meshes' space.", as(Type::position),
      slider(-100, 100));
    d(c.target, "target", "Its target", "scene units", "The point in the middle of the picture.",
      as(Type::position), slider(-100, 100));
    d(c.up, "up", "Its up", "", "The direction that is up in the picture.", slider(-1, 1));
    d(c.fov, "fov", "Its field of view", "degrees", "From the picture's bottom to its top.", at_least(0.001),
      below(180), slider(1, 120), only_with("height", {0.0}));
    d(c.height, "height", "Its height", "scene units",
      "From the picture's bottom to its top, with parallel rays; 0: fov.", at_least(0), slider(0, 100),
      zero_is("Off"));
}

void describe_source(const Describer& d, SourceParams& s) {
    const Describer files = d.shown_in("Source", "Files"), splats = d.shown_in("Source", "Splats");
    const Describer lattice = splats.only_with("kind", {"mesh"});
    files(s.kind, "kind", "Kind", "", "What the splats are made of.");
    files.list("meshes", s.meshes, describe_mesh);
    describe_texture(d.shown_in("Source", "Picture").only_with("kind", {"mesh"}), s.texture);
    describe_prepare(d.shown_in("Source", "Prepare").only_with("kind", {"mesh"}).in("prepare", false),
                     s.texture.prepare);
    describe_rework(d.shown_in("Source", "Masks").only_with("kind", {"mesh"}), s.texture);
    describe_buffer(lattice, s.buffer);
    lattice(s.voxels, "voxels", "Voxels", "", "Test positions per axis; auto: cubic, from count.", or_auto(),
            range(1, 1e6));
    lattice(s.voxel_size, "voxel_size", "Voxel size", "scene units",
            "Edge of a voxel instead of voxels; 0: not used.", at_least(0), slider(0, 1),
            only_with("voxels", {"auto"}), zero_is("Off"));
    splats(s.count, "count", "Count", "",
           "About how many positions voxels = \"auto\" keeps; or how many random stars there are.",
           range(1, 1e15), slider(1e4, 1e9), logarithmic(), never_with("kind", {"splats"}),
           only_with("voxels", {"auto"}), only_with("voxel_size", {0.0}),
           only_with("splats", {std::int64_t(0)}));
    lattice(s.splats, "splats", "Splats", "",
            "In place of count: positions left after the picture's alpha and masks; 0: count. Pictures are "
            "reduced until their bodies are no more.",
            range(0, 1e15), slider(1e4, 1e9), logarithmic(), only_with("voxels", {"auto"}),
            only_with("voxel_size", {0.0}), zero_is("Off"));
    lattice(s.jitter, "jitter", "Lattice jitter", "of half a voxel", "How far positions leave the lattice.",
            range(0, 1));
    lattice(s.max_distance, "max_distance", "Largest distance", "scene units",
            "Positions farther from the meshes are dropped; 0: 2 % of the longest side.", at_least(0),
            slider(0, 10), zero_is("Auto"));
    files.only_with("kind", {"mesh"})(s.uv, "uv", "Picture coordinates", "",
                                      "The mesh's own, or projected along an axis or from a camera.");
    const Describer planar =
        files.only_with("kind", {"mesh"}).only_with("uv", {"planar-xy", "planar-xz", "planar-yz"});
    planar(s.uv_width, "uv_width", "Picture width", "scene units",
           "What the picture's width covers; 0: it is stretched over the meshes' box.", at_least(0),
           slider(0, 100), zero_is("Auto"));
    planar(s.uv_center, "uv_center", "Picture centre", "scene units", "Where the picture's middle lies.",
           as(Type::position), slider(-10, 10), never_with("uv_width", {0.0}));
    planar(s.back, "back", "Back wall", "",
           "What lies behind the middle shows: the same, the picture mirrored, or displaced by noise.");
    describe_uv_camera(files.only_with("kind", {"mesh"}).only_with("uv", {"camera"}).in("uv_camera", false),
                       s.uv_camera);
    describe_structure(d.shown_in("Source", "Structure").only_with("kind", {"mesh"}).in("structure", false),
                       s.structure);
    splats(s.seed, "seed", "Layer seed", "", "Random numbers of this layer; 0: from the layer's name.",
           slider(0, 1000), zero_is("Auto"));
    static const std::string splat_files =
        "For kind = \"splats\": " + alternatives(endings_of({FileKind::splats})) + ", also of Gaussians.";
    files(s.file, "file", "Splat file", "", splat_files.c_str(), only_with("kind", {"splats"}));
    describe_stars(files.only_with("kind", {"stars"}), s.stars);
    describe_star_image(d.shown_in("Source", "Star image").only_with("kind", {"stars"}).animated(), s.stars);
}

}  // namespace

void describe_layer(const Describer& d, LayerParams& layer) {
    const Describer own = d.shown_in("Source", "Layer"), placement = d.shown_in("Source", "Placement");
    own(layer.name, "name", "Name", "", "Letters, digits and _, beginning with a letter.");
    own.animated()(layer.visible, "visible", "Visible", "", "Whether the layer is rendered.");
    placement(layer.axis, "axis", "Axis", "", "The layer's thin direction: noise and hybrid use it.",
              slider(-1, 1));
    own(layer.preset, "preset", "Preset", "",
        "A file with [look] and [render]; keys of the scene win over it.");
    describe_transform(placement.in("transform", true), layer.transform);
    describe_source(d.in("source", false), layer.source);
    describe_look(d.in("look", true), layer.look);
    describe_render(d.in("render", true), layer.render);
}

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
    d(c.center, "center", "Centre", "scene units", "Of the shape, in the layer's own space.",
      as(Type::position), slider(-10, 10));
    d(c.size, "size", "Size", "scene units", "Of the box, from side to side.", within(1e-6, 1e12),
      slider(0, 10), only_with("shape", {"box"}));
    d(c.rotate, "rotate", "Rotation", "degrees", "Turns the box about x, then y, then z.", within(-1e6, 1e6),
      slider(-180, 180), only_with("shape", {"box"}));
    d(c.radius, "radius", "Radius", "scene units", "Of the sphere.", within(1e-6, 1e12), slider(0, 10),
      only_with("shape", {"sphere"}));
    d(c.soft, "soft", "Soft edge", "scene units",
      "Width of the band at the surface over which opacity falls.", at_least(0), slider(0, 2));
}

void describe_alpha(const Describer& d, HorizontalAlpha& a) {
    d(a.power, "power", "Opacity at soft edges", "", "Opacity below the threshold is raised to this power.",
      within(0, 1e6), slider(0.1, 10), logarithmic(), shown_as("Power"));
    d(a.threshold, "threshold", "Threshold", "", "Opacity from here on is left alone.", range(0, 1));
    d(a.unpremultiply, "unpremultiply", "Unpremultiply edges", "",
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
      "Makes the front view show the picture's opacity; picture: its light too, measured part by part; "
      "auto: coverage for meshes, none for splat files.");
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
    const Describer density = section("Density with distance"), thickness = section("Thickness map");
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
    describe_vertical(section("Opacity with distance").in("vertical", true), look.vertical);
    describe_radius(section("Size").in("radius", true), look.radius);
    describe_grade(section("Colour").in("grade", true), look.grade);
}

void describe_render(const Describer& d, LayerRender& r) {
    const Describer dot = d.shown_in("Mixing", "Dot profile"), mixing = d.shown_in("Mixing", "Blend"),
                    detail = d.shown_in("Mixing", "Level of detail");
    dot(r.falloff.shape, "falloff", "Dot profile", "", "How a splat fades from its centre to its rim.",
        shown_as("Shape"));
    dot(r.falloff.core, "core", "Core", "of the radius", "Trapezoid: the flat part.", range(0, 1),
        only_with("falloff", {"trapezoid"}));
    dot(r.falloff.sharpness, "sharpness", "Sharpness", "",
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
           "picture is "
           "made linear again; of isolated layers that mix by over.",
           only_with("isolate", {true}), only_with("blend", {"over"}));
}

}  // namespace astrosplat

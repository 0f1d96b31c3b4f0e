// The description of one layer, one line per parameter: [[layer]], transform and source.
#include "scene/describe_layer.h"

#include "core/file_format.h"
#include "core/text.h"
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
      "Grey picture of depths, black farthest, or an EXR's distances (Z); empty: the picture's brightness.",
      of("sheet"));
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
      "Stars: Hipparcos (hip_main.dat), HYG, or a table (CSV, VOTable, FITS) with ra, dec and mag; or with "
      "like the stars.csv of a prepared picture; .gz and .bz2 too.");
    d(stars.like, "like", "Stars of", "",
      "The layer whose picture the catalogue's stars were found in (prepare's stars.csv): its surface, "
      "camera, depths and transform are theirs, and from that camera they look as in the picture.");
    const Describer of_picture = d.never_with("like", {""});
    of_picture(stars.depth, "depth", "Depth by", "",
               "Where the stars of a picture lie in their layer's depth: layer spreads them as it spreads "
               "its own, magnitude sorts them, the brightest nearest.");
    of_picture(stars.slab, "slab", "Slab", "scene units",
               "The stars of a picture lie within this depth around the surface, evenly; 0: as deep as their "
               "layer's own.",
               at_least(0), slider(0, 20), zero_is("Auto"));
    d(stars.unit, "unit", "Parsec", "scene units",
      "Scene units per parsec; auto: by scene.light_years_per_unit where that is known, else 1.", or_auto(),
      within(1e-9, 1e9), slider(0.001, 1000), logarithmic());
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

void describe_galaxy(const Describer& d, GalaxyParams& g) {
    d(g.inclination, "inclination", "Inclination", "degrees",
      "How far a galaxy's disk is turned from the picture's plane: 0 face-on, 90 edge-on; auto: found.",
      or_auto(), range(0, 90));
    d(g.position_angle, "position_angle", "Position angle", "degrees",
      "Of its major axis in the picture, counter-clockwise from right; auto: found.", or_auto(),
      within(-360, 360), slider(0, 180));
    d(g.center, "center", "Galaxy's middle", "of the picture",
      "Its middle, from the lower left corner; auto: found.", or_auto(), slider(0, 1));
    d(g.near_side, "near_side", "Near side", "degrees",
      "The direction of its nearer side, counter-clockwise from right; auto: where more dust is seen.",
      or_auto(), within(-360, 360), slider(0, 360));
    d(g.bulge, "bulge", "Bulge", "of the light", "Share of its spheroid; 1: no disk; auto: found.", or_auto(),
      range(0, 1));
}

void describe_structure(const Describer& d, StructureParams& s) {
    const Describer bodies = d.only_with("kind", {"disk", "sheet", "walls", "axis"});
    d(s.kind, "kind", "Structure", "",
      "How the picture gets depth: columns extrudes it; disk (galaxies), sheet (nebulae), walls (shells) "
      "and axis (bodies of revolution, as planetary nebulae) make bodies.");
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
    describe_galaxy(disk, s.galaxy);
    disk.list("galaxies", s.galaxies, describe_galaxy);
    disk(s.spiral, "spiral", "Invented arms", "",
         "How strongly arms are invented where a disk is seen from its edge, which no picture shows.",
         within(0, 10), slider(0, 3));
    const Describer axis = d.only_with("kind", {"axis"});
    axis(s.axis_angle, "axis_angle", "Axis of the nebula", "degrees",
         "Direction of the axis in the picture, counter-clockwise from right; auto: found by symmetry.",
         or_auto(), within(-360, 360), slider(0, 180));
    axis(s.tilt, "tilt", "Tilt of the axis", "degrees",
         "How far that end of the axis leans out of the picture, towards the viewer where positive; auto: "
         "found.",
         or_auto(), range(-80, 80));
    bodies(s.stars, "stars", "Separate stars", "",
           "Stars are found and become single splats; auto: unless prepare removes them.");
    bodies(s.dust, "dust", "Dust", "",
           "Share of the dark details that becomes dust; auto: four fifths in a disk, else none.", or_auto(),
           range(0, 1));
    bodies(s.opacity, "opacity", "Opacity power", "",
           "Power of brightness that opacity grows with; low makes dim parts denser.", within(0.01, 10),
           slider(0.2, 1.5));
    bodies(s.density, "density", "Opacity of white", "", "How opaque the brightest places become.",
           within(0, 1), slider(0.1, 0.98));
    bodies(s.border, "border", "Soft border", "of the width",
           "Light fades over this share towards the picture's edges.", within(0, 0.5), slider(0, 0.2));
    bodies(s.margin, "margin", "Picture margin", "of the width",
           "How far a picture on a plane goes on beyond its edges, mirrored and fading: without straight "
           "edges at an angle, and whole from the front.",
           within(0, 0.5), slider(0, 0.3));
    bodies(s.detail, "detail", "Invented detail", "octaves",
           "What close views show of each texel at most: 2 or 4 times as fine, and from afar the texel as it "
           "is.",
           range(0, 2));
    bodies(
        s.detail_tiles, "detail_tiles", "Its places", "",
        "Octaves of each tile of the picture, row by row with a blank between: where the camera comes close, "
        "as 'detail' writes them; empty: everywhere, 4 or 16 times as many splats.");
    bodies(s.detail_strength, "detail_strength", "Its grain", "",
           "Of the noise where the picture has no like of a place to copy from.", range(0, 1));
}

void describe_uv_camera(const Describer& d, UvCamera& c) {
    d(c.position, "position", "Picture's camera", "scene units",
      "Where the camera stood that took the picture, in the meshes' space.", as(Type::position),
      slider(-100, 100));
    d(c.target, "target", "Its target", "scene units", "The point in the middle of the picture.",
      as(Type::position), slider(-100, 100));
    d(c.up, "up", "Its upward direction", "", "The direction that is up in the picture.", slider(-1, 1));
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
    lattice(s.jitter, "jitter", "Random offset", "half voxels",
            "How far positions leave the middle of their voxel.", range(0, 1));
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

void describe_fits(const Describer& d, TextureSettings& t) {
    d.custom(
        spec("hdu", "Picture in file", "",
             "Number or name of the FITS HDU, EXR part or layer or TIFF page; auto: the one that shows most.",
             as(Type::text)),
        [&t](const ParameterSpec&) {
            const bool number =
                is_list_index(t.hdu) && t.hdu.size() < 10 && (t.hdu[0] != '0' || t.hdu == "0");
            return number ? Value(std::int64_t(std::stol(t.hdu))) : Value(t.hdu);
        },
        [&t](const Value& value, const ParameterSpec& s) {
            const bool number = std::holds_alternative<std::int64_t>(value.data);
            t.hdu = number ? to_toml(value) : text_of(value, s);
        });
    d(t.plane, "plane", "FITS plane", "",
      "Plane of a FITS cube, from 0; auto: three are colours, else the first that shows.", or_auto(),
      at_least(0), slider(0, 100));
    d(t.stretch, "stretch", "Stretch", "",
      "Curve from data values to display values; auto: asinh for FITS, linear else.");
    d(t.black, "black", "Black point", "data values", "Data value shown as 0; auto: the 0.25 percentile.",
      or_auto(), within(-1e30, 1e30), slider(0, 1));
    d(t.white, "white", "White point", "data values", "Data value shown as 1; auto: the 99.75 percentile.",
      or_auto(), within(-1e30, 1e30), slider(0, 1));
    d(t.softening, "softening", "Softening", "", "Where the asinh stretch turns from linear to logarithmic.",
      within(1e-9, 1e9), slider(0.001, 1), logarithmic());
}

void describe_prepare(const Describer& d, PrepareParams& p) {
    d(p.align, "align", "Align with", "",
      "FITS picture of the same field: this one is put on its grid of the sky.");
    d(p.starless, "starless", "Starless", "",
      "The same picture without its stars, as StarNet, StarXTerminator and Siril make it; the picture itself "
      "then "
      "shows the stars alone. Their sum is the picture; stars are measured where they are alone.");
    d(p.fill, "fill", "Fill", "",
      "Picture of the same size: what is not black in it is filled from its surroundings.");
    d(p.stars, "stars", "Stars", "", "Kept, or removed: what they hid is filled from around them.");
    const Describer removal = d.only_with("stars", {"remove"});
    removal(p.threshold, "threshold", "Threshold", "times the noise", "Least height of a star.",
            within(0.01, 1e9), slider(2, 20));
    removal(p.saturation, "saturation", "Saturation", "linear light",
            "Where the picture saturates; auto: 0.98 in 8 and 16 bit, nowhere in others.", or_auto(),
            within(1e-9, 1e9), slider(0.1, 1));
    d(p.background, "background", "Background", "",
      "Kept, or taken off as a level, a slope (plane) or one that bends (curved).");
    d(p.lupton, "lupton", "Lupton", "",
      "One asinh of the mean for all three channels in place of the stretch: bright parts keep their "
      "colour.");
    const Describer bent = d.only_with("lupton", {true});
    bent(p.q, "q", "Q", "", "How early that asinh bends.", within(1e-6, 1e6), slider(0.1, 100),
         logarithmic());
    bent(p.lupton_stretch, "lupton_stretch", "Lupton stretch", "of the white point",
         "Intensity it shows at a tenth of white.", within(1e-9, 1e9), slider(0.001, 1), logarithmic());
    d(p.ellipse, "ellipse", "Ellipse", "px",
      "Centre from the top left and half axes of what stays, the rest is cut off; []: everything.",
      within(-1e6, 1e6), slider(0, 4000));
    const Describer edge = d.never_with("ellipse", {Value()});
    edge(p.turn, "turn", "Turn", "degrees", "Turns the ellipse counter-clockwise.", slider(-180, 180));
    edge(p.feather, "feather", "Feather", "of the half axes", "Over which it fades, inwards.", range(0, 1));
    d(p.mask, "mask", "Mask picture", "", "Picture of the same size: what is black in it is cut off.");
    d(p.alpha, "alpha", "Alpha", "luminance", "From, to: alpha from luminance, 0 to 1; []: none.",
      within(-1e6, 1e6), slider(0, 1));
}

Description describe_preparation(TextureSettings& t) {
    Description description;
    const Describer d(description, {}, false);
    describe_fits(d, t);
    describe_prepare(d, t.prepare);
    return description;
}

std::string prepare_option(const ParameterKey& key) {
    if (key == "q") return "--lupton-q";  // newer CLI11 takes --q for -q
    std::string option = "--" + key.text();
    std::ranges::replace(option, '_', '-');
    return option;
}

}  // namespace astrosplat

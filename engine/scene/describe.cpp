// The description of everything but the layers, and the functions over descriptions.
#include "scene/describe.h"

#include "scene/describe_layer.h"

namespace astrosplat {

void Describer::custom(ParameterSpec field_spec, std::function<Value(const ParameterSpec&)> get,
                       std::function<void(const Value&, const ParameterSpec&)> set) const {
    using Type = ParameterType;
    field_spec.key = group_ / field_spec.key;
    field_spec.generic_key = field_spec.key.generic();
    field_spec.tab = tab_;
    field_spec.section = section_;
    if (field_spec.row_label.empty()) field_spec.row_label = field_spec.label;
    for (Condition& condition : field_spec.conditions) condition.key = group_ / condition.key;
    field_spec.conditions.insert(field_spec.conditions.end(), conditions_.begin(), conditions_.end());
    const Type type = field_spec.type;
    const bool no = type == Type::text || type == Type::words || type == Type::file || type == Type::files ||
                    type == Type::pattern;
    const bool steps = type == Type::boolean || type == Type::integer || type == Type::choice;
    field_spec.animation = no || !animated_ ? Animation::no : steps ? Animation::steps : Animation::yes;
    description_->parameters.push_back({std::move(field_spec), std::move(get), std::move(set)});
}

namespace {

using Type = ParameterType;
using namespace traits;

void describe_output(const Describer& d, OutputParams& o) {
    const Describer frame = d.shown_in("Output", "Frame"), frames = d.shown_in("Output", "Frames"),
                    format = d.shown_in("Output", "File format");
    frame(o.preset, "preset", "Preset", "",
          "A file with [output] and [camera] for a kind of screen, by name: dome. Keys of the scene win "
          "over it, but not where --set names it.");
    frame.custom(
        spec("resolution", "Resolution", "px", "Width and height of the frames.", as(Type::vector),
             components(2), range(1, 65536), slider(16, 8192)),
        [&o](const ParameterSpec& own) {
            return Field<glm::i64vec2>::get({o.width, o.height}, own);
        },
        [&o](const Value& value, const ParameterSpec& own) {
            const glm::i64vec2 size = Field<glm::i64vec2>::set(value, own);
            o.width = size.x;
            o.height = size.y;
        });
    frames(o.frames, "frames", "Frames", "", "Frames to render, such as 1-100,120,200-300x2.");
    frames(o.fps, "fps", "Frames per second", "fps", "Written into the frames; nothing moves by it.",
           within(1e-3, 1e6), slider(1, 120));
    frames(o.path, "path", "Frame files", "",
           "Where frames go; #### is the frame, the ending the format: .exr .tif .png.", as(Type::pattern));
    format(o.depth, "depth", "Bit depth", "", "auto: exr half, tif 16, png 8.");
    format(o.compression, "compression", "Compression", "",
           "exr: zip zips piz dwaa none; tif: deflate lzw none.");
    format(o.alpha, "alpha", "Alpha", "", "auto: exr and tif premultiplied, png none (opaque over black).");
    format(o.primaries, "primaries", "Primaries", "",
           "Of scene light in exr, named in its header: rec709 (D65) or acescg (AP1). Views stay rec709.");
    format(o.aovs, "aovs", "Extra channels", "", "Of depth, coverage, count and layers; exr only.",
           one_of({OutputParams::known_aovs.begin(), OutputParams::known_aovs.end()}));
    const Describer built_in =
        frame.only_with("ocio.config", {""}).only_with("ocio.display", {""}).only_with("ocio.view", {""});
    built_in(o.view, "view", "View", "", "auto: linear in exr and float tif, srgb in 8 and 16 bit.");
    frame.animated()(o.exposure, "exposure", "Exposure", "stops",
                     "Acts where a view is written; exr and float tif hold scene light.", range(-100, 100),
                     slider(-8, 8));
    frame(o.pixel_filter, "pixel_filter", "Pixel filter", "px", "Standard deviation of the pixel filter.",
          range(0.3, 2));
    frame(o.samples, "samples", "Samples", "",
          "Renderings whose mean a frame with motion blur or depth of field is.", range(1, 4096),
          slider(1, 256));
}

/// Colour management by OpenColorIO.
void describe_ocio(const Describer& d, OcioParams& o) {
    d(o.config, "config", "Colour config", "",
      "A configuration of OpenColorIO, whose displays and views take the place of view; empty: that of the "
      "environment's OCIO, where display or view is set.");
    d(o.display, "display", "Display", "", "Of the configuration; empty: its first.");
    d(o.view, "view", "Display view", "", "Of the display; empty: its first. Acts where a view is written.");
    d(o.space, "space", "Light is", "",
      "The configuration's name for linear light of Rec. 709; empty: looked for, else its role "
      "scene_linear.");
}

/// The projections with a left and a right eye.
std::vector<Value> two_eyed() {
    std::vector<Value> names;
    for (int k = 0; const std::string& name : all_names<Projection>())
        if (has_two_eyes(Projection(k++))) names.emplace_back(name);
    return names;
}

void describe_camera(const Describer& d, CameraParams& c) {
    const Describer place = d.shown_in("Camera", "Place"), lens = d.shown_in("Camera", "Lens");
    lens(c.projection, "projection", "Projection", "", "How space becomes a frame.");
    place(c.position, "position", "Position", "scene units",
          "Where the camera stands; [] frames all visible layers.", as(Type::position), slider(-100, 100));
    place(c.target, "target", "Target", "scene units", "The point in the middle of the frame.",
          as(Type::position), slider(-100, 100), only_with("rotation", {Value()}));
    place(c.up, "up", "Up", "", "The direction that is up in the frame.", slider(-1, 1),
          only_with("rotation", {Value()}));
    place(c.rotation, "rotation", "Rotation", "",
          "Quaternion x y z w, world from camera; replaces target, up and roll; [] is none.",
          as(Type::rotation), slider(-1, 1));
    place(c.roll, "roll", "Roll", "degrees", "Turns the camera about its line of sight.", slider(-180, 180),
          only_with("rotation", {Value()}));
    lens(c.fov, "fov", "Field of view", "degrees", "Vertical field of view.", at_least(0.001), below(180),
         slider(5, 120), only_with("projection", {"perspective"}), only_with("focal_length", {0.0}));
    lens(c.focal_length, "focal_length", "Focal length", "mm", "Above 0 it replaces fov, with film_width.",
         within(0, 1e6), slider(0, 300), only_with("projection", {"perspective"}), zero_is("Off"));
    lens(c.film_width, "film_width", "Film width", "mm", "Width of the film behind focal_length.",
         within(0.001, 1e6), slider(8, 70), only_with("projection", {"perspective"}),
         never_with("focal_length", {0.0}));
    lens(c.shift, "shift", "Shift", "frames",
         "Widths and heights of the frame by which it shows what is farther to the right and up, without "
         "turning.",
         range(-10, 10), slider(-0.5, 0.5), only_with("projection", {"perspective"}));
    lens(c.fisheye_fov, "fisheye_fov", "Fisheye angle", "degrees",
         "The full cone of a fisheye, as wide as the frame's shorter side.", within(0.001, 360),
         slider(90, 360), only_with("projection", {"fisheye"}));
    lens(c.fisheye_tilt, "fisheye_tilt", "Fisheye tilt", "degrees",
         "How far a fisheye's axis points above the target; 90: the target is on a level dome's lower rim.",
         range(-180, 180), slider(0, 90), only_with("projection", {"fisheye"}));
    lens(c.panorama_fov, "panorama_fov", "Panorama width", "degrees",
         "From the left to the right of an equirectangular or cylindrical frame.", within(0.001, 360),
         slider(60, 360), only_with("projection", {"equirectangular", "cylindrical"}));
    lens(c.height, "height", "Height", "scene units", "Scene units from bottom to top, orthographic.",
         at_least(1e-6), slider(0.1, 1000), logarithmic(), only_with("projection", {"orthographic"}));
    lens(c.shutter, "shutter", "Shutter", "degrees",
         "Motion blur: how long of a frame's 360 the shutter is open, half before it, half after.",
         within(0, 720), slider(0, 360), zero_is("Off"));
    lens(c.f_number, "f_number", "F-number", "",
         "Depth of field: the focal length over the aperture's width.", within(0, 1e6), slider(0, 22),
         only_with("projection", {"perspective"}), zero_is("Off"));
    lens(c.focus_distance, "focus_distance", "Focus distance", "scene units",
         "Where it is sharp, along the line of sight; 0: at the target's distance.", at_least(0),
         slider(0, 100), only_with("projection", {"perspective"}), never_with("f_number", {0.0}),
         zero_is("Target"));
    lens(c.unit_mm, "unit_mm", "Unit", "mm",
         "Of a scene unit, for depth of field: as if the scene was a model of that size.", within(1e-6, 1e12),
         slider(1, 100000), logarithmic(), only_with("projection", {"perspective"}),
         never_with("f_number", {0.0}));
    const Describer stereo = d.shown_in("Camera", "Stereo").only_with("projection", two_eyed());
    stereo.still()(c.eye, "eye", "Eye", "",
                   "The eye of a stereo pair that is shown; where %V is in output.path, it stands for left "
                   "and right and --batch writes both.");
    stereo(c.eye_separation, "eye_separation", "Eye separation", "scene units", "From eye to eye.",
           at_least(0), slider(0, 1));
    stereo(c.convergence, "convergence", "Convergence", "scene units",
           "Where both eyes see the same: nearer is before the screen; 0: at the target's distance.",
           at_least(0), slider(0, 100), zero_is("Target"));
    lens(c.near, "near", "Near", "scene units", "Nothing nearer is drawn.", at_least(1e-9), slider(0.001, 10),
         logarithmic());
    lens(c.far, "far", "Far", "scene units", "Nothing farther is drawn; 0: no limit.", at_least(0),
         slider(0, 10000), zero_is("No limit"));
    lens(c.near_fade, "near_fade", "Near fade", "scene units",
         "Splats fade in over this beyond near; 0: one radius of the splat.", at_least(0), slider(0, 10),
         zero_is("Auto"));
}

// Read once for all frames: none of these can be animated.
void describe_camera_file(const Describer& d, CameraParams& c) {
    d(c.file, "file", "Camera file", "",
      "Another program's camera; its path, turns and lens replace these keys, a .csv any keys it names.");
    const Describer read = d.never_with("file", {""});
    read(c.file_scale, "file_scale", "Unit of the file", "scene units",
         "Scene units per unit of the camera file.", within(1e-30, 1e30), slider(0.001, 1000), logarithmic());
    read(c.file_up, "file_up", "Up in the file", "",
         "Its axis that is up; auto: as the file says, or is usual.");
    read(c.file_offset, "file_offset", "Frames added", "frames", "Added to the frames of the camera file.",
         within(-1e9, 1e9), slider(-1000, 1000));
    read(c.file_fps, "file_fps", "Frame rate of the file", "fps",
         "Frames per second of the camera file; 0: as it says, else output.fps.", within(0, 1e6),
         slider(0, 120), zero_is("As it says"));
}

void describe_environment(const Describer& d, EnvironmentParams& e) {
    d(e.image, "image", "Picture", "", "Equirectangular picture behind everything.");
    d(e.cube, "cube", "Cube pictures", "",
      "Or six pictures of the faces of a cube around the origin, in the order +x -x +y -y +z -z.");
    d(e.gain, "gain", "Light gain", "", "Multiplies its light.", within(0, 1e6), slider(0.01, 100),
      logarithmic());
    d(e.rotation, "rotation", "Rotation", "degrees", "Turns it about x, then y, then z.", slider(-180, 180));
    d(e.behind, "behind", "Distance", "scene units",
      "How far from the origin it lies, so that near things move before it; 0: infinitely far.", at_least(0),
      slider(0, 1000), zero_is("Infinite"));
    d(e.visible, "visible", "Visible", "", "Whether it is drawn.");
}

void describe_tiling(const Describer& d, EnvironmentParams& e) {
    d(e.tile, "tile", "Tiled picture", "",
      "Or one picture of a part of the sky, such as a deep field: cut-outs of it, turned at random, make up "
      "the whole.");
    const Describer tiled = d.never_with("tile", {""});
    tiled(e.tiling.height_deg, "tile_height", "Its size", "degrees",
          "What the picture's shorter side covers on the sky.", range(2, 120), slider(5, 90));
    tiled(e.tiling.seed, "tile_seed", "Its seed", "", "Which cut-outs lie where.", slider(0, 1000));
    tiled(e.tiling.face_px, "tile_px", "Its detail", "px",
          "Pixels along a quarter of the sky's circle; more are finer and take more memory.", range(64, 8192),
          slider(512, 4096));
}

void describe_provenance(const Describer& d, ProvenanceParams& p) {
    d(p.title, "title", "Title", "", "Written into every frame; empty: from the inputs' own metadata.");
    d(p.credit, "credit", "Credit", "", "Written into every frame; empty: from the inputs' own metadata.");
    d(p.type, "type", "Type", "",
      "What the frames are, in AVM's words; auto: a simulation where all inputs say that they are, else "
      "artwork.",
      one_of({"auto", "Artwork", "Simulation"}));
}

void describe_scale(const Describer& d, Scene& scene) {
    d(scene.light_years_per_unit, "light_years_per_unit", "Scene unit", "light years",
      "How long a scene unit is in the sky: for distances and scale bars in the window, and for stars whose "
      "layer.source.unit is auto; 0: unknown.",
      at_least(0), slider(0, 1e5), zero_is("Unknown"));
}

void describe_reference(const Describer& d, ReferenceParams& r) {
    d(r.file, "file", "Picture", "", "Picture that the window compares the view with; it reaches no frame.");
    const Describer placed = d.never_with("file", {""});
    placed(
        r.view, "view", "In view", "",
        "The view it belongs to; any: every view. Where several fit, the first of the view itself is taken.");
    placed(r.frames, "frames", "At frames", "", "Frames it belongs to, such as 1-100,120; empty: all.");
    placed(r.position, "position", "Position", "of the height",
           "Where the picture's middle lies: right of and above the frame's middle.", within(-1e6, 1e6),
           slider(-1, 1));
    placed(r.scale, "scale", "Scale", "of the height", "The picture's height over the frame's.",
           within(1e-6, 1e6), slider(0.1, 10), logarithmic());
    placed(r.rotate, "rotate", "Rotation", "degrees", "Turns the picture counter-clockwise.",
           slider(-180, 180));
    placed(r.mirrored, "mirrored", "Mirrored", "", "Swaps left and right, before the picture is turned.");
    placed(r.opacity, "opacity", "Opacity", "", "Of the picture over the view.", range(0, 1));
}

}  // namespace

Description describe(Scene& scene) {
    return describe(scene, [](const ParameterKey&) { return true; });
}

Description describe(Scene& scene, const std::function<bool(const ParameterKey& group)>& wanted) {
    Description description;
    const Describer d(description, {}, false);
    if (wanted("output")) {
        describe_output(d.in("output", false), scene.output);
        describe_ocio(d.in("output.ocio", false).shown_in("Output", "Colour management"), scene.output.ocio);
    }
    if (wanted("camera")) {
        describe_camera(d.in("camera", true), scene.camera);
        describe_camera_file(d.in("camera", false).shown_in("Camera", "Place"), scene.camera);
    }
    if (wanted("environment")) {
        const Describer sky = d.in("environment", true).shown_in("Environment", "Environment");
        describe_environment(sky, scene.environment);
        describe_tiling(sky.still(), scene.environment);
    }
    if (wanted("provenance"))
        describe_provenance(d.in("provenance", false).shown_in("Output", "Provenance"), scene.provenance);
    if (wanted("scene")) describe_scale(d.in("scene", false).shown_in("Output", "Provenance"), scene);
    if (wanted("reference"))
        d.shown_in("Camera", "Reference").list("reference", scene.references, describe_reference);
    for (LayerParams& layer : scene.layers) {
        const ParameterKey group = layer_key(layer.name);
        if (wanted(group)) describe_layer(Describer(description, group, false), layer);
    }
    return description;
}

Description describe_preset(Look& look, LayerRender& render) {
    Description description;
    const Describer d(description, {}, false);
    describe_look(d.in("look", true), look);
    describe_render(d.in("render", true), render);
    return description;
}

std::vector<std::string> layer_names(const Scene& scene) {
    std::vector<std::string> names;
    for (const LayerParams& layer : scene.layers) names.push_back(layer.name);
    return names;
}

ParameterKey full_key(const Description& description, const ParameterKey& key) {
    for (const ParameterList& list : description.lists) {
        if (!key.is_below(list.key)) continue;
        const std::string_view rest = key.below(list.key);
        if (!is_list_index(rest.substr(0, rest.find('.')))) return full_key(description, list.key / 0 / rest);
    }
    return key;
}

const Parameter* find_parameter(const Description& description, const ParameterKey& key) {
    const ParameterKey full = full_key(description, key);
    for (const Parameter& parameter : description.parameters)
        if (parameter.spec.key == full) return &parameter;
    return nullptr;
}

ParameterKey section_of(const ParameterKey& generic_key) {
    for (const std::string_view section :
         {"layer.transform", "layer.source", "layer.look", "layer.render", "layer", "output", "camera",
          "environment", "provenance", "scene", "reference", "animation", "look", "render"})
        if (generic_key.is_below(section)) return section;
    return {};
}

const std::vector<ParameterRow>& parameter_rows() {
    static const std::vector<ParameterRow> rows = [] {
        Scene scene;
        scene.references.resize(1);
        scene.layers.resize(1);
        scene.layers[0].source.meshes.resize(1);
        scene.layers[0].source.texture.mask.resize(1);
        scene.layers[0].source.texture.mask[0].any.resize(1);
        scene.layers[0].look.thickness.stops.resize(1);
        scene.layers[0].look.noise.resize(1);
        scene.layers[0].look.crop.resize(1);
        std::vector<ParameterRow> result;
        for (const Parameter& parameter : describe(scene).parameters) {
            result.push_back({parameter.spec, parameter.get()});
            result.back().spec.key = parameter.spec.generic_key;
        }
        return result;
    }();
    return rows;
}

std::string value_words(const ParameterSpec& spec) {
    const char* animated = spec.animation == Animation::no      ? ""
                           : spec.animation == Animation::steps ? "; animated in steps"
                                                                : "; animated";
    const std::string unit = spec.unit.empty() ? "" : ", " + spec.unit;
    return fmt::format("({}{}{})", expectation(spec), unit, animated);
}

std::string parameter_table() {
    std::string table;
    ParameterKey section;
    for (const ParameterRow& row : parameter_rows()) {
        const ParameterSpec& s = row.spec;
        if (const ParameterKey own = section_of(s.key); own != section) {
            table += fmt::format("{}[{}]\n", table.empty() ? "" : "\n", own);
            section = own;
        }
        table += fmt::format("{:<34} = {:<20} # {} {}\n", s.key, to_toml(row.value), s.help, value_words(s));
    }
    return table;
}

}  // namespace astrosplat

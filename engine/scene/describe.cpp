// The description of everything but the layers, and the functions over descriptions.
#include "scene/describe.h"

#include <algorithm>

#include "scene/describer.h"

namespace astrosplat {

void Describer::place(ParameterSpec& field_spec, bool animated) const {
    using Type = ParameterType;
    field_spec.key = group_ / field_spec.key;
    field_spec.generic_key = field_spec.key.generic();
    const Type type = field_spec.type;
    const bool no = type == Type::text || type == Type::words || type == Type::file || type == Type::files ||
                    type == Type::pattern;
    const bool steps = type == Type::boolean || type == Type::integer || type == Type::choice;
    field_spec.animation = no || !animated ? Animation::no : steps ? Animation::steps : Animation::yes;
}

namespace {

using Type = ParameterType;

void describe_output(const Describer& d, OutputParams& o) {
    ParameterSpec resolution = spec("resolution", "Resolution", "px", "Width and height of the frames.");
    resolution.components = 2;
    d.custom(
        resolution.as(Type::vector).range(1, 65536).slider(16, 8192),
        [&o](const ParameterSpec& own) {
            return Field<glm::i64vec2>::get({o.width, o.height}, own);
        },
        [&o](const Value& value, const ParameterSpec& own) {
            const glm::i64vec2 size = Field<glm::i64vec2>::set(value, own);
            o.width = size.x;
            o.height = size.y;
        });
    d(spec("frames", "Frames", "", "Frames to render, such as 1-100,120,200-300x2."), o.frames);
    d(spec("fps", "Frames per second", "1/s", "Written into the frames; nothing moves by it.")
          .above(0)
          .slider(1, 120),
      o.fps);
    d(spec("path", "Frame files", "",
           "Where frames go; #### is the frame, the ending the format: .exr .tif .png.")
          .as(Type::pattern),
      o.path);
    d(spec("depth", "Bit depth", "", "auto: exr half, tif 16, png 8.")
          .one_of({"auto", "half", "float", "16", "8"}),
      o.depth);
    d(spec("compression", "Compression", "", "exr: zip zips piz dwaa none; tif: deflate lzw none.")
          .one_of({"auto", "zip", "zips", "piz", "dwaa", "deflate", "lzw", "none"}),
      o.compression);
    d(spec("alpha", "Alpha", "", "auto: exr and tif premultiplied, png none (opaque over black).")
          .one_of({"auto", "premultiplied", "straight", "none"}),
      o.alpha);
    d(spec("aovs", "Extra channels", "", "Of depth, coverage, count and layers; exr only.")
          .one_of({"depth", "coverage", "count", "layers"}),
      o.aovs);
    d(spec("view", "View", "", "auto: linear in exr and float tif, srgb in 8 and 16 bit.")
          .one_of({"auto", "linear", "srgb", "soft"}),
      o.view);
    d(spec("exposure", "Exposure", "stops",
           "Acts where a view is written; exr and float tif hold scene light.")
          .range(-100, 100)
          .slider(-8, 8),
      o.exposure, true);
    d(spec("pixel_filter", "Pixel filter", "px", "Standard deviation of the pixel filter.").range(0.3, 2),
      o.pixel_filter);
}

void describe_camera(const Describer& d, CameraParams& c) {
    d(spec("projection", "Projection", "", "How space becomes a picture.")
          .one_of({"perspective", "orthographic", "fisheye", "equirectangular"}),
      c.projection);
    d(spec("position", "Position", "scene units", "Where the camera stands; [] frames all visible layers.")
          .as(Type::position)
          .slider(-100, 100),
      c.position);
    d(spec("target", "Target", "scene units", "The point in the middle of the picture.")
          .as(Type::position)
          .slider(-100, 100),
      c.target);
    d(spec("up", "Up", "", "The direction that is up in the picture.").slider(-1, 1), c.up);
    d(spec("rotation", "Rotation", "",
           "Quaternion x y z w, world from camera; replaces target, up and roll; [] is none.")
          .as(Type::rotation)
          .slider(-1, 1),
      c.rotation);
    d(spec("roll", "Roll", "degrees", "Turns the camera about its line of sight.").slider(-180, 180), c.roll);
    d(spec("fov", "Field of view", "degrees", "Vertical field of view.").above(0).below(180).slider(5, 120),
      c.fov);
    d(spec("focal_length", "Focal length", "mm", "Above 0 it replaces fov, with film_width.")
          .at_least(0)
          .slider(0, 300),
      c.focal_length);
    d(spec("film_width", "Film width", "mm", "Width of the film behind focal_length.").above(0).slider(8, 70),
      c.film_width);
    d(spec("fisheye_fov", "Fisheye angle", "degrees", "The full cone of a fisheye.")
          .above(0)
          .range(0, 360)
          .slider(90, 360),
      c.fisheye_fov);
    d(spec("height", "Height", "scene units", "Scene units from bottom to top, orthographic.")
          .above(0)
          .slider(0.1, 1000)
          .logarithmic(),
      c.height);
    d(spec("near", "Near", "scene units", "Nothing nearer is drawn.")
          .above(0)
          .slider(0.001, 10)
          .logarithmic(),
      c.near);
    d(spec("far", "Far", "scene units", "Nothing farther is drawn; 0: no limit.")
          .at_least(0)
          .slider(0, 10000),
      c.far);
    d(spec("near_fade", "Near fade", "scene units",
           "Splats fade in over this beyond near; 0: one radius of the splat.")
          .at_least(0)
          .slider(0, 10),
      c.near_fade);
    d(spec("file", "Camera file", "", "Camera path to import instead of these keys."), c.file);
}

void describe_environment(const Describer& d, EnvironmentParams& e) {
    d(spec("image", "Picture", "", "Equirectangular picture behind everything."), e.image);
    d(spec("cube", "Cube pictures", "", "Or six pictures, in the order +x -x +y -y +z -z."), e.cube);
    d(spec("gain", "Gain", "", "Multiplies its light.").at_least(0).slider(0.01, 100).logarithmic(), e.gain);
    d(spec("rotation", "Rotation", "degrees", "Turns it about x, then y, then z.").slider(-180, 180),
      e.rotation);
    d(spec("visible", "Visible", "", "Whether it is drawn."), e.visible);
}

void describe_provenance(const Describer& d, ProvenanceParams& p) {
    d(spec("title", "Title", "", "Written into every frame."), p.title);
    d(spec("credit", "Credit", "", "Written into every frame; empty: from the inputs' own metadata."),
      p.credit);
    d(spec("type", "Type", "", "What the pictures are.").one_of({"Artwork", "Simulation"}), p.type);
}

}  // namespace

Description describe(Scene& scene) {
    return describe(scene, [](const ParameterKey&) { return true; });
}

Description describe(Scene& scene, const std::function<bool(const ParameterKey& group)>& wanted) {
    Description description;
    const Describer d(description, {}, false);
    if (wanted("output")) describe_output(d.section("output", false), scene.output);
    if (wanted("camera")) describe_camera(d.section("camera", true), scene.camera);
    if (wanted("environment")) describe_environment(d.section("environment", true), scene.environment);
    if (wanted("provenance")) describe_provenance(d.section("provenance", false), scene.provenance);
    for (LayerParams& layer : scene.layers) {
        const ParameterKey group = layer_key(layer.name);
        if (wanted(group)) describe_layer(Describer(description, group, false), layer);
    }
    return description;
}

Description describe_preset(Look& look, LayerRender& render) {
    Description description;
    const Describer d(description, {}, false);
    describe_look(d.section("look", true), look);
    describe_render(d.section("render", true), render);
    return description;
}

ParameterKey full_key(const Description& description, const ParameterKey& key) {
    for (const ParameterList& list : description.lists) {
        if (!key.is_below(list.key)) continue;
        const std::string_view rest = key.below(list.key);
        return is_list_index(rest.substr(0, rest.find('.'))) ? key : list.key / 0 / rest;
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
          "environment", "provenance", "animation", "look", "render"})
        if (generic_key.is_below(section)) return section;
    return {};
}

const std::vector<ParameterRow>& parameter_rows() {
    static const std::vector<ParameterRow> rows = [] {
        Scene scene;
        scene.layers.resize(1);
        scene.layers[0].source.meshes.resize(1);
        scene.layers[0].look.thickness.keys.resize(1);
        scene.layers[0].look.noise.resize(1);
        std::vector<ParameterRow> result;
        for (const Parameter& parameter : describe(scene).parameters) {
            result.push_back({parameter.spec, parameter.get()});
            result.back().spec.key = parameter.spec.generic_key;
        }
        return result;
    }();
    return rows;
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
        const char* animated = s.animation == Animation::no      ? ""
                               : s.animation == Animation::steps ? "; animated in steps"
                                                                 : "; animated";
        const std::string unit = s.unit.empty() ? "" : ", " + s.unit;
        table += fmt::format("{:<34} = {:<20} # {} ({}{}{})\n", s.key, to_toml(row.standard), s.help,
                             expectation(s), unit, animated);
    }
    return table;
}

}  // namespace astrosplat

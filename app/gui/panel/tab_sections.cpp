#include <fmt/format.h>

#include <map>

#include "core/file_format.h"
#include "core/text.h"
#include "edit/edits.h"
#include "edit/view_camera.h"
#include "gui/panel/parts.h"
#include "gui/parts.h"
#include "scene/detail_tiles.h"

namespace astrosplat::panel {
namespace {

bool unfolded(const Context&) { return true; }

bool is_fits(const Context& context) {
    for (const MeshInput& mesh : context.layer().source.meshes)
        for (const auto& texture : mesh.texture) {
            const FileFormat* const format = format_by_name(texture);
            if (format && format->id == "fits") return true;
        }
    return false;
}

/// The value of a parameter of the layer, in words.
template <const auto& key>
std::string value_of(const Context& context) {
    const Parameter* parameter = find(context, context.layer_key() / key);
    return parameter ? in_words(parameter->spec, parameter->get()) : "";
}
constexpr char falloff[] = "render.falloff", blend[] = "render.blend", structure[] = "source.structure.kind";

std::string files_state(const Context& context) {
    const SourceParams& source = context.layer().source;
    if (source.kind == SourceKind::splats) return source.file.filename().string();
    if (source.kind == SourceKind::stars) return source.stars.catalogue.filename().string();
    return source.meshes.empty() ? "none" : source.meshes.front().mesh.filename().string();
}

bool has_pictures(const Context& context) { return context.layer().source.kind == SourceKind::mesh; }

std::string preparation_state(const Context& context) {
    const PrepareParams& params = context.layer().source.texture.prepare;
    if (!prepares(params)) return "none";
    return params.stars == PrepareParams::Stars::remove ? "stars removed" : "changed";
}

std::string masks_state(const Context& context) {
    const TextureSettings& texture = context.layer().source.texture;
    if (!texture.mask.empty()) return counted(std::ssize(texture.mask), "mask");
    const bool changed = texture.derive != Derived::none || texture.smooth > 0.0 || texture.detail > 0.0;
    return changed ? "changed" : "none";
}

std::string splats_state(const Context& context) {
    const std::int64_t splats = context.layer_status().splats;
    return splats > 0 ? short_count(splats) : "";
}

std::string placement_state(const Context& context) {
    const LayerTransform& transform = context.layer().transform;
    return transform == LayerTransform() ? "as it lies" : fmt::format("x {}", figures(transform.scale));
}

void splats_note(Context& context) {
    const std::int64_t splats = context.layer_status().splats;
    if (splats > 0) note("It has " + splat_count(splats) + ".");
}

/// Of the lattice of test positions, which bodies do without.
bool is_of_lattice(const ParameterKey& key) {
    static constexpr const char* keys[] = {"buffer", "voxels", "voxel_size",
                                           "count",  "jitter", "max_distance"};
    return std::ranges::any_of(keys,
                               [&](const char* own) { return key == ParameterKey("layer.source") / own; });
}

/// Of a set that is still growing the preview knows too little.
std::string kept_state(const Context& context) {
    const LayerStatus& status = context.layer_status();
    const bool is_known = status.splats > 0 && status.kept >= 0 && !status.loading;
    return is_known ? percent(double(status.kept) / double(status.splats)) + " kept" : "";
}

void kept_note(Context& context) {
    if (const std::string kept = kept_state(context); !kept.empty())
        note(kept + " of " + splat_count(context.layer_status().splats));
}

std::string alpha_state(const Context& context) {
    const HorizontalAlpha& alpha = context.layer().look.alpha;
    return alpha == HorizontalAlpha() ? "off" : "power " + short_number(widen(alpha.power));
}

std::string distance_state(const Context& context) {
    static constexpr char shape[] = "look.vertical.shape";
    if (context.layer().look.vertical.shape == VerticalAlpha::Shape::none) return kept_state(context);
    return value_of<shape>(context);
}

std::string size_state(const Context& context) {
    const Radius& radius = context.layer().look.radius;
    if (radius.min == 0.0f && radius.max == 0.0f) return "auto";
    return short_number(widen(radius.min)) + " to " + short_number(widen(radius.max));
}

template <auto list>
std::string length_of(const Context& context) {
    const std::size_t length = (context.layer().look.*list).size();
    return length == 0 ? "off" : std::to_string(length);
}

std::string thickness_state(const Context& context) {
    const Thickness& thickness = context.layer().look.thickness;
    return thickness.map.empty() && thickness.stops.empty() ? "off"
                                                            : counted(std::ssize(thickness.stops), "stop");
}

std::string color_state(const Context& context) {
    return context.layer().look.grade == Grade() ? "off" : "changed";
}

void lighten_note(Context& context) {
    if (context.layer().render.blend == Blend::lighten)
        note("Lighten is always composited as a whole, in the order of the list.");
}

std::string detail_state(const Context& context) {
    const LevelOfDetail& lod = context.layer().render.lod;
    return lod.max_px > 0.0f ? figures(widen(lod.max_px)) + " px" : "off";
}

std::string place_state(const Context& context) {
    if (is_animated(context.document.scene(), "camera.position")) return "animated";
    return context.scene().camera.position ? "" : "auto";
}

std::string environment_state(const Context& context) {
    const EnvironmentParams& environment = context.scene().environment;
    if (environment.image.empty() && environment.cube.empty() && environment.tile.empty()) return "none";
    const fs::path& file = environment.tile.empty() ? environment.image : environment.tile;
    return environment.visible ? file.filename().string() : "hidden";
}

std::string reference_state(const Context& context) {
    const ReferenceParams* reference = seen_reference(context.scene(), context.status);
    return reference ? reference->file.filename().string() : "none";
}

std::string resolution_state(const Context& context) {
    const OutputParams& output = context.scene().output;
    return fmt::format("{} x {}", output.width, output.height);
}

std::string format_state(const Context& context) {
    const std::string& path = context.scene().output.path;
    return path.substr(std::min(path.rfind('.'), path.size()));
}

const TabSection sections[] = {
    {"Source", "Files", [](const Context& c) { return !has_bodies(c.layer()); }, files_state},
    {"Source", "Star image", unfolded,
     [](const Context& c) { return fmt::format("{:.3g} px", c.layer().source.stars.psf); }},
    {"Source",
     "Picture",
     is_fits,
     [](const Context& c) -> std::string { return is_fits(c) ? "FITS" : ""; },
     {"layer.source.black", "layer.source.white", "layer.source.stretch", "layer.source.softening",
      "layer.source.hdu", "layer.source.plane"}},
    {"Source", "Prepare", nullptr, preparation_state, {}, draw_preparation, has_pictures},
    {"Source", "Masks", nullptr, masks_state},
    {"Source", "Structure", unfolded, value_of<structure>, {}, detail_buttons},
    {"Source",
     "Splats",
     unfolded,
     splats_state,
     {"layer.source.count", "layer.source.splats", "layer.source.max_distance", "layer.source.voxels",
      "layer.source.voxel_size"},
     splats_note},
    {"Source", "Placement", nullptr, placement_state, {"layer.transform"}, placement_buttons},
    {"Source", "Layer", nullptr, [](const Context& c) -> std::string { return c.layer().name; }},
    {"Look",
     "With distance",
     [](const Context& c) { return !has_bodies(c.layer()); },
     distance_state,
     {"layer.look.pdf", "layer.look.density", "layer.look.reach"},
     kept_note},
    {"Look",
     "Opacity at soft edges",
     unfolded,
     alpha_state,
     {"layer.look.alpha.power", "layer.look.alpha.threshold", "layer.look.alpha.gain"}},
    {"Look", "Size", unfolded, size_state},
    {"Look", "Noise", nullptr, length_of<&Look::noise>},
    {"Look", "Thickness map", nullptr, thickness_state},
    {"Look", "Crop", nullptr, length_of<&Look::crop>, {}, crop_buttons},
    {"Look", "Colour", [](const Context& c) { return has_bodies(c.layer()); }, color_state},
    {"Look",
     "Whole look",
     nullptr,
     [](const Context&) -> std::string { return "export, apply, copy"; },
     {},
     look_buttons},
    {"Mixing", "Splat profile", unfolded, value_of<falloff>},
    {"Mixing",
     "Blend",
     unfolded,
     value_of<blend>,
     {"layer.render.blend", "layer.render.hybrid"},
     lighten_note},
    {"Mixing", "Level of detail", nullptr, detail_state},
    {"Camera", "Place", unfolded, place_state, {"camera.position", "camera.rotation"}},
    {"Camera", "Lens", unfolded, [](const Context& c) { return figures(c.scene().camera.fov) + " degrees"; }},
    {"Camera", "Stereo", nullptr,
     [](const Context& c) { return std::string(name_of(c.scene().camera.eye)); }},
    {"Camera", "Reference", nullptr, reference_state, {}, reference_buttons},
    {"Environment", "Environment", unfolded, environment_state, {"environment.visible"}},
    {"Output", "Frame", unfolded, resolution_state},
    {"Output", "Colour management", nullptr, colors_state, {}, colors_note},
    {"Output", "Frames", unfolded, [](const Context& c) -> std::string { return c.scene().output.frames; }},
    {"Output", "File format", nullptr, format_state},
    {"Output", "Provenance", nullptr,
     [](const Context& c) -> std::string { return c.scene().provenance.title; }}};

bool covers(const ParameterKey& group, const ParameterSpec& spec) {
    return spec.generic_key == group || spec.generic_key.is_below(group);
}

}  // namespace

std::span<const TabSection> tab_sections() { return sections; }

int order_of(const Context& context, const TabSection& section) {
    static const std::map<std::string, int> of_bodies{{"Structure", -2},    {"Colour", -2},
                                                      {"Picture", -1},      {"Splats", -1},
                                                      {"With distance", 1}, {"Files", 1}};
    const bool bodies = !context.scene().layers.empty() && has_bodies(context.layer());
    const auto found = of_bodies.find(section.title);
    return bodies && found != of_bodies.end() ? found->second : 0;
}

const char* head_of(const Context& context, const TabSection& section) {
    return section.title == "Files" && has_bodies(context.layer()) ? "More" : section.title.c_str();
}

std::size_t rank_in(const TabSection& section, const ParameterSpec& spec) {
    const auto found =
        std::ranges::find_if(section.first, [&](const auto& key) { return covers(key, spec); });
    return static_cast<std::size_t>(found - section.first.begin());
}

bool suits_layer(const Context& context, const ParameterSpec& spec) {
    if (spec.key.is_below("reference"))
        return context.status.reference &&
               spec.key.is_below(ParameterKey("reference") / context.status.reference->index);
    if (covers("layer.look.pdf", spec)) return context.layer().look.thickness.stops.empty();
    if (spec.generic_key == "layer.source.hdu" || spec.generic_key == "layer.source.plane")
        return is_fits(context);
    if (spec.generic_key == "layer.source.softening")
        return is_fits(context) || context.layer().source.texture.stretch == TextureSettings::Stretch::asinh;
    if (is_of_lattice(spec.generic_key)) return !has_bodies(context.layer());
    return suits_colors(context, spec);
}

void source_state(Context& context) {
    const LayerStatus& status = context.layer_status();
    const float width = ImGui::GetContentRegionAvail().x, top = ImGui::GetCursorPosY();
    if (status.loading || status.stale) {
        const std::string found = status.found > 0 ? ", " + splat_count(status.found) : "";
        load_line(context, context.view.layer, width, "Generating" + found, "Source changed");
    } else {
        const SourceParams& source = context.layer().source;
        const bool live = source.kind == SourceKind::mesh && !prepares(source.texture.prepare);
        note(live ? "Levels, masks and shape show at once; the rest regenerates."
                  : "Changing these regenerates the splats.");
    }
    // As high whatever it says, or the rows below would move under the mouse that drags one.
    ImGui::SetCursorPosY(std::max(ImGui::GetCursorPosY(), top + px(row_height + row_space)));
    if (!status.error.empty()) note(status.error, color::error);
    ImGui::Dummy({0.0f, px(4)});
}

void camera_buttons(Context& context) {
    const int clicked = button_line(context, {"Key camera here", "Add move"});
    if (clicked == 0)
        edit(context, "camera.position", "Set camera keyframe",
             [&](Scene& scene) { set_keyframe_of_seen_camera(scene, context.view, context.status); });
    if (clicked == 1) ImGui::OpenPopup("moves");
    if (begin_popup("moves")) {
        for (std::size_t i = 0; i < camera_move_names.size(); ++i)
            if (noted_menu_item(context, "panel", camera_move_names[i]))
                begin_move(context, static_cast<CameraMove>(i));
        end_menu_popup();
    }
    ImGui::Dummy({0.0f, px(4)});
}

void output_buttons(Context& context) {
    const int clicked = button_line(context, {"Render frames...", "Copy batch command"});
    if (clicked == 0) open_render_dialog(context.document, context.view, RenderKind::range);
    if (clicked == 1) request(context, Command::Kind::copy_batch_command);
    ImGui::Dummy({0.0f, px(4)});
}

}  // namespace astrosplat::panel

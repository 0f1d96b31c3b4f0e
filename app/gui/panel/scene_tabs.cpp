// Camera and Output: what belongs to the scene and not to a layer.
#include "gui/panel/scene_tabs.h"

#include "edit/camera_moves.h"
#include "edit/keys.h"
#include "gui/panel/row.h"
#include "gui/panel/section.h"
#include "gui/panel/words.h"
#include "gui/theme.h"

namespace astrosplat::panel {
namespace {

void rows(Context& context, std::initializer_list<const char*> keys) {
    for (const char* key : keys) parameter_row(context, key);
}

void camera_buttons(Context& context) {
    const int clicked = button_line({"Key camera here", "Add move"});
    if (clicked == 0)
        edit(context, "camera.position", "Key camera",
             [&](Scene& scene) { key_seen_camera(scene, context.view, context.status); });
    if (clicked == 1) ImGui::OpenPopup("moves");
    if (begin_popup("moves")) {
        for (std::size_t i = 0; i < camera_move_names.size(); ++i)
            if (ImGui::MenuItem(camera_move_names[i]))
                context.commands.push_back({Command::Kind::add_move, {}, "", i});
        end_popup();
    }
    ImGui::Dummy({0.0f, px(4)});
}

void place_section(Context& context) {
    const CameraParams& camera = context.scene().camera;
    const bool keyed = is_keyed(context.document.scene(), "camera.position");
    if (!section(context, "Place", keyed ? "keyed" : camera.position ? "" : "auto", true)) return;
    rows(context, {"camera.position", "camera.rotation"});
    if (!camera.rotation) rows(context, {"camera.target", "camera.up", "camera.roll"});
    parameter_row(context, "camera.file");
}

void lens_section(Context& context) {
    const CameraParams& camera = context.scene().camera;
    if (!section(context, "Lens", figures(camera.fov) + " degrees", true)) return;
    parameter_row(context, "camera.projection");
    if (camera.projection == Projection::perspective) {
        if (camera.focal_length == 0.0) parameter_row(context, "camera.fov");
        parameter_row(context, "camera.focal_length");
        if (camera.focal_length > 0.0) parameter_row(context, "camera.film_width");
    }
    if (camera.projection == Projection::orthographic) parameter_row(context, "camera.height");
    if (camera.projection == Projection::fisheye) parameter_row(context, "camera.fisheye_fov");
    rows(context, {"camera.near", "camera.near_fade", "camera.far"});
}

void environment_section(Context& context) {
    const EnvironmentParams& environment = context.scene().environment;
    const bool none = environment.image.empty() && environment.cube.empty();
    const std::string state = none                  ? "none"
                              : environment.visible ? environment.image.filename().string()
                                                    : "hidden";
    if (!section(context, "Environment", state)) return;
    rows(context, {"environment.visible", "environment.image", "environment.cube", "environment.gain",
                   "environment.rotation"});
}

void output_buttons(Context& context) {
    const int clicked = button_line({"Render range", "Copy batch command"});
    if (clicked == 0) context.commands.push_back({Command::Kind::render_range, {}, "", 0});
    if (clicked == 1) context.commands.push_back({Command::Kind::copy_batch_command, {}, "", 0});
    ImGui::Dummy({0.0f, px(4)});
}

}  // namespace

void camera_tab(Context& context) {
    camera_buttons(context);
    place_section(context);
    lens_section(context);
    environment_section(context);
}

void output_tab(Context& context) {
    output_buttons(context);
    const OutputParams& output = context.scene().output;
    const std::string size = std::to_string(output.width) + " x " + std::to_string(output.height);
    if (section(context, "Picture", size, true))
        rows(context, {"output.resolution", "output.view", "output.exposure", "output.pixel_filter"});
    if (section(context, "Frames", output.frames, true))
        rows(context, {"output.frames", "output.fps", "output.path"});
    if (section(context, "File format",
                output.path.substr(std::min(output.path.rfind('.'), output.path.size()))))
        rows(context, {"output.depth", "output.compression", "output.alpha", "output.aovs"});
    if (section(context, "Provenance", context.scene().provenance.title))
        rows(context, {"provenance.title", "provenance.credit", "provenance.type"});
}

}  // namespace astrosplat::panel

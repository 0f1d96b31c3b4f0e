// A look as a whole: copied and pasted between layers here; for exporting and applying the window asks for a
// file, as it does where a menu sent the command.
#include "gui/panel/parts.h"

#include "gui/panel/controls.h"

namespace astrosplat::panel {
namespace {

CopiedLook look_of(const Context& context) { return {context.layer().look, context.layer().render}; }

void give_look(Context& context, const std::string& name, const CopiedLook& copied,
               const std::function<bool(std::size_t)>& to) {
    edit(context, context.layer_key(), name, [&](Scene& scene) {
        for (std::size_t i = 0; i < scene.layers.size(); ++i) {
            if (!to(i)) continue;
            scene.layers[i].look = copied.look;
            scene.layers[i].render = copied.render;
        }
    });
}

void paste_look(Context& context) {
    const std::size_t layer = context.view.layer;
    give_look(context, "Paste look", *context.memory.copied, [&](std::size_t i) { return i == layer; });
}

void look_to_all(Context& context) {
    give_look(context, "Look of " + context.layer().name + " to all layers", look_of(context),
              [](std::size_t) { return true; });
}

}  // namespace

void look_buttons(Context& context) {
    const int files = button_line({"Export look...", "Apply look..."});
    if (files == 0) request(context, Command::Kind::save_look, context.view.layer);
    if (files == 1) request(context, Command::Kind::apply_look, context.view.layer);
    const int looks = button_line({"Copy", "Paste", "To all layers"});
    if (looks == 0) context.memory.copied = look_of(context);
    if (looks == 1 && context.memory.copied) paste_look(context);
    if (looks == 2) look_to_all(context);
}

void look_menu(Context& context) {
    if (ImGui::MenuItem("Copy look")) context.memory.copied = look_of(context);
    if (ImGui::MenuItem("Paste look", nullptr, false, context.memory.copied.has_value())) paste_look(context);
    if (ImGui::MenuItem("Look to all layers")) look_to_all(context);
    if (ImGui::MenuItem("Export look...")) request(context, Command::Kind::save_look, context.view.layer);
    if (ImGui::MenuItem("Apply look...")) request(context, Command::Kind::apply_look, context.view.layer);
}

}  // namespace astrosplat::panel

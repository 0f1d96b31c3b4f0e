// A look as a whole: copied and pasted between layers here, exported and applied through the viewer.
#include "gui/panel/parts.h"

#include "gui/panel/controls.h"

namespace astrosplat::panel {
namespace {

void copy_look(Context& context) {
    context.memory.copied = CopiedLook{context.layer().look, context.layer().render};
}

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

/// The window asks for it, as it does where a menu sent the command.
void ask_for_file(Context& context, Command::Kind kind) { request(context, kind, context.view.layer); }

void look_to_all(Context& context) {
    const CopiedLook copied{context.layer().look, context.layer().render};
    give_look(context, "Look of " + context.layer().name + " to all layers", copied,
              [](std::size_t) { return true; });
}

}  // namespace

void look_buttons(Context& context) {
    Memory& memory = context.memory;
    const int files = button_line({"Export look...", "Apply look..."});
    if (files == 0) ask_for_file(context, Command::Kind::save_look);
    if (files == 1) ask_for_file(context, Command::Kind::apply_look);
    const int looks = button_line({"Copy", "Paste", "To all layers"});
    if (looks == 0) copy_look(context);
    if (looks == 1 && memory.copied) paste_look(context);
    if (looks == 2) look_to_all(context);
}

void look_menu(Context& context) {
    Memory& memory = context.memory;
    if (ImGui::MenuItem("Copy look")) copy_look(context);
    if (ImGui::MenuItem("Paste look", nullptr, false, memory.copied.has_value())) paste_look(context);
    if (ImGui::MenuItem("Look to all layers")) look_to_all(context);
    if (ImGui::MenuItem("Export look...")) ask_for_file(context, Command::Kind::save_look);
    if (ImGui::MenuItem("Apply look...")) ask_for_file(context, Command::Kind::apply_look);
}

}  // namespace astrosplat::panel

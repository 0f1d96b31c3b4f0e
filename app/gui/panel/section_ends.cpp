// Contents of single sections besides the rows of parameters: the names of colour management, the two images
// of a preparation, handles in the view, references, a look as a whole.

#include "core/text.h"
#include "edit/layers.h"
#include "edit/lying.h"
#include "edit/selection.h"
#include "gui/panel/parts.h"
#include "scene/detail_tiles.h"

namespace astrosplat::panel {
namespace {

// Colour management.

constexpr const char *config_key = "output.ocio.config", *display_key = "output.ocio.display",
                     *view_key = "output.ocio.view", *space_key = "output.ocio.space";

const OcioParams& params_of(const Context& context) { return context.scene().output.ocio; }

/// The one the views are of; null: not known.
const ColorDisplay* display_of(const Context& context) {
    if (!context.status.color) return nullptr;
    const ColorConfig& config = context.status.color->config;
    const std::string& named = params_of(context).display;
    const auto found = std::ranges::find(config.displays, named.empty() ? config.default_display : named,
                                         &ColorDisplay::name);
    return found == config.displays.end() ? nullptr : &*found;
}

std::string in_use(const std::string& name, const char* how) {
    return name.empty() ? "None" : name + " (" + how + ")";
}

// The preparation of a picture: before and after.

constexpr float tallest = 320.0f;  // px at scale 1

// As wide as the panel, or as tall as there is room for.
Rect image_area(float aspect) {
    const float room = ImGui::GetContentRegionAvail().x;
    const float height = std::floor(std::min(room / std::max(aspect, 0.01f), px(tallest)));
    const float width = std::floor(std::min(room, height * aspect));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    return {{corner.x + std::floor((room - width) * 0.5f), corner.y}, {width, height}};
}

void drag_line(Context& context, const Rect& area) {
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::InvisibleButton("before and after", area.size());
    const bool active = ImGui::IsItemActive();
    if (active || ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (active) context.memory.preparation_line = share_at_mouse(area);
}

void draw_both(Context& context, const PrepareStatus& status) {
    const Rect area = image_area(status.aspect);
    context.memory.plots[context.layer_key() / "source.prepare"] = area;
    drag_line(context, area);
    const float share = context.memory.preparation_line;
    const float x = std::round(area.x + area.width * share);
    ImDrawList* list = ImGui::GetWindowDrawList();
    fill_rect(area, IM_COL32_BLACK);
    if (status.before) list->AddImage(status.before, area.corner(), {x, area.end().y}, {0, 0}, {share, 1});
    if (status.after) list->AddImage(status.after, {x, area.y}, area.end(), {share, 0}, {1, 1});
    line_down(x, area.y, area.end().y, color::text, px(1));
    captions("before", "after");
}

std::string what_was_done(const PrepareStatus& status, const PrepareParams& params) {
    if (status.working) return "Preparing";
    if (!prepares(params)) return "Nothing is prepared: the picture is used as it is.";
    std::string text = "A quick look at reduced size";
    if (params.stars == PrepareParams::Stars::remove)
        text += ", " + counted(status.stars, "star") + " removed";
    return text + ".";
}

/// Move, Rotate and Scale in one line: handles in the view that act on `target`.
void handle_buttons(Context& context, HandleTarget target, std::size_t crop) {
    const int clicked = button_line(context, {"Move", "Rotate", "Scale"});
    if (clicked < 0) return;
    context.view.tool = static_cast<HandleTool>(clicked + 1);
    context.view.handle_target = target;
    context.view.handle_crop = crop;
}

void copy_look(const Context& context) {
    ImGui::SetClipboardText(copied_text(context.scene(), CopiedKind::look, context.view.layer).c_str());
}

std::string copied_look() {
    const char* const text = ImGui::GetClipboardText();
    return text && copied_kind(text) == CopiedKind::look ? text : "";
}

void paste_look(Context& context) {
    const std::string look = copied_look();
    if (look.empty()) return;
    edit(context, context.layer_key(), "Paste look",
         [&](Scene& scene) { paste_text(scene, look, context.view.layer); });
}

void look_to_all(Context& context) {
    const LayerParams from = context.layer();
    edit(context, context.layer_key(), "Look of " + from.name + " to all layers", [&](Scene& scene) {
        for (LayerParams& layer : scene.layers) layer.look = from.look, layer.render = from.render;
    });
}

}  // namespace

std::optional<std::vector<std::string>> names_to_choose(const Context& context, const ParameterSpec& spec) {
    if (!context.status.color || context.status.color->config.displays.empty()) return std::nullopt;
    std::vector<std::string> names;
    if (spec.key == display_key) {
        for (const ColorDisplay& display : context.status.color->config.displays)
            names.push_back(display.name);
        return names;
    }
    const ColorDisplay* display = display_of(context);
    if (spec.key == view_key && display) return display->views;
    return std::nullopt;
}

std::string empty_in_words(const Context& context, const ParameterSpec& spec) {
    if (!spec.key.is_below("output.ocio") || !context.status.color) return "None";
    const ColorStatus& color = *context.status.color;
    if (spec.key == config_key && !color.config.file.empty())
        return in_use(color.config.file.filename().string(), "OCIO");
    if (spec.key == display_key) return in_use(color.display, "first");
    if (spec.key == view_key) return in_use(color.view, "first");
    if (spec.key == space_key) return in_use(color.space, "found");
    return "None";
}

bool suits_colors(const Context& context, const ParameterSpec& spec) {
    if (!spec.key.is_below("output.ocio") || spec.key == config_key) return true;
    if (params_of(context).wanted()) return true;
    return spec.key == display_key && context.status.color;
}

std::string colors_state(const Context& context) {
    if (!params_of(context).wanted()) return "none";
    const std::optional<ColorStatus>& color = context.status.color;
    return color && !color->view.empty() ? color->display + ", " + color->view : "";
}

void colors_note(Context& context) {
    const std::optional<ColorStatus>& color = context.status.color;
    if (color && !color->error.empty()) note(color->error, color::error);
}

void draw_preparation(Context& context) {
    context.view.preparation_open = true;
    const std::optional<PrepareStatus>& status = context.status.preparation;
    if (!status) return;
    ImGui::Dummy({0.0f, px(4)});
    if (status->before && status->after) draw_both(context, *status);
    if (status->error.empty())
        note(what_was_done(*status, context.layer().source.texture.prepare));
    else
        note(status->error, color::error);
    if (button_line(context, {"Write to folder..."}) == 0)
        request(context, Command::Kind::prepare_picture, context.view.layer);
    ImGui::Dummy({0.0f, px(4)});
}

void detail_buttons(Context& context) {
    if (!has_bodies(context.layer())) return;
    if (!lying_rings(context.scene(), context.view.layer).empty() &&
        button_line(context, {context.view.lying ? "Done inclining" : "Incline in the view"}) == 0)
        context.view.lying = !context.view.lying;
    if (button_line(context, {"Detail where the camera comes close"}) == 0)
        request(context, Command::Kind::make_detail);
}

void placement_buttons(Context& context) {
    note("Handles in the view: W, E and R");
    handle_buttons(context, HandleTarget::layer, 0);
}

void crop_buttons(Context& context) {
    const std::vector<Crop>& crops = context.layer().look.crop;
    const auto is_outline = [](const Crop& crop) { return crop.shape == Crop::Shape::outline; };
    note("Layer > Select erases, keeps or parts what is drawn around in the view");
    if (std::ranges::any_of(crops, is_outline) && button_line(context, {"Forget what was drawn"}) == 0)
        return edit(context, context.layer_key(), "Forget outlines",
                    [&](Scene& scene) { forget_outlines(scene, context.view.layer); });
    for (std::size_t i = 0; i < crops.size(); ++i) {
        if (is_outline(crops[i])) continue;
        ImGui::PushID(static_cast<int>(i));
        note(fmt::format("Handles of crop {} in the view", i));
        handle_buttons(context, HandleTarget::crop, i);
        ImGui::PopID();
    }
}

void reference_buttons(Context& context) {
    const ReferenceParams* reference = seen_reference(context.scene(), context.status);
    if (!reference) {
        note("No picture to compare this view with.");
        if (button_line(context, {"Load a reference..."}) == 0)
            request(context, Command::Kind::set_reference);
        return;
    }
    if (!context.status.reference->error.empty()) note(context.status.reference->error, color::error);
    const char* const align = context.status.reference->aligning ? "Aligning..." : "Align to this view";
    const int placed = button_line(context, {"Place in the view", align});
    if (placed == 0) {
        context.view.placing = true;
        show_reference(context.view);
    }
    if (placed == 1 && !context.status.reference->aligning) request(context, Command::Kind::align_reference);
    const auto index = static_cast<std::ptrdiff_t>(context.status.reference->index);
    const int clicked = button_line(context, {"Replace...", "Another for this view", "Remove"});
    if (clicked == 0) request(context, Command::Kind::set_reference);
    if (clicked == 1)
        edit(context, "reference", "Another reference", [&](Scene& scene) {
            ReferenceParams another = scene.references[static_cast<std::size_t>(index)];
            another.view = reference_view(context.view.view);
            scene.references.insert(scene.references.begin(), another);
        });
    if (clicked == 2)
        edit(context, "reference", "Remove reference",
             [&](Scene& scene) { scene.references.erase(scene.references.begin() + index); });
}

void look_buttons(Context& context) {
    const int files = button_line(context, {"Export look...", "Apply look..."});
    if (files == 0) request(context, Command::Kind::save_look, context.view.layer);
    if (files == 1) request(context, Command::Kind::apply_look, context.view.layer);
    const int looks = button_line(context, {"Copy", "Paste", "To all layers"});
    if (looks == 0) copy_look(context);
    if (looks == 1) paste_look(context);
    if (looks == 2) look_to_all(context);
}

void look_menu(Context& context) {
    if (ImGui::MenuItem("Copy look")) copy_look(context);
    if (ImGui::MenuItem("Paste look", nullptr, false, !copied_look().empty())) paste_look(context);
    if (ImGui::MenuItem("Look to all layers")) look_to_all(context);
    if (ImGui::MenuItem("Export look...")) request(context, Command::Kind::save_look, context.view.layer);
    if (ImGui::MenuItem("Apply look...")) request(context, Command::Kind::apply_look, context.view.layer);
}

}  // namespace astrosplat::panel

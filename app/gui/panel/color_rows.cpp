#include "gui/panel/parts.h"

#include <algorithm>

#include "gui/panel/controls.h"
#include "gui/theme.h"

namespace astrosplat::panel {
namespace {

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

}  // namespace astrosplat::panel

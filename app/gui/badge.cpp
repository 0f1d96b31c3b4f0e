// The badge: a dot in the state's colour, what the state is, and what can be done about it.
#include "gui/viewport_overlay.h"

#include <fmt/format.h>

#include "gui/parts.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float badge_height = 26, badge_inset = 12, padding = 10, dot_radius = 4, word_gap = 8,
                tick_room = 16;

/// Index of the first; that of none where none is.
std::size_t loading_layer(const Status& status) {
    const auto found = std::ranges::find(status.layers, true, &LayerStatus::loading);
    return static_cast<std::size_t>(found - status.layers.begin());
}
bool loads(const Status& status) { return loading_layer(status) < status.layers.size(); }

// A word at the badge's right end that can be clicked; `x` is where it begins.
bool word_button(GuiFrame& frame, const char* word, float x, float y) {
    const ImVec2 size = ImGui::CalcTextSize(word);
    ImGui::SetCursorScreenPos({x, y});
    const bool clicked = ImGui::InvisibleButton(word, {size.x, px(badge_height)});
    note_item(frame, std::string("badge/") + word);
    const bool hovered = ImGui::IsItemHovered();
    if (hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    draw_text({x, y + std::floor((px(badge_height) - size.y) * 0.5f)}, hovered ? color::text : color::accent,
              word);
    return clicked;
}

/// The reason why a whole frame is not the scene's: a visible layer that could not be loaded, or whose set
/// was made before its source was changed. Empty: nothing.
std::string lacking(const Scene& scene, const Status& status) {
    for (std::size_t i = 0; i < std::min(scene.layers.size(), status.layers.size()); ++i) {
        if (!scene.layers[i].visible) continue;
        const std::string& name = scene.layers[i].name;
        if (!status.layers[i].error.empty()) return "Not final: " + name + " is missing";
        if (status.layers[i].stale) return "Not final: " + name + " needs to be generated again";
    }
    return "";
}

// Words of the button that belongs to the state; nullptr: none.
const char* button_word(const Status& status) {
    if (!status.played_movie.empty()) return nullptr;
    if (status.starting || loads(status)) return "Cancel";
    return status.view_frame.state == ViewFrameState::failed ? "Copy" : nullptr;
}

void press_button(GuiFrame& frame) {
    if (frame.status.starting)
        request(frame, Command::Kind::cancel_start);
    else if (loads(frame.status))
        request(frame, Command::Kind::cancel_load, loading_layer(frame.status));
    else
        request_text(frame, Command::Kind::copy_text, frame.status.view_frame.error);
}

/// "+0.3 %"; -0 becomes 0.
std::string signed_percent(double share) {
    return fmt::format("{:+.1f} %", std::round(share * 1000.0) / 10.0 + 0.0);
}

/// Of light over that of what it is compared with.
std::string light_text(double ratio) {
    return std::isfinite(ratio) ? "light " + signed_percent(ratio - 1.0) : "no light to compare with";
}

/// The plate under a badge, at the bottom of the viewport.
Rect draw_plate(const Rect& viewport, float x, float width) {
    const Rect plate{x, viewport.end().y - px(badge_inset) - px(badge_height), width, px(badge_height)};
    fill_rect(plate, color::with_opacity(color::window, 0.86f), px(3));
    return plate;
}

bool is_hovered(const Rect& plate) { return ImGui::IsMouseHoveringRect(plate.corner(), plate.end()); }

float text_y(const Rect& plate) { return plate.y + std::floor((plate.height - ImGui::GetFontSize()) * 0.5f); }

struct SideBadge {
    std::string text, tooltip;
    ImU32 color;
    bool may_be_cut = false, tick = false;
};

std::optional<SideBadge> side_badge(const Status& status) {
    if (status.difference)
        return SideBadge{
            difference_text(*status.difference),
            "Of what is shown less what it is compared with, where both are seen: mean of display "
            "values,\nsignal to noise, and total light",
            color::text};
    if (!status.front) return std::nullopt;
    const FrontStatus& front = *status.front;
    const bool changed = !front.changed_by.empty();
    std::string why = changed ? "The look or the mixing differs from what shows a picture as it is"
                              : "The view from the front against its picture; D shows where they differ";
    if (front.measured) why = front_figures(front) + "\n" + why;
    return SideBadge{front_text(front), why, front.measured && !changed ? color::text : color::dim,
                     changed || !front.error.empty(), front.measured && front.matches && !changed};
}

}  // namespace

BadgeText badge_text(const Scene& scene, const Status& status) {
    const ViewFrameStatus& shown = status.view_frame;
    if (!status.played_movie.empty())
        return {"Movie", status.played_movie + "  (Esc or a click ends it)", color::good};
    if (!status.rendered_frame.empty()) return {"Rendered", status.rendered_frame, color::good};
    if (status.starting)
        return {
            fmt::format("{} {:.0f} %", starting_text(*status.starting), status.starting->progress * 100.0f),
            "", color::accent};
    if (const std::size_t index = loading_layer(status); index < status.layers.size()) {
        const LayerStatus& layer = status.layers[index];
        const std::string name = index < scene.layers.size() ? scene.layers[index].name : "layer";
        return {fmt::format("Generating {} {:.0f} %", name, layer.progress * 100.0f),
                layer.making.splats > 0 ? making_text(layer.making) + " in all"
                : layer.found > 0       ? splat_count(layer.found)
                                        : "",
                color::accent};
    }
    const std::string total = splat_count(shown.total);
    switch (shown.state) {
        case ViewFrameState::loading:
            return {"Loading", "", color::accent};
        case ViewFrameState::refining:
            return {fmt::format("Refining {:.0f} %", shown.progress * 100.0f), total, color::attention};
        case ViewFrameState::final:
            if (const std::string why = lacking(scene, status); !why.empty())
                return {why, total, color::error};
            if (shown.total == 0)
                return {"Empty", scene.layers.empty() ? "no layer yet" : "no splats to show", color::dim};
            if (!shown.device.empty())
                return {fmt::format("Final {:.0f} ms", 1e3 * shown.seconds), total + ", " + shown.device,
                        color::good};
            return {fmt::format("Final {:.1f} s", shown.seconds), total, color::good};
        case ViewFrameState::failed:
            return {"Cannot render: " + shown.error, "", color::error};
        case ViewFrameState::preview:
            break;
    }
    if (shown.samples > 1)
        return {fmt::format("Preview, {} of {} samples", shown.samples, scene.output.samples), total,
                color::accent};
    const char* const splats = shown.round_splats ? "round splats" : "splats";
    if (shown.shown >= shown.total)
        return {shown.round_splats ? "Preview, round splats" : "Preview", total, color::accent};
    return {fmt::format("Preview, {} {} for {}", short_count(shown.shown), splats, short_count(shown.total)),
            "", color::accent};
}

float draw_badge(GuiFrame& frame, const Rect& area) {
    BadgeText badge = badge_text(frame.document.scene(), frame.status);
    const char* word = button_word(frame.status);
    ImGui::PushFont(small_font());
    const float word_width = word ? ImGui::CalcTextSize(word).x + px(word_gap) * 2 : 0.0f;
    const float left = px(padding) + px(dot_radius) * 2 + px(word_gap);
    const float room = area.width - 2 * px(badge_inset) - left - word_width - px(padding);
    const std::string whole = badge.text;
    badge.text = fitting(badge.text, room);
    const float text_width = ImGui::CalcTextSize(badge.text.c_str()).x;
    float beside_width =
        badge.beside.empty() ? 0.0f : ImGui::CalcTextSize(badge.beside.c_str()).x + px(word_gap) * 1.5f;
    if (text_width + beside_width > room) beside_width = 0.0f;

    ImDrawList* list = ImGui::GetWindowDrawList();
    const float x = area.x + px(badge_inset);
    const float width = left + text_width + beside_width + word_width + px(padding);
    const Rect plate = draw_plate(area, x, width);
    list->AddCircleFilled({x + px(padding) + px(dot_radius), plate.middle().y}, px(dot_radius), badge.color,
                          16);
    draw_text({x + left, text_y(plate)}, color::text, badge.text);
    if (beside_width > 0)
        draw_text({x + left + text_width + px(word_gap) * 1.5f, text_y(plate)}, color::dim, badge.beside);
    if (word && word_button(frame, word, x + width - px(padding) - word_width + px(word_gap) * 2, plate.y))
        press_button(frame);
    if (badge.text != whole && is_hovered(plate)) ImGui::SetTooltip("%s", whole.c_str());
    ImGui::PopFont();
    return x + width;
}

std::string front_text(const FrontStatus& front) {
    if (!front.error.empty()) return "Front cannot be compared: " + front.error;
    if (!front.changed_by.empty()) return "Front changed by look: " + front.changed_by;
    if (!front.measured) return front.working ? "Comparing the front" : "";
    if (std::isnan(front.light)) return "The picture has no light to compare with";
    return front.matches ? "Matches the picture" : "Differs from the picture";
}

std::string front_figures(const FrontStatus& front) {
    return fmt::format("Front {:.1f} dB, SSIM {:.3f}, {}", front.psnr_db, front.ssim,
                       light_text(front.light));
}

std::string difference_text(const DifferenceStatus& difference) {
    const std::string psnr =
        std::isinf(difference.psnr_db) ? "the same" : fmt::format("{:.1f} dB", difference.psnr_db);
    return fmt::format("Mean {}, {}, {}", signed_percent(difference.mean), psnr,
                       light_text(difference.light));
}

void draw_side_badge(GuiFrame& frame, const Rect& area, float left) {
    const std::optional<SideBadge> badge = side_badge(frame.status);
    if (!badge || badge->text.empty()) return;
    ImGui::PushFont(small_font());
    const float x = left + px(word_gap), before = px(padding) + (badge->tick ? px(tick_room) : 0.0f);
    const float room = area.end().x - px(badge_inset) - x - before - px(padding);
    const std::string text = badge->may_be_cut ? fitting(badge->text, room) : badge->text;
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    if (width <= room) {
        const Rect plate = draw_plate(area, x, before + width + px(padding));
        if (badge->tick)
            draw_icon(ImGui::GetWindowDrawList(), Icon::tick, {x + px(padding) + px(5), plate.middle().y},
                      px(10), color::good);
        draw_text({x + before, text_y(plate)}, badge->color, text);
        if (is_hovered(plate)) ImGui::SetTooltip("%s\n%s", badge->text.c_str(), badge->tooltip.c_str());
    }
    ImGui::PopFont();
}

}  // namespace astrosplat

// The panel as a whole: the layers with the tabs of the selected one, or the tabs of the scene.
#include "gui/panel/panel.h"

#include "gui/panel/parts.h"

namespace astrosplat::panel {
namespace {

struct Tab {
    const char* label;  // as ParameterSpec::tab
    PanelTab tab;
    void (*top)(Context&);  // drawn above the sections; nullptr: nothing
};
constexpr Tab tabs[] = {
    {"Source", PanelTab::source, source_state},      {"Look", PanelTab::look, nullptr},
    {"Mixing", PanelTab::mixing, nullptr},           {"Camera", PanelTab::camera, camera_buttons},
    {"Environment", PanelTab::environment, nullptr}, {"Output", PanelTab::output, output_buttons}};

// One of two panels is seen, that of the layers or that of the scene, each with the tab it had last.
void head(Context& context) {
    PanelTab& tab = context.view.tab;
    Memory& memory = context.memory;
    (is_of_layer(tab) ? memory.layer_tab : memory.scene_tab) = tab;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos({corner.x + px(12), corner.y + px(4)});
    const int clicked = segmented(context, "panel",
                                  {{"Layers", "What is seen: the layers, their looks, how they mix"},
                                   {"Scene", "From where and how: camera, environment, frames and files"}},
                                  is_of_layer(tab) ? 0 : 1, 24);
    if (clicked >= 0) tab = clicked == 0 ? memory.layer_tab : memory.scene_tab;
    if (is_of_layer(tab)) {
        const float right = corner.x + ImGui::GetWindowContentRegionMax().x;
        ImGui::SetCursorScreenPos({right - px(12) - px(20), corner.y + px(4)});
        add_layer_button(context);
    }
    ImGui::SetCursorScreenPos({corner.x, corner.y + px(32)});
}

void tab_row(ViewState& view) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = px(32);
    line_across(corner.x, corner.x + width, corner.y, color::line);
    const float padding = px(12);
    float x = corner.x;
    PanelTab chosen = view.tab;
    for (const Tab& tab : tabs) {
        if (is_of_layer(tab.tab) != is_of_layer(view.tab)) continue;
        const ImVec2 text = ImGui::CalcTextSize(tab.label);
        const float tab_width = text.x + padding * 2.0f;
        ImGui::SetCursorScreenPos({x, corner.y});
        if (ImGui::InvisibleButton(tab.label, {tab_width, height})) chosen = tab.tab;
        const bool seen = view.tab == tab.tab;
        const ImU32 ink = seen || ImGui::IsItemHovered() ? color::text : color::dim;
        draw_text({x + padding, corner.y + (height - text.y) * 0.5f}, ink, tab.label);
        if (seen)
            fill_rect({x + padding, corner.y + height - px(2)}, {x + padding + text.x, corner.y + height},
                      color::accent);
        x += tab_width;
    }
    view.tab = chosen;
    ImGui::SetCursorScreenPos({corner.x, corner.y + height});
}

void tab_content(Context& context) {
    const auto tab = std::find_if(std::begin(tabs), std::end(tabs),
                                  [&](const Tab& t) { return t.tab == context.view.tab; });
    const bool of_layer = is_of_layer(tab->tab);
    if (of_layer && context.scene().layers.empty()) {
        note("No layer yet.");
        return;
    }
    Memory& memory = context.memory;
    memory.after_open = false;
    // Sections of layers share their ids, so that a drag does not survive a change of layer.
    ImGui::PushID(of_layer ? context.layer_key().text().c_str() : tab->label);
    if (!memory.error.empty() && !memory.error_shown) note(memory.error, color::error);
    memory.error_shown = false;
    if (tab->top) tab->top(context);
    draw_tab(context, tab->label);
    ImGui::PopID();
}

// The room of the scroll bar is always kept, so that rows do not jump when one appears.
void tab_body(Context& context) {
    const bool scrolls = context.memory.scroll > 0.0f;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(12), px(8)));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(8), px(row_space)));
    ImGui::PushStyleVar(ImGuiStyleVar_ScrollbarSize, px(8));
    if (!scrolls) {
        for (const ImGuiCol c :
             {ImGuiCol_ScrollbarGrab, ImGuiCol_ScrollbarGrabHovered, ImGuiCol_ScrollbarGrabActive})
            ImGui::PushStyleColor(c, color::none);
    }
    const ImGuiWindowFlags flags = ImGuiWindowFlags_AlwaysUseWindowPadding |
                                   ImGuiWindowFlags_AlwaysVerticalScrollbar | ImGuiWindowFlags_NavFlattened;
    ImGui::BeginChild("tab", {0.0f, 0.0f}, false, flags);
    if (!scrolls) ImGui::PopStyleColor(3);
    tab_content(context);
    context.memory.scroll = ImGui::GetScrollMaxY();
    ImGui::EndChild();
    ImGui::PopStyleVar(3);
}

void forget_untouched(Touch& touch) {
    if (!touch.seen) touch.drag = touch.entry = 0;
    touch.to_next = false;
}

}  // namespace

/// The whole panel.
void draw_all(Context& context) {
    ViewState& view = context.view;
    const std::size_t layers = context.scene().layers.size();
    view.layer = layers > 0 ? std::min(view.layer, layers - 1) : 0;
    const ImVec2 room = ImGui::GetContentRegionAvail();
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0.0f, 0.0f));
    head(context);
    if (is_of_layer(view.tab)) layer_list(context, std::min(layer_list_height(context), room.y * 0.4f));
    tab_row(view);
    ImGui::PopStyleVar();
    view.layer = layers > 0 ? std::min(view.layer, layers - 1) : 0;  // a layer was added or taken away
    tab_body(context);
    context.memory.all_open = false;
    context.memory.wanted = {};
    forget_untouched(context.memory.touch);
}

}  // namespace astrosplat::panel

namespace astrosplat {

void Panel::draw(const GuiFrame& frame) {
    panel::describe_current(memory_, frame.document, frame.view.frame);
    if (memory_.error_revision != frame.document.revision()) memory_.error.clear();
    memory_.rows.clear();
    memory_.plots.clear();
    memory_.touch.seen = false;
    frame.view.preparation_open = false;
    panel::Context context{frame, memory_};
    panel::draw_all(context);
}

void Panel::answer(const ParameterKey& key, const fs::path& file, const GuiFrame& frame) {
    panel::describe_current(memory_, frame.document, frame.view.frame);
    panel::Context context{frame, memory_};
    panel::set_value(context, key, file.string());
}

std::vector<const Parameter*> Panel::shown_parameters(const GuiFrame& frame) const {
    const panel::Context context{frame, const_cast<panel::Memory&>(memory_)};  // only read
    const ParameterKey layer = context.layer_key();
    std::vector<const Parameter*> shown;
    for (const Parameter& parameter : memory_.described.description.parameters) {
        const ParameterKey& key = parameter.spec.key;
        if ((!key.is_below("layer") || key.is_below(layer)) && panel::is_shown(context, parameter.spec))
            shown.push_back(&parameter);
    }
    return shown;
}

void Panel::show(const ParameterKey& key, ViewState& view) {
    const auto found = memory_.described.by_key.find(key);
    if (found == memory_.described.by_key.end()) return;
    const ParameterSpec& spec = found->second->spec;
    for (const panel::Tab& tab : panel::tabs)
        if (tab.label == spec.tab) view.tab = tab.tab;
    view.panels = true;
    memory_.open[{view.tab, std::string(spec.section)}] = true;
    memory_.wanted = key;
}

glm::vec4 Panel::plot_area(const std::string& key) const {
    const auto found = memory_.plots.find(key);
    const Rect area = found == memory_.plots.end() ? Rect() : found->second;
    return {area.x, area.y, area.width, area.height};
}

bool Panel::busy() const {
    return memory_.touch.drag != 0 || memory_.touch.entry != 0 || memory_.dragged_layer >= 0 ||
           !memory_.renaming.empty() || awaits_ring();
}

}  // namespace astrosplat

// The lines across the window: the menus, a loop over actions(), with recent files and the history added
// where File > Open and Edit > Redo are; the notice; the status bar, its right parts first, the message gets
// the room that is left.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>

#include "gui/actions.h"
#include "gui/icons.h"
#include "gui/parts.h"
#include "gui/widgets.h"

namespace astrosplat {

namespace {

void recent_files(GuiFrame& frame) {
    const bool any = !frame.status.recent.empty();
    if (ImGui::BeginMenu("Open recent", any)) {
        for (const auto& file : frame.status.recent) {
            ImGui::PushID(file.c_str());  // two of one name are two
            if (ImGui::MenuItem(file.filename().string().c_str()))
                request_path(frame, Command::Kind::open, file);
            note_item(frame, "File/Open recent/" + file.filename().string());
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", file.string().c_str());
            ImGui::PopID();
        }
        ImGui::EndMenu();
    } else {
        note_item(frame, "File/Open recent");
    }
}

// The steps of the document, the newest at the top; a click goes there. What can be redone is dimmed.
void history(GuiFrame& frame) {
    constexpr std::size_t most_seen = 30;
    if (!ImGui::BeginMenu("History")) return note_item(frame, "Edit/History");
    const std::vector<std::string> names = frame.document.history();
    const std::size_t now = frame.document.history_place();
    const std::size_t last = std::min(names.size(), std::max(now + most_seen / 2, most_seen));
    for (std::size_t step = last; step-- > last - std::min(last, most_seen);) {
        ImGui::PushID(static_cast<int>(step));
        ImGui::PushStyleColor(ImGuiCol_Text, step > now ? color::dim : color::text);
        const std::string& name = step == 0 ? "As opened" : names[step];
        if (ImGui::MenuItem(name.c_str(), nullptr, step == now)) frame.document.go_to(step);
        note_item(frame, "Edit/History/" + std::to_string(step));
        ImGui::PopStyleColor();
        ImGui::PopID();
    }
    ImGui::EndMenu();
}

void draw_action(GuiFrame& frame, const Action& action) {
    if (action.line_above) ImGui::Separator();
    const std::string label = action.label_now ? action.label_now(frame) : action.label;
    const bool enabled = !action.enabled || action.enabled(frame);
    const bool checked = action.checked && action.checked(frame);
    if (ImGui::MenuItem(label.c_str(), shortcut_text(action.shortcut).c_str(), checked, enabled))
        action.run(frame);
    note_item(frame, std::string(action.menu) + "/" + action.label);
    if (std::string_view(action.label) == "Open...") recent_files(frame);
    if (std::string_view(action.label) == "Redo") history(frame);
}

// Actions of one submenu follow each other in the table; it opens where the first of them stands.
void draw_submenu(GuiFrame& frame, const std::string& path) {
    const std::string title = path.substr(path.find('/') + 1);
    const bool open = ImGui::BeginMenu(title.c_str());
    if (!open) return note_item(frame, path);
    for (const Action& action : actions())
        if (path == action.menu) draw_action(frame, action);
    ImGui::EndMenu();
}

void draw_menu(GuiFrame& frame, const char* menu) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(8), px(8)));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(12), px(8)));
    const bool open = ImGui::BeginMenu(menu);
    // While it is open the last item is one of the menu's own.
    if (!open) note_item(frame, menu);
    if (open) {
        std::string submenu;
        for (const Action& action : actions()) {
            const std::string path = action.menu;
            if (path == menu) draw_action(frame, action);
            if (path.rfind(std::string(menu) + "/", 0) == 0 && path != submenu)
                draw_submenu(frame, submenu = path);
        }
        close_on_escape();
        ImGui::EndMenu();
    }
    ImGui::PopStyleVar(2);
}

void draw_title(const GuiFrame& frame, const Rect& area) {
    const std::string name = frame.document.name();
    const std::string text = frame.document.edited() ? name + " - edited" : name;
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float x = std::max(area.x + (area.width - size.x) * 0.5f, ImGui::GetCursorScreenPos().x + px(12));
    draw_text({std::floor(x), area.y + std::floor((area.height - size.y) * 0.5f)},
              frame.document.edited() ? color::text : color::dim, text);
}

}  // namespace

void draw_menu_bar(GuiFrame& frame, const Rect& area) {
    push_field_height(area.height);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(16), px(4)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(8), 0));
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::BeginChild("menu", area.size(), false, ImGuiWindowFlags_MenuBar);
    if (ImGui::BeginMenuBar()) {
        for (const char* menu : {"File", "Edit", "View", "Layer", "Camera", "Render", "Help"})
            draw_menu(frame, menu);
        draw_title(frame, area);
        ImGui::EndMenuBar();
    }
    ImGui::EndChild();
    ImGui::PopStyleVar(3);
}

namespace {

// A text and two answers to it: index of the one clicked, else -1.
int notice_question(GuiFrame& frame, const Rect& area, const std::string& text, ImU32 ink,
                    const std::array<Segment, 2>& answers) {
    row_text(text, area.height, ink);
    int clicked = -1;
    for (int i = 0; i < 2; ++i) {
        const auto& [label, hint] = answers[static_cast<std::size_t>(i)];
        ImGui::SameLine(0, px(i == 0 ? 16 : 8));
        ImGui::SetCursorScreenPos({ImGui::GetCursorScreenPos().x, area.y + (area.height - px(22)) * 0.5f});
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(10), px(3)));
        if (ImGui::Button(label, {0, px(22)})) clicked = i;
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", hint);
        ImGui::PopStyleVar();
        note_item(frame, std::string("notice/") + label);
    }
    return clicked;
}

void draw_disk_notice(GuiFrame& frame, const Rect& area) {
    const int clicked =
        notice_question(frame, area, frame.document.name() + " changed on disk", color::attention,
                        {{{"Reload", "Take what is on disk; undo brings this back"},
                          {"Keep", "Keep what is here; saving will replace what is on disk now"}}});
    if (clicked >= 0) request(frame, clicked == 0 ? Command::Kind::reload : Command::Kind::keep);
}

void draw_grey_notice(GuiFrame& frame, const Rect& area) {
    const std::vector<LayerParams>& layers = frame.document.scene().layers;
    const auto layer = std::ranges::find(layers, frame.view.grey_layer, &LayerParams::name);
    const int clicked = notice_question(
        frame, area, frame.view.grey_layer + " has no picture and is neutral grey", color::text,
        {{{"Choose a picture...", "Colours the splats of this mesh"},
          {"Keep grey", "A picture can be chosen under Source, too"}}});
    if (clicked == 0 && layer != layers.end())
        request(frame, Command::Kind::choose_picture, static_cast<std::size_t>(layer - layers.begin()));
    if (clicked == 1) frame.view.grey_layer.clear();
}

void draw_hint(GuiFrame& frame, const Rect& area) {
    row_text("Drop a picture, mesh or splat file here. F1 shows the keys.", area.height, color::text);
    ImGui::SetCursorScreenPos({area.end().x - area.height - px(4), area.y});
    if (icon_button("close hint", Icon::cross, {area.height, area.height}, px(10), color::dim, nullptr))
        frame.view.hint_open = false;
    note_item(frame, "close hint");
}

}  // namespace

void draw_notice(GuiFrame& frame, const Rect& area) {
    if (area.height <= 0) return;
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::PushStyleColor(ImGuiCol_ChildBg, color4(color::window));
    ImGui::BeginChild("notice", area.size(), false, ImGuiWindowFlags_NoScrollbar);
    ImGui::SetCursorScreenPos({area.x + px(12), area.y});
    if (frame.view.changed_on_disk)
        draw_disk_notice(frame, area);
    else if (!frame.view.grey_layer.empty())
        draw_grey_notice(frame, area);
    else
        draw_hint(frame, area);
    ImGui::EndChild();
    ImGui::PopStyleColor();
}

namespace {

constexpr float bar_margin = 12, part_gap = 24, bar_width = 120;

// Where the probe's numbers begin, after its left edge; the last is its width.
constexpr float probe_columns[] = {0, 46, 100, 150, 200, 250, 300, 352};

// ".214", "1.250": three decimals, so that numbers of one size have one width.
std::string light_text(float value) {
    std::string text = fmt::format("{:.3f}", value);
    if (text.rfind("0.", 0) == 0) text.erase(0, 1);
    if (text.rfind("-0.", 0) == 0) text.erase(1, 1);
    return text;
}

std::string machine_text(const Status& status) {
    const double gigabytes = static_cast<double>(status.memory_bytes) / 1e9;
    const char* cores = status.threads == 1 ? "core" : "cores";
    return fmt::format("{:.1f} GB, {} {}", gigabytes, status.threads, cores);
}

// Ends at `right`; returns where it begins.
float right_text(const std::string& text, float right, const Rect& area, ImU32 c) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float x = std::floor(right - size.x);
    draw_text({x, area.y + std::floor((area.height - size.y) * 0.5f)}, c, text);
    return x;
}

float draw_job(GuiFrame& frame, float right, const Rect& area) {
    const QueuedJob* const job = running_job(frame.status);
    if (!job) return right;
    const float side = area.height;
    ImGui::SetCursorScreenPos({right - side, area.y});
    if (icon_button("cancel job", Icon::cross, {side, side}, px(10), color::dim, "Cancel (Esc)"))
        request(frame, Command::Kind::cancel_render);
    note_item(frame, "cancel job");
    const float x1 = right - side - px(4), x0 = x1 - px(bar_width);
    progress_bar({x0, std::floor(area.y + area.height * 0.5f - px(2))}, px(bar_width), job->progress);
    const std::string left = job->seconds_left ? ", " + duration_text(*job->seconds_left) + " left" : "";
    const float x = right_text(job->text + left, x0 - px(8), area, color::text);
    ImGui::SetCursorScreenPos({x, area.y});
    if (ImGui::InvisibleButton("job", {x1 - x, area.height})) frame.view.queue_open = true;
    note_item(frame, "job");
    tooltip("Click: the queue");
    return x - px(part_gap);
}

// The probe's text: x, y, linear R G B A ("R", ".214") and the depth Z where there is one.
struct ProbeCell {
    const char* label;
    std::string number;
};

std::vector<ProbeCell> probe_cells(const PixelProbe& probe) {
    std::vector<ProbeCell> cells{{"x", fmt::format("{}", probe.x)}, {"y", fmt::format("{}", probe.y)}};
    constexpr const char* channels[] = {"R", "G", "B", "A"};
    for (std::size_t i = 0; i < 4; ++i) cells.push_back({channels[i], light_text(probe.rgba[i])});
    if (probe.depth) cells.push_back({"Z", fmt::format("{:.4g}", *probe.depth)});
    return cells;
}

// Label and number at fixed places, so that nothing wanders while the mouse moves.
float draw_probe(const Status& status, float right, const Rect& area) {
    if (!status.probe) return right;
    const std::vector<ProbeCell> cells = probe_cells(*status.probe);
    const float x = std::floor(right - px(std::end(probe_columns)[-1]));
    const float y = area.y + std::floor((area.height - ImGui::GetFontSize()) * 0.5f);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const float at = x + px(probe_columns[i]);
        draw_text({at, y}, color::dim, cells[i].label);
        draw_text({at + px(13), y}, color::text, cells[i].number);
    }
    return x - px(part_gap);
}

}  // namespace

void StatusBar::take_message(const Status& status) {
    const std::string& text = status.message.text;
    if (text == last_ && status.message.number == number_) return;
    last_ = text;
    number_ = status.message.number;
    if (status.message.error) unread_ = text;
}

void StatusBar::draw(GuiFrame& frame, const Rect& area) {
    take_message(frame.status);
    ImGui::PushFont(small_font());
    float right = right_text(machine_text(frame.status), area.end().x - px(bar_margin), area, color::dim);
    right = draw_job(frame, right - px(part_gap), area);
    right = draw_probe(frame.status, right, area);
    const bool error = !unread_.empty();
    const std::string whole = error                        ? unread_
                              : frame.status.message.error ? ""  // was read
                                                           : frame.status.message.text;
    const float room = right - area.x - px(bar_margin);
    const std::string text = fitting(whole, error ? room - px(20) : room);
    ImGui::SetCursorScreenPos({area.x + px(bar_margin), area.y});
    if (error) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        draw_icon(ImGui::GetWindowDrawList(), Icon::warning, {at.x + px(6), at.y + area.height * 0.5f},
                  px(12), color::error);
        ImGui::SetCursorScreenPos({at.x + px(20), area.y});
    }
    row_text(text, area.height, error ? color::error : color::dim);
    note_item(frame, "message");
    if (ImGui::IsItemHovered() && error) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (text != whole || error) tooltip((whole + (error ? "\nClick: read" : "")).c_str());
    if (error && ImGui::IsItemClicked()) unread_.clear();
    ImGui::PopFont();
}

}  // namespace astrosplat

// The lines across the window: the menus, a loop over actions(), with recent files and the history added
// where File > Open and Edit > Redo are; the tools, of which those at the right move into a menu, the rarest
// first, where the row is too narrow for them; the notice; the status bar, its right parts first, the
// message gets the room that is left.
#include <fmt/format.h>

#include <iterator>

#include "gui/parts.h"

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

void draw_menu(GuiFrame& frame, std::size_t index) {
    const char* const menu = menu_names[index];
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(8), px(8)));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(12), px(8)));
    if (opens_menu(menu)) ImGui::OpenPopup(menu);
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
        leave_menu_sideways(index);
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
    pass_ring_by();
    if (ImGui::BeginMenuBar()) {
        for (std::size_t menu = 0; menu < menu_names.size(); ++menu) draw_menu(frame, menu);
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
    if (!begin_part("notice", area)) return;
    fill_rect(area, color::window);
    ImGui::SetCursorScreenPos({area.x + px(12), area.y});
    if (frame.view.changed_on_disk)
        draw_disk_notice(frame, area);
    else if (!frame.view.grey_layer.empty())
        draw_grey_notice(frame, area);
    else
        draw_hint(frame, area);
    ImGui::EndChild();
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
    const auto stands = [&] { return status.standing_errors.count(unread_) > 0; };
    if (status.scenes != scenes_ || (unread_stands_ && !stands())) unread_.clear();
    scenes_ = status.scenes;
    const bool is_new = text != last_ || status.message.number != number_;
    last_ = text;
    number_ = status.message.number;
    if (is_new && status.message.error) unread_ = text;
    unread_stands_ = stands();
}

void StatusBar::draw(GuiFrame& frame, const Rect& area) {
    take_message(frame.status);
    ImGui::PushFont(small_font());
    float right = right_text(machine_text(frame.status), area.end().x - px(bar_margin), area, color::dim);
    right = draw_job(frame, right - px(part_gap), area);
    right = draw_probe(frame.status, right, area);
    const bool error = !unread_.empty();
    const std::string said = frame.status.message.error ? "" : frame.status.message.text;
    const bool news = !said.empty() || !error;  // later than the error, which comes back after it
    const std::string whole = news ? said : unread_;
    const float room = right - area.x - px(bar_margin);
    const std::string text = fitting(whole, error ? room - px(20) : room);
    ImGui::SetCursorScreenPos({area.x + px(bar_margin), area.y});
    if (error) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        draw_icon(ImGui::GetWindowDrawList(), Icon::warning, {at.x + px(6), at.y + area.height * 0.5f},
                  px(12), color::error);
        ImGui::SetCursorScreenPos({at.x + px(20), area.y});
    }
    row_text(text, area.height, news ? color::dim : color::error);
    note_item(frame, "message");
    if (ImGui::IsItemHovered() && error) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (text != whole || error)
        tooltip((error ? unread_ + "\nClick to put it away; Help > Log keeps it" : whole).c_str());
    if (error && ImGui::IsItemClicked()) unread_.clear();
    ImGui::PopFont();
}

namespace {

constexpr float control_height = 24, gap = 12, small_gap = 4;

int choice(GuiFrame& frame, const char* id, std::initializer_list<Segment> segments, int chosen) {
    return segmented(frame, id, segments, chosen, control_height);
}

// A field that opens a list of choices.
template <class Enum>
void combo(GuiFrame& frame, const char* name, Enum& value, const std::vector<const char*>& names, float width,
           const std::string& says, ImU32 ink = color::text) {
    ImGui::SetNextItemWidth(px(width));
    const auto index = static_cast<std::size_t>(value);
    ImGui::PushStyleColor(ImGuiCol_Text, index == 0 ? color::dim : ink);
    const bool open =
        ImGui::BeginCombo((std::string("##") + name).c_str(), names[index], ImGuiComboFlags_NoArrowButton);
    ImGui::PopStyleColor();
    if (open) {
        for (std::size_t i = 0; i < names.size(); ++i)
            if (ImGui::Selectable(names[i], i == index)) value = static_cast<Enum>(i);
        close_on_escape();
        ImGui::EndCombo();
    }
    note_item(frame, name);
    tooltip(says.c_str());
}

// A field in a narrow row.
void view_choice(GuiFrame& frame, bool is_narrow) {
    if (is_narrow)
        return combo(frame, "view", frame.view.view, {"Camera", "Free", "Front", "Top", "Side"}, 84,
                     "What is seen through (0, 1, 7, 3)");
    const int clicked = choice(frame, "view",
                               {{"Camera", "Through the scene's camera (0)"},
                                {"Free", "A camera of the window, the scene's stays (drag in the view)"},
                                {"Front", "Along z, without perspective (1)"},
                                {"Top", "From above (7)"},
                                {"Side", "Along x (3)"}},
                               static_cast<int>(frame.view.view));
    if (clicked >= 0) frame.view.view = static_cast<ViewKind>(clicked);
}

void size_choice(GuiFrame& frame) {
    const int clicked =
        choice(frame, "size",
               {{"Fit", "The frame at the size of the window (Z)"},
                {"1:1", "The frame at the size of the output: wheel zooms, middle drag moves (Z)"}},
               static_cast<int>(frame.view.size));
    if (clicked >= 0 && clicked != static_cast<int>(frame.view.size)) toggle_one_to_one(frame);
}

void compare_choice(GuiFrame& frame) {
    const bool with_reference = compares_with_reference(frame);
    const char* const other = with_reference ? "Ref" : "B";
    const char* const both = with_reference ? "A|Ref" : "A|B";
    const int clicked =
        choice(frame, "compare",
               {{"A", "The look as it is now (A)"},
                {both, "Wipe between now and what it is compared with"},
                {other, "What it is compared with: the stored look, or the reference over the view (A)"},
                {"Blink", "One after the other (X)"},
                {"Diff", "Now minus what it is compared with; grey where they are equal"}},
               static_cast<int>(frame.view.compare));
    if (clicked >= 0) set_compare(frame, static_cast<CompareMode>(clicked));
}

// The settings of the chosen comparison, next to it; nothing while A is seen alone.
void compare_settings(GuiFrame& frame) {
    ViewState& view = frame.view;
    if (!compares(view)) return;
    CompareWith with = view.compare_with;
    combo(frame, "compare with", with, {"with B", "with Ref"}, 76,
          "What is compared with: the stored look B, or the reference picture (Ctrl+B)");
    if (with != view.compare_with) compare_with(frame, with);
    if (view.compare == CompareMode::difference) {
        ImGui::SameLine(0, px(small_gap));
        drag_field(frame, view.difference_gain,
                   {"difference gain", 0.02f, 0.1f, 100, "x %.1f", 52, color::text,
                    "The difference is multiplied by this"});
    }
    if (view.compare == CompareMode::blink) {
        ImGui::SameLine(0, px(small_gap));
        drag_field(frame, view.blink_hz,
                   {"blink rate", 0.02f, 0.25f, 10, "%.1f /s", 52, color::text, "Changes a second"});
    }
    if (!has_reference(frame) || !compares_with_reference(frame)) return;
    ImGui::SameLine(0, px(small_gap));
    if (choice(frame, "place", {{"Place", "Move, turn and scale the reference in the view (P)"}},
               view.placing ? 0 : -1) == 0)
        toggle_placing(frame);
}

float width_of_compare_settings(const GuiFrame& frame) {
    const CompareMode mode = frame.view.compare;
    if (!compares(frame.view)) return 0;
    const bool has_number = mode == CompareMode::difference || mode == CompareMode::blink;
    const bool has_place = has_reference(frame) && compares_with_reference(frame);
    return 76 + (has_number ? small_gap + 52 : 0) + (has_place ? small_gap + 52 : 0);
}

void display_control(GuiFrame& frame) {
    combo(frame, "display", frame.view.display, {"As output", "Linear", "sRGB", "Soft"}, 84,
          "How the frame's linear light is shown; rendered files follow the panel Output");
}

void channel_control(GuiFrame& frame) {
    combo(frame, "channel", frame.view.inspection.channel, {"RGB", "R", "G", "B", "A", "Lum", "Stops"}, 56,
          "What of a pixel is seen: one channel alone (Shift+R, G, B, A), its luminance (Shift+L), or its "
          "light in stops as false colours (Shift+E)",
          color::attention);
}

/// Of this window only: a number of the inspection that is amber while it is not `neutral`.
void inspection_field(GuiFrame& frame, float& value, float neutral, DragField field) {
    field.ink = value != neutral ? color::attention : color::dim;
    drag_field(frame, value, field);
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) value = neutral;
}

void exposure_control(GuiFrame& frame) {
    inspection_field(
        frame, frame.view.inspection.exposure, 0.0f,
        {"exposure", 0.02f, -20, 20, "%+.1f EV", 72, 0,
         "Exposure of this window only, to look into dark and bright parts. Never saved. Right click: 0"});
}

void gamma_control(GuiFrame& frame) {
    inspection_field(frame, frame.view.inspection.gamma, 1.0f,
                     {"gamma", 0.01f, 0.2f, 5, "g %.2f", 56, 0,
                      "Gamma of this window only, which lifts what is dark. Never saved. Right click: 1"});
}

void neutral_control(GuiFrame& frame) {
    const bool neutral = frame.view.inspection == Inspection();
    if (icon_button("neutral", Icon::cross, {px(control_height), px(control_height)}, px(10),
                    neutral ? color::dim : color::attention,
                    "All colours, exposure and gamma as they are (Shift+N)"))
        frame.view.inspection = {};
    note_item(frame, "neutral");
}

// From as many splats as hold the frame rate to all of them.
void preview_control(GuiFrame& frame) {
    constexpr float least_percent = 0.5f;
    float percent = frame.view.preview_share * 100.0f;
    const float x = ImGui::GetCursorPosX();
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, color::dim);
    ImGui::TextUnformatted("Preview");
    ImGui::SameLine(x + px(58));
    ImGui::SetNextItemWidth(px(100));
    const char* format = percent > 0 ? "%.0f %%" : "Fluid";
    if (ImGui::SliderFloat("##preview", &percent, 0, 100, format, ImGuiSliderFlags_AlwaysClamp))
        frame.view.preview_share = percent < least_percent ? 0.0f : percent / 100.0f;
    ImGui::PopStyleColor();
    note_item(frame, "preview");
    tooltip(
        "What moves: at the left as many splats as hold 24 frames a second, each in place of many; to the "
        "right more splats and fewer frames, up to every splat");
}

void engine_control(GuiFrame& frame) {
    combo(frame, "engine", frame.view.engine, {"Engine auto", "Card", "Processor"}, 96,
          "What draws the preview. Now: " + frame.status.engine);
}

struct Tool {
    float width;  // at scale 1
    void (*draw)(GuiFrame&);
};
// The ones that are looked for most first: the last go behind "..." where there is no room.
constexpr std::array<Tool, 7> right_tools{{{84, display_control},
                                           {158, preview_control},
                                           {96, engine_control},
                                           {72, exposure_control},
                                           {56, channel_control},
                                           {56, gamma_control},
                                           {control_height, neutral_control}}};

// The tools that had no room: the settings of the comparison where `with_compare`, and the tools from one on.
void rest_of_tools(GuiFrame& frame, bool with_compare, std::size_t from) {
    const bool clicked = icon_button("more", Icon::dots, {px(control_height), px(control_height)}, px(12),
                                     color::dim, nullptr);
    note_item(frame, "more tools");
    if (clicked) ImGui::OpenPopup("rest");
    if (!ImGui::BeginPopup("rest")) return;
    if (with_compare) compare_settings(frame);
    for (std::size_t i = from; i < right_tools.size(); ++i) right_tools[i].draw(frame);
    close_on_escape();
    ImGui::EndPopup();
}

void draw_right_tools(GuiFrame& frame, const Rect& area) {
    const float more = px(control_height) + px(small_gap);
    const float right = area.end().x - px(8);
    const float settings_end =
        ImGui::GetCursorScreenPos().x + px(small_gap + width_of_compare_settings(frame));
    const bool has_settings = settings_end + px(gap) + more <= right;
    if (has_settings) {
        ImGui::SetCursorScreenPos({ImGui::GetCursorScreenPos().x + px(small_gap), area.y + px(4)});
        compare_settings(frame);
    }
    const float left_end = has_settings ? settings_end : ImGui::GetCursorScreenPos().x;
    const auto width_of = [](std::size_t count) {
        float width = 0;
        for (std::size_t i = 0; i < count; ++i)
            width += px(right_tools[i].width) + (i > 0 ? px(small_gap) : 0);
        return width;
    };
    std::size_t fits = right_tools.size();
    const auto has_rest = [&] { return !has_settings || fits < right_tools.size(); };
    while (fits > 0 && left_end + px(gap) + width_of(fits) + (has_rest() ? more : 0) > right) --fits;
    const bool rest = has_rest();
    ImGui::SetCursorScreenPos({std::floor(right - width_of(fits) - (rest ? more : 0)), area.y + px(4)});
    for (std::size_t i = 0; i < fits; ++i) {
        right_tools[i].draw(frame);
        ImGui::SameLine(0, px(small_gap));
    }
    if (rest) rest_of_tools(frame, !has_settings, fits);
}

}  // namespace

void draw_tool_row(GuiFrame& frame, const Rect& area) {
    if (!begin_part("tools", area)) return;
    push_field_height(px(control_height));
    ImGui::SetCursorScreenPos({area.x + px(8), area.y + px(4)});
    constexpr float narrow = 620;
    view_choice(frame, area.width < px(narrow));
    ImGui::SameLine(0, px(gap));
    size_choice(frame);
    ImGui::SameLine(0, px(gap));
    compare_choice(frame);
    ImGui::SameLine(0, 0);
    draw_right_tools(frame, area);
    ImGui::PopStyleVar();
    ImGui::EndChild();
}

}  // namespace astrosplat

// The ring moves by Dear ImGui's requests for navigation. Its own switch for them would take arrows, Space
// and Escape from the timeline at all times, and Tab stop at text fields alone, so they are made here, one by
// one; as long as the switch is off, it hides its highlight in every frame.
#include <imgui_internal.h>

#include <cstring>

#include "gui/parts.h"

namespace astrosplat {
namespace {

constexpr std::array<const char*, 4> parts{"start card", "panel", "tools", "timeline"};  // the ring's, by F6
constexpr std::string_view menu_letters = "FEVLCRH";                                     // of menu_names

// What the keys of this frame ask of parts that are drawn later; there is one window.
const char* part_to_enter = nullptr;
std::array<bool, parts.size()> part_drawn{}, part_is_there{};  // in this frame, and in the last
bool alt_alone = false;                                        // nothing else was pressed since
const char* menu_to_open = nullptr;
const char* next_menu = nullptr;  // to be opened in the next frame
bool ring_wanted = false;         // by the last key or click
bool mouse_moved = false;         // since that key
bool ring_was_alive = false;      // its control was drawn in the last frame
bool text_was_typed = false;      // when this frame began

ImGuiContext& imgui() { return *ImGui::GetCurrentContext(); }

bool is_within(const ImGuiWindow* window, const char* part) {
    const std::string name = std::string("/") + part + "_";  // "astrosplat/panel_1A2B3C4D"
    for (; window; window = window->ParentWindow)
        if (std::strstr(window->Name, name.c_str())) return true;
    return false;
}

/// Index of the part that has the keyboard; -1: none.
int current_part() {
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (is_within(imgui().NavWindow, parts[i])) return static_cast<int>(i);
    return -1;
}

/// The one after it, of those that are there.
const char* part_after(int part) {
    for (std::size_t i = 1; i <= parts.size(); ++i) {
        const std::size_t next = static_cast<std::size_t>(part + static_cast<int>(i)) % parts.size();
        if (part_is_there[next]) return parts[next];
    }
    return nullptr;
}

/// What the ring is on counts as hovered, until the mouse moves.
void show_ring(bool mouse_rests = true) {
    ring_wanted = true;
    mouse_moved = !mouse_rests;
    imgui().NavDisableHighlight = false;
    imgui().NavDisableMouseHover = mouse_rests;
}

constexpr ImGuiScrollFlags keep_visible =
    ImGuiScrollFlags_KeepVisibleEdgeX | ImGuiScrollFlags_KeepVisibleEdgeY;

void step(bool back) {
    ImGuiContext& g = imgui();
    ImGui::NavMoveRequestSubmit(ImGuiDir_None, back ? ImGuiDir_Up : ImGuiDir_Down,
                                ImGuiNavMoveFlags_Tabbing | ImGuiNavMoveFlags_FocusApi, keep_visible);
    g.NavTabbingDir = g.NavId == 0 || !ring_was_alive ? 0 : back ? -1 : 1;
    g.NavTabbingResultFirst.Clear();
    g.NavTabbingCounter = -1;
    show_ring();
}

void move(ImGuiDir direction) {
    ImGuiContext& g = imgui();
    ImGuiWindow* const window = g.NavWindow;
    if (!window) return;
    show_ring();
    if (g.NavId == 0) return ImGui::NavInitWindow(window, true);
    ImGui::NavMoveRequestSubmit(direction, direction, ImGuiNavMoveFlags_None, keep_visible);
    ImRect from = window->NavRectRel[g.NavLayer];
    from.Translate(window->DC.CursorStartPos);
    from.Min.x = from.Max.x = std::min(from.Min.x + 1.0f, from.Max.x);  // columns: as Dear ImGui has it
    g.NavScoringRect = from;
}

void activate() {
    ImGuiContext& g = imgui();
    g.NavActivateId = g.NavActivateDownId = g.NavActivatePressedId = g.NavId;
    if (!key_pressed(key_code::space)) g.NavActivateInputId = g.NavId;
}

bool enter_pressed() { return key_pressed(key_code::enter) || key_pressed(key_code::pad_enter); }

void steer_ring() {
    const bool popup = any_popup(), ring = ring_shown();
    if (key_pressed(key_code::tab, true)) {
        if (popup || ring || is_within(imgui().NavWindow, "panel"))  // after a click in the panel from there
            step(ImGui::GetIO().KeyShift);
        else
            part_to_enter = part_after(-1);
    }
    if (key_pressed(key_code::f6) && !popup) part_to_enter = part_after(ring ? current_part() : -1);
    if (!ring && !popup) return;
    constexpr std::pair<int, ImGuiDir> arrows[] = {{key_code::left, ImGuiDir_Left},
                                                   {key_code::right, ImGuiDir_Right},
                                                   {key_code::up, ImGuiDir_Up},
                                                   {key_code::down, ImGuiDir_Down}};
    for (const auto& [code, direction] : arrows)
        if (key_pressed(code, true)) move(direction);
    if (ring && (key_pressed(key_code::space) || enter_pressed())) activate();
    if (key_pressed(key_code::escape) && !popup) hide_ring();
}

/// Alt let go with nothing else pressed meanwhile: with a drag in the view it is another camera.
bool alt_tapped() {
    const ImGuiIO& io = ImGui::GetIO();
    if (key_pressed(key_code::left_alt)) alt_alone = true;
    for (int code = 0; code < static_cast<int>(std::size(io.KeysDown)); ++code)
        if (code != key_code::left_alt && key_down(code)) alt_alone = false;
    if (ImGui::IsAnyMouseDown() || io.MouseWheel != 0.0f) alt_alone = false;
    return alt_alone && ImGui::IsKeyReleased(static_cast<ImGuiKey>(key_code::left_alt));
}

/// Alt and the letter of a menu; Alt alone or F10 for the first.
void steer_menus() {
    const ImGuiIO& io = ImGui::GetIO();
    if ((alt_tapped() || key_pressed(key_code::f10)) && !any_popup()) menu_to_open = menu_names[0];
    for (std::size_t i = 0; i < menu_names.size(); ++i)
        if (io.KeyAlt && !io.KeyCtrl && key_pressed(menu_letters[i])) menu_to_open = menu_names[i];
    if (menu_to_open) show_ring();
}

/// From a text to the control beside it, by F6 where Tab completes it: Dear ImGui's own Tab would stop at
/// texts alone. In the panel values are typed one after the other.
void leave_text() {
    const ImGuiContext& g = imgui();
    const bool takes_tab = (g.ActiveIdUsingKeyInputMask & (1u << ImGuiKey_Tab)) != 0;
    const bool leaves = (key_pressed(key_code::tab, true) && !takes_tab) || key_pressed(key_code::f6);
    if (!leaves || g.IO.KeyCtrl || g.IO.KeyAlt || is_within(g.NavWindow, "panel")) return;
    if (text_was_typed) step(g.IO.KeyShift);
}

}  // namespace

bool ring_shown() { return ring_wanted && imgui().NavId != 0 && imgui().NavWindow && ring_was_alive; }

void hide_ring() {
    ring_wanted = false;
    imgui().NavDisableHighlight = true;
}

void steer_by_keys() {
    ImGuiContext& g = imgui();
    part_to_enter = nullptr;
    menu_to_open = std::exchange(next_menu, nullptr);
    mouse_moved = mouse_moved || g.IO.MouseDelta.x != 0.0f || g.IO.MouseDelta.y != 0.0f;
    if (ring_wanted) show_ring(!mouse_moved);
    for (const bool clicked : g.IO.MouseClicked)
        if (clicked) hide_ring();
    text_was_typed = g.ActiveId != 0 && g.ActiveId == g.InputTextState.ID;
    part_is_there = std::exchange(part_drawn, {});
    if (g.ActiveId != 0) return leave_text();
    steer_menus();
    if (!g.IO.KeyCtrl && !g.IO.KeyAlt) steer_ring();
}

bool takes_key(int code) {
    using namespace key_code;
    if (!ring_shown()) return false;
    for (const int own : {tab, left, right, up, down, space, enter, escape})
        if (code == own) return true;
    return code >= '0' && code <= '9';  // a number that was meant for the field is no other view
}

bool enter_answers() { return enter_pressed() && (text_was_typed || !ring_shown()); }

void enter_part(const char* name) {
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (std::strcmp(name, parts[i]) == 0) part_drawn[i] = true;
    if (!part_to_enter || std::strcmp(name, part_to_enter) != 0) return;
    ImGui::SetKeyboardFocusHere();
    show_ring();
}

void pass_ring_by() {
    ImGuiWindow* const window = imgui().CurrentWindow;
    window->DC.NavLayersActiveMask = 0;
    window->DC.NavHasScroll = false;
}

void leave_menu_sideways(std::size_t menu) {
    const ImGuiDir direction = imgui().NavMoveDir;
    if (!ImGui::NavMoveRequestButNoResultYet() || (direction != ImGuiDir_Left && direction != ImGuiDir_Right))
        return;
    ImGui::NavMoveRequestCancel();
    const std::size_t by = direction == ImGuiDir_Right ? 1 : menu_names.size() - 1;
    next_menu = menu_names[(menu + by) % menu_names.size()];
}

bool opens_menu(const char* name) { return menu_to_open && std::strcmp(name, menu_to_open) == 0; }

bool entered_by_key() { return ring_shown() && ImGui::IsItemFocused() && enter_pressed(); }

void keep_ring_at(ImGuiID id) {
    ImGuiContext& g = imgui();
    if (!ring_wanted) return;
    ImGui::FocusWindow(g.CurrentWindow);
    g.NavId = id;
}

void ring_to_next_item() {
    ImGui::SetKeyboardFocusHere();
    show_ring();
}

bool keys_steer() {
    const ImGuiContext& g = imgui();
    return g.NavMoveSubmitted || g.NavInitRequest || menu_to_open || next_menu;
}

void draw_ring() {
    ImGuiContext& g = imgui();
    ring_was_alive = g.NavIdIsAlive;
    const ImGuiWindow* const window = g.NavWindow;
    if (!ring_shown() || !window) return;
    ImRect area = window->NavRectRel[g.NavLayer];
    area.Translate(window->DC.CursorStartPos);
    area.Expand(px(2));
    ImRect seen = window->InnerRect;
    seen.Expand(px(1));
    area.ClipWith(seen);
    ImDrawList* const list = ImGui::GetForegroundDrawList();
    list->AddRect({std::floor(area.Min.x), std::floor(area.Min.y)},
                  {std::floor(area.Max.x), std::floor(area.Max.y)}, color::accent, px(3), 0, px(2));
}

}  // namespace astrosplat

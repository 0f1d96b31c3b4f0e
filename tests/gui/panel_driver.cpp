// Frames of ImGui without a window.
#include "gui/panel_driver.h"

#include <imgui_internal.h>

#include "gui/gui.h"
#include "gui/key_map.h"
#include "gui/widgets.h"
#include "scene/describe.h"
#include "support/test.h"

namespace astrosplat {
namespace {

ImGuiContext* make_context(glm::vec2 size) {
    ImGuiContext* context = ImGui::CreateContext();
    ImGui::SetCurrentContext(context);
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {size.x, size.y};
    io.DeltaTime = 1.0f / 60.0f;
    io.LogFilename = nullptr;
    set_key_map();
    apply_theme(1.0f);
    io.MousePos = {-1000.0f, -1000.0f};
    return context;
}

}  // namespace

PanelDriver::PanelDriver(const std::string& toml, float width_px, float height_px)
    : document(Document::untitled(toml, "/nowhere/scene.toml")),
      size_(width_px, height_px),
      context_(make_context(size_)),
      font_(font_picture()) {
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->SetTexID(&font_);
    io.ClipboardUserData = &clipboard;
    io.SetClipboardTextFn = [](void* own, const char* text) { *static_cast<std::string*>(own) = text; };
    io.GetClipboardTextFn = [](void* own) { return static_cast<std::string*>(own)->c_str(); };
    frames(2);
}

PanelDriver::~PanelDriver() { ImGui::DestroyContext(context_); }

void PanelDriver::frames(int count) {
    for (int i = 0; i < count; ++i) {
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({size_.x, size_.y});
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
        ImGui::Begin("window", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        ImGui::PopStyleVar();
        panel.draw(frame());
        ImGui::End();
        ImGui::Render();
    }
}

void PanelDriver::move(glm::vec2 to) {
    ImGui::GetIO().MousePos = {to.x, to.y};
    frames();
}

void PanelDriver::press(int button) {
    ImGui::GetIO().MouseDown[button] = true;
    frames();
}

void PanelDriver::release(int button) {
    ImGui::GetIO().MouseDown[button] = false;
    frames(2);
}

void PanelDriver::click(glm::vec2 at, int button) {
    frames(30);  // far enough from the last click not to be a double one
    move(at);
    press(button);
    release(button);
}

void PanelDriver::double_click(glm::vec2 at) {
    click(at);
    press();
    release();
}

void PanelDriver::drag(glm::vec2 from, glm::vec2 by, int steps) {
    frames(30);
    move(from);
    press();
    for (int i = 1; i <= steps; ++i) move(from + by * (float(i) / float(steps)));
    release();
}

void PanelDriver::type(const std::string& text) {
    for (const char c : text) {
        ImGui::GetIO().AddInputCharacter(static_cast<unsigned char>(c));
        frames();
    }
}

void PanelDriver::tap(ImGuiKey_ key) {
    ImGuiIO& io = ImGui::GetIO();
    io.KeysDown[io.KeyMap[key]] = true;
    frames();
    io.KeysDown[io.KeyMap[key]] = false;
    frames(2);
}

void PanelDriver::enter(const std::string& key, const std::string& text) {
    double_click(row(key).value);
    type(text);
    tap(ImGuiKey_Enter);
}

void PanelDriver::choose(const std::string& item) {
    frames(2);
    const ImGuiContext& g = *context_;
    if (g.OpenPopupStack.empty()) {
        ADD_FAILURE() << "no popup with " << item;
        return;
    }
    const ImGuiWindow* popup = g.OpenPopupStack.back().Window;
    // A menu item is a selectable without text inside the id of its label; a selectable is its label.
    const ImGuiID label = ImHashStr(item.c_str(), 0, popup->ID), inside = ImHashStr("", 0, label);
    for (float y = popup->Pos.y; y < popup->Pos.y + popup->Size.y; y += 4.0f) {
        move({popup->Pos.x + popup->Size.x * 0.5f, y});
        if (g.HoveredId != label && g.HoveredId != inside) continue;
        press();
        release();
        return;
    }
    ADD_FAILURE() << "no item " << item;
}

bool PanelDriver::has_row(const std::string& key) const {
    for (const DrawnRow& drawn : panel.rows())
        if (drawn.key == key) return true;
    return false;
}

DrawnRow PanelDriver::row(const std::string& key) const {
    for (const DrawnRow& drawn : panel.rows())
        if (drawn.key == key) return drawn;
    ADD_FAILURE() << "no row of " << key;
    return {};
}

void PanelDriver::show(PanelTab tab) {
    view.tab = tab;
    panel.open_all();
    frames(3);
}

Value PanelDriver::value(const std::string& key) const {
    Scene scene = document.scene();
    const Description description = describe(scene);
    const Parameter* parameter = find_parameter(description, key);
    EXPECT_TRUE(parameter) << key;
    return parameter ? parameter->get() : Value();
}

}  // namespace astrosplat

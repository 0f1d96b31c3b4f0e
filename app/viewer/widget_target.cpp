#include "viewer/widget_target.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "gui/gui.h"

namespace astrosplat {

WidgetTarget::WidgetTarget(int width, int height) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
    io.DeltaTime = 1.0f / 60.0f;
    apply_theme(1.0f);
    ImGui_ImplOpenGL3_Init("#version 410 core");
    target_.resize(width, height, GL_RGBA8);
}

WidgetTarget::~WidgetTarget() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
}

void WidgetTarget::begin() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
}

void WidgetTarget::end() {
    ImGui::Render();
    target_.bind();
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

std::vector<unsigned char> WidgetTarget::read() const {
    return read_rgba8(target_.framebuffer(), target_.width(), target_.height());
}

}  // namespace astrosplat

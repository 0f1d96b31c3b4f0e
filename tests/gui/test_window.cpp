// Frames of 1/60 s; every press and every move is seen by at least one of them, as ImGui 1.86 wants it.
#include "gui/test_window.h"

#include <imgui_internal.h>

#include "gui/key_map.h"
#include "gui/widgets.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Something like a galaxy, so that pictures of the window can be judged.
Picture8 galaxy_picture(int width, int height) {
    Picture8 picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double dx = (x - width * 0.5) / height, dy = (y - height * 0.5) / (height * 0.55);
            const double r = std::sqrt(dx * dx + dy * dy), angle = std::atan2(dy, dx);
            const double arm = 0.5 + 0.5 * std::cos(2 * angle - 9 * std::log(r + 0.05));
            const double light = std::exp(-4.5 * r) * (0.35 + arm) + 0.9 * std::exp(-30 * r);
            const auto level = [&](double gain) {
                return std::uint8_t(255.0 * std::min(1.0, std::pow(light * gain, 0.8)));
            };
            picture.at(x, y) = {level(1.0), level(0.85), level(0.8 + 0.3 * r), 255};
        }
    return picture;
}

}  // namespace

TestWindow::TestWindow(Document document_, int width, int height, float content_scale)
    : document(std::move(document_)), context_(ImGui::CreateContext()), width_(width), height_(height) {
    apply_theme(content_scale);
    set_key_map();
    font_ = font_picture();
    image_ = galaxy_picture(1222, 668);
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->SetTexID(&font_);
    io.DisplaySize = {float(width), float(height)};
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    status = example_status();
    status.viewport_texture = &image_;
    status.view_frame.width = image_.width;
    status.view_frame.height = image_.height;
    move({-100.0f, -100.0f});
    frame(2);
}

TestWindow::~TestWindow() { ImGui::DestroyContext(context_); }

void TestWindow::frame(int count) {
    for (int i = 0; i < count; ++i) {
        ImGui::GetIO().DeltaTime = 1.0f / 60.0f;
        ImGui::NewFrame();
        Commands commands;
        commands.swap(dropped);
        gui.draw(document, view, status, commands);
        ImGui::Render();
        commands_.insert(commands_.end(), commands.begin(), commands.end());
        ImGui::GetIO().MouseWheel = 0.0f;
    }
}

void TestWindow::move(glm::vec2 to) { ImGui::GetIO().MousePos = {to.x, to.y}; }
void TestWindow::press(int button) {
    ImGui::GetIO().MouseDown[button] = true;
    frame();
}
void TestWindow::release(int button) {
    ImGui::GetIO().MouseDown[button] = false;
    frame();
}
void TestWindow::hover(glm::vec2 to) {
    move(to);
    frame(2);
}
void TestWindow::click(glm::vec2 at_px, int button) {
    hover(at_px);  // first, as a mouse does
    press(button);
    release(button);
    frame(3);  // what it opens is there
}
void TestWindow::double_click(glm::vec2 at_px) {
    click(at_px);
    press();
    release();
    frame(3);
}
void TestWindow::drag(glm::vec2 from, glm::vec2 by, int button) {
    hover(from);
    press(button);
    for (int step = 1; step <= 4; ++step) {
        move(from + by * (float(step) / 4.0f));
        frame();
    }
    release(button);
    frame();
}
void TestWindow::wheel(float notches) {
    ImGui::GetIO().MouseWheel = notches;
    frame();
}

void TestWindow::hold(bool ctrl, bool shift, bool alt) {
    ImGuiIO& io = ImGui::GetIO();
    io.KeyCtrl = ctrl;
    io.KeyShift = shift;
    io.KeyAlt = alt;
}
void TestWindow::tap(int code, bool ctrl, bool shift) {
    hold(ctrl, shift, false);
    ImGui::GetIO().KeysDown[code] = true;
    frame();
    ImGui::GetIO().KeysDown[code] = false;
    hold(false, false, false);
    frame(3);
}
void TestWindow::type(const std::string& text) {
    ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
    frame(2);
}

bool TestWindow::has(const std::string& name) const {
    for (const DrawnItem& item : gui.drawn_items())
        if (item.name == name) return true;
    return false;
}
glm::vec2 TestWindow::ring() const {
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    EXPECT_TRUE(ring_shown());
    if (!ring_shown()) return {};
    const ImVec2 in_window = g.NavWindow->NavRectRel[g.NavLayer].GetCenter(),
                 at = g.NavWindow->DC.CursorStartPos;
    return {at.x + in_window.x, at.y + in_window.y};
}

glm::vec2 TestWindow::at(const std::string& name) {
    for (const DrawnItem& item : gui.drawn_items())
        if (item.name == name) return item.middle;
    std::string names;
    for (const DrawnItem& item : gui.drawn_items()) names += " '" + item.name + "'";
    ADD_FAILURE() << "no control '" << name << "' among" << names;
    return {-100.0f, -100.0f};
}

void TestWindow::choose(const std::string& path) {
    for (std::size_t slash = path.find('/'); slash != std::string::npos; slash = path.find('/', slash + 1))
        click(at(path.substr(0, slash)));
    click(at(path));
}

Commands TestWindow::take_commands() {
    Commands taken;
    taken.swap(commands_);
    return taken;
}

Command TestWindow::take_only(Command::Kind kind) {
    const Commands taken = take_commands();
    EXPECT_EQ(kinds(taken), std::vector{kind});
    return taken.empty() ? Command() : taken[0];
}

Picture8 TestWindow::picture(Style style) {
    Picture8 target(width_, height_);
    software_draw(*ImGui::GetDrawData(), target, style);
    return target;
}

void TestWindow::keep_screen(const std::string& name) {
    const char* folder = std::getenv("ASTROSPLAT_GUI_PICTURES");
    if (folder && *folder) write_ppm(fs::path(folder) / (name + ".ppm"), picture());
}

Document example_document() {
    return Document::untitled(R"(astrosplat = 1
[output]
resolution = [1920, 1080]
frames = "1-240"
[camera]
position = [0.0, 6.0, 12.0]
target = [0.0, 0.0, 0.0]

[[layer]]
name = "dust"
[layer.source]
meshes = [ { mesh = "plane", texture = "dust.png" } ]
count = 2900000

[[layer]]
name = "stars"
[layer.source]
meshes = [ { mesh = "plane", texture = "stars.png" } ]
count = 8100000

[[layer]]
name = "nebulae"
[layer.source]
meshes = [ { mesh = "plane", texture = "nebulae.png" } ]
count = 1400000

[animation]
"camera.position" = { keys = [[1, [0.0, 6.0, 12.0]], [90, [8.0, 3.0, 8.0]], [240, [0.0, 0.5, 12.0]]], interpolation = "smooth" }
"layer.dust.look.alpha.power" = { keys = [[1, 1.0], [90, 2.5], [180, 1.2]], interpolation = "smooth" }
"layer.stars.render.opacity" = { keys = [[24, 0.2], [120, 1.0]] }
)",
                              "/scenes/whirlpool.toml");
}

Status example_status() {
    Status status;
    status.view_frame.state = ViewFrameState::refining;
    status.view_frame.progress = 0.41f;
    status.view_frame.shown = 240000;
    status.view_frame.total = 12400000;
    for (const std::int64_t splats : {2900000, 8100000, 1400000}) {
        LayerStatus layer;
        layer.splats = splats;
        layer.kept = splats / 100 * 61;
        layer.radius_min = 0.01;
        layer.radius_max = 0.05;
        status.layers.push_back(layer);
    }
    status.box.add({-5.0, -0.5, -5.0});
    status.box.add({5.0, 0.5, 5.0});
    status.probe = PixelProbe{812, 344, {0.214f, 0.187f, 0.093f, 0.61f}, 23.4f};
    status.message = {"Read 3 layers", false};
    status.log = {{"Read 3 layers", false}};
    status.memory_bytes = 3200000000;
    status.threads = 2;
    status.engine = "NVIDIA H100";
    status.has_ffmpeg = true;
    status.recent = {"/scenes/m51.toml", "/scenes/nebula.toml"};
    return status;
}

void make_edited(TestWindow& window) {
    window.document.edit("Opacity of dust", [](Scene& scene) { scene.layers[0].render.opacity = 0.5; });
    window.frame();
}

QueuedJob running_job_of(const std::string& text, float progress) {
    QueuedJob job;
    job.number = 1;
    job.state = QueuedJob::State::running;
    job.title = "whirlpool.toml: Frames 1-240, 1920x1080";
    job.target = "/renders/whirlpool/whirlpool.####.exr";
    job.text = text;
    job.progress = progress;
    return job;
}

std::vector<Command::Kind> kinds(const Commands& commands) {
    std::vector<Command::Kind> list;
    for (const Command& command : commands) list.push_back(command.kind);
    return list;
}

}  // namespace astrosplat

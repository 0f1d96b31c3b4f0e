#include "window/window_test.h"

#include "edit/preferences.h"
#include "gui/widgets.h"
#include "source/write_image.h"

namespace astrosplat::test {
namespace {

constexpr const char* scene_text = R"(# by hand, keep this
astrosplat = 1

[output]
resolution = [320, 180]  # px
frames = "1-24"
path = "frames/shot.####.png"

[camera]
position = [0.0, 6.0, 8.0]
target = [0.0, 0.0, 0.0]

[[layer]]
name = "disc"  # the only one
[layer.source]
meshes = [ { mesh = "plane", texture = "rings.png" } ]
count = 60000

[animation]
"camera.position" = { keys = [[1, [0.0, 6.0, 8.0]], [24, [4.0, 5.0, 7.0]]] }
)";

bool on_path(const std::string& program) {
    return run_program({"/bin/sh", "-c", "command -v " + program}).code == 0;
}

Area area_of(const Rect& rect) { return {int(rect.x), int(rect.y), int(rect.width), int(rect.height)}; }

constexpr int badge_height = 50;  // px at the viewport's lower end

}  // namespace

void write_rings(const fs::path& file) {
    constexpr int size = 64;
    std::vector<unsigned char> rgba;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double r = std::hypot(x - 30.5, y - 34.5) / 32.0;
            const double light = std::max(0.0, 1.0 - r) * (0.6 + 0.4 * std::cos(20.0 * r));
            const auto byte = [&](double level) { return static_cast<unsigned char>(255.0 * light * level); };
            rgba.insert(rgba.end(), {byte(1.0), byte(0.7), byte(0.3 + 0.005 * x), 255});
        }
    write_image(file, size, size, rgba);
}

void write_plain(const fs::path& file, int width, int height, const std::array<unsigned char, 3>& rgb) {
    std::vector<unsigned char> rgba;
    for (int i = 0; i < width * height; ++i) rgba.insert(rgba.end(), {rgb[0], rgb[1], rgb[2], 255});
    write_image(file, width, height, rgba);
}

ViewerTest::ViewerTest() : scene_file(folder / "scene.toml") {
    write_text(scene_file, scene_text);
    write_rings(folder / "rings.png");
    fs::create_directories(folder / "home");
    fs::create_directories(folder / "tmp");
    Preferences preferences;
    preferences.window_width = width;
    preferences.window_height = height;
    save_preferences(preferences, folder / "home/config/astrosplat/viewer.json");
}

WindowTest::~WindowTest() {
    if (program) end(SIGKILL);
}

void WindowTest::SetUp() {
    for (const char* needed : {"Xvfb", "xdotool"})
        if (!on_path(needed)) GTEST_SKIP() << needed << " is not installed (third_party/packages.txt)";
    screen.emplace(width, height);
    person.emplace(screen->display());
}

RunOptions ViewerTest::options() const {
    const auto place = [&](const char* name) { return (folder / name).string(); };
    RunOptions options;
    options.folder = folder;
    options.environment = {"HOME=" + place("home"),
                           "XDG_CONFIG_HOME=" + place("home/config"),
                           "XDG_STATE_HOME=" + place("home/state"),
                           "XDG_CACHE_HOME=" + place("home/cache"),
                           "TMPDIR=" + place("tmp"),
                           "PATH=" + place("no programs")};
    options.without = {"DISPLAY", "WAYLAND_DISPLAY", "ASTROSPLAT_CACHE"};
    return options;
}

RunResult ViewerTest::run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), ASTROSPLAT_PROGRAM);
    return run_program(arguments, ViewerTest::options());
}

RunOptions WindowTest::options() const {
    RunOptions options = ViewerTest::options();
    options.environment.push_back("DISPLAY=" + screen->display());
    options.environment.insert(options.environment.end(), environment.begin(), environment.end());
    return options;
}

void WindowTest::start(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), ASTROSPLAT_PROGRAM);
    program = std::make_unique<RunningProgram>(arguments, options());
    // With the title of the scene it has drawn a frame.
    const auto shown = [&] { return title().find(" - astrosplat") != std::string::npos || !running(); };
    ASSERT_TRUE(comes_true(shown) && running()) << program->err_so_far();
    screen->focus();
}

bool WindowTest::running() const { return program && program->running(); }

RunResult WindowTest::end(int signal) {
    if (signal) program->signal(signal);
    EXPECT_TRUE(comes_true([&] { return !running(); }));
    if (running()) program->signal(SIGKILL);
    const RunResult result = program->wait();
    program.reset();
    return result;
}

void WindowTest::expect_title(const std::string& begin) {
    EXPECT_TRUE(comes_true([&] { return title() == begin + " - astrosplat"; })) << title();
}

Pixels WindowTest::pixels_of(Rect Layout::*part) const { return screen->pixels(area_of(layout().*part)); }

Pixels WindowTest::frame_pixels() const {
    Area area = area_of(layout().viewport);
    area.height -= badge_height;
    return screen->pixels(area);
}

bool WindowTest::settled(const ViewState& parts) const {
    Area area = area_of(make_layout(parts, width, height, 1.0f).viewport);
    area.y += area.height - badge_height;
    area.height = badge_height;
    return count_of(screen->pixels(area), color::good) > 10;  // the dot
}

Pixels WindowTest::settled_frame(const Pixels& before) {
    Pixels now;
    const auto arrived = [&] {
        if (!settled()) return false;
        now = frame_pixels();
        return settled() && now != before && now == frame_pixels();
    };
    EXPECT_TRUE(comes_true(arrived)) << program->err_so_far();
    return now;
}

void WindowTest::expect_settled(const Pixels& expected) {
    EXPECT_TRUE(comes_true([&] { return settled() && frame_pixels() == expected; }));
}

TestWindow& WindowTest::same_widgets() {
    if (!widgets_) {
        widgets_.emplace(Document::open(scene_file), width, height);
        widgets_->status.layers.resize(1);
        widgets_->status.jobs.clear();
        widgets_->frame(3);
    }
    return *widgets_;
}

DrawnRow WindowTest::row(const std::string& key) {
    for (const DrawnRow& drawn : same_widgets().gui.panel().rows())
        if (drawn.key == key) return drawn;
    ADD_FAILURE() << "no row of " << key;
    return {};
}

glm::vec2 WindowTest::value_box(const std::string& key) { return row(key).value; }
glm::vec2 WindowTest::diamond(const std::string& key) { return row(key).diamond; }

// Blending rounds differently on the GPU.
bool WindowTest::shows(const Picture8& widgets, glm::vec2 middle) const {
    constexpr int radius = 8, tolerance = 3;
    const Area area{int(middle.x) - radius, int(middle.y) - radius, 2 * radius, 2 * radius};
    const Pixels shown = screen->pixels(area);
    std::size_t alike = 0;
    for (std::size_t i = 0; i < shown.rgb.size(); ++i) {
        const auto x = int(i) % area.width, y = int(i) / area.width;
        const Rgba8& wanted = widgets.at(area.x + x, area.y + y);
        const int found[] = {int(shown.rgb[i] >> 16 & 255), int(shown.rgb[i] >> 8 & 255),
                             int(shown.rgb[i] & 255)};
        alike += std::abs(wanted.r - found[0]) <= tolerance && std::abs(wanted.g - found[1]) <= tolerance &&
                 std::abs(wanted.b - found[2]) <= tolerance;
    }
    return alike > shown.rgb.size() * 9 / 10;
}

void WindowTest::click_when_shown(const std::string& name) {
    const glm::vec2 at = same_widgets().at(name);
    const Picture8 widgets = same_widgets().picture();
    person->move({width - 2.0f, height - 2.0f});  // under the mouse it looks different
    EXPECT_TRUE(comes_true([&] { return shows(widgets, at); })) << name << " is not shown";
    person->click(at);
}

void WindowTest::choose(const std::string& path) {
    TestWindow& widgets = same_widgets();
    for (std::size_t slash = path.find('/'); slash != std::string::npos; slash = path.find('/', slash + 1)) {
        const glm::vec2 menu = widgets.at(path.substr(0, slash));
        widgets.click(menu);
        person->click(menu);
    }
    const glm::vec2 item = widgets.at(path);
    widgets.click(item);
    person->click(item);
}

}  // namespace astrosplat::test

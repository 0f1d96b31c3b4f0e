// The window, state by state: every control lies inside the window at every size, and at one size it looks as
// in a committed picture. A change that is meant to be seen comes with new references; one that is not fails
// here. With $ASTROSPLAT_GUI_PICTURES all pictures are kept to be looked at.
#include "gui/panel_driver.h"
#include "gui/reference_screens.h"
#include "gui/test_window.h"
#include "gui/widgets.h"
#include "support/test.h"

namespace astrosplat {
namespace {

struct Size {
    int width, height;
    float scale;
    const char* name;
    friend void PrintTo(const Size& given, std::ostream* out) { *out << given.name; }
};
constexpr Size sizes[] = {{1100, 700, 1.0f, "of_references"},
                          {900, 600, 1.0f, "small"},
                          {1600, 900, 1.0f, "large"},
                          {2200, 1400, 2.0f, "double"}};

class References : public testing::TestWithParam<Size> {
  protected:
    References() : window(example_document(), GetParam().width, GetParam().height, GetParam().scale) {}
    /// Every control that was drawn can be reached by the mouse.
    /// `frames` later: what lies behind a dialog that opens grows dark from frame to frame.
    void expect_inside(const std::string& name, int frames = 3) {
        window.frame(frames);
        window.keep_screen(std::string(GetParam().name) + "_" + name);
        for (const DrawnItem& item : window.gui.drawn_items()) {
            // May be scrolled away: what the timeline lists, and in a low window the end of the longest menu.
            if (item.name.starts_with("track ") || item.name.starts_with("keyframe ") ||
                (GetParam().height < 700 && item.name.starts_with("View/")))
                continue;
            EXPECT_GE(item.middle.x, 0) << name << ": " << item.name;
            EXPECT_GE(item.middle.y, 0) << name << ": " << item.name;
            EXPECT_LE(item.middle.x, GetParam().width) << name << ": " << item.name;
            EXPECT_LE(item.middle.y, GetParam().height) << name << ": " << item.name;
        }
    }
    void expect_reference(const std::string& name, int frames = 3) {
        expect_inside(name, frames);
        if (GetParam().name == sizes[0].name) expect_like_reference(name);
    }
    TestWindow window;
};
INSTANTIATE_TEST_SUITE_P(Sizes, References, testing::ValuesIn(sizes),
                         [](const auto& given) { return std::string(given.param.name); });

TEST_P(References, Main) {
    window.view.frame = 86;
    expect_reference("main");
}
TEST_P(References, MenuOpen) {
    window.click("View");
    expect_reference("menu");
}
TEST_P(References, EveryMenu) {
    for (const char* menu : {"File", "Edit", "View", "Layer", "Camera", "Render", "Help"}) {
        window.click(menu);
        expect_inside(std::string("menu_") + menu);
        window.tap(key_code::escape);
    }
}
TEST_P(References, Graph) {
    window.view.frame = 60;
    window.click("graph");
    window.click("track camera.position");
    expect_reference("graph");
}
TEST_P(References, SnapshotsAndWipe) {
    window.view.snapshots_open = true;
    window.view.compare = CompareMode::wipe;
    void* picture = window.status.viewport_texture;
    window.status.snapshots = {{"Warm dust", picture, 1.83f, 12400000, 1.8},
                               {"Before the noise", picture, 0.6f, 12400000, 0}};
    window.status.b_snapshot = 0;
    window.status.b_name = "Warm dust";
    expect_reference("wipe");
}
TEST_P(References, Scopes) {
    window.view.scopes_open = true;
    window.status.scopes.fill(window.status.viewport_texture);
    expect_reference("scopes");
}
TEST_P(References, Log) {
    window.view.log_open = true;
    window.status.log.push_back({"whirlpool.toml:12: expected over, add or screen, found 'plus'", true});
    expect_reference("log");
}
TEST_P(References, Shortcuts) {
    window.tap(key_code::f1);
    expect_reference("shortcuts", 1);
}
TEST_P(References, RenderDialog) {
    window.choose("Render/Frames...");
    window.view.render.folder = "/films/one";
    window.view.render.name = "a.doc";
    window.status.render_estimate = "About 00:01:36 and 744 MB in all; 12 of 240 frames are there already";
    expect_reference("render", 1);
}
TEST_P(References, RenderCommand) {
    window.choose("Render/Movie...");
    window.status.render_estimate = "About 00:01:36, with 744 MB of frames until the movie is written";
    window.status.render_command = "astrosplat --batch /films/whirlpool.toml --frames=1-240";
    window.click("render/command");
    expect_inside("render_command");
}
TEST_P(References, Queue) {
    QueuedJob done = running_job_of("", 1.0f), failed = done,
              running = running_job_of("frame 12 (12/240)", 0.05f);
    done.state = QueuedJob::State::done;
    failed.state = QueuedJob::State::failed;
    failed.text = "no space left on device";
    failed.number = 2;
    running.number = 3;
    running.seconds_left = 754.0;
    running.files = {"/films/a.0001.png", "/films/a.0002.png"};
    window.status.jobs = {done, failed, running};
    window.status.finished = {window.status.viewport_texture, 1.78f, ""};
    window.view.queue_open = true;
    expect_reference("queue");
}
TEST_P(References, JobsThatEnded) {
    QueuedJob failed = running_job_of("", 0.3f), held = failed, movie = failed;
    failed.state = QueuedJob::State::failed;
    failed.text = "frame 12: /films/whirlpool/a.0012.png: cannot be written: No space left on device";
    failed.files = {"/films/whirlpool/a.0011.png"};
    held.state = QueuedJob::State::waiting;
    held.held_by = failed.number;
    held.number = 2;
    movie.state = QueuedJob::State::done;
    movie.is_movie = movie.kept = true;
    movie.target = "/films/whirlpool.mp4";
    movie.number = 3;
    window.status.jobs = {failed, held, movie};
    window.status.finished = {window.status.viewport_texture, 1.78f, ""};
    window.view.queue_open = true;
    expect_inside("queue_movie");
    window.click("queue/job 1");
    expect_inside("queue_failed");
    window.view.queue_open = false;
    window.view.movie = movie.target;
    window.status.played_movie = "whirlpool.mp4";
    expect_inside("movie");
}
TEST_P(References, Question) {
    make_edited(window);
    window.choose("File/Quit");
    expect_reference("question", 1);
}
TEST_P(References, Recovery) {
    window.status.recoveries = {
        {"/state/whirlpool-812-3f.toml", "whirlpool.toml", "2026-04-12 18:03:10 UTC"}};
    expect_inside("recovery");
}
TEST_P(References, OpenAFile) {
    window.status.recent = {"/usr/share/doc/a.toml",
                            fs::path(ASTROSPLAT_SOURCE_DIR) / "assets/scenes/nebula.toml"};
    window.choose("File/Open...");
    window.type(ASTROSPLAT_SOURCE_DIR "/assets");
    window.click("file/Open");
    expect_inside("open");
}
TEST_P(References, Failed) {
    window.status.view_frame.state = ViewFrameState::failed;
    window.status.view_frame.error = "the picture 'stars.png' of layer stars cannot be read";
    window.status.message = {"/scenes/whirlpool.toml:14: expected a file that can be read, found none", true};
    window.status.changed_on_disk = true;
    window.status.jobs.push_back(running_job_of("frame 12 (12/240)", 0.05f));
    expect_reference("failed");
}
TEST_P(References, FirstStart) {
    window.view.hint_open = true;
    window.status.layers[1].loading = true;
    window.status.layers[1].progress = 0.37f;
    window.status.layers[1].found = 3100000;
    window.status.layers[2].stale = true;
    expect_reference("first_start");
}
TEST_P(References, FreeViewWithOverlays) {
    window.status.view_frame.state = ViewFrameState::preview;
    window.view.view = ViewKind::free;
    window.view.inspection.exposure = 2.5f;
    window.view.preview_share = 0.25f;
    window.view.safe_areas = true;
    window.view.layer = 1;
    window.view.solo = {"stars"};
    window.status.overlay_lines = {{{100, 300}, {300, 250}, {500, 330}}, {{100, 300}}, {{300, 250}}};
    expect_reference("free");
}
TEST_P(References, WithoutPanels) {
    window.tap(key_code::f11);
    window.status.view_frame.state = ViewFrameState::final;
    window.status.view_frame.seconds = 1.8;
    expect_reference("no_panels");
}
TEST_P(References, DomesHaveRoundGatesAndSafeAreas) {
    window.tap(key_code::f11);
    window.document.edit("Dome", [](Scene& scene) {
        scene.output.width = scene.output.height = 1024;
        scene.camera.projection = Projection::fisheye;
    });
    window.view.safe_areas = true;
    window.status.view_frame.width = window.status.view_frame.height = 1024;
    window.status.view_frame.state = ViewFrameState::final;
    expect_reference("dome");
}

TEST(NoticeReferences, WhatTheButtonsDo) {
    TestWindow window(example_document(), sizes[0].width, sizes[0].height);
    window.status.changed_on_disk = true;
    window.frame(2);
    for (const std::string button : {"Reload", "Keep"}) {
        const glm::vec2 place = window.at("notice/" + button);
        window.move(place);
        window.frame(60);
        expect_like_reference("notice_" + button, Part{int(place.x) - 60, int(place.y) - 10, 420, 80});
    }
}

void expect_panel_reference(const std::string& name, PanelDriver& driver, PanelTab tab) {
    driver.show(tab);
    driver.frames(3);
    expect_like_reference(name);
}

TEST(PanelReferences, EveryTabWithAllSectionsOpen) {
    const char* const names[] = {"source", "look", "mixing", "camera", "environment", "output"};
    for (std::size_t tab = 0; tab < std::size(names); ++tab) {
        PanelDriver driver(R"(astrosplat = 1
[output]
resolution = [1920, 1080]
[camera]
position = [0.0, 6.0, 12.0]
target = [0.0, 0.0, 0.0]
[[layer]]
name = "dust"
[layer.source]
meshes = [ { mesh = "plane", texture = "dust.png" } ]
count = 2900000
[layer.look]
pdf = { shape = "curve", points = [[0.0, 1.0], [0.4, 0.3], [1.0, 0.0]] }
noise = [ { frequency = 0.5, cull = 0.4 }, { frequency = 4.0, jitter = 0.1 } ]
grade = { gain = 2.0, tint = [1.0, 0.8, 0.6] }
[animation]
"layer.dust.look.alpha.power" = { keys = [[1, 1.0], [90, 2.5]] }
)",
                           360.0f, 1400.0f);
        driver.status = example_status();
        driver.status.layers[0].color = glm::vec3(0.8f, 0.4f, 0.2f);
        expect_panel_reference(std::string("panel_") + names[tab], driver, static_cast<PanelTab>(tab));
    }
}

TEST(PanelReferences, AnglesOfAHybridLayer) {
    const std::string hybrid =
        "[layer.render]\nblend = \"hybrid\"\nhybrid = { from_deg = 20.0, to_deg = 65.0 }\n";
    PanelDriver driver(dust_scene(hybrid), 360.0f, 900.0f);
    driver.status = example_status();
    expect_panel_reference("panel_hybrid", driver, PanelTab::mixing);
}

TEST(IconReferences, Sheet) {
    TestWindow window(example_document(), 480, 320);
    ImGui::NewFrame();
    for (int i = 0; i <= int(Icon::tick); ++i) {
        const ImVec2 center{40.0f + 80.0f * float(i % 6), 40.0f + 80.0f * float(i / 6)};
        draw_icon(ImGui::GetForegroundDrawList(), static_cast<Icon>(i), center, 64.0f, color::text);
    }
    draw_bracket(ImGui::GetForegroundDrawList(), 360.0f, 250.0f, 310.0f, color::text);
    ImGui::Render();
    expect_like_reference("icons");
}

}  // namespace
}  // namespace astrosplat

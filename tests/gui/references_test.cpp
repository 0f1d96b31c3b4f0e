// The window, state by state, against committed pictures. A change that is meant to be
// seen comes with new references; one that is not fails here.
#include <gtest/gtest.h>

#include "gui/icons.h"
#include "gui/key_codes.h"
#include "gui/panel_driver.h"
#include "gui/reference_screens.h"
#include "gui/test_window.h"
#include "gui/theme.h"

namespace astrosplat {
namespace {

class References : public testing::Test {
  protected:
    References() : window(example_document(), 1100, 700) {}
    void expect_reference(const std::string& name) {
        window.frame(3);
        expect_like_reference(name, window.picture(Style::schematic));
    }
    TestWindow window;
};

TEST_F(References, Main) {
    window.view.frame = 86;
    expect_reference("main");
}
TEST_F(References, MenuOpen) {
    window.click("View");
    expect_reference("menu");
}
TEST_F(References, Graph) {
    window.view.frame = 60;
    window.click("graph");
    window.click("track camera.position");
    expect_reference("graph");
}
TEST_F(References, SnapshotsAndWipe) {
    window.view.snapshots_open = true;
    window.view.compare = CompareMode::wipe;
    void* picture = window.status.viewport_texture;
    window.status.snapshots = {{"Warm dust", picture, 1.83f, 12400000, 1.8},
                               {"Before the noise", picture, 0.6f, 12400000, 0}};
    window.status.b_snapshot = 0;
    window.status.b_name = "Warm dust";
    expect_reference("wipe");
}
TEST_F(References, Log) {
    window.view.log_open = true;
    window.status.log.push_back({"whirlpool.toml:12: expected over, add or screen, found 'plus'", true});
    expect_reference("log");
}
TEST_F(References, Shortcuts) {
    window.tap(key_code::f1);
    expect_reference("shortcuts");
}
TEST_F(References, RenderDialog) {
    window.choose("Render/Frames...");
    window.view.render.folder = "/films/one";
    window.view.render.name = "a.doc";
    window.status.render_command = "astrosplat --batch /films/whirlpool.toml --frames=1-240";
    expect_reference("render");
}
TEST_F(References, Queue) {
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
TEST_F(References, Question) {
    make_edited(window);
    window.choose("File/Quit");
    expect_reference("question");
}
TEST_F(References, Failed) {
    window.status.view_frame.state = ViewFrameState::failed;
    window.status.view_frame.error = "the picture 'stars.png' of layer stars cannot be read";
    window.status.message = {"/scenes/whirlpool.toml:14: expected a file that can be read, found none", true};
    window.status.changed_on_disk = true;
    window.status.jobs.push_back(running_job_of("frame 12 (12/240)", 0.05f));
    expect_reference("failed");
}
TEST_F(References, WhatTheButtonsOfANoticeDo) {
    window.status.changed_on_disk = true;
    window.frame(2);
    for (const std::string button : {"Reload", "Keep"}) {
        const glm::vec2 place = window.at("notice/" + button);
        window.move(place);
        window.frame(60);
        expect_like_reference("notice_" + button,
                              cropped(window.picture(Style::schematic), static_cast<int>(place.x) - 60,
                                      static_cast<int>(place.y) - 10, 420, 80));
    }
}
TEST_F(References, FirstStart) {
    window.view.hint_open = true;
    window.status.layers[1].loading = true;
    window.status.layers[1].progress = 0.37f;
    window.status.layers[1].found = 3100000;
    window.status.layers[2].stale = true;
    expect_reference("first_start");
}
TEST_F(References, FreeViewWithOverlays) {
    window.status.view_frame.state = ViewFrameState::preview;
    window.view.view = ViewKind::free;
    window.view.inspect_exposure = 2.5f;
    window.view.preview_share = 0.25f;
    window.view.safe_areas = true;
    window.view.layer = 1;
    window.view.solo = {"stars"};
    window.status.overlay_lines = {{{100, 300}, {300, 250}, {500, 330}}};
    expect_reference("free");
}
TEST_F(References, WithoutPanels) {
    window.tap(key_code::f11);
    window.status.view_frame.state = ViewFrameState::final;
    window.status.view_frame.seconds = 1.8;
    expect_reference("no_panels");
}
TEST_F(References, DomesHaveRoundGatesAndSafeAreas) {
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
        driver.show(static_cast<PanelTab>(tab));
        driver.frames(3);
        Picture8 picture(360, 1400);
        software_draw(*ImGui::GetDrawData(), picture, Style::schematic);
        expect_like_reference(std::string("panel_") + names[tab], picture);
    }
}

TEST(PanelReferences, AnglesOfAHybridLayer) {
    PanelDriver driver(R"(astrosplat = 1
[[layer]]
name = "dust"
[layer.source]
meshes = [ { mesh = "plane", texture = "dust.png" } ]
[layer.render]
blend = "hybrid"
hybrid = { from_deg = 20.0, to_deg = 65.0 }
)",
                       360.0f, 900.0f);
    driver.status = example_status();
    driver.show(PanelTab::mixing);
    driver.frames(3);
    Picture8 picture(360, 900);
    software_draw(*ImGui::GetDrawData(), picture, Style::schematic);
    expect_like_reference("panel_hybrid", picture);
}

TEST(IconReferences, Sheet) {
    TestWindow window(example_document(), 480, 320);
    ImGui::NewFrame();
    for (int i = 0; i <= static_cast<int>(Icon::dots); ++i) {
        const ImVec2 center{40.0f + 80.0f * static_cast<float>(i % 6),
                            40.0f + 80.0f * static_cast<float>(i / 6)};
        draw_icon(ImGui::GetForegroundDrawList(), static_cast<Icon>(i), center, 64.0f, color::text);
    }
    draw_bracket(ImGui::GetForegroundDrawList(), 360.0f, 250.0f, 310.0f, color::text);
    ImGui::Render();
    expect_like_reference("icons", window.picture(Style::schematic));
}

}  // namespace
}  // namespace astrosplat

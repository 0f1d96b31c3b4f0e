// Unsaved changes and snapshots survive a crash, and the window a long walk.
#include <glm/common.hpp>

#include "edit/kept_files.h"
#include "gui/widgets.h"
#include "support/test.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

// Unsaved changes survive a crash, and a scene edited by hand meanwhile is offered.

class WindowSafety : public WindowTest {
  protected:
    WindowSafety() { environment = {"ASTROSPLAT_AUTOSAVE_SECONDS=1"}; }

    std::vector<fs::path> autosaves() const {
        std::vector<fs::path> files;
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder / "home/state/astrosplat/autosave", ignored))
            if (entry.path().extension() == ".toml" && entry.path().filename().string()[0] != '.')
                files.push_back(entry.path());
        return files;
    }
    void edit() {
        start_settled();
        person->drag(value_box(power), {60.0f, 0.0f});
        expect_title("scene.toml - edited");
    }
    void offer_recovery() {
        std::vector<RecoveryOffer>& offers = same_widgets().status.recoveries;
        for (const fs::path& file : autosaves()) offers.push_back({file, "scene.toml", "now"});
        ASSERT_EQ(offers.size(), 1u);
        same_widgets().frame(3);
    }
};

TEST_F(WindowSafety, AKilledSessionIsRecovered) {
    edit();
    ASSERT_TRUE(comes_true([&] { return !autosaves().empty(); }));
    EXPECT_EQ(end(SIGKILL).code, -SIGKILL);
    EXPECT_EQ(saved().layers[0].look.alpha.power, 1.0f);

    start();
    expect_title("scene.toml");
    offer_recovery();
    click_when_shown("recovery/Recover");
    expect_title("scene.toml - edited");
    save();
    EXPECT_GT(saved().layers[0].look.alpha.power, 1.0f);
    EXPECT_HAS(text_of(scene_file), "# by hand, keep this");
    EXPECT_TRUE(comes_true([&] { return autosaves().empty(); }));
}

TEST_F(WindowSafety, ATerminatedSessionSavesAtOnceAndMayBeDiscarded) {
    environment.clear();
    edit();
    EXPECT_TRUE(autosaves().empty());
    EXPECT_EQ(end(SIGTERM).code, 128 + SIGTERM);
    start();
    offer_recovery();
    click_when_shown("recovery/Discard");
    EXPECT_TRUE(comes_true([&] { return autosaves().empty(); }));
    EXPECT_EQ(title(), "scene.toml - astrosplat");
    EXPECT_EQ(saved().layers[0].look.alpha.power, 1.0f);
}

class WindowDisk : public WindowSafety {
  protected:
    void replace(const std::string& what, const std::string& by) {
        replace_in_scene(what, by);
        same_widgets().status.changed_on_disk = true;
        same_widgets().frame(3);
    }
    /// In the colour of errors: the badge where it cannot render.
    bool picture_failed() const {
        const Rect port = layout().viewport;
        return count_of(screen->pixels({0, int(port.y + port.height) - 50, 100, 50}), color::error) > 10;
    }
    int complaints() const { return count_of(pixels_of(&Layout::status), color::error); }
};

TEST_F(WindowDisk, ASceneEditedByHandIsReadAgain) {
    const Pixels before = start_settled();
    replace("count = 60000", "count = 60000\n[layer.look]\nalpha = { power = 2.5 }");
    click_when_shown("notice/Reload");
    settled_frame(before);
    EXPECT_EQ(title(), "scene.toml - astrosplat");

    replace("power = 2.5", "powr = 2.5");
    click_when_shown("notice/Reload");
    EXPECT_TRUE(comes_true([&] { return complaints() > 0; })) << "the wrong key is not complained of";
    EXPECT_TRUE(running());

    replace("powr = 2.5", "power = 1.0");
    click_when_shown("notice/Reload");
    expect_settled(before);
}

TEST_F(WindowDisk, AnEnvironmentThatCannotBeReadEndsNothing) {
    write_text(folder / "sky.png", "no picture");
    const Pixels before = start_settled();
    replace("[[layer]]", "[environment]\nimage = \"sky.png\"\n[[layer]]");
    click_when_shown("notice/Reload");
    EXPECT_TRUE(comes_true([&] { return picture_failed() || !running(); }));
    ASSERT_TRUE(running()) << program->err_so_far();
    person->press("ctrl+z");
    expect_settled(before);
}

// Snapshots lie beside the scene as soon as they are taken, and are there again after a crash.

class WindowSnapshots : public WindowTest {
  protected:
    std::vector<StoredLook> kept() const {
        std::vector<std::string> problems;
        std::vector<StoredLook> found = read_snapshots(snapshot_folder(scene_file), problems);
        EXPECT_EQ(problems, std::vector<std::string>());
        return found;
    }
    /// The strip below the picture, with one card.
    void open_strip() {
        choose("View/Snapshots");
        same_widgets().status.snapshots = {{"Look 1", nullptr, 1.0f, 1000, 0.0}};
        same_widgets().frame(3);
    }
    bool says_an_error() const {
        const Rect bar = layout().status;
        return count_of(screen->pixels({0, int(bar.y), 600, int(bar.height)}), color::error) > 0;
    }
};

TEST_F(WindowSnapshots, SurviveACrashAndAreComparedAfterIt) {
    const Pixels first = start_settled();
    person->drag(value_box(power), {60.0f, 0.0f});
    const Pixels changed = settled_frame(first);
    person->press("b");
    EXPECT_TRUE(comes_true([&] { return fs::exists(snapshot_folder(scene_file) / "0001.png"); }));
    end(SIGKILL);
    ASSERT_EQ(kept().size(), 1u);
    EXPECT_EQ(kept()[0].name, "Look 1");
    EXPECT_GT(kept()[0].scene->layers[0].look.alpha.power, saved().layers[0].look.alpha.power);

    fs::remove_all(folder / "home/state");  // its autosave, which would be offered
    start_settled();
    open_strip();
    person->click(same_widgets().at("snapshot 0"));
    const Rect viewport = layout().viewport;
    const auto upper_half = [&] {  // without badge and strip
        return screen->pixels(
            {int(viewport.x), int(viewport.y), int(viewport.width), int(viewport.height / 2)});
    };
    ViewState with_strip;
    with_strip.snapshots_open = true;
    EXPECT_TRUE(comes_true([&] { return settled(with_strip); })) << "the strip made the view smaller";
    const Pixels saved_look = upper_half();
    person->press("a");
    EXPECT_TRUE(comes_true([&] { return upper_half() != saved_look; })) << "B is the changed look";
    person->press("a");
    EXPECT_TRUE(comes_true([&] { return upper_half() == saved_look; }));
    expect_title("scene.toml");
}

TEST_F(WindowSnapshots, AreRestoredAsOneStepAndDeleted) {
    Scene scene = saved();
    scene.layers[0].look.alpha.power = 7.0f;
    write_snapshot(snapshot_folder(scene_file), {"Look 1"}, scene, "");
    start_settled();
    open_strip();
    const auto choose_of_card = [&](const std::string& entry) {
        TestWindow& widgets = same_widgets();
        const glm::vec2 card = widgets.at("snapshot 0");
        widgets.click(card, 1);
        widgets.frame(3);
        person->click(card, 3);
        person->click(widgets.at("snapshot/" + entry));
        widgets.click(widgets.at("snapshot/" + entry));
    };
    choose_of_card("Restore");
    expect_title("scene.toml - edited");
    save();
    EXPECT_EQ(saved().layers[0].look.alpha.power, 7.0f);
    person->press("ctrl+z");
    person->press("ctrl+s");
    EXPECT_TRUE(comes_true([&] { return saved().layers[0].look.alpha.power != 7.0f; }));
    choose_of_card("Delete");
    EXPECT_TRUE(comes_true([&] { return kept().empty(); }));
}

TEST_F(WindowSnapshots, WhereTheyCannotBeKeptOneLineSaysSo) {
    write_text(snapshot_folder(scene_file), "a file in the folder's place");
    const Pixels first = start_settled();
    person->press("b");
    EXPECT_TRUE(comes_true([&] { return says_an_error(); }));
    person->drag(value_box(power), {60.0f, 0.0f});
    settled_frame(first);
    person->press("a");
    expect_settled(first);
}

/// Bytes of a process that are not only lent to it (core/buffer.h).
std::int64_t memory_of(pid_t process) {
    std::ifstream rollup("/proc/" + std::to_string(process) + "/smaps_rollup");
    std::int64_t kib = 0;
    for (std::string word; rollup >> word;) {
        std::int64_t value = 0;
        if (word == "Rss:" && rollup >> value) kib += value;
        if (word == "LazyFree:" && rollup >> value) kib -= value;
    }
    return 1024 * kib;
}

class WindowWalk : public WindowTest {
  protected:
    /// Ends after so many rounds, or, once two are done, after so many seconds.
    void walk(int rounds, int gestures, std::chrono::seconds at_most) {
        const auto end_of_walk = std::chrono::steady_clock::now() + at_most;
        const auto has_time = [&](int round) {
            return round < 2 || std::chrono::steady_clock::now() < end_of_walk;
        };
        const std::string begun = text_of(scene_file);
        start_settled();
        std::int64_t first = 0, last = 0;
        int round = 0;
        for (; round < rounds && has_time(round) && running(); ++round) {
            for (int i = 0; i < gestures && running(); ++i) gesture();
            ASSERT_TRUE(running()) << program->err_so_far();
            come_to_rest();
            person->press("ctrl+s");
            person->press_often("ctrl+z", 2 * gestures);  // no gesture is more than two steps
            come_to_rest();
            person->press("ctrl+s");
            EXPECT_TRUE(comes_back(begun)) << text_of(scene_file);
            expect_title("scene.toml");
            last = memory_at_rest();
            if (round == 0) first = last;
            std::printf("round %d: %.0f MB\n", round, 1e-6 * double(last));
            std::fflush(stdout);
        }
        EXPECT_GT(first, 0);
        EXPECT_LT(last - first, 100'000'000);
        person->press("ctrl+q");
        EXPECT_EQ(end().code, 0);
    }

  private:
    /// Once it has stopped changing.
    std::int64_t memory_at_rest() const {
        constexpr std::int64_t step = 1'000'000;
        std::int64_t before = memory_of(program->id());
        for (int still = 0, i = 0; still < 4 && i < 60; ++i) {
            usleep(500'000);
            const std::int64_t now = memory_of(program->id());
            still = std::abs(now - before) < step ? still + 1 : 0;
            before = now;
        }
        return before;
    }

    std::uint32_t chance(std::uint32_t below) { return shared::as_hash(18u, step_++, 0u, 7u) % below; }
    float within(float low, float size) { return low + size * 0.001f * float(chance(1000)); }

    /// Somewhere below the menus, which lead out of the scene.
    glm::vec2 anywhere() { return {within(10.0f, width - 20.0f), within(70.0f, height - 110.0f)}; }
    glm::vec2 on(Rect Layout::*part) {
        const Rect area = layout().*part;
        return {within(area.x + 8.0f, area.width - 16.0f), within(area.y + 8.0f, area.height - 16.0f)};
    }

    /// Not over the screen's edge.
    void drag(glm::vec2 from, glm::vec2 by) {
        const glm::vec2 to = glm::clamp(from + by, glm::vec2(2.0f), glm::vec2(width - 2.0f, height - 2.0f));
        person->drag(from, to - from);
    }

    void gesture() {
        constexpr const char* keys[] = {
            "0", "1",    "3",     "7",  "9", "f",   "g",    "z",     "h",      "s",     "b",      "x",
            "k", "Left", "Right", "Up", "w", "e",   "Down", "space", "Escape", "space", "ctrl+z", "ctrl+y",
            "r", "F1",   "Home",  "i",  "o", "Tab", "a",    "F6",    "F10",    "alt+v", "ctrl+k"};
        switch (chance(8)) {
            case 0:
            case 1:
                return drag(on(&Layout::viewport), {within(-90.0f, 180.0f), within(-60.0f, 120.0f)});
            case 2:
            case 3:
                return drag(on(&Layout::panel), {within(-60.0f, 120.0f), 0.0f});
            case 4:
                return person->click(on(&Layout::panel));
            case 5:
                person->click(anywhere(), chance(4) == 0 ? 3 : 1);
                return person->press("Escape");
            default:
                return person->press(keys[chance(std::size(keys))]);
        }
    }
    /// Closes what is open, with the mouse where it does nothing.
    void come_to_rest() {
        person->press_often("Escape", 4);
        person->move({width - 2.0f, height - 2.0f});
    }
    /// Each key has a frame or two of its own, and a busy machine draws few a second.
    bool comes_back(const std::string& text) const {
        constexpr int patience = 5;  // times that of others
        for (int i = 0; i < patience; ++i)
            if (comes_true([&] { return text_of(scene_file) == text; })) return true;
        return false;
    }

    std::uint32_t step_ = 0;
};

TEST_F(WindowWalk, AHalfMinute) { walk(2, 14, std::chrono::minutes(1)); }
TEST_F(WindowWalk, TenMinutesNightly) { walk(20, 30, std::chrono::minutes(10)); }

}  // namespace
}  // namespace astrosplat::test

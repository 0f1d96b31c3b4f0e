// A long time at the window, by hands that do not know what they do: mouse and keys at random, always the
// same. Nothing ends it, nothing grows for ever, and undo to the start brings the file back byte for byte.
#include <glm/common.hpp>

#include "window/window_test.h"

namespace astrosplat::test {
namespace {

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
            undo_all();
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
        constexpr const char* keys[] = {"0", "1",  "3",    "7",     "9",      "f",     "g",      "z",
                                        "h", "s",  "b",    "x",     "k",      "Left",  "Right",  "Up",
                                        "w", "e",  "Down", "space", "Escape", "space", "ctrl+z", "ctrl+y",
                                        "r", "F1", "Home", "i",     "o",      "Tab"};
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
        for (int i = 0; i < 4; ++i) person->press("Escape");
        person->move({width - 2.0f, height - 2.0f});
    }
    /// Each key has a frame or two of its own, and a busy machine draws few a second.
    bool comes_back(const std::string& text) const {
        constexpr int patience = 5;  // times that of others
        for (int i = 0; i < patience; ++i)
            if (comes_true([&] { return text_of(scene_file) == text; })) return true;
        return false;
    }
    void undo_all() {
        person->press_often("ctrl+z", 150);
        come_to_rest();
    }

    std::uint32_t step_ = 0;
};

TEST_F(WindowWalk, AHalfMinute) { walk(2, 14, std::chrono::minutes(1)); }
TEST_F(WindowWalk, TenMinutesNightly) { walk(20, 30, std::chrono::minutes(10)); }

}  // namespace
}  // namespace astrosplat::test

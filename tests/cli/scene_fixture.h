// A small scene in a folder of its own, and short ways to run the program on it.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "support/errors.h"
#include "support/pixmap.h"
#include "support/run_program.h"

namespace astrosplat::test {

using Words = std::vector<std::string>;

inline Words joined(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// `count` soft splats in a cube of side 4, the same on every run.
inline std::string cube_of_splats(int count) {
    std::string text = fmt::format(
        "ATTRIBUTES\n position rgbPP opacityPP radiusPP\nTYPES\n V V R R\nNUMBER_OF_PARTICLES: {}\nBEGIN "
        "DATA\n",
        count);
    std::uint32_t state = 12345;
    const auto next = [&state] {
        state = state * 1664525u + 1013904223u;
        return double(state >> 8) / 16777216.0;
    };
    for (int i = 0; i < count; ++i) {
        const double x = next() * 4 - 2, y = next() * 4 - 2, z = next() * 4 - 2;
        const double r = next(), g = next(), b = next(), alpha = next() * 0.8 + 0.1,
                     radius = next() * 0.3 + 0.05;
        text += fmt::format("{:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}\n", x, y, z, r, g, b,
                            alpha, radius);
    }
    return text;
}

/// A picture of 32x16 pixels in colours, as a portable pixmap.
inline std::string small_picture() {
    return pixmap(32, 16, [](int x, int y, int k) { return k == 2 ? 128 : k == 0 ? x * 8 : y * 16; });
}

class SceneTest : public FolderTest {
  protected:
    SceneTest() {
        write_text(folder / "stars.pda", cube_of_splats(300));
        write_text(folder / "dust.pda", cube_of_splats(100));
        write_scene();
    }

    void write_scene(const std::string& more = "") {
        write_text(folder / "scene.toml", R"(astrosplat = 1
[output]
resolution = [64, 48]
frames = "1-3"
path = "frames/shot.####.exr"
[camera]
position = [0.0, 0.0, 9.0]
[[layer]]
name = "stars"
[layer.source]
kind = "splats"
file = "stars.pda"
[[layer]]
name = "dust"
[layer.source]
kind = "splats"
file = "dust.pda"
[layer.render]
blend = "add"
[animation]
"camera.position" = { keys = [[1, [0.0, 0.0, 9.0]], [3, [2.0, 1.0, 8.0]]] }
)" + more);
    }

    RunResult run(std::vector<std::string> arguments, RunOptions options = {}) const {
        arguments.insert(arguments.begin(), ASTROSPLAT_PROGRAM);
        if (options.folder == ".") options.folder = folder;
        // No test fills the user's cache. Last, as of two values the first counts: a test's own choice.
        options.environment.push_back("ASTROSPLAT_CACHE=" + own_cache());
        return run_program(arguments, options);
    }
    std::string own_cache() const { return (folder / "sets").string(); }
    /// --batch scene.toml and more.
    RunResult batch(const Words& more = {}, const RunOptions& options = {}) const {
        return run(joined({"--batch", "scene.toml"}, more), options);
    }
    /// A run in the folder that goes on alongside the test.
    RunningProgram started(const Words& arguments) const {
        return RunningProgram(joined({ASTROSPLAT_PROGRAM}, arguments), {.folder = folder});
    }
    nlohmann::json json(const std::string& file) const {
        return nlohmann::json::parse(text_of(folder / file));
    }
    /// sha256 of the float pixels of every frame of a run that must succeed.
    std::vector<std::string> hashes(const Words& more, const RunOptions& options = {}) const {
        const Words words = joined(more, {"--overwrite", "--stats", "stats.json"});
        std::vector<std::string> list;
        if (expect_success(batch(words, options)).code != 0) return list;
        const nlohmann::json stats = json("stats.json");
        for (const auto& frame : stats.at("frames")) list.push_back(frame.at("sha256"));
        EXPECT_FALSE(list.empty());
        return list;
    }
};

inline std::int64_t line_count(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

inline std::string last_line(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text.substr(text.rfind('\n') + 1);
}

/// One line on stderr that contains `part`, nothing on stdout.
inline void expect_one_line(const RunResult& result, int code, const std::string& part) {
    EXPECT_EQ(result.code, code) << result.err;
    EXPECT_EQ(line_count(result.err), 1) << result.err;
    EXPECT_HAS(result.err, part);
    EXPECT_EQ(result.out, "");
}

}  // namespace astrosplat::test

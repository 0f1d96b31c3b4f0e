// manual and completion: everything that the help and the description know is in them, and the programs that
// read them find no fault. Where such a program is not there its part is skipped.
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

class Manual : public SceneTest {
  protected:
    std::string printed(const std::vector<std::string>& words) const {
        const RunResult result = run(words);
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        return result.out;
    }
    static bool has(const std::string& program) {
        return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
    }
    /// Names such as "--frames" at the beginning of the help's lines.
    static std::set<std::string> options_of(const std::string& help) {
        std::set<std::string> names;
        std::istringstream lines(help);
        const std::regex begins("^ +(-[a-z], ?)?(--[a-z-]+)");
        for (std::string line; std::getline(lines, line);) {
            std::smatch found;
            if (std::regex_search(line, found, begins)) names.insert(found[2]);
        }
        return names;
    }
    static std::string without_escapes(std::string text) {
        for (std::size_t at; (at = text.find("\\-")) != std::string::npos;) text.erase(at, 1);
        return text;
    }
    /// The words that bash offers after these.
    std::vector<std::string> completed(const std::vector<std::string>& words) const {
        write_text(folder / "completion.bash", printed({"completion", "bash"}));
        std::string script = fmt::format("source completion.bash; COMP_WORDS=('{}'", ASTROSPLAT_PROGRAM);
        for (const std::string& word : words) script += " '" + word + "'";
        script +=
            fmt::format("); COMP_CWORD={}; _astrosplat; printf '%s\\n' \"${{COMPREPLY[@]}}\"", words.size());
        const RunResult result = run_program({"/usr/bin/env", "bash", "-c", script}, in_folder());
        EXPECT_EQ(result.err, "");
        std::vector<std::string> offers;
        std::istringstream lines(result.out);
        for (std::string line; std::getline(lines, line);)
            if (!line.empty()) offers.push_back(line);
        return offers;
    }
    RunOptions in_folder() const {
        RunOptions options;
        options.folder = folder;
        return options;
    }
};

TEST_F(Manual, HasEveryOptionAndCommand) {
    const std::string page = without_escapes(printed({"manual", "1"}));
    const std::string help = printed({"--help"});
    const std::set<std::string> options = options_of(help);
    EXPECT_GT(options.size(), 25u);
    for (const std::string& option : options)
        EXPECT_NE(page.find("\\fB" + option + "\\fR"), std::string::npos) << option;
    for (const char* command : {"new", "prepare", "status", "verify", "camera", "export", "completion"}) {
        EXPECT_NE(page.find(fmt::format(".SS \\fBastrosplat\\fR \\fB{}\\fR", command)), std::string::npos)
            << command;
        for (const std::string& option : options_of(printed({command, "--help"})))
            EXPECT_NE(page.find("\\fB" + option + "\\fR"), std::string::npos) << command << " " << option;
    }
}

TEST_F(Manual, HasEveryKey) {
    const std::string page = without_escapes(printed({"manual", "5"}));
    const auto keys = nlohmann::json::parse(printed({"parameters", "--json"}));
    EXPECT_GT(keys.size(), 150u);
    for (const auto& key : keys)
        EXPECT_NE(page.find("\\fB" + key.at("key").get<std::string>() + "\\fR"), std::string::npos) << key;
}

TEST_F(Manual, GroffFindsNoFault) {
    if (!has("groff")) GTEST_SKIP() << "groff is not installed";
    for (const char* section : {"1", "5"}) {
        write_text(folder / "page", printed({"manual", section}));
        const RunResult result =
            run_program({"/usr/bin/env", "groff", "-ww", "-man", "-Tutf8", "-z", "page"}, in_folder());
        EXPECT_EQ(result.code, 0);
        EXPECT_EQ(result.err, "") << section;
    }
}

TEST_F(Manual, OtherSectionsAndShellsAreRefused) {
    EXPECT_EQ(run({"manual", "3"}).code, 2);
    EXPECT_EQ(run({"completion", "tcsh"}).code, 2);
}

TEST_F(Manual, BashCompletes) {
    if (!has("bash")) GTEST_SKIP() << "bash is not installed";
    using Offers = std::vector<std::string>;
    write_text(folder / "zwei worte.toml", "");
    EXPECT_EQ(completed({"ver"}), Offers{"verify"});
    EXPECT_EQ(completed({"new", "--as", ""}), (Offers{"galaxy", "nebula", "remnant", "field", "plane"}));
    EXPECT_EQ(completed({"--progress", "p"}), Offers{"plain"});
    EXPECT_EQ(completed({"--batch", "zwei"}), Offers{"zwei worte.toml"});
    EXPECT_EQ(completed({"--set", "output.fp"}), Offers{"output.fps="});
    EXPECT_EQ(completed({"--threads", ""}), Offers{});
    EXPECT_EQ(completed({"export", "x.toml", "--sp"}), Offers{"--space"});
    EXPECT_EQ(completed({"completion", "f"}), Offers{"fish"});
}

/// A scene that is named anywhere on the line tells how its layers are called.
TEST_F(Manual, BashCompletesKeysOfLayers) {
    if (!has("bash")) GTEST_SKIP() << "bash is not installed";
    using Offers = std::vector<std::string>;
    write_text(folder / "zwei worte.toml", "astrosplat = 1\n[[layer]]\nname = \"gas\"\n");
    EXPECT_EQ(completed({"--batch", "zwei worte.toml", "--set", "layer.gas.look.alpha.po"}),
              Offers{"layer.gas.look.alpha.power="});
    EXPECT_EQ(completed({"--batch", "zwei worte.toml", "--set", "output.fp"}), Offers{"output.fps="});
    EXPECT_EQ(completed({"--batch", "missing.toml", "--set", "layer."}), Offers{});
}

TEST_F(Manual, FishCompletesBehindAScene) {
    if (!has("fish")) GTEST_SKIP() << "fish is not installed";
    write_text(folder / "a.toml", "astrosplat = 1\n[[layer]]\nname = \"gas\"\n");
    write_text(folder / "completion.fish", printed({"completion", "fish"}));
    RunOptions options = in_folder();
    options.environment.push_back("PATH=" + std::filesystem::path(ASTROSPLAT_PROGRAM).parent_path().string() +
                                  ":/usr/bin:/bin");
    const RunResult result = run_program(
        {"/usr/bin/env", "fish", "-c",
         "source completion.fish; complete -C 'astrosplat --batch a.toml --set layer.gas.look.alpha.po'"},
        options);
    EXPECT_TRUE(result.out.starts_with("layer.gas.look.alpha.power=")) << result.out << result.err;
}

TEST_F(Manual, ParametersOfASceneAreThoseThatSetTakes) {
    write_text(folder / "a.toml",
               "astrosplat = 1\n[[layer]]\nname = \"gas\"\n"
               "look = { alpha = { power = 3 } }\n");
    const std::string scene = (folder / "a.toml").string();
    EXPECT_NE(printed({"parameters", scene}).find("layer.gas.look.alpha.power"), std::string::npos);
    const auto keys = nlohmann::json::parse(printed({"parameters", scene, "--json"}));
    const auto power = std::ranges::find(keys, "layer.gas.look.alpha.power", [](const auto& row) {
        return row.at("key").template get<std::string>();
    });
    ASSERT_NE(power, keys.end());
    EXPECT_EQ(power->at("value"), 3);
    std::istringstream names(printed({"parameters", scene, "--names"}));
    std::size_t count = 0;
    for (std::string name; std::getline(names, name); ++count)
        EXPECT_EQ(name, keys.at(count).at("key").get<std::string>());
    EXPECT_EQ(count, keys.size());
}

TEST_F(Manual, OtherShellsReadTheirScripts) {
    int read = 0;
    for (const char* shell : {"zsh", "fish", "bash"}) {
        if (!has(shell)) continue;
        write_text(folder / "script", printed({"completion", shell}));
        const RunResult result = run_program({"/usr/bin/env", shell, "-n", "script"}, in_folder());
        EXPECT_EQ(result.code, 0) << shell;
        EXPECT_EQ(result.err, "") << shell;
        ++read;
    }
    if (read == 0) GTEST_SKIP() << "none of bash, zsh and fish is installed";
}

}  // namespace
}  // namespace astrosplat::test

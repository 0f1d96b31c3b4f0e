// README, manual, help and completion promise what the program does.

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

// README and the chapters of the manual promise nothing that the program does not do: commands, options,
// keys, files and links that they name exist, and README's first picture is made as written there.

const fs::path root = ASTROSPLAT_SOURCE_DIR;

std::vector<fs::path> documents() {
    std::vector<fs::path> files{root / "README.md"};
    for (const auto& entry : fs::directory_iterator(root / "app/manual")) files.push_back(entry.path());
    return files;
}

Words matches(const std::string& text, const char* pattern) {
    const std::regex regex(pattern);
    Words found;
    for (std::sregex_iterator it(text.begin(), text.end(), regex), none; it != none; ++it)
        found.push_back((*it)[1]);
    return found;
}

Words words_of(const std::string& line) {
    std::istringstream words(line);
    return {std::istream_iterator<std::string>(words), {}};
}

/// What is typed in indented blocks of code, from "astrosplat" on; without comments, continued lines joined.
Words commands_in(const std::string& text) {
    const std::string joined = std::regex_replace(text, std::regex(R"(\\\n)"), " ");
    return matches(joined, R"(\n    (?:\$ )?(?:build/release/)?(astrosplat [^#\n]*))");
}

/// Names such as "--frames" at the beginning of a help's lines.
std::set<std::string> options_in(const std::string& help) {
    const Words names = matches(help, R"(\n +(?:-[a-z], ?)?(--[a-z-]+))");
    return {names.begin(), names.end()};
}

class Documents : public SceneTest {
  protected:
    /// Long options of the program or of a command of it.
    const std::set<std::string>& options_of(const std::string& command) {
        if (const auto known = options_.find(command); known != options_.end()) return known->second;
        const RunResult help = command.empty() ? run({"--help"}) : run({command, "--help"});
        return options_[command] = options_in(help.out);
    }

  private:
    std::map<std::string, std::set<std::string>> options_;
};

TEST_F(Documents, CommandsTakeTheOptionsShown) {
    const std::set<std::string> known = {"new",     "prepare", "generate",   "convert",
                                         "export",  "camera",  "status",     "info",
                                         "compare", "verify",  "parameters", "fidelity"};
    std::size_t checked = 0;
    for (const fs::path& file : documents())
        for (const std::string& line : commands_in(text_of(file))) {
            const Words words = words_of(line);
            const std::string command = words.size() > 1 && known.contains(words[1]) ? words[1] : "";
            for (const std::string& word : words) {
                if (!word.starts_with("--")) continue;
                EXPECT_TRUE(options_of(command).contains(word)) << file << ": " << line << ": " << word;
                ++checked;
            }
        }
    EXPECT_GT(checked, 20u);
}

TEST_F(Documents, OptionsNamedInTextExist) {
    const std::string page = run({"manual", "1"}).out;
    const std::string plain = std::regex_replace(page, std::regex(R"(\\-)"), "-");
    std::size_t checked = 0;
    for (const fs::path& file : documents())
        for (const std::string& option : matches(text_of(file), R"(`(--[a-z-]+)[^`]*`)")) {
            EXPECT_NE(plain.find("\\fB" + option + "\\fR"), std::string::npos) << file << ": " << option;
            ++checked;
        }
    EXPECT_GT(checked, 20u);
}

TEST_F(Documents, KeysOfScenesExist) {
    std::size_t checked = 0;
    for (const fs::path& file : documents())
        for (std::string text : matches(text_of(file), "\n```toml\n([^`]*)```")) {
            if (text.find("[[layer]]") == std::string::npos && text.find("[layer.") != std::string::npos)
                text = "[[layer]]\nname = \"gas\"\n" + text;
            if (!text.starts_with("astrosplat = 1")) text = "astrosplat = 1\n" + text;
            write_text(folder / "shown.toml", text);
            const RunResult result = run({"parameters", (folder / "shown.toml").string()});
            EXPECT_EQ(result.code, 0) << file << ":\n" << text << result.err;
            ++checked;
        }
    EXPECT_GT(checked, 5u);
}

/// The name under which GitHub finds a heading.
std::string anchor_of(std::string heading) {
    heading = std::regex_replace(heading, std::regex("[^A-Za-z0-9 -]"), "");
    for (char& c : heading) c = c == ' ' ? '-' : static_cast<char>(std::tolower(c));
    return heading;
}

TEST_F(Documents, LinksLeadSomewhere) {
    std::size_t checked = 0;
    for (const fs::path& file : documents())
        for (const std::string& link : matches(text_of(file), R"(\]\(([^)]+)\))")) {
            if (link.starts_with("http")) continue;
            const std::size_t sharp = link.find('#');
            const fs::path target = file.parent_path() / link.substr(0, sharp);
            EXPECT_TRUE(fs::exists(target)) << file << ": " << link;
            ++checked;
            if (sharp == std::string::npos) continue;
            Words headings = matches(text_of(target), "\n## ([^\n]+)");
            std::ranges::transform(headings, headings.begin(), anchor_of);
            EXPECT_NE(std::ranges::find(headings, link.substr(sharp + 1)), headings.end())
                << file << ": " << link;
        }
    EXPECT_GT(checked, 10u);
}

TEST_F(Documents, FilesNamedExist) {
    std::size_t checked = 0;
    for (const fs::path& file : documents())
        for (const std::string& named :
             matches(text_of(file),
                     R"([` ]((?:engine|app|shaders|tests|assets|third_party)/[A-Za-z0-9_./-]*\.[a-z]+)\b)")) {
            EXPECT_TRUE(fs::exists(root / named)) << file << ": " << named;
            ++checked;
        }
    EXPECT_GT(checked, 15u);
}

TEST_F(Documents, ReadmesMapNamesEveryFolder) {
    const std::string readme = text_of(root / "README.md");
    const std::string map = readme.substr(readme.find("## Where things are"));
    for (const char* parent : {"engine", "app"})
        for (const auto& entry : fs::directory_iterator(root / parent))
            if (entry.is_directory()) {
                const std::string name = entry.path().filename().string() + "/";
                EXPECT_NE(map.find(" " + name), std::string::npos) << parent << "/" << name;
            }
}

/// README's first picture, in a folder that looks like a clone after the first build.
class FirstPicture : public Documents {
  protected:
    FirstPicture() {
        fs::create_directories(folder / "build/release");
        fs::create_symlink(ASTROSPLAT_PROGRAM, folder / "build/release/astrosplat");
        fs::create_symlink(root / "assets", folder / "assets");
        const std::string readme = text_of(root / "README.md");
        const std::size_t begin = readme.find("## Your first picture");
        lines = matches(readme.substr(begin, readme.find("\n## ", begin) - begin),
                        "\n    (build/release/astrosplat [^\n]*)");
    }
    RunResult run_line(const std::string& line) const {
        return run_program({"/usr/bin/env", "sh", "-c", line}, {.folder = folder});
    }
    Words lines;
};

TEST_F(FirstPicture, GetsAScene) {
    ASSERT_EQ(lines.size(), 3u);
    expect_success(run_line(lines[0]));
    const std::string scene = words_of(lines[0]).back();
    EXPECT_TRUE(fs::exists(folder / scene));
    EXPECT_EQ(words_of(lines[1]).back(), scene);
    EXPECT_HAS(lines[2], " " + scene + " ");
}

TEST_F(FirstPicture, IsRenderedNightly) {
    ASSERT_EQ(lines.size(), 3u);
    expect_success(run_line(lines[0]));
    expect_success(run_line(lines[2]));
    for (const char* frame : {"0001", "0041", "0081", "0121", "0161", "0201"})
        EXPECT_TRUE(fs::exists(folder / fmt::format("renders/first.{}.png", frame))) << frame;
}

// manual and completion: everything that the help and the description know is in them, and the programs that
// read them find no fault. Where such a program is not there its part is skipped.

class Manual : public SceneTest {
  protected:
    std::string printed(const Words& words) const {
        const RunResult result = expect_success(run(words));
        EXPECT_EQ(result.err, "");
        return result.out;
    }
    static bool has(const std::string& program) {
        return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
    }
    static std::string without_escapes(std::string text) {
        for (std::size_t at; (at = text.find("\\-")) != std::string::npos;) text.erase(at, 1);
        return text;
    }
    /// The words that bash offers after these.
    Words completed(const Words& words) const {
        write_text(folder / "completion.bash", printed({"completion", "bash"}));
        std::string script = fmt::format("source completion.bash; COMP_WORDS=('{}'", ASTROSPLAT_PROGRAM);
        for (const std::string& word : words) script += " '" + word + "'";
        script +=
            fmt::format("); COMP_CWORD={}; _astrosplat; printf '%s\\n' \"${{COMPREPLY[@]}}\"", words.size());
        const RunResult result = run_program({"/usr/bin/env", "bash", "-c", script}, in_folder());
        EXPECT_EQ(result.err, "");
        return matches(result.out, "([^\n]+)");
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
    const std::set<std::string> options = options_in(help);
    EXPECT_GT(options.size(), 25u);
    for (const std::string& option : options) EXPECT_HAS(page, "\\fB" + option + "\\fR");
    for (const char* command : {"new", "prepare", "status", "verify", "camera", "export", "completion"}) {
        EXPECT_HAS(page, fmt::format(".SS \\fBastrosplat\\fR \\fB{}\\fR", command));
        for (const std::string& option : options_in(printed({command, "--help"})))
            EXPECT_NE(page.find("\\fB" + option + "\\fR"), std::string::npos) << command << " " << option;
    }
}

TEST_F(Manual, HasEveryKey) {
    const std::string page = without_escapes(printed({"manual", "5"}));
    const auto keys = nlohmann::json::parse(printed({"parameters", "--json"}));
    EXPECT_GT(keys.size(), 150u);
    for (const auto& key : keys) EXPECT_HAS(page, "\\fB" + key.at("key").get<std::string>() + "\\fR");
}

TEST_F(Manual, GroffFindsNoFault) {
    if (!has("groff")) GTEST_SKIP() << "groff is not installed";
    for (const char* section : {"1", "5"}) {
        write_text(folder / "page", printed({"manual", section}));
        const RunResult result = expect_success(
            run_program({"/usr/bin/env", "groff", "-ww", "-man", "-Tutf8", "-z", "page"}, in_folder()));
        EXPECT_EQ(result.err, "") << section;
    }
}

TEST_F(Manual, OtherSectionsAndShellsAreRefused) {
    EXPECT_EQ(run({"manual", "3"}).code, 2);
    EXPECT_EQ(run({"completion", "tcsh"}).code, 2);
}

TEST_F(Manual, BashCompletes) {
    if (!has("bash")) GTEST_SKIP() << "bash is not installed";
    write_text(folder / "zwei worte.toml", "");
    EXPECT_EQ(completed({"ver"}), Words{"verify"});
    EXPECT_EQ(completed({"new", "--as", ""}), (Words{"galaxy", "elliptical", "nebula", "planetary", "remnant",
                                                     "field", "cluster", "thin", "plane"}));
    EXPECT_EQ(completed({"--progress", "p"}), Words{"plain"});
    EXPECT_EQ(completed({"--batch", "zwei"}), Words{"zwei worte.toml"});
    EXPECT_EQ(completed({"--set", "output.fp"}), Words{"output.fps="});
    EXPECT_EQ(completed({"--threads", ""}), Words{});
    EXPECT_EQ(completed({"export", "x.toml", "--sp"}), Words{"--space"});
    EXPECT_EQ(completed({"completion", "f"}), Words{"fish"});
}

/// A scene that is named anywhere on the line tells how its layers are called.
TEST_F(Manual, BashCompletesKeysOfLayers) {
    if (!has("bash")) GTEST_SKIP() << "bash is not installed";
    write_text(folder / "zwei worte.toml", "astrosplat = 1\n[[layer]]\nname = \"gas\"\n");
    EXPECT_EQ(completed({"--batch", "zwei worte.toml", "--set", "layer.gas.look.alpha.po"}),
              Words{"layer.gas.look.alpha.power="});
    EXPECT_EQ(completed({"--batch", "zwei worte.toml", "--set", "output.fp"}), Words{"output.fps="});
    EXPECT_EQ(completed({"--batch", "missing.toml", "--set", "layer."}), Words{});
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
    EXPECT_HAS(printed({"parameters", scene}), "layer.gas.look.alpha.power");
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
        const RunResult result =
            expect_success(run_program({"/usr/bin/env", shell, "-n", "script"}, in_folder()));
        EXPECT_EQ(result.err, "") << shell;
        ++read;
    }
    if (read == 0) GTEST_SKIP() << "none of bash, zsh and fish is installed";
}

}  // namespace
}  // namespace astrosplat::test

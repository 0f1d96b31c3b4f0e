// How the program is called, and what its documents promise.
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "cli/scene_fixture.h"
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

/// Commands in indented blocks of code, from "astrosplat" on; without comments, continued lines joined.
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
    for (char& c : heading) c = c == ' ' ? '-' : char(std::tolower(c));
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
    options.environment.push_back("PATH=" + fs::path(ASTROSPLAT_PROGRAM).parent_path().string() +
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

// Help, version, and every way to call the program wrongly: one line, exit code 2, nothing written.

class Usage : public SceneTest {};

TEST_F(Usage, HelpAndVersionAreEverywhere) {
    for (const char* command : {"", "new", "generate", "convert", "info", "compare", "parameters"}) {
        Words start;
        if (*command) start.push_back(command);
        for (const char* option : {"-h", "--help", "--version"}) {
            Words arguments = start;
            arguments.push_back(option);
            const RunResult result = run(arguments);
            EXPECT_EQ(result.code, 0) << command << " " << option << result.err;
            EXPECT_EQ(result.err, "");
            EXPECT_HAS(result.out, option[2] == 'v' ? "astrosplat 0." : "--help");
        }
    }
}

TEST_F(Usage, TheVersionSaysWhatItWasBuiltOf) {
    const std::string text = run({"--version"}).out;
    EXPECT_TRUE(std::regex_match(
        text,
        std::regex(
            "astrosplat [0-9.]+\\ncommit ([0-9a-f]{12}(-dirty)?|unknown)\\nbuilt with (GCC|Clang) [^\\n]+, "
            "[A-Za-z]+\\nlibraries OpenEXR 3[^\\n]+, OpenImageIO 2[^\\n]+\\ninstructions [a-z0-9]+\\n")))
        << text;
    // Where a library was not found, its number would be missing.
    EXPECT_FALSE(std::regex_search(text, std::regex("[A-Za-z] ?(,|\\n[^\\n]*instructions)"))) << text;
    const std::string head =
        run_program({"/bin/sh", "-c", "git -C '" ASTROSPLAT_SOURCE_DIR "' rev-parse --short=12 HEAD"}).out;
    if (head.size() == 13) {
        EXPECT_NE(text.find("commit " + head.substr(0, 12)), std::string::npos) << text << head;
    }
}

TEST_F(Usage, HelpNamesEveryOptionOfTheDesign) {
    const std::string help = run({"--help"}).out;
    for (const char* option :
         {"--batch",      "-f,--frames", "-o,--output", "--resolution", "--set",       "--layers",
          "-t,--threads", "--memory",    "--region",    "--resume",     "--overwrite", "--dry-run",
          "--stats",      "--cache",     "--no-cache",  "--progress",   "-v,",         "-q,",
          "new",          "generate",    "convert",     "info",         "compare",     "parameters"}) {
        EXPECT_HAS(help, option);
    }
}

TEST_F(Usage, WithoutADisplayTheWaysOutAreNamed) {
    for (const Words& words : {Words{}, {"scene.toml"}}) {
        const RunResult result = run(words);
        expect_one_line(result, 2, "no window: ");
        for (const char* way : {"--batch", "--screenshot"}) EXPECT_HAS(result.err, way);
    }
}

TEST_F(Usage, TestsNeverOpenAWindow) {
    setenv("DISPLAY", ":4711", 1);
    const RunResult result = run_program({"/bin/sh", "-c", "echo $DISPLAY$WAYLAND_DISPLAY"});
    unsetenv("DISPLAY");
    EXPECT_EQ(result.out, "\n");
}

TEST_F(Usage, MistakesAreOneLineAndCode2) {
    expect_one_line(batch({"--frobnicate"}), 2, "--frobnicate");
    expect_one_line(batch({"other.toml"}), 2, "other.toml");
    expect_one_line(run({"--batch"}), 2, "scene");
    expect_one_line(run({"--batch", "missing.toml"}), 2, "missing.toml");
    expect_one_line(run({"info"}), 2, "FILE");
    expect_one_line(run({"info", "missing.png"}), 2, "missing.png");
    expect_one_line(run({"convert", "stars.pda"}), 2, "OUT");
    expect_one_line(run({"generate", "scene.toml", "--layer", "stars"}), 2, "--output");
    expect_one_line(run({"--batch", "info", "stars.pda"}), 2, "--batch");
    EXPECT_FALSE(fs::exists(folder / "frames"));
}

TEST_F(Usage, BadOptionValuesNameTheOptionAndTheValue) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"--threads", "0"},       {"--threads", "two"},     {"--memory", "-1"},
        {"--memory", "4GB"},      {"--region", "1,2,3"},    {"--region", "0,0,65,48"},
        {"--region", "-1,0,4,4"}, {"--region", "0,0,0,4"},  {"--resolution", "1920"},
        {"--resolution", "0x5"},  {"--resolution", "-50%"}, {"--resolution", "axb"},
        {"--frames", "1-"},       {"--frames", "5-1"},      {"--frames", ""},
        {"--layers", "nothing"},  {"--set", "output.fps"},  {"--progress", "loud"},
    };
    for (const auto& [option, value] : cases) {
        const RunResult result = batch({option + "=" + value});
        expect_one_line(result, 2, value);
        EXPECT_HAS(result.err, option);
    }
    EXPECT_FALSE(fs::exists(folder / "frames"));
}

TEST_F(Usage, DraftsOfDomesAreSmallerButSquare) {
    expect_one_line(batch({"--set", "output.preset=dome", "--resolution", "64x48"}), 2,
                    "--resolution: expected a square for the preset dome, found '64x48'");
    expect_success(batch({"--set", "output.preset=dome", "--resolution", "64x64", "-f", "1"}));
}

TEST_F(Usage, BadScenesNameFileAndLine) {
    write_scene("[outptu]\n");
    const RunResult result = batch();
    EXPECT_EQ(result.code, 2);
    EXPECT_TRUE(std::regex_search(result.err, std::regex("scene\\.toml:[0-9]+: .*outptu"))) << result.err;
    EXPECT_EQ(line_count(result.err), 1) << result.err;
    write_scene();
    expect_one_line(batch({"--set", "layer.stars.look.alpha.powr=2"}), 2, "alpha.power");
}

TEST_F(Usage, MissingInputsAreNamed) {
    fs::remove(folder / "dust.pda");
    const RunResult result = batch();
    expect_one_line(result, 2, "dust.pda");
    EXPECT_FALSE(fs::exists(folder / "frames"));
}

TEST_F(Usage, SeveralFramesNeedAFrameToken) {
    expect_one_line(batch({"-o", "one.exr"}), 2, "one.exr");
    expect_success(batch({"-o", "one.exr", "-f", "2"}));
    EXPECT_TRUE(fs::exists(folder / "one.exr"));
}

// Short names of looks and scenes: beside the scene, then the person's own, then those that come
// with the program.

class Names : public SceneTest {
  protected:
    static std::string look(const std::string& opacity) {
        return "astrosplat = 1\n[render]\nopacity = " + opacity + "\n";
    }
    void write_scene_with(const std::string& preset) {
        write_text(folder / "named.toml",
                   "astrosplat = 1\n[output]\nresolution = [32, 24]\npath = \"n.exr\"\nframes = "
                   "\"1\"\n[camera]\nposition = [0, 0, 9]\n[[layer]]\nname = "
                   "\"a\"\npreset = \"" +
                       preset +
                       "\"\n[layer.source]\nkind = "
                       "\"splats\"\nfile = \"stars.pda\"\n");
    }
    RunOptions own_data() const {
        RunOptions options;
        options.environment = {"XDG_DATA_HOME=" + (folder / "data ö").string()};
        return options;
    }
    /// Hash of the frame's pixels.
    std::string pixels() const {
        expect_success(run({"--batch", "named.toml", "--overwrite", "-q", "--stats", "s.json"}, own_data()));
        return json("s.json").at("frames").at(0).at("sha256");
    }
};

TEST_F(Names, OfLooksAreFoundBesideTheSceneThenThePersonsThenThePrograms) {
    write_scene_with("s106");
    const std::string shipped = pixels();
    write_text(folder / "data ö/astrosplat/looks/s106.toml", look("0.5"));
    const std::string own = pixels();
    EXPECT_NE(own, shipped);
    write_text(folder / "s106.toml", look("0.25"));
    const std::string beside = pixels();
    EXPECT_NE(beside, own);
    EXPECT_NE(beside, shipped);
    write_scene_with("data ö/astrosplat/looks/s106.toml");
    EXPECT_EQ(pixels(), own) << "a file's name means that file";
}

TEST_F(Names, ThatAreNotKnownNameThoseThatAre) {
    write_scene_with("s107");
    write_text(folder / "data ö/astrosplat/looks/mine.toml", look("0.5"));
    const RunResult result = run({"--batch", "named.toml"}, own_data());
    EXPECT_EQ(result.code, 2);
    EXPECT_HAS(result.err, "by name: m51, mine, s106");
    write_scene_with("s106.tom");
    EXPECT_EQ(run({"--batch", "named.toml"}, own_data()).code, 2) << "an ending makes it a file";
}

TEST_F(Names, OfScenes) {
    const RunResult known =
        expect_success(run({"--batch", "spiral", "--dry-run", "-f", "1", "-o", "a.exr"}, own_data()));
    EXPECT_HAS(known.out, "scenes/spiral.toml");
    EXPECT_EQ(run({"--batch", "scene", "--dry-run"}, own_data()).code, 0) << "beside";
    const RunResult unknown = run({"--batch", "spirale", "--dry-run"}, own_data());
    EXPECT_EQ(unknown.code, 2);
}

// The libraries that the program loads when it starts.

class Start : public SceneTest {
  protected:
    void SetUp() override {
        SceneTest::SetUp();
#if !defined(__x86_64__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
        GTEST_SKIP() << "only x86-64 without sanitizers has the lazy loader";
#endif
    }

    /// The libraries that the dynamic linker loaded during a run, by its own account.
    std::string libraries_of(const Words& arguments) const {
        const fs::path report = folder / ("libraries of " + arguments[0]);
        fs::remove_all(report);
        fs::create_directories(report);
        const std::string output = "LD_DEBUG_OUTPUT=" + (report / "report").string();
        expect_success(run(arguments, {.environment = {"LD_DEBUG=files", output}}));
        std::string text;
        for (const auto& entry : fs::directory_iterator(report)) text += text_of(entry.path());
        return text;
    }
};

// With all that it needs OpenImageIO is 250 libraries, a fifth of a second and 100 MB.
TEST_F(Start, ThePictureLibraryWaitsForTheFirstPicture) {
    write_text(folder / "picture.ppm", small_picture());
    const std::string library = "libOpenImageIO.so", colors = "libOpenColorIO.so";
    EXPECT_HAS(libraries_of({"info", "picture.ppm"}), library);
    const std::string without = libraries_of({"parameters"});
    EXPECT_HAS(without, "libc.so");
    EXPECT_EQ(without.find(library), std::string::npos);
    EXPECT_EQ(without.find(colors), std::string::npos);
    EXPECT_EQ(libraries_of({"info", "stars.pda"}).find(library), std::string::npos);
}

TEST_F(Start, FramesAreWrittenAndResumedWithoutIt) {
    for (const char* file : {"frame.exr", "frame.png", "frame.tif"})
        for (const char* how : {"--overwrite", "--resume"}) {
            const std::string loaded =
                libraries_of({"--batch", "scene.toml", "--frames", "1", "--output", file, how});
            EXPECT_HAS(loaded, "libc.so");
            EXPECT_EQ(loaded.find("libOpenImageIO.so"), std::string::npos) << file << " " << how;
        }
}

}  // namespace
}  // namespace astrosplat::test

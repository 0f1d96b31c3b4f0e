// README and the chapters of the manual promise nothing that the program does not do: commands, options,
// keys, files and links that they name exist, and README's first picture is made as written there.
#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <sstream>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

const fs::path root = ASTROSPLAT_SOURCE_DIR;

std::vector<fs::path> documents() {
    std::vector<fs::path> files{root / "README.md"};
    for (const auto& entry : fs::directory_iterator(root / "app/manual")) files.push_back(entry.path());
    return files;
}

std::vector<std::string> matches(const std::string& text, const char* pattern) {
    const std::regex regex(pattern);
    std::vector<std::string> found;
    for (std::sregex_iterator it(text.begin(), text.end(), regex), none; it != none; ++it)
        found.push_back((*it)[1]);
    return found;
}

std::vector<std::string> words_of(const std::string& line) {
    std::istringstream words(line);
    return {std::istream_iterator<std::string>(words), {}};
}

/// What is typed in indented blocks of code, from "astrosplat" on; without comments, continued lines joined.
std::vector<std::string> commands_in(const std::string& text) {
    const std::string joined = std::regex_replace(text, std::regex(R"(\\\n)"), " ");
    return matches(joined, R"(\n    (?:\$ )?(?:build/release/)?(astrosplat [^#\n]*))");
}

class Documents : public SceneTest {
  protected:
    /// Long options of the program or of a command of it.
    const std::set<std::string>& options_of(const std::string& command) {
        if (const auto known = options_.find(command); known != options_.end()) return known->second;
        const RunResult help = command.empty() ? run({"--help"}) : run({command, "--help"});
        const auto names = matches(help.out, R"(\n +(?:-[a-z], ?)?(--[a-z-]+))");
        return options_[command] = {names.begin(), names.end()};
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
            const std::vector<std::string> words = words_of(line);
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
            std::vector<std::string> headings = matches(text_of(target), "\n## ([^\n]+)");
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
        RunOptions options;
        options.folder = folder;
        return run_program({"/usr/bin/env", "sh", "-c", line}, options);
    }
    std::vector<std::string> lines;
};

TEST_F(FirstPicture, GetsAScene) {
    ASSERT_EQ(lines.size(), 3u);
    const RunResult result = run_line(lines[0]);
    EXPECT_EQ(result.code, 0) << result.err;
    const std::string scene = words_of(lines[0]).back();
    EXPECT_TRUE(fs::exists(folder / scene));
    EXPECT_EQ(words_of(lines[1]).back(), scene);
    EXPECT_NE(lines[2].find(" " + scene + " "), std::string::npos);
}

TEST_F(FirstPicture, IsRenderedNightly) {
    ASSERT_EQ(lines.size(), 3u);
    ASSERT_EQ(run_line(lines[0]).code, 0);
    const RunResult result = run_line(lines[2]);
    EXPECT_EQ(result.code, 0) << result.err;
    for (const char* frame : {"0001", "0041", "0081", "0121", "0161", "0201"})
        EXPECT_TRUE(fs::exists(folder / fmt::format("renders/first.{}.png", frame))) << frame;
}

}  // namespace
}  // namespace astrosplat::test

// The architecture as a test (DESIGN 2): includes point one way, libraries stay behind the files that wrap
// them, and the top level holds only what was agreed. A rule that is not checked is lost.
#include <regex>

#include "support/test.h"

namespace fs = std::filesystem;

namespace {

const fs::path root = ASTROSPLAT_SOURCE_DIR;

struct Include {
    std::string file;  // relative to the repository
    std::string name;  // as written
    bool quoted;
};

bool is_source(const fs::path& file) { return file.extension() == ".h" || file.extension() == ".cpp"; }

std::vector<Include> includes_below(const std::string& folder) {
    static const std::regex line_pattern(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
    std::vector<Include> includes;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
        if (!entry.is_regular_file() || !is_source(entry.path())) continue;
        std::ifstream in(entry.path());
        for (std::string line; std::getline(in, line);) {
            std::smatch match;
            if (!std::regex_search(line, match, line_pattern)) continue;
            includes.push_back(
                {fs::relative(entry.path(), root).generic_string(), match[2], match[1] == "\""});
        }
    }
    return includes;
}

std::string first_folder(const std::string& path) {
    const auto slash = path.find('/');
    return slash == std::string::npos ? "" : path.substr(0, slash);
}

/// Standard output of a command run in the repository; empty when it fails.
std::string output_of(const std::string& command) {
    const std::string line = "cd '" + root.string() + "' && " + command + " 2>/dev/null";
    FILE* pipe = popen(line.c_str(), "r");
    if (!pipe) return "";
    std::string output;
    std::array<char, 4096> buffer;
    for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
        output.append(buffer.data(), n);
    return pclose(pipe) == 0 ? output : "";
}

std::vector<std::string> tracked_files() {
    std::istringstream list(output_of("git ls-files"));
    std::vector<std::string> files;
    for (std::string file; std::getline(list, file);) {
        if (fs::exists(root / file)) files.push_back(file);
    }
    return files;
}

TEST(Structure, EngineIncludesPointOneWay) {
    const std::map<std::string, std::set<std::string>> allowed = {
        {"core", {"core"}},
        {"ocio", {"core", "ocio"}},
        {"image", {"core", "image"}},
        {"detect", {"core", "image", "detect"}},
        {"fidelity", {"core", "image", "detect", "fidelity"}},
        {"prepare", {"core", "image", "detect", "prepare"}},
        {"source", {"core", "image", "camera", "detect", "prepare", "source"}},
        {"splats", {"core", "splats"}},
        {"gltf", {"core", "gltf"}},
        {"usd", {"core", "usd"}},
        {"splat_files", {"core", "gltf", "usd", "splats", "splat_files"}},
        {"stars", {"core", "source", "splats", "stars"}},
        {"generate", {"core", "source", "splats", "splat_files", "generate"}},
        {"look", {"core", "image", "source", "splats", "look"}},
        {"streamed", {"core", "splats", "splat_files", "look", "streamed"}},
        {"camera", {"core", "camera"}},
        {"camera_files", {"core", "gltf", "usd", "camera", "camera_files"}},
        {"render", {"core", "source", "splats", "camera", "render"}},
        {"merge", {"core", "splats", "camera", "render", "merge"}},
        {"gaussians", {"core", "splats", "splat_files", "camera", "render", "merge", "gaussians"}},
        {"volumes", {"core", "splat_files", "camera", "render", "gaussians", "volumes"}},
        {"bodies", {"core", "image", "detect", "source", "splats", "camera", "render", "bodies"}},
        {"objects", {"core", "image", "source", "bodies", "objects"}},
        {"sets", {"core", "source", "splats", "splat_files", "generate", "bodies", "stars", "sets"}},
        {"scene",
         {"core", "prepare", "source", "splats", "splat_files", "generate", "bodies", "stars", "sets", "look",
          "camera", "camera_files", "render", "ocio", "objects", "scene"}},
        {"output",
         {"core", "source", "splats", "splat_files", "generate", "sets", "look", "camera", "render", "scene",
          "ocio", "output"}},
        {"frame",
         {"core", "source", "splats", "look", "camera", "render", "scene", "output", "ocio", "frame"}},
        {"",
         {"core", "source", "splats", "splat_files", "generate", "sets", "look", "camera", "render", "scene",
          "output", "frame", "image", "fidelity", "streamed", ""}},  // pipeline, measure_fidelity
    };
    const std::vector<Include> includes = includes_below("engine");
    ASSERT_GT(includes.size(), 100u);
    for (const Include& include : includes) {
        if (!include.quoted) continue;
        if (fs::exists(root / "shaders/shared" / include.name)) continue;
        const std::string from = first_folder(include.file.substr(std::string("engine/").size()));
        ASSERT_TRUE(allowed.count(from)) << include.file << ": a folder the design does not know";
        EXPECT_TRUE(allowed.at(from).count(first_folder(include.name)))
            << include.file << " includes " << include.name;
        EXPECT_TRUE(fs::exists(root / "engine" / include.name))
            << include.file << ": write the path from engine/, not " << include.name;
    }
}

TEST(Structure, EngineKnowsNoWindow) {
    const std::regex window("GLFW|glad|imgui|^GL/|^EGL/|^X11/|^CLI/|^GLES");
    for (const Include& include : includes_below("engine")) {
        EXPECT_FALSE(std::regex_search(include.name, window)) << include.file << " includes " << include.name;
    }
}

TEST(Structure, CommandLineAndBatchKnowNoWindow) {
    const std::regex window("GLFW|glad|imgui|^GL/|^EGL/|^X11/");
    for (const Include& include : includes_below("app")) {
        const std::string folder = first_folder(include.file.substr(std::string("app/").size()));
        if (!folder.empty()) continue;
        EXPECT_FALSE(std::regex_search(include.name, window)) << include.file << " includes " << include.name;
    }
}

TEST(Structure, PreviewKnowsNoWidgetsAndWidgetsKnowNoGl) {
    const std::regex widgets("imgui|^gui/"), gl("GLFW|glad|^GL/|^gl/");
    for (const Include& include : includes_below("app")) {
        if (include.file.rfind("app/gl/", 0) == 0) {
            EXPECT_FALSE(std::regex_search(include.name, widgets))
                << include.file << " includes " << include.name;
        }
        if (include.file.rfind("app/gui/", 0) == 0) {
            EXPECT_FALSE(std::regex_search(include.name, gl)) << include.file << " includes " << include.name;
        }
    }
}

TEST(Structure, LibrariesStayBehindTheFilesThatWrapThem) {
    const std::vector<std::pair<std::regex, std::regex>> rules = {
        // The headers named here are for the readers and the writers of pictures only.
        {std::regex("^OpenImageIO/"), std::regex("^engine/(source|output)/[^/]*\\.cpp$|"
                                                 "^engine/source/open_picture\\.h$")},
        {std::regex("^png\\.h"), std::regex("^engine/output/png_frame\\.cpp$")},
        {std::regex("^tiffio"), std::regex("^engine/(output/tiff_frame|source/open_picture)\\.cpp$")},
        {std::regex("^OpenColorIO/"), std::regex("^engine/ocio/display_transform\\.cpp$")},
        {std::regex("^fitsio"), std::regex("^engine/source/([^/]*\\.cpp|fits_file\\.h)$")},
        {std::regex("^openssl/"), std::regex("^engine/core/hash\\.cpp$")},
        {std::regex("^bzlib"), std::regex("^engine/core/packed_file\\.cpp$")},
        {std::regex("^openvdb/"), std::regex("^engine/volumes/openvdb/[^/]*\\.cpp$")},
        {std::regex("^pugixml"), std::regex("^engine/source/(object_metadata|votable|xisf)\\.cpp$")},
        {std::regex("^(wcs|erfa)"), std::regex("^engine/source/sky_grid\\.cpp$")},
        {std::regex("^lcms2"), std::regex("^engine/source/color_encoding\\.cpp$")},
        {std::regex("^lz4"), std::regex("^engine/source/xisf\\.cpp$")},
        {std::regex("^zstd"), std::regex("^engine/(source/xisf|splat_files/spz|gaussians/spz_file)\\.cpp$")},
        {std::regex("^webp/"), std::regex("^engine/splat_files/sog\\.cpp$")},
        {std::regex("^toml"), std::regex("^engine/scene/")},
        {std::regex("^tiny_obj"), std::regex("^engine/source/[^/]*\\.cpp$")},
        {std::regex("^CLI/"), std::regex("^app/(command|main|manual)\\.(cpp|h)$")},
    };
    std::vector<Include> includes = includes_below("engine");
    for (const Include& include : includes_below("app")) includes.push_back(include);
    for (const Include& include : includes)
        for (const auto& [library, place] : rules) {
            if (!std::regex_search(include.name, library)) continue;
            EXPECT_TRUE(std::regex_search(include.file, place))
                << include.file << " includes " << include.name;
        }
}

// "astrosplat::native Block" of what a file defines at the level of namespaces that have names. What ends
// one is said by its comment.
std::vector<std::string> types_defined_in(const fs::path& file) {
    static const std::regex type(
        R"re(^(?:struct|class|enum class|union) (\w+)(?: final)?(?: :[^;{]*)? \{)re");
    static const std::regex opening(R"re(^namespace ?(\S*) \{)re");
    std::vector<std::string> types, namespaces;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        std::smatch match;
        if (line == "namespace {") {
            namespaces.emplace_back();
        } else if (std::regex_search(line, match, opening)) {
            namespaces.push_back(match[1]);
        } else if (line.starts_with("}  // namespace") && !namespaces.empty()) {
            namespaces.pop_back();
        } else if (std::regex_search(line, match, type) &&
                   std::find(namespaces.begin(), namespaces.end(), "") == namespaces.end()) {
            std::string where;
            for (const std::string& name : namespaces) where += (where.empty() ? "" : "::") + name;
            types.push_back(where + " " + match[1].str());
        }
    }
    return types;
}

// The linker takes one destructor for both, and no one says so.
TEST(Structure, NoTwoTypesHaveOneName) {
    std::map<std::string, std::string> file_of;
    for (const char* const folder : {"engine", "app"})
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            if (!entry.is_regular_file() || !is_source(entry.path())) continue;
            const std::string file = fs::relative(entry.path(), root).generic_string();
            for (const std::string& type : types_defined_in(entry.path())) {
                const auto [known, is_new] = file_of.emplace(type, file);
                EXPECT_TRUE(is_new) << type << ": in " << known->second << " and " << file;
            }
        }
    EXPECT_GT(file_of.size(), 300u);
    EXPECT_TRUE(file_of.contains("astrosplat SplatSet"));
    EXPECT_TRUE(file_of.contains("astrosplat::native Block"));
}

// Code that one file alone needs stands in that file. The number of the others may only fall.
TEST(Structure, AHeaderHasTwoUsersOrATest) {
    constexpr std::size_t allowed = 2;
    std::map<std::string, std::set<std::string>> users;  // of each header, by its path
    for (const char* const folder : {"engine", "app", "tests"})
        for (const Include& include : includes_below(folder))
            for (const std::string base : {"engine", "app"})
                if (include.quoted && fs::exists(root / base / include.name))
                    users[base + "/" + include.name].insert(include.file);
    std::string lonely;
    std::size_t count = 0;
    for (const auto& [header, files] : users) {
        const std::string source = header.substr(0, header.size() - 2) + ".cpp";
        const auto is_test = [](const std::string& file) { return file.starts_with("tests/"); };
        const bool is_kernel = header.ends_with("-inl.h");  // Highway compiles it once per instruction set
        if (is_kernel || std::ranges::any_of(files, is_test) || files.size() - files.count(source) >= 2)
            continue;
        lonely += "\n" + header;
        ++count;
    }
    EXPECT_GT(users.size(), 200u);
    EXPECT_LE(count, allowed) << "merge the newest of these into its only user:" << lonely;
}

/// From each idea of a folder, a header with its source, to those it includes there.
std::map<std::string, std::set<std::string>> ideas_below(const std::string& folder) {
    std::map<std::string, std::set<std::string>> arrows;
    for (const Include& include : includes_below(folder)) {
        const fs::path from = include.file, to = "app/" + fs::path(include.name).generic_string();
        if (!to.generic_string().starts_with(folder + "/") || !fs::exists(root / to)) continue;
        const std::string idea = fs::path(from).replace_extension(), other = fs::path(to).replace_extension();
        if (idea != other) arrows[idea].insert(other);
    }
    return arrows;
}

// Who changes one idea of a circle has to know all of them.
TEST(Structure, IdeasOfTheProgramPointOneWay) {
    auto arrows = ideas_below("app");
    ASSERT_GT(arrows.size(), 60u);
    for (std::size_t grown = 1; grown > 0;) {  // at last all that are reached from each
        grown = 0;
        for (auto& [idea, reached] : arrows) {
            const std::set<std::string> before = reached;
            for (const std::string& next : before)
                if (const auto further = arrows.find(next); further != arrows.end())
                    reached.insert(further->second.begin(), further->second.end());
            grown += reached.size() - before.size();
        }
    }
    std::string circle;
    for (const auto& [idea, reached] : arrows)
        if (reached.contains(idea)) circle += "\n" + idea;
    EXPECT_EQ(circle, "");
}

TEST(Structure, TopLevelHoldsOnlyWhatWasAgreed) {
    const std::set<std::string> agreed = {
        ".ci",     ".clang-format", ".gitignore", "CMakeLists.txt", "CMakePresets.json",
        "LICENSE", "README.md",     "app",        "assets",         "engine",
        "shaders", "tests",         "third_party"};
    const std::vector<std::string> files = tracked_files();
    if (files.empty()) GTEST_SKIP() << "not a git checkout";
    for (const std::string& file : files) {
        const std::string folder = first_folder(file);
        EXPECT_TRUE(agreed.count(folder.empty() ? file : folder)) << file;
    }
}

TEST(Structure, NoFileNamesAFolderOfOneMachine) {
    const std::vector<std::string> files = tracked_files();
    if (files.empty()) GTEST_SKIP() << "not a git checkout";
    const std::set<std::string> texts = {".h",  ".cpp",  ".glsl", ".txt", ".cmake", ".sh",
                                         ".md", ".toml", ".json", ".py",  ""};
    const std::regex machine_folder("(^|[^A-Za-z0-9_.}])/(work|home|root|Users)/");
    for (const std::string& file : files) {
        if (!texts.count(fs::path(file).extension().string())) continue;
        std::ifstream in(root / file);
        int number = 0;
        for (std::string line; std::getline(in, line);) {
            ++number;
            EXPECT_FALSE(std::regex_search(line, machine_folder)) << file << ":" << number << ": " << line;
        }
    }
}

TEST(Structure, ReadmeNamesFilesThatAreThere) {
    std::ifstream in(root / "README.md");
    const std::string text(std::istreambuf_iterator<char>(in), {});
    const std::regex place("`((app|assets|engine|shaders|tests|third_party)/[A-Za-z0-9_./-]+)`");
    int count = 0;
    for (std::sregex_iterator found(text.begin(), text.end(), place), end; found != end; ++found, ++count)
        EXPECT_TRUE(fs::exists(root / (*found)[1].str())) << (*found)[1].str();
    EXPECT_GT(count, 10);
}

TEST(Structure, CodeIsFormatted) {
    if (output_of("clang-format --version").find("version 14") == std::string::npos) {
        GTEST_SKIP() << "clang-format 14 is not installed";
    }
    std::string sources;
    for (const std::string& file : tracked_files()) {
        if (is_source(file)) sources += " '" + file + "'";
    }
    if (sources.empty()) GTEST_SKIP() << "not a git checkout";
    const std::string command = "clang-format --dry-run -Werror" + sources + " && echo formatted";
    EXPECT_EQ(output_of(command), "formatted\n") << "run: clang-format -i $(git ls-files '*.h' '*.cpp')";
}

}  // namespace

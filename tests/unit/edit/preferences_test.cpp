// The window's settings on disk, and the files in use that change there.
#include "edit/preferences.h"
#include "core/file.h"
#include "core/log.h"
#include "edit/document.h"
#include "edit/kept_files.h"
#include "scene/layer_setup.h"
#include "scenes.h"
#include "support/bits.h"
#include "support/run_program.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// The window's settings on disk: round trip, damage, folders that cannot be written.

/// Warnings while `work` runs.
template <class Work>
std::vector<std::string> warnings_of(const Work& work) {
    const Said said;
    work();
    return said.warnings;
}

class PreferencesTest : public testing::Test {
  protected:
    const TempFolder folder;
};

TEST_F(PreferencesTest, RoundTrip) {
    const CommaLocale comma;
    Preferences p;
    p.window_width = 1234;
    p.window_height = 777;
    p.panel_width = 401.5f;
    p.timeline_height = 200.25f;
    p.timeline_open = false;
    p.scopes_open = true;
    p.scopes = {true, false, false};
    for (const SettingRow& row : setting_rows()) p.settings.*row.value = row.choices.back().value;
    p.settings.cache_folder = "/gro\xc3\x9f/sets \"1\"";
    add_recent(p, folder.file("a \"b\" ä.toml", "x"));
    add_recent_folder(p, folder.path());
    RenderTask task{RenderKind::movie,      "1-5", 320, 180,    "/films",   "a \"b\".mp4",
                    ExistingFrames::resume, true,  5,   "long", "the disc", 5000};
    p.renders = {{folder / "a \"b\" ä.toml", "Movie of 1-9", task}};
    const fs::path file = folder / "neu/tiefer/viewer.json";
    EXPECT_TRUE(warnings_of([&] { save_preferences(p, file); }).empty());
    EXPECT_EQ(load_preferences(file), p);
}

TEST_F(PreferencesTest, AMissingFileIsNoNews) {
    EXPECT_TRUE(warnings_of([&] {
                    EXPECT_EQ(load_preferences(folder / "viewer.json"), Preferences{});
                    EXPECT_EQ(load_preferences({}), Preferences{});
                    save_preferences({}, {});
                }).empty());
}

TEST_F(PreferencesTest, DamageGivesDefaultsAndOneWarning) {
    for (const char* text : {"", "{", "[1, 2]", "\xff\xfe", "{\"window_width\": 12"}) {
        const fs::path file = folder.file("viewer.json", text);
        EXPECT_EQ(warnings_of([&] { EXPECT_EQ(load_preferences(file), Preferences{}); }).size(), 1u) << text;
    }
    fs::create_directory(folder / "ordner.json");
    EXPECT_EQ(warnings_of([&] { load_preferences(folder / "ordner.json"); }).size(), 1u);
}

TEST_F(PreferencesTest, SingleValuesThatAreWrongHaveTheirDefault) {
    const fs::path file =
        folder.file("viewer.json",
                    "{\"window_width\": \"wide\", \"window_height\": -5, \"panel_width\": 1e9,"
                    " \"timeline_open\": 3, \"recent\": [1, \"/gone\"], \"recent_folders\": [\"/gone\"],"
                    " \"interface_percent\": 7, \"threads\": \"all\", \"engine\": 9, \"autosave_s\": -1,"
                    " \"contrast\": 2, \"memory_gib\": 3, \"cache_folder\": \"sets\"}");
    EXPECT_EQ(load_preferences(file), Preferences{});
}

TEST_F(PreferencesTest, RendersOfScenesThatAreGoneOrNotToldInFullAreLeftOut) {
    Preferences p;
    const fs::path scene = folder.file("a.toml", "x"), file = folder / "viewer.json";
    p.renders = {{scene, "One", {}}, {folder / "gone.toml", "Two", {}}, {"", "Untitled", {}}};
    save_preferences(p, file);
    p.renders.resize(1);
    EXPECT_EQ(load_preferences(file), p);
    for (const auto& [part, by] : {std::pair{"\"width\": 0", "\"width\": \"x\""},
                                   {"\"kind\": 1", "\"kind\": 4"},
                                   {"\"chunk\"", "\"junk\""}}) {
        folder.file("viewer.json", test::replaced(test::text_of(file), part, by));
        EXPECT_TRUE(load_preferences(file).renders.empty()) << by;
        save_preferences(p, file);
    }
}

TEST_F(PreferencesTest, EverySettingHasItsDefaultAmongItsChoices) {
    for (const SettingRow& row : setting_rows())
        EXPECT_EQ(std::ranges::count(row.choices, Settings().*row.value, &SettingChoice::value), 1)
            << row.name;
    EXPECT_EQ(setting_rows().size(), offsetof(Settings, device) / sizeof(int) + 1) << "one row each";
    EXPECT_EQ(autosave_interval({.autosave_s = 15}), std::chrono::seconds(15));
}

TEST(Settings, TheCommandLineAndTheEnvironmentNameTheCacheBeforeTheSettings) {
    const Settings settings{.cache_gib = 5, .cache_folder = "/mine"};
    const SetCache standard{"/standard/sets"}, named{"/named"}, none;
    {
        const Variable no_folder("ASTROSPLAT_CACHE", nullptr);
        EXPECT_EQ(cache_with(settings, standard, false).folder, "/mine");
        EXPECT_EQ(cache_with(Settings(), standard, false).folder, standard.folder);
        EXPECT_EQ(cache_with(settings, named, true).folder, "/named");
        EXPECT_EQ(cache_with(settings, none, true).folder, "") << "--no-cache";
        EXPECT_EQ(cache_with(settings, named, true).limit_bytes, std::int64_t{5} << 30);
    }
    const Variable folder("ASTROSPLAT_CACHE", "/of/the/environment");
    EXPECT_EQ(cache_with(settings, {"/of/the/environment"}, false).folder, "/of/the/environment");
}

TEST(Settings, ACacheFolderIsAbsoluteAndNoFile) {
    const TempFolder folder;
    EXPECT_EQ(problem_of_cache_folder(""), "");
    EXPECT_EQ(problem_of_cache_folder(folder.path().string()), "");
    EXPECT_EQ(problem_of_cache_folder((folder / "to come").string()), "");
    EXPECT_EQ(problem_of_cache_folder("sets"), "expected an absolute path, found 'sets'");
    const std::string file = folder.file("file", "x").string();
    EXPECT_EQ(problem_of_cache_folder(file), "expected a folder, found the file '" + file + "'");
}

TEST_F(PreferencesTest, AFolderThatCannotBeWrittenCostsOneWarning) {
    const fs::path file = folder.file("file", "x") / "viewer.json";
    EXPECT_EQ(warnings_of([&] { save_preferences({}, file); }).size(), 1u);
}

TEST_F(PreferencesTest, TwelveRecentFilesNewestFirstEachOnce) {
    Preferences p;
    for (int i = 0; i < 15; ++i) add_recent(p, folder.file("scene " + std::to_string(i) + ".toml", "x"));
    EXPECT_EQ(p.recent.size(), 12u);
    EXPECT_EQ(p.recent[0], folder / "scene 14.toml");
    add_recent(p, folder / "x" / ".." / "scene 5.toml");
    EXPECT_EQ(p.recent.size(), 12u);
    EXPECT_EQ(p.recent[0], folder / "scene 5.toml");
    EXPECT_EQ(std::count(p.recent.begin(), p.recent.end(), folder / "scene 5.toml"), 1);
    save_preferences(p, folder / "viewer.json");
    fs::remove(folder / "scene 14.toml");
    const Preferences loaded = load_preferences(folder / "viewer.json");
    EXPECT_EQ(loaded.recent.size(), 11u);  // existing ones only
    EXPECT_EQ(loaded.recent[1], folder / "scene 13.toml");
}

TEST_F(PreferencesTest, EightRecentFoldersNewestFirstEachOnce) {
    Preferences p;
    for (int i = 0; i < 10; ++i) {
        fs::create_directory(folder / std::to_string(i));
        add_recent_folder(p, folder / std::to_string(i));
    }
    add_recent_folder(p, folder / "5");
    ASSERT_EQ(p.recent_folders.size(), 8u);
    EXPECT_EQ(p.recent_folders[0], folder / "5");
    EXPECT_EQ(p.recent_folders[1], folder / "9");
    save_preferences(p, folder / "viewer.json");
    fs::remove(folder / "9");
    EXPECT_EQ(load_preferences(folder / "viewer.json").recent_folders.size(), 7u) << "existing ones only";
}

TEST_F(PreferencesTest, PanelsGoIntoAViewAndBack) {
    Preferences p, back;
    p.panel_width = 444.0f;
    p.timeline_height = 99.0f;
    p.timeline_open = false;
    ViewState view;
    static_cast<PanelSizes&>(view) = p;
    EXPECT_EQ(view.panel_width, 444.0f);
    static_cast<PanelSizes&>(back) = view;
    EXPECT_EQ(back, p);
}

TEST(UserFolders, FollowTheBaseDirectorySpecification) {
    const Variable home("HOME", "/heim");
    {
        const Variable state("XDG_STATE_HOME", "/zu stand"), config("XDG_CONFIG_HOME", "/ein");
        EXPECT_EQ(autosave_folder(), "/zu stand/astrosplat/autosave");
        EXPECT_EQ(preferences_file(), "/ein/astrosplat/viewer.json");
    }
    {
        const Variable state("XDG_STATE_HOME", "relative"), config("XDG_CONFIG_HOME", "");
        EXPECT_EQ(state_folder(), "/heim/.local/state/astrosplat");
        EXPECT_EQ(config_folder(), "/heim/.config/astrosplat");
    }
    const Variable state("XDG_STATE_HOME", nullptr), config("XDG_CONFIG_HOME", nullptr);
    const Variable no_home("HOME", nullptr);
    EXPECT_EQ(autosave_folder(), "");
    EXPECT_EQ(preferences_file(), "");
}

// Changes of files in use, and which files a scene uses.

using Paths = std::vector<fs::path>;

class WatchedFilesTest : public testing::Test {
  protected:
    TempFolder folder;
    fs::path a = folder.file("a ü.png", "a"), b = folder.file("b.png", "b");
    WatchedFiles watched;

    WatchedFilesTest() { watched.watch({a, b, folder / "missing.png", a}); }
    /// As if written this many seconds from now, whatever the file system's clock can tell apart.
    void date(const fs::path& file, int seconds) {
        fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(seconds));
    }
};

TEST_F(WatchedFilesTest, AChangeIsReportedOnceItRests) {
    EXPECT_EQ(watched.changed(), Paths{});
    date(a, 5);
    EXPECT_EQ(watched.changed(), Paths{}) << "it may still be written";
    date(a, 5);
    EXPECT_EQ(watched.changed(), Paths{});
    EXPECT_EQ(watched.changed(), Paths{a});
    EXPECT_EQ(watched.changed(), Paths{});
    folder.file("b.png", "longer");
    watched.changed();
    EXPECT_EQ(watched.changed(), Paths{b});
}

TEST_F(WatchedFilesTest, AFileThatIsGoneIsWaitedFor) {
    const std::string name = "a ü.png";
    fs::remove(a);
    EXPECT_EQ(watched.changed(), Paths{});
    EXPECT_EQ(watched.changed(), Paths{});
    folder.file(name, "another");
    watched.changed();
    EXPECT_EQ(watched.changed(), Paths{a});
}

TEST_F(WatchedFilesTest, AMissingFileAppears) {
    const fs::path file = folder.file("missing.png", "here");
    watched.changed();
    EXPECT_EQ(watched.changed(), Paths{file});
}

TEST_F(WatchedFilesTest, WatchingAgainForgetsNothing) {
    date(a, 5);
    date(b, 5);
    watched.watch({a});
    watched.changed();
    EXPECT_EQ(watched.changed(), Paths{a});
    watched.watch({a, b});
    watched.changed();
    EXPECT_EQ(watched.changed(), Paths{}) << "b was changed while no one watched it";
}

TEST_F(WatchedFilesTest, FilesOfAScene) {
    Scene scene;
    SourceParams source;
    source.meshes = {{"plane", {a}, 0.15}, {folder / "m.obj", {}, 0.15}};
    source.kind = SourceKind::stars;
    EXPECT_EQ(named_files(source), Paths{});
    source.stars.catalogue = folder / "m.obj";
    EXPECT_EQ(named_files(source), Paths{folder / "m.obj"});
    source.kind = SourceKind::mesh;
    EXPECT_EQ(named_files(source), (Paths{a, folder / "m.obj"}));
    source.texture.prepare.starless = b;
    EXPECT_EQ(named_files(source), (Paths{a, folder / "m.obj", b}));
    source.texture.prepare = {};
    folder.file("m.obj", "mtllib m.mtl\nv 0 0 0\n");
    folder.file("m.mtl", "newmtl one\nmap_Kd b.png\n");
    Paths all = all_files(source);
    std::sort(all.begin(), all.end());
    EXPECT_EQ(all, (Paths{a, b, folder / "m.mtl", folder / "m.obj"}));
    source.kind = SourceKind::splats;
    source.file = folder / "stars.pda";
    EXPECT_EQ(all_files(source), Paths{folder / "stars.pda"});

    scene.layers.resize(2);
    scene.layers[1].look.thickness.map = a;
    scene.environment.cube = {b};
    EXPECT_EQ(picture_files(scene), (Paths{b, a}));
}

}  // namespace
}  // namespace astrosplat

// The file dialog: what it lists and completes, and its questions.
#include "gui/file_dialog.h"
#include "gui/reference_screens.h"
#include "gui/test_window.h"
#include "gui/widgets.h"
#include "scene/describe.h"
#include "support/test.h"

namespace astrosplat {
namespace {

std::vector<std::string> names(const std::vector<FileEntry>& entries) {
    std::vector<std::string> list;
    for (const FileEntry& entry : entries) list.push_back(entry.name);
    return list;
}

TEST(FileList, FoldersFirstThenTheWantedFiles) {
    const TempFolder folder;
    fs::create_directory(folder / "zoom");
    folder.file("b.toml", "12345");
    folder.file("A.TOML", "");
    folder.file("c.png", "");
    folder.file(".hidden.toml", "");
    const std::vector<FileEntry> entries = list_folder(folder.path(), {".toml"});
    EXPECT_EQ(names(entries), (std::vector<std::string>{"zoom", "A.TOML", "b.toml"}));
    EXPECT_EQ(entries[2].bytes, 5U);
    EXPECT_EQ(list_folder(folder.path(), {}).size(), 4U);
    EXPECT_TRUE(list_folder(folder / "nothing", {}).empty());
}

TEST(FileList, SortsByTimeAndSizeAndBackwards) {
    const TempFolder folder;
    fs::create_directory(folder / "zoom");
    const auto now = fs::file_time_type::clock::now();
    const auto add = [&](const std::string& name, const std::string& text, int hours_ago) {
        folder.file(name, text);
        fs::last_write_time(folder / name, now - std::chrono::hours(hours_ago));
    };
    add("a", "12", 1);
    add("b", "1", 3);
    add("c", "123", 2);
    std::vector<FileEntry> entries = list_folder(folder.path(), {});
    const auto sorted = [&](FileOrder order, bool backwards) {
        sort_entries(entries, order, backwards);
        return names(entries);
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(sorted(FileOrder::changed, false), (Names{"zoom", "a", "c", "b"}));
    EXPECT_EQ(sorted(FileOrder::changed, true), (Names{"zoom", "b", "c", "a"}));
    EXPECT_EQ(sorted(FileOrder::size, false), (Names{"zoom", "c", "a", "b"}));
    EXPECT_EQ(sorted(FileOrder::name, true), (Names{"zoom", "c", "b", "a"}));
    EXPECT_EQ(sorted(FileOrder::name, false), (Names{"zoom", "a", "b", "c"}));
}

TEST(FileList, NumbersInNamesCount) {
    std::istringstream names_in_order(
        "10 a|a|p|p.png|p2.png|p9.png|p010.png|p10.png|P10b.png|p11.png|p100.2.png|p100.10.png|pa|"
        "q99999999999999999998|q99999999999999999999");
    std::vector<std::string> in_order;
    for (std::string name; std::getline(names_in_order, name, '|');) in_order.push_back(name);
    std::vector<FileEntry> entries;
    for (const std::string& name : in_order) entries.push_back({name, false, 0, {}});
    std::ranges::reverse(entries);
    sort_entries(entries, FileOrder::name, false);
    EXPECT_EQ(names(entries), in_order);
    sort_entries(entries, FileOrder::name, true);
    std::ranges::reverse(entries);
    EXPECT_EQ(names(entries), in_order);
}

TEST(FileList, KeysGoThroughTheList) {
    std::vector<FileEntry> entries(3);
    entries[0].name = "alpha";
    entries[1].name = "Beta";
    entries[2].name = "gamma";
    EXPECT_EQ(entry_beside(entries, "alpha", 1), 1U);
    EXPECT_EQ(entry_beside(entries, "alpha", -1), 0U);
    EXPECT_EQ(entry_beside(entries, "gamma", 1), 2U);
    EXPECT_EQ(entry_beside(entries, "be", -1), 1U);
    EXPECT_EQ(entry_beside(entries, "", 1), 0U);
    EXPECT_EQ(entry_beside(entries, "x", -1), 2U);
    EXPECT_EQ(entry_beside({}, "x", 1), std::nullopt);
    EXPECT_EQ(entry_begun(entries, "G"), 2U);
    EXPECT_EQ(entry_begun(entries, ""), std::nullopt);
}

TEST(FileList, CompletesAsFarAsThereIsNoChoice) {
    const TempFolder folder;
    fs::create_directory(folder / "scenes");
    folder.file("galaxy_one.toml", "");
    folder.file("galaxy_two.toml", "");
    folder.file("für.toml", "");
    folder.file("fül.toml", "");
    EXPECT_EQ(complete_path("ga", folder.path()), "galaxy_");
    EXPECT_EQ(complete_path("galaxy_o", folder.path()), "galaxy_one.toml");
    EXPECT_EQ(complete_path("sc", folder.path()), "scenes/");
    EXPECT_EQ(complete_path("x", folder.path()), "x");
    EXPECT_EQ(complete_path("f", folder.path()), "fü");
    const std::string absolute = folder.path().string() + "/sc";
    EXPECT_EQ(complete_path(absolute, "/"), absolute + "enes/");
}

TEST(FileList, TypedPathsKnowHome) {
    EXPECT_EQ(typed_path("~", "/x"), home_folder());
    EXPECT_EQ(typed_path("~/a", "/x"), home_folder() / "a");
    EXPECT_EQ(typed_path("a", "/x"), "/x/a");
    EXPECT_EQ(typed_path("/a", "/x"), "/a");
}

TEST(FileQueries, ANewSceneIsCalledAsWhatItWasMadeOf) {
    const TempFolder folder;
    const Document document = Document::untitled("astrosplat = 1\n", folder / "M 51.toml");
    EXPECT_EQ(query_for(Command::Kind::save_as, document)->name, "M 51.toml");
    EXPECT_EQ(query_for(Command::Kind::save_view, document)->name, "M 51.png");
    const fs::path file = folder.file("ä.toml", "astrosplat = 1\n");
    EXPECT_EQ(query_for(Command::Kind::save_as, Document::open(file))->name, "ä.toml");
}

/// A file of the scene is asked for in plain words, where it lies now, among files of its kind.
TEST(FileQueries, AFileOfTheSceneIsSoughtWhereItIs) {
    const TempFolder folder;
    fs::create_directory(folder / "textures");
    folder.file("textures/a.png", "");
    const Document document = Document::untitled(
        "astrosplat = 1\n[[layer]]\nname = \"gas\"\n[layer.source]\n"
        "meshes = [ { mesh = \"plane\", texture = \"textures/a.png\" } ]\n",
        folder / "scene.toml");
    const FileQuery picture = query_for("layer.gas.source.meshes.0.texture", document);
    EXPECT_EQ(picture.title, "Picture of gas");
    EXPECT_EQ(picture.folder, folder / "textures");
    EXPECT_NE(std::ranges::find(picture.extensions, ".png"), picture.extensions.end());
    const FileQuery mesh = query_for("layer.gas.source.meshes.0.mesh", document);
    EXPECT_FALSE(fs::equivalent(mesh.folder, folder / "textures"));
    EXPECT_EQ(mesh.extensions, std::vector<std::string>{".obj"});
    EXPECT_EQ(query_for("environment.image", document).title, "Picture");
}

TEST(FileQueries, EveryFileOfASceneHasAKind) {
    const std::set<std::string> of_any_kind{"output.ocio.config", "layer.source.catalogue"};
    const Document document = example_document();
    int files = 0;
    for (const ParameterRow& row : parameter_rows()) {
        if (row.spec.type != ParameterType::file && row.spec.type != ParameterType::files) continue;
        const bool any = of_any_kind.count(row.spec.key.text()) > 0;
        const ParameterKey key =
            row.spec.key.is_below("layer") ? row.spec.key.moved("layer", layer_key("dust")) : row.spec.key;
        EXPECT_EQ(query_for(key, document).extensions.empty(), any) << key;
        ++files;
    }
    EXPECT_GT(files, 10);
}

class FileDialogTest : public testing::Test {
  protected:
    FileDialogTest() : window(example_document()) {
        fs::create_directory(folder / "scenes");
        folder.file("scenes/old.toml", "x");
    }
    void type_path(const std::string& path) {
        window.tap('A', true);
        window.type(path);
    }
    void begin(const std::string& command) { window.choose(command); }
    /// The dialog of a command, led to a file or folder by its path.
    void begin_at(const std::string& command, const fs::path& place) {
        begin(command);
        type_path(place.string());
        window.tap(key_code::enter);
    }
    TempFolder folder;
    TestWindow window;
};

TEST_F(FileDialogTest, TabCompletesAndEnterGoesIntoAFolder) {
    begin("File/Open...");
    type_path(folder.path().string() + "/sc");
    window.tap(key_code::tab);
    window.tap(key_code::enter);
    EXPECT_TRUE(window.has("file/old.toml"));
    window.click("file/old.toml");
    window.click("file/Open");
    EXPECT_EQ(window.take_only(Command::Kind::open).path, folder / "scenes/old.toml");
}

TEST_F(FileDialogTest, OtherFilesAreListedWhereAllAreAskedFor) {
    folder.file("scenes/notes.txt", "");
    begin_at("File/Open...", folder / "scenes");
    EXPECT_TRUE(window.has("file/old.toml"));
    EXPECT_FALSE(window.has("file/notes.txt"));
}

TEST_F(FileDialogTest, SizesHaveTheUnitThatKeepsThemShort) {
    const std::pair<const char*, std::uintmax_t> files[] = {{"a.toml", 999},
                                                            {"b.toml", 45000},
                                                            {"c.toml", 1200000},
                                                            {"d.toml", 1200000000},
                                                            {"e.toml", 2000000000}};
    for (const auto& [name, size] : files)
        fs::resize_file(folder.file(std::string("scenes/") + name, ""), size);
    begin_at("File/Open...", folder / "scenes");
    const glm::vec2 first = window.at("file/a.toml"), last = window.at("file/e.toml");
    const int top = int(first.y) - 12, bottom = int(last.y) + 12;
    expect_like_reference("file_sizes", Part{int(first.x) + 200, top, 90, bottom - top});
}

TEST_F(FileDialogTest, AColumnSortsAndClickedAgainTheOtherWayRound) {
    folder.file("scenes/new.toml", "12345");
    begin_at("File/Open...", folder / "scenes");
    const auto old_is_first = [&] { return window.at("file/old.toml").y < window.at("file/new.toml").y; };
    EXPECT_FALSE(old_is_first());
    window.click("file/by Size");
    EXPECT_FALSE(old_is_first()) << "larger first";
    window.click("file/by Size");
    EXPECT_TRUE(old_is_first());
    window.click("file/by Name");
    EXPECT_FALSE(old_is_first());
}

TEST_F(FileDialogTest, FoldersThatFilesWereChosenInArePlaces) {
    const std::string place = "place/" + (folder / "scenes").string();
    begin("File/Open...");
    EXPECT_FALSE(window.has(place));
    type_path((folder / "scenes/old.toml").string());
    window.tap(key_code::enter);
    window.take_commands();
    begin("File/Open...");
    window.click(place);
    EXPECT_TRUE(window.has("file/old.toml"));
}

/// Pictures beside one another, of which one is read, one cannot be, and one is still to be read.
TEST_F(FileDialogTest, PicturesAreListedAsTheyLook) {
    for (const char* name : {"a.png", "b.png", "c.FITS", "d.txt"})
        folder.file(std::string("scenes/") + name, "");
    fs::create_directory(folder / "scenes/more");
    begin_at("File/Import as a layer...", folder / "scenes");
    const std::vector<ListedPicture> listed = window.view.listed_pictures;
    ASSERT_EQ(listed.size(), 3U);
    EXPECT_EQ(listed[0].file, folder / "scenes/a.png");
    Picture8 red(30, 20);
    std::ranges::fill(red.pixels, Rgba8{200, 30, 20, 255});
    window.status.thumbnails[listed[0]] = {&red, 3000, 2000};
    window.status.thumbnails[listed[1]] = {};
    window.frame(2);
    EXPECT_EQ(window.view.listed_pictures, listed);
    window.keep_screen("thumbnails");
    const glm::vec2 first = window.at("file/more"), last = window.at("file/c.FITS");
    const int top = int(first.y) - 14, bottom = int(last.y) + 28;
    expect_like_reference("thumbnails", Part{int(first.x) - 300, top, 380, bottom - top});
    window.tap(key_code::escape);
    window.tap(key_code::escape);
    EXPECT_TRUE(window.view.listed_pictures.empty()) << "nothing is read behind a closed dialog";
}

TEST_F(FileDialogTest, OfAFolderOfThousandsOnlyRowsThatAreSeenAreDrawn) {
    for (int i = 0; i < 3000; ++i) folder.file("scenes/frame" + std::to_string(10000 + i) + ".png", "");
    begin_at("File/Import as a layer...", folder / "scenes");
    EXPECT_TRUE(window.has("file/frame10000.png"));
    EXPECT_FALSE(window.has("file/frame10100.png"));
    EXPECT_LT(window.view.listed_pictures.size(), 12U);
    window.hover(window.at("file/frame10000.png"));
    for (int i = 0; i < 200 && !window.has("file/frame10100.png"); ++i) window.wheel(-1.0f);
    for (int i = 0; i < 3; ++i) window.wheel(-1.0f);  // to where the whole row is seen
    EXPECT_TRUE(window.has("file/frame10100.png"));
    window.click("file/frame10100.png");
    window.click("file/Open");
    EXPECT_EQ(window.take_commands().at(0).path, folder / "scenes/frame10100.png");
}

/// As in a file manager: the second click is not one on what lies there in the new list.
TEST_F(FileDialogTest, ADoubleClickOnAFolderOnlyEntersIt) {
    fs::create_directories(folder / "scenes/deep/deeper");
    folder.file("scenes/deep/deeper/x.toml", "");
    const auto double_click = [&](glm::vec2 at) {
        window.click(at);
        window.frame(6);  // a hand takes a tenth of a second
        window.press();
        window.release();
        window.frame();
    };
    begin_at("File/Open...", folder / "scenes");
    double_click(window.at("file/deep"));
    EXPECT_TRUE(window.has("file/deeper"));
    EXPECT_FALSE(window.has("file/x.toml"));
    window.frame(30);
    double_click(window.at("file/deeper"));
    EXPECT_TRUE(window.has("file/x.toml")) << "nor does it open a file";
    EXPECT_TRUE(window.take_commands().empty());
    window.frame(30);
    double_click(window.at("file/x.toml"));
    EXPECT_EQ(window.take_commands().at(0).path, folder / "scenes/deep/deeper/x.toml");
}

TEST_F(FileDialogTest, UpAndDownChooseAndTheListFollows) {
    for (int i = 0; i < 200; ++i) folder.file("scenes/shot" + std::to_string(100 + i) + ".png", "");
    begin_at("File/Import as a layer...", folder / "scenes");
    EXPECT_FALSE(window.has("file/shot250.png"));
    window.type("SHOT250");
    window.frame(2);
    EXPECT_TRUE(window.has("file/shot250.png")) << "what is begun is in sight";
    window.tap(key_code::down);
    window.tap(key_code::down);
    window.tap(key_code::up);
    window.tap(key_code::down);
    for (int i = 0; i < 20; ++i) window.tap(key_code::down);
    EXPECT_TRUE(window.has("file/shot271.png"));
    window.tap(key_code::enter);
    EXPECT_EQ(window.take_commands().at(0).path, folder / "scenes/shot271.png");
}

TEST_F(FileDialogTest, AMissingFileIsSaid) {
    begin("File/Open...");
    type_path((folder / "nothing.toml").string());
    window.click("file/Open");
    EXPECT_TRUE(window.has("file/path"));
    EXPECT_TRUE(window.take_commands().empty());
}

TEST_F(FileDialogTest, ReplacingIsAsked) {
    begin("File/Save as...");
    type_path((folder / "scenes/old.toml").string());
    window.click("file/Save");
    EXPECT_TRUE(window.take_commands().empty());
    window.keep_screen("replace");
    window.click("file/Replace");
    EXPECT_EQ(window.take_only(Command::Kind::save_as).path, folder / "scenes/old.toml");
}

TEST_F(FileDialogTest, TheExtensionIsAdded) {
    begin_at("File/Save as...", folder / "new");
    EXPECT_EQ(window.take_only(Command::Kind::save_as).path, folder / "new.toml");
}

}  // namespace
}  // namespace astrosplat

// The document: undo and redo, gestures, refused edits, saving, the file on disk.
#include "edit/document.h"

#include "edit/edits.h"
#include "scenes.h"
#include "support/test.h"

namespace astrosplat {
namespace {

using test::edit_scene;
using test::opacity;
using test::SceneFolder;
using test::value_of;

class DocumentTest : public testing::Test {
  protected:
    const SceneFolder f;
    Document document = Document::open(f.file);
};

TEST_F(DocumentTest, OpensAsTheLoaderReads) {
    document = Document::open(f.file);
    EXPECT_EQ(document.scene(), load_scene(f.file));
    EXPECT_EQ(document.file(), f.file);
    EXPECT_EQ(document.name(), "szene ä.toml");
    EXPECT_FALSE(document.edited());
    EXPECT_FALSE(document.can_undo());
    EXPECT_FALSE(document.can_redo());
    EXPECT_EQ(document.undo_name(), "");
}

TEST_F(DocumentTest, OneEditIsOneStep) {
    const Scene before = document.scene();
    const std::uint64_t revision = document.revision();
    document.set(opacity, 0.25, 1.0);
    EXPECT_EQ(value_of(document, opacity), Value(0.25));
    EXPECT_TRUE(document.edited());
    EXPECT_NE(document.revision(), revision);
    EXPECT_EQ(document.undo_name(), "Opacity of stars");
    document.undo();
    EXPECT_EQ(document.scene(), before);
    EXPECT_FALSE(document.edited());
    EXPECT_NE(document.revision(), revision);
    EXPECT_EQ(document.redo_name(), "Opacity of stars");
    document.redo();
    EXPECT_EQ(value_of(document, opacity), Value(0.25));
    EXPECT_FALSE(document.can_redo());
}

TEST_F(DocumentTest, AGestureIsOneStep) {
    for (int i = 1; i <= 9; ++i) document.set(opacity, i * 0.1, 1.0, 7);
    document.set(opacity, 0.05, 1.0, 8);
    document.undo();
    EXPECT_EQ(value_of(document, opacity), Value(0.9));
    document.undo();
    EXPECT_FALSE(document.can_undo());
    EXPECT_FALSE(document.edited());
}

TEST_F(DocumentTest, AGestureThatComesBackIsNoStep) {
    document.set("camera.fov", 50.0, 1.0);
    document.set(opacity, 0.7, 1.0, 7);
    document.set(opacity, 0.5, 1.0, 7);
    EXPECT_EQ(document.undo_name(), "Field of view");
    document.set(opacity, 0.6, 1.0, 7);  // and goes on
    EXPECT_EQ(document.undo_name(), "Opacity of stars");
    document.undo();
    EXPECT_EQ(value_of(document, "camera.fov"), Value(50.0));
    EXPECT_EQ(value_of(document, opacity), Value(0.5));
}

// Sides are dragged one by one.
TEST_F(DocumentTest, FramesOfDomesStaySquare) {
    const auto set_size = [&](std::int64_t width, std::int64_t height) {
        document.set("output.resolution", Value::List{width, height}, 1.0);
    };
    set_size(2048, 360);
    EXPECT_EQ(document.scene().output.height, 360);
    document.set("output.preset", "dome", 1.0);
    EXPECT_EQ(document.scene().output.width, 4096);
    set_size(2048, 4096);
    EXPECT_EQ(document.scene().output.height, 2048);
    set_size(2048, 8192);
    EXPECT_EQ(document.scene().output.width, 8192);
    EXPECT_THROW(set_size(512, 8192), InputError);
    document.save();
    EXPECT_EQ(load_scene(f.file).output.height, 8192);
}

TEST_F(DocumentTest, AnEditThatChangesNothingIsNotRecorded) {
    const std::uint64_t revision = document.revision();
    document.set(opacity, 0.5, 1.0);
    document.edit("Nothing", [](Scene&) {});
    EXPECT_FALSE(document.can_undo());
    EXPECT_EQ(document.revision(), revision);
}

TEST_F(DocumentTest, AnEditAfterUndoEndsRedo) {
    document.set(opacity, 0.25, 1.0);
    document.undo();
    document.set("camera.fov", 30.0, 1.0);
    EXPECT_FALSE(document.can_redo());
    document.undo();
    EXPECT_EQ(value_of(document, opacity), Value(0.5));
}

TEST_F(DocumentTest, FiveHundredStepsCanBeUndone) {
    for (int i = 1; i <= 510; ++i) document.set("camera.roll", double(i) / 10, 1.0);
    int steps = 0;
    for (; document.can_undo(); ++steps) document.undo();
    EXPECT_EQ(steps, 500);
    EXPECT_EQ(value_of(document, "camera.roll"), Value(1.0));
    EXPECT_TRUE(document.edited());
}

TEST_F(DocumentTest, RefusedEditsChangeNothing) {
    const Scene before = document.scene();
    const std::uint64_t revision = document.revision();
    EXPECT_EQ(ERROR_OF(document.set("camera.fov", 180.0, 1.0)),
              "camera.fov: expected a number of at least 0.001 and below 180, found 180");
    EXPECT_EQ(ERROR_OF(document.set("camera.fov", "wide", 1.0)),
              "camera.fov: expected a number, found a string");
    EXPECT_EQ(ERROR_OF(document.set("layer.dust.look.alpha.powr", 1.0, 1.0)),
              "unknown key 'layer.dust.look.alpha.powr'; did you mean 'layer.dust.look.alpha.power'?");
    EXPECT_EQ(ERROR_OF(document.set("layer.dust.look.radius.min", 0.5, 1.0)),
              "szene ä.toml: layer.dust.look.radius.min: expected min not above max, found 0.5 and 0");
    EXPECT_EQ(ERROR_OF(document.set("layer.dust.preset", "fehlt.toml", 1.0)),
              (f.folder / "fehlt.toml").string() +
                  ": cannot be read: No such file or directory; the looks that come with astrosplat are "
                  "in " ASTROSPLAT_SOURCE_DIR "/assets/looks, by name: m51, s106");
    EXPECT_EQ(ERROR_OF(document.set("layer.dust.look.thickness.map", "latin-1 \xe4.png", 1.0)),
              "layer.dust.look.thickness.map: expected text in UTF-8, found another encoding");
    EXPECT_EQ(ERROR_OF(document.set("layer.dust.look.noise.3.cull", 0.5, 1.0)),
              "layer.dust.look.noise.3.cull: expected an index of at most 2 in layer.look.noise, found 3");
    EXPECT_EQ(ERROR_OF(document.reset("layer.star.look.density")),
              "layer.star.look.density: unknown layer 'star'; did you mean 'stars'?");
    EXPECT_EQ(ERROR_OF(document.reset("camera.fow")), "unknown key 'camera.fow'; did you mean 'camera.fov'?");
    EXPECT_EQ(ERROR_OF(document.edit("Fov", [](Scene& s) { s.camera.fov = -1.0; })),
              "camera.fov: expected a number of at least 0.001 and below 180, found -1");
    EXPECT_EQ(ERROR_OF(document.edit("Twin", [](Scene& s) { s.layers[0].name = "stars"; })),
              "szene ä.toml: layer.name: expected each name once, found 'stars' twice");
    EXPECT_EQ(
        ERROR_OF(document.edit("Name", [](Scene& s) { s.layers[0].name = "a b"; })),
        "szene ä.toml: layer.name: expected letters, digits and _ beginning with a letter, found 'a b'");
    const auto swap_keyframes = [](Scene& s) {
        std::swap(s.animation[0].keyframes[0], s.animation[0].keyframes[1]);
    };
    EXPECT_EQ(ERROR_OF(document.edit("Keyframes", swap_keyframes)),
              "layer.stars.render.core: expected ascending frames, each once, found others");
    const auto fails = [](Scene& s) {
        s.camera.fov = 10.0;
        throw std::runtime_error("own error");
    };
    EXPECT_THROW(document.edit("Own", fails), std::runtime_error);
    EXPECT_EQ(document.scene(), before);
    EXPECT_EQ(document.revision(), revision);
    EXPECT_FALSE(document.can_undo());
}

TEST_F(DocumentTest, SettingAKeyedParameterSetsItsKey) {
    const std::string core = "layer.stars.render.core";
    document.set(core, 0.75, 12.0);
    const Track& track = *find_track(document.scene(), core);
    ASSERT_EQ(track.keyframes.size(), 3u);
    EXPECT_EQ(track.keyframes[1].frame, 12.0);
    EXPECT_EQ(track.keyframes[1].value, std::vector<double>{0.75});
    EXPECT_EQ(value_of(document, core), Value(0.5));  // the value below the track
    document.undo();
    EXPECT_EQ(find_track(document.scene(), core)->keyframes.size(), 2u);
}

TEST_F(DocumentTest, ResetGivesTheDefaultAndEndsTheAnimation) {
    document.reset("layer.stars.render.core");
    EXPECT_FALSE(is_animated(document.scene(), "layer.stars.render.core"));
    document.reset(opacity);
    EXPECT_EQ(value_of(document, opacity), Value(1.0));
    EXPECT_EQ(document.undo_name(), "Reset Opacity of stars");
    document.reset("layer.dust.look.noise.0.cull");
    EXPECT_EQ(value_of(document, "layer.dust.look.noise.0.cull"), Value(0.0));
}

TEST_F(DocumentTest, RenamingALayerTakesItsTracksAlong) {
    document.set("layer.stars.name", "suns", 1.0);
    EXPECT_TRUE(is_animated(document.scene(), "layer.suns.render.core"));
    document.save();
    EXPECT_EQ(load_scene(f.file), document.scene());
}

TEST_F(DocumentTest, TracksOfRemovedElementsGo) {
    document.edit("Remove noise", [](Scene& s) { s.layers[0].look.noise.pop_back(); });
    EXPECT_FALSE(is_animated(document.scene(), "layer.dust.look.noise.1.jitter"));
    document.save();
    EXPECT_EQ(load_scene(f.file), document.scene());
}

TEST_F(DocumentTest, AListGrowsForItsNextElement) {
    document.set("layer.stars.look.noise.cull", 0.5, 1.0);
    ASSERT_EQ(document.scene().layers[1].look.noise.size(), 1u);
    EXPECT_EQ(document.scene().layers[1].look.noise[0].cull, 0.5f);
}

TEST_F(DocumentTest, TypedPathsAreRelativeToTheScene) {
    document.set("layer.dust.look.thickness.map", "neue karte.png", 1.0);
    EXPECT_EQ(document.scene().layers[0].look.thickness.map, f.folder / "neue karte.png");
    document.save();
    EXPECT_HAS(f.text(), "map = \"neue karte.png\"");
}

TEST_F(DocumentTest, SavingTouchesOnlyWhatChanged) {
    document.set(opacity, 0.25, 1.0);
    document.save();
    EXPECT_EQ(f.text(), test::replaced(edit_scene, "opacity = 0.5", "opacity = 0.25"));
    EXPECT_FALSE(document.edited());
    EXPECT_FALSE(document.changed_on_disk());
    document.undo();
    EXPECT_TRUE(document.edited());
    document.save();
    EXPECT_EQ(f.text(), edit_scene);
}

TEST_F(DocumentTest, WhatWasSavedIsSavedAgainByteForByte) {
    document.set("layer.dust.look.radius.vertical_scale", Value(0.5), 1.0);  // a line that was not there
    document.save();
    const std::string edited = f.text();
    EXPECT_NE(edited, edit_scene);
    document.undo();
    document.save();
    EXPECT_EQ(f.text(), edit_scene);
    document.redo();
    document.save();
    EXPECT_EQ(f.text(), edited);

    f.folder.file("szene ä.toml", edited + "# from other hands\n");
    document.reload();
    document.undo();
    document.save();
    EXPECT_HAS(f.text(), "# from other hands");
}

TEST_F(DocumentTest, SavingElsewhereMovesTheDocument) {
    document.set(opacity, 0.25, 1.0);
    fs::create_directories(f.folder / "neu ü");
    const fs::path target = f.folder / "neu ü/zweite szene.toml";
    const std::string text = document.text_for(target);
    document.save_as(target);
    EXPECT_EQ(f.text(), edit_scene);
    EXPECT_EQ(document.file(), target);
    EXPECT_FALSE(document.edited());
    EXPECT_EQ(load_scene(target), document.scene());
    EXPECT_EQ(load_scene(target).layers[0].source.meshes[0].texture[0], f.folder / "Bilder/m 51 ä.png");
    EXPECT_HAS(text, "# by hand, keep this");
    document.undo();  // the old scene, but of the new file
    EXPECT_EQ(document.scene().file, target);
    EXPECT_TRUE(document.edited());
    document.save();
    EXPECT_EQ(load_scene(target), document.scene());
}

TEST_F(DocumentTest, SavingElsewhereKeepsWhereFramesGo) {
    const auto place = [&] {
        return (document.file().parent_path() / document.scene().output.path).lexically_normal();
    };
    const fs::path before = place();
    fs::create_directories(f.folder / "neu ü");
    document.save_as(f.folder / "neu ü/zweite szene.toml");
    EXPECT_EQ(place(), before);
    EXPECT_EQ(load_scene(document.file()).output.path, document.scene().output.path);
    document.save_as(f.folder / "neu ü/dritte szene.toml");
    EXPECT_EQ(place(), before);
}

TEST(UntitledDocument, UntitledAsksForAFile) {
    const TempFolder folder;
    Document document = Document::untitled(edit_scene, folder / "untitled.toml");
    EXPECT_EQ(document.name(), "Untitled");
    EXPECT_TRUE(document.file().empty());
    EXPECT_FALSE(document.edited());
    EXPECT_FALSE(document.changed_on_disk());
    EXPECT_EQ(ERROR_OF(document.save()), "Untitled: expected a file to save to, found none");
    EXPECT_EQ(ERROR_OF(document.reload()), "Untitled: expected a file to read again, found none");
    document.set(opacity, 0.25, 1.0);
    EXPECT_TRUE(document.edited());
    document.save_as(folder / "szene.toml");
    EXPECT_EQ(document.name(), "szene.toml");
    EXPECT_FALSE(document.edited());
    EXPECT_EQ(load_scene(folder / "szene.toml"), document.scene());
}

TEST_F(DocumentTest, AFileThatCannotBeWrittenLeavesTheDocument) {
    document.set(opacity, 0.25, 1.0);
    const fs::path blocked = f.file / "inside a file.toml";
    EXPECT_EQ(message_of<OutputError>([&] { document.save_as(blocked); }),
              blocked.string() + ": cannot be written: Not a directory");
    EXPECT_EQ(document.file(), f.file);
    EXPECT_TRUE(document.edited());
    document.save();
    EXPECT_FALSE(document.edited());
}

TEST_F(DocumentTest, AFailedSaveAsLeavesNoEdit) {
    document.set(opacity, 0.25, 1.0);
    document.undo();
    const Scene before = document.scene();
    const std::uint64_t revision = document.revision();
    EXPECT_THROW(document.save_as(f.folder / "no such folder/szene.toml"), OutputError);
    EXPECT_EQ(document.scene(), before);
    EXPECT_EQ(document.revision(), revision);
    EXPECT_FALSE(document.edited());
    EXPECT_TRUE(document.can_redo() && !document.can_undo());
}

TEST_F(DocumentTest, AssignmentsAreEdits) {
    const std::vector<Assignment> assignments{{opacity, "0.25"}, {"layer.dust.look.alpha", "{power=3}"}};
    document = Document::open(f.file, assignments);
    EXPECT_EQ(document.scene(), load_scene(f.file, assignments));
    EXPECT_TRUE(document.edited());
    EXPECT_FALSE(document.can_undo());
    EXPECT_TRUE(document.set_by_command_line(opacity));
    EXPECT_TRUE(document.set_by_command_line("layer.dust.look.alpha.power"));
    EXPECT_FALSE(document.set_by_command_line("layer.dust.look.density"));
    EXPECT_FALSE(document.set_by_command_line("layer.stars.render.core"));
    document.set(opacity, 0.3, 1.0);
    EXPECT_FALSE(document.set_by_command_line(opacity));
    document.undo();
    EXPECT_TRUE(document.set_by_command_line(opacity));
    document.save();
    EXPECT_EQ(load_scene(f.file), document.scene());
    EXPECT_FALSE(document.set_by_command_line(opacity));
}

TEST_F(DocumentTest, AnAssignedListElementIsMarkedWithoutItsIndex) {
    const std::vector<Assignment> assignments{{"layer.dust.look.noise.cull", "0.25"}};
    document = Document::open(f.file, assignments);
    EXPECT_TRUE(document.set_by_command_line("layer.dust.look.noise.0.cull"));
    EXPECT_FALSE(document.set_by_command_line("layer.dust.look.noise.1.cull"));
}

TEST_F(DocumentTest, NoticesOtherHands) {
    EXPECT_FALSE(document.changed_on_disk());
    const auto time = fs::last_write_time(f.file);
    fs::last_write_time(f.file, time + std::chrono::seconds(5));
    EXPECT_FALSE(document.changed_on_disk());  // touched, but the same
    f.folder.file("szene ä.toml", test::replaced(edit_scene, "fov = 40.0", "fov = 35.0"));
    fs::last_write_time(f.file, time + std::chrono::seconds(10));
    EXPECT_TRUE(document.changed_on_disk());
    EXPECT_TRUE(document.changed_on_disk());
    document.ignore_change_on_disk();
    EXPECT_FALSE(document.changed_on_disk());
    fs::remove(f.file);
    EXPECT_FALSE(document.changed_on_disk());
}

TEST_F(DocumentTest, ReloadIsOneStep) {
    document.set(opacity, 0.25, 1.0);
    const Scene mine = document.scene();
    f.folder.file("szene ä.toml", test::replaced(edit_scene, "fov = 40.0", "fov = 35.0"));
    document.reload();
    EXPECT_EQ(document.scene(), load_scene(f.file));
    EXPECT_FALSE(document.edited());
    EXPECT_FALSE(document.changed_on_disk());
    EXPECT_EQ(document.undo_name(), "Reload");
    document.undo();
    EXPECT_EQ(document.scene(), mine);
    EXPECT_TRUE(document.edited());
    document.save();
    EXPECT_EQ(load_scene(f.file), mine);
}

TEST_F(DocumentTest, AReloadThatFailsChangesNothing) {
    const Scene before = document.scene();
    f.folder.file("szene ä.toml", "astrosplat = 1\n[camera]\nfov = \"wide\"\n");
    EXPECT_EQ(ERROR_OF(document.reload()),
              f.file.string() + ":3: camera.fov: expected a number, found a string");
    EXPECT_EQ(document.scene(), before);
    EXPECT_FALSE(document.can_undo());
}

TEST_F(DocumentTest, ReloadKeepsAssignmentsThatWereNotSaved) {
    const std::vector<Assignment> assignments{{opacity, "0.25"}};
    document = Document::open(f.file, assignments);
    document.reload();
    EXPECT_EQ(value_of(document, opacity), Value(0.25));
    document.save();
    f.folder.file("szene ä.toml", edit_scene);
    document.reload();
    EXPECT_EQ(value_of(document, opacity), Value(0.5));
}

TEST_F(DocumentTest, ACommaLocaleChangesNothing) {
    const CommaLocale comma;
    document = Document::open(f.file);
    document.set(opacity, 0.125, 1.0);
    document.set("layer.dust.source.count", std::int64_t{1234567}, 1.0);
    document.save();
    EXPECT_HAS(f.text(), "opacity = 0.125");
    EXPECT_HAS(f.text(), "count = 1234567");
    EXPECT_EQ(load_scene(f.file), document.scene());
}

TEST_F(DocumentTest, ValuesOfOtherTypesAreAsInTheFile) {
    document.set("output.depth", std::int64_t{16}, 1.0);
    EXPECT_EQ(value_of(document, "output.depth"), Value("16"));
    document.set("layer.dust.source.unpremultiply", true, 1.0);
    document.save();
    EXPECT_EQ(load_scene(f.file), document.scene());
}

}  // namespace
}  // namespace astrosplat

// Files kept next to a scene: autosaves and snapshots.
#include <signal.h>
#include <sys/wait.h>

#include "core/log.h"
#include "edit/edits.h"
#include "edit/kept_files.h"
#include "edit/layers.h"
#include "scenes.h"
#include "support/run_program.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Autosave and recovery, with a process that is really killed.

using std::chrono::seconds;
using test::opacity;
using test::SceneFolder;

const Autosave::Clock::time_point start{};

std::size_t files_in(const fs::path& folder) {
    std::error_code ignored;
    return std::size_t(std::distance(fs::directory_iterator(folder, ignored), fs::directory_iterator()));
}

struct AutosaveTest : testing::Test {
    SceneFolder f;
    fs::path folder = f.folder / "zustand ä" / "autosave";
    Document document = Document::open(f.file);
};

TEST_F(AutosaveTest, WritesAMinuteAfterTheFirstEdit) {
    Autosave autosave(folder);
    autosave.update(document, start);
    EXPECT_FALSE(fs::exists(folder));
    document.set(opacity, 0.25, 1.0);
    autosave.update(document, start + seconds(100));
    autosave.update(document, start + seconds(159));
    EXPECT_TRUE(autosave.file().empty());
    autosave.update(document, start + seconds(160));
    ASSERT_FALSE(autosave.file().empty());
    EXPECT_EQ(autosave.file().parent_path(), folder);
    EXPECT_EQ(autosave.file().filename().string().rfind("szene ä-", 0), 0u);
    Scene loaded = load_scene(autosave.file());  // loads from where it lies
    loaded.file = f.file;
    EXPECT_EQ(loaded, document.scene());
    EXPECT_EQ(f.text(), test::edit_scene);

    const auto time = fs::last_write_time(autosave.file());
    autosave.update(document, start + seconds(400));  // nothing new
    EXPECT_EQ(fs::last_write_time(autosave.file()), time);
    document.set(opacity, 0.75, 1.0);
    autosave.update(document, start + seconds(500));
    autosave.update(document, start + seconds(560));
    EXPECT_EQ(load_scene(autosave.file()).layers[1].render.opacity, 0.75f);
}

TEST_F(AutosaveTest, GoesWhenNothingIsLeftToSave) {
    Autosave autosave(folder);
    document.set(opacity, 0.25, 1.0);
    ASSERT_TRUE(autosave.write(document));
    EXPECT_EQ(files_in(folder), 2u);  // and its lock
    document.save();
    autosave.update(document, start);
    EXPECT_EQ(files_in(folder), 0u);
    document.set(opacity, 0.75, 1.0);
    ASSERT_TRUE(autosave.write(document));
    document.undo();
    autosave.update(document, start);
    EXPECT_EQ(files_in(folder), 0u);
}

TEST_F(AutosaveTest, GoesWhenTheWindowCloses) {
    document.set(opacity, 0.25, 1.0);
    {
        Autosave autosave(folder);
        ASSERT_TRUE(autosave.write(document));
    }
    EXPECT_EQ(files_in(folder), 0u);
}

TEST_F(AutosaveTest, StaysWhenAnExceptionEndsTheProgram) {
    document.set(opacity, 0.25, 1.0);
    try {
        Autosave autosave(folder);
        autosave.write(document);
        throw std::runtime_error("the program's own fault");
    } catch (const std::runtime_error&) {
    }
    EXPECT_EQ(files_in(folder), 1u);
}

TEST_F(AutosaveTest, ALivingProcessIsNotRecovered) {
    document.set(opacity, 0.25, 1.0);
    Autosave autosave(folder);
    ASSERT_TRUE(autosave.write(document));
    EXPECT_TRUE(recoveries(folder).empty());
}

/// Of processes that are gone, in an order that neither names nor the folder give.
TEST_F(AutosaveTest, TheNewestRecoveryComesFirst) {
    const auto leave = [&](const std::string& name, const std::string& time) {
        fs::create_directories(folder);
        std::ofstream(folder / (name + "-999999999-0.toml"))
            << R"(# astrosplat autosave {"file":"/scene.toml","titled":true,"time":")" << time << "\"}\n";
    };
    leave("b", "2026-05-01 12:30:00");
    leave("a", "2026-05-01 12:29:59");
    leave("c", "2025-12-31 23:59:59");
    leave("d", "2026-05-02 00:00:00");
    std::vector<std::string> times;
    for (const Recovery& recovery : recoveries(folder)) times.push_back(recovery.time);
    EXPECT_EQ(times, (std::vector<std::string>{"2026-05-02 00:00:00", "2026-05-01 12:30:00",
                                               "2026-05-01 12:29:59", "2025-12-31 23:59:59"}));
}

TEST_F(AutosaveTest, AFolderThatCannotBeWrittenCostsOneWarning) {
    document.set(opacity, 0.25, 1.0);
    const Said said;
    Autosave autosave(f.file / "inside a file");
    EXPECT_FALSE(autosave.write(document));
    EXPECT_FALSE(autosave.write(document));
    EXPECT_HAS(said.one_warning(), "no autosave of szene ä.toml: ");
    EXPECT_TRUE(recoveries(f.file / "inside a file").empty());
    EXPECT_TRUE(recoveries(f.folder / "missing").empty());
}

/// Runs `work` in a process of its own and kills it when it says it is ready: `ready` does not return there.
template <class Work>
void killed_process(const Work& work) {
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        work([&](bool good) {
            const char done = good ? 'y' : 'n';
            if (write(ready[1], &done, 1) != 1) _exit(1);
            for (;;) pause();
        });
        _exit(1);
    }
    close(ready[1]);
    char done = 0;
    EXPECT_EQ(read(ready[0], &done, 1), 1);
    EXPECT_EQ(done, 'y');
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    close(ready[0]);
}

TEST_F(AutosaveTest, AKilledProcessIsRecovered) {
    killed_process([&](const auto& ready) {
        Document edited = Document::open(f.file);
        edited.set(opacity, 0.25, 1.0);
        edited.set("output.path", "neue bilder/a.####.exr", 1.0);
        Autosave autosave(folder);
        ready(autosave.write(edited) && recoveries(folder).empty());
    });
    const std::vector<Recovery> found = recoveries(folder);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].original, f.file);
    EXPECT_TRUE(found[0].titled);
    EXPECT_EQ(found[0].name(), "szene ä.toml");
    EXPECT_EQ(found[0].time.size(), 19u);

    Document recovered = recover(found[0].autosave);
    EXPECT_EQ(recovered.file(), f.file);
    EXPECT_TRUE(recovered.edited());
    EXPECT_FALSE(recovered.can_undo());
    Document wanted = Document::open(f.file);
    wanted.set(opacity, 0.25, 1.0);
    wanted.set("output.path", "neue bilder/a.####.exr", 1.0);
    EXPECT_EQ(recovered.scene(), wanted.scene());
    recovered.save();
    const std::string text = f.text();
    EXPECT_EQ(text.rfind("# by hand, keep this\n", 0), 0u);  // saved into the original, as if edited there
    EXPECT_HAS(text, "Bilder/m 51 ä.png");
    EXPECT_EQ(text.find(f.folder.path().string()), std::string::npos);
    EXPECT_EQ(load_scene(f.file), wanted.scene());

    discard_recovery(found[0].autosave);
    EXPECT_EQ(files_in(folder), 0u);
}

TEST_F(AutosaveTest, AnUntitledSceneIsRecoveredUntitled) {
    const fs::path place = f.folder / "m 51 ä.toml";
    killed_process([&](const auto& ready) {
        Document edited = Document::untitled(test::edit_scene, place);
        edited.set(opacity, 0.25, 1.0);
        Autosave autosave(folder);
        ready(autosave.write(edited));
    });
    const std::vector<Recovery> found = recoveries(folder);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_FALSE(found[0].titled);
    EXPECT_EQ(found[0].name(), "m 51 ä (never saved)");
    Document recovered = recover(found[0].autosave);
    EXPECT_EQ(recovered.name(), "Untitled");
    EXPECT_EQ(recovered.scene().file, place);
    EXPECT_TRUE(recovered.edited());
    recovered.save_as(f.folder / "gerettet.toml");
    EXPECT_EQ(load_scene(f.folder / "gerettet.toml"), recovered.scene());
    EXPECT_EQ(recovered.scene().layers[1].render.opacity, 0.25f);
    EXPECT_EQ(recovered.scene().layers[0].source.meshes[0].texture[0], f.folder / "Bilder/m 51 ä.png");
}

TEST_F(AutosaveTest, TheOriginalMayBeGone) {
    killed_process([&](const auto& ready) {
        document.set(opacity, 0.25, 1.0);
        Autosave autosave(folder);
        ready(autosave.write(document));
    });
    fs::remove(f.file);
    Document recovered = recover(recoveries(folder).at(0).autosave);
    recovered.save();
    EXPECT_EQ(load_scene(f.file), recovered.scene());
    EXPECT_HAS(f.text(), "# by hand, keep this");
}

TEST_F(AutosaveTest, APresetThatIsGoneLosesNothing) {
    const fs::path preset = f.folder.file("vorlage.toml", "[look]\ndensity = 0.5\n");
    document.set("layer.stars.preset", preset.string(), 1.0);
    document.save();
    fs::remove(preset);
    document.set(opacity, 0.25, 1.0);
    EXPECT_EQ(ERROR_OF(document.save()),
              preset.string() +
                  ": cannot be read: No such file or directory; the looks that come with astrosplat are "
                  "in " ASTROSPLAT_SOURCE_DIR "/assets/looks, by name: m51, s106");
    Autosave autosave(folder);
    ASSERT_TRUE(autosave.write(document));
    Scene loaded = load_scene(autosave.file());
    EXPECT_EQ(loaded.layers[1].look, document.scene().layers[1].look);
    EXPECT_EQ(loaded.layers[1].render, document.scene().layers[1].render);
}

TEST_F(AutosaveTest, OtherFilesAreNoAutosaves) {
    fs::create_directories(folder);
    std::ofstream(folder / "a-1-0.toml") << test::edit_scene;
    std::ofstream(folder / "b-1-0.toml") << "# astrosplat autosave {\"file\": 3}\n";
    std::ofstream(folder / "c-1-0.toml") << "# astrosplat autosave nonsense\n";
    EXPECT_TRUE(recoveries(folder).empty());
    EXPECT_EQ(ERROR_OF(recover(folder / "a-1-0.toml")),
              (folder / "a-1-0.toml").string() + ": expected an autosave, found another file");
}

// Snapshots: stored looks, and the folder that holds them beside their scene.

// Stored looks: what they bring back, what they leave.

const std::string power = "layer.dust.look.alpha.power";

struct Snapshots : testing::Test {
    test::SceneFolder f;
    Document document = Document::open(f.file);
    StoredLook first = store_look({"Erster Blick", 1.0}, document);
};

TEST_F(Snapshots, HoldTheMoment) {
    const StoredLook later = store_look({"Later", 12.0}, document);
    document.set(opacity, 0.25, 1.0);
    EXPECT_EQ(later.name, "Later");
    EXPECT_EQ(later.frame, 12.0);
    EXPECT_EQ(*later.scene, load_scene(f.file));
}

TEST_F(Snapshots, RestoreIsOneStepThatBringsTheLookBack) {
    const Scene before = document.scene();
    document.set(opacity, 0.25, 1.0);
    document.set(power, 5.0, 1.0);
    document.set("layer.dust.visible", false, 1.0);
    document.set("output.exposure", 2.0, 1.0);
    document.edit("Keyframes", [](Scene& s) { set_keyframe(s, power, 3.0, 4.0); });
    document.edit("Keyframes", [](Scene& s) { remove_track(s, "layer.stars.render.core"); });
    restore_look(document, first);
    Scene restored = document.scene();
    EXPECT_EQ(restored.layers, before.layers);
    EXPECT_EQ(restored.output.exposure, 0.0);
    EXPECT_FALSE(is_animated(restored, power));
    EXPECT_EQ(*find_track(restored, "layer.stars.render.core"),
              *find_track(before, "layer.stars.render.core"));
    EXPECT_EQ(document.undo_name(), "Restore Erster Blick");
    document.undo();
    EXPECT_EQ(test::value_of(document, power), Value(5.0));
    document.save();
    EXPECT_EQ(load_scene(f.file), document.scene());
}

TEST_F(Snapshots, WhatIsNoLookStays) {
    document.set("camera.fov", 20.0, 1.0);
    document.set("layer.dust.source.count", std::int64_t{5000}, 1.0);
    document.set("layer.stars.transform.scale", 3.0, 1.0);
    document.set("output.frames", "7", 1.0);
    document.edit("Keyframes", [](Scene& s) { set_keyframe(s, "camera.fov", 3.0, 30.0); });
    const Scene before = document.scene();
    restore_look(document, first);
    EXPECT_EQ(document.scene(), before);
}

TEST_F(Snapshots, LayersAreMatchedByName) {
    document.edit("Layers", [](Scene& s) {
        duplicate_layer(s, 1);
        move_layer(s, 0, 2);
        rename_layer(s, 2, "gas");
        for (LayerParams& layer : s.layers) layer.look.density = 0.125f;
    });
    restore_look(document, first);
    Scene scene = document.scene();
    EXPECT_EQ(test::layer(scene, "stars").look.density, 1.0f);
    EXPECT_EQ(test::layer(scene, "stars_2").look.density, 0.125f);
    EXPECT_EQ(test::layer(scene, "gas").look.density, 0.125f);
    EXPECT_TRUE(is_animated(scene, "layer.gas.look.noise.1.jitter"));
    EXPECT_FALSE(is_animated(scene, "layer.dust.look.noise.1.jitter"));
}

// Snapshots in the folder beside their scene: what is written is read again, and nothing is lost where one of
// them is broken.

struct SnapshotFiles : testing::Test {
    test::SceneFolder f;
    Document document = Document::open(f.file);
    fs::path folder = snapshot_folder(f.file);
    const SnapshotFacts facts{"Wärmer \"rot\"", 12.5, 3100000, 1.75};
    std::vector<std::string> problems;

    fs::path write(const SnapshotFacts& about) const {
        return write_snapshot(folder, about, document.scene(), "png");
    }
};

TEST_F(SnapshotFiles, WhatIsWrittenIsReadAgain) {
    document.set(test::opacity, 0.25, 1.0);
    const fs::path file = write(facts);
    EXPECT_EQ(file, folder / "0001.toml");
    const std::vector<StoredLook> kept = read_snapshots(folder, problems);
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_TRUE(problems.empty());
    EXPECT_EQ(kept[0].file, file);
    EXPECT_EQ(static_cast<const SnapshotFacts&>(kept[0]), facts);
    EXPECT_EQ(with_look_of(load_scene(f.file), *kept[0].scene), document.scene());
    EXPECT_EQ(test::text_of(snapshot_image(file)), "png");
}

TEST_F(SnapshotFiles, ASnapshotIsASceneThatNamesTheSameFiles) {
    const Scene kept = load_scene(write(facts));
    Scene expected = document.scene();
    expected.file = kept.file;
    EXPECT_EQ(kept, expected);
}

TEST_F(SnapshotFiles, ANewOneComesAfterTheLastAndOverwritesNone) {
    write(facts);
    const fs::path second = write({"zwei"});
    write({"drei"});
    remove_snapshot(second);
    EXPECT_FALSE(fs::exists(snapshot_image(second)));
    EXPECT_EQ(write({"vier"}), folder / "0004.toml");
    std::vector<std::string> names;
    for (const StoredLook& kept : read_snapshots(folder, problems)) names.push_back(kept.name);
    EXPECT_EQ(names, (std::vector<std::string>{facts.name, "drei", "vier"}));
}

TEST_F(SnapshotFiles, AnotherNameChangesNothingElse) {
    const fs::path file = write(facts);
    const Scene before = load_scene(file);
    rename_snapshot(file, "Kälter\nblau");
    const std::vector<StoredLook> kept = read_snapshots(folder, problems);
    ASSERT_EQ(kept.size(), 1u);
    SnapshotFacts renamed = facts;
    renamed.name = "Kälter\nblau";
    EXPECT_EQ(static_cast<const SnapshotFacts&>(kept[0]), renamed);
    EXPECT_EQ(*kept[0].scene, before);
}

TEST_F(SnapshotFiles, ABrokenOneIsReportedAndTheOthersAreThere) {
    write(facts);
    test::write_text(folder / "0002.toml", "astrosplat = 1\n");
    test::write_text(folder / "0003.toml", "# astrosplat snapshot {\"name\": \n");
    std::string text = test::text_of(folder / "0001.toml");
    text.insert(text.find("opacity"), "opacty = 1\n");
    test::write_text(folder / "0004.toml", text);
    test::write_text(folder / "notes.txt", "mine");
    EXPECT_EQ(read_snapshots(folder, problems).size(), 1u);
    ASSERT_EQ(problems.size(), 3u);
    EXPECT_EQ(problems[0], (folder / "0002.toml").string() + ":1: expected a snapshot, found another file");
    EXPECT_EQ(problems[1], (folder / "0003.toml").string() + ":1: expected a snapshot, found another file");
    EXPECT_HAS(problems[2], "opacty");
    EXPECT_TRUE(fs::exists(folder / "0003.toml")) << "nothing is thrown away";
}

TEST_F(SnapshotFiles, WhereNoFolderCanBeNothingIsWritten) {
    test::write_text(folder, "a file in its place");
    EXPECT_THROW(write(facts), OutputError);
    EXPECT_TRUE(read_snapshots(folder, problems).empty());
}

TEST_F(SnapshotFiles, AMissingOneIsAnError) {
    const fs::path file = write(facts);
    fs::remove(file);
    EXPECT_THROW(rename_snapshot(file, "x"), InputError);
    EXPECT_NO_THROW(remove_snapshot(file)) << "it is gone, as was wished";
}

}  // namespace
}  // namespace astrosplat

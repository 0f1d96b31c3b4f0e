// Autosave and recovery, with a process that is really killed.
#include "edit/autosave.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/log.h"
#include "scenes.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using test::opacity;
using test::SceneFolder;

const Autosave::Clock::time_point start{};

std::size_t files_in(const fs::path& folder) {
    std::error_code ignored;
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder, ignored), fs::directory_iterator()));
}

struct AutosaveTest : testing::Test {
    SceneFolder f;
    fs::path folder = f.folder / "zustand ä" / "autosave";
};

TEST_F(AutosaveTest, WritesAMinuteAfterTheFirstEdit) {
    Document document = Document::open(f.file);
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
    Document document = Document::open(f.file);
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
    Document document = Document::open(f.file);
    document.set(opacity, 0.25, 1.0);
    {
        Autosave autosave(folder);
        ASSERT_TRUE(autosave.write(document));
    }
    EXPECT_EQ(files_in(folder), 0u);
}

TEST_F(AutosaveTest, StaysWhenAnExceptionEndsTheProgram) {
    Document document = Document::open(f.file);
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
    Document document = Document::open(f.file);
    document.set(opacity, 0.25, 1.0);
    Autosave autosave(folder);
    ASSERT_TRUE(autosave.write(document));
    EXPECT_TRUE(recoveries(folder).empty());
}

/// Of processes that are gone, in an order that neither names nor the folder give.
TEST_F(AutosaveTest, TheNewestRecoveryComesFirst) {
    const auto leave = [&](const std::string& name, const std::string& time) {
        std::filesystem::create_directories(folder);
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
    Document document = Document::open(f.file);
    document.set(opacity, 0.25, 1.0);
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel level, const std::string& line) {
        if (level == LogLevel::warning) warnings.push_back(line);
    });
    Autosave autosave(f.file / "inside a file");
    EXPECT_FALSE(autosave.write(document));
    EXPECT_FALSE(autosave.write(document));
    set_log_sink(nullptr);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("no autosave of szene ä.toml: "), std::string::npos);
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
        Document document = Document::open(f.file);
        document.set(opacity, 0.25, 1.0);
        document.set("output.path", "neue bilder/a.####.exr", 1.0);
        Autosave autosave(folder);
        ready(autosave.write(document) && recoveries(folder).empty());
    });
    const std::vector<Recovery> found = recoveries(folder);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].original, f.file);
    EXPECT_TRUE(found[0].titled);
    EXPECT_EQ(found[0].name(), "szene ä.toml");
    EXPECT_EQ(found[0].time.size(), 19u);

    Document document = recover(found[0].autosave);
    EXPECT_EQ(document.file(), f.file);
    EXPECT_TRUE(document.edited());
    EXPECT_FALSE(document.can_undo());
    Document wanted = Document::open(f.file);
    wanted.set(opacity, 0.25, 1.0);
    wanted.set("output.path", "neue bilder/a.####.exr", 1.0);
    EXPECT_EQ(document.scene(), wanted.scene());
    document.save();
    const std::string text = f.text();
    EXPECT_EQ(text.rfind("# by hand, keep this\n", 0), 0u);  // saved into the original, as if edited there
    EXPECT_NE(text.find("Bilder/m 51 ä.png"), std::string::npos);
    EXPECT_EQ(text.find(f.folder.path().string()), std::string::npos);
    EXPECT_EQ(load_scene(f.file), wanted.scene());

    discard_recovery(found[0].autosave);
    EXPECT_EQ(files_in(folder), 0u);
}

TEST_F(AutosaveTest, AnUntitledSceneIsRecoveredUntitled) {
    const fs::path place = f.folder / "m 51 ä.toml";
    killed_process([&](const auto& ready) {
        Document document = Document::untitled(test::edit_scene, place);
        document.set(opacity, 0.25, 1.0);
        Autosave autosave(folder);
        ready(autosave.write(document));
    });
    const std::vector<Recovery> found = recoveries(folder);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_FALSE(found[0].titled);
    EXPECT_EQ(found[0].name(), "m 51 ä (never saved)");
    Document document = recover(found[0].autosave);
    EXPECT_EQ(document.name(), "Untitled");
    EXPECT_EQ(document.scene().file, place);
    EXPECT_TRUE(document.edited());
    document.save_as(f.folder / "gerettet.toml");
    EXPECT_EQ(load_scene(f.folder / "gerettet.toml"), document.scene());
    EXPECT_EQ(document.scene().layers[1].render.opacity, 0.25f);
    EXPECT_EQ(document.scene().layers[0].source.meshes[0].texture[0], f.folder / "Bilder/m 51 ä.png");
}

TEST_F(AutosaveTest, TheOriginalMayBeGone) {
    killed_process([&](const auto& ready) {
        Document document = Document::open(f.file);
        document.set(opacity, 0.25, 1.0);
        Autosave autosave(folder);
        ready(autosave.write(document));
    });
    fs::remove(f.file);
    Document document = recover(recoveries(folder).at(0).autosave);
    document.save();
    EXPECT_EQ(load_scene(f.file), document.scene());
    EXPECT_NE(f.text().find("# by hand, keep this"), std::string::npos);
}

TEST_F(AutosaveTest, APresetThatIsGoneLosesNothing) {
    const fs::path preset = f.folder.file("vorlage.toml", "[look]\ndensity = 0.5\n");
    Document document = Document::open(f.file);
    document.set("layer.stars.preset", preset.string(), 1.0);
    document.save();
    fs::remove(preset);
    document.set(opacity, 0.25, 1.0);
    EXPECT_EQ(message_of<InputError>([&] { document.save(); }),
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
    EXPECT_EQ(message_of<InputError>([&] { recover(folder / "a-1-0.toml"); }),
              (folder / "a-1-0.toml").string() + ": expected an autosave, found another file");
}

}  // namespace
}  // namespace astrosplat

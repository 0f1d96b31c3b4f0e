// Folders that do not answer, as on a network's disk: the window goes on. The C library's readdir and stat
// are found behind this program's own, which the C++ library calls instead.
#include <dirent.h>
#include <dlfcn.h>
#include <sys/stat.h>

#include "gui/file_dialog.h"
#include "gui/test_window.h"
#include "gui/widgets.h"
#include "support/test.h"

namespace {
std::atomic<bool> folders_stand_still{false};

void wait_for_the_disk() {
    while (folders_stand_still) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}
}  // namespace

extern "C" dirent* readdir(DIR* folder) {
    using Read = dirent* (*)(DIR*);
    static const auto real = reinterpret_cast<Read>(dlsym(RTLD_NEXT, "readdir"));
    wait_for_the_disk();
    return real(folder);
}

extern "C" int stat(const char* file, struct stat* status) noexcept {
    using Look = int (*)(const char*, struct stat*);
    static const auto real = reinterpret_cast<Look>(dlsym(RTLD_NEXT, "stat"));
    wait_for_the_disk();
    return real(file, status);
}

namespace astrosplat {
namespace {

class SlowFolder : public testing::Test {
  protected:
    SlowFolder() {
        for (const char* name : {"scenes", "more"}) fs::create_directory(folder / name);
        folder.file("scenes/old.toml", "x");
        folder.file("more/new.toml", "x");
    }
    ~SlowFolder() override { folders_stand_still = false; }
    TempFolder folder;
};

TEST_F(SlowFolder, DoesNotStopTheWindow) {
    TestWindow window(example_document());
    const auto go_to = [&](const std::string& name) {
        window.tap('A', true);
        window.type((folder / name).string());
        window.tap(key_code::enter);
    };
    const auto wait_for = [&](const auto& condition) {
        for (int i = 0; i < 2000 && !condition(); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            window.frame();
        }
    };
    window.choose("File/Open...");
    folders_stand_still = true;
    go_to("more");
    window.type("x");  // not there, then
    go_to("scenes");
    EXPECT_FALSE(window.has("file/old.toml")) << "and no frame waited, or this one would for ever";
    folders_stand_still = false;
    wait_for([&] { return window.has("file/old.toml"); });
    EXPECT_FALSE(window.has("file/new.toml")) << "the last folder asked for";
    folders_stand_still = true;
    window.type("o");
    window.tap(key_code::tab);
    folders_stand_still = false;
    for (int i = 0; i < 100; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        window.frame();
    }
    folders_stand_still = true;
    window.tap(key_code::enter);  // old.toml, once the disk knows it
    EXPECT_TRUE(window.take_commands().empty());
    folders_stand_still = false;
    Commands commands;
    wait_for([&] { return !(commands = window.take_commands()).empty(); });
    ASSERT_EQ(commands.size(), 1U);
    EXPECT_EQ(commands[0].path, folder / "scenes/old.toml");
}

TEST_F(SlowFolder, IsLeftToItselfByWhoAsks) {
    const auto read = [&](const std::string& name) {
        return [path = folder / name, otherwise = folder / "scenes"](const std::atomic<bool>& forgotten) {
            return read_folder(path, otherwise, {".toml"}, forgotten);
        };
    };
    folders_stand_still = true;
    {
        DiskQuestion<FolderContents> question;
        EXPECT_FALSE(question.is_open());
        question.begin(read("more"));
        EXPECT_FALSE(question.take());
        EXPECT_TRUE(question.is_open());
    }
    folders_stand_still = false;
    DiskQuestion<FolderContents> question;
    question.begin(read("none"));
    std::optional<FolderContents> found;
    for (int i = 0; i < 12000 && !(found = question.take()); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->folder, folder / "scenes");
    EXPECT_EQ(found->entries.size(), 1U);
    EXPECT_FALSE(question.is_open());
    EXPECT_FALSE(question.take());
}

}  // namespace
}  // namespace astrosplat

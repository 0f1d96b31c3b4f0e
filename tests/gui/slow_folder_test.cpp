// Folders that do not answer, as on a network's disk: the window goes on. The C library's readdir is found
// behind this program's own, which the C++ library calls instead.
#include <dirent.h>
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "gui/folder_reader.h"
#include "gui/key_codes.h"
#include "gui/test_window.h"
#include "support/temp_folder.h"

namespace {
std::atomic<bool> folders_stand_still{false};
}

extern "C" dirent* readdir(DIR* folder) {
    using Read = dirent* (*)(DIR*);
    static const auto real = reinterpret_cast<Read>(dlsym(RTLD_NEXT, "readdir"));
    while (folders_stand_still) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return real(folder);
}

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

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
        window.frame(2);
    };
    window.choose("File/Open...");
    window.frame(2);
    folders_stand_still = true;
    const auto begun = std::chrono::steady_clock::now();
    go_to("more");
    EXPECT_FALSE(window.has("file/new.toml"));
    go_to("scenes");
    window.tap(key_code::tab);  // nothing to complete with
    EXPECT_FALSE(window.has("file/old.toml"));
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(20));
    folders_stand_still = false;
    for (int i = 0; i < 2000 && !window.has("file/old.toml"); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        window.frame();
    }
    EXPECT_FALSE(window.has("file/new.toml")) << "the last folder asked for";
    window.click("file/old.toml");
    window.click("file/Open");
    EXPECT_EQ(window.take_commands().at(0).path, folder / "scenes/old.toml");
}

TEST_F(SlowFolder, IsLeftToItselfByItsReader) {
    folders_stand_still = true;
    {
        FolderReader reader;
        EXPECT_FALSE(reader.reading());
        reader.begin(folder.path(), "/", {});
        EXPECT_FALSE(reader.take());
        EXPECT_TRUE(reader.reading());
    }
    folders_stand_still = false;
    FolderReader reader;
    reader.begin(folder / "none", folder / "scenes", {".toml"});
    const auto found = reader.take(std::chrono::seconds(60));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->folder, folder / "scenes");
    EXPECT_EQ(found->entries.size(), 1U);
    EXPECT_FALSE(reader.reading());
    EXPECT_FALSE(reader.take());
}

}  // namespace
}  // namespace astrosplat

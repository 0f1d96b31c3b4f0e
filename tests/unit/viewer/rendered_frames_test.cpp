// Frames from disk for playing: read in the background, again when they change, within bounds.
#include "viewer/rendered_frames.h"

#include <gtest/gtest.h>

#include <thread>

#include "source/write_image.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

struct RenderedFramesTest : testing::Test {
    TempFolder folder;
    /// One colour all over.
    fs::path write(const std::string& name, unsigned char level, int side = 8) {
        const fs::path file = folder.path() / name;
        std::vector<unsigned char> rgba;
        for (int i = 0; i < side * side; ++i) rgba.insert(rgba.end(), {level, level, level, 255});
        write_image(file, side, side, rgba);
        return file;
    }
    static std::shared_ptr<const RenderedFrame8> read(RenderedFrames& frames, const fs::path& file) {
        while (frames.working()) std::this_thread::yield();
        return frames.found(file);
    }
};

TEST_F(RenderedFramesTest, AreReadAheadAndLookAsTheFilesDo) {
    const fs::path one = write("a.0001.png", 40), two = write("a.0002.png", 200);
    RenderedFrames frames;
    frames.want({one, two});
    ASSERT_TRUE(read(frames, two));
    EXPECT_EQ(frames.found(one)->width, 8);
    EXPECT_EQ(frames.found(one)->rgba[0], 40);
    EXPECT_EQ(frames.found(two)->rgba[0], 200);
    EXPECT_FLOAT_EQ(to_image(*frames.found(two)).at(3, 3)[0], 200.0f / 255.0f);
}

TEST_F(RenderedFramesTest, AreReadAgainWhenTheFileChanges) {
    const fs::path file = write("a.0001.png", 40);
    RenderedFrames frames;
    frames.want({file});
    const auto before = read(frames, file);
    frames.want({file});
    EXPECT_EQ(read(frames, file), before) << "not for nothing";
    write("a.0001.png", 90);
    fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(5));
    frames.want({file});
    EXPECT_EQ(read(frames, file)->rgba[0], 90);
    fs::remove(file);
    frames.want({file});
    EXPECT_FALSE(read(frames, file));
}

TEST_F(RenderedFramesTest, ThatAreBrokenSayWhy) {
    const fs::path file = folder.path() / "a.0001.png";
    std::ofstream(file) << "no picture";
    RenderedFrames frames;
    frames.want({file});
    EXPECT_FALSE(read(frames, file)->error.empty());
}

TEST_F(RenderedFramesTest, AreForgottenBeyondTheirMemory) {
    const fs::path one = write("a.0001.png", 1, 64), two = write("a.0002.png", 2, 64);
    RenderedFrames frames(64, 20'000);  // one of 16 KiB
    for (const fs::path& file : {one, two}) {
        frames.want({file});
        read(frames, file);
    }
    frames.want({two});
    EXPECT_FALSE(frames.found(one));
    EXPECT_TRUE(frames.found(two));
}

}  // namespace
}  // namespace astrosplat

// Frames from disk for playing: read in the background, again when they change, within bounds.
#include "viewer/file_pictures.h"

#include <gtest/gtest.h>

#include <thread>

#include "output/write.h"
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
    static std::shared_ptr<const PackedPicture> read(RenderedFrames& frames, const fs::path& file) {
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
    EXPECT_EQ(frames.found(one)->codes[0], 40);
    EXPECT_EQ(frames.found(two)->codes[0], 200);
    EXPECT_FLOAT_EQ(to_image(*frames.found(two)).at(3, 3)[0], 200.0f / 255.0f);
}

/// The view is not in them, so that another one needs no file.
TEST_F(RenderedFramesTest, OfSceneLightStayLight) {
    Image light = make_image(8, 8, 4, 1.0f);
    for (std::size_t i = 0; i < light.pixels.size(); i += 4) {
        light.pixels[i] = 0.2f;
        light.pixels[i + 1] = 3.5f;
        light.pixels[i + 2] = -0.25f;
    }
    write_linear_image(folder / "a.0001.exr", light, "", Existing::replace);
    RenderedFrames frames;
    frames.want({folder / "a.0001.exr"});
    const auto found = read(frames, folder / "a.0001.exr");
    ASSERT_TRUE(found && found->is_light()) << found->error;
    const Image image = to_image(*found);
    EXPECT_NEAR(image.at(3, 3)[0], 0.2f, 1e-4f);
    EXPECT_EQ(image.at(3, 3)[1], 3.5f);
    EXPECT_EQ(image.at(3, 3)[2], -0.25f);
}

TEST_F(RenderedFramesTest, OfOtherPrimariesAreToldInThoseOfTheViewport) {
    OutputParams output;
    output.width = output.height = 8;
    output.path = (folder / "a.####.exr").string();
    output.primaries = OutputParams::Primaries::acescg;
    RenderedFrame frame;
    frame.beauty = make_image(8, 8, 4, 1.0f);
    for (std::size_t i = 0; i < frame.beauty.pixels.size(); i += 4) frame.beauty.pixels[i] = 0.125f;
    FrameFile file;
    file.file = folder / "a.0001.exr";
    file.output = output;
    file.whole_width = file.whole_height = 8;
    write_frame(file, frame, FrameMetadata());
    RenderedFrames frames;
    frames.want({file.file});
    const auto found = read(frames, file.file);
    ASSERT_TRUE(found && found->is_light()) << found->error;
    EXPECT_NEAR(to_image(*found).at(3, 3)[0], 0.125f, 2e-3f);
    EXPECT_NEAR(to_image(*found).at(3, 3)[1], 1.0f, 2e-3f);
}

/// A frame of the queue, as the viewport would show it.
TEST_F(RenderedFramesTest, FinishedOnesAreSeenThroughTheView) {
    Image light = make_image(8, 8, 4, 0.2f);
    write_linear_image(folder / "a.exr", light, "", Existing::replace);
    const auto level = [&](OutputParams::View view, double exposure, const fs::path& file) {
        return static_cast<int>(
            std::lround(255.0f * *finished_view({file, view, nullptr, exposure}, 64).image.at(3, 3)));
    };
    using View = OutputParams::View;
    EXPECT_NEAR(level(View::linear, 1.0, folder / "a.exr"), 102, 1);
    EXPECT_NEAR(level(View::srgb, 0.0, folder / "a.exr"), 124, 1);
    const fs::path seen = write("a.0001.png", 90);
    EXPECT_EQ(level(View::linear, 1.0, seen), 90) << "which is a view already";
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
    EXPECT_EQ(read(frames, file)->codes[0], 90);
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

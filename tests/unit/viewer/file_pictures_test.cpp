// Picture files, small: how each kind looks, frames that play, what is read again, kept and let go.
#include "viewer/files.h"

#include "core/log.h"
#include "output/write.h"
#include "source/write_image.h"
#include "support/fits_text.h"
#include "support/test.h"

namespace astrosplat {
namespace {

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
    static std::shared_ptr<const PackedImage> read(RenderedFrames& frames, const fs::path& file) {
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

TEST_F(RenderedFramesTest, OfOtherPrimariesAreShownInThoseOfTheViewport) {
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
        return int(std::lround(255.0f * *finished_view({file, view, nullptr, exposure}, 64).image.at(3, 3)));
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

struct ThumbnailsTest : testing::Test {
    TempFolder folder;

    ListedPicture listed(const std::string& name) const {
        return {folder / name, fs::last_write_time(folder / name), fs::file_size(folder / name)};
    }
    /// Left half of one grey, right half of another.
    ListedPicture write(const std::string& name, unsigned char left, unsigned char right, int width = 300,
                        int height = 200) const {
        std::vector<unsigned char> rgba;
        for (int i = 0; i < width * height; ++i) {
            const unsigned char level = i % width < width / 2 ? left : right;
            rgba.insert(rgba.end(), {level, level, level, 255});
        }
        write_image(folder / name, width, height, rgba);
        return listed(name);
    }
    static std::shared_ptr<const PackedImage> read(Thumbnails& thumbnails, const ListedPicture& picture) {
        thumbnails.want({picture});
        while (thumbnails.working()) std::this_thread::yield();
        return thumbnails.found(picture);
    }
    static int grey(const PackedImage& t, std::int64_t x, std::int64_t y) {
        return t.codes[std::size_t(3 * (y * t.width + x))];
    }
};

TEST_F(ThumbnailsTest, LookAsTheirFilesDoWhateverTheKind) {
    for (const char* name : {"a.png", "a.jpg", "a.tif"}) {
        const PackedImage t = thumbnail_of_file(write(name, 40, 200).file, 60);
        EXPECT_EQ(t.file_width, 300) << name;
        EXPECT_EQ(t.file_height, 200) << name;
        EXPECT_EQ(t.width, 60) << name;
        EXPECT_EQ(t.height, 40) << name;
        EXPECT_NEAR(grey(t, 10, 20), 40, 2) << name;
        EXPECT_NEAR(grey(t, 50, 20), 200, 2) << name;
    }
    const PackedImage small = thumbnail_of_file(write("b.png", 1, 2, 8, 4).file, 60);
    EXPECT_EQ(small.width, 8) << "none is enlarged";
    const PackedImage thin = thumbnail_of_file(write("c.png", 9, 9, 300, 1).file, 60);
    EXPECT_EQ(thin.height, 1);
}

TEST_F(ThumbnailsTest, LightGetsTheScreensCurve) {
    Image light = make_image(4, 4, 4, 1.0f);
    for (std::size_t i = 0; i < 16; ++i) light.pixels[4 * i] = 0.25f;
    write_linear_image(folder / "a.exr", light, "", Existing::replace);
    const PackedImage t = thumbnail_of_file(folder / "a.exr", 60);
    EXPECT_EQ(t.codes[0], 137) << "255 * (1.055 * 0.25^(1 / 2.4) - 0.055)";
    EXPECT_EQ(t.codes[1], 255);
}

TEST_F(ThumbnailsTest, FitsIsStretchedAndItsGapsAreBlack) {
    const auto value = [](int x, int y) {
        return x < 32 || y % 4 == 0 ? std::nan("") : x < 64 ? 100.0 : 900.0;
    };
    folder.file("a.fits", fits_file(128, 64, "", value));
    const PackedImage t = thumbnail_of_file(folder / "a.fits", 32);
    EXPECT_EQ(t.file_width, 128);
    EXPECT_EQ(grey(t, 2, 15), 0) << "no value there";
    EXPECT_EQ(grey(t, 12, 4), 0) << "black";
    EXPECT_EQ(grey(t, 30, 4), 191) << "white, three rows of four";
}

TEST_F(ThumbnailsTest, BrokenFilesAreEmptyAndNothingIsSaid) {
    const Said said;
    set_log_level(LogLevel::detail);
    folder.file("a.png", "no picture");
    const std::string whole = test::bytes_of(write("b.png", 1, 250).file);
    folder.file("b.png", whole.substr(0, whole.size() / 2));
    Thumbnails thumbnails;
    for (const char* name : {"a.png", "b.png"}) {
        const auto found = read(thumbnails, listed(name));
        ASSERT_TRUE(found) << name;
        EXPECT_FALSE(found->error.empty()) << name;
    }
    EXPECT_FALSE(thumbnails.working()) << "not tried for ever";
    set_log_level(LogLevel::info);
    EXPECT_EQ(said.text(), "");
}

TEST_F(ThumbnailsTest, AreKeptUntilTheFileIsAnother) {
    const ListedPicture before = write("a.png", 40, 40);
    Thumbnails thumbnails;
    const auto found = read(thumbnails, before);
    EXPECT_EQ(grey(*found, 0, 0), 40);
    thumbnails.want({});
    EXPECT_EQ(read(thumbnails, before), found) << "not for nothing";
    write("a.png", 90, 90);
    ListedPicture after = before;
    after.changed += std::chrono::seconds(5);
    EXPECT_EQ(grey(*read(thumbnails, after), 0, 0), 90);
    after.bytes += 1;
    EXPECT_FALSE(thumbnails.found(after));
}

TEST_F(ThumbnailsTest, AreForgottenBeyondTheirMemoryTheOldestFirst) {
    const ListedPicture one = write("a.png", 1, 1, 64, 64), two = write("b.png", 2, 2, 64, 64),
                        three = write("c.png", 3, 3, 64, 64);
    Thumbnails thumbnails(64, 30'000);  // two of 12 KiB
    for (const ListedPicture& picture : {one, two}) read(thumbnails, picture);
    read(thumbnails, one);
    read(thumbnails, three);
    EXPECT_TRUE(thumbnails.found(one));
    EXPECT_FALSE(thumbnails.found(two));
    thumbnails.want({one, two, three});
    while (thumbnails.working()) std::this_thread::yield();
    EXPECT_TRUE(thumbnails.found(one) && thumbnails.found(two) && thumbnails.found(three)) << "all are seen";
}

/// A large picture that is scrolled away does not hold up what is seen then.
TEST_F(ThumbnailsTest, AFileThatIsNotWantedAnyMoreIsLetGo) {
    const ListedPicture large = write("large.tif", 10, 20, 9000, 6000), small = write("small.png", 40, 40);
    Thumbnails thumbnails;
    thumbnails.want({large});
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    EXPECT_EQ(grey(*read(thumbnails, small), 0, 0), 40);
    EXPECT_FALSE(thumbnails.found(large));
}

}  // namespace
}  // namespace astrosplat

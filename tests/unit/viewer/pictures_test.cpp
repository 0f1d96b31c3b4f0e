// Picture files, small: how each kind looks, frames that play, what is read again, kept and let go; and
// pictures of layers: the front's measures, before and after what is prepared.
#include "viewer/files.h"

#include "core/color.h"
#include "core/log.h"
#include "measure_fidelity.h"
#include "output/write.h"
#include "sets/load_source.h"
#include "source/prepared_picture.h"
#include "source/write_image.h"
#include "support/fits_text.h"
#include "support/pixmap.h"
#include "support/small_scene.h"
#include "support/test.h"
#include "viewer/comparison.h"

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

/// The result for the request.
template <class Work, class Request>
auto asked(Work& work, const Request& request) {
    work.want(request);
    while (work.working()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return work.found(request);
}

class FrontCheckTest : public testing::Test {
  protected:
    FrontCheckTest() {
        scene.layers.erase(scene.layers.begin());  // the sphere
        scene.layers[0].look.grade.gain = 1.0f;
        scene.layers[0].render.blend = Blend::over;
        scene.layers[0].source.count = 10000;
        const LayerParams& layer = scene.layers[0];
        sets = {std::make_shared<const SplatSet>(load_source(layer.source, layer.name))};
    }

    FrontRequest request() const { return front_request(scene, sets, 0); }

    SmallScene small;
    Scene& scene = small.scene;
    std::vector<std::shared_ptr<const SplatSet>> sets;
};

TEST_F(FrontCheckTest, FindsWhatTheEngineMeasures) {
    FrontCheck check{front_check()};
    EXPECT_FALSE(check.working());
    const auto found = asked(check, request());
    ASSERT_TRUE(found);
    const FrontComparison expected = compare_front(scene, sets, fidelity_reference(scene, {}), 64);
    EXPECT_EQ(found->error, "");
    EXPECT_EQ(found->fidelity.psnr_db, expected.fidelity.psnr_db);
    EXPECT_EQ(found->fidelity.ssim, expected.fidelity.ssim);
    EXPECT_EQ(found->fidelity.flux.frame, expected.fidelity.flux.frame);
    EXPECT_EQ(found->difference.width, 64);
    EXPECT_EQ(found->difference.channels, 4);
}

TEST_F(FrontCheckTest, WhatIsFoundBelongsToItsRequest) {
    FrontCheck check{front_check(32)};
    const FrontRequest before = request();
    const auto found = asked(check, before);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->fidelity.width_px, 32);
    scene.camera.position = {1.0, 2.0, 3.0};
    scene.output.exposure = 2.0;
    check.want(request());
    EXPECT_EQ(check.found(request()), found) << "no front depends on camera and exposure";
    scene.layers[0].look.grade.gain = 0.5f;
    EXPECT_FALSE(check.found(request()));
    ASSERT_TRUE(asked(check, request()));
    EXPECT_FALSE(check.found(before));
    EXPECT_LT(check.found(request())->fidelity.flux.frame, 0.6 * found->fidelity.flux.frame);
}

TEST_F(FrontCheckTest, CancelledItHasFoundNothingAndCanBeAskedAgain) {
    FrontCheck check{front_check()};
    check.want(request());
    check.cancel();
    EXPECT_FALSE(check.working());
    EXPECT_FALSE(check.found(request()));
    EXPECT_TRUE(asked(check, request()));
    check.cancel();
    EXPECT_TRUE(check.found(request())) << "nothing was under way";
}

TEST_F(FrontCheckTest, ALayerWithoutAPictureSaysSo) {
    scene.layers[0].source.meshes[0].texture = {small.folder / "missing.ppm"};
    FrontCheck check{front_check()};
    const auto found = asked(check, request());
    ASSERT_TRUE(found);
    EXPECT_HAS(found->error, "missing.ppm");
}

TEST_F(FrontCheckTest, KnowsLooksThatChangeTheFront) {
    scene.layers[0].look = {};
    scene.layers[0].render = {};
    scene.layers[0].render.lod.max_px = 60.0f;
    EXPECT_TRUE(has_front_picture(scene));
    EXPECT_EQ(front_changed_by(scene), "");
    scene.layers[0].look.grade.gain = 2.0f;
    scene.layers[0].look.grade.saturation = 0.0f;
    EXPECT_EQ(front_changed_by(scene), "colour gain, saturation");
    scene.layers[0].look.noise.resize(2);
    EXPECT_EQ(front_changed_by(scene), "noise, colour gain, saturation");
    scene.layers[0].render.opacity = 0.5f;
    EXPECT_EQ(front_changed_by(scene), "noise, colour gain, saturation and 1 more");
    scene.layers[0].visible = false;
    EXPECT_EQ(front_changed_by(scene), "");
    EXPECT_FALSE(has_front_picture(scene));
    scene.layers[0] = LayerParams{};
    scene.layers[0].render.blend = Blend::add;
    EXPECT_EQ(front_changed_by(scene), "blend");
    scene.layers[0].source.kind = SourceKind::splats;
    EXPECT_FALSE(has_front_picture(scene));
}

TEST_F(FrontCheckTest, OnlyPicturesHaveAFront) {
    scene.layers[0].source.meshes[0].mesh = "plane";
    EXPECT_TRUE(has_front_picture(scene));
    scene.layers[0].source.meshes[0].mesh = "/meshes/cow.obj";
    scene.layers[0].source.uv = UvMode::mesh;
    EXPECT_FALSE(has_front_picture(scene)) << "it has texture coordinates of its own";
    for (const UvMode onto : {UvMode::planar_xz, UvMode::camera}) {
        scene.layers[0].source.uv = onto;
        EXPECT_TRUE(has_front_picture(scene));
    }
}

// Twelve stars on a grey ground.
std::string stars_on_grey() { return test::starry_pixmap({256, 192, 64, 64, 150.0, 9.0, 0.0, 1.0}); }

class PreparePreviewTest : public testing::Test {
  protected:
    PreparePreviewTest() {
        layer.source.meshes = {{"plane", {folder.file("p.ppm", stars_on_grey())}}};
        layer.source.texture.prepare.stars = PrepareParams::Stars::remove;
    }
    PrepareRequest request(std::uint64_t changes = 0) const {
        return prepare_request(layer, changes).value();
    }
    TempFolder folder;
    LayerParams layer;
};

TEST_F(PreparePreviewTest, ShowsThePictureBeforeAndAfter) {
    PreparePreview preview{prepare_preview()};
    const auto found = asked(preview, request());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->error, "");
    EXPECT_EQ(found->stars, 12);
    EXPECT_EQ(found->before.width, 256);
    const float seen = found->before.at(32, 31)[0], removed = found->after.at(32, 31)[0];
    EXPECT_NEAR(seen, 210.0 / 255.0, 0.02) << "display values";
    EXPECT_LT(removed, 0.35f);
    EXPECT_EQ(found->after.at(32, 31)[3], 1.0f);
    const Image exact = prepare_picture(layer.source.meshes[0].texture, layer.source.texture).image;
    EXPECT_NEAR(removed, real::linear_to_srgb(double(exact.at(32, 31)[0])), 1e-6);
}

TEST_F(PreparePreviewTest, IsSmallAndCutsWhereThePictureIsCut) {
    layer.source.texture.prepare.stars = PrepareParams::Stars::keep;
    layer.source.texture.prepare.ellipse = glm::dvec4(128.0, 96.0, 64.0, 48.0);
    const PreparedView view = prepared_view(request(), 100, {});
    ASSERT_EQ(view.after.width, 64);
    ASSERT_EQ(view.after.height, 48);
    ASSERT_EQ(view.before.width, 64);
    EXPECT_EQ(view.after.at(1, 24)[0], 0.0f);
    EXPECT_EQ(view.after.at(32, 1)[0], 0.0f);
    EXPECT_GT(view.after.at(32, 24)[0], 0.1f);
    EXPECT_GT(view.before.at(1, 24)[0], 0.1f);
}

// A picture of 20 x 20 px with a bright upper half, seen upside down and half as fine by the one it
// is put on.
TEST_F(PreparePreviewTest, BothSidesAreAligned) {
    const auto bright_above = [](int, int y) { return y >= 10 ? 900.0 : 100.0; };
    const auto own = folder.file(
        "own.fits", fits_file(20, 20, fits_sky(10.5, 10.5, 10.0, 41.0, 0.001, 180.0), bright_above));
    layer.source.texture.prepare = {};
    layer.source.texture.prepare.align = folder.file(
        "other.fits", fits_file(20, 12, fits_sky(10.5, 6.5, 10.0, 41.0, 0.002, 0.0), bright_above));
    layer.source.texture.stretch = TextureSettings::Stretch::linear;
    layer.source.texture.black = 0.0;
    layer.source.texture.white = 1000.0;
    layer.source.meshes[0].texture = {own};
    const PreparedView view = prepared_view(request(), 400, {});
    for (const Image* side : {&view.before, &view.after}) {
        ASSERT_EQ(side->width, 20);
        ASSERT_EQ(side->height, 12);
        EXPECT_GT(side->at(10, 8)[0], 0.8f) << "below the middle";
        EXPECT_NEAR(side->at(10, 3)[0], 0.35f, 0.02f) << "above";
        EXPECT_EQ(side->at(2, 6)[0], 0.0f) << "what the picture does not show";
    }
}

TEST_F(PreparePreviewTest, WhatComesLaterIsLeftOut) {
    layer.source.texture.derive = Derived::dust;
    layer.source.texture.smooth = 9.0;
    layer.source.texture.mask.emplace_back().luminance = glm::dvec2(0.9, 1.0);
    const PrepareRequest plain = request();
    EXPECT_EQ(plain.texture.derive, Derived::none);
    EXPECT_EQ(plain.texture.smooth, 0.0);
    EXPECT_TRUE(plain.texture.mask.empty());
}

TEST_F(PreparePreviewTest, SaysWhyNothingCanBeShown) {
    PreparePreview preview{prepare_preview()};
    layer.source.meshes[0].texture = {folder / "missing.png"};
    ASSERT_TRUE(asked(preview, request()));
    EXPECT_NE(preview.found(request())->error.find("missing.png"), std::string::npos);
    EXPECT_FALSE(preview.found(request(1))) << "of another request nothing is known";
}

TEST_F(PreparePreviewTest, OnlyPicturesOfTheSceneArePrepared) {
    layer.source.meshes[0].texture.clear();
    EXPECT_FALSE(prepare_request(layer, 0));
    layer.source.kind = SourceKind::splats;
    EXPECT_FALSE(prepare_request(layer, 0));
}

}  // namespace
}  // namespace astrosplat

// The settled picture, other views, and frames that are played.
#include "viewer/view_frame.h"

#include "core/memory.h"
#include "edit/view_camera.h"
#include "gl/gl_fixture.h"
#include "output/write.h"
#include "pipeline.h"
#include "sets/load_source.h"
#include "support/frames.h"
#include "support/small_scene.h"
#include "support/test.h"
#include "unit/edit/scenes.h"
#include "viewer/final_frames.h"
#include "viewer/view_motion.h"

namespace astrosplat {
namespace {

// The settled picture is the pipeline's, bit for bit, whatever was begun and cancelled before it.

using State = FinalFrame::State;

class FinalFrameTest : public testing::Test {
  protected:
    FinalFrameTest() {
        for (const LayerParams& layer : small.scene.layers)
            sets.push_back(std::make_shared<const SplatSet>(load_source(layer.source, layer.name)));
    }

    /// One of a few pictures that differ in look, camera or size.
    FinalRequest request(std::uint32_t which) const {
        FinalRequest wanted;
        wanted.scene = small.scene;
        wanted.sets = sets;
        wanted.width = which % 2 ? 200 : 161;
        wanted.height = 99;
        wanted.scene.layers[0].look.grade.gain = 1.0f + 0.1f * float(which / 2 % 2);
        wanted.scene.camera.position = glm::dvec3(4.0, 6.0 + which / 4, 12.0);
        return wanted;
    }

    static std::string hash_of(const FinalRequest& wanted) {
        Pipeline pipeline;
        pipeline.set_scene(wanted.scene, wanted.sets);
        RenderSettings settings = settings_of(pipeline, wanted.frame);
        settings.width = wanted.width;
        settings.height = wanted.height;
        settings.region = wanted.region;
        return pixel_hash(pipeline.frame(wanted.frame, settings).beauty);
    }

    static void wait(const FinalFrame& picture) {
        while (picture.outcome().state == State::running)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

    /// Starts it, and waits until it is done.
    static void finish(FinalFrame& picture, const FinalRequest& wanted) {
        picture.start(wanted);
        wait(picture);
        ASSERT_EQ(picture.outcome().state, State::done) << picture.outcome().error;
    }

    SmallScene small;
    std::vector<std::shared_ptr<const SplatSet>> sets;
};

TEST_F(FinalFrameTest, SettlesToThePipelinesPixels) {
    FinalFrame picture;
    EXPECT_EQ(picture.outcome().state, State::idle);
    finish(picture, request(0));
    const std::string wanted = hash_of(request(0));
    EXPECT_EQ(pixel_hash(picture.outcome().frame->beauty), wanted);
    EXPECT_TRUE(picture.outcome().frame->depth.pixels.empty());
    EXPECT_EQ(picture.progress(), 1.0f);
    Image tiles;
    EXPECT_FALSE(picture.take_tiles(tiles).empty());
    EXPECT_EQ(pixel_hash(tiles), wanted);
    EXPECT_TRUE(picture.take_tiles(tiles).empty());
}

TEST_F(FinalFrameTest, ACardDrawsTheSamePixels) {
    FinalFrame picture({DeviceChoice::gpu, {}});
    picture.start(request(0));
    wait(picture);
    const FinalFrame::Outcome first = picture.outcome();
    if (first.state == State::failed) GTEST_SKIP() << first.error;
    EXPECT_NE(first.frame->statistics.device, "") << first.frame->statistics.not_on_device;
    for (const std::uint32_t which : {0, 3, 5}) {
        FinalRequest wanted = request(which);
        if (which == 5) wanted.region = {37, 20, 90, 51};
        finish(picture, wanted);
        Image tiles;
        picture.take_tiles(tiles);
        EXPECT_EQ(pixel_hash(tiles), hash_of(wanted)) << which;
    }
}

/// On a card that counts as quick however slow this machine is.
class Followed : public FinalFrameTest {
  protected:
    void SetUp() override {
        if (!test::shared_context().context) GTEST_SKIP() << test::shared_context().reason;
        choice.quick_s = 1e6;
    }

    ViewRequest view(std::uint32_t which) const {
        const FinalRequest frame = request(which);
        ViewRequest wanted;
        static_cast<FrameRequest&>(wanted) = frame;
        for (std::size_t i = 0; i < sets.size(); ++i) {
            const LayerParams& params = small.scene.layers[i];
            wanted.layers.push_back(std::make_shared<const LoadedLayer>(
                whole_layer(sets[i], params.source, params.name, sets[i]->size())));
            wanted.box.add(bounds(*sets[i]));
        }
        return wanted;
    }

    void show(const ViewRequest& wanted) { shown.show(wanted, choice, true, now); }
    void settle(const ViewRequest& wanted) {
        now += 1.0;
        do {
            show(wanted);
            now += 0.01;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        } while (!shown.final_frame());
    }

    PreviewChoice choice;
    double now = 0.0;  // s
    ViewFrame shown{std::make_shared<PictureFiles>(), {DeviceChoice::gpu, {}}};
};

TEST_F(Followed, AMovedCameraShowsFinalFramesAlone) {
    const ViewRequest first = view(0), second = view(4), third = view(8);
    settle(first);
    if (shown.final_frame()->statistics.device.empty()) GTEST_SKIP() << "no card";
    EXPECT_EQ(pixel_hash(*shown.pixels()), hash_of(request(0)));
    show(second);
    EXPECT_EQ(shown.status().state, ViewFrameState::final);
    EXPECT_FALSE(shown.final_frame()) << "it is on its way";
    show(third);  // while that is on its way: it is not thrown away
    settle(third);
    EXPECT_EQ(shown.status().state, ViewFrameState::final);
    EXPECT_EQ(pixel_hash(*shown.pixels()), hash_of(request(8)));
    choice.quick_s = 0.0;  // what comes next is too slow for it
    settle(second);
    show(first);
    EXPECT_EQ(shown.status().state, ViewFrameState::preview);
}

/// Whatever was drawn before: camera, look and size change from one to the next.
TEST_F(Followed, ACardsPreviewsAreThoseOfTheProcessor) {
    const GlInfo& info = test::shared_context().context->info();
    Card card(info, info.software);
    ViewFrame processors(std::make_shared<PictureFiles>());
    choice.splats = 20'000;
    choice.refined = false;
    PreviewChoice by_card = choice;
    by_card.device = &card;
    for (const std::uint32_t which : {0, 1, 2, 6, 4}) {
        shown.show(view(which), by_card, false, now);
        processors.show(view(which), choice, false, now);
        ASSERT_EQ(shown.status().state, ViewFrameState::preview);
        EXPECT_EQ(pixel_hash(*shown.pixels()), pixel_hash(*processors.pixels())) << which;
        EXPECT_GT(shown.status().shown, 1000);
        EXPECT_FALSE(card.pass_times().empty()) << "it has drawn";
    }
}

/// Whatever was seen in between, and without a preview: the frame itself, as long as its sets are those.
TEST_F(Followed, AFinalFrameThatIsKeptIsThereAtOnce) {
    const auto kept = std::make_shared<FinalFrames>();
    kept->limit(1 << 30);
    ViewFrame keeps(std::make_shared<PictureFiles>(), {}, kept);
    choice.quick_s = 0.0;
    const auto settled = [&](const ViewRequest& wanted) {
        keeps.show(wanted, choice, true, now += 1.0);
        const bool at_once = keeps.final_frame() != nullptr;
        while (!keeps.final_frame()) {
            keeps.show(wanted, choice, true, now += 0.2);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return at_once;
    };
    const ViewRequest first = view(0), second = view(5), graded = view(2);
    EXPECT_FALSE(settled(first));
    EXPECT_FALSE(settled(second)) << "another camera and size";
    EXPECT_FALSE(settled(graded));
    const std::uint64_t version = keeps.version();
    EXPECT_TRUE(settled(first));
    EXPECT_GT(keeps.version(), version);
    EXPECT_EQ(keeps.status().state, ViewFrameState::final);
    EXPECT_EQ(keeps.status().width, first.width);
    EXPECT_EQ(pixel_hash(*keeps.pixels()), hash_of(request(0)));
    EXPECT_TRUE(settled(second));
    EXPECT_EQ(pixel_hash(*keeps.pixels()), hash_of(request(5)));
    keeps.show(first, choice, false, now += 1.0);
    EXPECT_EQ(keeps.status().state, ViewFrameState::preview) << "while a scene plays one would flash up";
    keeps.show(first, choice, true, now);
    EXPECT_TRUE(keeps.final_frame()) << "and stopped";
    EXPECT_TRUE(settled(second));
    const std::vector<float> light = keeps.layer_light(100, 50);
    ViewFrame other(std::make_shared<PictureFiles>());
    other.show(second, choice, false, 0.0);
    EXPECT_EQ(light, other.layer_light(100, 50)) << "of what is shown, not of the last preview";
    sets[0] = std::make_shared<const SplatSet>(*sets[0]);
    EXPECT_FALSE(settled(view(0))) << "another set";
    kept->limit(0);
    EXPECT_FALSE(settled(view(4)));
    EXPECT_FALSE(settled(view(0))) << "none is kept any more";
}

TEST_F(Followed, OfALoopThatIsTooLongTheSameFramesStay) {
    FinalFrames kept;
    auto frame = std::make_shared<RenderedFrame>();
    frame->beauty = make_image(100, 100, 4);
    const std::int64_t bytes = 100 * 100 * 4 * 4;
    kept.limit(3 * bytes);
    std::vector<ViewRequest> loop;
    for (int i = 0; i < 5; ++i) {
        loop.push_back(view(0));
        loop.back().frame = i;
    }
    const auto count = [&] {
        return std::ranges::count_if(loop, [&](const ViewRequest& r) { return kept.find(r) != nullptr; });
    };
    for (const ViewRequest& request : loop) {
        kept.begin_round();
        kept.keep(request, frame, 1.0);
    }
    EXPECT_EQ(count(), 3);
    EXPECT_EQ(kept.bytes(), 3 * bytes);
    EXPECT_FALSE(kept.full()) << "older ones made room";
    EXPECT_TRUE(kept.find(loop[4]));
    kept.begin_round();
    for (const ViewRequest& request : loop)
        if (!kept.find(request)) kept.keep(request, frame, 1.0);
    EXPECT_TRUE(kept.full());
    const std::uint64_t drops = kept.drops();
    EXPECT_EQ(count(), 3);
    for (int round = 0; round < 2; ++round)
        for (const ViewRequest& request : loop)
            EXPECT_TRUE(kept.find(request) || !kept.keep(request, frame, 1.0));
    EXPECT_EQ(kept.drops(), drops) << "none makes room for another of the loop";
    kept.limit(bytes);
    kept.keep(view(1), frame, 1.0);
    EXPECT_LE(kept.bytes(), bytes);
}

/// What is seen of a blurred frame before it is final: every lens, eye, projection and kind of layer.
class Blurred : public Followed {
  protected:
    using Change = std::function<void(Scene& scene)>;

    ViewRequest blurred(const Change& change) const {
        ViewRequest wanted = view(0);
        wanted.scene.output.samples = 20;
        change(wanted.scene);
        return wanted;
    }
    static double off(const Image& a, const Image& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            sum += std::pow(double(a.pixels[i]) - double(b.pixels[i]), 2.0);
        return sum;
    }
};

void open_lens(Scene& scene) {
    scene.camera.f_number = 1.0;
    scene.camera.unit_mm = 2.0;
    scene.camera.focus_distance = 9.0;
}
void open_shutter(Scene& scene) {
    scene.camera.shutter = 360.0;
    set_keyframe(scene, "camera.position", 0.0, Value::List{2.0, 6.0, 12.0});
    set_keyframe(scene, "camera.position", 2.0, Value::List{6.0, 6.0, 12.0});
}

TEST_F(Blurred, FewSamplesComeFirstAndAreNotCalledFinal) {
    choice.splats = 200'000;  // or what merges them would be most of the difference
    const Change changes[] = {
        open_lens,
        open_shutter,
        [](Scene& scene) { open_lens(scene), open_shutter(scene), scene.camera.eye = Eye::right; },
        [](Scene& scene) {
            open_shutter(scene), scene.camera.projection = Projection::equirectangular;
            set_keyframe(scene, "camera.position", 0.0, Value::List{-8.0, 2.0, 7.0});  // close by
            set_keyframe(scene, "camera.position", 2.0, Value::List{12.0, 2.0, 7.0});
        },
        [](Scene& scene) {
            open_lens(scene), open_shutter(scene);
            scene.layers[0].render.isolate = true;
            set_keyframe(scene, "layer." + scene.layers[1].name + ".visible", 0.0, true);
            set_keyframe(scene, "layer." + scene.layers[1].name + ".visible", 1.2, false);
        },
    };
    for (const Change& change : changes) {
        const ViewRequest wanted = blurred(change);
        const auto which = &change - changes;
        ViewFrame processors(std::make_shared<PictureFiles>());  // that knows of no quick frame
        std::map<int, Image> seen;                               // by samples
        do {
            processors.show(wanted, choice, true, now += 0.02);
            const ViewFrameStatus& status = processors.status();
            ASSERT_NE(status.state, ViewFrameState::failed) << status.error;
            if (status.state != ViewFrameState::final) seen.try_emplace(status.samples, *processors.pixels());
            ASSERT_EQ(status.state == ViewFrameState::final, processors.final_frame() != nullptr);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        } while (!processors.final_frame());
        ASSERT_EQ(seen.size(), 3u) << which;
        const Image& final = *processors.pixels();
        EXPECT_LT(off(seen.at(4), final), 0.6 * off(seen.at(1), final)) << which;
        EXPECT_LT(off(seen.at(16), final), off(seen.at(4), final)) << which;
        EXPECT_EQ(seen.begin()->first, 1);
    }
}

TEST_F(FinalFrameTest, DepthComesWithTheSamePixels) {
    FinalRequest wanted = request(0);
    wanted.depth = true;
    FinalFrame picture;
    finish(picture, wanted);
    EXPECT_EQ(pixel_hash(picture.outcome().frame->beauty), hash_of(request(0)));
    EXPECT_EQ(picture.outcome().frame->depth.width, wanted.width);
}

TEST_F(FinalFrameTest, ARegionIsThatPartOfThePicture) {
    FinalRequest wanted = request(1);
    wanted.region = {37, 20, 90, 51};
    FinalFrame picture;
    finish(picture, wanted);
    Image tiles;
    picture.take_tiles(tiles);
    EXPECT_EQ(tiles.width, 90);
    EXPECT_EQ(pixel_hash(tiles), hash_of(wanted));
}

TEST_F(FinalFrameTest, CancelsAndRestartsInAnyOrderLeaveNoTrace) {
    std::array<std::string, 8> wanted;
    for (std::uint32_t i = 0; i < 8; ++i) wanted[i] = hash_of(request(i));
    FinalFrame picture;
    Image tiles;
    std::uint32_t current = 0;
    for (std::uint32_t step = 0; step < 120; ++step) {
        const std::uint32_t chance = shared::as_hash(3u, step, 0u, 1u);
        const std::uint32_t action = chance % 5;
        if (action == 0) picture.cancel();
        if (action <= 2) picture.start(request(current = (chance >> 8) % 8));
        if (action == 3) picture.take_tiles(tiles);
        if (action == 4) std::this_thread::sleep_for(std::chrono::milliseconds((chance >> 8) % 12));
        if (step % 20 != 19) continue;
        picture.start(request(current));
        while (picture.outcome().state == State::running) {
            picture.take_tiles(tiles);
            std::this_thread::yield();
        }
        picture.take_tiles(tiles);
        ASSERT_EQ(picture.outcome().state, State::done) << picture.outcome().error;
        ASSERT_EQ(pixel_hash(picture.outcome().frame->beauty), wanted[current]) << "step " << step;
        ASSERT_EQ(pixel_hash(tiles), wanted[current]) << "step " << step;
    }
}

TEST_F(FinalFrameTest, IsWholeWhenItIsDone) {
    FinalRequest wanted = request(0);
    wanted.region = {70, 40, 24, 16};
    const std::string hash = hash_of(wanted);
    FinalFrame picture;
    for (int round = 0; round < 200; ++round) {
        Image tiles;
        FinalFrame::Outcome outcome;
        for (picture.start(wanted); outcome.state != State::done; std::this_thread::yield()) {
            outcome = picture.outcome();
            picture.take_tiles(tiles);
        }
        ASSERT_EQ(pixel_hash(tiles), hash) << "round " << round;
    }
}

TEST_F(FinalFrameTest, ACancelledPictureStaysUnfinished) {
    FinalRequest large = request(0);
    large.width = large.height = 4000;
    FinalFrame picture;
    Image tiles;
    picture.start(large);
    while (picture.take_tiles(tiles).empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    picture.cancel();
    EXPECT_EQ(picture.outcome().state, State::idle);
    EXPECT_EQ(picture.progress(), 0.0f);
    EXPECT_FALSE(picture.outcome().frame);
    EXPECT_TRUE(picture.take_tiles(tiles).empty());

    const auto begin = std::chrono::steady_clock::now();
    FinalRequest next = request(1);
    next.region = {0, 0, 1, 1};
    finish(picture, next);
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
    std::printf("from cancel to the next picture's pixel: %.1f ms\n", taken.count());
}

/// Where memory does not suffice for a frame at once, it comes in bands, as --batch makes them.
TEST_F(FinalFrameTest, ALimitOfMemoryMakesBandsAndNotAnError) {
    small.scene.layers.resize(1);
    small.scene.layers[0].source.count = 2'500'000;
    FinalRequest wanted;
    wanted.scene = small.scene;
    wanted.sets = {std::make_shared<const SplatSet>(load_source(small.scene.layers[0].source, "gas"))};
    wanted.width = 400;
    wanted.height = 260;
    const std::string hash = hash_of(wanted);
    FinalFrame picture;
    FinalRequest pixel = wanted;  // so that the splats are shaded
    pixel.region = {0, 0, 1, 1};
    finish(picture, pixel);
    const std::int64_t before = resident_memory_bytes(), left = 72'000'000;
    limit_memory(before + left, "a dial");
    picture.start(wanted);
    wait(picture);
    EXPECT_LT(resident_memory_bytes(), before + left);
    limit_memory(before + 1'000'000, "a dial");
    wanted.scene.camera.position = glm::dvec3(5.0, 6.0, 12.0);
    wanted.width = wanted.height = 3000;
    FinalFrame refused;
    refused.start(wanted);
    wait(refused);
    limit_memory(0);
    ASSERT_EQ(picture.outcome().state, State::done) << picture.outcome().error;
    EXPECT_EQ(pixel_hash(picture.outcome().frame->beauty), hash);
    EXPECT_EQ(refused.outcome().state, State::failed);
    EXPECT_HAS(refused.outcome().error, " that a dial allows; this takes ");
}

TEST_F(FinalFrameTest, AFailureIsOneLineAndTheNextPictureWorks) {
    FinalRequest bad = request(0);
    bad.scene.layers[0].look.thickness.map = small.folder / "missing.png";
    FinalFrame picture;
    picture.start(bad);
    wait(picture);
    EXPECT_EQ(picture.outcome().state, State::failed);
    EXPECT_HAS(picture.outcome().error, "missing.png");
    EXPECT_EQ(picture.outcome().error.find('\n'), std::string::npos);
    EXPECT_FALSE(picture.outcome().frame);
    finish(picture, request(0));
    EXPECT_EQ(picture.outcome().error, "");
    EXPECT_EQ(pixel_hash(picture.outcome().frame->beauty), hash_of(request(0)));
}

TEST_F(FinalFrameTest, LayersStillLoadingAreLeftOut) {
    FinalRequest wanted = request(0);
    wanted.sets[0] = nullptr;
    FinalFrame picture;
    finish(picture, wanted);
    EXPECT_EQ(pixel_hash(picture.outcome().frame->beauty), hash_of(wanted));
    EXPECT_NE(pixel_hash(picture.outcome().frame->beauty), hash_of(request(0)));
}

TEST_F(FinalFrameTest, EndsInTheMiddleOfAPicture) {
    FinalRequest large = request(0);
    large.width = large.height = 4000;
    const long owners = sets[0].use_count();
    {
        FinalFrame picture;
        picture.start(large);
        while (picture.progress() == 0.0f) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        EXPECT_EQ(picture.outcome().state, State::running);
        EXPECT_GT(sets[0].use_count(), owners);
    }
    EXPECT_EQ(sets[0].use_count(), owners) << "a thread still works on it";
}

// The scene's camera as other views show it. Seen through itself, its frame is the picture's edge.

using Line = CameraOverlay::Line;

struct CameraOverlayTest : testing::Test {
    Scene scene = parse_scene(test::edit_scene, "/scene.toml");  // 640 x 360 px
    Bounds box{{-4.0, -1.0, -3.0}, {6.0, 1.0, 5.0}};
    ViewRequest request;
    Rect place{10.0f, 20.0f, 320.0f, 180.0f};
    CameraOverlay overlay;
    CameraOverlayTest() {
        request.scene = scene;
        request.box = box;
        request.width = 640;
        request.height = 360;
    }
    std::vector<Line> lines() { return overlay.lines(scene, scene, box, request, place); }
    bool has_line(const Line& wanted) {
        const std::vector<Line> all = lines();
        return std::any_of(all.begin(), all.end(), [&](const Line& line) {
            return std::equal(line.begin(), line.end(), wanted.begin(), wanted.end(),
                              [](const glm::vec2& a, const glm::vec2& b) {
                                  return std::abs(a.x - b.x) < 0.01f && std::abs(a.y - b.y) < 0.01f;
                              });
        });
    }
};

TEST_F(CameraOverlayTest, FrameAndTheMarkAboveItLieAtThePicturesEdge) {
    EXPECT_TRUE(has_line({{10, 20}, {330, 20}, {330, 200}, {10, 200}, {10, 20}}));
    EXPECT_TRUE(has_line({{138, 12.8f}, {170, -8.8f}, {202, 12.8f}, {138, 12.8f}}));
}

TEST_F(CameraOverlayTest, AViewFromElsewhereSeesTheWholeFrustum) {
    request.scene.camera.position = glm::dvec3(30.0, 4.0, 10.0);
    request.scene.camera.target =
        glm::dvec3(0.0, 4.0, 10.0);  // the scene's camera, which is so in the middle
    const std::vector<Line> all = lines();
    ASSERT_GE(all.size(), 6u);
    for (std::size_t i = 0; i < 4; ++i) {  // from the eye to the corners
        ASSERT_EQ(all[i].size(), 2u);
        EXPECT_NEAR(all[i][0].x, 170.0f, 0.01f);
        EXPECT_NEAR(all[i][0].y, 110.0f, 0.01f);
        EXPECT_GT(all[i][1].y, 110.0f - 180.0f);
    }
}

/// Eight seconds; the camera is twice as fast in the second half of its way.
TEST_F(CameraOverlayTest, TicksLieWhereTheCameraIsAtEqualTimes) {
    scene.output.frames = "1-193";
    scene.output.fps = 24.0;
    const auto key = [](double frame, double x) {
        return Keyframe<std::vector<double>>(frame, {x, 4.0, 10.0}, Interpolation::linear);
    };
    Track way{.key = ParameterKey("camera.position"), .keyframes = {}};
    way.keyframes = {key(1.0, 0.0), key(97.0, 4.0), key(193.0, 12.0)};
    scene.animation = {way};
    request.scene.camera.position = glm::dvec3(6.0, 60.0, 10.0);
    request.scene.camera.target = glm::dvec3(6.0, 0.0, 9.99);
    std::vector<float> x;
    for (const Line& line : lines())
        if (line.size() == 1) x.push_back(line[0].x);
    ASSERT_EQ(x.size(), 9u);
    for (std::size_t i = 1; i < x.size(); ++i)
        EXPECT_NEAR((x[i] - x[i - 1]) / (x[1] - x[0]), i <= 4 ? 1.0f : 2.0f, 0.02f) << i;
}

TEST_F(CameraOverlayTest, ACameraThatCannotBeMadeHasNoLines) {
    request.scene.camera.fov = 0.0;
    EXPECT_TRUE(lines().empty());
}

// Mouse over the viewport: when the view leaves the scene's camera, and where it stands then.

using Drag = ViewportInput::Drag;

struct NavigatorTest : testing::Test {
    test::SceneFolder folder;
    Document document = Document::open(folder.file);
    ViewState view;
    ViewRequest request;
    Bounds box{{-4.0, -1.0, -3.0}, {6.0, 1.0, 5.0}};
    ShownView shown{request, {640.0, 360.0}, box};
    Navigator navigator;
    NavigatorTest() {
        request.scene = document.scene();
        request.box = box;
        request.width = 640;
        request.height = 360;
        view.view = ViewKind::camera;
    }
    bool left_camera(const ViewportInput& input) {
        view.view = ViewKind::camera;
        return navigator.navigate(input, shown, 1.0, document, view);
    }
};

ViewportInput dragged(Drag drag, const glm::dvec2& by) {
    ViewportInput input;
    input.hovered = true;
    input.drag = drag;
    input.delta_px = by;
    return input;
}

TEST_F(NavigatorTest, OnlyAMoveLeavesTheCamera) {
    for (const Drag drag : {Drag::orbit, Drag::pan, Drag::dolly, Drag::look}) {
        EXPECT_FALSE(left_camera(dragged(drag, {0.0, 0.0})));
        EXPECT_EQ(view.view, ViewKind::camera);
        EXPECT_TRUE(left_camera(dragged(drag, {3.0, 0.0})));
        EXPECT_EQ(view.view, ViewKind::free);
    }
    EXPECT_FALSE(left_camera(dragged(Drag::none, {3.0, 0.0})));
    EXPECT_FALSE(left_camera(dragged(Drag::wipe, {3.0, 0.0})));
    ViewportInput input;
    input.wheel = 1.0f;
    EXPECT_FALSE(left_camera(input));  // over another part of the window
    input.hovered = true;
    EXPECT_TRUE(left_camera(input));
}

TEST_F(NavigatorTest, ALockedCameraIsEditedOneStepAGesture) {
    view.lock_to_camera = true;
    const CameraParams before = document.scene().camera;
    ViewportInput input = dragged(Drag::orbit, {5.0, 0.0});
    input.drag_begins = true;
    EXPECT_FALSE(left_camera(input));
    input.drag_begins = false;
    EXPECT_FALSE(left_camera(input));
    EXPECT_EQ(view.view, ViewKind::camera);
    EXPECT_NE(document.scene().camera.position, before.position);
    document.undo();
    EXPECT_EQ(document.scene().camera, before);
    EXPECT_FALSE(document.can_undo());
}

TEST_F(NavigatorTest, AFramedBoxFillsTheFreeView) {
    EXPECT_TRUE(frame_in_view(view, box, shown));
    EXPECT_EQ(view.view, ViewKind::free);
    const FreeCamera first = view.free;
    EXPECT_EQ(first.pivot, box.center());
    EXPECT_EQ(first, framed(first, box, 640.0 / 360.0));
    const Bounds half{box.center(), box.hi};
    EXPECT_FALSE(frame_in_view(view, half, shown));  // it is a free view already
    EXPECT_EQ(view.free, framed(first, half, 640.0 / 360.0));
    EXPECT_FALSE(frame_in_view(view, {}, shown));
    EXPECT_EQ(view.free.pivot, half.center());
}

// Playing: the scene's frames at its speed, round and round, whatever the clock does.

struct PlaybackTest : testing::Test {
    Playback playback;
    ViewState view;
    OutputParams output;
    PlaybackTest() {
        output.frames = "10-12";
        output.fps = 4.0;
        view.frame = 10.0;
        view.playing = true;
    }
    double frame_at(double now) {
        playback.advance(view, output, is_final, now);
        return view.frame;
    }
    bool is_final = false;
};

TEST_F(PlaybackTest, WaitsForFinalFramesWhereTheyAreWanted) {
    output.frames = "10-100";
    view.play_final = true;
    frame_at(100.0);
    EXPECT_EQ(frame_at(101.0), 10.0);
    is_final = true;
    EXPECT_EQ(frame_at(102.0), 11.0) << "the next one, however late";
    EXPECT_EQ(frame_at(102.25), 12.0);
    EXPECT_EQ(frame_at(102.75), 14.0) << "those that are there keep the speed";
    view.every_frame = true;
    EXPECT_EQ(frame_at(103.5), 15.0);
}

TEST_F(PlaybackTest, AfterTheLastFrameComesTheFirst) {
    EXPECT_EQ(frame_at(100.0), 10.0);
    EXPECT_EQ(frame_at(100.125), 10.0);
    EXPECT_EQ(frame_at(100.25), 11.0);
    EXPECT_EQ(frame_at(100.5), 12.0);
    EXPECT_EQ(frame_at(100.75), 10.0);
}

TEST_F(PlaybackTest, FramesThatCannotBeDrawnInTimeAreLeftOut) {
    output.frames = "10-100";
    frame_at(100.0);
    EXPECT_EQ(frame_at(101.125), 14.0);
    EXPECT_EQ(frame_at(101.25), 15.0);  // the eighth of a second is not lost
}

TEST_F(PlaybackTest, APauseIsNotCaughtUp) {
    frame_at(100.0);
    view.playing = false;
    EXPECT_EQ(frame_at(101.0), 10.0);
    view.playing = true;
    EXPECT_EQ(frame_at(102.0), 10.0);
    EXPECT_EQ(frame_at(102.25), 11.0);
}

TEST_F(PlaybackTest, InAndOutPointsBoundIt) {
    output.frames = "1-100";
    view.play_first = 20.0;
    view.play_last = 22.0;
    frame_at(100.0);
    EXPECT_EQ(frame_at(100.25), 20.0);  // from outside
    EXPECT_EQ(frame_at(100.5), 21.0);
    EXPECT_EQ(frame_at(100.75), 22.0);
    EXPECT_EQ(frame_at(101.0), 20.0);
    view.play_last = 7.0;  // before the in point: as if it were not there
    for (int i = 0; i < 5; ++i) frame_at(101.25 + 0.25 * i);
    EXPECT_EQ(view.frame, 25.0);
}

TEST_F(PlaybackTest, ThereAndBackShowsTheEndsOnce) {
    view.play_mode = PlayMode::ping_pong;
    frame_at(100.0);
    std::vector<double> seen;
    for (int i = 1; i <= 6; ++i) seen.push_back(frame_at(100.0 + 0.25 * i));
    EXPECT_EQ(seen, (std::vector<double>{11, 12, 11, 10, 11, 12}));
}

TEST_F(PlaybackTest, OnceStopsAtTheEndAndBeginsAgain) {
    view.play_mode = PlayMode::once;
    frame_at(100.0);
    frame_at(100.25);
    frame_at(100.5);
    EXPECT_TRUE(view.playing);
    EXPECT_EQ(frame_at(100.75), 12.0);
    EXPECT_FALSE(view.playing);
    frame_at(101.0);
    view.playing = true;
    EXPECT_EQ(frame_at(102.0), 10.0);
}

TEST_F(PlaybackTest, EveryFrameIsShownAndTheRateAsItIs) {
    output.frames = "10-100";
    view.every_frame = true;
    frame_at(100.0);
    for (int i = 1; i <= 4; ++i) EXPECT_EQ(frame_at(100.0 + 0.5 * i), 10.0 + i);  // 2 a second, not 4
    EXPECT_NEAR(playback.shown_fps(), 2.0, 1e-9);
    view.every_frame = false;
    for (int i = 1; i <= 8; ++i) frame_at(102.0 + 0.25 * i);
    EXPECT_NEAR(playback.shown_fps(), 4.0, 1e-9);
}

TEST(FirstFrame, IsTheEarliest) {
    Scene scene;
    scene.output.frames = "7-9,3";
    EXPECT_EQ(frame_range(scene.output).first, 3.0);
}

}  // namespace
}  // namespace astrosplat

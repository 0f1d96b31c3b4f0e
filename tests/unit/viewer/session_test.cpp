// A window's session without a window, and the queues beneath it.
#include "viewer/session.h"

#include <atomic>
#include <glm/vec2.hpp>

#include "fidelity/front.h"
#include "gl/gl_fixture.h"
#include "support/test.h"
#include "viewer/background_work.h"
#include "viewer/picture_starts.h"
#include "viewer/render_queue.h"
#include "viewer/window.h"

namespace astrosplat::test {
namespace {

/// On a scene of one disk, of the painted galaxy in so many positions, and a clock that stands still but for
/// what a test adds.
class DiskSession : public GlTest {
  protected:
    DiskSession(std::int64_t count, glm::ivec2 size_px) : session{options(count), {}}, size_px_(size_px) {}

    void draw() {
        advance(session, now);
        draw_viewport(session, size_px_, now);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

    const Quiet quiet;
    double now = 1000.0;  // s
    const TempFolder folder;
    Session session;

  private:
    ViewerOptions options(std::int64_t count) const {
        ViewerOptions options;
        options.program = "/bin/false";  // no jobs are looked for
        options.input = folder.file(
            "scene.toml", fmt::format("astrosplat = 1\n[camera]\nposition = [0.0, 6.0, 8.0]\n"
                                      "[[layer]]\nname = \"disk\"\n[layer.source]\n"
                                      "meshes = [ {{ mesh = \"plane\", texture = \"{}\" }} ]\ncount = {}\n",
                                      ASTROSPLAT_SOURCE_DIR "/assets/textures/spiral.jpg", count));
        return options;
    }

    glm::ivec2 size_px_;
};

/// From a start on, the final picture comes before all that serves the next touch.
class Start : public DiskSession {
  protected:
    Start() : DiskSession(1'500'000, {320, 180}) {}
    std::shared_ptr<const LoadedLayer> disk() const { return session.sets.loader().layer("disk"); }
    std::string name() const { return session.document.scene().layers[0].name; }
    StructureKind kind() const { return session.document.scene().layers[0].source.structure.kind; }
    void choose(const char* choice) {
        Commands chosen{{Command::Kind::start_again, {}, choice, 0}};
        carry_out(session, chosen);
        wait_for_start(session);
    }
    const fs::path picture = ASTROSPLAT_SOURCE_DIR "/assets/textures/spiral.jpg";
};

// The clock stands: a set that arrives is no touch, after which the picture would have to rest.
TEST_F(Start, TheFinalPictureComesBeforeTheTreesOfLaterPreviews) {
    draw();
    now += 0.5;
    while (!settled(session)) draw();
    ASSERT_TRUE(disk()->set);
    EXPECT_FALSE(disk()->arranged);
    EXPECT_FALSE(disk()->histograms);
    while (!session.sets.loaded(session.document)) draw();
    EXPECT_TRUE(disk()->arranged);
    EXPECT_TRUE(disk()->histograms);
    EXPECT_TRUE(settled(session)) << "what came later changed nothing";
}

// From elsewhere bodies with depth along its rays look cut off.
TEST_F(Start, APictureIsSeenByItsOwnCamera) {
    ASSERT_EQ(session.view.view, ViewKind::camera);
    session.view.view = ViewKind::free;
    open_file(session, ASTROSPLAT_SOURCE_DIR "/assets/textures/spiral.jpg");
    wait_for_start(session);
    EXPECT_EQ(session.view.view, ViewKind::camera);
    ASSERT_TRUE(session.document.scene().camera.position);
    EXPECT_EQ(*session.document.scene().camera.position,
              session.document.scene().layers[0].source.uv_camera.position);
}

TEST_F(Start, APictureOpensWithWhatItWasTakenFor) {
    EXPECT_FALSE(session.view.start);
    open_file(session, picture);
    EXPECT_EQ(name(), "disk") << "until it is made";
    wait_for_start(session);
    ASSERT_TRUE(session.view.start);
    EXPECT_EQ(session.view.start->object, SkyObject::galaxy);
    choose("nebula");
    ASSERT_TRUE(session.view.start);
    EXPECT_EQ(session.view.start->object, SkyObject::nebula);
    EXPECT_NE(kind(), StructureKind::disk);
    EXPECT_FALSE(session.document.edited());
    const auto with = [&](const char* choice) {
        choose(choice);
        return session.document.scene().layers[0].source.splats;
    };
    EXPECT_EQ(with("splats 20000"), 20000);
    EXPECT_EQ(with("film"), 20000) << "which stays";
    EXPECT_EQ(with("whole"), 0);
    take_document(session, demo_document());
    EXPECT_FALSE(session.view.start);
}

TEST_F(Start, AnotherKindIsOneUndoStepAndTheCardFollows) {
    open_file(session, picture);
    wait_for_start(session);
    choose("nebula");
    choose("film");
    EXPECT_EQ(session.document.undo_name(), "Make a film");
    session.document.undo();
    EXPECT_EQ(session.document.undo_name(), "Taken for a nebula");
    session.document.undo();
    draw();
    EXPECT_EQ(session.view.start->object, SkyObject::galaxy);
    EXPECT_FALSE(session.view.start->film);
    EXPECT_EQ(kind(), StructureKind::disk);
    EXPECT_FALSE(session.document.can_undo());
    EXPECT_FALSE(session.document.edited());
    session.document.redo();
    session.document.redo();
    draw();
    EXPECT_EQ(session.view.start->object, SkyObject::nebula);
    EXPECT_TRUE(session.view.start->film);
    session.document.undo();
    const std::string text = session.document.text_for(folder / "later.toml");
    for (const char* of_the_galaxy : {"kind = \"disk\"", "how it lies is unsure"})
        EXPECT_EQ(text.find(of_the_galaxy), std::string::npos) << of_the_galaxy;
}

TEST_F(Start, WhatIsDroppedWithAPictureComesAfterIt) {
    Commands both{{Command::Kind::open, picture, {}, 0}, {Command::Kind::add_shape, {}, "disk", 0}};
    carry_out(session, both);
    EXPECT_FALSE(session.document.edited());
    wait_for_start(session);
    EXPECT_EQ(name(), "spiral");
    ASSERT_EQ(session.dropped.size(), 1u);
    EXPECT_EQ(session.dropped[0].kind, Command::Kind::add_shape);
}

// The window's thread goes on.
TEST_F(Start, APictureThatIsLookedAtIsCancelled) {
    open_file(session, picture);
    draw();
    ASSERT_TRUE(session.status.starting);
    EXPECT_EQ(session.status.starting->picture, picture);
    EXPECT_LE(next_due(session, now), 0.1);
    carry_out(session, {Command::Kind::cancel_start, {}, {}, 0});
    draw();
    EXPECT_FALSE(session.status.starting);
    EXPECT_EQ(name(), "disk");
    EXPECT_FALSE(session.view.start);
}

TEST_F(Start, WhatIsMadeForAnotherSceneIsDropped) {
    open_file(session, picture);
    take_document(session, demo_document());
    wait_for_start(session);
    EXPECT_EQ(name(), demo_document().scene().layers[0].name);
    EXPECT_FALSE(session.view.start);
    open_file(session, picture);
    session.document.edit("Wider", [](Scene& scene) { scene.camera.fov = 41.0; });
    wait_for_start(session);
    EXPECT_TRUE(session.document.edited()) << "nothing that a person did is lost";
    EXPECT_HAS(session.status.message.text, "was not opened");
    take_document(session, demo_document());
    open_file(session, picture);
    wait_for_start(session);
    start_again(session, "film");
    session.document.edit("Wider", [](Scene& scene) { scene.camera.fov = 41.0; });
    wait_for_start(session);
    EXPECT_EQ(session.document.scene().camera.fov, 41.0);
    EXPECT_HAS(session.status.message.text, "Make a film: not made");
}

TEST_F(Start, APictureThatCannotBeReadSaysSoAndTheSceneStays) {
    const std::string whole = read_file(picture);
    open_file(session, folder.file("cut.jpg", whole.substr(0, whole.size() / 3)));
    while (session.starts.wanted()) draw();
    EXPECT_TRUE(session.status.message.error);
    EXPECT_HAS(session.status.message.text, "cut.jpg");
    EXPECT_EQ(name(), "disk");
}

// Each with another light from aside; gone with the card.
TEST_F(Start, WhatElseItMayBeIsSeenFromAside) {
    open_file(session, picture);
    wait_for_start(session);
    session.view.settle = false;
    while (session.status.kinds.size() < sky_object_count) draw();
    for (const auto& [object, kind] : session.status.kinds) {
        EXPECT_TRUE(kind.texture) << int(object);
        EXPECT_EQ(kind.error, "");
    }
    choose("nebula");
    draw();
    EXPECT_EQ(session.status.kinds.size(), sky_object_count) << "they are of the same picture";
    session.view.start.reset();
    draw();
    EXPECT_TRUE(session.status.kinds.empty());
    EXPECT_FALSE(session.kind_views.working());
}

TEST(KindView, ShowsBodiesFromAside) {
    const fs::path picture = ASTROSPLAT_SOURCE_DIR "/assets/textures/spiral.jpg";
    const KindView disk = kind_view({picture, SkyObject::galaxy}, {}),
                   flat = kind_view({picture, SkyObject::thin}, {});
    ASSERT_EQ(disk.image.width, 160);
    ASSERT_EQ(disk.image.height, 100);
    const auto mean = [](const Image& image) {
        double sum = 0.0;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) sum += i % 4 == 3 ? 0.0 : image.pixels[i];
        return sum / double(image.width * image.height * 3);
    };
    EXPECT_GT(mean(disk.image), 0.03);
    EXPECT_GT(mean(flat.image), 0.03);
    EXPECT_LT(psnr_db(disk.image, flat.image), 40.0);
    std::atomic<bool> stop{true};
    EXPECT_THROW(kind_view({picture, SkyObject::galaxy}, {{}, &stop}), Cancelled);
}

TEST_F(Start, ACameraMadeForOtherFramesIsSaid) {
    folder.file("move.chan", "1001 0 0 9 0 0 0 40\n1005 1 0 9 0 0 0 40\n");
    for (const char* frames : {"1001-1005", "1-5"}) {
        open_file(session, folder.file("film.toml", fmt::format("astrosplat = 1\n[output]\nframes = \"{}\"\n"
                                                                "[camera]\nfile = \"move.chan\"\n",
                                                                frames)));
        draw();
        const bool said =
            session.status.message.text.find("camera.file_offset = -1000 would fit") != std::string::npos;
        EXPECT_EQ(said, frames[1] == '-') << session.status.message.text;
    }
}

// By the scene's own camera, as one edit.
TEST_F(Start, DetailComesWhereTheCameraDoes) {
    const auto structure = [&]() -> const StructureParams& {
        return session.document.scene().layers[0].source.structure;
    };
    carry_out(session, {Command::Kind::make_detail, {}, {}});
    EXPECT_EQ(structure().detail, 0) << "a layer of columns has none";
    session.document.edit("Closer", [](Scene& scene) {
        scene.layers[0].source.structure.kind = StructureKind::sheet;
        scene.camera.position = glm::dvec3(0.0, 1.0, 1.0);
    });
    carry_out(session, {Command::Kind::make_detail, {}, {}});
    EXPECT_EQ(structure().detail, 2);
    EXPECT_HAS(structure().detail_tiles, "2");
    EXPECT_HAS(session.status.message.text, "more splats of detail");
    session.document.undo();
    EXPECT_EQ(structure().detail, 0);
    EXPECT_EQ(session.document.scene().camera.position, glm::dvec3(0.0, 1.0, 1.0));
}

// Whoever moves needs them at once.
TEST_F(Start, AMovingHandDoesNotHoldUpTheTrees) {
    int moves = 0;
    for (; !disk() || !disk()->arranged; now += 0.1) {
        ASSERT_LT(++moves, 2000) << "they take some seconds with the set itself";
        session.document.edit("Wider", [&](Scene& scene) { scene.camera.fov = 40.0 + 0.01 * moves; });
        draw();
        ASSERT_FALSE(settled(session));
    }
}

// They would take half of the processor from it.
TEST_F(Start, SumsForTheNextMoveGiveWayToTheFinalFrame) {
    session.view.settle = false;
    for (; !session.sets.loaded(session.document) || !preview_exact(session); now += 0.02) draw();
    session.document.edit("Harder", [](Scene& scene) { scene.layers[0].look.alpha.power = 0.7f; });
    draw();  // what moved is at rest from now on
    draw();
    now += 0.15;
    draw();  // sums of the whole begin
    ASSERT_FALSE(session.view_frame.exact());
    session.view.settle = true;
    now += 0.1;
    draw();
    ASSERT_EQ(session.view_frame.status().state, ViewFrameState::refining);
    std::this_thread::sleep_for(std::chrono::seconds(2));  // they would long be there
    while (!settled(session)) draw();
    EXPECT_FALSE(session.view_frame.exact()) << "they begin again now";
    while (!session.view_frame.exact()) draw();
}

// Which takes the system a while.
TEST_F(Start, MemoryIsCountedEveryFiveSeconds) {
    advance(session, now);
    const std::int64_t before = session.status.memory_bytes;
    EXPECT_GT(before, 0);
    const std::vector<char> more(std::size_t{256} << 20, 'x');
    advance(session, now + 4.9);
    EXPECT_EQ(session.status.memory_bytes, before);
    advance(session, now + 5.0);
    EXPECT_GT(session.status.memory_bytes, before + (std::int64_t{200} << 20)) << more[0];
}

/// Between what moves and the final frame, the picture comes closer to it in steps.
class FinerPreviewSession : public DiskSession {
  protected:
    FinerPreviewSession() : DiskSession(400'000, {640, 360}) {
        session.fixed_splats = 3000;
        session.view.settle = false;
    }

    std::int64_t shown() const { return session.view_frame.status().shown; }
    double distance_to(const Image& other) const {
        const Image image = *session.view_frame.pixels();
        double sum = 0.0;
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            sum += std::fabs(double(image.pixels[i]) - double(other.pixels[i]));
        return sum;
    }
};

TEST_F(FinerPreviewSession, EveryStepIsCloserToTheFinalFrame) {
    for (; !session.sets.loaded(session.document) || !preview_exact(session); now += 0.02) draw();
    session.document.edit("Wider", [](Scene& scene) { scene.camera.fov = 50.0; });  // the last change
    do draw();
    while (!session.sets.loaded(session.document) || !preview_exact(session));
    std::vector<Image> seen{*session.view_frame.pixels()};
    std::vector<std::int64_t> counts{shown()};
    session.view.settle = true;
    draw();
    EXPECT_EQ(shown(), counts.back()) << "the hand may still move";
    now += 0.1;  // less than the final frame waits for
    while (seen.size() < 3) {
        draw();
        ASSERT_EQ(session.view_frame.status().state, ViewFrameState::preview);
        if (shown() == counts.back()) continue;
        counts.push_back(shown());
        seen.push_back(*session.view_frame.pixels());
    }
    EXPECT_GT(counts[1], 3 * counts[0]);
    EXPECT_GT(counts[2], 3 * counts[1]);
    for (now += 1.0; !settled(session); now += 0.02) draw();
    EXPECT_LT(distance_to(seen[1]), 0.8 * distance_to(seen[0]));
    EXPECT_LT(distance_to(seen[2]), distance_to(seen[1]));
    EXPECT_GE(next_due(session, now), 0.1) << "nothing is left to be done";
}

/// The hand rests, but no final frame may begin: its set is another one.
TEST_F(FinerPreviewSession, SetsThatAreMadeDoNotHoldItUp) {
    for (; !session.sets.loaded(session.document) || !preview_exact(session); now += 0.02) draw();
    session.view.settle = true;
    session.document.edit("More", [](Scene& scene) { scene.layers[0].source.count += 1000; });
    draw();
    const std::int64_t before = shown();
    now += 0.1;
    for (int i = 0; i < 5000 && shown() < 3 * before; ++i) {
        draw();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ASSERT_FALSE(session.sets.wanted(session.document.scene()));
    }
    EXPECT_GE(shown(), 3 * before);
    EXPECT_EQ(session.view_frame.status().state, ViewFrameState::preview);
}

/// Which the window's own context is: no other card's probe says anything about it.
TEST_F(FinerPreviewSession, APreviewIsDrawnByTheCardThatIsAskedFor) {
    session.gl = shared_context().context->info();
    session.card_choice.device = DeviceChoice::automatic;
    const auto picture = [&](PreviewEngine engine) {
        session.view.engine = engine;
        draw();
        fill_status(session);
        return *session.view_frame.pixels();
    };
    for (; !session.sets.loaded(session.document) || !preview_exact(session); now += 0.02) draw();
    const Image processor = picture(PreviewEngine::processor);
    EXPECT_EQ(session.status.engine, "processor");
    const Image card = picture(PreviewEngine::card);
    if (session.status.engine == "processor") GTEST_SKIP() << "no card";
    EXPECT_EQ(session.status.engine, session.gl.renderer);
    EXPECT_EQ(card.pixels, processor.pixels);
    picture(PreviewEngine::automatic);
    EXPECT_EQ(session.status.engine == "processor", session.gl.software) << "none has drawn a final frame";
    session.card_choice.device = DeviceChoice::cpu;
    picture(PreviewEngine::card);
    EXPECT_EQ(session.status.engine, "processor");
}

TEST(Messages, AFailedPictureAndLayerAreSaidOnce) {
    Status status;
    status.layers.resize(2);
    say_new_errors(status);
    EXPECT_TRUE(status.log.empty());
    status.view_frame.state = ViewFrameState::failed;
    status.view_frame.error = "s.toml: camera.fov: expected an angle, found 0";
    say_new_errors(status);
    ASSERT_EQ(status.log.size(), 1u);
    EXPECT_TRUE(status.message.error);
    EXPECT_EQ(status.message.text, status.view_frame.error);
    status.layers[1].error = "a.png: expected a picture, found none";
    say_new_errors(status);
    say_new_errors(status);
    ASSERT_EQ(status.log.size(), 2u);
    EXPECT_EQ(status.message.text, status.layers[1].error);
    status.view_frame.state = ViewFrameState::preview;
    say_new_errors(status);
    status.view_frame.state = ViewFrameState::failed;
    say_new_errors(status);
    EXPECT_EQ(status.log.size(), 3u) << "it has failed again";
}

TEST(Messages, MessagesGoAndErrorsStay) {
    Status status;
    MessageAge age;
    const auto seen_at = [&](double now) {
        forget_old_message(status, age, now);
        return status.message.text;
    };
    EXPECT_EQ(seen_at(0.0), "");
    say(status, "Saved a.toml");
    EXPECT_EQ(seen_at(100.0), "Saved a.toml");
    EXPECT_EQ(seen_at(111.0), "Saved a.toml");
    say(status, "Saved a.toml");
    EXPECT_EQ(seen_at(113.0), "Saved a.toml") << "it was said again";
    EXPECT_EQ(seen_at(124.0), "Saved a.toml");
    EXPECT_EQ(seen_at(126.0), "");
    EXPECT_EQ(status.log.size(), 2u) << "the log keeps them";
    say(status, "a.toml: expected a number, found none", true);
    seen_at(130.0);
    EXPECT_EQ(seen_at(1e6), "a.toml: expected a number, found none");
}

/// 3 x 2 px, red is 10 x + y, the other channels 1.
Image numbered() {
    Image image = make_image(3, 2, 4, 1.0f);
    for (std::int64_t y = 0; y < 2; ++y)
        for (std::int64_t x = 0; x < 3; ++x) image.at(x, y)[0] = float(10 * x + y);
    return image;
}

TEST(Probe, IsThePixelAndItsDepth) {
    const Image pixels = numbered();
    Image depth = make_image(3, 2, 1, 0.0f);
    *depth.at(2, 1) = 7.5f;
    const auto found = probe_of(pixels, &depth, {}, 2, 1);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->x, 2);
    EXPECT_EQ(found->y, 1);
    EXPECT_EQ(found->rgba[0], 21.0f);
    EXPECT_EQ(found->rgba[3], 1.0f);
    EXPECT_EQ(found->depth, 7.5f);
    EXPECT_FALSE(probe_of(pixels, &depth, {}, 1, 1)->depth) << "nothing is there";
    EXPECT_FALSE(probe_of(pixels, nullptr, {}, 2, 1)->depth) << "of previews";
    const Image without;
    EXPECT_FALSE(probe_of(pixels, &without, {}, 2, 1)->depth) << "of scenes that write none";
}

TEST(Probe, CountsFromTheWholePicture) {
    const Image pixels = numbered();
    const Region part{100, 50, 3, 2};
    const auto found = probe_of(pixels, nullptr, part, 101, 51);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->x, 101);
    EXPECT_EQ(found->rgba[0], 11.0f);
    for (const auto& [x, y] : {std::pair{99, 50}, {103, 50}, {100, 49}, {100, 52}})
        EXPECT_FALSE(probe_of(pixels, nullptr, part, x, y)) << x << " " << y;
}

// Results for a superseded request are dropped, with all that the request held.

struct Held {
    std::shared_ptr<const int> value;
    bool operator==(const Held&) const = default;
};
struct Sum {
    std::shared_ptr<const int> of;
    std::string error;
};

class LatestWorkTest : public testing::Test {
  protected:
    std::shared_ptr<const Sum> wait_for(const Held& request) {
        work.want(request);
        for (;;) {
            if (auto found = work.found(request)) return found;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    LatestWork<Held, Sum> work{[](const Held& request, const Progress&) { return Sum{request.value, {}}; }};
};

TEST_F(LatestWorkTest, ForgetsWhatItHeld) {
    auto value = std::make_shared<const int>(7);
    const std::weak_ptr<const int> watched = value;
    EXPECT_EQ(*wait_for({value})->of, 7);
    EXPECT_TRUE(work.asked([&](const Held& asked) { return asked.value == value; }));
    value.reset();
    EXPECT_FALSE(watched.expired()) << "else there is nothing to be forgotten";
    work.forget();
    for (int tries = 0; tries < 2000 && !watched.expired(); ++tries)  // the thread may be about to let go
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_TRUE(watched.expired());
    EXPECT_FALSE(work.working());
    EXPECT_FALSE(work.asked([](const Held&) { return true; }));
}

TEST_F(LatestWorkTest, BeginsAgainAfterThat) {
    const Held request{std::make_shared<const int>(3)};
    wait_for(request);
    work.forget();
    EXPECT_EQ(work.found(request), nullptr);
    EXPECT_EQ(*wait_for(request)->of, 3);
}

// Events that came between two slow frames, and the frames they are given to.

using Kind = InputEvent::Kind;

InputEvent at(Kind kind, double x) { return {kind, 0, 0, x, 0.0, 0.0}; }
InputEvent of(Kind kind, int code) { return {kind, code, 0, 0.0, 0.0, 0.0}; }

std::vector<std::vector<InputEvent>> frames_of(const std::vector<InputEvent>& events,
                                               Typing typing = Typing::shortcuts) {
    InputQueue queue;
    for (const InputEvent& event : events) queue.push(event);
    std::vector<std::vector<InputEvent>> frames;
    while (!queue.empty()) frames.push_back(queue.take(typing));
    return frames;
}

using Frames = std::vector<std::vector<InputEvent>>;

TEST(InputQueue, NothingIsTakenFromNothing) { EXPECT_TRUE(InputQueue().take().empty()); }

TEST(InputQueue, ADragEndsWhereItWasLetGo) {
    const InputEvent to_begin = at(Kind::move, 1), press = of(Kind::press, 0), half = at(Kind::move, 2),
                     end = at(Kind::move, 3), release = of(Kind::release, 0), away = at(Kind::move, 9);
    EXPECT_EQ(frames_of({to_begin, press, half, end, release, away}),
              (Frames{{to_begin}, {press}, {half, end}, {release}, {away}}));
}

TEST(InputQueue, ADoubleClickIsTwoClicks) {
    const InputEvent press = of(Kind::press, 0), release = of(Kind::release, 0);
    EXPECT_EQ(frames_of({press, release, press, release}), (Frames{{press}, {release}, {press}, {release}}));
}

TEST(InputQueue, ClicksAtTwoPlacesStayThere) {
    const InputEvent menu = at(Kind::move, 1), item = at(Kind::move, 2), press = of(Kind::press, 0),
                     release = of(Kind::release, 0);
    EXPECT_EQ(frames_of({menu, press, release, item, press, release}),
              (Frames{{menu}, {press}, {release}, {item}, {press}, {release}}));
}

TEST(InputQueue, MovesAndNotchesAreOneFrame) {
    const InputEvent a = at(Kind::move, 1), b = at(Kind::move, 2), notch = at(Kind::wheel, 1);
    EXPECT_EQ(frames_of({a, b, notch, notch}), (Frames{{a, b, notch, notch}}));
    EXPECT_EQ(frames_of({notch, a}), (Frames{{notch}, {a}})) << "the wheel would turn what lies elsewhere";
}

TEST(InputQueue, AShortPressOfAKeyIsSeen) {
    const InputEvent down = of(Kind::key_down, '0'), up = of(Kind::key_up, '0');
    EXPECT_EQ(frames_of({down, up}), (Frames{{down}, {up}}));
}

TEST(InputQueue, AKeyPressedTwiceIsTwoPresses) {
    const InputEvent down = of(Kind::key_down, 258), up = of(Kind::key_up, 258),
                     other = of(Kind::key_down, 264);
    EXPECT_EQ(frames_of({down, up, down, up, other}), (Frames{{down}, {up}, {down}, {up, other}}));
}

TEST(InputQueue, CtrlIsHeldForAsLongAsItsKey) {
    const InputEvent ctrl = of(Kind::key_down, 341), s = of(Kind::key_down, 'S'),
                     s_up = of(Kind::key_up, 'S'), ctrl_up = of(Kind::key_up, 341);
    EXPECT_EQ(frames_of({ctrl, s, ctrl_up, s_up}), (Frames{{ctrl}, {s}, {ctrl_up, s_up}}));
}

TEST(InputQueue, WhatIsTypedWaitsUntilItMay) {
    const InputEvent move = at(Kind::move, 1), key = of(Kind::key_down, '3'),
                     three = of(Kind::character, '3');
    InputQueue queue;
    for (const InputEvent& event : {move, key, three}) queue.push(event);
    EXPECT_EQ(queue.take(Typing::later), std::vector<InputEvent>{move});
    EXPECT_TRUE(queue.take(Typing::later).empty());
    EXPECT_EQ(queue.take(), (std::vector<InputEvent>{key, three}));
}

TEST(InputQueue, KeysAndCharactersKeepTheirOrder) {
    const InputEvent ctrl = of(Kind::key_down, 341), a = of(Kind::key_down, 'A'),
                     a_up = of(Kind::key_up, 'A'), ctrl_up = of(Kind::key_up, 341),
                     key = of(Kind::key_down, '3'), three = of(Kind::character, '3'),
                     key_up = of(Kind::key_up, '3'), enter = of(Kind::key_down, 257);
    EXPECT_EQ(frames_of({ctrl, a, a_up, ctrl_up, key, three, key_up, enter}),
              (Frames{{ctrl}, {a}, {a_up, ctrl_up, key, three}, {key_up, enter}}));
}

/// A word typed in no time is a word, however long a frame takes; Enter is after it,
/// Left before what follows.
TEST(InputQueue, AWordIsOneFrameOfAText) {
    std::vector<InputEvent> word;
    for (const char letter : {'n', 'n', 'e'})
        for (const InputEvent& event :
             {of(Kind::key_down, letter - 32), of(Kind::character, letter), of(Kind::key_up, letter - 32)})
            word.push_back(event);
    std::vector<InputEvent> typed = word;
    const InputEvent enter = of(Kind::key_down, 257), left = of(Kind::key_down, 263),
                     a = of(Kind::character, 'a');
    typed.insert(typed.end(), {enter, left, a});
    EXPECT_EQ(frames_of(typed, Typing::text), (Frames{word, {enter}, {left}, {a}}));
    EXPECT_GT(frames_of(word).size(), 2u) << "three shortcuts";
    const InputEvent ctrl = of(Kind::key_down, 341), up = of(Kind::key_up, 'V');
    InputEvent v = of(Kind::key_down, 'V');
    v.modifiers = 2;
    EXPECT_EQ(frames_of({a, ctrl, v, up}, Typing::text), (Frames{{a}, {ctrl}, {v}, {up}}));
}

TEST(InputQueue, AKeyBeforeAClickIsHeldInIt) {
    const InputEvent ctrl = of(Kind::key_down, 341), press = of(Kind::press, 0),
                     release = of(Kind::release, 0), ctrl_up = of(Kind::key_up, 341);
    EXPECT_EQ(frames_of({ctrl, press, release, ctrl_up}), (Frames{{ctrl}, {press}, {release}, {ctrl_up}}));
}

// Jobs of the window: how far one is by the lines that it says, and what one that is refused or waits leaves
// on the disk.

TEST(RenderingLine, SaysTheShareOfAllFrames) {
    EXPECT_EQ(share_of_line("astrosplat: preparing 50% eta 00:00:02"), 0.5f);
    EXPECT_EQ(share_of_line("astrosplat: frame 12 (3/10) 50% eta 00:04:10"), 0.25f);
    EXPECT_EQ(share_of_line("astrosplat: frame 12 (10/10) 100% eta 00:00:00"), 1.0f);
    for (const char* other : {"", "saved a.0001.exr", "37% of nothing", "about x% more", "37%"})
        EXPECT_FALSE(share_of_line(other)) << other;
}

TEST(RenderQueue, AJobThatIsRefusedLeavesNoFolder) {
    const TempFolder folder;
    const fs::path temporary = folder / "temporary";
    fs::create_directory(temporary);
    const fs::path preset = folder.file("look.toml", "astrosplat = 1\n[look]\ndensity = 0.5\n");
    const std::string scene =
        "astrosplat = 1\n[[layer]]\nname = \"a\"\npreset = \"look.toml\"\n"
        "[layer.source]\nmeshes = [ { mesh = \"plane\", texture = \"a.png\" } ]\n";
    const Document document = Document::open(folder.file("scene.toml", scene));
    fs::remove(preset);  // without it the scene cannot be written
    const Variable place("TMPDIR", temporary.c_str());
    RenderQueue jobs(SetCache{}, "astrosplat");
    EXPECT_THROW(jobs.add(make_render_task(document, RenderKind::range, 1.0), document), InputError);
    EXPECT_TRUE(jobs.jobs().empty());
    EXPECT_TRUE(fs::is_empty(temporary));
}

TEST(RenderQueue, AJobThatWaitsLeavesNothingBehind) {
    const TempFolder folder;
    const fs::path temporary = folder / "tmp";
    fs::create_directories(temporary);
    const Variable place("TMPDIR", temporary.c_str());
    const Document document =
        Document::open(folder.file("scene.toml",
                                   "astrosplat = 1\n[[layer]]\nname = \"a\"\n[layer.source]\n"
                                   "meshes = [ { mesh = \"plane\", texture = \"a.png\" } ]\n"));
    RenderQueue jobs(SetCache{}, "astrosplat");
    jobs.add(make_render_task(document, RenderKind::range, 1.0), document);
    EXPECT_FALSE(fs::is_empty(temporary)) << "the scene as it is now";
    jobs.cancel(1);
    EXPECT_TRUE(fs::is_empty(temporary));
    EXPECT_EQ(jobs.jobs()[0].state, QueuedJob::State::cancelled);
    jobs.remove(1);
    EXPECT_TRUE(jobs.jobs().empty());
    {
        RenderQueue dropped(SetCache{}, "astrosplat");
        dropped.add(make_render_task(document, RenderKind::range, 1.0), document);
    }
    EXPECT_TRUE(fs::is_empty(temporary));
}

}  // namespace
}  // namespace astrosplat::test

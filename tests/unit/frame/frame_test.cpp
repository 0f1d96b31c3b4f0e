// Frames: means of renderings, their names, and their hash.
#include "core/file.h"
#include "frame/frame_hash.h"
#include "frame/frame_scene.h"
#include "frame/output_pattern.h"
#include "scene/camera_file.h"
#include "scene/describe.h"
#include "scene/load.h"
#include "support/all_values.h"
#include "support/color_config.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Means of renderings by hand: light, depth by opacity, and layers that only some of them show.

/// Of one pixel: everything `light`, at `depth`, before an environment.
RenderedFrame rendering(float light, float opacity, float depth, std::size_t layers) {
    RenderedFrame frame;
    frame.beauty = make_image(1, 1, 4, light);
    frame.depth = make_image(1, 1, 1, depth);
    frame.opacity = make_image(1, 1, 1, opacity);
    frame.layers.assign(layers, make_image(1, 1, 4, light));
    frame.statistics = {100, 10, 2.0, 0.5, {}, {}};
    return frame;
}

TEST(MeanFrame, LightIsTheMeanAndDepthIsWeightedByOpacity) {
    RenderedFrame sum;
    add_rendering(sum, rendering(1.0f, 0.75f, 2.0f, 0), {});
    add_rendering(sum, rendering(0.5f, 0.25f, 10.0f, 0), {});
    divide_sum(sum, 2, 0);
    EXPECT_EQ(sum.beauty.pixels[0], 0.75f);
    EXPECT_EQ(sum.depth.pixels[0], 4.0f);
    EXPECT_TRUE(sum.layers.empty());
    EXPECT_EQ(sum.statistics.splats_in, 100);
    EXPECT_EQ(sum.statistics.splats_drawn, 10);
    EXPECT_EQ(sum.statistics.mean_overlap, 2.0);
    EXPECT_EQ(sum.statistics.seconds, 1.0);
}

TEST(MeanFrame, DepthIsNothingWhereNothingIsSeen) {
    RenderedFrame sum;
    for (int i = 0; i < 2; ++i) add_rendering(sum, rendering(1.0f, 0.0f, 0.0f, 0), {});
    divide_sum(sum, 2, 0);
    EXPECT_EQ(sum.depth.pixels[0], 0.0f);
}

TEST(MeanFrame, ALayerThatOneRenderingShowsHasItsShareInItsPlace) {
    RenderedFrame sum;
    const std::array<std::size_t, 1> third = {2}, first = {0};
    add_rendering(sum, rendering(1.0f, 1.0f, 1.0f, 1), third);
    add_rendering(sum, rendering(0.5f, 1.0f, 1.0f, 1), first);
    add_rendering(sum, rendering(0.0f, 1.0f, 1.0f, 0), {});
    add_rendering(sum, rendering(1.0f, 1.0f, 1.0f, 1), third);
    divide_sum(sum, 4, 4);
    ASSERT_EQ(sum.layers.size(), 4u);
    for (const auto& [layer, light] : {std::pair{0, 0.125f}, {1, 0.0f}, {2, 0.5f}, {3, 0.0f}})
        EXPECT_EQ(sum.layers[std::size_t(layer)].pixels[0], light) << layer;
}

// Frame numbers and eyes in file names, and folders whose names look like them.

std::string frame_file(const std::string& name, std::int64_t frame, Eye eye = Eye::centre) {
    return OutputPattern{"", name}.resolve(frame, eye).string();
}

bool is_stereo(const std::string& name) { return OutputPattern{"", name}.is_stereo(); }
bool is_numbered(const std::string& name) { return OutputPattern{"", name}.is_numbered(); }

TEST(OutputPattern, EveryPatternPadsWithZeros) {
    EXPECT_EQ(frame_file("frames/shot.####.exr", 12), "frames/shot.0012.exr");
    EXPECT_EQ(frame_file("shot.%04d.exr", 12), "shot.0012.exr");
    EXPECT_EQ(frame_file("shot.{frame:04}.exr", 12), "shot.0012.exr");
    EXPECT_EQ(frame_file("shot.{frame:04d}.exr", 12), "shot.0012.exr");
    EXPECT_EQ(frame_file("#.png", 12), "12.png");
    EXPECT_EQ(frame_file("%d.png", 7), "7.png");
    EXPECT_EQ(frame_file("{frame}.png", 7), "7.png");
    EXPECT_EQ(frame_file("####.png", 123456), "123456.png");
}

TEST(OutputPattern, PairsHaveTheirEyeInTheName) {
    EXPECT_EQ(frame_file("%V/shot.%v.####.exr", 12, Eye::left), "left/shot.l.0012.exr");
    EXPECT_EQ(frame_file("shot.%04d.%V.exr", 12, Eye::right), "shot.0012.right.exr");
    EXPECT_EQ(frame_file("shot.%V.png", 12), "shot.centre.png");
    EXPECT_TRUE(is_stereo("%V.####.exr") && is_stereo("%v.exr"));
    EXPECT_FALSE(is_stereo("V.%04d.exr") || is_stereo("100%"));
}

TEST(OutputPattern, NegativeFramesKeepTheirDigits) {
    EXPECT_EQ(frame_file("a.####.exr", -5), "a.-0005.exr");
    EXPECT_EQ(frame_file("a.%03d.exr", -5), "a.-005.exr");
    EXPECT_EQ(frame_file("a.{frame}.exr", -5), "a.-5.exr");
    EXPECT_EQ(frame_file("a.#.exr", INT64_MIN), "a.-9223372036854775808.exr");
}

TEST(OutputPattern, OtherTextIsLeftAlone) {
    for (const char* name :
         {"100%.exr", "50%of{frames}.exr", "{frame:}.exr", "{frame:x}.exr", "ünter 1.exr", ""}) {
        EXPECT_EQ(frame_file(name, 3), name);
        EXPECT_FALSE(is_numbered(name)) << name;
    }
    EXPECT_EQ(frame_file("ünter 100% ##.exr", 3), "ünter 100% 03.exr");
    EXPECT_TRUE(is_numbered("a.%d.exr"));
}

TEST(OutputPattern, TwoPlacesAreAnError) {
    const std::string expected =
        "output.path: expected one place for the frame number (####, %04d or {frame:04}), found more in "
        "'#/shot.%04d.exr'";
    EXPECT_EQ(ERROR_OF(output_pattern("/a", "#/shot.%04d.exr")), expected);
    EXPECT_EQ(ERROR_OF(frame_file("#/shot.%04d.exr", 1)), expected);
}

TEST(OutputPattern, TheFolderIsTakenAsItIs) {
    const OutputPattern pattern{"/films/C#1 100%v {frame}", "shot.####.exr"};
    EXPECT_EQ(pattern.resolve(5), "/films/C#1 100%v {frame}/shot.0005.exr");
    EXPECT_FALSE(pattern.is_stereo());
    EXPECT_FALSE((OutputPattern{"/films/####", "shot.exr"}.is_numbered()));
    EXPECT_EQ(output_pattern("/no such C#1/%V", "still.exr").resolve(5), "/no such C#1/%V/still.exr");
}

TEST(OutputPattern, WrittenFoldersThatExistAreTakenAsTheyAre) {
    const TemporaryFolder folder;
    fs::create_directories(folder.path() / "C#1" / "{frame}");
    const OutputPattern inside = output_pattern(folder.path(), "C#1/{frame}/%V/shot.####.exr");
    EXPECT_EQ(inside.folder, folder.path() / "C#1" / "{frame}");
    EXPECT_EQ(inside.resolve(5, Eye::left), folder.path() / "C#1/{frame}/left/shot.0005.exr");
    EXPECT_EQ(output_pattern("/", (folder.path() / "C#1/a.%04d.exr").string()).resolve(5),
              folder.path() / "C#1/a.0005.exr");
    EXPECT_EQ(output_pattern(folder.path(), "C#2/a.exr").resolve(5), folder.path() / "C52/a.exr");
}

TEST(OutputPattern, FramesHaveAFolderInCommon) {
    EXPECT_EQ(output_pattern("/films/C#1", "a/b/%V/shot.####.exr").common_folder(), "/films/C#1/a/b");
    EXPECT_EQ(output_pattern("/films", "shot.####.exr").common_folder(), "/films");
}

TEST(OutputPattern, FilesOfAllFramesAreCalledByTheStem) {
    for (const char* name :
         {"a/shot.####.exr", "shot_%04d.png", "shot-{frame:04}.tif", "shot.%V.####.exr", "shot.exr"})
        EXPECT_EQ((OutputPattern{"", name}.stem()), "shot") << name;
    EXPECT_EQ((OutputPattern{"", "####.exr"}.stem()), "frame");
}

TEST(OutputPattern, APairNeedsACameraWithTwoEyes) {
    CameraParams camera;
    camera.eye = Eye::right;
    EXPECT_EQ(eyes_of({"", "a.####.exr"}, camera), std::vector{Eye::right});
    EXPECT_EQ(eyes_of({"", "%V/a.####.exr"}, camera), (std::vector{Eye::left, Eye::right}));
    camera.projection = Projection::fisheye;
    EXPECT_THROW(eyes_of({"", "%V/a.####.exr"}, camera), InputError);
}

// The frame hash changes with everything that reaches the frame's pixels, and with nothing else.

class FrameHashTest : public testing::Test {
  protected:
    FrameHashTest() {
        put("stars.png", "one");
        put("dust.pda", "two");
        put("sky.exr", "three");
        put("disk.obj",
            "mtllib disk.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n");
        put("disk.mtl", "newmtl m\nmap_Kd own.png\n");
        put("own.png", "four");
    }

    void put(const std::string& name, const std::string& text) { folder_.file(name, text); }

    Scene scene() {
        return parse_scene(R"(astrosplat = 1
[environment]
image = "sky.exr"
[[layer]]
name = "stars"
[layer.source]
meshes = [ { mesh = "plane", texture = "stars.png" } ]
[[layer]]
name = "dust"
[layer.source]
kind = "splats"
file = "dust.pda"
[animation]
"camera.position" = { keys = [[1, [0, 0, 30]], [10, [0, 2, 4]], [20, [0, 2, 4]]], interpolation = "linear" }
"layer.dust.visible" = { keys = [[1, true], [15, false]] }
)",
                           folder_ / "scene.toml");
    }

    std::string hash(const Scene& scene, std::int64_t frame = 1) {
        return FrameHasher().frame_hash(frame_scene(scene, double(frame)));
    }
    std::string text(const Scene& scene) { return FrameHasher().canonical_text(frame_scene(scene, 1.0)); }
    std::string changed(const std::function<void(Scene&)>& change, std::int64_t frame = 1) {
        Scene other = scene();
        change(other);
        return hash(other, frame);
    }

    TempFolder folder_;
};

TEST_F(FrameHashTest, FilesThatChangedSinceAreRefused) {
    FrameHasher hasher;
    hasher.frame_hash(frame_scene(scene(), 1.0));
    EXPECT_EQ(hasher.files().size(), 3u);
    EXPECT_NO_THROW(check_unchanged(hasher.files()));
    put("dust.pda", "two");
    EXPECT_NO_THROW(check_unchanged(hasher.files())) << "the same bytes";
    const std::atomic<bool> cancelled{true};
    EXPECT_THROW(check_unchanged(hasher.files(), {{}, &cancelled}), Cancelled)
        << "before they are hashed again";
    put("dust.pda", "2!!");
    EXPECT_EQ(ERROR_OF(check_unchanged(hasher.files())),
              (folder_ / "dust.pda").string() +
                  ": expected the file that the frames were planned with, found a change since; start again");
    fs::remove(folder_ / "dust.pda");
    EXPECT_THROW(check_unchanged(hasher.files()), InputError);
}

TEST_F(FrameHashTest, MaterialsAndTheirPicturesCount) {
    Scene own = scene();
    own.layers[0].source.meshes = {{folder_ / "disk.obj", {}, 0.15}};
    FrameHasher hasher;
    const std::string before = hasher.frame_hash(frame_scene(own, 1.0));
    for (const char* name : {"disk.obj", "disk.mtl", "own.png"})
        EXPECT_TRUE(hasher.files().count(folder_ / name)) << name;
    put("own.png", "five");
    EXPECT_NE(hash(own), before);
    EXPECT_THROW(check_unchanged(hasher.files()), InputError);
}

TEST_F(FrameHashTest, IsSixtyFourHexDigitsAndStable) {
    EXPECT_EQ(hash(scene()).size(), 64u);
    EXPECT_EQ(hash(scene()), hash(scene()));
    FrameHasher hasher;
    const std::string first = hasher.frame_hash(frame_scene(scene(), 3.0));
    hasher.frame_hash(frame_scene(scene(), 7.0));
    EXPECT_EQ(hasher.frame_hash(frame_scene(scene(), 3.0)), first);
}

TEST_F(FrameHashTest, IgnoresWhereAndHowOftenFramesGo) {
    const std::string before = hash(scene());
    EXPECT_EQ(changed([](Scene& s) { s.output.path = "other.####.exr"; }), before);
    EXPECT_EQ(changed([](Scene& s) { s.output.frames = "5-9"; }), before);
    EXPECT_EQ(changed([](Scene& s) { s.output.fps = 30; }), before);
    EXPECT_EQ(changed([](Scene& s) { s.output.compression = OutputParams::Compression::none; }), before);
    EXPECT_EQ(changed([](Scene& s) { s.provenance = {"a", "b", "Simulation"}; }), before);
    EXPECT_EQ(changed([](Scene& s) { s.references.resize(1); }), before);
    EXPECT_EQ(changed([](Scene& s) { s.light_years_per_unit = 30.0; }), before);
    EXPECT_EQ(changed([](Scene& s) { s.layers[0].preset = "old.toml"; }), before);
}

// The scale of a scene reaches pixels where stars are placed by it, and counts as their unit.
TEST_F(FrameHashTest, TheScaleCountsAsTheUnitOfStars) {
    const auto of_stars = [&](double light_years_per_unit, std::optional<double> unit) {
        return changed([&](Scene& s) {
            s.light_years_per_unit = light_years_per_unit;
            s.layers[0].source.kind = SourceKind::stars;
            s.layers[0].source.stars.catalogue = folder_ / "stars.png";
            s.layers[0].source.stars.unit = unit;
        });
    };
    const std::string plain = of_stars(0.0, {});
    EXPECT_EQ(of_stars(0.0, 1.0), plain) << "as before there was a scale";
    EXPECT_NE(of_stars(30.0, {}), plain);
    EXPECT_EQ(of_stars(30.0, {}), of_stars(0.0, parsec_ly / 30.0));
    EXPECT_EQ(of_stars(30.0, 1.0), plain) << "its own unit wins";
    EXPECT_NE(text(scene()).find("layer.stars.source.unit = 1.0\n"), std::string::npos);
}

TEST_F(FrameHashTest, EveryOtherParameterCounts) {
    // Every numeric or boolean parameter of the scene, changed through its description.
    const std::set<std::string> of_others = {"output.fps",
                                             "camera.position",  // keyed, or not seen
                                             "layer.source.like",
                                             "layer.source.depth",
                                             "layer.source.slab",           // of stars of a picture
                                             "scene.light_years_per_unit",  // of stars of a catalogue
                                             "camera.eye_separation",
                                             "camera.convergence",  // of pairs
                                             "camera.focus_distance",
                                             "camera.unit_mm",
                                             "output.samples"};  // of blurs
    Scene original = scene();
    const std::string before = hash(original, 5);
    int tried = 0;
    for (std::size_t i = 0; i < describe(original).parameters.size(); ++i) {
        Scene other = scene();
        Description description = describe(other);
        const Parameter& parameter = description.parameters[i];
        const std::string& key = parameter.spec.generic_key;
        if (of_others.contains(key) || parameter.spec.key == "layer.dust.visible") continue;
        if (key.starts_with("camera.file_") || key.starts_with("environment.tile_")) continue;  // of no file
        if (parameter.spec.section == "Star image") continue;  // of layers that are stars
        if (is_of_another_lens(parameter.spec, other.camera.projection)) continue;
        const Value value = parameter.get();
        if (parameter.spec.type != ParameterType::number && parameter.spec.type != ParameterType::boolean)
            continue;
        if (const bool* flag = std::get_if<bool>(&value.data))
            parameter.set(!*flag);
        else if (value.is_number())
            parameter.set(from_numbers(parameter.spec, {value.number() == 0.5 ? 0.75 : 0.5}));
        else
            continue;
        ++tried;
        EXPECT_NE(hash(other, 5), before) << parameter.spec.key;
    }
    EXPECT_GT(tried, 60);
}

// The shutter sees frames on either side, so what moves there counts, and only there.
TEST_F(FrameHashTest, AnOpenShutterSeesWhatMovesAroundTheFrame) {
    const auto with_end = [&](double shutter, double last_key, double value) {
        return changed(
            [&](Scene& s) {
                s.camera.shutter = shutter;
                Track track{ParameterKey("camera.roll"), {}};
                track.interpolation = Interpolation::linear;
                track.keyframes.emplace_back(1.0, std::vector<double>{0.0}, Interpolation::linear);
                track.keyframes.emplace_back(5.0, std::vector<double>{10.0}, Interpolation::linear);
                track.keyframes.emplace_back(last_key, std::vector<double>{value}, Interpolation::linear);
                s.animation = {track};
            },
            5);
    };
    EXPECT_EQ(with_end(0.0, 6.0, 20.0), with_end(0.0, 6.0, 40.0));
    EXPECT_NE(with_end(180.0, 6.0, 20.0), with_end(180.0, 6.0, 40.0));
}

// A layer or a sky that only some of the shutter's moments show counts with all its keys, moving or not.
TEST_F(FrameHashTest, WhatIsVisibleWithinTheShutterCounts) {
    const auto switched = [&](const char* key, const auto& change, std::vector<double> at_frame,
                              std::vector<double> after) {
        return changed(
            [&](Scene& s) {
                s.camera.shutter = 180.0;
                Track track{ParameterKey(key), {}};
                track.keyframes.emplace_back(1.0, at_frame, Interpolation::step);
                track.keyframes.emplace_back(5.1, after, Interpolation::step);
                s.animation = {track};
                change(s);
            },
            5);
    };
    const auto nothing = [](Scene&) {};
    const auto thinner = [](Scene& s) { s.layers[1].look.density = 0.25; };
    const auto brighter = [](Scene& s) { s.environment.gain = 2.0f; };
    const auto other_file = [&](Scene& s) { s.layers[1].source.file = folder_ / "stars.png"; };
    for (const auto& [first, then] : {std::pair{0.0, 1.0}, std::pair{1.0, 0.0}}) {
        const std::string dust = switched("layer.dust.visible", nothing, {first}, {then});
        EXPECT_NE(switched("layer.dust.visible", thinner, {first}, {then}), dust) << first;
        EXPECT_NE(switched("layer.dust.visible", other_file, {first}, {then}), dust) << first;
        EXPECT_NE(switched("environment.visible", brighter, {first}, {then}),
                  switched("environment.visible", nothing, {first}, {then}))
            << first;
    }
    EXPECT_EQ(switched("layer.dust.visible", thinner, {0.0}, {0.0}),
              switched("layer.dust.visible", nothing, {0.0}, {0.0}))
        << "at no moment";
}

TEST_F(FrameHashTest, EyesCountWhereThereAreTwo) {
    const auto of_eye = [&](Eye eye, double separation, Projection projection = Projection::perspective) {
        return changed([&](Scene& s) {
            s.camera.eye = eye;
            s.camera.eye_separation = separation;
            s.camera.projection = projection;
        });
    };
    EXPECT_EQ(of_eye(Eye::centre, 1.0), of_eye(Eye::centre, 2.0));
    EXPECT_NE(of_eye(Eye::left, 1.0), of_eye(Eye::left, 2.0));
    EXPECT_NE(of_eye(Eye::left, 1.0), of_eye(Eye::right, 1.0));
    EXPECT_EQ(of_eye(Eye::left, 1.0, Projection::fisheye), of_eye(Eye::right, 1.0, Projection::fisheye));
    EXPECT_EQ(FrameHasher().frame_hash(frame_scene(scene(), 1.0, Eye::right)),
              changed([](Scene& s) { s.camera.eye = Eye::right; }));
}

TEST_F(FrameHashTest, AConfigurationCountsWhereAViewIsWritten) {
    const fs::path config = test::write_color_config(folder_.path());
    const auto managed = [&](const std::string& file, const OcioParams& ocio) {
        return changed([&](Scene& s) {
            s.output.path = file;
            s.output.ocio = ocio;
        });
    };
    EXPECT_EQ(managed("a.exr", {config, "", "", ""}), hash(scene())) << "scene light knows no view";
    EXPECT_EQ(managed("a.png", {}), changed([](Scene& s) { s.output.path = "a.png"; }));
    const std::string film = managed("a.png", {config, "", "", ""});
    EXPECT_NE(film, managed("a.png", {}));
    EXPECT_EQ(film, managed("a.png", {config, "Screen", "Film", ""})) << "the names that are used";
    EXPECT_NE(film, managed("a.png", {config, "", "Plain", ""}));
    EXPECT_NE(film, managed("a.png", {config, "", "", "doubled"}));
    Scene other = scene();
    other.output.path = "a.png";
    other.output.ocio.config = config;
    const std::string text = this->text(other);
    EXPECT_HAS(text, "OpenColorIO " + ocio_version());
    EXPECT_EQ(text.find("output.view"), std::string::npos) << "which has no effect";
    std::ofstream(config, std::ios::app) << "# more\n";
    EXPECT_NE(film, managed("a.png", {config, "", "", ""}));
}

TEST_F(FrameHashTest, KeysOfOtherLensesAndOfBlursThatAreOffAreLeftOut) {
    EXPECT_NE(changed([](Scene& s) { s.output.primaries = OutputParams::Primaries::acescg; }), hash(scene()));
    for (const char* key : {"camera.eye", "camera.convergence", "camera.fisheye_tilt", "camera.f_number",
                            "camera.focus_distance", "camera.unit_mm", "output.samples"})
        EXPECT_EQ(text(scene()).find(key), std::string::npos) << key;
    EXPECT_NE(changed([](Scene& s) { s.camera.shift.x = 0.1; }), hash(scene()));
    EXPECT_NE(changed([](Scene& s) { s.camera.shutter = 90.0; }), hash(scene()));
    EXPECT_NE(changed([](Scene& s) { s.camera.f_number = 2.0; }), hash(scene()));
}

/// All numbers of the camera that a frame is seen with.
std::vector<double> camera_numbers(const CameraParams& params) {
    Bounds box;
    box.add({-2.0, -1.0, -3.0});
    box.add({1.0, 2.0, 0.5});
    const Camera c = through_lens(make_camera(params, 640, 480, box), params, {0.3, -0.6}, 640);
    std::vector<double> numbers{c.focal_px,  c.center_x_px, c.center_y_px, c.near,           c.far,
                                c.near_fade, c.edge,        c.parallax,    c.target_distance};
    for (int k = 0; k < 3; ++k) numbers.push_back(c.eye[k]);
    for (int k = 0; k < 9; ++k) numbers.push_back(c.world_from_camera[k / 3][k % 3]);
    return numbers;
}

// What the hash leaves out reaches no camera, and what it does not is left out of no other.
TEST_F(FrameHashTest, ALensCountsWhereItIsTheCameras) {
    std::map<std::string, std::set<bool>> counted;  // by key: of which projections
    for (const Projection projection : test::all_values<Projection>)
        for (const bool placed : {true, false}) {
            Scene scene;
            scene.camera.projection = projection;
            scene.camera.eye = Eye::left;
            scene.camera.f_number = 4.0;
            scene.camera.focal_length = 0.0;
            if (placed) scene.camera.position = glm::dvec3(1.0, 2.0, 30.0);
            const std::vector<double> before = camera_numbers(scene.camera);
            const std::string text = this->text(scene);
            const Description description = describe(scene);
            for (const Parameter& parameter : description.parameters) {
                const std::string& key = parameter.spec.key.text();
                const Value value = parameter.get();
                if (!key.starts_with("camera.") || parameter.spec.type != ParameterType::number) continue;
                const bool counts = text.find(key + " =") != std::string::npos;
                counted[key].insert(counts);
                if (counts) continue;
                parameter.set(from_numbers(parameter.spec, {value.number() == 0.5 ? 0.75 : 0.5}));
                EXPECT_EQ(camera_numbers(scene.camera), before) << key << ", " << name_of(projection);
                parameter.set(value);
            }
        }
    for (const char* key : {"camera.fisheye_fov", "camera.fisheye_tilt", "camera.panorama_fov",
                            "camera.f_number", "camera.convergence", "camera.height"})
        EXPECT_EQ(counted[key].size(), 2u) << key;
    for (const char* key : {"camera.fov", "camera.near"}) EXPECT_EQ(counted[key], std::set{true}) << key;
}

TEST_F(FrameHashTest, MixingInDisplayValuesCountsWhereItIsDone) {
    EXPECT_EQ(text(scene()).find("render.space"), std::string::npos);
    const auto display = [](Scene& s) { s.layers[0].render.space = BlendSpace::display; };
    EXPECT_EQ(changed(display), hash(scene()));
    const auto alone = [](Scene& s) { s.layers[0].render.isolate = true; };
    EXPECT_NE(changed([&](Scene& s) { alone(s), display(s); }), changed(alone));
}

TEST_F(FrameHashTest, TheImageOfStarsCountsForStarsAlone) {
    EXPECT_EQ(text(scene()).find("wings"), std::string::npos);
    EXPECT_EQ(text(scene()).find("spikes"), std::string::npos);
    const auto stars = [](Scene& s) { s.layers[0].source.kind = SourceKind::stars; };
    const std::string before = changed(stars);
    EXPECT_NE(before, changed([&](Scene& s) { stars(s), s.layers[0].source.stars.psf = 2.0; }));
    EXPECT_NE(before, changed([&](Scene& s) { stars(s), s.layers[0].source.stars.wings.share = 0.25; }));
    EXPECT_NE(before, changed([&](Scene& s) { stars(s), s.layers[0].source.stars.spikes.vanes = 3; }));
}

// Stars of a picture lie where that picture's layer has it, even one that is not seen; keys of others do
// not count.
TEST_F(FrameHashTest, TheLayerOfAPictureCountsForItsStars) {
    EXPECT_EQ(text(scene()).find("source.like"), std::string::npos);
    EXPECT_EQ(text(scene()).find("source.slab"), std::string::npos);
    EXPECT_EQ(text(scene()).find("environment.tile"), std::string::npos);
    const auto stars = [](Scene& s) {
        s.layers[0].visible = false;
        s.layers[1].visible = true;
        std::erase_if(s.animation,
                      [](const Track& t) { return t.key.text().find("visible") != std::string::npos; });
        s.layers[1].source.kind = SourceKind::stars;
        s.layers[1].source.stars.like = s.layers[0].name;
    };
    const std::string before = changed(stars);
    EXPECT_NE(before, changed([&](Scene& s) { stars(s), s.layers[0].source.structure.depth = 0.5; }));
    EXPECT_NE(before, changed([&](Scene& s) { stars(s), s.layers[0].transform.scale = 2.0; }));
    EXPECT_NE(before, changed([&](Scene& s) { stars(s), s.layers[1].source.stars.slab = 2.0; }));
    const auto of_none = [&](Scene& s) { stars(s), s.layers[1].source.stars.like.clear(); };
    EXPECT_EQ(changed(of_none),
              changed([&](Scene& s) { of_none(s), s.layers[0].source.structure.depth = 0.5; }));
}

TEST_F(FrameHashTest, TheWholePathCountsForStarsAlongIt) {
    const auto stars = [](Scene& s) {
        s.layers[0].source.kind = SourceKind::stars;
        s.layers[0].source.stars.along = "camera";
    };
    const auto moved = [&](Scene& s) {
        stars(s);
        for (Track& track : s.animation)
            if (track.key == "camera.position") track.keyframes[2].value = {9, 9, 9};
    };
    EXPECT_NE(changed(stars, 1), changed(moved, 1));
}

TEST_F(FrameHashTest, OnlyTheFramesAKeyframeReachesChange) {
    const auto move_last_keyframe = [](Scene& s) {
        for (Track& track : s.animation)
            if (track.key == "camera.position") track.keyframes[2].value = {9, 9, 9};
    };
    EXPECT_EQ(changed(move_last_keyframe, 1), hash(scene(), 1));
    EXPECT_EQ(changed(move_last_keyframe, 10), hash(scene(), 10));
    EXPECT_NE(changed(move_last_keyframe, 11), hash(scene(), 11));
    EXPECT_NE(hash(scene(), 1), hash(scene(), 2));
    EXPECT_EQ(hash(scene(), 16), hash(scene(), 19));  // nothing moves there: the same picture
}

TEST_F(FrameHashTest, ACameraFileCountsByWhatItSaysAtTheFrame) {
    const auto with = [&](const std::string& text, std::int64_t frame) {
        put("cam.chan", text);
        Scene s = scene();
        s.camera.file = folder_ / "cam.chan";
        attach_camera_file(s, "");
        return hash(s, frame);
    };
    const std::string before = "1 0 0 5 0 0 0\n2 0 0 6 0 0 0\n3 0 0 7 0 0 0\n";
    const std::string after = "1 0 0 5 0 0 0\n2 0 0 6 0 0 0\n3 0 0 7 0 1 0\n";
    EXPECT_EQ(with(after, 2), with(before, 2));
    EXPECT_NE(with(after, 3), with(before, 3));
    EXPECT_NE(with(before, 1), hash(scene(), 1));
    Scene keys = scene();  // the same place and turn, written as keys
    keys.camera.rotation = glm::dvec4(0, 0, 0, 1);
    for (Track& track : keys.animation)
        if (track.key == "camera.position") track.keyframes = {{1.0, {0, 0, 5}, Interpolation::linear}};
    EXPECT_EQ(with(before, 1), hash(keys, 1));
    EXPECT_EQ(text(scene()).find("file_"), std::string::npos) << "frames keep their hash";
}

TEST_F(FrameHashTest, HiddenLayersAndSkiesDoNotCount) {
    const auto change_dust = [](Scene& s) { s.layers[1].look.density = 0.1f; };
    EXPECT_NE(changed(change_dust, 5), hash(scene(), 5));
    EXPECT_EQ(changed(change_dust, 16), hash(scene(), 16));
    const auto hide = [](Scene& s) { s.environment.visible = false; };
    EXPECT_NE(changed(hide), hash(scene()));
    EXPECT_EQ(changed(hide), changed([&](Scene& s) {
                  hide(s);
                  s.environment.gain = 7;
                  s.environment.image.clear();
              }));
}

TEST_F(FrameHashTest, InputsCountByTheirBytesNotByTheirNames) {
    const std::string before = hash(scene());
    for (const char* name : {"stars.png", "dust.pda", "sky.exr"}) {
        put(name, "changed");
        EXPECT_NE(hash(scene()), before) << name;
        put(name,
            name == std::string("stars.png") ? "one" : (name == std::string("dust.pda") ? "two" : "three"));
        EXPECT_EQ(hash(scene()), before) << name;
    }
    fs::copy_file(folder_ / "sky.exr", folder_ / "moved.exr");
    EXPECT_EQ(changed([&](Scene& s) { s.environment.image = folder_ / "moved.exr"; }), before);
}

TEST_F(FrameHashTest, AMeshsOwnPicturesCount) {
    const auto own = [&](Scene& s) {
        s.layers[0].source.meshes[0].mesh = folder_ / "disk.obj";
        s.layers[0].source.meshes[0].texture.clear();
    };
    const std::string before = changed(own);
    put("own.png", "changed");
    EXPECT_NE(changed(own), before);
}

TEST_F(FrameHashTest, TheRegionCounts) {
    const FrameScene frame = frame_scene(scene(), 1.0);
    const std::string part = FrameHasher({10, 10, 50, 40}).frame_hash(frame);
    EXPECT_NE(FrameHasher().frame_hash(frame), part);
    EXPECT_NE(FrameHasher({10, 10, 50, 41}).frame_hash(frame), part);
}

TEST_F(FrameHashTest, CanonicalTextShowsWhatIsHashed) {
    const std::string text = this->text(scene());
    EXPECT_EQ(text.rfind("pixels = 5\n", 0), 0u);
    EXPECT_HAS(text, "\ncamera.position = [0.0, 0.0, 30.0]\n");
    EXPECT_HAS(text, "\nlayer.stars.source.meshes.0.mesh = \"plane\"\n");
    EXPECT_EQ(text.find(folder_.path().string()), std::string::npos) << text;
}

}  // namespace
}  // namespace astrosplat

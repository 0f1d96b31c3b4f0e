// Properties that hold wherever features cross: one a case, over scenes drawn from seeds (crossing.h). In the
// lane ci these are the fewest seeds that let every pair of features meet; at night others follow. A scene
// that fails names its seed and prints its text; alone it runs as
//   ASTROSPLAT_CROSSING=SEED test_cross --gtest_filter='Seeds/*'  (or 'Runs/*')
#include "cross/crossing.h"
#include "cross/inputs.h"
#include "cross/rendering.h"
#include "edit/command_lines.h"
#include "edit/document.h"
#include "edit/layers.h"
#include "output/metadata.h"
#include "output/write.h"
#include "scene/animate.h"
#include "scene/describe.h"
#include "scene/load.h"
#include "source/texture.h"
#include "support/printing.h"
#include "support/random_values.h"
#include "support/run_program.h"
#include "support/test.h"

namespace astrosplat::test {
namespace {

constexpr std::uint32_t pool = 1500;  // seeds that those of the lane ci are chosen from

/// A scene file in a folder that is named as the crossing has it; its text is printed where a case fails.
class Crossings : public testing::TestWithParam<std::uint32_t> {
  protected:
    Crossings() : crossing(crossing_of(GetParam())), text(scene_text(crossing)) {
        folder = outside.path() / folder_name(crossing);
        fs::create_directories(folder);
        std::ofstream(folder / "scene.toml", std::ios::binary) << text;
        if (crossing.path == CameraPath::csv_file)
            std::ofstream(folder / camera_table_name, std::ios::binary) << camera_table(crossing);
        scene = load_scene(folder / "scene.toml");
    }
    ~Crossings() override {
        if (HasFailure())
            ADD_FAILURE() << "ASTROSPLAT_CROSSING=" << GetParam() << " in '" << folder_name(crossing)
                          << "':\n"
                          << text << camera_table(crossing);
    }

    double frame() const { return double(crossing_frame); }
    Eye eye() const { return eyes_of(crossing).back(); }

    Quiet quiet;
    Crossing crossing;
    std::string text;
    TempFolder outside;
    fs::path folder;
    Scene scene;
};

/// Those chosen, or the one that a person asks for.
std::vector<std::uint32_t> seeds_or_one(std::vector<std::uint32_t> (*chosen)()) {
    if (const char* const alone = std::getenv("ASTROSPLAT_CROSSING"))
        return {std::uint32_t(std::strtoul(alone, nullptr, 10))};
    return chosen();
}

std::string seed_name(const testing::TestParamInfo<std::uint32_t>& info) {
    return std::to_string(info.param);
}

constexpr std::uint32_t nightly_seeds = 400;

// --- pictures ---

/// The first value of two images that differs by more than `within`, relative above 1; empty: none.
std::string difference(const Image& found, const Image& expected, double within) {
    if (found.pixels.size() != expected.pixels.size())
        return fmt::format("{} values, expected {}", found.pixels.size(), expected.pixels.size());
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        const double a = double(found.pixels[i]), b = double(expected.pixels[i]);
        if (!(std::fabs(a - b) <= within * std::fmax(1.0, std::fabs(b))))
            return fmt::format("value {} of pixel {}: {}, expected {}", i % std::size_t(expected.channels),
                               i / std::size_t(expected.channels), a, b);
    }
    return "";
}

void add(Image& sum, const Image& image, double weight = 1.0) {
    if (sum.pixels.empty()) sum = make_image(image.width, image.height, image.channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        sum.pixels[i] = float(double(sum.pixels[i]) + weight * double(image.pixels[i]));
}

std::map<std::string, Image> by_name(const Shot& shot) {
    std::map<std::string, Image> layers;
    for (std::size_t i = 0; i < shot.frame.layers.size(); ++i)
        layers[i < shot.layers.size() ? shot.layers[i] : "unnamed"] = shot.frame.layers[i];
    return layers;
}

Image colors_of(const Image& rgba) {
    Image colors = rgba;
    for (std::size_t i = 3; i < colors.pixels.size(); i += 4) colors.pixels[i] = 0.0f;
    return colors;
}

bool has_lighten(const Crossing& c) {
    return std::ranges::any_of(c.layers, [](const CrossingLayer& l) { return l.blend == Blend::lighten; });
}

/// The light of the sky as it arrives: it grows with the sky's gain, and nothing else does.
Image light_of_sky(Window& window, Scene scene, double frame, Eye eye, const Image& beauty) {
    scene.environment.gain *= 2.0f;
    Image light = window.shot_of(scene, frame, eye).frame.beauty;
    add(light, beauty, -1.0);
    return colors_of(light);
}

TEST_P(Crossings, LayersAndSkyMakeTheBeauty) {
    // A pixel is closed once what lies behind it is below 2^-16 of exposed white, which with the sky's gain
    // comes later: 2^-24 is far below what is asked for here.
    if (crossing.sky != Sky::none) scene.output.exposure = 8.0f;
    Window window(scene);
    const Shot shot = window.shot_of(scene, frame(), eye());
    ASSERT_EQ(shot.layers.size(), shot.frame.layers.size());
    Image sum = make_image(crossing_width, crossing_height, 4);
    for (const Image& layer : shot.frame.layers) add(sum, colors_of(layer));
    const Image beauty = colors_of(shot.frame.beauty);
    if (crossing.sky == Sky::none || !has_lighten(crossing)) {
        if (crossing.sky != Sky::none)
            add(sum, light_of_sky(window, scene, frame(), eye(), shot.frame.beauty));
        EXPECT_EQ(difference(sum, beauty, 1e-5), "");
        return;
    }
    // The brighter of sky and layer arrives: what the layers leave is the sky's, and never below 0.
    for (std::size_t i = 0; i < sum.pixels.size(); ++i)
        sum.pixels[i] = std::max(sum.pixels[i], beauty.pixels[i]);
    EXPECT_EQ(difference(sum, beauty, 1e-5), "");
}

TEST_P(Crossings, ABlurredFrameIsTheMeanOfItsSamples) {
    const Shot shot = shot_of(scene, frame(), eye(), Extra::all, machine_of(crossing));
    const std::vector<Shot> samples = samples_of(scene, frame(), eye());
    const double share = 1.0 / double(samples.size());
    Image beauty, coverage, count;
    std::map<std::string, Image> layers;
    for (const Shot& sample : samples) {
        add(beauty, sample.frame.beauty, share);
        add(coverage, sample.frame.coverage, share);
        add(count, sample.frame.count, share);
        for (const auto& [name, image] : by_name(sample)) add(layers[name], image, share);
    }
    EXPECT_EQ(difference(shot.frame.beauty, beauty, 1e-5), "");
    EXPECT_EQ(difference(shot.frame.coverage, coverage, 1e-5), "");
    EXPECT_EQ(difference(shot.frame.count, count, 1e-5), "");
    const std::map<std::string, Image> found = by_name(shot);
    ASSERT_EQ(found.size(), layers.size()) << "a layer of some sample is one of the frame";
    for (const auto& [name, image] : layers) {
        ASSERT_TRUE(found.count(name)) << name;
        EXPECT_EQ(difference(found.at(name), image, 1e-5), "") << name;
    }
}

/// Layers whose opacity is the pixel's alpha.
bool is_plain(const CrossingLayer& layer) {
    return layer.holdout == Answer::no && layer.blend == Blend::over;
}

TEST_P(Crossings, DepthIsTheMeanOfWhatIsSeenWithOrWithoutASky) {
    const Image depth = shot_of(scene, frame(), eye(), Extra::all, machine_of(crossing)).frame.depth;
    const std::vector<Shot> samples = samples_of(scene, frame(), eye());
    const bool plain = std::ranges::all_of(crossing.layers, is_plain);
    for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
        double sum = 0.0, weight = 0.0;
        for (const Shot& sample : samples) {
            const RenderedFrame& alone = sample.without_sky.front();
            const double opacity = double(alone.opacity.pixels[i]);
            if (plain) {
                ASSERT_NEAR(opacity, double(alone.beauty.pixels[4 * i + 3]), 1e-5) << i;
            }
            sum += opacity * double(alone.depth.pixels[i]), weight += opacity;
        }
        const double expected = weight > 0.0 ? sum / weight : 0.0;
        // Behind what the stop rule closes nothing is seen, and that is another place under a bright sky.
        ASSERT_NEAR(double(depth.pixels[i]), expected, 1e-4 * expected) << i;
    }
}

TEST_P(Crossings, AnyMachineAndTheWindowGiveTheSameBits) {
    const Shot plain = shot_of(scene, frame(), eye(), Extra::of_scene);
    const Shot other = shot_of(scene, frame(), eye(), Extra::of_scene, machine_of(crossing));
    EXPECT_TRUE(other.frame.statistics.device.empty() || crossing.device != Device::cpu);
    EXPECT_EQ(other.layers, plain.layers);
    EXPECT_EQ(other.frame.beauty.pixels, plain.frame.beauty.pixels);
    EXPECT_EQ(other.frame.depth.pixels, plain.frame.depth.pixels);
    EXPECT_EQ(other.frame.coverage.pixels, plain.frame.coverage.pixels);
    EXPECT_EQ(other.frame.count.pixels, plain.frame.count.pixels);
    ASSERT_EQ(other.frame.layers.size(), plain.frame.layers.size());
    for (std::size_t i = 0; i < plain.frame.layers.size(); ++i)
        EXPECT_EQ(other.frame.layers[i].pixels, plain.frame.layers[i].pixels) << i;
    const Shot all = shot_of(scene, frame(), eye());
    EXPECT_EQ(all.frame.beauty.pixels, plain.frame.beauty.pixels) << "extra channels change no pixel";
    Scene before = scene;
    before.layers.front().look.grade.gain *= 0.5f;
    before.layers.back().render.opacity *= 0.5f;
    before.environment.gain *= 0.5f;
    Window window(scene);
    window.shot_of(before, frame() + 1.0, eye(), Extra::of_scene);
    const Shot shown = window.shot_of(scene, frame(), eye(), Extra::of_scene);
    EXPECT_EQ(shown.frame.beauty.pixels, plain.frame.beauty.pixels);
}

// --- values ---

bool is_tried(const ParameterSpec& spec) {
    using Type = ParameterType;
    constexpr std::array types = {Type::boolean, Type::number,   Type::choice,
                                  Type::vector,  Type::position, Type::color};
    const std::string& key = spec.generic_key.text();
    return std::ranges::find(types, spec.type) != types.end() && !key.starts_with("layer.source") &&
           !key.starts_with("reference") && !key.starts_with("provenance") &&
           !key.starts_with("camera.file") && key != "output.resolution" && key != "output.fps" &&
           key != "environment.tile_height";
}

/// Specs of the parameters whose values a scene may change without another set; of a group, or of all.
std::vector<ParameterSpec> tried_specs(Scene scene, const std::string& group) {
    std::vector<ParameterSpec> specs;
    for (const Parameter& parameter : describe(scene).parameters)
        if (is_tried(parameter.spec) &&
            (group.empty() || parameter.spec.generic_key.text().starts_with(group)))
            specs.push_back(parameter.spec);
    return specs;
}

Value value_at(Scene scene, const ParameterKey& key) { return find_parameter(describe(scene), key)->get(); }

void set_value(Scene& scene, const ParameterKey& key, const Value& value) {
    find_parameter(describe(scene), key)->set(value);
}

/// Another scene that hashes alike has the same pixels.
TEST_P(Crossings, AnotherPixelHasAnotherHash) {
    Window window(scene);
    const Shot shot = window.shot_of(scene, frame(), eye(), Extra::of_scene);
    const std::string hash = hash_of(scene, crossing_frame, eye());
    const auto expect_true_of = [&](const Scene& changed, const std::string& what) {
        if (hash_of(changed, crossing_frame, eye()) != hash) return;
        const Shot other = window.shot_of(changed, frame(), eye(), Extra::of_scene);
        EXPECT_EQ(other.frame.beauty.pixels == shot.frame.beauty.pixels, true) << what;
        EXPECT_EQ(other.frame.depth.pixels == shot.frame.depth.pixels, true) << what;
        EXPECT_EQ(other.layers, shot.layers) << what;
    };
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        Scene changed = scene;
        changed.layers[i].look.grade.gain *= 0.5f;
        changed.layers[i].transform.translate.x += 0.4;
        expect_true_of(changed, "layer " + layer_name(i));
    }
    Scene dimmer = scene;
    dimmer.environment.gain *= 0.5f;
    expect_true_of(dimmer, "environment.gain");
    for (std::size_t i = 0; i < scene.animation.size(); ++i) {  // later by less than the shutter is open
        Scene changed = scene;
        changed.animation[i].keyframes.back().frame += 0.1;
        expect_true_of(changed, "the last key of " + scene.animation[i].key.text());
    }
    if (crossing.path == CameraPath::csv_file) {
        std::string table = camera_table(crossing);
        table.replace(table.rfind(",1.0,"), 5, ",1.2,");  // another place, after the frame
        std::ofstream(folder / "other.csv", std::ios::binary) << table;
        const std::vector<Assignment> other = {{"camera.file", to_toml((folder / "other.csv").string())}};
        expect_true_of(load_scene(folder / "scene.toml", other), "another end of the camera's file");
    }
    Numbers numbers(crossing.seed + 7);
    const std::vector<ParameterSpec> specs = tried_specs(scene, "");
    for (int i = 0; i < 12; ++i) {
        const ParameterSpec& spec = specs[numbers.below(specs.size())];
        Scene changed = scene;
        set_value(changed, spec.key, random_value(spec, numbers));
        try {
            expect_true_of(changed, spec.key.text() + " = " + to_toml(value_at(changed, spec.key)));
        } catch (const InputError&) {
            // a rule between parameters, which loading would have found
        }
    }
    if (hash_of(scene, crossing_frame + 1, eye()) == hash) {
        const Shot next = window.shot_of(scene, frame() + 1.0, eye(), Extra::of_scene);
        EXPECT_EQ(next.frame.beauty.pixels == shot.frame.beauty.pixels, true) << "the next frame";
    }
}

struct Chosen {
    ParameterSpec spec;
    Value value;
};

/// A key of the group and a value that the scene takes, another than it has.
Chosen choose(const Crossing& c, const Scene& scene) {
    Numbers numbers(c.seed + 3);
    const std::vector<ParameterSpec> specs = tried_specs(scene, std::string(name_of(c.assigned)));
    while (true) {
        const ParameterSpec& spec = specs[numbers.below(specs.size())];
        const Value value = random_value(spec, numbers);
        if (value != value_at(scene, spec.key)) return {spec, value};
    }
}

/// Whether `scene` sets its blur itself, so that a frame without blur is another question.
bool is_of_blur(const std::string& key) {
    return key == "camera.shutter" || key == "camera.f_number" || key == "output.samples";
}

/// The same for the command line; none where nothing is set or a rule between parameters forbids it.
std::optional<Assignment> chosen_assignment(const Crossing& c, const fs::path& file, const Scene& scene) {
    if (c.assigned == Assigned::nothing) return {};
    const Chosen chosen = choose(c, scene_at(scene, double(crossing_frame)));
    const Assignment assignment = {chosen.spec.key, to_toml(chosen.value)};
    try {
        load_scene(file, std::vector{assignment});
    } catch (const InputError&) {
        return {};
    }
    return assignment;
}

TEST_P(Crossings, WhatIsSetIsWhatIsRendered) {
    const auto assignment = chosen_assignment(crossing, folder / "scene.toml", scene);
    if (!assignment) return;
    const Chosen chosen = choose(crossing, scene_at(scene, frame()));
    const ParameterKey& key = chosen.spec.key;
    SCOPED_TRACE("--set " + key.text() + "=" + to_toml(chosen.value));
    Scene given = load_scene(folder / "scene.toml", std::vector{*assignment});
    Scene expected = scene_at(scene, frame());
    set_value(expected, key, chosen.value);
    // Keys that would replace it go: --set wins over those, too.
    if (key == "camera.target") expected.camera.rotation.reset();
    if (key == "camera.fov") expected.camera.focal_length = 0.0;
    for (const double at : {1.0, frame(), frame() + 0.2, 100.0})
        EXPECT_EQ(to_toml(value_at(scene_at(given, at), key)), to_toml(value_at(expected, key))) << at;
    const bool along_the_way = std::ranges::any_of(
        crossing.layers, [](const CrossingLayer& l) { return l.source == Source::random_stars; });
    if (along_the_way || is_of_blur(key.text())) return;  // the way is another then
    stop_animation(expected);
    for (Scene* each : {&given, &expected}) each->camera.shutter = each->camera.f_number = 0.0;
    Window window(given);
    // A value that the layer's splats cannot have is refused when they are there, as ever.
    const auto beauty_or_refusal = [&](const Scene& each) -> std::pair<Image, std::string> {
        try {
            return {window.shot_of(each, frame(), eye()).frame.beauty, ""};
        } catch (const InputError& error) {
            return {{}, error.what()};
        }
    };
    const auto [found, refusal] = beauty_or_refusal(given);
    const auto [wanted, expected_refusal] = beauty_or_refusal(expected);
    EXPECT_EQ(refusal, expected_refusal);
    EXPECT_EQ(difference(found, wanted, 0.0), "");
}

// --- names ---

TEST_P(Crossings, FilesLieInTheFolderNamed) {
    for (const std::int64_t number : frames_of(crossing))
        for (const Eye each : eyes_of(crossing)) {
            const fs::path expected = folder / file_of_frame(crossing, number, each);
            EXPECT_EQ(batch_file(scene, number, each), expected);
            EXPECT_EQ(file_of_output(folder, output_path(crossing), number, each), expected);
        }
    const Shot shot = shot_of(scene, frame(), eye(), Extra::of_scene);
    const fs::path file = folder / file_of_frame(crossing, crossing_frame, eye());
    fs::create_directories(file.parent_path());
    write_shot(scene, shot, crossing_frame, eye(), file);
    ASSERT_TRUE(fs::exists(file));
    const FrameHeader header = read_frame_header(file);
    EXPECT_EQ(header.frame, crossing_frame);
    if (has_two_eyes(crossing.projection)) {
        EXPECT_EQ(header.eye, eye());
    }
    EXPECT_EQ(header.frame_hash, hash_of(scene, crossing_frame, eye()));
    EXPECT_EQ(header.pixel_hash, pixel_hash(shot.frame.beauty));
}

/// The job does what the dialog offers: the same names as --batch, and a movie next to them.
TEST_P(Crossings, TheWindowsJobsHaveTheNamesOfBatch) {
    const Document document = Document::open(folder / "scene.toml");
    for (const RenderKind kind : {RenderKind::range, RenderKind::frame}) {
        const RenderTask task = make_render_task(document, kind, frame());
        ASSERT_EQ(render_problem(task, scene.camera), "");
        const std::string output = render_files(task).string();
        for (const Eye each : eyes_of(crossing))
            EXPECT_EQ(file_of_output("/nowhere", output, crossing_frame, each),
                      folder / file_of_frame(crossing, crossing_frame, each));
    }
    RenderTask movie = make_render_task(document, RenderKind::movie, frame());
    ASSERT_EQ(render_problem(movie, scene.camera), "");
    EXPECT_EQ(render_target(movie), folder / folder_of_movie(crossing) / "shot.mp4");
    fs::create_directories(movie_folder(render_target(movie)));
    const fs::path first = file_of_output("/nowhere", render_files(movie).string(), 7, Eye::centre);
    EXPECT_EQ(first, movie_folder(render_target(movie)) / "frame.000007.png");
}

// --- edits ---

TEST_P(Crossings, UndoOfEverythingRestoresTheBytes) {
    Document document = Document::open(folder / "scene.toml");
    Numbers numbers(crossing.seed + 11);
    std::vector<Scene> states = {document.scene()};
    const auto edited = [&] {
        if (!(document.scene() == states.back())) states.push_back(document.scene());
    };
    for (int i = 0; i < 10; ++i) {
        const std::vector<ParameterSpec> specs = tried_specs(document.scene(), "");
        const ParameterSpec& spec = specs[numbers.below(specs.size())];
        try {
            document.set(spec.key, random_value(spec, numbers), numbers.frame());
        } catch (const InputError&) {
            EXPECT_EQ(document.scene(), states.back()) << spec.key;
        }
        edited();
    }
    document.edit("Duplicate", [](Scene& s) { duplicate_layer(s, 0); });
    edited();
    document.edit("Move", [](Scene& s) { move_layer(s, 0, s.layers.size() - 1); });
    edited();
    document.edit("Remove", [](Scene& s) { remove_layer(s, 0); });
    edited();
    Scene loaded = parse_scene(document.text_for(folder / "scene.toml"), folder / "scene.toml");
    EXPECT_EQ(loaded, document.scene()) << "what is saved loads as it was";
    while (document.can_undo()) {
        ASSERT_FALSE(states.empty());
        EXPECT_EQ(document.scene(), states.back());
        states.pop_back();
        document.undo();
    }
    EXPECT_EQ(states.size(), 1u);
    EXPECT_EQ(document.text_for(folder / "scene.toml"), text);
    EXPECT_FALSE(document.edited());
}

// --- seeds ---

std::vector<std::uint32_t> all_seeds() {
    static const std::vector<std::uint32_t> seeds = covering_seeds(possible_pairs(), pool);
    return seeds;
}

INSTANTIATE_TEST_SUITE_P(Seeds, Crossings, testing::ValuesIn(seeds_or_one(all_seeds)), seed_name);
/// Each failed one night: splats were lost across a panorama's seam, a closed pixel's sky and a refusal were
/// not foreseen.
INSTANTIATE_TEST_SUITE_P(Found, Crossings, testing::Values(1519u, 1558u, 1654u, 1892u), seed_name);
INSTANTIATE_TEST_SUITE_P(Nightly, Crossings, testing::Range(pool, pool + nightly_seeds), seed_name);

TEST(CrossingSeeds, LetEveryPairOfFeaturesMeet) {
    std::set<FeaturePair> met;
    for (const std::uint32_t seed : all_seeds())
        for (const FeaturePair& pair : pairs_of(crossing_of(seed))) met.insert(pair);
    const std::vector<FeaturePair> possible = possible_pairs();
    EXPECT_GT(possible.size(), 3900u);
    std::string missed;
    for (const auto& [a, b] : possible)
        if (!met.count({a, b}))
            missed += feature_names()[std::size_t(a)] + " x " + feature_names()[std::size_t(b)] + "\n";
    EXPECT_EQ(missed, "");
}

// The program itself on scenes drawn from seeds: batch, verify, resume, the window's jobs and its movies make
// files of the same names and pixels, each in the folder that was named.

/// Relative paths of all files below a folder.
std::set<std::string> files_below(const fs::path& folder) {
    std::set<std::string> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.insert(entry.path().lexically_relative(folder).string());
    return files;
}

class ProgramCrossings : public Crossings {
  protected:
    ProgramCrossings() : before(files_below(outside.path())) {}

    /// On the machine that the crossing has.
    RunResult run(std::vector<std::string> words, const fs::path& working_directory) const {
        const Machine machine = machine_of(crossing);
        words.insert(words.begin(), ASTROSPLAT_PROGRAM);
        words.insert(words.end(),
                     {"--threads", std::to_string(machine.threads), "-q", "--device", device_word(crossing)});
        RunOptions options;
        options.folder = working_directory;
        options.environment = {"ASTROSPLAT_VECTOR_TARGET=" + machine.target,
                               "ASTROSPLAT_CACHE=" + shared_sets().folder.string()};
        return run_program(words, options);
    }

    /// Every frame's file in the scene's folder, absolute.
    std::vector<std::string> frame_files() const {
        std::vector<std::string> files;
        for (const std::int64_t number : frames_of(crossing))
            for (const Eye each : eyes_of(crossing))
                files.push_back((folder / file_of_frame(crossing, number, each)).string());
        return files;
    }

    /// Exactly the frames have come since the scene was written.
    void expect_only_frames() const {
        std::set<std::string> expected = before;
        for (const std::string& file : frame_files())
            expected.insert(fs::path(file).lexically_relative(outside.path()).string());
        EXPECT_EQ(files_below(outside.path()), expected);
    }

    std::set<std::string> before;
};

std::vector<std::string> texts_of(const std::vector<std::string>& files) {
    std::vector<std::string> texts;
    for (const std::string& file : files) texts.push_back(text_of(file));
    return texts;
}

TEST_P(ProgramCrossings, BatchVerifyAndTheWindowMakeTheSameFiles) {
    const RunResult batch = expect_success(run({"--batch", "scene.toml"}, folder));
    expect_only_frames();
    const FrameHeader header = read_frame_header(folder / file_of_frame(crossing, crossing_frame, eye()));
    EXPECT_EQ(header.pixel_hash, pixel_hash(shot_of(scene, frame(), eye()).frame.beauty));
    EXPECT_EQ(header.frame_hash, hash_of(scene, crossing_frame, eye()));

    std::vector<std::string> words = {"verify", (folder / "scene.toml").string()};
    const std::vector<std::string> files = frame_files(), made = texts_of(files);
    words.insert(words.end(), files.begin(), files.end());
    expect_success(run(words, "/"));

    // A job of the window has a copy of the scene in a folder of its own.
    const TempFolder job;
    const RenderTask task =
        make_render_task(Document::open(folder / "scene.toml"), RenderKind::range, frame());
    ASSERT_EQ(render_problem(task, scene.camera), "");
    const fs::path copy =
        job.file("scene.toml", Document::open(folder / "scene.toml").text_for(job / "scene.toml"));
    words = {"--batch", copy.string()};
    for (const std::string& word : batch_arguments(task)) words.push_back(word);
    const auto written = fs::last_write_time(files.front());
    expect_success(run(words, "/"));
    EXPECT_EQ(fs::last_write_time(files.front()), written) << "the frames are there already";
    for (const std::string& file : files) fs::remove(file);
    expect_success(run(words, "/"));
    expect_only_frames();
    EXPECT_EQ(texts_of(files) == made, true) << "byte for byte";
}

TEST_P(ProgramCrossings, OutputOfTheCommandLineLiesInTheWorkingDirectory) {
    const fs::path elsewhere = outside / ("b " + folder_name(crossing));
    fs::create_directories(elsewhere);
    std::vector<Assignment> assignments = {{"output.depth", "\"half\""}};
    if (const auto chosen = chosen_assignment(crossing, folder / "scene.toml", scene))
        assignments.push_back(*chosen);
    const Scene given = load_scene(folder / "scene.toml", assignments);
    std::vector<std::string> words = {
        "--batch", (folder / "scene.toml").string(), "-f", std::to_string(crossing_frame), "-o", "out.exr"};
    for (const auto& [key, value] : assignments)
        words.insert(words.end(), {"--set", key.text() + "=" + value});
    SCOPED_TRACE(words.back());
    const RunResult batch = run(words, elsewhere);
    std::string refusal;
    Image expected;
    try {
        expected = shot_of(given, frame(), given.camera.eye).frame.beauty;
    } catch (const InputError& error) {
        refusal = error.what();
    }
    EXPECT_EQ(batch.code, refusal.empty() ? 0 : 2) << batch.err << refusal;
    if (!refusal.empty()) return;
    EXPECT_EQ(files_below(elsewhere), std::set<std::string>{"out.exr"});
    EXPECT_EQ(read_frame_header(elsewhere / "out.exr").pixel_hash, pixel_hash(expected));
}

/// What the window's session makes of a scene, with its requests and its final frames.
class WindowCrossings : public ProgramCrossings {};

TEST_P(WindowCrossings, TheSettledWindowShowsThePixelsOfBatch) {
    const fs::path picture = outside / "settled.exr";
    expect_success(run(
        {(folder / "scene.toml").string(), "--screenshot", picture.string(), "--settled", "--size",
         fmt::format("{}x{}", crossing_width, crossing_height), "--frame", std::to_string(crossing_frame)},
        "/"));
    const Image expected = shot_of(scene, frame(), scene.camera.eye, Extra::of_scene).frame.beauty;
    EXPECT_EQ(difference(load_linear_image(picture), expected, 0.0), "");
}

TEST_P(ProgramCrossings, AMovieIsMadeOfTheFramesThatBatchMakes) {
    if (run_program({"/bin/sh", "-c", "command -v ffmpeg ffprobe"}).code != 0)
        GTEST_SKIP() << "ffmpeg is not installed";
    if (crossing.ending != Ending::movie) return;
    const RenderTask task =
        make_render_task(Document::open(folder / "scene.toml"), RenderKind::movie, frame());
    ASSERT_EQ(render_problem(task, scene.camera), "");
    std::vector<std::string> words = {"--batch", (folder / "scene.toml").string()};
    for (const std::string& word : batch_arguments(task)) words.push_back(word);
    expect_success(run(words, "/"));
    const fs::path movie = render_target(task);
    std::set<std::string> frames = files_below(movie_folder(movie));
    EXPECT_EQ(frames.erase(movie_words(movie).filename()), 1u);
    ASSERT_EQ(frames.size(), frames_of(crossing).size());
    const FrameHeader header = read_frame_header(movie_folder(movie) / *frames.begin());
    EXPECT_EQ(header.pixel_hash, pixel_hash(shot_of(scene, frame(), scene.camera.eye).frame.beauty));

    std::vector<std::string> writing = movie_command(movie, 24.0);
    writing.insert(writing.begin(), "/usr/bin/env");
    expect_success(run_program(writing));
    const RunResult probed = run_program(
        {"/usr/bin/env", "ffprobe", "-v", "error", "-count_frames", "-select_streams", "v:0", "-show_entries",
         "stream=width,height,nb_read_frames", "-of", "csv=p=0", movie_part(movie).string()});
    EXPECT_EQ(probed.out, fmt::format("{},{},{}\n", crossing_width, crossing_height, frames.size()))
        << probed.err;
}

/// Few seeds in which every choice of the one factors meets every choice of the others.
std::vector<std::uint32_t> seeds_where(const std::vector<std::string>& ones,
                                       const std::vector<std::string>& others) {
    std::vector<FeaturePair> wanted;
    const auto starts = [](int feature, const std::vector<std::string>& factors) {
        const std::string& name = feature_names()[std::size_t(feature)];
        return std::ranges::any_of(factors, [&](const std::string& f) { return name.starts_with(f + " "); });
    };
    for (const FeaturePair& pair : possible_pairs())
        if (starts(pair.first, ones) && starts(pair.second, others)) wanted.push_back(pair);
    return covering_seeds(wanted, pool);
}

/// What names and files depend on.
std::vector<std::uint32_t> seeds_of_names() {
    return seeds_where({"folder", "token", "seen"}, {"token_in_folder"});
}
/// What a frame of the window could forget.
std::vector<std::uint32_t> seeds_of_views() {
    const std::vector<std::string> factors = {"blur",    "layer_switched", "sky_switched", "moved",
                                              "path",    "projection",     "channels",     "sky",
                                              "sky_near"};
    return seeds_where(factors, factors);
}

INSTANTIATE_TEST_SUITE_P(Runs, ProgramCrossings, testing::ValuesIn(seeds_or_one(seeds_of_names)), seed_name);
INSTANTIATE_TEST_SUITE_P(Views, WindowCrossings, testing::ValuesIn(seeds_or_one(seeds_of_views)), seed_name);
INSTANTIATE_TEST_SUITE_P(NightlyViews, WindowCrossings, testing::Range(pool, pool + 60u), seed_name);
INSTANTIATE_TEST_SUITE_P(NightlyRuns, ProgramCrossings, testing::Range(pool, pool + 60u), seed_name);

}  // namespace
}  // namespace astrosplat::test

// Command lines that the window runs: --batch, prepare, movies.
#include "edit/command_lines.h"
#include "edit/edits.h"
#include "edit/layers.h"
#include "scenes.h"
#include "source/write_image.h"
#include "support/run_program.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// The command line for what is shown: a real shell takes it apart, and the loader makes the scene of it.

using test::opacity;

/// The words a shell makes of a command, which is given printf instead of the program.
std::vector<std::string> shell_words(std::string command) {
    EXPECT_EQ(command.rfind("astrosplat ", 0), 0u);
    command = "printf '%s\\0' " + command.substr(11);
    FILE* pipe = popen(command.c_str(), "r");
    std::string output;
    std::array<char, 4096> buffer;
    for (std::size_t n; pipe && (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
        output.append(buffer.data(), n);
    EXPECT_EQ(pclose(pipe), 0);
    std::vector<std::string> words;
    for (std::size_t at = 0; at < output.size(); at = output.find('\0', at) + 1)
        words.push_back(output.substr(at, output.find('\0', at) - at));
    return words;
}

Scene scene_of(const std::vector<std::string>& words) {
    std::vector<Assignment> assignments;
    for (std::size_t i = 0; i + 1 < words.size(); ++i)
        if (words[i] == "--set") assignments.push_back(parse_assignment(words[i + 1]));
    return load_scene(words.at(1), assignments);
}

struct BatchCommandTest : testing::Test {
    test::SceneFolder f;
    Document document = Document::open(f.file);
    BatchCommandOptions options;

    void expect_command() {
        const BatchCommand command = batch_command(document, options);
        EXPECT_EQ(command.reason, "");
        Scene loaded = scene_of(shell_words(command.text)), shown = document.scene();
        for (Scene* scene : {&loaded, &shown})  // tracks in any order
            std::sort(scene->animation.begin(), scene->animation.end(),
                      [](const Track& a, const Track& b) { return a.key < b.key; });
        loaded.output.path = shown.output.path = "";  // --set writes it absolute
        EXPECT_EQ(loaded, shown) << command.text;
    }
};

TEST_F(BatchCommandTest, OfASavedScene) {
    options.frame = 12.25;
    options.width = 960;
    options.height = 540;
    options.region = Region{10, 20, 300, 200};
    const std::string quoted = "'" + f.file.string() + "'";
    EXPECT_EQ(batch_command(document, options).text,
              "astrosplat --batch " + quoted + " --frames=12 --resolution 960x540 --region 10,20,300,200");
    options = {};
    EXPECT_EQ(batch_command(document, options).text, "astrosplat --batch " + quoted);
    options.frame = -3.0;
    EXPECT_EQ(batch_command(document, options).text, "astrosplat --batch " + quoted + " --frames=-3");
}

TEST_F(BatchCommandTest, EditsAreAssignments) {
    document.set(opacity, 0.25, 1.0);
    const BatchCommand command = batch_command(document, options);
    EXPECT_HAS(command.text, " --set layer.stars.render.opacity=0.25");
    document.set("provenance.title", "It's \"M 51\" $HOME `x` \\ ü", 1.0);
    document.set("layer.dust.look.thickness.map", "neue karte's ä.png", 1.0);
    document.set("layer.dust.source.unpremultiply", true, 1.0);
    document.set("output.depth", "16", 1.0);
    document.set("output.path", "andere bilder/b.####.png", 1.0);
    document.set("output.aovs", Value::List{"depth", "count"}, 1.0);
    document.set("layer.stars.look.noise.cull", 0.5, 1.0);
    document.set("camera.rotation", Value::List{0.0, 0.5, 0.0, 1.0}, 1.0);
    expect_command();
    ASSERT_FALSE(HasFailure());
    document.edit("Keyframes", [](Scene& s) {
        set_keyframe(s, opacity, 1.0, 0.0);
        set_keyframe(s, opacity, 9.5, 1.0);
        set_interpolation(s, opacity, 1.0, Interpolation::step);
        set_keyframe(s, "layer.stars.render.core", 12.0, 0.25);
        remove_track(s, "layer.dust.look.noise.1.jitter");
    });
    expect_command();
}

TEST_F(BatchCommandTest, ATrackOfAnEditedValueStays) {
    document.edit("Both", [](Scene& s) { s.layers[1].render.falloff.core = 0.75f; });
    expect_command();
}

TEST_F(BatchCommandTest, AssignmentsOfTheCommandLineStay) {
    const std::vector<Assignment> assignments{{opacity, "0.25"}};
    document = Document::open(f.file, assignments);
    expect_command();
}

TEST_F(BatchCommandTest, AFreeViewIsACamera) {
    document.edit("Keyframes", [](Scene& s) { set_keyframe(s, "camera.fov", 3.0, 30.0); });
    document.save();
    CameraParams camera;
    camera.position = glm::dvec3(1.0, 2.0, 3.5);
    camera.fov = 33.0;
    options.camera = camera;
    const BatchCommand command = batch_command(document, options);
    EXPECT_EQ(command.reason, "");
    const Scene loaded = scene_of(shell_words(command.text));
    EXPECT_EQ(loaded.camera, camera);
    EXPECT_FALSE(is_animated(loaded, "camera.fov"));
}

TEST_F(BatchCommandTest, AFarmsCommandSubmits) {
    RenderTask task = make_render_task(document, RenderKind::range, 1.0);
    task.by_slurm = true;
    const BatchCommand command = render_command(document, task, "astrosplat");
    std::string wanted = "astrosplat --submit slurm " + shell_word(document.file().string());
    for (const std::string& word : submit_arguments(task)) wanted += " " + shell_word(word);
    EXPECT_EQ(command.text, wanted);
}

TEST_F(BatchCommandTest, WhatCannotBeSaidIsNotSaid) {
    const std::string reason = "save the scene first: its edits cannot be said as --set";
    document.edit("Layer", [](Scene& s) { duplicate_layer(s, 1); });
    EXPECT_EQ(batch_command(document, options).text, "");
    EXPECT_EQ(batch_command(document, options).reason, reason);
    document.undo();
    document.edit("Noise", [](Scene& s) { s.layers[0].look.noise.clear(); });
    EXPECT_EQ(batch_command(document, options).reason, reason);
    document.save();
    expect_command();
    document = Document::untitled(test::edit_scene, f.folder / "untitled.toml");
    EXPECT_EQ(batch_command(document, options).reason, "save the scene first: it has no file yet");
}

TEST(ShellWord, QuotesWhatAShellWouldTakeApart) {
    EXPECT_EQ(shell_word("plain-1.0_a/b,c:d+e%f@g=h"), "plain-1.0_a/b,c:d+e%f@g=h");
    EXPECT_EQ(shell_word(""), "''");
    EXPECT_EQ(shell_word("a b"), "'a b'");
    EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
    EXPECT_EQ(shell_word("~"), "'~'");
    EXPECT_EQ(shell_word("ü"), "'ü'");
    for (const char* text : {"a b", "it's", "$HOME", "`x`", "a\nb", "\"", "\\", "*", "!", "# x", "ü'ä'"})
        EXPECT_EQ(shell_words("astrosplat " + shell_word(text)), std::vector<std::string>{text});
}

// The keys of source.prepare as the options of the command: those that do something, and no others.

using Words = std::vector<std::string>;

SourceParams source_of(std::vector<fs::path> pictures) {
    SourceParams source;
    source.meshes = {{"plane", std::move(pictures)}};
    return source;
}

TEST(PrepareCommandLine, SaysWhatTheKeysSay) {
    SourceParams source = source_of({"a b.png"});
    EXPECT_EQ(prepare_command(source, "out"),
              (Words{"prepare", "a b.png", "-o", "out", "--stars", "keep", "--lupton", "false"}));
    PrepareParams& prepare = source.texture.prepare;
    prepare.stars = PrepareParams::Stars::remove;
    prepare.threshold = 7.5;
    prepare.background = PrepareParams::Background::plane;
    prepare.ellipse = glm::dvec4(10.0, 20.0, 5.5, 4.0);
    prepare.turn = -30.0;
    prepare.alpha = glm::dvec2(0.0, 0.25);
    prepare.mask = "mask.png";
    EXPECT_EQ(prepare_command(source, "out"), (Words{"prepare",      "a b.png",
                                                     "-o",           "out",
                                                     "--stars",      "remove",
                                                     "--threshold",  "7.5",
                                                     "--background", "plane",
                                                     "--lupton",     "false",
                                                     "--ellipse",    "[10.0, 20.0, 5.5, 4.0]",
                                                     "--turn",       "-30.0",
                                                     "--mask",       "mask.png",
                                                     "--alpha",      "[0.0, 0.25]"}));
}

TEST(PrepareCommandLine, LeavesOutWhatTheCommandWouldRefuse) {
    SourceParams source = source_of({"a.png"});
    source.texture.stretch = TextureSettings::Stretch::log;  // of FITS alone
    source.texture.prepare.threshold = 7.5;                  // no star is removed
    source.texture.prepare.feather = 0.5;                    // nothing is cut
    EXPECT_EQ(prepare_command(source, "out").size(), 8u);
}

TEST(PrepareCommandLine, NamesThreeFilters) {
    SourceParams source = source_of({"r.fits", "g.fits", "b.fits"});
    source.texture.prepare.lupton = true;
    source.texture.prepare.lupton_stretch = 0.5;
    EXPECT_EQ(prepare_command(source, "out"),
              (Words{"prepare", "--r", "r.fits", "--g", "g.fits", "--b", "b.fits", "-o", "out", "--stars",
                     "keep", "--lupton", "true", "--lupton-stretch", "0.5"}));
}

TEST(PrepareCommandLine, NeedsAPicture) {
    EXPECT_EQ(ERROR_OF(prepare_command(source_of({}), "out")),
              "source.meshes: expected a picture to prepare, found none");
}

// Renderings from the window as words of --batch and of ffmpeg.

RenderTask task_of(RenderKind kind, const std::string& name) {
    RenderTask task;
    task.kind = kind;
    task.frames = "1-24";
    task.width = 320;
    task.height = 180;
    task.folder = "/films/[one]*";
    task.name = name;
    return task;
}

bool has(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

TEST(RenderTask, SaysWhyItCannotBeRendered) {
    const RenderTask good = task_of(RenderKind::range, "a.####.exr");
    EXPECT_EQ(render_problem(good, {}), "");
    const auto with = [&](auto change) {
        RenderTask task = good;
        change(task);
        return render_problem(task, {});
    };
    EXPECT_NE(with([](RenderTask& t) { t.width = 0; }), "");
    EXPECT_NE(with([](RenderTask& t) { t.height = 65537; }), "");
    EXPECT_NE(with([](RenderTask& t) { t.folder = "relative"; }), "");
    EXPECT_NE(with([](RenderTask& t) { t.name = ""; }), "");
    EXPECT_NE(with([](RenderTask& t) { t.name = "b/a.####.exr"; }), "");
    EXPECT_NE(with([](RenderTask& t) { t.name = "a.####.mp4"; }), "");
    EXPECT_NE(with([](RenderTask& t) { t.name = "a.exr"; }), "") << "24 frames in one file";
    EXPECT_NE(with([](RenderTask& t) { t.frames = "9-"; }), "");
    EXPECT_EQ(with([](RenderTask& t) { t.frames = "9", t.name = "a.exr"; }), "");
    EXPECT_EQ(render_problem(task_of(RenderKind::movie, "a.mkv"), {}), "");
    EXPECT_NE(render_problem(task_of(RenderKind::movie, "a.exr"), {}), "");
}

TEST(RenderTask, KeepsReplacesOrRefusesWhatIsThere) {
    RenderTask task = task_of(RenderKind::range, "a.####.exr");
    EXPECT_TRUE(has(batch_arguments(task), "--resume") && has(batch_arguments(task), "--overwrite"));
    task.existing = ExistingFrames::replace;
    EXPECT_TRUE(!has(batch_arguments(task), "--resume") && has(batch_arguments(task), "--overwrite"));
    task.existing = ExistingFrames::refuse;
    EXPECT_TRUE(!has(batch_arguments(task), "--resume") && !has(batch_arguments(task), "--overwrite"));
    EXPECT_TRUE(has(batch_arguments(task), "--output=/films/[one]*/a.####.exr"));
}

TEST(RenderTask, AJobTakesNoMoreThanTheWindow) {
    const RenderTask task = task_of(RenderKind::range, "a.####.exr");
    std::vector<std::string> words = batch_arguments(task);
    EXPECT_EQ(batch_arguments(task, limits_with(Settings(), 0)), words) << "the settings say nothing";
    words.insert(words.end(), {"--threads=4", "--memory=8"});
    EXPECT_EQ(batch_arguments(task, limits_with({.threads = 4, .memory_gib = 8}, 0)), words);
    EXPECT_EQ(batch_arguments(task, limits_with({.threads = 2, .memory_gib = 8}, 4)), words) << "--threads 4";
    const Settings card{.threads = 4, .memory_gib = 8, .device = int(DeviceChoice::gpu)};
    words.push_back("--device=gpu");
    EXPECT_EQ(batch_arguments(task, limits_with(card, 0)), words);
    words.back() = "--device=cpu";
    EXPECT_EQ(batch_arguments(task, limits_with(card, 0, DeviceChoice::cpu)), words) << "--device cpu";
}

TEST(RenderTask, AMoviesFramesLieBesideIt) {
    const RenderTask task = task_of(RenderKind::movie, "a.mp4");
    EXPECT_EQ(render_files(task), "/films/[one]*/a.mp4.frames/frame.######.png");
    const std::vector<std::string> words = movie_command(render_target(task), 23.976);
    EXPECT_TRUE(has(words, "/films/\\[one\\]\\*/a.mp4.frames/frame.*.png")) << "a pattern of ffmpeg";
    EXPECT_TRUE(has(words, "23.976"));
    EXPECT_TRUE(has(words, movie_words(render_target(task)).string()));
    EXPECT_TRUE(has(batch_arguments(task), "--ffmetadata=" + movie_words(render_target(task)).string()));
    EXPECT_EQ(words.back(), movie_part(render_target(task))) << "one that is there stays until this is whole";
    EXPECT_EQ(movie_part(render_target(task)), "/films/[one]*/a.mp4.frames/movie.mp4");
    EXPECT_TRUE(has(batch_arguments(task), "output.aovs=[]")) << "which PNG files cannot hold";
    EXPECT_FALSE(has(batch_arguments(task_of(RenderKind::range, "a.####.exr")), "output.aovs=[]"));
}

TEST(RenderTask, SplatsAreExportedAsTheShellDoes) {
    RenderTask task = task_of(RenderKind::splats, "a.glb");
    EXPECT_NE(render_problem(task, {}), "") << "24 frames";
    task.frames = "12";
    EXPECT_EQ(render_problem(task, {}), "");
    EXPECT_EQ(render_title(task), "Splats of frame 12");
    EXPECT_EQ(export_mode(task), "export");
    EXPECT_EQ(export_arguments(task),
              (std::vector<std::string>{"--output=/films/[one]*/a.glb", "--frame=12"}));
    task.most_splats = 5000;
    task.layer = "the disc";
    task.existing = ExistingFrames::replace;
    EXPECT_EQ(export_arguments(task),
              (std::vector<std::string>{"--output=/films/[one]*/a.glb", "--frame=12", "--layer=the disc",
                                        "--count=5000", "--overwrite"}));
    for (const std::string& ending : render_endings(RenderKind::splats))
        EXPECT_TRUE(has({".ply", ".glb", ".usda", ".spz", ".vdb", ".splats"}, ending)) << ending;
    EXPECT_EQ(render_endings(RenderKind::splats).size(), 6u);
    task.name = "a.splats";
    EXPECT_NE(render_problem(task, {}), "") << "that holds all of a layer's splats";
    task.most_splats = 0;
    EXPECT_EQ(render_problem(task, {}), "");
    EXPECT_EQ(export_mode(task), "generate");
    EXPECT_EQ(export_arguments(task), (std::vector<std::string>{"--output=/films/[one]*/a.splats",
                                                                "--layer=the disc", "--overwrite"}));
    task.layer.clear();
    EXPECT_NE(render_problem(task, {}), "") << "of which layer?";
}

TEST(RenderTask, IsKeptWithTheSceneWhileItsOutputStays) {
    const TempFolder folder;
    const auto open = [&](const std::string& name) {
        return Document::open(folder.file(name, "astrosplat = 1\n[output]\npath = \"a.####.png\"\n"));
    };
    Document document = open("a.toml");
    std::vector<KeptRender> kept;
    RenderTask chosen = make_render_task(document, RenderKind::range, 1.0);
    chosen.frames = "3-9";
    chosen.width = 320;
    chosen.name = "b.####.tif";
    RenderTask again = chosen;
    again.existing = ExistingFrames::replace;
    keep_render(kept, document, again);
    EXPECT_EQ(kept_render(kept, document, RenderKind::range, 5.0), chosen);
    EXPECT_EQ(kept_render(kept, document, RenderKind::movie, 5.0),
              make_render_task(document, RenderKind::movie, 5.0));
    const Document other = open("b.toml");
    EXPECT_EQ(kept_render(kept, other, RenderKind::range, 5.0),
              make_render_task(other, RenderKind::range, 5.0));
    document.edit("Fps", [](Scene& scene) { scene.output.fps = 30; });
    EXPECT_EQ(kept_render(kept, document, RenderKind::range, 5.0), chosen);
    document.edit("Width", [](Scene& scene) { scene.output.width = 640; });
    EXPECT_EQ(kept_render(kept, document, RenderKind::range, 5.0).frames, document.scene().output.frames);
    chosen.kind = RenderKind::frame;
    chosen.frames = "7";
    keep_render(kept, document, chosen);
    EXPECT_EQ(kept_render(kept, document, RenderKind::frame, 5.0).frames, "5");
    EXPECT_EQ(kept_render(kept, document, RenderKind::frame, 5.0).width, 320);
    for (int i = 0; i < 40; ++i) keep_render(kept, document, chosen);
    EXPECT_EQ(kept.size(), 2u);
}

TEST(RenderTask, TheChoicesForFramesHoldForMovies) {
    RenderTask task = task_of(RenderKind::movie, "a.mp4");
    const std::string kept = "--movie=" + render_target(task).string();
    EXPECT_TRUE(has(batch_arguments(task), kept));
    for (const ExistingFrames other : {ExistingFrames::replace, ExistingFrames::refuse}) {
        task.existing = other;
        EXPECT_FALSE(has(batch_arguments(task), kept));
    }
}

// As a player decodes it that believes the tags, and one that takes BT.709 for granted.
TEST(RenderTask, AMoviesColoursAreThoseOfItsFrames) {
    if (test::run_program({"/bin/sh", "-c", "command -v ffmpeg && command -v ffprobe"}).code != 0)
        GTEST_SKIP() << "ffmpeg is not installed";
    const TempFolder folder;
    for (const auto& [width, height] :
         {std::pair(641, 479), std::pair(1280, 720), std::pair(1920, 1080), std::pair(3840, 2160)}) {
        const fs::path movie = folder / fmt::format("{}.mp4", height);
        fs::create_directory(movie_folder(movie));
        std::vector<unsigned char> rgba(std::size_t(4 * width * height), 255);
        for (std::size_t i = 0; i < rgba.size(); i += 4) rgba[i] = 220, rgba[i + 1] = 60, rgba[i + 2] = 90;
        write_image(movie_folder(movie) / "frame.000001.png", width, height, rgba);
        test::write_text(movie_words(movie), ";FFMETADATA1\n");
        std::vector<std::string> writing = movie_command(movie, 24.0);
        writing.insert(writing.begin(), "/usr/bin/env");
        const test::RunResult made = test::run_program(writing);
        ASSERT_EQ(made.code, 0) << made.err;
        EXPECT_EQ(test::run_program({"/usr/bin/env", "ffprobe", "-v", "error", "-show_entries",
                                     "stream=color_range,color_space,color_transfer,color_primaries", "-of",
                                     "csv=p=0", movie_part(movie).string()})
                      .out,
                  "tv,bt709,bt709,bt709\n");
        for (const char* matrix : {"auto", "bt709"}) {
            const std::string pixel =
                test::run_program({"/usr/bin/env", "ffmpeg", "-v", "error", "-i", movie_part(movie).string(),
                                   "-vf",
                                   fmt::format("scale=in_color_matrix={}:flags=accurate_rnd+full_chroma_int,"
                                               "crop=2:2:100:100",
                                               matrix),
                                   "-frames:v", "1", "-pix_fmt", "rgb24", "-f", "rawvideo", "-"})
                    .out;
            ASSERT_EQ(pixel.size(), 12u);
            constexpr std::array wanted{220, 60, 90};
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(int(static_cast<unsigned char>(pixel[c])), wanted[c], 2) << height << matrix << c;
        }
    }
}

TEST(RenderTask, PlacesMayStandInTheNamesOfFolders) {
    const std::string text = "astrosplat = 1\n[output]\nframes = \"1-2\"\npath = \"%V/take.####/shot.exr\"\n";
    const Document document = Document::untitled(text, "/films/scene.toml");
    EXPECT_EQ(render_problem(make_render_task(document, RenderKind::range, 1.0), {}), "");
    const RenderTask movie = make_render_task(document, RenderKind::movie, 1.0);
    EXPECT_EQ(render_target(movie).parent_path(), fs::current_path());
    EXPECT_EQ(movie.name, "shot.mp4");
}

/// A job that --batch would refuse is refused before it starts.
TEST(RenderTask, AMovieIsOneFileWhateverItsFramesAreCalled) {
    for (const char* name : {"a.####.mp4", "a.%04d.mp4", "a{frame:04}.mp4", "%V.mp4", "a.%v.mp4"})
        EXPECT_NE(render_problem(task_of(RenderKind::movie, name), {}), "") << name;
    for (const std::string pattern : {"frame.####.exr", "frame.%04d.exr", "{frame:04}.exr", "%V.####.exr"}) {
        const Document document =
            Document::untitled("astrosplat = 1\n[output]\npath = \"" + pattern + "\"\n", "/films/scene.toml");
        const RenderTask movie = make_render_task(document, RenderKind::movie, 1.0);
        EXPECT_EQ(movie.name, "frame.mp4") << pattern;
        EXPECT_EQ(render_problem(movie, {}), "") << pattern;
        EXPECT_EQ(render_problem(make_render_task(document, RenderKind::range, 1.0), {}), "") << pattern;
    }
}

TEST(RenderTask, PairsNeedACameraWithTwoEyes) {
    CameraParams camera;
    const RenderTask pairs = task_of(RenderKind::range, "a.%v.####.exr");
    EXPECT_EQ(render_problem(pairs, camera), "");
    camera.projection = Projection::fisheye;
    EXPECT_NE(render_problem(pairs, camera), "");
    EXPECT_EQ(render_problem(task_of(RenderKind::movie, "a.mp4"), camera), "");
}

TEST(RenderTask, AnotherEndingKeepsTheName) {
    EXPECT_EQ(with_ending("a.b.####.exr", ".png"), "a.b.####.png");
}

TEST(RenderTask, AFarmGetsChunksAndKeepsWhatIsFinished) {
    RenderTask task = task_of(RenderKind::range, "a.####.exr");
    EXPECT_FALSE(renders_by_slurm(task));
    task.by_slurm = true;
    task.existing = ExistingFrames::replace;
    task.chunk = 25;
    std::vector<std::string> words = frame_arguments(task);
    words.insert(words.end(), {"--chunk=25", "--overwrite"});
    EXPECT_EQ(submit_arguments(task), words);
    task.partition = "long,short";
    EXPECT_EQ(submit_arguments(task)[4], "--partition=long,short");
    for (const std::int64_t chunk : {0, 1'000'001}) {
        task.chunk = chunk;
        EXPECT_NE(render_problem(task, {}), "") << chunk;
    }
    task.kind = RenderKind::movie;
    EXPECT_FALSE(renders_by_slurm(task)) << "a movie is written here";
}

}  // namespace
}  // namespace astrosplat

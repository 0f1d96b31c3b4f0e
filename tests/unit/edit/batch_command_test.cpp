// The command line for what is shown: a real shell takes it apart, and the loader makes the scene of it.
#include "edit/command_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "edit/keyframes.h"
#include "edit/layers.h"
#include "scenes.h"

namespace astrosplat {
namespace {

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
    EXPECT_NE(command.text.find(" --set layer.stars.render.opacity=0.25"), std::string::npos);
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

}  // namespace
}  // namespace astrosplat

// The commands of the command line with their options, one function each.
#include "cli_parts.h"

#include <fmt/format.h>

#include "command_words.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/text.h"
#include "prepare_settings.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

void add_new(CLI::App& app, Invocation& call) {
    CLI::App& command = add_command(app, call, "new", "Writes a scene for a picture",
                                    [&call] { return run_new(call.create); });
    add_value(command, "IMAGE", call.create.image, "IMAGE", "The picture")->required();
    add_value(command, "-o,--output", call.create.scene, "SCENE",
              "The scene file to write (default: the picture's name with .toml, in this folder)");
    add_value(command, "--as", call.create.as, "galaxy|nebula|remnant|field|plane",
              "What the picture shows (default: by looking at it)");
    command.add_flag("--film", call.create.film, "With a camera move of ten seconds");
    add_value(command, "--shape", call.create.shape, "plane|relief|disk|sphere",
              "Columns on this mesh instead of bodies");
    command.add_flag("--overwrite", call.create.overwrite, "Replaces the scene file");
}

void add_three_filters(CLI::App& command, PrepareOptions& prepare) {
    add_value(command, "--r", prepare.red, "FILE",
              "With --g and --b in place of IN: three filters, brought onto the grid of the first where FITS "
              "headers tell the sky, and shown with one asinh for all (Lupton)");
    add_value(command, "--g", prepare.green, "FILE", "The filter shown as green");
    add_value(command, "--b", prepare.blue, "FILE", "The filter shown as blue");
}

void add_prepare(CLI::App& app, Invocation& call) {
    PrepareOptions& prepare = call.prepare;
    CLI::App& command = add_command(app, call, "prepare", "Makes a picture ready for a scene",
                                    [&call] { return run_prepare(call.prepare); });
    add_value(command, "IN", prepare.image, "IN", "The picture, also in FITS");
    add_value(command, "-o,--output", prepare.folder, "FOLDER",
              "Gets picture.exr in linear light, stars.csv, background.json, front.exr and back.exr")
        ->required();
    add_three_filters(command, prepare);
    for (const PrepareOption& option : prepare_options()) {
        const auto set = [&prepare, key = option.key](const std::string& text) {
            prepare.settings[key] = text;
        };
        command.add_option_function<std::string>(option.option, set, option.help)
            ->option_text(option.placeholder);
    }
    add_value(
        command, "--split", prepare.split, "FILE",
        "Writes front.exr, what is not black in that picture, and back.exr, the rest with that part filled");
    command.add_flag("--overwrite", prepare.overwrite, "Replaces the files in the folder");
    add_progress(command, prepare.progress);
}

void add_generate(CLI::App& app, Invocation& call) {
    CLI::App& command = add_command(app, call, "generate", "Generates a layer's splats into a file",
                                    [&call] { return run_generate(call.generate); });
    add_value(command, "SCENE", call.generate.scene, "SCENE", "The scene")->required();
    add_value(command, "--layer", call.generate.layer, "NAME", "Name of the layer")->required();
    add_value(command, "-o,--output", call.generate.output, "FILE.(pda|ply|splats)",
              "The splat file to write")
        ->required();
    add_assignments(command, call.generate.assignments);
    add_value(command, "--memory", call.generate.memory_gib, "GiB",
              "Limit of what is taken: pictures of bodies that would take more are reduced, columns written "
              "in parts");
    command.add_flag("--overwrite", call.generate.overwrite, "Replaces the file");
    add_progress(command, call.generate.progress);
}

void add_convert(CLI::App& app, Invocation& call) {
    CLI::App& command = add_command(app, call, "convert", "Converts between splat files",
                                    [&call] { return run_convert(call.convert); });
    add_value(command, "IN", call.convert.input, "IN",
              "A " + alternatives(endings_of({FileKind::splats})) + " file")
        ->required();
    add_value(command, "OUT", call.convert.output, "OUT",
              "A " + alternatives(endings_of({FileKind::splats}, FileUse::written)) + " file")
        ->required();
    command.add_flag("--overwrite", call.convert.overwrite, "Replaces the file");
    add_progress(command, call.convert.progress);
}

void add_camera(CLI::App& app, Invocation& call) {
    CLI::App& command = add_command(app, call, "camera", "Writes the scene's camera for other programs",
                                    [&call] { return run_camera(call.camera); });
    add_value(command, "SCENE", call.camera.scene, "SCENE", "The scene")->required();
    add_value(command, "-o,--output", call.camera.output, "FILE.(chan|csv|gltf|usda)",
              "The camera file to write")
        ->required();
    add_value(command, "-f,--frames", call.camera.frames, "1-100,120,200-300x2", "Instead of output.frames");
    add_assignments(command, call.camera.assignments);
    command.add_flag("--overwrite", call.camera.overwrite, "Replaces the file");
}

void add_status(CLI::App& app, Invocation& call) {
    CLI::App& command =
        add_command(app, call, "status", "Lists which frames are done, missing, damaged or of other settings",
                    [&call] { return run_status(call.status); });
    add_value(command, "SCENE", call.status.batch.scene, "SCENE", "The scene")->required();
    add_frame_choice(command, call.status.batch);
    command.add_flag("--json", call.status.json, "Prints JSON");
}

void add_export(CLI::App& app, Invocation& call) {
    ExportOptions& options = call.export_options;
    CLI::App& command =
        add_command(app, call, "export", export_help, [&call] { return run_export(call.export_options); });
    add_value(command, "SCENE", options.scene, "SCENE", "The scene")->required();
    add_value(command, "-o,--output", options.output, "FILE.(ply|glb|usda|vdb)", "The file to write")
        ->required();
    add_value(command, "--frame", options.frame, "N", "The frame (default: the scene's first)");
    add_value(command, "--layer", options.layer, "NAME", "Only this layer (default: all that are visible)");
    add_value(command, "--count", options.count, "N", "Merges splats until so many are left");
    add_value(command, "--space", options.space, "display|linear",
              "Of colours (default: display in .ply and .usda, linear in .glb and .vdb)");
    add_value(
        command, "--voxel-size", options.voxel_size, "X",
        "Side of the voxels of a .vdb, scene units (default: as the splats are wide, 128 to 512 along the "
        "longest side)");
    add_assignments(command, options.assignments);
    command.add_flag("--overwrite", options.overwrite, "Replaces the file");
    add_progress(command, options.progress);
}

void add_reports(CLI::App& app, Invocation& call) {
    CLI::App& info = add_command(app, call, "info", "Describes any file the program reads",
                                 [&call] { return run_info(call.info); });
    add_value(info, "FILE", call.info.file, "FILE", "Scene, mesh, picture, frame or splat file")->required();
    info.add_flag("--json", call.info.json, "Prints JSON");

    CLI::App& compare = add_command(app, call, "compare", "Compares the linear light of two images",
                                    [&call] { return run_compare(call.compare); });
    add_value(compare, "A", call.compare.a, "A", "An image")->required();
    add_value(compare, "B", call.compare.b, "B", "An image of the same size")->required();
    compare.add_flag("--json", call.compare.json, "Prints JSON");
    add_value(compare, "--max-difference", call.compare.max_difference, "X",
              "Largest difference allowed in any channel; beyond it the exit code is 3");

    CLI::App& parameters = add_command(app, call, "parameters", "Lists every key of a scene file",
                                       [&call] { return run_parameters(call.parameters); });
    add_value(parameters, "SCENE", call.parameters.scene, "SCENE",
              "Lists the keys of this scene as --set takes them, with their values");
    parameters.add_flag("--names", call.parameters.names, "Prints only the keys");
    parameters.add_flag("--json", call.parameters.json, "Prints JSON");
}

void add_fidelity(CLI::App& app, Invocation& call) {
    FidelityOptions& fidelity = call.fidelity;
    CLI::App& command = add_command(app, call, "fidelity", "Measures how true a scene is to its picture",
                                    [&call] { return run_fidelity(call.fidelity); });
    add_value(command, "SCENE", fidelity.scene, "SCENE", "The scene")->required();
    add_value(command, "-o,--output", fidelity.output, "REPORT.(html|json)", "The report to write")
        ->required();
    add_value(command, "--reference", fidelity.reference, "IMAGE",
              "A picture to compare with, in place of the layer's own");
    add_assignments(command, fidelity.assignments);
    command.add_flag("--overwrite", fidelity.overwrite, "Replaces the report");
    add_progress(command, fidelity.progress);
}

void add_verify(CLI::App& app, Invocation& call) {
    VerifyOptions& verify = call.verify;
    CLI::App& command =
        add_command(app, call, "verify", "Renders frames again and says whether files hold them",
                    [&call] { return run_verify(call.verify); });
    add_value(command, "SCENE", verify.batch.scene, "SCENE", "The scene")->required();
    command
        .add_option_function<std::vector<std::string>>(
            "FRAME",
            [&verify](const std::vector<std::string>& files) {
                verify.files.assign(files.begin(), files.end());
            },
            "Frame files; each says itself which frame, size, region and eye it holds")
        ->option_text("FRAME...")
        ->required();
    add_assignments(command, verify.batch.assignments);
    add_value(command, "--layers", verify.batch.layers, "A,B", "Where --batch had it too");
    add_value(command, "--memory", verify.batch.memory_gib, "GiB", "Where --batch had it too");
    command.add_flag("--json", verify.json, "Prints JSON");
    add_progress(command, verify.batch.progress);
}

/// Keys that --set takes as they stand: those of layers need a layer's name, for which the scripts ask the
/// program.
std::vector<std::string> keys_to_set() {
    std::vector<std::string> keys;
    for (const ParameterRow& row : parameter_rows())
        if (!row.spec.key.is_below("layer")) keys.push_back(row.spec.key.text());
    return keys;
}

/// Commands that print the words of the whole command line.
void add_words(CLI::App& app, Invocation& call) {
    CLI::App& manual = add_command(
        app, call, "manual", "Prints a manual page: 1 of the program, 5 of scene files", [&app, &call] {
            if (call.manual != "1" && call.manual != "5")
                bad_input("manual", "", "1 or 5", "'" + call.manual + "'");
            fmt::print("{}", call.manual == "1" ? command_manual(command_words(app)) : scene_manual());
            return exit_done;
        });
    add_value(manual, "SECTION", call.manual, "SECTION", "1: the program, 5: scene files")->required();
    CLI::App& completion = add_command(
        app, call, "completion", "Prints a script with which a shell completes commands", [&app, &call] {
            fmt::print("{}", completion_script(call.shell, command_words(app), keys_to_set()));
            return exit_done;
        });
    add_value(completion, "SHELL", call.shell, "bash|zsh|fish", "The shell")->required();
}

}  // namespace

void add_commands(CLI::App& app, Invocation& call) {
    add_new(app, call);
    add_prepare(app, call);
    add_generate(app, call);
    add_convert(app, call);
    add_export(app, call);
    add_camera(app, call);
    add_status(app, call);
    add_reports(app, call);
    add_fidelity(app, call);
    add_verify(app, call);
    add_words(app, call);
}

}  // namespace astrosplat

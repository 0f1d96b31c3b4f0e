// prepare: asks whether the folder can be written, reads, works, writes, and tells what a scene needs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <nlohmann/json.hpp>

#include "command.h"
#include "core/error.h"
#include "core/text.h"
#include "exit.h"
#include "objects/identify.h"
#include "prepare/stages.h"
#include "prepare/star_removal.h"
#include "scene/check.h"
#include "scene/describe.h"
#include "scene/describe_layer.h"
#include "source/fits.h"
#include "source/object_metadata.h"
#include "source/picture.h"
#include "source/prepared_picture.h"
#include "source/write_image.h"

namespace astrosplat {
namespace {

/// As typed; values are checked before any work.
struct PrepareOptions {
    fs::path red, green, blue;                    // three filters in place of the picture
    std::map<std::string, std::string> settings;  // by key of describe_preparation()
    std::optional<fs::path> split;
};

// Options that are also keys of a source: from their one description.

std::string placeholder_of(const ParameterSpec& spec) {
    switch (spec.type) {
        case ParameterType::choice:
            return fmt::format("{}", fmt::join(spec.choices, "|"));
        case ParameterType::boolean:
            return "true|false";
        case ParameterType::file:
            return "FILE";
        case ParameterType::vector:
            return spec.components == 2 ? "LOW,HIGH" : "X,Y,RX,RY";
        default:
            return "X";
    }
}

std::string default_text(const Parameter& parameter) {
    const Value value = parameter.get();
    const std::string text = value.text() ? *value.text() : to_toml(value);
    return text.empty() || text == "[]" ? "" : fmt::format(" (default: {})", text);
}

// Words as they are typed: no quotes around text, no brackets around lists.
Value value_typed(const std::string& text, const ParameterSpec& spec) {
    if (spec.type == ParameterType::file) return text;
    const bool list = spec.type == ParameterType::vector && !text.starts_with('[');
    return typed_value(list ? "[" + text + "]" : text);
}

// An option that does nothing by itself was meant to do something.
void require_effect(const Parameter& parameter, const Description& description) {
    const auto find = [&](const ParameterKey& key) { return find_parameter(description, key); };
    if (has_effect(parameter.spec, find)) return;
    const Condition& condition = parameter.spec.conditions.front();
    const std::string value = condition.wanted ? " " + to_toml(condition.values.front()) : "";
    bad_input(prepare_option(parameter.spec.key), "", prepare_option(condition.key) + value + " with it",
              "none");
}

/// The command's defaults: it takes the stars away, and shows three filters with one asinh.
TextureSettings default_prepare_settings(bool three_filters) {
    TextureSettings settings;
    settings.prepare.stars = PrepareParams::Stars::remove;
    settings.prepare.lupton = three_filters;
    return settings;
}

/// Whether three filters are given. Throws InputError unless that is so or one picture is given.
bool has_three_filters(const fs::path& picture, const PrepareOptions& own) {
    const int given = !own.red.empty() + !own.green.empty() + !own.blue.empty();
    if (given != 0 && (given != 3 || !picture.empty()))
        bad_input("--r, --g, --b", "", "all three and no other picture",
                  given == 3 ? "'" + picture.string() + "' as well" : std::to_string(given) + " of them");
    if (given == 0 && picture.empty()) bad_input("prepare", "", "a picture, or --r, --g and --b", "none");
    return given == 3;
}

/// Throws InputError for what cannot be or would do nothing.
TextureSettings prepare_settings(const PrepareOptions& own, bool three_filters) {
    TextureSettings settings = default_prepare_settings(three_filters);
    const Description description = describe_preparation(settings);
    for (const auto& [key, text] : own.settings) {
        const Parameter* const parameter = find_parameter(description, key);
        try {
            parameter->set(value_typed(text, parameter->spec));
        } catch (const ValueError& error) {
            throw InputError(prepare_option(key) + ": " + error.what());
        }
    }
    for (const auto& [key, text] : own.settings)
        require_effect(*find_parameter(description, key), description);
    if (const std::optional<KeyProblem> problem = problem_of(settings.prepare))
        throw InputError(prepare_option(problem->key) + ": " + problem->message);
    if (own.settings.contains("stretch") && settings.prepare.lupton)
        bad_input("--stretch", "", "--lupton false with it", "none");
    return settings;
}

// The work.

std::string sky_text(const SkySurface& sky) {
    const nlohmann::ordered_json json = {{"terms", {"1", "u", "v", "u^2", "u*v", "v^2"}},
                                         {"u", "-1 left, 1 right"},
                                         {"v", "-1 top, 1 bottom"},
                                         {"unit", "linear light before the stretch"},
                                         {"red", sky.coefficients[0]},
                                         {"green", sky.coefficients[1]},
                                         {"blue", sky.coefficients[2]}};
    return json.dump(2) + "\n";
}

/// Names of the files that these options ask for.
std::vector<fs::path> pictures_of(const fs::path& folder, const PrepareOptions& own,
                                  const PrepareParams& params) {
    std::vector<fs::path> files{folder / "picture.exr"};
    if (params.stars == PrepareParams::Stars::remove) files.push_back(folder / "stars.csv");
    if (params.background != PrepareParams::Background::keep) files.push_back(folder / "background.json");
    if (own.split) files.insert(files.end(), {folder / "front.exr", folder / "back.exr"});
    return files;
}

/// The first file's words on its object, all files' on how they came about, and on the sky those of the file
/// on whose grid it was put.
std::string metadata_text(const std::vector<fs::path>& inputs, const PrepareParams& params,
                          const std::string& credit) {
    std::vector<ObjectMetadata> all;
    for (const fs::path& input : inputs) all.push_back(clues_of(input).metadata);
    const ObjectMetadata merged = merged_metadata(all);
    ObjectMetadata said = all.front();
    said.spectra = merged.spectra;
    said.urls = merged.urls;
    said.credit = credit;
    if (!params.align.empty()) {
        const ObjectMetadata grid = clues_of(params.align).metadata;
        said.degrees_per_px = grid.degrees_per_px;
        said.reference_px = grid.reference_px;
        said.north_angle = grid.north_angle;
        said.sky_position = grid.sky_position;
    }
    return xmp_packet(said);
}

/// Writes pictures made of the input, with what that says of itself.
struct PictureWriter {
    fs::path folder;
    std::string credit, metadata;
    Existing existing;

    void operator()(const char* name, const Image& image) const {
        write_linear_image(folder / name, image, credit, existing, metadata);
    }
};

/// The part that the mask shows, and the picture with that part filled from around it.
void write_split(const PictureWriter& write, const fs::path& mask_file, const Image& picture,
                 const Progress& progress) {
    const Image mask = read_mask_like(picture, "--split", mask_file);
    Image front = picture, back = picture;
    cut_with_mask(front, mask);
    write("front.exr", front);
    fill(back, bright_pixels(mask), FillKind::texture, progress);
    write("back.exr", back);
}

void write_all(const PictureWriter& write, const PrepareParams& params, const PreparedPicture& result,
               const Image& picture) {
    write("picture.exr", picture);
    if (params.stars == PrepareParams::Stars::remove)
        write_file_atomically(write.folder / "stars.csv",
                              star_table(result.stars, picture.width, picture.height), write.existing);
    if (result.sky)
        write_file_atomically(write.folder / "background.json", sky_text(*result.sky), write.existing);
}

std::string sky_summary(const std::optional<SkySurface>& sky) {
    if (!sky) return "left in the picture";
    return fmt::format("{:.4g} {:.4g} {:.4g} in the middle taken off", sky->at(0.0, 0.0, 0),
                       sky->at(0.0, 0.0, 1), sky->at(0.0, 0.0, 2));
}

std::string star_summary(const PrepareParams& params, const std::vector<PictureStar>& stars) {
    if (params.stars == PrepareParams::Stars::keep) return "left in the picture";
    const auto saturated = std::ranges::count_if(stars, &PictureStar::saturated);
    return fmt::format("{} taken away, {} of them saturated", stars.size(), saturated);
}

void print_summary(const fs::path& folder, const std::vector<fs::path>& files, const PrepareParams& params,
                   const PreparedPicture& result, const Image& picture) {
    std::string names;
    for (const fs::path& file : files) names += " " + printable(file.filename().string());
    fmt::print("picture     {}x{} px, linear light, {}\n", picture.width, picture.height,
               picture.channels == 4 ? "alpha" : "no alpha");
    fmt::print("stars       {}\n", star_summary(params, result.stars));
    fmt::print("background  {}\n", sky_summary(result.sky));
    fmt::print("written     {}:{}\n", printable(folder.string()), names);
    fmt::print("next        astrosplat new {} -o SCENE.toml\n", printable(files.front().string()));
}

/// Of all input files, before any of the work.
void require_inputs(const fs::path& image, const PrepareOptions& own, const PrepareParams& params) {
    for (const fs::path& file : {image, own.red, own.green, own.blue, params.align, params.starless,
                                 params.fill, params.mask, own.split.value_or(fs::path())})
        if (!file.empty()) require_picture(file);
    if (own.settings.contains("stretch") && !image.empty() && !is_fits(image))
        bad_input("--stretch", "", "a FITS picture", "'" + image.string() + "'");
}

int run_prepare(const CommandOptions& options, const PrepareOptions& own) {
    const fs::path &image = options.input, folder = *options.output;
    const bool three_filters = has_three_filters(image, own);
    const TextureSettings settings = prepare_settings(own, three_filters);
    const PrepareParams& params = settings.prepare;
    require_inputs(image, own, params);
    const std::vector<fs::path> files = pictures_of(folder, own, params);
    for (const fs::path& file : files) refuse_to_overwrite(file, options.overwrite);
    prove_writable(folder);
    ProgressReport report(options.progress);
    const Progress progress = report.begin_step("preparing");
    std::vector<fs::path> inputs{image};
    if (three_filters) inputs = {own.red, own.green, own.blue};
    const PreparedPicture result = prepare_picture(inputs, settings, progress);
    const Image picture = without_plain_alpha(result.image);
    const PictureWriter write{folder, result.credit, metadata_text(inputs, params, result.credit),
                              existing_of(options)};
    if (own.split) write_split(write, *own.split, result.image, progress);
    write_all(write, params, result, picture);
    print_summary(folder, files, params, result, picture);
    return exit_done;
}

void add_three_filters(CLI::App& command, PrepareOptions& own) {
    add_value(command, "--r", own.red, "FILE",
              "With --g and --b in place of IN: three filters, brought onto the grid of the first where FITS "
              "headers tell the sky, and shown with one asinh for all (Lupton)");
    add_value(command, "--g", own.green, "FILE", "The filter shown as green");
    add_value(command, "--b", own.blue, "FILE", "The filter shown as blue");
}

/// The options that are also keys of a source, with their defaults.
void add_settings(CLI::App& command, std::map<std::string, std::string>& values) {
    TextureSettings settings = default_prepare_settings(false);
    for (const Parameter& parameter : describe_preparation(settings).parameters) {
        const ParameterSpec& spec = parameter.spec;
        const std::string unit = spec.unit.empty() ? "" : fmt::format(" [{}]", spec.unit);
        const auto set = [&values, key = spec.key.text()](const std::string& text) { values[key] = text; };
        command
            .add_option_function<std::string>(prepare_option(spec.key), set,
                                              spec.help + unit + default_text(parameter))
            ->option_text(placeholder_of(spec));
    }
}

}  // namespace

void add_prepare(CLI::App& app, Invocation& call) {
    auto [command, own] = add_command(app, call, "prepare", "Makes a picture ready for a scene", run_prepare);
    add_value(command, "IN", call.options.input, "IN", "The picture, also in FITS");
    add_output(command, call.options, "FOLDER",
               "Gets picture.exr in linear light, stars.csv, background.json, front.exr and back.exr");
    add_three_filters(command, own);
    add_settings(command, own.settings);
    add_value(
        command, "--split", own.split, "FILE",
        "Writes front.exr, what is not black in that picture, and back.exr, the rest with that part filled");
    add_progress(command, call.options);
}

}  // namespace astrosplat

#include "command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "core/text.h"
#include "exit.h"
#include "scene/parameter_key.h"

namespace astrosplat {
namespace {

/// Throws where `value` is not from lo to hi.
template <class Number>
Number within(const std::optional<Number>& value, Number lo, Number hi, const char* option,
              const std::string& text, const char* expected) {
    if (!value || !(*value >= lo && *value <= hi)) bad_input(option, "", expected, "'" + text + "'");
    return *value;
}

}  // namespace

std::vector<Assignment> assignments_of(const CommandOptions& options) {
    std::vector<Assignment> assignments;
    for (const std::string& text : options.assignments) assignments.push_back(parse_assignment(text));
    return assignments;
}

double option_number(const char* option, const std::string& text, const char* expected, double lo,
                     double hi) {
    return within(parse_double(text), lo, hi, option, text, expected);
}

std::int64_t option_count(const char* option, const std::string& text, const char* expected, std::int64_t lo,
                          std::int64_t hi) {
    return within(parse_int64(text), lo, hi, option, text, expected);
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream in(text + separator);
    for (std::string part; std::getline(in, part, separator);) parts.emplace_back(trim(part));
    return parts;
}

const LayerParams& layer_named(const Scene& scene, const std::string& name) {
    std::vector<std::string> names;
    for (const LayerParams& layer : scene.layers) {
        if (layer.name == name) return layer;
        names.push_back(layer.name);
    }
    bad_input(scene.file.string(), "",
              fmt::format("--layer to name one of its layers ({})", fmt::join(names, ", ")),
              "'" + name + "'" + did_you_mean(name, names));
}

void prove_writable(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw OutputError(folder.string() + ": cannot create this folder: " + error.message());
    const AtomicFile probe(folder / "astrosplat-probe");  // never committed: its destructor removes it
}

fs::path folder_of(const fs::path& file) { return fs::absolute(file).parent_path(); }

void refuse_to_overwrite(const fs::path& file, bool overwrite) {
    std::error_code ignored;
    if (overwrite || !fs::exists(fs::symlink_status(file, ignored))) return;
    throw InputError(file.string() + ": exists already; --overwrite replaces it");
}

WriteTarget claim_output(const CommandOptions& options) {
    refuse_to_overwrite(*options.output, options.overwrite);
    defer_interrupts();
    prove_writable(folder_of(*options.output));
    return {*options.output, existing_of(options)};
}

namespace {

bool is_plain_list(const Report& value) {
    const auto is_plain = [](const Report& item) { return !item.is_structured(); };
    return value.is_array() && std::all_of(value.begin(), value.end(), is_plain);
}

std::string plain_text(const Report& value) {
    if (value.is_string()) return printable(value.get<std::string>());
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_number_float()) return fmt::format("{:.7g}", value.get<double>());
    if (!value.is_array()) return value.dump();
    std::string line;
    for (const Report& item : value) line += (line.empty() ? "" : ", ") + plain_text(item);
    return line;
}

void print_lines(const Report& report, int indent) {
    for (const auto& entry : report.items()) {
        const std::string name = report.is_array() ? "-" : printable(entry.key()) + ":";
        if (!entry.value().is_structured() || is_plain_list(entry.value())) {
            fmt::print("{:{}}{} {}\n", "", indent, name, plain_text(entry.value()));
        } else {
            fmt::print("{:{}}{}\n", "", indent, name);
            print_lines(entry.value(), indent + 2);
        }
    }
}

}  // namespace

Report number(double value) {
    if (std::isfinite(value)) return value;
    return fmt::format("{}", value);
}

void print_report(const Report& report, bool json) {
    if (!json) return print_lines(report, 0);
    fmt::print("{}\n", report.dump(2, ' ', false, Report::error_handler_t::replace));
}

void add_input(CLI::App& app, CommandOptions& options, const std::string& name, const std::string& help) {
    add_value(app, name, options.input, name, help)->required();
}

CLI::Option* add_output(CLI::App& app, CommandOptions& options, const std::string& placeholder,
                        const std::string& help) {
    CLI::Option* const output = add_value(app, "-o,--output", options.output, placeholder, help)->required();
    app.add_flag("--overwrite", options.overwrite, "Replaces what is there already");
    return output;
}

void add_assignments(CLI::App& app, CommandOptions& options) {
    app.add_option_function<std::vector<std::string>>(
           "--set", [&options](const std::vector<std::string>& texts) { options.assignments = texts; },
           "Sets a key of the scene; may be repeated")
        ->option_text("KEY=VALUE")
        ->expected(1)
        ->allow_extra_args(false)  // what follows is the scene
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_progress(CLI::App& app, CommandOptions& options) {
    app.add_option_function<std::string>(
           "--progress",
           [&options](const std::string& text) {
               if (text != "auto" && text != "plain" && text != "none")
                   bad_input("--progress", "", "auto, plain or none", "'" + text + "'");
               options.progress = text == "auto"    ? ProgressMode::automatic
                                  : text == "plain" ? ProgressMode::plain
                                                    : ProgressMode::none;
           },
           "How to report progress on stderr")
        ->option_text("auto|plain|none");
}

void add_json(CLI::App& app, CommandOptions& options) { app.add_flag("--json", options.json, "Prints JSON"); }

void add_common(CLI::App& app, Invocation& call) {
    app.set_help_flag("-h,--help", "Prints this help");
    app.set_version_flag("--version", "astrosplat " ASTROSPLAT_VERSION,
                         "Prints version, commit and libraries");
    add_value(app, "-t,--threads", call.threads, "N", "Threads (default: the cores this process may use)");
    add_value(
        app, "--cache", call.cache, "DIR",
        "Folder that keeps generated sets and prepared pictures (default: $ASTROSPLAT_CACHE, "
        "$XDG_CACHE_HOME/astrosplat or ~/.cache/astrosplat); at most 20 GiB or a tenth of the disk, the "
        "least recently used go");
    app.add_flag("--no-cache", call.no_cache, "Neither reads nor writes generated sets");
    app.add_flag("-v,--verbose", call.verbose, "Says more");
    app.add_flag("-q,--quiet", call.quiet, "Says only warnings and errors");
    const std::string log_json = "Messages and progress on stderr as JSON, one object a line";
    app.add_flag("--log-json", log_json);  // was seen to before all else
}

void add_frame_choice(CLI::App& app, CommandOptions& options) {
    add_value(app, "-f,--frames", options.frames, "1-100,120,200-300x2", "Frames instead of output.frames");
    add_value(app, "-o,--output", options.output, "PATTERN", "Frame files, such as frames/shot.####.exr");
    add_value(app, "--resolution", options.resolution, "1920x1080|50%", "Size of the frame");
    add_assignments(app, options);
    add_value(app, "--layers", options.layers, "A,B", "Only these layers");
    add_value(app, "--memory", options.memory_gib, "GiB",
              "Limit of all that the program takes: larger .splats files are read block by block, and "
              "pictures that bodies are made of are reduced");
    add_value(app, "--region", options.region, "X,Y,W,H", "Part of the frame, from the top left, in pixels");
}

CLI::App& add_command(CLI::App& app, Invocation& call, const char* name, const char* help,
                      std::function<int(const CommandOptions&)> run) {
    CLI::App& command = *app.add_subcommand(name, help);
    add_common(command, call);
    command.callback([&call, run = std::move(run)] { call.command = run; });
    return command;
}

}  // namespace astrosplat

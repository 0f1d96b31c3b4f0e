#include "cli.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>

#include "build_facts.h"
#include "cli_commands.h"
#include "cli_options.h"
#include "core/error.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/text.h"
#include "core/vector_target.h"
#include "interrupt.h"
#include "json_log.h"
#include "places.h"
#include "sets_only.h"
#include "window.h"

namespace astrosplat {
namespace {

void apply_common(const CommonOptions& common) {
    if (common.quiet) set_log_level(LogLevel::warning);
    if (common.verbose) set_log_level(LogLevel::detail);
    if (!common.threads.empty()) {
        const std::optional<std::int64_t> threads = parse_int64(common.threads);
        if (!threads || *threads < 1 || *threads > 1024) {
            bad_input("--threads", "", "a number from 1 to 1024", "'" + common.threads + "'");
        }
        set_thread_count(static_cast<int>(*threads));
    }
}

SetCache cache_of(const CommonOptions& common) {
    if (common.no_cache) return {};
    return {common.cache.empty() ? default_cache_folder() : std::filesystem::path(common.cache)};
}

/// Of every command, unless a mode was asked for.
void silence_progress(Invocation& call) {
    for (ProgressMode* mode : {&call.batch_options.progress, &call.generate.progress, &call.convert.progress,
                               &call.export_options.progress, &call.fidelity.progress, &call.prepare.progress,
                               &call.verify.batch.progress})
        if (*mode == ProgressMode::automatic) *mode = ProgressMode::none;
}

int run(Invocation& call) {
    apply_common(call.common);
    log_detail(fmt::format("threads {}, vector target {}", thread_count(), vector_target()));
    for (SetCache* cache : {&call.batch_options.cache, &call.status.batch.cache, &call.verify.batch.cache,
                            &call.generate.cache, &call.export_options.cache, &call.fidelity.cache})
        *cache = cache_of(call.common);
    if (call.common.quiet) silence_progress(call);
    if (call.action) {
        if (call.batch) bad_input("--batch", "", "a scene", "a command as well");
        return call.action();
    }
    const bool submits = !call.submit.system.empty();
    if (!submits && (call.submit.chunk || call.submit.partition))
        bad_input(call.submit.chunk ? "--chunk" : "--partition", "", "--submit slurm beside it", "none");
    if (!call.batch && !submits) return run_window(call);
    const char* mode = submits ? "--submit" : "--batch";
    if (!call.screenshot.output.empty()) bad_input(mode, "", "no --screenshot beside it", "both");
    if (call.input.empty()) bad_input(mode, "", "a scene file", "none (see --help)");
    call.batch_options.scene = call.input;
    if (submits) return run_submit(call.submit, call.batch_options);
    return call.batch_options.sets_only ? run_sets_only(call.batch_options) : run_batch(call.batch_options);
}

/// CLI11's message as one line.
int report_usage_error(const CLI::ParseError& error) {
    std::string line = error.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
    log_error(line + " (see astrosplat --help)");
    return exit_not_started;
}

}  // namespace

int run_command_line(int argc, char** argv) {
    // A mistake in the command line is to be JSON, too.
    if (std::any_of(argv, argv + argc, [](const std::string& text) { return text == "--log-json"; }))
        log_as_json();
    Invocation call;
    CLI::App app("Turns a mesh and a telescope picture into a volume of soft splats and renders film frames.",
                 "astrosplat");
    app.require_subcommand(0, 1);
    add_program_options(app, call);
    add_commands(app, call);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        const auto commands = app.get_subcommands();
        fmt::print("{}", commands.empty() ? app.help() : commands.front()->help());
        return exit_done;
    } catch (const CLI::CallForVersion&) {
        fmt::print("{}", version_text());
        return exit_done;
    } catch (const CLI::ParseError& error) {
        return report_usage_error(error);
    }
    return run(call);
}

}  // namespace astrosplat

// fidelity: loads, asks whether the report can be written, measures, writes.
#include "fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "batch_plan.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/text.h"
#include "estimate.h"
#include "fidelity_page.h"
#include "fidelity_table.h"
#include "interrupt.h"
#include "measure_fidelity.h"
#include "places.h"
#include "scene/animate.h"
#include "scene/check.h"
#include "scene/frames.h"
#include "scene/load.h"

namespace astrosplat {
namespace {

bool ends_in_html(const std::filesystem::path& file) {
    const std::string ending = lower_case(file.extension().string());
    if (ending == ".html" || ending == ".htm") return true;
    if (ending != ".json")
        bad_input(file.string(), "", "a name ending in .html or .json",
                  "'" + file.extension().string() + "'");
    return false;
}

/// The scene with the command line applied, as it stands at its first frame.
Scene scene_to_measure(const FidelityOptions& options) {
    std::vector<Assignment> assignments;
    for (const std::string& text : options.assignments) assignments.push_back(parse_assignment(text));
    const auto [scene, places] = load_placed(options.scene, assignments);
    Scene judged = scene;  // its cameras and its sky are not rendered
    judged.camera = {};
    judged.environment = {};
    std::erase_if(judged.animation, [](const Track& track) { return track.key.layer().empty(); });
    check_renderable(judged, places);
    const std::int64_t first =
        parse_frames(scene.output.frames, scene.file.string() + ": output.frames").front();
    Scene now = scene_at(judged, static_cast<double>(first));
    now.camera = {};
    stop_animation(now);
    return now;
}

void announce_memory(const Scene& now, const FidelityReference& reference, const FidelitySettings& settings) {
    BatchPlan plan;
    plan.scene = now;
    plan.cache = settings.cache;
    plan.scene.output.width = std::max(settings.width_px, reference.picture.width);
    plan.scene.output.height = reference.height_px(plan.scene.output.width);
    plan.scene.output.aovs.clear();
    const JobEstimate job = estimate(plan);
    const std::int64_t bytes = job.bytes + fidelity_bytes(reference, settings);
    log_info(fmt::format("front views of {} and {} px, about {}, about {} of memory", settings.width_px,
                         reference.picture.width, human_count(job.splats, "splat"),
                         human_bytes(static_cast<double>(bytes))));
}

/// A front view holds the light of all layers, a picture that of one.
void warn_of_other_layers(const Scene& now, const FidelityReference& reference) {
    const auto shown = std::count_if(now.layers.begin(), now.layers.end(),
                                     [](const LayerParams& layer) { return layer.visible; });
    if (shown > 1 && reference.file.empty())
        log_warning(
            fmt::format("{} layers are seen, and compared with the picture of '{}' alone; --reference names "
                        "another picture",
                        shown, reference.layer));
}

void print_rows(const std::vector<FidelityRow>& rows) {
    std::string view;
    for (const FidelityRow& row : rows) {
        if (row.view != view) fmt::print("{}\n", row.view);
        view = row.view;
        const std::string line = fmt::format("  {:<24} {:>28}   {:<18} {}", row.measure, row.value,
                                             row.target, word_of(row.verdict));
        fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
    }
}

}  // namespace

int run_fidelity(const FidelityOptions& options) {
    const bool html = ends_in_html(options.output);
    const Scene now = scene_to_measure(options);
    refuse_to_overwrite(options.output, options.overwrite);
    defer_interrupts();
    prove_writable(folder_of(options.output));
    ProgressReport progress(options.progress);
    const FidelityReference reference =
        fidelity_reference(now, options.reference, progress.begin_step("reading the picture"), options.cache);
    warn_of_other_layers(now, reference);
    FidelitySettings settings;
    settings.cache = options.cache;
    settings.begin_step = [&](const std::string& step) { return progress.begin_step(step); };
    announce_memory(now, reference, settings);
    const FidelityReport report = measure_fidelity(now, reference, settings);
    const std::string name = now.file.filename().string();
    const std::string text =
        html ? fidelity_page(report, name)
             : fidelity_json(report, name).dump(2, ' ', false, Report::error_handler_t::replace) + "\n";
    write_file_atomically(options.output, text, options.overwrite ? Existing::replace : Existing::keep);
    print_rows(fidelity_rows(report));
    fmt::print("{}\n", printable(options.output.string()));
    return exit_done;
}

}  // namespace astrosplat

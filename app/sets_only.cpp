// One layer in memory at a time.
#include "sets_only.h"

#include <fmt/format.h>

#include "batch_plan.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "interrupt.h"
#include "places.h"
#include "progress_report.h"
#include "scene/animate.h"
#include "scene/layer_source.h"

namespace astrosplat {

int run_sets_only(const BatchOptions& options) {
    if (options.cache.folder.empty()) bad_input("--sets-only", "", "a cache that keeps them", "none");
    if (options.dry_run || options.stats)
        bad_input("--sets-only", "",
                  fmt::format("no {} beside it", options.dry_run ? "--dry-run" : "--stats"), "both");
    const BatchPlan plan = plan_frames(options);
    defer_interrupts();
    prove_writable(options.cache.folder);
    ProgressReport report(options.progress);
    for (const LayerParams& layer : plan.scene.layers) {
        if (!ever_visible(plan.scene, layer)) continue;
        const LoadedSet loaded = load_source(plan.cache, source_of(plan.scene, layer), layer.name,
                                             report.begin_step("preparing " + layer.name));
        log_info(fmt::format("layer {}: {}{}", layer.name, human_count(loaded.set.size(), "splat"),
                             loaded.cached ? ", kept already" : ""));
    }
    check_unchanged(plan.hasher.files(), Progress{{}, &interrupted()});
    return exit_done;
}

}  // namespace astrosplat

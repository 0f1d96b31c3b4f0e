// The window, or a screenshot of it.
#include "cli.h"
#include "core/error.h"
#ifdef ASTROSPLAT_WINDOW
#include "core/file.h"
#include "exit.h"
#include "farm/child_process.h"
#endif

namespace astrosplat {
#ifdef ASTROSPLAT_WINDOW
namespace {

void refuse_without_screenshot(const ScreenshotOptions& shot) {
    const char* option = shot.size      ? "--size"
                         : shot.frame   ? "--frame"
                         : shot.ui      ? "--ui"
                         : shot.settled ? "--settled"
                         : shot.opengl  ? "--opengl"
                                        : nullptr;
    if (option) bad_input(option, "", "--screenshot OUT.png beside it", "none");
}

}  // namespace

int run_window(Invocation& call) {
    CommandOptions& options = call.options;
    if (!options.input.empty()) options.input = find_by_name("scenes", options.input);
    const ViewerOptions viewer{options.input, assignments_of(options), options.cache,
                               own_program(), !call.threads.empty(),   !call.cache.empty() || call.no_cache};
    ScreenshotOptions& shot = call.screenshot;
    if (shot.output.empty()) {
        refuse_without_screenshot(shot);
        defer_interrupts();
        return run_viewer(viewer, interrupted());
    }
    prove_writable(folder_of(shot.output));
    shot.scene = viewer;
    return run_screenshot(shot);
}

#else

int run_window(Invocation&) {
    throw InputError(
        "this astrosplat was built without its window; --batch SCENE renders, --help names what else it "
        "does");
}

#endif

}  // namespace astrosplat

#include "window.h"

#include "core/error.h"
#ifdef ASTROSPLAT_WINDOW
#include "core/file.h"
#include "farm/child_process.h"
#include "interrupt.h"
#include "places.h"
#include "viewer/run_viewer.h"
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
    if (!call.input.empty()) call.input = find_by_name("scenes", call.input).string();
    ViewerOptions viewer{call.input,
                         {},
                         call.batch_options.cache,
                         own_program(),
                         !call.common.threads.empty(),
                         !call.common.cache.empty() || call.common.no_cache};
    for (const std::string& text : call.batch_options.assignments)
        viewer.assignments.push_back(parse_assignment(text));
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

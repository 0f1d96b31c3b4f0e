// One frame of what the window would show, without a display: the viewport alone, or with the panels.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/vec2.hpp>
#include <thread>

#include "core/error.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/progress.h"
#include "core/text.h"
#include "exit.h"
#include "output/write.h"
#include "scene/check.h"
#include "source/write_image.h"
#include "viewer/session.h"
#include "viewer/viewer.h"
#include "viewer/window.h"

namespace astrosplat {
namespace {

/// Advances until the sets are there and the frame is what was asked for.
template <class DrawFrame>
void wait_for_frame(Session& session, bool final, const DrawFrame& draw_frame) {
    for (;;) {
        const double now = seconds_now();
        advance(session, now);
        draw_frame(now);
        if (session.status.view_frame.state == ViewFrameState::failed)
            throw InputError(session.status.view_frame.error);
        for (const LayerStatus& layer : session.status.layers)
            if (!layer.error.empty()) throw InputError(layer.error);
        if (session.sets.loaded(session.document) &&
            (final ? settled(session) && !session.front.working() : preview_exact(session)))
            return;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

/// Px.
glm::ivec2 parse_size(const std::string& text) {
    const std::size_t x = text.find('x');
    const auto width = parse_int64(text.substr(0, x));
    const auto height = x == std::string::npos ? std::nullopt : parse_int64(text.substr(x + 1));
    constexpr std::int64_t most = 16384;
    if (!width || !height || *width < 16 || *height < 16 || *width > most || *height > most)
        bad_input("--size", "", "a size from 16x16 to 16384x16384, such as 960x540", "'" + text + "'");
    return {static_cast<int>(*width), static_cast<int>(*height)};
}

double parse_frame(const std::string& text) {
    const auto frame = parse_double(text);
    if (!frame || !std::isfinite(*frame)) bad_input("--frame", "", "a number", "'" + text + "'");
    return *frame;
}

void write_exr(const ScreenshotOptions& options, glm::ivec2 size, Session& session) {
    RenderedFrame preview;
    OutputParams output = session.document.scene().output;
    if (!options.settled) {
        preview.beauty = session.view_frame.read();
        output.aovs.clear();
    }
    const auto final = options.settled ? session.view_frame.final_frame() : nullptr;
    const RenderedFrame& frame = final ? *final : preview;
    output.path = options.output.string();
    output.depth = OutputParams::Depth::float32;
    output.compression = OutputParams::Compression::automatic;
    output.view = OutputParams::View::automatic;
    output.alpha = OutputParams::Alpha::automatic;
    FrameMetadata metadata;
    metadata.frame = static_cast<std::int64_t>(session.view.frame);
    metadata.fps = output.fps;
    metadata.pixel_hash = pixel_hash(frame.beauty);
    metadata.provenance = session.document.scene().provenance;
    write_frame({options.output, output, size.x, size.y}, frame, metadata);
}

/// The viewport alone.
void take_viewport(const ScreenshotOptions& options, glm::ivec2 size, bool exr, Session& session) {
    wait_for_frame(session, options.settled, [&](double now) { draw_viewport(session, size, now, true); });
    if (exr) return write_exr(options, size, session);
    write_image(options.output, size.x, size.y, session.display.read());
}

/// The window with its panels.
void take_window(const ScreenshotOptions& options, glm::ivec2 size, Session& session) {
    WidgetTarget target(size.x, size.y);
    Gui gui;
    const auto draw_frame = [&](double now) {
        target.begin();
        Commands commands;
        gui.draw(session.document, session.view, session.status, commands);
        const Layout layout =
            make_layout(session.view, static_cast<float>(size.x), static_cast<float>(size.y), 1.0f);
        draw_viewport(session,
                      {static_cast<int>(layout.viewport.width), static_cast<int>(layout.viewport.height)},
                      now, true);
        target.end();
    };
    wait_for_frame(session, options.settled, draw_frame);
    for (int i = 0; i < 3; ++i) {  // until the widgets have seen the last status
        advance(session, seconds_now());
        draw_frame(seconds_now());
    }
    write_image(options.output, size.x, size.y, target.read());
}

void take(const ScreenshotOptions& options, const GlInfo& gl) {
    const glm::ivec2 size = options.size ? parse_size(*options.size) : glm::ivec2(960, 540);
    const FileFormat* const format = format_by_name(options.output);
    const bool exr = format && format->id == "openexr";
    if (!exr && !(format && format->id == "png"))
        bad_input("--screenshot", "", "a .png or .exr file", options.output.string());
    if (exr && options.ui)
        bad_input("--screenshot", "", "no --ui with an .exr file, which holds the picture's light",
                  options.output.string());
    Session session(options.scene, gl);
    check_renderable(session.document.scene(), {});
    if (options.frame) session.view.frame = parse_frame(*options.frame);
    session.view.settle = options.settled;
    session.view.hint_open = false;
    prepare_screenshot(session, options.ui);
    if (options.opengl) session.view.engine = PreviewEngine::opengl;
    options.ui ? take_window(options, size, session) : take_viewport(options, size, exr, session);
}

}  // namespace

int run_screenshot(const ScreenshotOptions& options) {
    std::unique_ptr<OffscreenContext> context;
    try {
        context = std::make_unique<OffscreenContext>();
    } catch (const NoContext& error) {
        log_error(std::string("no OpenGL: ") + error.what() +
                  "; frames render without it: astrosplat --batch SCENE");
        return exit_not_started;
    }
    take(options, context->info());
    return exit_done;
}

}  // namespace astrosplat

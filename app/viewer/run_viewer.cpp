// The window's loop: wait for events, advance the session, draw widgets and viewport, show them. And one
// frame of what it would show, without a display: the viewport alone, or with the panels.
#include "viewer/viewer.h"

#include <fmt/format.h>
#include <imgui.h>

#include <chrono>
#include <cstdio>
#include <mutex>
#include <thread>

#include "core/error.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/text.h"
#include "exit.h"
#include "gui/widgets.h"
#include "output/write.h"
#include "scene/check.h"
#include "scene/source_metadata.h"
#include "source/write_image.h"
#include "viewer/session.h"
#include "viewer/window.h"

namespace astrosplat {
namespace {

/// Frames drawn after the last event, so that hovers, tooltips and layouts come to rest.
constexpr int frames_after_event = 4;

constexpr double screen_frame_s = 1.0 / 60.0;

/// Messages of the engine and the widgets, from any thread: for the terminal at once, and errors and warnings
/// for the message bar in the next frame.
class LogLines {
  public:
    void push(LogLevel level, const std::string& line) {
        fmt::print(stderr, "{}\n", terminal_line(level, line));
        if (level != LogLevel::error && level != LogLevel::warning) return;
        {
            const std::lock_guard lock(mutex_);
            messages_.push_back({line, level == LogLevel::error, 0});
        }
        Window::wake();
    }
    std::vector<Message> take() {
        const std::lock_guard lock(mutex_);
        return std::exchange(messages_, {});
    }

  private:
    std::mutex mutex_;
    std::vector<Message> messages_;
};

ShownPicture shown_picture(const Session& session) {
    return {session.status.viewport_texture, session.viewport_px.x, session.viewport_px.y};
}

class Loop {
  public:
    Loop(const ViewerOptions& options, const Preferences& preferences, const std::atomic<bool>& interrupted)
        : interrupted_(interrupted),
          window_(preferences.window_width, preferences.window_height, "astrosplat"),
          session_(options, window_.gl()) {
        apply_theme(wanted_scale(), wanted_contrast());
        set_log_sink([this](LogLevel level, const std::string& line) { log_.push(level, line); });
    }

    ~Loop() { set_log_sink(nullptr); }
    Loop(const Loop&) = delete;
    Loop& operator=(const Loop&) = delete;

    void run() {
        while (!session_.quitting) {
            wait();
            frame();
        }
        int width = 0, height = 0;
        window_.size(width, height);
        close(session_, width, height);
    }

  private:
    void wait() {
        const double due = next_due(session_, seconds_now());
        if (window_.has_input()) {
            was_touched_ = true;
            window_.wait(0.0);
        } else if (frames_left_ > 0 || gui_.busy() || due <= 0.0) {
            window_.wait(still_ ? screen_frame_s : 0.0);  // where nothing is shown, no screen sets the pace
            frames_left_ = std::max(0, frames_left_ - 1);
        } else {
            // Sets, frames and undone steps come and go with every touch.
            if (due >= idle_due_s && std::exchange(was_touched_, false)) return_freed_memory();
            const double before = seconds_now();
            window_.wait(due);
            // Woken by an event rather than by the clock: let the widgets come to rest again.
            if (seconds_now() - before < due - 0.001) frames_left_ = frames_after_event;
        }
    }

    void frame() {
        if (interrupted_) interrupt(session_);
        if (window_.close_requested()) gui_.ask_to_quit();
        const std::vector<fs::path> dropped = window_.take_dropped();
        if (!dropped.empty()) drop(session_, dropped);
        const double now = seconds_now();
        advance(session_, now);
        for (const Message& message : log_.take()) say(session_.status, message.text, message.error);
        if (title(session_) != title_) window_.set_title(title_ = title(session_));
        if (window_.has_input()) frames_left_ = frames_after_event;
        if (const float scale = wanted_scale(); scale != px(1.0f)) {
            apply_theme(scale, wanted_contrast());
            window_.reload_fonts();
        } else if (wanted_contrast() != theme_contrast()) {
            set_contrast(wanted_contrast());
        }
        if (!window_.begin_frame(gui_.opening())) return;
        const bool was_settled = settled(session_);
        Commands commands = std::exchange(session_.dropped, {});
        gui_.draw(session_.document, session_.view, session_.status, commands);
        navigate(session_, gui_.viewport_input(), now);
        carry_out(session_, commands);
        const ImGuiIO& io = ImGui::GetIO();
        const Layout layout = make_layout(session_.view, io.DisplaySize.x, io.DisplaySize.y, px(1.0f));
        draw_viewport(session_,
                      {static_cast<int>(layout.viewport.width * io.DisplayFramebufferScale.x),
                       static_cast<int>(layout.viewport.height * io.DisplayFramebufferScale.y)},
                      now);
        // The badge was drawn before the frame: it must not call a preview final.
        if (was_settled && !settled(session_)) {
            frames_left_ = frames_after_event;
            return window_.drop_frame();
        }
        still_ = !window_.end_frame(session_.display.version(), shown_picture(session_));
        session_.frame_took_s = seconds_now() - now;
        if (const auto text = std::exchange(session_.clipboard, {})) ImGui::SetClipboardText(text->c_str());
        if (const auto file = std::exchange(session_.screenshot, {})) {
            int width = 0, height = 0;
            const std::vector<unsigned char> pixels = window_.read(width, height);
            save_screenshot(session_, *file, width, height, pixels);
        }
    }

    float wanted_scale() const {
        const int percent = session_.view.settings.interface_percent;
        return percent > 0 ? 0.01f * static_cast<float>(percent) : window_.content_scale();
    }

    int wanted_contrast() const { return session_.view.settings.contrast; }

    const std::atomic<bool>& interrupted_;
    LogLines log_;  // before the session, whose threads write into it
    Window window_;
    Session session_;
    Gui gui_;
    std::string title_;
    int frames_left_ = frames_after_event;
    bool was_touched_ = true;  // since the window was last at rest
    bool still_ = false;       // the last frame looked like the one before
};

}  // namespace

int run_viewer(const ViewerOptions& options, const std::atomic<bool>& interrupted) {
    keep_little_freed_memory();
    const Preferences preferences = load_preferences();
    const Settings& settings = preferences.settings;
    ViewerOptions with_settings = options;
    with_settings.limits = limits_with(settings, options.threads_given ? thread_count() : 0, options.device);
    with_settings.device = with_settings.limits.device;
    if (with_settings.limits.threads > 0) set_thread_count(with_settings.limits.threads);
    with_settings.cache = cache_with(settings, options.cache, options.cache_given);
    limit_memory(std::int64_t{settings.memory_gib} << 30, "Edit > Settings > Memory");
    std::unique_ptr<Loop> loop;
    try {
        loop = std::make_unique<Loop>(with_settings, preferences, interrupted);
    } catch (const NoContext& error) {
        log_error(
            std::string("no window: ") + error.what() +
            "; frames render without one: astrosplat --batch SCENE, and so does an image of the window: "
            "astrosplat --screenshot OUT.png SCENE");
        return exit_not_started;
    }
    loop->run();
    return exit_done;
}

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
    const auto final = options.settled ? session.view_frame.final_frame() : nullptr;
    if (!final) preview.beauty = *session.view_frame.pixels();
    const RenderedFrame& frame = final ? *final : preview;
    OutputParams output = session.document.scene().output;
    std::erase_if(output.aovs, [&](const std::string& aov) {  // the window's frames have no other
        return aov != "depth" || frame.depth.pixels.empty();
    });
    output.path = options.output.string();
    output.depth = OutputParams::Depth::float32;
    output.compression = OutputParams::Compression::automatic;
    output.view = OutputParams::View::automatic;
    output.alpha = OutputParams::Alpha::automatic;
    FrameMetadata metadata;
    metadata.frame = static_cast<std::int64_t>(session.view.frame);
    metadata.fps = output.fps;
    metadata.pixel_hash = pixel_hash(frame.beauty);
    metadata.sources = source_metadata(session);
    metadata.provenance = resolved(session.document.scene().provenance, metadata.sources);
    write_frame({options.output, output, size.x, size.y}, frame, metadata);
}

/// The viewport alone.
void take_viewport(const ScreenshotOptions& options, glm::ivec2 size, bool exr, Session& session) {
    wait_for_frame(session, options.settled, [&](double now) { draw_viewport(session, size, now, true); });
    if (exr) return write_exr(options, size, session);
    write_image(options.output, size.x, size.y, session.display.read(), credit_of(session));
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
        target.end(shown_picture(session));
    };
    wait_for_frame(session, options.settled, draw_frame);
    for (int i = 0; i < 3; ++i) {  // until the widgets have seen the last status
        advance(session, seconds_now());
        draw_frame(seconds_now());
    }
    write_image(options.output, size.x, size.y, target.read(), credit_of(session));
}

void take(const ScreenshotOptions& options, const GlInfo& gl) {
    const glm::ivec2 size = options.size ? parse_size(*options.size) : glm::ivec2(960, 540);
    const FileFormat* const format = format_by_name(options.output);
    const bool exr = format && format->id == "openexr";
    if (!exr && !(format && format->id == "png"))
        bad_input("--screenshot", "", "a .png or .exr file", options.output.string());
    if (exr && options.ui)
        bad_input("--screenshot", "", "no --ui with an .exr file, which holds the frame's light",
                  options.output.string());
    Session session(options.scene, gl);
    wait_for_start(session);
    check_renderable(session.document.scene(), {});
    if (options.frame) session.view.frame = parse_frame(*options.frame);
    session.view.settle = options.settled;
    session.view.hint_open = false;
    session.view.start.reset();
    prepare_screenshot(session, options.ui);
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

// Waiting times at the window: frames while orbiting, a slider, the timeline, the final frame,
// the start. In: a scene (default: the demo) whose sets are in the cache. Out: Markdown; wall and
// processor time, because only the latter means anything on a busy machine.
#include <fmt/format.h>
#include <glad/gl.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>

#include "core/color.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "scene/scene.h"
#include "source/write_image.h"
#include "support/preview_views.h"
#include "support/temp_folder.h"
#include "viewer/session.h"
#include "viewer/window.h"

namespace astrosplat::bench {
namespace {

/// User and system time of all threads.
double processor_seconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Times of the same thing done several times.
struct Times {
    std::vector<double> wall_ms, processor_ms;

    void measure(const std::function<void()>& work) {
        const double wall = seconds_now(), processor = processor_seconds();
        work();
        processor_ms.push_back(1e3 * (processor_seconds() - processor));
        wall_ms.push_back(1e3 * (seconds_now() - wall));
    }
    static double median(std::vector<double> values) {
        std::sort(values.begin(), values.end());
        return values.empty() ? 0.0 : values[values.size() / 2];
    }
    double median_ms() const { return median(wall_ms); }
    double worst_ms() const { return *std::max_element(wall_ms.begin(), wall_ms.end()); }
    double best_ms() const { return *std::min_element(wall_ms.begin(), wall_ms.end()); }
};

void print_head() { fmt::print("| what | target | measured | notes |\n|---|---|---|---|\n"); }

void print_row(const std::string& what, const std::string& target, const std::string& measured,
               const std::string& notes) {
    fmt::print("| {} | {} | {} | {} |\n", what, target, measured, notes);
    std::fflush(stdout);
}

void print_rate(const std::string& what, const std::string& target, const Times& times,
                const std::string& notes) {
    print_row(what, target,
              fmt::format("{:.1f} frames/s, worst {:.1f}", 1e3 / times.median_ms(), 1e3 / times.worst_ms()),
              fmt::format("processor {:.1f} ms a frame, worst {:.1f}{}", Times::median(times.processor_ms),
                          *std::max_element(times.processor_ms.begin(), times.processor_ms.end()), notes));
}

void print_wait(const std::string& what, const std::string& target, const Times& times) {
    print_row(
        what, target, fmt::format("{:.0f} ms, worst {:.0f}", times.median_ms(), times.worst_ms()),
        fmt::format("best {:.0f}, processor {:.0f} ms", times.best_ms(), Times::median(times.processor_ms)));
}

/// The window's loop without the window: a viewport alone, or with the panels around it.
class Viewer {
  public:
    Viewer(const ViewerOptions& options, const GlInfo& gl, int width, int height, bool panels)
        : session_(options, gl), width_(width), height_(height) {
        session_.view.hint_open = false;
        if (panels) widgets_ = std::make_unique<WidgetTarget>(width, height);
        if (panels) gui_ = std::make_unique<Gui>();
    }

    Session& session() { return session_; }

    /// One turn of the loop, until the pixels are there.
    void frame(bool hurry = false) {
        const double now = seconds_now();
        advance(session_, now);
        if (widgets_) {
            widgets_->begin();
            Commands commands;
            gui_->draw(session_.document, session_.view, session_.status, commands);
            const Layout layout = make_layout(session_.view, float(width_), float(height_), 1.0f);
            draw_viewport(session_, {int(layout.viewport.width), int(layout.viewport.height)}, now, hurry);
            widgets_->end();
        } else {
            draw_viewport(session_, {width_, height_}, now, hurry);
        }
        glFinish();
    }
    /// Frames as the window draws them, which sleeps while nothing is due.
    void run_until(const std::function<bool()>& done) {
        for (;;) {
            frame();
            if (done()) return;
            std::this_thread::sleep_for(std::chrono::duration<double>(next_due(session_, seconds_now())));
        }
    }
    void settle() {
        session_.view.settle = true;
        run_until([&] { return settled(session_); });
    }
    /// Until all sets and what comes later are there.
    void load() {
        run_until([&] { return session_.sets.loaded(session_.document) && preview_exact(session_); });
    }
    void orbit_a_little() {
        ViewportInput input;
        input.hovered = true;
        input.drag = ViewportInput::Drag::orbit;
        input.drag_begins = !orbiting_;
        input.delta_px = {5.0, 0.5};
        orbiting_ = true;
        navigate(session_, input, seconds_now());
    }
    Times orbit(int frames) {
        Times times;
        for (int i = 0; i < frames; ++i)
            times.measure([&] {
                orbit_a_little();
                frame();
            });
        return times;
    }

  private:
    Session session_;
    int width_, height_;
    std::unique_ptr<WidgetTarget> widgets_;
    std::unique_ptr<Gui> gui_;
    bool orbiting_ = false;
};

constexpr int samples = 21, orbit_frames = 120, warm_frames = 60;

std::string shown_of(const ViewFrameStatus& picture) {
    return fmt::format(", {} of {} thousand splats", picture.shown / 1000, picture.total / 1000);
}

/// As the window starts: it settles by itself.
void measure_start(Viewer& viewer, double started, double processor_started) {
    const auto print_since_start = [&](const std::string& what, const std::string& target) {
        print_row(what, target, fmt::format("{:.2f} s", seconds_now() - started),
                  fmt::format("processor {:.2f} s", processor_seconds() - processor_started));
    };
    Session& session = viewer.session();
    viewer.run_until([&] { return session.status.view_frame.shown > 0; });
    viewer.frame();
    print_since_start("start to first picture", "<= 1.0 s");
    viewer.run_until([&] { return session.status.view_frame.state == ViewFrameState::refining; });
    print_since_start("start to the final frame's beginning", "");
    viewer.settle();
    print_since_start("start to final picture", "<= 3 s");
    viewer.load();
    print_since_start("start to all that comes later: trees, histograms", "");
}

/// From the last touch, the 0.15 s of rest included.
void measure_settling(Viewer& viewer, const std::string& what) {
    Session& session = viewer.session();
    const double touched = seconds_now(), processor = processor_seconds();
    double first = 0.0;
    std::vector<unsigned char> before;
    session.view.settle = true;
    viewer.run_until([&] {
        if (first == 0.0 && session.status.view_frame.state != ViewFrameState::loading) {
            std::vector<unsigned char> pixels = session.display.read();
            const bool refining =
                session.status.view_frame.state == ViewFrameState::refining || settled(session);
            if (refining && pixels != before) first = seconds_now();
            before = std::move(pixels);
        }
        return settled(session);
    });
    print_row("settled: " + what, "first tiles <= 0.5 s, all <= 2 s",
              fmt::format("{:.2f} s, {:.2f} s", first - touched, seconds_now() - touched),
              fmt::format("from the last touch, 0.15 s of rest included; processor {:.2f} s",
                          processor_seconds() - processor));
}

/// Moves a look parameter of the layers [first, last) to and fro, one step a frame.
Times drag_slider(Viewer& viewer, std::size_t first, std::size_t last) {
    Times times;
    for (int i = 0; i < samples; ++i)
        times.measure([&] {
            viewer.session().document.edit(
                "Drag",
                [&](Scene& scene) {
                    for (std::size_t k = first; k < last; ++k)
                        scene.layers[k].look.alpha.power = 0.5f + 0.01f * float(i + 1);
                },
                1);
            viewer.frame();
        });
    return times;
}

void measure_sliders(Viewer& viewer) {
    const Scene scene = viewer.session().document.scene();
    for (std::size_t i = 0; i < scene.layers.size(); ++i)
        print_wait("slider of layer " + scene.layers[i].name, "<= 80 ms", drag_slider(viewer, i, i + 1));
    print_wait("slider of all layers at once", "<= 80 ms", drag_slider(viewer, 0, scene.layers.size()));
}

/// How the pictures of one layer are read, to and fro, until the preview shows it.
Times drag_level(Viewer& viewer, std::size_t layer) {
    const auto drag_to = [&](int step) {
        viewer.session().document.edit(
            "Drag",
            [&](Scene& scene) {
                using Alpha = TextureSettings::Alpha;
                scene.layers[layer].source.texture.alpha = step % 2 ? Alpha::luminance : Alpha::max;
                scene.layers[layer].source.texture.softening = 0.1 + 0.01 * step;  // of FITS
            },
            1);
        viewer.run_until([&] {
            const LayerParams& now = viewer.session().document.scene().layers[layer];
            return viewer.session().sets.layer(now)->source == now.source;
        });
    };
    drag_to(0);  // reads the files
    Times times;
    for (int i = 1; i <= samples; ++i) times.measure([&] { drag_to(i); });
    return times;
}

void measure_levels(Viewer& viewer) {
    const Scene scene = viewer.session().document.scene();
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        if (scene.layers[i].source.kind != SourceKind::mesh) continue;
        print_wait("level of layer " + scene.layers[i].name, "<= 80 ms", drag_level(viewer, i));
        viewer.session().document.edit("Back", [&](Scene& now) { now = scene; });
        viewer.run_until([&] { return viewer.session().sets.loaded(viewer.session().document); });
    }
}

/// How bodies lie, to and fro, until the preview shows it.
void measure_shaping(Viewer& viewer) {
    const Scene scene = viewer.session().document.scene();
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        const StructureKind kind = scene.layers[i].source.structure.kind;
        if (scene.layers[i].source.kind != SourceKind::mesh || kind == StructureKind::columns) continue;
        const auto drag_to = [&](int step) {
            viewer.session().document.edit(
                "Drag",
                [&](Scene& now) {
                    StructureParams& structure = now.layers[i].source.structure;
                    structure.height = 0.15 + 0.005 * step;
                    structure.depth = 0.1 + 0.005 * step;
                },
                1);
            viewer.run_until([&] {
                const LayerParams& now = viewer.session().document.scene().layers[i];
                return viewer.session().sets.layer(now)->source == now.source;
            });
        };
        drag_to(0);
        Times times;
        for (int step = 1; step <= samples; ++step) times.measure([&] { drag_to(step); });
        print_wait("structure of layer " + scene.layers[i].name, "<= 80 ms", times);
        viewer.session().document.edit("Back", [&](Scene& now) { now = scene; });
        viewer.run_until([&] { return viewer.session().sets.loaded(viewer.session().document); });
    }
}

void measure_scrubbing(Viewer& viewer) {
    Times times;
    viewer.session().view.view = ViewKind::camera;
    for (int i = 0; i < samples; ++i)
        times.measure([&] {
            viewer.session().view.frame = 1.0 + 7.0 * i;
            viewer.frame();
        });
    print_wait("scrub to another frame", "<= 80 ms", times);
}

/// From the last touch until the frame is blurred, as the mean of its first few renderings or of all.
void measure_blurring(Viewer& viewer) {
    Session& session = viewer.session();
    const auto measure = [&](const std::string& what, const std::function<void(CameraParams&)>& blur) {
        session.document.edit("Blur", [&](Scene& now) { blur(now.camera); });
        viewer.run_until([&] { return session.sets.loaded(session.document); });
        Times times;
        std::int64_t samples_seen = 0;
        session.view.settle = true;
        session.view.view = ViewKind::camera;
        for (int i = 0; i < 5; ++i) {
            session.view.frame = 40.0 + 9.0 * i;
            viewer.frame();
            times.measure([&] {
                viewer.run_until([&] { return session.status.view_frame.samples > 1 || settled(session); });
            });
            samples_seen = session.status.view_frame.samples;
        }
        print_wait(fmt::format("blurred by {}: {} samples", what, samples_seen), "<= 500 ms", times);
        session.document.undo();
        session.view.settle = false;
    };
    measure("the lens", [](CameraParams& camera) { camera.f_number = 2.8; });
    measure("the shutter", [](CameraParams& camera) { camera.shutter = 180.0; });
}

/// A touch while the final frame is being computed.
void measure_cancelling(Viewer& viewer) {
    Times times;
    Session& session = viewer.session();
    for (int i = 0; i < samples; ++i) {
        session.view.settle = true;
        viewer.orbit_a_little();
        viewer.frame();
        while (session.status.view_frame.state != ViewFrameState::refining) {
            viewer.frame(true);
            advance(session, seconds_now());
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20 + 13 * i));
        times.measure([&] {
            viewer.orbit_a_little();
            viewer.frame();
        });
    }
    session.view.settle = false;
    print_wait("touched while refining: new preview", "<= 80 ms", times);
}

void measure_idling(Viewer& viewer) {
    constexpr double seconds = 5.0;
    const double start = seconds_now(), processor = processor_seconds();
    viewer.run_until([&] { return seconds_now() - start > seconds; });
    print_row("idle, once settled, every frame drawn", "",
              fmt::format("{:.1f} %", 100.0 * (processor_seconds() - processor) / (seconds_now() - start)),
              "a frame each second; the window leaves out those that would look alike");
}

/// Which rows are wanted; all where none are named.
struct Parts {
    std::vector<std::string> names;
    bool operator()(const char* name) const {
        return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
    }
};

void measure_viewport(Viewer& viewer, const Parts& wanted) {
    ViewState& view = viewer.session().view;
    if (wanted("settle")) measure_settling(viewer, "after the start");
    view.settle = false;
    viewer.orbit(warm_frames);
    if (wanted("orbit"))
        print_rate("orbit, 960x540", ">= 24 frames/s, never below 12", viewer.orbit(orbit_frames),
                   shown_of(viewer.session().status.view_frame));
    if (wanted("slider")) measure_sliders(viewer);
    if (wanted("level")) measure_levels(viewer);
    if (wanted("shape")) measure_shaping(viewer);
    if (wanted("scrub")) measure_scrubbing(viewer);
    if (wanted("blur")) measure_blurring(viewer);
    if (!wanted("settle")) return;
    viewer.orbit(1);
    measure_settling(viewer, "after looks and a camera");
    view.settle = false;
    viewer.orbit(1);
    measure_settling(viewer, "after another camera");
    measure_cancelling(viewer);
}

void measure_window(Viewer& viewer, const Parts& wanted) {
    viewer.session().view.settle = false;
    viewer.load();
    viewer.orbit(warm_frames);
    if (wanted("window"))
        print_rate("orbit, window of 1600x900 with panels", "", viewer.orbit(orbit_frames),
                   shown_of(viewer.session().status.view_frame));
    viewer.settle();
    Times redraw;
    for (int i = 0; i < samples; ++i) redraw.measure([&] { viewer.frame(); });
    if (wanted("window")) print_wait("the same drawn again, nothing changed", "", redraw);
    if (wanted("idle")) measure_idling(viewer);
}

void measure_session(const ViewerOptions& options, const GlInfo& gl, const Parts& wanted, double started,
                     double processor_started) {
    if (wanted("start") || wanted("orbit") || wanted("slider") || wanted("level") || wanted("shape") ||
        wanted("scrub") || wanted("blur") || wanted("settle")) {
        Viewer viewer(options, gl, 960, 540, false);
        measure_start(viewer, started, processor_started);
        if (wanted.names != std::vector<std::string>{"start"}) measure_viewport(viewer, wanted);
    }
    if (wanted("window") || wanted("idle")) {
        Viewer viewer(options, gl, 1600, 900, true);
        measure_window(viewer, wanted);
    }
}

/// As many splats as hold 24 frames a second while the scene is orbited.
std::int64_t fluid_splats(const ViewerOptions& options, const GlInfo& gl) {
    Viewer viewer(options, gl, 960, 540, false);
    viewer.session().view.settle = false;
    viewer.load();
    viewer.orbit(2 * orbit_frames);
    return viewer.session().status.view_frame.shown;
}

/// As sRGB, to be looked at.
void save_picture(const Image& image, const fs::path& file) {
    std::vector<unsigned char> rgba;
    for (std::int64_t y = 0; y < image.height; ++y)
        for (std::int64_t x = 0; x < image.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double light = std::clamp(double(image.at(x, y)[c]), 0.0, 1.0);
                rgba.push_back(static_cast<unsigned char>(std::lround(255.0 * real::linear_to_srgb(light))));
            }
            rgba.push_back(255);
        }
    write_image(file, image.width, image.height, rgba);
}

/// Moving views against the final frame (issue 18, 1), with `shown` splats, or where that is 0 with those of
/// 24 frames a second.
void measure_truths(const ViewerOptions& options, const GlInfo& gl, std::int64_t shown,
                    const fs::path& pictures) {
    if (shown == 0) shown = fluid_splats(options, gl);
    for (const test::NamedView& view : test::preview_views()) {
        const test::ViewTruth truth = test::measure_truth(view, shown, options.cache);
        if (!pictures.empty()) {
            save_picture(truth.preview, pictures / (std::string(view.name) + ", preview.png"));
            save_picture(truth.final, pictures / (std::string(view.name) + ", final.png"));
        }
        print_row(
            std::string("preview of a ") + view.name,
            view.is_edge ? "light 3 %, blocks 90 %, thickness 15 %" : "light 3 %, blocks 90 %",
            fmt::format("{:+.1f} %, {} of {} blocks{}", 100.0 * (truth.light - 1.0), truth.near,
                        truth.bright_blocks,
                        view.is_edge ? fmt::format(", {:+.0f} %", 100.0 * (truth.thickness - 1.0)) : ""),
            fmt::format("{} of {} thousand splats", truth.shown / 1000, truth.splats / 1000));
    }
}

/// Previews of a scene after each cause against its final frames.
void measure_causes(const ViewerOptions& options, std::int64_t shown, const fs::path& pictures) {
    for (const test::CausedView& seen :
         test::measure_causes(options.input, shown == 0 ? 60'000 : shown, options.cache)) {
        const std::string name = seen.view + ", " + test::cause_names[int(seen.cause)];
        if (!pictures.empty()) {
            save_picture(seen.truth.preview, pictures / (name + ".png"));
            save_picture(seen.truth.final,
                         pictures / (seen.view + (seen.cause == test::Cause::edit ? ", final edited.png"
                                                                                  : ", final.png")));
        }
        print_row("preview " + name, "light 3 %",
                  fmt::format("{:+.1f} %, {} of {} blocks", 100.0 * (seen.truth.light - 1.0), seen.truth.near,
                              seen.truth.bright_blocks),
                  fmt::format("{} thousand splats", seen.truth.shown / 1000));
    }
}

int run(int argc, char** argv) {
    const double started = seconds_now(), processor_started = processor_seconds();
    ViewerOptions options;
    Parts wanted;
    std::int64_t shown = 0;
    std::string pictures, cache = default_cache_folder().string();
    CLI::App app("Measures the viewer: the table of issue 4.");
    app.add_option("scene", options.input, "default: the demo");
    app.add_option("--cache", cache, "folder of generated sets");
    app.add_option("--only", wanted.names,
                   "some of: start orbit slider level shape scrub blur settle window idle truth causes");
    app.add_option("--pictures", pictures, "folder for the frames of truth");
    app.add_option("--shown", shown, "of the previews of truth; default: those that hold 24 frames a second");
    CLI11_PARSE(app, argc, argv);
    options.cache.folder = cache;
    const TempFolder home;  // no preferences or autosaves of whoever measures
    setenv("XDG_CONFIG_HOME", home.path().c_str(), 1);
    setenv("XDG_STATE_HOME", home.path().c_str(), 1);
    const OffscreenContext context;
    fmt::print("{}, {} threads\n\n", context.info().renderer, thread_count());
    print_head();
    measure_session(options, context.info(), wanted, started, processor_started);
    if (wanted("truth")) measure_truths(options, context.info(), shown, pictures);
    if (wanted("causes")) measure_causes(options, shown, pictures);
    return 0;
}

}  // namespace
}  // namespace astrosplat::bench

int main(int argc, char** argv) {
    try {
        astrosplat::keep_little_freed_memory();  // as the window does
        return astrosplat::bench::run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "viewer_bench: {}\n", error.what());
        return 1;
    }
}

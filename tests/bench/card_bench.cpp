// The renderer on a graphics card: its times, pass by pass, and whether its frames have the processor's bits.
// Prints the rows of README.md here. card_bench [CASE...]: those whose name holds one of the words; --times:
// without comparing.
#include <fmt/format.h>

#include "core/parallel.h"
#include "core/shared_maths.h"
#include "gl/card.h"
#include "inputs.h"
#include "pipeline.h"
#include "render/render.h"
#include "scene/load.h"

namespace astrosplat {
namespace {

struct Case {
    const char* name;
    std::int64_t count;
    float diameter_px, alpha;
    std::int64_t width, height;
    Blend blend;
    float share = 1.0f;   // of the frame's sides, in which nine of ten lie
    float lod_px = 0.0f;  // level of detail
};

template <class T>
T median(std::vector<T> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

void measure(const Case& c, Card& card, bool compares, const std::vector<int>& slabs) {
    ShadedSplats set = bench::spread(c.count, c.diameter_px * 1920.0f / float(c.width), c.alpha, c.share);
    static std::uint64_t stamps = 1'000'000;
    set.stamp = ++stamps;
    RenderLayer layer;
    layer.name = "bench";
    layer.splats = &set;
    layer.render.blend = c.blend;
    layer.render.lod = {c.lod_px, 64};
    Camera camera;
    camera.focal_px = 1000.0 * double(c.width) / 1920.0;
    camera.center_x_px = 0.5 * double(c.width);
    camera.center_y_px = 0.5 * double(c.height);
    RenderSettings settings;
    settings.width = c.width;
    settings.height = c.height;
    settings.device = &card;
    RenderCache cache;
    RenderedFrame frame;
    for (const int k : slabs) {
        card.set_slabs(k);
        std::vector<double> whole, passes;
        std::vector<std::vector<double>> of_pass;
        std::vector<Card::PassTime> times;
        for (int i = 0; i < 7; ++i) {
            frame = render({&layer, 1}, camera, nullptr, settings, {}, &cache);
            if (!frame.statistics.not_on_device.empty()) {
                fmt::print("| {} | not drawn: {} |\n", c.name, frame.statistics.not_on_device);
                return;
            }
            if (i < 2) continue;
            times = card.pass_times();
            of_pass.resize(times.size());
            double sum = 0.0;
            for (std::size_t p = 0; p < times.size(); ++p)
                sum += times[p].milliseconds, of_pass[p].push_back(times[p].milliseconds);
            passes.push_back(sum);
            whole.push_back(1e3 * frame.statistics.seconds);
            if (whole.back() > 1000.0 && i > 3) break;
        }
        fmt::print("| {} | slabs {} | card {:.2f} ms | with reading back {:.1f} ms |", c.name, k,
                   median(passes), median(whole));
        for (std::size_t p = 0; p < times.size(); ++p)
            fmt::print(" {} {:.2f} |", times[p].name, median(of_pass[p]));
        fmt::print(" {:.2f} GB{}{} |\n", 1e-9 * double(card.bytes()),
                   card.share().apart ? ", slab by slab" : "",
                   card.share().bands > 1 ? fmt::format(", {} bands", card.share().bands) : "");
        std::fflush(stdout);
    }
    card.set_slabs(0);
    if (!compares) return;
    settings.device = nullptr;
    const RenderedFrame warm = render({&layer, 1}, camera, nullptr, settings, {}, &cache);
    const RenderedFrame here = render({&layer, 1}, camera, nullptr, settings, {}, &cache);
    std::size_t differ = 0;
    for (std::size_t i = 0; i < here.beauty.pixels.size(); ++i)
        differ += std::memcmp(&here.beauty.pixels[i], &frame.beauty.pixels[i], 4) != 0;
    fmt::print("  {}: {} of {} values differ; {} threads {:.0f} ms\n", c.name, differ,
               here.beauty.pixels.size(), thread_count(), 1e3 * here.statistics.seconds);
    std::fflush(stdout);
}

/// A look with four octaves of noise that is dragged: from a changed number to the frame.
void measure_look(Card& card) {
    const auto set = std::make_shared<const SplatSet>(bench::random_set(10'000'000));
    Scene scene = parse_scene(R"(astrosplat = 1
[output]
resolution = [1920, 1080]
[camera]
position = [0.0, 3.0, 14.0]
target = [0.0, 0.0, 0.0]
[[layer]]
name = "bench"
source = { kind = "splats", file = "bench.splats" }
[layer.look]
noise = [ { frequency = 0.7, octaves = 4, cull = 0.5, brightness = 0.4 } ]
alpha = { power = 1.1 }
radius = { min = 0.005, max = 0.015 }
)",
                              "/bench.toml");
    Pipeline there, here;
    const auto drag = [&](Pipeline& pipeline, RenderDevice* device, int step) {
        const auto start = Clock::now();
        scene.layers[0].look.alpha.power = 1.1f + 0.1f * float(step);
        pipeline.set_scene(scene, {set});
        const FrameScene now = pipeline.frame_scene(1.0);
        RenderSettings settings = render_settings(now.scene.output);
        settings.device = device;
        RenderedFrame frame = pipeline.frame(now, settings);
        return std::pair(std::move(frame), 1e3 * seconds_since(start));
    };
    std::vector<double> times;
    for (int step = 0; step < 9; ++step) times.push_back(drag(there, &card, step).second);
    times.erase(times.begin(), times.begin() + 2);
    const RenderedFrame frame = drag(there, &card, 9).first;
    drag(here, nullptr, 7);
    const auto [expected, milliseconds] = drag(here, nullptr, 9);
    std::size_t differ = 0;
    for (std::size_t i = 0; i < expected.beauty.pixels.size(); ++i)
        differ += std::memcmp(&expected.beauty.pixels[i], &frame.beauty.pixels[i], 4) != 0;
    fmt::print(
        "| a look dragged on 10 M, four octaves | drawn by '{}' | {:.1f} ms, read back | {} of {} values "
        "differ; "
        "{} threads {:.0f} ms |\n",
        frame.statistics.device, median(times), differ, expected.beauty.pixels.size(), thread_count(),
        milliseconds);
    std::fflush(stdout);
}

int run(const std::vector<std::string>& words) {
    const Case cases[] = {
        {"10 M 5 px over 1080p", 10'000'000, 5.0f, 0.3f, 1920, 1080, Blend::over},
        {"2.6 M 26 px over 1080p", 2'600'000, 26.0f, 0.3f, 1920, 1080, Blend::over},
        {"44 M 3 px screen 1080p", 44'000'000, 3.0f, 0.05f, 1920, 1080, Blend::screen},
        {"44 M 3 px screen 2160p", 44'000'000, 3.0f, 0.05f, 3840, 2160, Blend::screen},
        {"10 M 5 px over clustered", 10'000'000, 5.0f, 0.3f, 1920, 1080, Blend::over, 0.2236f},
        {"10 M 5 px over faint clustered", 10'000'000, 5.0f, 0.005f, 1920, 1080, Blend::over, 0.2236f},
        {"1 M 3 px faint one tile", 1'000'000, 3.0f, 0.0001f, 1920, 1080, Blend::over, 0.005f},
        {"2.6 M 26 px hybrid 1080p", 2'600'000, 26.0f, 0.3f, 1920, 1080, Blend::hybrid},
        {"1.2 M by level of detail 20 M", 1'200'000, 10.0f, 0.3f, 1920, 1080, Blend::over, 1.0f, 8.0f}};
    const auto start = Clock::now();
    OffscreenContext context;
    const GlInfo& info = context.info();
    const CardProbe probe = probe_card(info);
    Card card(info, probe.native_division);
    fmt::print("{}; OpenGL {}.{}; probe {:.2f} s, own division {}, fault '{}'; all {:.2f} s\n", info.renderer,
               info.major, info.minor, probe.seconds, probe.native_division, probe.fault,
               seconds_since(start));
    const bool compares = std::ranges::find(words, "--times") == words.end();
    for (const std::string& word : words)  // --room=1.5 GB of the card's memory
        if (word.starts_with("--room=")) card.set_room(std::int64_t(1e9 * std::stod(word.substr(7))));
    if (words.empty() || std::ranges::find(words, "look") != words.end()) measure_look(card);
    for (const Case& c : cases) {
        const auto asked = [&](const std::string& word) {
            return std::string(c.name).find(word) != std::string::npos;
        };
        const bool all =
            std::ranges::all_of(words, [](const std::string& word) { return word.starts_with("--"); });
        if (!all && std::ranges::none_of(words, asked)) continue;
        measure(c, card, compares, c.count > 20'000'000 ? std::vector{6, 8, 12} : std::vector{1, 4});
    }
    return 0;
}

}  // namespace
}  // namespace astrosplat

int main(int argc, char** argv) {
    try {
        return astrosplat::run({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}

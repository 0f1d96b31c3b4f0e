#include "device.h"

#include <fmt/format.h>
#include <sys/xattr.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/shared_maths.h"
#include "core/text.h"
#include "exit.h"
#include "render/render.h"
#ifdef ASTROSPLAT_WINDOW
#include "gl/card.h"
#endif

namespace astrosplat {

DeviceChoice parse_device(const std::string& text) {
    if (text == "auto") return DeviceChoice::automatic;
    if (text == "cpu") return DeviceChoice::cpu;
    if (text != "gpu") bad_input("--device", "", "gpu, cpu or auto", "'" + text + "'");
    return DeviceChoice::gpu;
}

#ifdef ASTROSPLAT_WINDOW

struct FrameDevice::State {
    std::unique_ptr<OwnCard> card;
};

FrameDevice::FrameDevice(const CommandOptions& options) : choice_(options.device) {
    if (options.memory_gib && choice_ == DeviceChoice::automatic) {
        log_detail("frames are drawn by the processor: what a card's driver takes, --memory cannot bound");
        choice_ = DeviceChoice::cpu;
    }
    try {
        state_ = std::make_unique<State>(State{open_card({choice_, options.cache.folder})});
    } catch (const std::runtime_error& error) {
        throw InputError(std::string("--device gpu: ") + error.what());
    }
}

RenderDevice* FrameDevice::get() const { return state_->card ? &state_->card->card() : nullptr; }

#else

struct FrameDevice::State {};

FrameDevice::FrameDevice(const CommandOptions& options) : choice_(options.device) {
    if (choice_ == DeviceChoice::gpu)
        throw InputError("--device gpu: this astrosplat was built without OpenGL");
}

RenderDevice* FrameDevice::get() const { return nullptr; }

#endif

FrameDevice::~FrameDevice() = default;

std::string FrameDevice::name() const { return get() ? get()->name() : "the processor"; }

void FrameDevice::check(const RenderStatistics& statistics) {
    const std::string& why = statistics.not_on_device;
    if (why.empty() || why == said_) return;
    const std::string what = fmt::format("{}: {}", name(), why);
    if (choice_ == DeviceChoice::gpu)
        throw InputError("--device gpu: " + what + "; --device auto leaves such frames to the processor");
    log_info("drawn by the processor, for " + what);
    said_ = why;
}

namespace {

constexpr const char* device_attribute = "user.astrosplat.device";

}  // namespace

void note_device(const fs::path& frame, const std::string& device) {
    static_cast<void>(setxattr(frame.c_str(), device_attribute, device.data(), device.size(), 0));
}

std::string noted_device(const fs::path& frame) {
    char device[256];
    const ssize_t size = getxattr(frame.c_str(), device_attribute, device, sizeof device);
    return size > 0 ? std::string(device, std::size_t(size)) : std::string();
}

// device: what was found, and how fast it is.

namespace {

/// As tests/bench: splats spread over the frame, 5 px wide.
ShadedSplats spread_splats(std::uint32_t count) {
    ShadedSplats splats;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto random = [&](std::uint32_t purpose) {
            return shared::as_uniform(shared::as_hash(1u, i, 0u, purpose));
        };
        const float z = 10.0f + 10.0f * random(3);
        splats.position.push_back({(random(1) - 0.5f) * 1.92f * z, (random(2) - 0.5f) * 1.08f * z, -z});
        splats.radius.push_back(0.0025f * z);
        splats.alpha.push_back(0.3f * (0.5f + random(4)));
        splats.color.push_back({random(5), random(6), random(7)});
        splats.id.push_back(i);
    }
    splats.stamp = ~std::uint64_t{0};
    return splats;
}

/// The better of three, seconds.
double frame_seconds(const ShadedSplats& splats, RenderDevice* device, RenderedFrame& frame) {
    RenderLayer layer;
    layer.splats = &splats;
    Camera camera;
    camera.focal_px = 1000.0;
    camera.center_x_px = 960.0;
    camera.center_y_px = 540.0;
    RenderSettings settings;
    settings.device = device;
    RenderCache cache;
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        frame = render({&layer, 1}, camera, nullptr, settings, {}, &cache);
        best = std::min(best, frame.statistics.seconds);
        if (best > 1.0) break;  // by a driver that draws by the processor
    }
    return best;
}

int run_device(const CommandOptions& options) {
    CommandOptions asked = options;
    Report report;
    std::unique_ptr<FrameDevice> device;
    try {
        device = std::make_unique<FrameDevice>(asked);
    } catch (const InputError& error) {
        report["problem"] = error.what();
    }
    report["draws"] = device ? device->name() : "the processor";
    RenderDevice* const card = device ? device->get() : nullptr;
    if (card && card->free_bytes() > 0) report["free_gib"] = std::ldexp(double(card->free_bytes()), -30);
    report["threads"] = thread_count();
    report["instructions"] = vector_target();
    const ShadedSplats splats = spread_splats(1'000'000);
    RenderedFrame here, there;
    report["processor_ms"] = 1e3 * frame_seconds(splats, nullptr, here);
    if (card) {
        report["card_ms"] = 1e3 * frame_seconds(splats, card, there);
        report["same_bits"] = there.beauty.pixels == here.beauty.pixels;
    }
    print_report(report, options.json);
    return exit_done;
}

}  // namespace

void add_device_option(CLI::App& app, CommandOptions& options) {
    app.add_option_function<std::string>(
           "--device", [&options](const std::string& text) { options.device = parse_device(text); },
           "What draws: a graphics card that has the processor's bits, the processor, or a card where there "
           "is one "
           "(default: auto)")
        ->option_text("gpu|cpu|auto");
}

void add_device(CLI::App& app, Invocation& call) {
    CLI::App& device =
        add_command(app, call, "device", "Shows what draws frames on this machine, and how fast", run_device);
    add_device_option(device, call.options);
    add_json(device, call.options);
}

}  // namespace astrosplat

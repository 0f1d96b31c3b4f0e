// What is asked of a card before it may draw. A driver's update may change its arithmetic, so what was found
// is remembered with the driver's version.
#include <fmt/format.h>

#include <cstring>

#include "core/atomic_file.h"
#include "core/file.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/shared_maths.h"
#include "gl/card.h"
#include "render/render.h"

namespace astrosplat {
namespace {

constexpr GLuint inputs = 100'000;

struct ProbeInput {
    float a, b, c, unused;
};

/// Any normal numbers within the exponents that a frame's have, ties and ends among them; c from -80 to 80.
std::vector<ProbeInput> probe_inputs() {
    const auto bits = [](std::uint32_t i, std::uint32_t purpose) {
        return shared::as_hash(7u, i, 0u, purpose);
    };
    const auto number = [&](std::uint32_t i, std::uint32_t purpose) {
        const std::uint32_t exponent = 87 + bits(i, purpose + 1) % 80;  // 2^-40 to 2^39
        std::uint32_t mantissa = bits(i, purpose);
        if (i % 16 == purpose % 16) mantissa &= 0xff800fffu;  // few digits: ties
        if (i % 64 == purpose % 64) mantissa |= 0x007fffffu;
        return std::bit_cast<float>((mantissa & 0x807fffffu) | exponent << 23);
    };
    std::vector<ProbeInput> all;
    for (std::uint32_t i = 0; i < inputs; ++i)
        all.push_back({number(i, 1), number(i, 3), 160.0f * shared::as_uniform(bits(i, 5)) - 80.0f, 0.0f});
    return all;
}

/// The same in C++ as card_probe.glsl.
float expected(int operation, const ProbeInput& in) {
    const float a = in.a, b = in.b, c = in.c;
    switch (operation) {
        case 0:
            return a / b;
        case 1:
            return std::sqrt(std::fabs(a));
        case 2:
            return a * b + c;
        case 3:
            return shared::as_exp(c);
        case 4:
            return shared::as_log(std::fabs(a));
        case 5:
            return float(((double(a) * double(b) + double(b) * double(c)) + double(a) * double(c)) +
                         double(c));
        case 6: {
            const float near_whole = (c - 0.5f) + 12582912.0f;
            return (c - (near_whole - 12582912.0f)) * std::floor(c * 256.0f + 0.5f);
        }
        default:
            return a * 1.0e-30f + b * 1.0e-30f;
    }
}

constexpr const char* operations[] = {"division",          "square root",     "multiplication and addition",
                                      "exponential",       "logarithm",       "doubles",
                                      "rounding to whole", "denormal numbers"};

/// How many results of an operation differ.
std::int64_t differing(int operation, bool native_division, const std::vector<ProbeInput>& in) {
    ProgramSource source =
        card_source("card_probe.glsl", fmt::format("OPERATION {}", operation), native_division);
    const GlProgram program(source);
    CardBuffer counts, from, to;
    if (!counts.reserve(8192) || !from.fill(in.data(), std::ssize(in) * std::int64_t(sizeof in[0])) ||
        !to.reserve(4 * std::ssize(in)))
        return std::ssize(in);
    counts.bind(0);
    from.bind(1);
    to.bind(2);
    program.use();
    Uniforms{program.name()}("count", static_cast<GLuint>(in.size()));
    glDispatchCompute((inputs + 255) / 256, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<float> results(in.size());
    glGetNamedBufferSubData(to.name(), 0, static_cast<GLsizeiptr>(4 * results.size()), results.data());
    const DenormalsAreZero as_on_cards;
    std::int64_t differ = 0;
    for (std::size_t i = 0; i < in.size(); ++i) {
        const float here = expected(operation, in[i]);
        if (std::memcmp(&here, &results[i], sizeof here) == 0) continue;
        if (differ++ < 8)
            log_detail(fmt::format("{} of {:a}, {:a}, {:a}: the card has {:a}, the processor {:a}",
                                   operations[operation], in[i].a, in[i].b, in[i].c, results[i], here));
    }
    return differ;
}

/// 20,000 splats, half of them at places that eight share.
ShadedSplats probe_splats() {
    ShadedSplats splats;
    for (std::uint32_t i = 0; i < 20'000; ++i) {
        const auto random = [&](std::uint32_t purpose) {
            return shared::as_uniform(shared::as_hash(11u, i % 2 == 0 ? i : i / 16, 0u, purpose));
        };
        const float z = 10.0f + 10.0f * random(3);
        splats.position.push_back({(random(1) - 0.5f) * 1.92f * z, (random(2) - 0.5f) * 1.08f * z, -z});
        splats.radius.push_back(z * (0.001f + 0.02f * random(4) * random(4) * random(4)));
        splats.alpha.push_back(0.3f * (0.5f + random(5)));
        splats.color.push_back({random(6), random(7), random(8)});
        splats.id.push_back(i);
    }
    return splats;
}

/// Empty, or what differs from the processor's frame.
std::string scene_fault(Card& card) {
    const ShadedSplats splats = probe_splats();
    Camera camera;
    camera.focal_px = 320.0 / 1.92;
    camera.center_x_px = 160.0;
    camera.center_y_px = 90.0;
    for (const Blend blend : {Blend::over, Blend::screen}) {
        RenderLayer layer;
        layer.splats = &splats;
        layer.render.blend = blend;
        RenderSettings settings;
        settings.width = 320;
        settings.height = 180;
        const RenderedFrame here = render({&layer, 1}, camera, nullptr, settings);
        settings.device = &card;
        const RenderedFrame there = render({&layer, 1}, camera, nullptr, settings);
        if (there.statistics.device.empty()) return "it does not draw: " + there.statistics.not_on_device;
        if (std::memcmp(here.beauty.pixels.data(), there.beauty.pixels.data(),
                        4 * here.beauty.pixels.size()) != 0)
            return "a frame of 20,000 splats has other bits";
    }
    return {};
}

/// The card, its driver and this program, in one line.
std::string identity(const GlInfo& info) {
    const auto* version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    std::size_t texts = 0;
    for (const char* file : {"card_exact.glsl", "card_project.glsl", "card_fold.glsl", "maths.glsl"})
        texts = texts * 31 + std::hash<std::string>()(shader_text(file));
    constexpr int probe_version = 1;  // raised when other things are asked
    return fmt::format("{} | {} | {:x} | {}", info.renderer, version ? version : "", texts, probe_version);
}

fs::path probe_file(const fs::path& kept) { return kept.empty() ? kept : kept / "card.txt"; }

/// Without one of these a driver could only draw by the processor: nothing is loaded to find that out.
bool has_card() {
    std::error_code ignored;
    for (const char* device : {"/dev/nvidiactl", "/dev/nvidia0", "/dev/dxg"})
        if (fs::exists(device, ignored)) return true;
    for (const auto& entry : fs::directory_iterator("/dev/dri", ignored))
        if (entry.path().filename().string().starts_with("renderD")) return true;
    return false;
}

std::optional<CardProbe> remembered(const fs::path& kept, const std::string& identity) try {
    if (kept.empty() || !fs::exists(kept)) return {};
    std::istringstream lines(read_file(kept));
    CardProbe probe;
    std::string whose, division;
    std::getline(lines, whose);
    std::getline(lines, division);
    std::getline(lines, probe.fault);
    if (whose != identity || (division != "own" && division != "corrected")) return {};
    probe.native_division = division == "own";
    return probe;
} catch (const std::exception&) {  // it is made anew
    return {};
}

void remember(const fs::path& kept, const std::string& identity, const CardProbe& probe) try {
    if (kept.empty()) return;
    fs::create_directories(kept.parent_path());
    write_file_atomically(kept, fmt::format("{}\n{}\n{}\n", identity,
                                            probe.native_division ? "own" : "corrected", probe.fault));
} catch (const std::exception&) {  // the next run asks again
}

}  // namespace

CardProbe probe_card(const GlInfo& info) {
    const auto start = Clock::now();
    const std::vector<ProbeInput> in = probe_inputs();
    CardProbe probe;
    probe.native_division = differing(0, true, in) + differing(1, true, in) == 0;
    for (int operation = 0; operation < int(std::size(operations)) && probe.fault.empty(); ++operation)
        if (const std::int64_t count = differing(operation, probe.native_division, in); count > 0)
            probe.fault =
                fmt::format("{}: {} of {} results have other bits", operations[operation], count, inputs);
    if (probe.fault.empty()) {
        Card card(info, probe.native_division);
        probe.fault = scene_fault(card);
    }
    probe.seconds = seconds_since(start);
    return probe;
}

CardProbe known_probe(const GlInfo& info, const fs::path& kept) {
    static std::mutex mutex;
    static std::map<std::string, CardProbe> of_this_run;
    static_cast<void>(Card(info, true));  // throws where it cannot compute
    const std::string who = identity(info);
    const fs::path file = probe_file(kept);
    const std::lock_guard lock(mutex);
    if (const auto found = of_this_run.find(who); found != of_this_run.end()) return found->second;
    const std::optional<CardProbe> known = remembered(file, who);
    const CardProbe probe = known ? *known : probe_card(info);
    if (!known) remember(file, who, probe);
    return of_this_run[who] = probe;
}

std::unique_ptr<Card> exact_card(const GlInfo& info, const CardProbe& probe) {
    if (!probe.fault.empty())
        throw NoContext(info.renderer + " does not compute as the processor does: " + probe.fault);
    return std::make_unique<Card>(info, probe.native_division);
}

OwnCard::OwnCard(const fs::path& kept, bool software) {
    const GlInfo& info = context_.info();
    if (info.software && !software) throw NoContext("no graphics card: " + info.renderer + " would draw");
    probe_ = known_probe(info, kept);
    card_ = exact_card(info, probe_);
}

std::unique_ptr<OwnCard> open_card(const CardChoice& choice) {
    const bool asked = choice.device == DeviceChoice::gpu;
    if (choice.device == DeviceChoice::cpu) return nullptr;
    try {
        if (!asked && !has_card()) throw NoContext("there is no graphics card");
        auto card = std::make_unique<OwnCard>(choice.kept, asked);
        log_detail("frames are drawn by " + card->card().name());
        return card;
    } catch (const std::runtime_error& error) {
        if (asked) throw;
        log_detail(std::string("frames are drawn by the processor: ") + error.what());
        return nullptr;
    }
}

}  // namespace astrosplat

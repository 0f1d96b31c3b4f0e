// Names for Highway's run-time targets. A choice enables that target and all lesser ones, so that a kernel
// compiled without it falls to the next below.
#include "core/vector_target.h"

#include <fmt/format.h>
#include <hwy/targets.h>

#include <array>
#include <cstdint>
#include <cstdlib>

#include "core/error.h"

namespace astrosplat {
namespace {

struct Target {
    const char* name;
    std::int64_t bits;  // Highway's; a lower bit is a better target
};

// Highway 1.0 has no SSE2 target of its own: its portable fallback, compiled for the baseline of
// x86-64, is that.
constexpr std::array<Target, 4> targets = {
    {{"avx512", HWY_AVX3}, {"avx2", HWY_AVX2}, {"sse4", HWY_SSE4}, {"sse2", HWY_EMU128 | HWY_SCALAR}}};

// The best that the processor can do, whatever was chosen before.
std::int64_t detected() {
    static const std::int64_t bits = hwy::SupportedTargets() | HWY_STATIC_TARGET;
    return bits;
}

bool compiled_and_supported(const Target& target) { return (target.bits & HWY_TARGETS & detected()) != 0; }

void enable(std::int64_t bits) {
    hwy::SetSupportedTargetsForTest(bits);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

void set_vector_target(const std::string& name) {
    const std::int64_t supported = detected();
    if (name == "best") return enable(supported);
    std::int64_t not_above = 0;
    for (auto target = targets.rbegin(); target != targets.rend(); ++target) {
        not_above |= target->bits & supported;
        if (name == target->name && compiled_and_supported(*target)) return enable(not_above);
    }
    bad_input("vector target", "",
              fmt::format("one that this processor has (best, {})", fmt::join(vector_targets(), ", ")),
              "'" + name + "'");
}

void use_vector_target_of_environment() {
    const char* name = std::getenv("ASTROSPLAT_VECTOR_TARGET");
    if (!name || !*name) return;
    try {
        set_vector_target(name);
    } catch (const InputError& error) {
        throw InputError(fmt::format("ASTROSPLAT_VECTOR_TARGET: {}", error.what()));
    }
}

std::vector<std::string> vector_targets() {
    std::vector<std::string> names;
    for (const Target& target : targets)
        if (compiled_and_supported(target)) names.emplace_back(target.name);
    return names;
}

std::string vector_target() {
    detected();
    const std::int64_t enabled = hwy::SupportedTargets();
    for (const Target& target : targets)
        if (target.bits & HWY_TARGETS & enabled) return target.name;
    return targets.back().name;
}

}  // namespace astrosplat

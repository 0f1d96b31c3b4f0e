#include "bodies/octaves.h"

#include <algorithm>

#include "core/real.h"
#include "core/shared_maths.h"

namespace astrosplat {
namespace {

constexpr double shortest_wave = 5.0;  // texels at a width of 1920
constexpr double clumpiness[8] = {3, 3, 2.6, 2.2, 1.7, 0.8, 0.3, 0.05};

}  // namespace

double by_feature(const double (&values)[8], double feature) {
    const double k = std::clamp(real::log(feature / 2.0) / real::log(2.0), 0.0, 6.0 + 0.644);
    const int i = std::min(6, static_cast<int>(k));
    const double t = i == 6 ? (k - 6.0) / 0.644 : k - i;  // the last is at 200, not at 256
    return values[i] * (1.0 - t) + values[i + 1] * t;
}

double clump_gain(const Placement& placement, double feature) {
    return 1.6 * by_feature(clumpiness, feature / placement.scale) * placement.clumps;
}

NoiseStack stack(const Placement& placement, double longest, double feature, double first_gain,
                 double ratio) {
    NoiseStack noise;
    noise.seed = placement.seed;
    const double shortest = std::max(2.2 * feature, shortest_wave * placement.scale);
    double gain = first_gain;
    for (double wave = longest; noise.count < NoiseStack::most; wave /= 2.0, gain *= ratio) {
        if (noise.count > 0 && wave < shortest) break;
        noise.frequency[noise.count] = static_cast<float>(1.0 / wave);
        noise.gain[noise.count++] = static_cast<float>(gain);
    }
    return noise;
}

NoiseStack waves(const Placement& placement, std::uint32_t field,
                 std::initializer_list<std::pair<double, double>> wave_and_gain) {
    NoiseStack noise;
    noise.seed = shared::as_mix(placement.seed + field);
    for (const auto& [wave, gain] : wave_and_gain) {
        noise.frequency[noise.count] = static_cast<float>(1.0 / (wave * placement.scale));
        noise.gain[noise.count++] = static_cast<float>(gain);
    }
    return noise;
}

}  // namespace astrosplat

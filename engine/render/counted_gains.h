// Gains of footprints whose pixels were counted one by one, for the next time: around a panorama's pole a
// splat touches the cells of whole rows, and would be counted for each. In: all that they depend on. Out: a
// place for them.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/shared_maths.h"

namespace astrosplat {

struct CountedGains {
    static constexpr std::size_t places = 4096, numbers = 15;
    using Key = std::array<float, numbers>;
    Key key{};
    bool known = false;
    float amplitude = 1.0f, edge_gain = 0.0f;

    /// That of a key, among those of this thread; unknown when it is new.
    static CountedGains& of(const Key& key) {
        static thread_local std::vector<CountedGains> all(places);
        std::uint32_t hash = 0;
        for (const float number : key) hash = shared::as_mix(hash ^ std::bit_cast<std::uint32_t>(number));
        CountedGains& gains = all[hash % places];
        if (gains.known && gains.key == key) return gains;
        gains = {key};
        return gains;
    }
};

}  // namespace astrosplat

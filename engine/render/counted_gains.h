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
#include "render/footprint.h"

namespace astrosplat {

struct CountedGains {
    static constexpr std::size_t places = 4096, numbers = 15;
    using Key = std::array<float, numbers>;
    /// `splat`: what the gains depend on beside the table and the lens.
    static Key key_of(const FootprintTable& table, const Lens& lens, const std::array<float, 6>& splat) {
        return {splat[0],
                splat[1],
                splat[2],
                splat[3],
                splat[4],
                splat[5],
                lens.focal_px,
                lens.center_x_px,
                lens.center_y_px,
                lens.edge,
                static_cast<float>(lens.projection),
                static_cast<float>(static_cast<int>(table.falloff.shape)),
                table.falloff.core,
                table.falloff.sharpness,
                table.pixel_filter_px};
    }
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

/// Sets a footprint's gains to those known of the key, or by find().
template <class Find>
void set_counted_gains(const CountedGains::Key& key, Footprint& f, const Find& find) {
    CountedGains& gains = CountedGains::of(key);
    if (!gains.known) {
        find();
        gains.amplitude = f.amplitude;
        gains.edge_gain = f.edge_gain;
        gains.known = true;
    }
    f.amplitude = gains.amplitude;
    f.edge_gain = gains.edge_gain;
}

}  // namespace astrosplat

// Gains of footprints whose pixels were counted one by one, for the next time: around a panorama's pole a
// splat touches the cells of whole rows, and would be counted for each. In: all that they depend on. Out: a
// place for them.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <unordered_map>
#include <utility>

#include "core/shared_maths.h"
#include "render/footprint.h"

namespace astrosplat {

/// Those of all threads together.
class CountedGains {
  public:
    using Key = std::array<float, 15>;
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
    /// Sets a footprint's gains to those known of the key, or by find(), which is a function of the key: a
    /// thread may find what another is about to know.
    template <class Find>
    static void set(const Key& key, Footprint& f, const Find& find) {
        Part& part = part_of(key);
        {
            const std::lock_guard lock(part.mutex);
            if (const auto known = part.gains.find(key); known != part.gains.end()) {
                f.amplitude = known->second.first;
                f.edge_gain = known->second.second;
                return;
            }
        }
        find();
        const std::lock_guard lock(part.mutex);
        if (part.gains.size() >= most_kept / parts) part.gains.clear();
        part.gains.emplace(key, std::pair{f.amplitude, f.edge_gain});
    }

  private:
    static constexpr std::size_t most_kept = 1 << 16, parts = 64;  // 8 MB; threads seldom meet

    static std::uint32_t hash_of(const Key& key) {
        std::uint32_t hash = 0;
        for (const float number : key) hash = shared::as_mix(hash ^ std::bit_cast<std::uint32_t>(number));
        return hash;
    }
    struct Hash {
        std::size_t operator()(const Key& key) const { return hash_of(key); }
    };
    struct Part {
        std::mutex mutex;
        std::unordered_map<Key, std::pair<float, float>, Hash> gains;
    };
    static Part& part_of(const Key& key) {
        static std::array<Part, parts> all;
        return all[hash_of(key) >> 26];
    }
};

}  // namespace astrosplat

// Which bins of a pyramid discs touch, against a plain count.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "render/bin_rects.h"

namespace astrosplat {
namespace {

constexpr float tile_px = 32.0f, x0_px = 100.0f, y0_px = -40.0f;

/// Bins of 32, 64, 128 and 256 px over 256 x 128 px.
std::vector<BinLevel> four_levels() { return {{0, 8, 7, 3}, {32, 4, 3, 1}, {40, 2, 1, 0}, {42, 1, 0, 0}}; }

struct Disc {
    float x_px, y_px, reach_px;
};

/// The rectangle that the header asks for, in the plainest way.
BinRect expected(const std::vector<BinLevel>& levels, const Disc& disc) {
    std::size_t l = 0;
    float bin_px = tile_px;
    while (disc.reach_px > bin_px && l + 1 < levels.size()) bin_px *= 2.0f, ++l;
    const auto bin = [&](float px, float last) {
        return static_cast<std::uint32_t>(std::clamp(std::floor(px / bin_px), 0.0f, last));
    };
    const BinLevel& level = levels[l];
    const float x = disc.x_px - x0_px, y = disc.y_px - y0_px;
    const std::uint32_t left = bin(x - disc.reach_px, level.last_column),
                        right = bin(x + disc.reach_px, level.last_column),
                        top = bin(y - disc.reach_px, level.last_row),
                        bottom = bin(y + disc.reach_px, level.last_row);
    return {level.first_bin + top * level.columns + left, level.columns, right - left + 1, bottom - top + 1};
}

std::vector<Disc> many_discs() {
    std::vector<Disc> discs;
    for (int i = 0; i < 1003; ++i) {  // no whole number of vectors
        const float reach_px = 0.5f * std::ldexp(1.0f, i % 11);
        discs.push_back({x0_px + static_cast<float>(i * 37 % 300) - 20.25f,
                         y0_px + static_cast<float>(i * 53 % 170) - 20.5f, reach_px});
    }
    discs.push_back({x0_px + 64.0f, y0_px + 64.0f, 32.0f});  // on the edges of bins
    discs.push_back({1e30f, -1e30f, 3.0f});
    discs.push_back({0.0f, 0.0f, 1e30f});
    return discs;
}

TEST(BinRects, AreThoseThatTheSquareTouchesOnTheLevelThatFits) {
    const std::vector<BinLevel> levels = four_levels();
    const std::vector<Disc> all = many_discs();
    Discs discs;
    discs.resize(all.size() + bin_rect_room);
    for (std::size_t i = 0; i < all.size(); ++i) discs.set(i, all[i].x_px, all[i].y_px, all[i].reach_px);
    for (std::size_t i = all.size(); i < all.size() + bin_rect_room; ++i) discs.set(i, NAN, NAN, NAN);
    for (const std::string& target : vector_targets()) {
        SCOPED_TRACE(target);
        set_vector_target(target);
        std::vector<BinRect> rects(all.size() + bin_rect_room);
        find_bins({x0_px, y0_px, tile_px, levels}, discs, all.size(), rects.data());
        for (std::size_t i = 0; i < all.size(); ++i) {
            const BinRect want = expected(levels, all[i]), &found = rects[i];
            ASSERT_EQ(found.first_bin, want.first_bin) << i;
            ASSERT_EQ(found.columns, want.columns) << i;
            ASSERT_EQ(found.wide, want.wide) << i;
            ASSERT_EQ(found.high, want.high) << i;
            ASSERT_LE(found.wide * found.high, most_bins) << i;
        }
    }
    set_vector_target("best");
}

}  // namespace
}  // namespace astrosplat

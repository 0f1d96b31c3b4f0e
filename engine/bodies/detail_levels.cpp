#include "bodies/detail_levels.h"

#include <fmt/format.h>

#include <algorithm>

namespace astrosplat {
namespace {

constexpr float fade_texels = 16.0f;  // DETAIL 4

std::vector<std::string> rows_of(const std::string& tiles) {
    std::vector<std::string> rows(1);
    for (const char c : tiles)
        if (c == ' ')
            rows.emplace_back();
        else
            rows.back() += c;
    return rows;
}

}  // namespace

std::string fault_of_tiles(const std::string& tiles) {
    if (tiles.empty()) return "";
    for (const std::string& row : rows_of(tiles)) {
        if (row.empty() || row.find_first_not_of("012") != std::string::npos)
            return fmt::format("expected rows of 0, 1 and 2 with a blank between, found '{}'", row);
        if (row.size() != rows_of(tiles).front().size())
            return fmt::format("expected rows of {} tiles as the first, found {} in '{}'",
                               rows_of(tiles).front().size(), row.size(), row);
    }
    return "";
}

DetailLevels::DetailLevels(const StructureParams& params, std::int64_t width, std::int64_t height)
    : width_(width), height_(height) {
    if (params.detail == 0) return;
    if (params.detail_tiles.empty()) {
        octaves_ = {std::uint8_t(params.detail)};
        beyond_ = params.detail;
    } else {
        const std::vector<std::string> rows = rows_of(params.detail_tiles);
        rows_ = std::ssize(rows);
        columns_ = std::ssize(rows.front());
        for (const std::string& row : rows)
            for (const char digit : row)
                octaves_.push_back(std::uint8_t(std::min(digit - '0', params.detail)));
        left_ = top_ = std::llround(double(width) * params.margin / (1.0 + 2.0 * params.margin));
        width_ -= 2 * left_;
        height_ -= 2 * top_;
        tiles_share_ = double(width_ * height_) / double(width * height);
    }
    most_ = std::ranges::max(octaves_);
}

int DetailLevels::of(const Tile& tile) const {
    const bool inside = tile.column >= 0 && tile.column < columns_ && tile.row >= 0 && tile.row < rows_;
    return inside ? octaves_[std::size_t(tile.row * columns_ + tile.column)] : beyond_;
}

DetailLevels::Tile DetailLevels::tile_at(float x, float y) const {
    const auto index = [](float at, std::int64_t begin, std::int64_t size, std::int64_t count) {
        const auto texel = std::int64_t(std::floor(at)) - begin;
        if (texel < 0) return std::int64_t{-1};
        return ((texel + 1) * count - 1) / size;  // the last that begins at or before it
    };
    return {index(x, left_, width_, columns_), index(y, top_, height_, rows_)};
}

int DetailLevels::at(float x, float y) const { return most_ > 0 ? of(tile_at(x, y)) : 0; }

float DetailLevels::share(float x, float y, int octave) const {
    if (columns_ == 1 && rows_ == 1) return 1.0f;
    const Tile here = tile_at(x, y);
    float nearest = fade_texels;
    for (std::int64_t row = here.row - 1; row <= here.row + 1; ++row)
        for (std::int64_t column = here.column - 1; column <= here.column + 1; ++column) {
            const bool beyond = column < 0 || column >= columns_ || row < 0 || row >= rows_;
            if ((beyond && left_ == 0) || of({column, row}) >= octave) continue;  // the picture ends there
            const float dx = std::max({0.0f, float(left_of(column)) - x, x - float(left_of(column + 1))}),
                        dy = std::max({0.0f, float(top_of(row)) - y, y - float(top_of(row + 1))});
            nearest = std::min(nearest, std::sqrt(dx * dx + dy * dy));
        }
    return nearest / fade_texels;
}

Region DetailLevels::bounds(const Region& region, int octaves) const {
    if (beyond_ == octaves) return region;  // all of the picture
    std::int64_t left = region.x + region.width, top = region.y + region.height, right = region.x,
                 below = region.y;
    for (std::int64_t row = 0; row < rows_; ++row)
        for (std::int64_t column = 0; column < columns_ && most_ > 0; ++column) {
            if (of({column, row}) != octaves) continue;
            const std::int64_t l = std::max(region.x, left_of(column)), t = std::max(region.y, top_of(row)),
                               r = std::min(region.x + region.width, left_of(column + 1)),
                               b = std::min(region.y + region.height, top_of(row + 1));
            if (l >= r || t >= b) continue;
            left = std::min(left, l), top = std::min(top, t);
            right = std::max(right, r), below = std::max(below, b);
        }
    if (left >= right) return {};
    return {left, top, right - left, below - top};
}

double DetailLevels::area_share(int octaves) const {
    if (octaves_.empty()) return 0.0;
    return tiles_share_ * double(std::ranges::count(octaves_, std::uint8_t(octaves))) /
           double(octaves_.size());
}

}  // namespace astrosplat

// Where a picture has invented detail, and how much (DETAIL 4): tiles of its own, with so many octaves each.
// In: the layer's keys and the picture's size. Out: octaves at a place, and the parts that have them.
#pragma once

#include "core/image.h"
#include "source/source.h"

namespace astrosplat {

class DetailLevels {
  public:
    /// None anywhere.
    DetailLevels() = default;

    /// For a picture of width x height texels, structure.margin among them. Without detail_tiles all of it
    /// has structure.detail octaves; with them what lies within the margin has as many as its tile says, at
    /// most that.
    DetailLevels(const StructureParams& params, std::int64_t width, std::int64_t height);

    bool any() const { return most_ > 0; }

    /// Octaves at a place, texels from the top left corner.
    int at(float x, float y) const;

    /// How much of such an octave counts at a place that has it, 0..1: it fades over 16 texels towards those
    /// that have fewer.
    float share(float x, float y, int octave) const;

    /// The smallest part of `region` outside of which no place of it has exactly so many octaves.
    Region bounds(const Region& region, int octaves) const;

    /// The share of the picture that has exactly so many.
    double area_share(int octaves) const;

  private:
    struct Tile {
        std::int64_t column, row;
    };
    std::int64_t left_of(std::int64_t column) const { return left_ + column * width_ / columns_; }
    std::int64_t top_of(std::int64_t row) const { return top_ + row * height_ / rows_; }
    int of(const Tile& tile) const;
    Tile tile_at(float x, float y) const;

    std::int64_t left_ = 0, top_ = 0, width_ = 1, height_ = 1;  // texels, of all tiles together
    std::int64_t columns_ = 1, rows_ = 1;
    std::vector<std::uint8_t> octaves_;  // row by row; empty: none
    int most_ = 0;
    int beyond_ = 0;            // the tiles
    double tiles_share_ = 1.0;  // of the picture's area
};

/// What is wrong with a value of structure.detail_tiles, as "expected .., found .."; empty: nothing.
std::string fault_of_tiles(const std::string& tiles);

}  // namespace astrosplat

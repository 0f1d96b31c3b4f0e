#include "bodies/detail_parts.h"

#include "bodies/detail_picture.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

constexpr std::int64_t block_texels = 512;  // a side, that are made at once
constexpr std::int64_t shown_about = 8;     // texels about a part that its fit sees (DETAIL 4)
constexpr double finest_blur_px = 1.2;      // of detail pixels, as of texels (picture_light.cpp)

// A region with so many texels more on each side that the picture has, from and to multiples of eight: all
// that is halved on the way begins there, too.
Region widened(const Region& region, std::int64_t by, const Image& picture) {
    const auto begin = [&](std::int64_t at) { return std::max<std::int64_t>(0, (at - by) / 8 * 8); };
    const auto end = [&](std::int64_t at, std::int64_t size) {
        return std::min(size, (at + by + 7) / 8 * 8);
    };
    const std::int64_t x = begin(region.x), y = begin(region.y);
    return {x, y, end(region.x + region.width, picture.width) - x,
            end(region.y + region.height, picture.height) - y};
}

// 1, else 0: of a star nothing is copied.
Image where_no_star_was(const Image& rest, const Image& light) {
    constexpr float of_star = 0.01f;  // of the light, at which a texel was a star's
    Image sources = unfilled_image(rest.width, rest.height, 1);
    for_each_pixel(rest, [&](std::int64_t x, std::int64_t y) {
        const float *const left = rest.at(x, y), *const all = light.at(x, y);
        const auto is_whole = [&](int c) { return all[c] - left[c] <= of_star * all[c]; };
        *sources.at(x, y) = is_whole(0) && is_whole(1) && is_whole(2) ? 1.0f : 0.0f;
    });
    return sources;
}

// The detail of a part, of what is coarser than it and less than it.
Image detail_of(const DetailPart& part, const Image& light, const Image& sources, const DetailWish& like,
                const Progress& progress) {
    const Region about = widened(part.region, detail_reach_px, light);
    DetailWish wish = like;
    wish.octaves = part.octaves;
    wish.x = about.x;
    wish.y = about.y;
    const int times = 1 << part.octaves;
    const Image all = detail_picture(part_of(light, about), part_of(sources, about), wish, progress);
    return part_of(all, {times * (part.shown.x - about.x), times * (part.shown.y - about.y),
                         times * part.shown.width, times * part.shown.height});
}

// What a part's light has more than the coarser bands, which stay as they are.
Image beyond_coarser(const DetailPart& part, const Image& light, const Image& finest) {
    Image coarser = part_of(light, part.shown);
    const Image band = part_of(finest, part.shown);
    for (std::size_t i = 0; i < coarser.pixels.size(); ++i) coarser.pixels[i] -= band.pixels[i];
    coarser = octaves_larger(std::move(coarser), part.octaves);
    parallel_each(coarser.pixels.size(), 1 << 16, [&](std::size_t i) {
        coarser.pixels[i] = std::max(0.0f, part.light.pixels[i] - std::max(0.0f, coarser.pixels[i]));
    });
    return coarser;
}

// Blurs of detail pixels; the last takes the rest.
std::vector<Band> bands_of(int octaves) {
    std::vector<Band> bands;
    for (int i = 0; i <= octaves; ++i)
        bands.push_back({i, finest_blur_px * (1 << i), finest_blur_px * (1 << i) * 5.0 / 3.0});
    return bands;
}

}  // namespace

std::vector<DetailPart> add_detail(const Image& with_stars, const Image& light, const Image& finest,
                                   const Image& alpha, const StructureParams& params,
                                   const Placement& placement, const Opacity& opacity,
                                   const Progress& progress, PictureSplats& out) {
    const DetailLevels& levels = placement.detail;
    const Image sources = where_no_star_was(light, with_stars);
    std::vector<DetailPart> parts;
    for (std::int64_t y = 0; y < light.height; y += block_texels)
        for (std::int64_t x = 0; x < light.width; x += block_texels)
            for (const int octaves : {1, 2}) {
                const Region block{x, y, std::min(block_texels, light.width - x),
                                   std::min(block_texels, light.height - y)};
                const Region region = levels.bounds(block, octaves);
                if (region.width > 0)
                    parts.push_back({octaves, region, widened(region, shown_about, light), {}, {}, {}});
            }
    DetailWish wish;
    wish.strength = params.detail_strength;
    wish.seed = placement.seed;
    wish.slope = detail_slope(light);
    wish.share = [&](float px, float py, int octave) { return levels.share(px, py, octave); };
    for (std::size_t i = 0; i < parts.size(); ++i) {
        DetailPart& part = parts[i];
        const double done = double(i) / double(parts.size()), next = double(i + 1) / double(parts.size());
        part.light = detail_of(part, light, sources, wish, progress.part(done, next));
        part.stars = part_of(with_stars, part.shown);
        const Image without = part_of(light, part.shown);
        for (std::size_t k = 0; k < without.pixels.size(); ++k) part.stars.pixels[k] -= without.pixels[k];
        split_bands(
            beyond_coarser(part, light, finest), bands_of(part.octaves), false,
            [&](const Band& band, const Image& of_band) {
                for (const BandSplats& size : detail_splats(band, part.octaves, placement)) {
                    const BandLight here{of_band, part.shown, part.region, float(1 << part.octaves)};
                    part.ranges.push_back(add_band(here, size, with_stars, alpha, placement, opacity, out));
                }
            });
    }
    return parts;
}

}  // namespace astrosplat

#include "bodies/picture_stars.h"

#include <algorithm>
#include <span>
#include <utility>

#include "bodies/bright_stars.h"

namespace astrosplat {

PictureStars take_picture_stars(Image& light, const StructureParams& params) {
    PictureStars stars;
    if (params.stars == StructureParams::Stars::no) return stars;
    std::vector<Star> bright;
    const bool disk = params.kind == StructureKind::disk;
    if (disk) bright = take_bright_stars(light);
    stars.all =
        take_stars(light, disk ? least_left_in_dust : 0.0f);  // without dust a hole is nearer the front
    stars.ordinary = stars.all.size();
    stars.count = static_cast<std::int64_t>(stars.ordinary);
    for (Star& star : bright) {
        star.body += static_cast<std::uint32_t>(stars.ordinary);
        stars.count = std::max(stars.count, static_cast<std::int64_t>(star.body) + 1);
    }
    std::ranges::stable_sort(bright, {}, &Star::sigma);
    stars.all.insert(stars.all.end(), bright.begin(), bright.end());
    return stars;
}

void add_picture_stars(const PictureStars& stars, const Placement& placement, const Opacity& opacity,
                       PictureSplats& out) {
    const std::span<const Star> all(stars.all);
    add_stars(all.first(stars.ordinary), 0, placement, opacity, out);
    for (std::size_t begin = stars.ordinary; begin < all.size();) {
        std::size_t end = begin;
        while (end < all.size() && all[end].sigma == all[begin].sigma) ++end;
        add_stars(all.subspan(begin, end - begin), static_cast<std::uint32_t>(begin), placement, opacity,
                  out);
        begin = end;
    }
}

}  // namespace astrosplat

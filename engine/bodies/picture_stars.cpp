#include "bodies/picture_stars.h"

#include <algorithm>
#include <span>
#include <utility>

#include "bodies/bright_stars.h"

namespace astrosplat {

PictureStars take_picture_stars(Image& light, const StructureParams& params, bool enlarged) {
    PictureStars stars;
    if (params.stars == StructureParams::Stars::no) return stars;
    std::vector<Star> bright;
    const bool disk = params.kind == StructureKind::disk;
    if (disk) bright = take_bright_stars(light);
    const float least_left = disk ? least_left_in_dust : 0.0f;  // without dust a hole is nearer the front
    stars.all = take_stars(light, least_left, enlarged ? StarsTaken::explained : StarsTaken::round);
    std::ranges::stable_sort(stars.all, {}, &Star::sigma);
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
    constexpr float about_one_size = 1.4f;  // widest over narrowest: each more takes the front's fit longer
    const std::span<const Star> all(stars.all);
    for (std::size_t begin = 0; begin < all.size();) {
        const bool ordinary = begin < stars.ordinary;
        const float widest = ordinary ? about_one_size * all[begin].sigma : all[begin].sigma;
        std::size_t end = begin;
        while (end < (ordinary ? stars.ordinary : all.size()) && all[end].sigma <= widest) ++end;
        add_stars(all.subspan(begin, end - begin), static_cast<std::uint32_t>(begin), placement, opacity,
                  out);
        begin = end;
    }
}

}  // namespace astrosplat

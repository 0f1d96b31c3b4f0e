#include "detect/parts.h"

#include <glm/geometric.hpp>

#include "core/sorting.h"
#include "detect/background.h"
#include "image/blur.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

Region box_of(const std::vector<std::int64_t>& pixels, std::int64_t width) {
    std::int64_t left = width, top = pixels.front() / width, right = 0, bottom = 0;
    for (const std::int64_t i : pixels) {
        left = std::min(left, i % width);
        right = std::max(right, i % width + 1);
        top = std::min(top, i / width);
        bottom = std::max(bottom, i / width + 1);
    }
    return {left, top, right - left, bottom - top};
}

constexpr float deviations = 2.5f;
constexpr int margin_px = 2;
constexpr std::size_t least_px = 3;

// Pixels brighter than the sky.
PixelMask bright_pixels(const Image& brightest) {
    const Image smooth = gaussian_blur(brightest, 1.0);
    std::vector<float> values(smooth.pixels.begin(), smooth.pixels.end());
    const Background sky = background_of(values);
    const float least =
        sky.level + deviations * float(sigma_of_median_distance) * sky.median_distance + 1e-6f;
    PixelMask bright = make_mask(smooth.width, smooth.height);
    std::ranges::transform(smooth.pixels, bright.pixels.begin(),
                           [&](float v) -> unsigned char { return v > least; });
    return bright;
}

float median_of(const Image& channel) {
    return median(std::vector<float>(channel.pixels.begin(), channel.pixels.end()));
}

PictureObject object_of(const std::vector<std::int64_t>& part, const Image& brightest, float sky) {
    glm::dvec2 sum(0.0);
    double light = 0.0;
    for (const std::int64_t i : part) {
        const double weight = std::max(1e-9, double(brightest.pixels[i] - sky));
        sum += weight * (glm::dvec2(i % brightest.width, i / brightest.width) + 0.5);
        light += weight;
    }
    PictureObject object{glm::vec2(sum / light), 0.0f};
    for (const std::int64_t i : part)
        object.reach = std::max(
            object.reach,
            glm::distance(object.middle, glm::vec2(i % brightest.width, i / brightest.width) + 0.5f));
    return object;
}

// The light of the objects' pixels above the median of each channel is theirs.
void share_light(const Image& picture, PictureObjects& found) {
    found.light = make_image(picture.width, picture.height, 3);
    found.sky = make_image(picture.width, picture.height, 3);
    for (int c = 0; c < 3; ++c) {
        const float sky = median_of(channel_of(picture, c));
        for (std::int64_t i = 0; i < picture.width * picture.height; ++i) {
            const float whole = picture.pixels[i * picture.channels + c];
            const bool owned = found.owner[i] >= 0;
            const float own = owned ? whole - std::min(whole, sky) : 0.0f;
            found.light.pixels[3 * i + c] = own;
            found.sky.pixels[3 * i + c] = whole - own;
        }
    }
}

}  // namespace

PixelMask make_mask(std::int64_t width, std::int64_t height) {
    PixelMask mask{width, height, {}};
    mask.pixels.assign(std::size_t(width * height), 0);
    return mask;
}

PixelPart take_part(PixelMask& mask, std::int64_t first, Touching touching) {
    PixelPart part;
    const auto take = [&](std::int64_t i) {
        unsigned char& there = mask.pixels[i];
        if (there) part.pixels.push_back(i);
        there = 0;
    };
    take(first);
    for (std::size_t next = 0; next < part.pixels.size(); ++next) {
        const std::int64_t x = part.pixels[next] % mask.width, y = part.pixels[next] / mask.width;
        for_each_about(mask, x, y, 1, [&](std::int64_t i, std::int64_t j) {
            if (touching == Touching::corners || i == x || j == y) take(j * mask.width + i);
        });
    }
    if (!part.pixels.empty()) part.box = box_of(part.pixels, mask.width);
    return part;
}

std::vector<PixelPart> connected_parts(PixelMask mask, Touching touching) {
    std::vector<PixelPart> parts;
    for (std::size_t i = 0; i < mask.pixels.size(); ++i)
        if (mask.pixels[i]) parts.push_back(take_part(mask, std::int64_t(i), touching));
    return parts;
}

PixelMask grown(const PixelMask& mask) {
    PixelMask wider = mask;
    for_each_between(mask, 0, 0, mask.width - 1, mask.height - 1, [&](std::int64_t x, std::int64_t y) {
        if (mask.at(x, y))
            for_each_about(mask, x, y, 1, [&](std::int64_t i, std::int64_t j) { wider.at(i, j) = 1; });
    });
    return wider;
}

PictureObjects find_objects(const Image& picture, double longest_px) {
    PictureObjects found;
    const Image brightest = brightest_channel(picture);
    PixelMask mask = bright_pixels(brightest);
    for (int i = 0; i < margin_px; ++i) mask = grown(mask);
    found.owner.assign(mask.pixels.size(), -1);
    const float dark = median_of(brightest);
    for (const PixelPart& part : connected_parts(std::move(mask))) {
        const PictureObject object = object_of(part.pixels, brightest, dark);
        if (part.pixels.size() < least_px || double(object.reach) > longest_px) continue;
        for (const std::int64_t i : part.pixels) found.owner[i] = std::int32_t(found.objects.size());
        found.objects.push_back(object);
    }
    share_light(picture, found);
    return found;
}

}  // namespace astrosplat

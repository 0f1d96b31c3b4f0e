#include "source/picture_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "image/blur.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

constexpr float deviations = 2.5f;
constexpr int margin_px = 2;
constexpr std::size_t least_px = 3;

float median_of(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Pixels brighter than the sky.
std::vector<char> bright_pixels(const Image& brightest) {
    const Image smooth = gaussian_blur(brightest, 1.0);
    const std::vector<float> values(smooth.pixels.begin(), smooth.pixels.end());
    const float sky = median_of(values);
    std::vector<float> away(values.size());
    std::ranges::transform(values, away.begin(), [&](float v) { return std::fabs(v - sky); });
    const float least = sky + deviations * 1.4826f * median_of(away) + 1e-6f;
    std::vector<char> bright(values.size());
    std::ranges::transform(values, bright.begin(), [&](float v) { return v > least ? 1 : 0; });
    return bright;
}

std::vector<char> grown(const std::vector<char>& mask, std::int64_t width, std::int64_t height) {
    std::vector<char> wider = mask;
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            if (!mask[static_cast<std::size_t>(y * width + x)]) continue;
            for (std::int64_t j = std::max<std::int64_t>(0, y - 1); j <= std::min(height - 1, y + 1); ++j)
                for (std::int64_t i = std::max<std::int64_t>(0, x - 1); i <= std::min(width - 1, x + 1); ++i)
                    wider[static_cast<std::size_t>(j * width + i)] = 1;
        }
    return wider;
}

// The connected pixels (of eight neighbours) of the mask around the first one, which get a number.
std::vector<std::int64_t> take_part(const std::vector<char>& mask, std::int64_t width, std::int64_t height,
                                    std::int64_t first, std::int32_t number,
                                    std::vector<std::int32_t>& owner) {
    std::vector<std::int64_t> part{first};
    owner[static_cast<std::size_t>(first)] = number;
    for (std::size_t next = 0; next < part.size(); ++next) {
        const std::int64_t x = part[next] % width, y = part[next] / width;
        for (std::int64_t j = std::max<std::int64_t>(0, y - 1); j <= std::min(height - 1, y + 1); ++j)
            for (std::int64_t i = std::max<std::int64_t>(0, x - 1); i <= std::min(width - 1, x + 1); ++i) {
                const auto at = static_cast<std::size_t>(j * width + i);
                if (!mask[at] || owner[at] != -1) continue;
                owner[at] = number;
                part.push_back(j * width + i);
            }
    }
    return part;
}

PictureObject object_of(const std::vector<std::int64_t>& part, const Image& brightest, float sky) {
    glm::dvec2 sum(0.0);
    double light = 0.0;
    for (const std::int64_t i : part) {
        const double weight =
            std::max(1e-9, static_cast<double>(brightest.pixels[static_cast<std::size_t>(i)] - sky));
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

}  // namespace

PictureObjects find_objects(const Image& picture, double longest_px) {
    PictureObjects found;
    const std::int64_t width = picture.width, height = picture.height;
    found.light = make_image(width, height, 3);
    found.sky = make_image(width, height, 3);
    std::array<float, 3> sky{};
    for (int c = 0; c < 3; ++c) {
        const Image channel = channel_of(picture, c);
        sky[static_cast<std::size_t>(c)] = median_of({channel.pixels.begin(), channel.pixels.end()});
    }
    const Image brightest = brightest_channel(picture);
    std::vector<char> mask = bright_pixels(brightest);
    for (int i = 0; i < margin_px; ++i) mask = grown(mask, width, height);
    found.owner.assign(mask.size(), -1);
    const float dark = median_of({brightest.pixels.begin(), brightest.pixels.end()});
    for (std::int64_t i = 0; i < width * height; ++i) {
        if (!mask[static_cast<std::size_t>(i)] || found.owner[static_cast<std::size_t>(i)] != -1) continue;
        const auto number = static_cast<std::int32_t>(found.objects.size());
        const std::vector<std::int64_t> part = take_part(mask, width, height, i, number, found.owner);
        const PictureObject object = object_of(part, brightest, dark);
        if (part.size() >= least_px && double(object.reach) <= longest_px) {
            found.objects.push_back(object);
            continue;
        }
        for (const std::int64_t p : part) {
            found.owner[static_cast<std::size_t>(p)] = -1;
            mask[static_cast<std::size_t>(p)] = 0;
        }
    }
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) {
                const float whole = picture.at(x, y)[c];
                const bool owned = found.owner[static_cast<std::size_t>(y * width + x)] >= 0;
                const float own = owned ? whole - std::min(whole, sky[static_cast<std::size_t>(c)]) : 0.0f;
                found.light.at(x, y)[c] = own;
                found.sky.at(x, y)[c] = whole - own;
            }
    return found;
}

}  // namespace astrosplat

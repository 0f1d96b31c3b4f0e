// Of whole numbers up to the picture, whose levels come from a table: a picture changes 60 times a second.
#include "output/scopes.h"

#include <glm/common.hpp>
#include <numeric>

#include "core/real.h"

namespace astrosplat {
namespace {

constexpr int values = 256;       // of a channel
constexpr int vector_bins = 255;  // an odd number has a middle

// Rec. 709: of luma, and the largest difference of blue and of red from it.
constexpr glm::vec3 luma_of(0.2126f, 0.7152f, 0.0722f);
constexpr float blue_range = 1.8556f, red_range = 1.5748f;

/// Column and row of the vectorscope, in parts, of 8-bit values: a product a channel, for the chroma is
/// linear.
class VectorPlace {
  public:
    glm::vec2 operator()(const unsigned char* p) const {
        return middle_ + float(p[0]) * red_ + float(p[1]) * green_ + float(p[2]) * blue_;
    }

  private:
    static constexpr float scale_ = vector_bins / (2.0f * vector_reach * 255.0f);
    glm::vec2 middle_{0.5f * vector_bins}, red_ = scale_ * chroma_of({1.0f, 0.0f, 0.0f}),
                                           green_ = scale_ * chroma_of({0.0f, 1.0f, 0.0f}),
                                           blue_ = scale_ * chroma_of({0.0f, 0.0f, 1.0f});
};

/// What a bin of `chroma` is drawn in.
glm::vec3 color_of(glm::vec2 chroma) {
    constexpr float luma = 0.6f;
    const float red = luma + red_range * chroma.y, blue = luma + blue_range * chroma.x;
    const float green = (luma - luma_of.r * red - luma_of.b * blue) / luma_of.g;
    return glm::clamp(glm::vec3(red, green, blue), 0.0f, 1.0f);
}

void put(Image& picture, int x, int y, glm::vec3 c) {
    float* const p = picture.at(x, y);
    p[0] = c.r, p[1] = c.g, p[2] = c.b, p[3] = 1.0f;
}

/// The traces of red, green and blue, whose sum is white: paler than the primaries, of which blue is hard to
/// see on black.
glm::vec3 sum_of_traces(glm::vec3 levels) {
    constexpr float own = 0.7f, other = 0.5f * (1.0f - own);
    return (own - other) * levels + glm::vec3(other * (levels.r + levels.g + levels.b));
}

Image histogram_picture(const ScopeCounts& counts) {
    constexpr int height = 128;
    constexpr float fill = 0.55f;
    std::uint32_t most =
        1;  // black and white, which hold all that is cut off, would leave nothing of the rest
    for (int column = 1; column < values - 1; ++column)
        for (int k = 0; k < 3; ++k) most = std::max(most, counts.at(column, 0, k));
    Image picture = unfilled_image(values, height, 4);
    for (int column = 0; column < values; ++column) {
        glm::vec3 top;
        for (int k = 0; k < 3; ++k)
            top[k] =
                height * std::sqrt(static_cast<float>(counts.at(column, 0, k)) / static_cast<float>(most));
        for (int row = 0; row < height; ++row)
            put(picture, column, height - 1 - row,
                fill * sum_of_traces(glm::clamp(top - static_cast<float>(row), 0.0f, 1.0f)));
    }
    return picture;
}

/// Four times the count, softened over the rows above and below, so that no single one is lost where the
/// picture is drawn smaller.
std::uint32_t softened(const ScopeCounts& counts, int column, int row, int channel) {
    return counts.at(column, std::max(0, row - 1), channel) + 2 * counts.at(column, row, channel) +
           counts.at(column, std::min(counts.rows - 1, row + 1), channel);
}

/// Of four times a count: 0 to 1 for `full`.
class Levels {
  public:
    explicit Levels(double full) {
        const double scale = 1.0 / real::log(1.0 + std::max(1.0, full));
        for (std::size_t i = 0; i < table_.size(); ++i)
            table_[i] =
                static_cast<float>(std::min(1.0, scale * real::log(1.0 + 0.25 * static_cast<double>(i))));
    }
    float operator()(std::uint32_t quadrupled) const {
        return table_[std::min<std::size_t>(quadrupled, table_.size() - 1)];
    }

  private:
    std::array<float, 4096> table_;
};

std::uint32_t sum(const ScopeCounts& counts) {
    return std::accumulate(counts.counts.begin(), counts.counts.end(), std::uint32_t{0}) /
           static_cast<std::uint32_t>(counts.channels);
}

/// A column one sixteenth of which is of one value is as bright there as can be.
Image waveform_picture(const ScopeCounts& counts) {
    const Levels level(0.0625 * static_cast<double>(sum(counts)) / counts.columns);
    Image picture = unfilled_image(counts.columns, counts.rows, 4);
    for (int row = 0; row < counts.rows; ++row)
        for (int column = 0; column < counts.columns; ++column) {
            glm::vec3 levels;
            for (int k = 0; k < 3; ++k) levels[k] = level(softened(counts, column, row, k));
            put(picture, column, counts.rows - 1 - row, sum_of_traces(levels));
        }
    return picture;
}

Image vectorscope_picture(const ScopeCounts& counts) {
    const Levels level(0.0005 * static_cast<double>(sum(counts)));
    Image picture = unfilled_image(counts.columns, counts.rows, 4);
    const auto chroma = [](int bin) {
        return 2.0f * vector_reach * ((static_cast<float>(bin) + 0.5f) / float(vector_bins) - 0.5f);
    };
    for (int row = 0; row < counts.rows; ++row)
        for (int column = 0; column < counts.columns; ++column) {
            const float light = level(softened(counts, column, row, 0));
            const glm::vec3 ink = light > 0.0f ? color_of({chroma(column), chroma(row)}) : glm::vec3(0.0f);
            put(picture, column, counts.rows - 1 - row, light * ink);
        }
    return picture;
}

}  // namespace

glm::vec2 chroma_of(glm::vec3 rgb) {
    const float luma = luma_of.r * rgb.r + luma_of.g * rgb.g + luma_of.b * rgb.b;
    return {(rgb.b - luma) / blue_range, (rgb.r - luma) / red_range};
}

ScopeCounts count_points(Scope scope, const ScreenPoints& points) {
    const bool is_vectors = scope == Scope::vectorscope, is_waveform = scope == Scope::waveform;
    ScopeCounts found;
    constexpr std::int64_t most_columns = 256;
    const auto columns = static_cast<int>(std::clamp<std::int64_t>(points.width, 1, most_columns));
    found.columns = is_vectors ? vector_bins : is_waveform ? columns : values;
    found.rows = is_waveform ? values : is_vectors ? vector_bins : 1;
    found.channels = is_vectors ? 1 : 3;
    found.counts.resize(static_cast<std::size_t>(found.columns * found.rows * found.channels));
    const VectorPlace vector_place;
    std::int64_t x = 0;
    for (std::size_t i = 0; i + 3 < points.rgba.size(); i += 4) {
        const unsigned char* const p = &points.rgba[i];
        const int column = static_cast<int>(x * columns / points.width);
        x = x + 1 == points.width ? 0 : x + 1;
        if (is_vectors) {
            const glm::vec2 place = vector_place(p);
            ++found.counts[found.index(static_cast<int>(place.x), static_cast<int>(place.y), 0)];
        } else {
            for (int k = 0; k < 3; ++k)
                ++found.counts[is_waveform ? found.index(column, p[k], k) : found.index(p[k], 0, k)];
        }
    }
    return found;
}

Image scope_picture(Scope scope, const ScopeCounts& counts) {
    switch (scope) {
        case Scope::histogram:
            return histogram_picture(counts);
        case Scope::waveform:
            return waveform_picture(counts);
        default:
            return vectorscope_picture(counts);
    }
}

}  // namespace astrosplat

// A footprint averages optical depths where a picture averages light, and light is a concave function of
// depth: so a column that is right over an even picture shows too much about stars, and too little where
// chance left few splats. Here the chart's cells are drawn as the renderer would draw them, and what is
// missing goes back to the splats as a factor, a few times over.
//
// A splat that adds `a` (alpha times weight) to a cell leaves 1 - a of the light behind, so its depth is
// -ln(1 - a) = a + a^2/2 + ..; the weight is that of the footprint on these cells.
#include "look/picture_fit.h"

#include <algorithm>

#include "core/parallel.h"
#include "look/picture_cover.h"
#include "look/shared_look.h"

namespace astrosplat {
namespace {

constexpr int steps = 4;
constexpr float faint = 1e-4f;     // light of which nothing more is asked than its order
constexpr int neighbourhood = 4;   // footprints' variances over which black positions are counted
constexpr float all_there = 0.9f;  // a share of positions that may be missing by chance
constexpr float least_step = 0.33f, most_step = 3.0f;
constexpr float least_factor = 0.25f, most_factor = 4.0f;
constexpr std::int64_t fit_chunk = 1 << 14;  // cells

template <class Body>
void each_cell(const CellValues& values, const Body& body) {
    parallel_each(values.size(), fit_chunk, body);
}

class Fit {
  public:
    Fit(const PictureChart& chart, PictureCells& cells, int match, double positions_due)
        : chart_(chart), cells_(cells), match_(match), blur_(chart, false), blur_squares_(chart, true) {
        PictureCover cover = cover_once(chart, cells, positions_due);
        inside_ = std::move(cover.inside);
        whole_ = std::move(cover.whole);
        around_ = inside_;
        blur_(around_);
        each_cell(around_, [&](std::size_t i) { around_[i] = inside_[i] > 0.0f ? 1.0f / around_[i] : 0.0f; });
    }

    ChannelValues factors();

  private:
    /// Means over footprints' weights on the cells inside of the picture.
    void average(CellValues& values) {
        blur_(values);
        each_cell(values, [&](std::size_t i) { values[i] *= around_[i]; });
    }
    void count_black();
    void find_wanted();
    void vary_wanted();
    void draw(std::size_t channel);
    void draw_summed(std::size_t channel);
    void draw_covering(std::size_t channel);
    void draw_hidden(std::size_t channel);
    void step(std::size_t channel);

    const PictureChart& chart_;
    PictureCells& cells_;
    const int match_;
    ChartBlur blur_, blur_squares_;
    std::vector<float> whole_;    // positions a cell of each block has where nothing is black
    CellValues inside_, around_;  // 1 where there is a picture; one over its mean over a footprint
    CellValues light_, other_;    // as drawn; and room for more
    CellValues depth_, shown_;    // of opacity, as it stands: linear depth, and opacity over it
    ChannelValues factors_;
};

// Adds to the positions about each cell the black ones, which are not in the set: where many are missing all
// about, since here and there chance has left few.
void Fit::count_black() {
    average(cells_.positions);
    CellValues about = cells_.positions;
    for (int n = 0; n < neighbourhood; ++n) average(about);
    each_cell(about, [&](std::size_t i) {
        const float whole = whole_[chart_.block_of_cell(static_cast<std::int64_t>(i))];
        float& count = cells_.positions[i];
        if (about[i] > 0.0f && about[i] < all_there * whole)
            count = std::clamp(count * (all_there * whole / about[i]), count, std::max(count, whole));
    });
}

// The mean over the positions of a footprint.
void Fit::find_wanted() {
    count_black();
    for (CellValues& wanted : cells_.wanted) {
        average(wanted);
        each_cell(wanted, [&](std::size_t i) {
            const float count = cells_.positions[i];
            wanted[i] = inside_[i] > 0.0f && count > 0.0f ? wanted[i] / count : 0.0f;
        });
    }
    if (!cells_.plain.empty()) vary_wanted();
}

// Noise and crops of the look change depth, and are to be seen.
void Fit::vary_wanted() {
    blur_(cells_.varied);
    blur_(cells_.plain);
    const bool sums = match_ == shared_types::MATCH_LIGHT, screens = match_ == shared_types::MATCH_SCREEN;
    each_cell(cells_.plain, [&](std::size_t i) {
        const float share = cells_.plain[i] > 0.0f ? cells_.varied[i] / cells_.plain[i] : 1.0f;
        const auto changed = [&](float light) {
            return sums ? light * share : 1.0f - shared::as_exp(-share * shared::look_small_depth(light));
        };
        const float before = cells_.wanted[0][i], opacity = changed(before);
        for (std::size_t c = 0; c < picture_channels; ++c) {
            float& light = cells_.wanted[c][i];
            if (c == 0 || screens)
                light = changed(light);
            else
                light *= before > 0.0f ? opacity / before : 0.0f;
        }
    });
}

void Fit::draw_summed(std::size_t channel) {
    const CellValues &depth = cells_.depth[channel], &factor = factors_[channel];
    each_cell(light_, [&](std::size_t i) { light_[i] = depth[i] * factor[i]; });
    average(light_);
}

// 1 - e^-depth, with the squares of opacity as far as this channel's depth is a share of it.
void Fit::draw_covering(std::size_t channel) {
    draw_summed(channel);
    const CellValues &depth = cells_.depth[channel], &opacity = cells_.depth[0], &factor = factors_[channel];
    each_cell(other_, [&](std::size_t i) {
        const float share = opacity[i] > 0.0f ? factor[i] * (depth[i] / opacity[i]) : 0.0f;
        other_[i] = cells_.squares[i] * (share * share);
    });
    blur_squares_(other_);
    const bool of_opacity = channel == 0;
    each_cell(light_, [&](std::size_t i) {
        const float linear = light_[i];
        light_[i] = 1.0f - shared::as_exp(-(linear + 0.5f * other_[i] * around_[i]));
        if (of_opacity) shown_[i] = linear > 0.0f ? light_[i] / linear : 1.0f;
    });
}

// Colours that hide one another: their mean by depth, as far as the column is opaque.
void Fit::draw_hidden(std::size_t channel) {
    draw_summed(channel);
    each_cell(light_, [&](std::size_t i) { light_[i] *= shown_[i]; });
}

void Fit::draw(std::size_t channel) {
    if (match_ == shared_types::MATCH_LIGHT)
        draw_summed(channel);
    else if (match_ == shared_types::MATCH_SCREEN || channel == 0)
        draw_covering(channel);
    else
        draw_hidden(channel);
}

// Richardson's and Lucy's step: what is missing about a splat, by its footprint, which keeps the sum of
// light.
void Fit::step(std::size_t channel) {
    draw(channel);
    each_cell(light_, [&](std::size_t i) {
        const float missing = (cells_.wanted[channel][i] + faint) / (light_[i] + faint);
        light_[i] = inside_[i] * std::clamp(missing, least_step, most_step);
    });
    average(light_);
    CellValues& factor = factors_[channel];
    each_cell(factor, [&](std::size_t i) {
        if (inside_[i] > 0.0f) factor[i] = std::clamp(factor[i] * light_[i], least_factor, most_factor);
    });
}

ChannelValues Fit::factors() {
    find_wanted();
    light_ = other_ = shown_ = CellValues(inside_.size(), 0.0f);
    for (CellValues& factor : factors_) factor.assign(inside_.size(), 1.0f);
    const bool screens = match_ == shared_types::MATCH_SCREEN;
    for (int n = 0; n < steps; ++n)
        for (std::size_t c = screens ? 1 : 0; c < picture_channels; ++c) step(c);
    if (screens)
        each_cell(factors_[0], [&](std::size_t i) {
            factors_[0][i] = (factors_[1][i] + factors_[2][i] + factors_[3][i]) / 3.0f;
        });
    return std::move(factors_);
}

}  // namespace

ChannelValues picture_fit(const PictureChart& chart, PictureCells& cells, int match, double positions_due) {
    return Fit(chart, cells, match, positions_due).factors();
}

std::int64_t picture_fit_bytes(const PictureChart& chart) {
    constexpr std::int64_t values = static_cast<std::int64_t>(picture_channels) + 8;
    return chart.cells() * values * static_cast<std::int64_t>(sizeof(float));
}

}  // namespace astrosplat

// A footprint averages optical depths, a picture averages light, which is concave in depth: a column that is
// right over an even picture shows too much about stars, and too little where chance left few splats. So the
// chart's cells are drawn as the renderer would draw them, and missing light goes back to the splats as a
// factor, a few times over. A splat adding `a` (alpha times weight) has depth -ln(1 - a).
#include "look/picture_fit.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "image/channels.h"
#include "look/shared_look.h"

namespace astrosplat {
namespace {

struct PictureCover {
    CellValues inside;  // 1 for cells that have positions or neighbours that have, else 0
    // How many positions a cell of each block has where the picture is nowhere black, whose black positions
    // are not in the set; 0: not known.
    std::vector<float> whole;
};

constexpr double piled_up = 5.0;       // times what chance adds to the positions of a cell
constexpr double never_piled = 2.0;    // positions
constexpr double sampled_below = 0.5;  // covered less than this, the set is a sample

struct BlockSums {
    double due = 0.0, unclamped = 0.0, positions = 0.0, cells = 0.0;

    void add(const BlockSums& s) {
        due += s.due, unclamped += s.unclamped, positions += s.positions, cells += s.cells;
    }
};

// Calls body(cell, block) for the cells of a band of blocks, row after row.
template <class Body>
void each_of_band(const PictureChart& chart, std::int64_t band, const Body& body) {
    const std::int64_t mesh = band / chart_side, rows = chart.rows;
    const std::int64_t begin = PictureChart::block_begin(band % chart_side, rows);
    const std::int64_t end = PictureChart::block_begin(band % chart_side + 1, rows);
    for (std::int64_t y = mesh * rows + begin; y < mesh * rows + end; ++y)
        for (std::int64_t x = 0; x < chart.columns; ++x)
            body(std::size_t(y * chart.columns + x),
                 std::size_t(band * chart_side + PictureChart::block_at(x, chart.columns)));
}

// 1 where a cell or one of the eight about it has positions.
CellValues filled(const PictureChart& chart, const CellValues& positions) {
    CellValues result(positions.size(), 0.0f);
    const std::int64_t columns = chart.columns, rows = chart.rows;
    const Region grid{0, 0, columns, rows};
    parallel_each(chart.meshes * rows, 16, [&](std::int64_t y) {
        const std::int64_t first = y / rows * rows;  // of the mesh
        for (std::int64_t x = 0; x < columns; ++x) {
            float sum = 0.0f;
            for_each_about(grid, x, y - first, 1, [&](std::int64_t nx, std::int64_t ny) {
                sum += positions[(first + ny) * columns + nx];
            });
            result[y * columns + x] = sum > 0.0f ? 1.0f : 0.0f;
        }
    });
    return result;
}

// Of each block and its neighbours.
std::vector<BlockSums> sums_around(const PictureChart& chart, const PictureCells& cells,
                                   const CellValues& inside) {
    std::vector<BlockSums> own(chart.blocks.size()), around(chart.blocks.size());
    parallel_for(chart.meshes * chart_side, [&](std::int64_t band, int) {
        each_of_band(chart, band, [&](std::size_t cell, std::size_t block) {
            own[block].positions += double(cells.positions[cell]);
            own[block].cells += double(inside[cell]);
        });
    });
    for (std::size_t b = 0; b < own.size(); ++b)
        own[b].due = cells.cover[b].due, own[b].unclamped = cells.cover[b].unclamped;
    const Region grid{0, 0, chart_side, chart_side};
    for (std::int64_t b = 0; b < std::ssize(own); ++b) {
        const std::int64_t in_mesh = b % (chart_side * chart_side), first = b - in_mesh;
        for_each_about(
            grid, in_mesh % chart_side, in_mesh / chart_side, 1,
            [&](std::int64_t x, std::int64_t y) { around[b].add(own[first + y * chart_side + x]); });
    }
    return around;
}

// A picture's black positions are not in the set, so less than once is once.
float covered(const BlockSums& s) {
    if (!(s.unclamped > 0.0) || !(s.cells > 0.0)) return 1.0f;
    const double estimate = s.due / s.unclamped * (s.positions / s.cells);
    return float(estimate < sampled_below ? estimate : std::max(1.0, std::floor(estimate + 0.5)));
}

void empty_cell(PictureCells& cells, std::size_t i) {
    for (std::size_t c = 0; c < picture_channels; ++c) cells.depth[c][i] = cells.wanted[c][i] = 0.0f;
    cells.squares[i] = cells.positions[i] = 0.0f;
    if (!cells.plain.empty()) cells.plain[i] = cells.varied[i] = 0.0f;
}

// Divides the splats' sums by how often their surface is covered: once, unless parts of meshes share u and
// v, or the set is a sample of one. Empties cells on the edge of a mesh, where all positions beyond it are
// piled up; they are not inside. `positions_due`: of a square scene unit of surface; 0: not known.
PictureCover cover_once(const PictureChart& chart, PictureCells& cells, double positions_due) {
    PictureCover cover{filled(chart, cells.positions), std::vector<float>(chart.blocks.size())};
    const std::vector<BlockSums> around = sums_around(chart, cells, cover.inside);
    for (std::size_t b = 0; b < around.size(); ++b)
        cover.whole[b] = float(positions_due * chart.blocks[b].cell_area) * covered(around[b]);
    parallel_for(chart.meshes * chart_side, [&](std::int64_t band, int) {
        each_of_band(chart, band, [&](std::size_t i, std::size_t block) {
            const BlockSums& s = around[block];
            const double mean = s.cells > 0.0 ? s.positions / s.cells : 0.0;
            if (double(cells.positions[i]) > mean + piled_up * std::sqrt(mean) + never_piled) {
                empty_cell(cells, i);
                cover.inside[i] = 0.0f;
            }
            const float less = 1.0f / covered(s);
            if (less == 1.0f) return;
            for (std::size_t c = 0; c < picture_channels; ++c) cells.depth[c][i] *= less;
            cells.squares[i] *= less * less;
        });
    });
    return cover;
}

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

    ChannelValues factors() {
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

  private:
    /// Means over footprints' weights on the cells inside of the picture.
    void average(CellValues& values) {
        blur_(values);
        each_cell(values, [&](std::size_t i) { values[i] *= around_[i]; });
    }

    // Adds to the positions about each cell the black ones, which are not in the set: where many are missing
    // all about, since here and there chance has left few.
    void count_black() {
        average(cells_.positions);
        CellValues about = cells_.positions;
        for (int n = 0; n < neighbourhood; ++n) average(about);
        each_cell(about, [&](std::size_t i) {
            const float whole = whole_[chart_.block_of_cell(std::int64_t(i))];
            float& count = cells_.positions[i];
            if (about[i] > 0.0f && about[i] < all_there * whole)
                count = std::clamp(count * (all_there * whole / about[i]), count, std::max(count, whole));
        });
    }

    // The mean over the positions of a footprint.
    void find_wanted() {
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
    void vary_wanted() {
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

    void draw(std::size_t channel) {
        if (match_ == shared_types::MATCH_LIGHT)
            draw_summed(channel);
        else if (match_ == shared_types::MATCH_SCREEN || channel == 0)
            draw_covering(channel);
        else
            draw_hidden(channel);
    }

    void draw_summed(std::size_t channel) {
        const CellValues &depth = cells_.depth[channel], &factor = factors_[channel];
        each_cell(light_, [&](std::size_t i) { light_[i] = depth[i] * factor[i]; });
        average(light_);
    }

    // 1 - e^-depth, with the squares of opacity as far as this channel's depth is a share of it.
    void draw_covering(std::size_t channel) {
        draw_summed(channel);
        const CellValues &depth = cells_.depth[channel], &opacity = cells_.depth[0],
                         &factor = factors_[channel];
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
    void draw_hidden(std::size_t channel) {
        draw_summed(channel);
        each_cell(light_, [&](std::size_t i) { light_[i] *= shown_[i]; });
    }

    // Richardson's and Lucy's step: what is missing about a splat, by its footprint,
    // which keeps the sum of light.
    void step(std::size_t channel) {
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

    const PictureChart& chart_;
    PictureCells& cells_;
    const int match_;
    ChartBlur blur_, blur_squares_;
    std::vector<float> whole_;    // positions a cell of each block has where nothing is black
    CellValues inside_, around_;  // 1 where there is a picture; one over its mean over a footprint
    CellValues light_, other_;    // as drawn; and room for more
    CellValues shown_;            // of opacity, as it stands, over linear depth
    ChannelValues factors_;
};

// Of alpha * color for red, green and blue, and of alpha alone; from 1/4 to 4. `match` is one of
// MATCH_LIGHT, MATCH_TRANSMITTANCE and MATCH_SCREEN. Uses the sums up.
// `positions_due` of a square scene unit of surface, black ones too; 0: not known.
ChannelValues picture_fit(const PictureChart& chart, PictureCells& cells, int match, double positions_due) {
    return Fit(chart, cells, match, positions_due).factors();
}

// Memory that it takes besides the sums at its peak, bytes.
std::int64_t picture_fit_bytes(const PictureChart& chart) {
    constexpr std::int64_t values = std::int64_t(picture_channels) + 8;
    return chart.cells() * values * std::int64_t(sizeof(float));
}

// On both sides of a square scene unit, of a lattice and the one between its corners.
double positions_due(const SplatSet& set) {
    const glm::dvec3& s = set.spacing;
    return set.generated ? 2.0 * set.max_distance * 2.0 / (s.x * s.y * s.z) : 0.0;
}

// Noise that only moves splats along the axis does not show from there, and takes longer than the rest.
PreparedLook without_jitter(PreparedLook u) {
    using shared_types::LookNoise;
    const auto shows = [](const LookNoise& n) {
        return n.cull != 0.0f || n.silhouette != 0.0f || n.alpha != 0.0f || n.brightness != 0.0f;
    };
    LookNoise* const end = std::stable_partition(u.noises, u.noises + u.noise_count, shows);
    u.noise_count = int(end - u.noises);
    return u;
}

}  // namespace

PictureFactors picture_factors(const LookRun& whole, const SplatSet& set, const FalloffMoments& falloff) {
    const PreparedLook uniforms = without_jitter(whole.uniforms);
    const LookRun run{whole.in, uniforms, whole.map, whole.out};
    PictureFactors factors;
    if (set.uv.empty() || set.size() == 0) return factors;
    const PictureChart chart = picture_chart(run, set, falloff.variance);
    if (chart.meshes == 0) return factors;
    claim_memory(picture_cells_bytes(chart, set.size()) + picture_fit_bytes(chart), "matching the picture");
    PictureCells cells = picture_cells(run, set, chart, falloff.integral);
    factors.of_cell = picture_fit(chart, cells, run.uniforms.match, positions_due(set));
    std::erase(cells.cell_of, no_cell);
    factors.cell_of = std::move(cells.cell_of);
    return factors;
}

void apply_factors(const PictureFactors& factors, ShadedSplats& shaded) {
    constexpr std::int64_t chunk = 1 << 14;
    parallel_each(factors.cell_of.size(), chunk, [&](std::size_t i) {
        const std::size_t cell = factors.cell_of[i];
        if (cell == beyond_cells) return;
        const float opacity = factors.of_cell[0][cell];
        shaded.alpha[i] = std::min(1.0f, shaded.alpha[i] * opacity);
        for (int c = 0; c < 3; ++c) shaded.color[i][c] *= factors.of_cell[std::size_t(c) + 1][cell] / opacity;
    });
}

}  // namespace astrosplat

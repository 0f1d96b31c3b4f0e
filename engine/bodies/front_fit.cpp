// Richardson and Lucy's steps with an exponent: they stay positive and undo the dots' own blur as well. Dots
// of one size see the ratio through their own footprint; wide ones on a coarser grid.
#include "bodies/front_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "camera/camera.h"
#include "core/color.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "image/blur.h"
#include "image/channels.h"
#include "render/render.h"

namespace astrosplat {
namespace {

constexpr double filter_px = 0.5;  // of the output's pixels, as scenes have it
constexpr float sky = 0.002f;      // added to both sides of a ratio
constexpr int most_steps = 6, fast_steps = 5;
constexpr float fast_exponent = 2.2f;  // of the first steps
constexpr double least_gain_db = 0.1;
constexpr std::int64_t cell_px = 32;
constexpr double seen_share = 0.25;        // of a footprint's variance through which a dot sees the ratio
constexpr std::int64_t psnr_step = 4;      // rows between those that the PSNR is measured on
constexpr double finest_grid_sigma = 1.5;  // grid steps below which a blur is not made coarser

float factor(const Image& grid, int channel, float x, float y) {
    const float ratio = bilinear(grid, channel, x, y) / bilinear(grid, channel + 3, x, y);
    return std::clamp(ratio, 0.33f, 3.0f);
}

class FrontView {
  public:
    FrontView(PictureSplats& dots, const Image& light)
        : dots_(dots), target_(gaussian_blur(light, filter_px)) {
        settings_.width = light.width;
        settings_.height = light.height;
        settings_.pixel_filter = static_cast<float>(filter_px);
        layer_.name = "front";
        layer_.splats = &dots.splats;
        layer_.absorbs = dots.absorbs;
        float highest = 0.0f;
        for (const glm::vec3& p : dots.splats.position) highest = std::max(highest, p.z);
        CameraParams params;
        params.projection = Projection::orthographic;
        params.position =
            glm::dvec3(0.0, 0.0, 2.0 * static_cast<double>(highest) + static_cast<double>(light.width));
        params.target = glm::dvec3(0.0);
        params.height = static_cast<double>(light.height);
        camera_ =
            make_camera(params, static_cast<double>(light.width), static_cast<double>(light.height), {});
    }

    void render_now(const Progress& progress) {
        frame_ = render({&layer_, 1}, camera_, nullptr, settings_, progress, &cache_);
    }

    double psnr_db() const;
    void step(float exponent);
    void match_cells();

  private:
    Image weighted_ratio() const;
    Image cell_flux() const;
    /// Where a dot is in the picture, px from the top left corner.
    glm::vec2 texel(const glm::vec3& p) const {
        return {p.x + 0.5f * static_cast<float>(target_.width),
                0.5f * static_cast<float>(target_.height) - p.y};
    }

    PictureSplats& dots_;
    Image target_;
    RenderSettings settings_;
    RenderLayer layer_;
    Camera camera_;
    RenderCache cache_;
    RenderedFrame frame_;
};

double FrontView::psnr_db() const {
    std::vector<double> rows(static_cast<std::size_t>((target_.height + psnr_step - 1) / psnr_step), 0.0);
    parallel_chunks(
        static_cast<std::int64_t>(rows.size()), 16, [&](std::int64_t begin, std::int64_t end, int) {
            for (std::int64_t row = begin; row < end; ++row) {
                const std::int64_t y = row * psnr_step;
                double sum = 0.0;
                for (std::int64_t x = 0; x < target_.width; ++x) {
                    for (int c = 0; c < 3; ++c) {
                        const double seen = static_cast<double>(display_srgb(frame_.beauty.at(x, y)[c]));
                        const double wanted = static_cast<double>(display_srgb(target_.at(x, y)[c]));
                        sum += (seen - wanted) * (seen - wanted);
                    }
                }
                rows[static_cast<std::size_t>(row)] = sum;
            }
        });
    double sum = 0.0;
    for (const double of_row : rows) sum += of_row;
    const double mean = sum / (3.0 * static_cast<double>(target_.width) * static_cast<double>(rows.size()));
    return -10.0 / real::log(10.0) * real::log(std::max(mean, 1e-12));
}

// Channels 0..2: ratio times what is seen; 3..5: what is seen.
Image FrontView::weighted_ratio() const {
    Image out = make_image(target_.width, target_.height, 6);
    parallel_chunks(target_.height, 16, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin * target_.width; i < end * target_.width; ++i) {
            const float* const seen = frame_.beauty.pixels.data() + i * frame_.beauty.channels;
            const float* const wanted = target_.pixels.data() + i * 3;
            float* const p = out.pixels.data() + i * 6;
            for (int c = 0; c < 3; ++c) {
                const float ratio = std::clamp((wanted[c] + sky) / (seen[c] + sky), 0.25f, 4.0f);
                p[c] = ratio * (seen[c] + sky);
                p[c + 3] = seen[c] + sky;
            }
        }
    });
    return out;
}

void FrontView::step(float exponent) {
    Image grid = weighted_ratio();
    double variance = 0.0, pixel = 1.0;  // of the grid's blur so far, and a grid step, in texels
    std::vector<DotRange> ranges = dots_.ranges;
    std::stable_sort(ranges.begin(), ranges.end(),
                     [](const DotRange& a, const DotRange& b) { return a.sigma < b.sigma; });
    for (const DotRange& range : ranges) {
        const double sigma = static_cast<double>(range.sigma);
        const double wanted = seen_share * (sigma * sigma + filter_px * filter_px);
        while (std::sqrt(wanted) / pixel > 2.0 * finest_grid_sigma && std::min(grid.width, grid.height) > 8) {
            grid = halved(grid);
            variance += 0.75 * pixel * pixel;
            pixel *= 2.0;
        }
        if (wanted > variance) {
            grid = gaussian_blur(grid, std::sqrt(wanted - variance) / pixel);
            variance = wanted;
        }
        const auto texels_per_step = static_cast<float>(pixel);
        parallel_chunks(range.end - range.begin, 65536, [&](std::int64_t begin, std::int64_t end, int) {
            for (std::int64_t i = range.begin + begin; i < range.begin + end; ++i) {
                const auto at = static_cast<std::size_t>(i);
                const glm::vec2 p = texel(dots_.splats.position[at]) / texels_per_step;
                for (int c = 0; c < 3; ++c) {
                    const float f = factor(grid, c, p.x, p.y);
                    dots_.splats.color[at][c] *= exponent == 1.0f ? f : shared::as_pow(f, exponent);
                }
            }
        });
    }
}

// The picture's flux over that of the front view in each cell, three channels.
Image FrontView::cell_flux() const {
    Image cells =
        make_image((target_.width + cell_px - 1) / cell_px, (target_.height + cell_px - 1) / cell_px, 3);
    parallel_for(cells.height, [&](std::int64_t row, int) {
        for (std::int64_t column = 0; column < cells.width; ++column) {
            double wanted[3] = {0.0, 0.0, 0.0}, seen[3] = {0.0, 0.0, 0.0};
            for (std::int64_t y = row * cell_px; y < std::min((row + 1) * cell_px, target_.height); ++y) {
                for (std::int64_t x = column * cell_px; x < std::min((column + 1) * cell_px, target_.width);
                     ++x) {
                    for (int c = 0; c < 3; ++c) {
                        wanted[c] += static_cast<double>(target_.at(x, y)[c]);
                        seen[c] += static_cast<double>(frame_.beauty.at(x, y)[c]);
                    }
                }
            }
            for (int c = 0; c < 3; ++c) {
                const double ratio = seen[c] > 0.0 ? wanted[c] / seen[c] : 1.0;
                cells.at(column, row)[c] = static_cast<float>(std::clamp(ratio, 0.5, 2.0));
            }
        }
    });
    return cells;
}

void FrontView::match_cells() {
    const Image cells = cell_flux();
    parallel_chunks(dots_.splats.size(), 65536, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin; i < end; ++i) {
            const auto at = static_cast<std::size_t>(i);
            if (dots_.splats.color[at].x < 0.0f) continue;  // dust
            const glm::vec2 p = texel(dots_.splats.position[at]) / static_cast<float>(cell_px);
            for (int c = 0; c < 3; ++c) dots_.splats.color[at][c] *= bilinear(cells, c, p.x, p.y);
        }
    });
}

}  // namespace

FrontFit fit_front(PictureSplats& dots, const Image& light, const Progress& progress) {
    FrontFit fit;
    FrontView view(dots, light);
    view.render_now(progress);
    fit.first_psnr_db = fit.psnr_db = view.psnr_db();
    while (fit.steps < most_steps) {
        view.step(fit.steps < fast_steps ? fast_exponent : 1.0f);
        ++fit.steps;
        view.render_now(progress);
        const double gain = view.psnr_db() - fit.psnr_db;
        fit.psnr_db += gain;
        if (fit.steps > fast_steps && gain < least_gain_db) break;
    }
    view.match_cells();
    return fit;
}

}  // namespace astrosplat

// Compositing the dots takes long, and what hides what does not change with their colours. So they are
// rendered twice only; between, the share of all light that reaches the viewer, pixel by pixel, makes the
// view out of the dots' flat light. Steps are Richardson and Lucy's, which stay positive and undo the dots'
// own blur as well.
#include "bodies/front_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "bodies/flat_light.h"
#include "camera/camera.h"
#include "core/color.h"
#include "core/parallel.h"
#include "core/real.h"
#include "image/blur.h"
#include "image/channels.h"
#include "render/render.h"

namespace astrosplat {
namespace {

constexpr double filter_px = 0.5;               // of the output's pixels, as scenes have it
constexpr float sky = 0.002f;                   // added to both sides of a ratio
constexpr int first_steps = 4, last_steps = 2;  // after the first rendering, and after the last
constexpr std::int64_t cell_px = 32;
constexpr std::int64_t psnr_step = 4;  // rows between those that the PSNR is measured on

Image quotient(Image image, const Image& divisor) {
    parallel_each(image.pixels.size(), 65536,
                  [&](std::size_t i) { image.pixels[i] /= std::max(divisor.pixels[i], 1e-12f); });
    return image;
}

void multiply(Image& image, const Image& factor) {
    parallel_each(image.pixels.size(), 65536, [&](std::size_t i) { image.pixels[i] *= factor.pixels[i]; });
}

// Channel 0: what is wanted over what is seen, times what is seen; 1: what is seen.
Image weighted_ratio(const Image& wanted, const Image& seen) {
    Image out = make_image(seen.width, seen.height, 2);
    parallel_each(seen.pixels.size(), 65536, [&](std::size_t i) {
        const float here = seen.pixels[i] + sky;
        out.pixels[2 * i] = std::clamp((wanted.pixels[i] + sky) / here, 0.25f, 4.0f) * here;
        out.pixels[2 * i + 1] = here;
    });
    return out;
}

// What is wanted over what is seen, in cells.
Image cell_ratio(const Image& wanted, const Image& seen) {
    Image cells = make_image((seen.width + cell_px - 1) / cell_px, (seen.height + cell_px - 1) / cell_px, 1);
    parallel_each(cells.height, 1, [&](std::int64_t row) {
        for (std::int64_t column = 0; column < cells.width; ++column) {
            double wanted_sum = 0.0, seen_sum = 0.0;
            for (std::int64_t y = row * cell_px; y < std::min((row + 1) * cell_px, seen.height); ++y) {
                for (std::int64_t x = column * cell_px; x < std::min((column + 1) * cell_px, seen.width);
                     ++x) {
                    wanted_sum += static_cast<double>(*wanted.at(x, y));
                    seen_sum += static_cast<double>(*seen.at(x, y));
                }
            }
            const double ratio = seen_sum > 0.0 ? wanted_sum / seen_sum : 1.0;
            *cells.at(column, row) = static_cast<float>(std::clamp(ratio, 0.5, 2.0));
        }
    });
    return cells;
}

class FrontView {
  public:
    FrontView(PictureSplats& dots, const Image& picture)
        : target_(gaussian_blur(picture, filter_px)), flat_(dots, picture.width, picture.height, filter_px) {
        settings_.width = picture.width;
        settings_.height = picture.height;
        settings_.pixel_filter = static_cast<float>(filter_px);
        layer_.name = "front";
        layer_.splats = &dots.splats;
        layer_.absorbs = dots.absorbs;
        float highest = 0.0f;
        for (const glm::vec3& p : dots.splats.position) highest = std::max(highest, p.z);
        CameraParams params;
        params.projection = Projection::orthographic;
        params.position =
            glm::dvec3(0.0, 0.0, 2.0 * static_cast<double>(highest) + static_cast<double>(picture.width));
        params.target = glm::dvec3(0.0);
        params.height = static_cast<double>(picture.height);
        camera_ =
            make_camera(params, static_cast<double>(picture.width), static_cast<double>(picture.height), {});
    }

    void render_now(const Progress& progress) {
        frame_ = render({&layer_, 1}, camera_, nullptr, settings_, progress, &cache_);
    }

    /// Takes a channel so many steps on from the rendering; `settle`: with the last one the light of wide
    /// areas is right, too, and what is seen then is returned.
    Image go_on(int channel, int steps, bool settle);
    /// Takes a channel from what is seen to the picture's flux, cell by cell.
    void match_cells(int channel, const Image& seen);
    /// Sum of the squares of what sRGB values differ from the picture's, of some rows.
    double error(int channel, const Image& seen) const;
    double rendered_error(int channel) const { return error(channel, channel_of(frame_.beauty, channel)); }
    double psnr_db(double error_of_all) const;

  private:
    Image target_;  // the picture as the filter shows it
    FlatLight flat_;
    RenderSettings settings_;
    RenderLayer layer_;
    Camera camera_;
    RenderCache cache_;
    RenderedFrame frame_;
};

Image FrontView::go_on(int channel, int steps, bool settle) {
    const Image wanted = channel_of(target_, channel);
    Image seen = channel_of(frame_.beauty, channel);
    const Image share = quotient(seen, flat_.sum(channel));
    const auto seen_now = [&] {
        Image now = flat_.sum(channel);
        multiply(now, share);
        return now;
    };
    for (int step = 0; step < steps; ++step) {
        if (step > 0) seen = seen_now();
        flat_.correct(channel, weighted_ratio(wanted, seen), !settle || step + 1 < steps);
    }
    return settle ? seen_now() : Image{};
}

void FrontView::match_cells(int channel, const Image& seen) {
    const Image cells = cell_ratio(channel_of(target_, channel), seen);
    flat_.multiply(channel, cells, static_cast<double>(cell_px));
}

double FrontView::error(int channel, const Image& seen) const {
    std::vector<double> rows(static_cast<std::size_t>((target_.height + psnr_step - 1) / psnr_step), 0.0);
    parallel_each(rows.size(), 16, [&](std::size_t row) {
        const std::int64_t y = static_cast<std::int64_t>(row) * psnr_step;
        for (std::int64_t x = 0; x < target_.width; ++x) {
            const double difference = static_cast<double>(display_srgb(*seen.at(x, y))) -
                                      static_cast<double>(display_srgb(target_.at(x, y)[channel]));
            rows[row] += difference * difference;
        }
    });
    return std::accumulate(rows.begin(), rows.end(), 0.0);
}

double FrontView::psnr_db(double error_of_all) const {
    const std::int64_t rows = (target_.height + psnr_step - 1) / psnr_step;
    const double mean = error_of_all / (3.0 * static_cast<double>(target_.width * rows));
    return -10.0 / real::log(10.0) * real::log(std::max(mean, 1e-12));
}

}  // namespace

FrontFit fit_front(PictureSplats& dots, Image light, const Progress& progress) {
    FrontView view(dots, light);
    light = {};
    const auto each_channel = [&](const auto& change) {
        for (int channel = 0; channel < 3; ++channel) {
            progress.check();
            change(channel);
        }
    };
    double before = 0.0, after = 0.0;
    view.render_now(progress);
    each_channel([&](int channel) {
        before += view.rendered_error(channel);
        view.go_on(channel, first_steps, false);
    });
    view.render_now(progress);
    each_channel([&](int channel) {
        const Image seen = view.go_on(channel, last_steps, true);
        after += view.error(channel, seen);
        view.match_cells(channel, seen);
    });
    return {first_steps + last_steps, view.psnr_db(before), view.psnr_db(after)};
}

}  // namespace astrosplat

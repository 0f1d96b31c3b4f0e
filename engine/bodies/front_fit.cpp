// Compositing the splats takes long, and what hides what hardly changes with their colours. So they are
// rendered once: then the share of all light that reaches the viewer makes the view out of the splats' flat
// light. (On coarse pixels: a share for every pixel would follow the grain of the splats.) Before, what there
// is too much of is supposed to be hidden. Steps are Richardson and Lucy's, which stay positive and undo the
// splats' own blur; each takes half of the last one along (Polyak's heavy ball, in logarithms), so that seven
// are worth ten without.
#include "bodies/front_fit.h"

#include <numeric>

#include "bodies/detail_picture.h"
#include "camera/camera.h"
#include "core/color.h"
#include "core/parallel.h"
#include "core/real.h"
#include "image/blur.h"
#include "render/render.h"

namespace astrosplat {
namespace {

constexpr double filter_px = 0.5;               // of the output's pixels, as scenes have it
constexpr float sky = 0.002f;                   // added to both sides of a ratio
constexpr float largest_ratio = 4.0f;           // of a step, and its inverse: DEPTH 5
constexpr double largest_cell_ratio = 2.0;      // of a cell's flux, at the end
constexpr int first_steps = 4, last_steps = 3;  // before the rendering and after it
// Of small pictures, which are all detail, and where there is dust, whose details light has to make up for.
constexpr int last_steps_of_detail = 6;
constexpr double share_blur_px = 2.0;  // coarse pixels, of the share that is supposed
constexpr std::int64_t flux_cell_px = 32;
// Of the rendering's records; with more it takes its picture in parts.
constexpr std::int64_t least_projected_bytes = std::int64_t{64} << 20, projected_bytes_a_texel = 12;
constexpr std::int64_t psnr_step = 16;  // rows between those that the PSNR is measured on

glm::dvec3 light_of_cell(const Image& image, std::int64_t column, std::int64_t row) {
    glm::dvec3 sum(0.0);
    for (std::int64_t y = row * flux_cell_px; y < std::min((row + 1) * flux_cell_px, image.height); ++y)
        for (std::int64_t x = column * flux_cell_px; x < std::min((column + 1) * flux_cell_px, image.width);
             ++x)
            for (int c = 0; c < 3; ++c) sum[c] += double(image.at(x, y)[c]);
    return sum;
}

// The ratio of the wanted light to the visible, in cells.
Image cell_ratio(const Image& wanted, const Image& seen) {
    Image cells = make_image((seen.width + flux_cell_px - 1) / flux_cell_px,
                             (seen.height + flux_cell_px - 1) / flux_cell_px, 3);
    parallel_each(cells.height, 1, [&](std::int64_t row) {
        for (std::int64_t column = 0; column < cells.width; ++column) {
            const glm::dvec3 here = light_of_cell(seen, column, row),
                             there = light_of_cell(wanted, column, row);
            for (int c = 0; c < 3; ++c)
                cells.at(column, row)[c] =
                    float(here[c] > 0.0
                              ? std::clamp(there[c] / here[c], 1.0 / largest_cell_ratio, largest_cell_ratio)
                              : 1.0);
        }
    });
    return cells;
}

// The colours of an image of three or more channels over those of `flat`.
Image share_of(const Image& seen, const Image& flat) {
    Image share = unfilled_image(flat.width, flat.height, 3);
    parallel_each(flat.width * flat.height, 65536, [&](std::int64_t i) {
        for (int c = 0; c < 3; ++c)
            share.pixels[3 * i + c] =
                seen.pixels[seen.channels * i + c] / std::max(flat.pixels[3 * i + c], 1e-12f);
    });
    return share;
}

// Texels a pixel of the rendering. Of two, the filter there is as wide as halving, for the share, makes that
// of single texels; but a small picture's points hide less of themselves then than they do where they are
// seen.
std::int64_t rendered_step(const Image& picture, bool small) {
    constexpr std::int64_t most_whole = std::int64_t{1} << 20;  // texels
    return small || picture.width * picture.height <= most_whole ? 1 : 2;
}

// Steps towards an image, each of which takes half of the last one along.
class Steps {
  public:
    explicit Steps(const Image& target) : target_(target) {}

    /// The ratio of what is wanted to what is seen. Its weights make steps those down the square of what
    /// differs as a display shows it, whose values grow by light to the power -.58: so that what is dark
    /// counts beside what is bright.
    Fraction weighted_ratio(Image seen) {
        const bool first = momentum_.pixels.empty();
        if (first) momentum_ = unfilled_image(seen.width, seen.height, 3);
        Fraction ratio{unfilled_image(seen.width, seen.height, 3), std::move(seen)};
        parallel_each(ratio.seen.pixels.size(), 65536, [&](std::size_t i) {
            float& here = ratio.seen.pixels[i];
            here += sky;
            const auto held = [](float r) { return std::clamp(r, 1.0f / largest_ratio, largest_ratio); };
            const float now = held((target_.pixels[i] + sky) / here);
            const float step = first ? now : held(now * momentum_.pixels[i]);
            momentum_.pixels[i] = std::sqrt(step);
            here = 1.0f / std::sqrt(std::sqrt(here));  // about seen^(1 - 2 * .58)
            ratio.wanted.pixels[i] = step * here;
        });
        return ratio;
    }

  private:
    const Image& target_;
    Image momentum_;  // root of the last step's ratio; without pixels before the first step
};

class FittedView {
  public:
    FittedView(PictureSplats& set, const Image& picture, bool small)
        : target_(gaussian_blur(picture, filter_px)), flat_(set, picture.width, picture.height, filter_px) {
        settings_.pixel_filter = float(filter_px);
        layer_.name = "front";
        layer_.splats = &set.splats;
        layer_.absorbs = set.absorbs;
        float highest = 0.0f;
        for (const glm::vec3& p : set.splats.position) highest = std::max(highest, p.z);
        const std::int64_t step = rendered_step(picture, small);
        settings_.width = (picture.width + step - 1) / step;
        settings_.height = (picture.height + step - 1) / step;
        const auto width = double(step * settings_.width),
                   height = double(step * settings_.height);  // texels
        CameraParams params;
        params.projection = Projection::orthographic;
        params.target = 0.5 * glm::dvec3(width - double(picture.width), double(picture.height) - height, 0.0);
        params.position = params.target + glm::dvec3(0.0, 0.0, 2.0 * double(highest) + width);
        params.height = height;
        camera_ = make_camera(params, double(settings_.width), double(settings_.height), {});
        settings_.memory_limit_bytes =
            std::max(least_projected_bytes, projected_bytes_a_texel * picture.width * picture.height);
    }

    /// The visible light if the light that the picture does not have is hidden.
    Image supposed();
    /// The visible light, from a rendering.
    Image rendered(const Progress& progress);
    /// The visible light if the same share of it is hidden as then.
    Image seen() const { return shown(flat_.sum()); }
    /// Takes the colours a step on from what is seen.
    void step_from(Image seen, bool overshoot) {
        flat_.correct(steps_.weighted_ratio(std::move(seen)), overshoot);
    }
    /// Takes them to the picture's flux, cell by cell.
    void match_cells(const Image& seen) { flat_.multiply(cell_ratio(target_, seen), double(flux_cell_px)); }
    /// On sRGB values of some rows.
    double psnr_db(const Image& seen) const;
    /// The share of the flat light that reaches the viewer, as smooth as at half the picture's size.
    const Image& share() const { return share_; }

  private:
    Image shown(Image flat) const;

    Image target_;  // the picture as the filter shows it
    Steps steps_{target_};
    FlatLight flat_;
    RenderSettings settings_;
    RenderLayer layer_;
    Camera camera_;
    Image share_;
};

Image FittedView::supposed() {
    Image flat = flat_.sum();
    share_ = share_of(halved(target_), halved(flat));
    parallel_each(share_.pixels.size(), 65536,
                  [&](std::size_t i) { share_.pixels[i] = std::min(share_.pixels[i], 1.0f); });
    share_ = doubled(gaussian_blur(share_, share_blur_px), flat.width, flat.height);
    return shown(std::move(flat));
}

Image FittedView::rendered(const Progress& progress) {
    share_ = {};
    Image flat = flat_.sum();
    release_spare_pages();  // of the steps
    Image beauty = render({&layer_, 1}, camera_, nullptr, settings_, progress).beauty;
    if (beauty.width == flat.width && beauty.height == flat.height) beauty = halved(beauty);
    share_ = doubled(share_of(beauty, halved(flat)), flat.width, flat.height);
    beauty = {};
    release_spare_pages();
    return shown(std::move(flat));
}

Image FittedView::shown(Image flat) const {
    parallel_each(flat.pixels.size(), 65536, [&](std::size_t i) { flat.pixels[i] *= share_.pixels[i]; });
    return flat;
}

double FittedView::psnr_db(const Image& seen) const {
    std::vector<double> rows(std::size_t((target_.height + psnr_step - 1) / psnr_step), 0.0);
    parallel_each(rows.size(), 16, [&](std::size_t row) {
        const float* const here = seen.at(0, std::int64_t(row) * psnr_step);
        const float* const there = target_.at(0, std::int64_t(row) * psnr_step);
        for (std::int64_t i = 0; i < 3 * target_.width; ++i) {
            const double difference = double(display_srgb(here[i])) - double(display_srgb(there[i]));
            rows[row] += difference * difference;
        }
    });
    const double error = std::accumulate(rows.begin(), rows.end(), 0.0);
    const double mean = error / (3.0 * double(target_.width) * double(rows.size()));
    return -10.0 / real::log(10.0) * real::log(std::max(mean, 1e-12));
}

constexpr int detail_steps = 8;  // DETAIL 4 has 6

// The flat light of those splats that are no detail and no stars.
Image coarser_light(PictureSplats& set, std::int64_t width, std::int64_t height) {
    std::vector<SplatRange> all = set.ranges;
    std::erase_if(set.ranges, [](const SplatRange& range) { return range.of != SplatRange::Of::bands; });
    Image sum = FlatLight(set, width, height, 0.25 * filter_px).sum();
    set.ranges = std::move(all);
    return sum;
}

// Splats of detail that are seen in a part, in its own detail pixels.
struct SeenDetail {
    PictureSplats set;
    std::vector<std::int64_t> row;  // in the whole set; -1: another part's
};

SeenDetail seen_detail(const PictureSplats& all, std::span<const DetailPart> parts, std::size_t number,
                       const glm::vec2& picture) {
    const DetailPart& part = parts[number];
    const Region& shown = part.shown;
    const auto times = float(1 << part.octaves);
    const glm::vec2 size(shown.width, shown.height);
    SeenDetail seen;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const Region& there = parts[p].region;
        if (there.x >= shown.x + shown.width || there.x + there.width <= shown.x ||
            there.y >= shown.y + shown.height || there.y + there.height <= shown.y)
            continue;
        for (const SplatRange& range : parts[p].ranges) {
            const std::int64_t begin = std::ssize(seen.row);
            for (std::int64_t i = range.begin; i < range.end; ++i) {
                const glm::vec3& from = all.splats.position[i];
                const glm::vec2 texel(from.x + 0.5f * picture.x - float(shown.x),
                                      0.5f * picture.y - from.y - float(shown.y));
                if (texel.x < 0.0f || texel.y < 0.0f || texel.x >= size.x || texel.y >= size.y) continue;
                seen.set.splats.position.push_back(
                    {times * (texel.x - 0.5f * size.x), times * (0.5f * size.y - texel.y), 0.0f});
                seen.set.splats.color.push_back(all.splats.color[i]);
                seen.set.splats.alpha.push_back(all.splats.alpha[i]);
                seen.row.push_back(p == number ? i : -1);
            }
            if (std::ssize(seen.row) > begin)
                seen.set.ranges.push_back({begin, std::ssize(seen.row), range.sigma * times, range.of});
        }
    }
    return seen;
}

// Takes the splats of a part's detail on until they and what is coarser, seen through the filter at its own
// pixels, are the part itself: what the filter would take of it is put in before. `colors`: of all splats
// before; what lies in other parts stays as it is.
void fit_part(PictureSplats& all, std::span<const DetailPart> parts, std::size_t number, const Image& coarser,
              const Image& share, Buffer<glm::vec3>& colors) {
    const DetailPart& part = parts[number];
    SeenDetail own = seen_detail(all, parts, number, {coarser.width, coarser.height});
    if (own.row.empty()) return;
    const Image passes = octaves_larger(part_of(share, part.shown), part.octaves),
                below = octaves_larger(part_of(coarser, part.shown), part.octaves);
    FlatLight flat(own.set, part.light.width, part.light.height, filter_px);
    Steps steps(part.light);
    for (int step = 0; step < detail_steps; ++step) {
        Image seen = flat.sum();
        parallel_each(seen.pixels.size(), 65536, [&](std::size_t i) {
            seen.pixels[i] =
                std::max(0.0f, passes.pixels[i]) * (seen.pixels[i] + std::max(0.0f, below.pixels[i]));
        });
        flat.correct(steps.weighted_ratio(std::move(seen)), step + 1 < detail_steps);
    }
    for (std::size_t i = 0; i < own.row.size(); ++i)
        if (own.row[i] >= 0) colors[std::size_t(own.row[i])] = own.set.splats.color[i];
}

}  // namespace

FrontFit fit_front(PictureSplats& set, Image light, bool small, const Progress& progress,
                   std::span<const DetailPart> detail) {
    FittedView view(set, light, small);
    const int steps_after = small || set.absorbs ? last_steps_of_detail : last_steps;
    light = {};
    Image seen = view.supposed();
    for (int step = 0; step < first_steps; ++step) {
        progress.check();
        view.step_from(step == 0 ? std::move(seen) : view.seen(), true);
        progress.at(0.3 * (step + 1) / first_steps);
    }
    seen = view.rendered(progress.part(0.3, 0.7));
    for (int step = 0; step < steps_after; ++step) {
        progress.check();
        view.step_from(std::move(seen), step + 1 < steps_after);
        progress.at(0.7 + 0.3 * (step + 1) / steps_after);
        seen = view.seen();  // after the last step the light of wide areas is right, too
    }
    view.match_cells(seen);
    view.match_cells(view.seen());  // between the cells' middles a factor is that of neither
    if (!detail.empty()) {
        const Image coarser = coarser_light(set, seen.width, seen.height);
        Buffer<glm::vec3> colors = set.splats.color;
        for (std::size_t i = 0; i < detail.size(); ++i) {
            progress.check();
            fit_part(set, detail, i, coarser, view.share(), colors);
        }
        set.splats.color = std::move(colors);
    }
    return {first_steps + steps_after, view.psnr_db(seen)};
}

}  // namespace astrosplat

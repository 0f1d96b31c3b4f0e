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
#include "image/channels.h"
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

    /// The ratio of what is wanted to what is seen. A display's values grow by light to the power -.58, so a
    /// step down the square of what differs there weighs the ratio by seen^(1 - 2 * .58): what is dark counts
    /// beside what is bright. What is too bright is weighed so; for what is to be raised less of that is as
    /// good, and flux is kept. The last step keeps it. Each step asks for every channel once.
    Fraction weighted_ratio(Image seen, int channel, bool last) {
        Image& momentum = momentum_[channel];
        const bool first = momentum.pixels.empty();
        if (first) momentum = unfilled_image(seen.width, seen.height, 1);
        Fraction ratio{unfilled_image(seen.width, seen.height, 1), std::move(seen)};
        parallel_each(momentum.pixels.size(), 65536, [&](std::size_t i) {
            float here = ratio.seen.pixels[i] + sky;
            const auto held = [](float r) { return std::clamp(r, 1.0f / largest_ratio, largest_ratio); };
            const float now = held((target_.pixels[3 * i + channel] + sky) / here);
            const float step = first ? now : held(now * momentum.pixels[i]);
            momentum.pixels[i] = std::sqrt(step);
            const float root = std::sqrt(std::sqrt(here));
            if (!last) here = step < 1.0f ? 1.0f / root : root;
            ratio.seen.pixels[i] = here;
            ratio.wanted.pixels[i] = step * here;
        });
        return ratio;
    }

    /// Takes the colours a step on from what is seen.
    void take(Image seen, FlatLight& flat, bool last) {
        std::array<Image, 3> channels;  // each is used up when it is taken
        for (int c = 0; c < 3; ++c) channels[c] = channel_of(seen, c);
        seen = {};
        for (int c = 0; c < 3; ++c) flat.correct(weighted_ratio(std::move(channels[c]), c, last), c, !last);
        if (last) momentum_ = {};
    }

  private:
    const Image& target_;
    std::array<Image, 3> momentum_;  // root of the last step's ratio; without pixels before the first step
};

class FittedView {
  public:
    FittedView(PictureSplats& set, const Image& picture, bool small)
        : target_(gaussian_blur(picture, filter_px)), flat_(set, picture.width, picture.height, filter_px) {
        settings_.pixel_filter = float(filter_px);
        layer_.name = "front";
        layer_.splats = &set.splats;
        layer_.absorbs = set.absorbs;
        for (const glm::vec3& p : set.splats.position) highest_ = std::max(highest_, p.z);
        stand_at(rendered_step(picture, small));
        settings_.memory_limit_bytes =
            std::max(least_projected_bytes, projected_bytes_a_texel * picture.width * picture.height);
    }

    /// The next rendering has pixels of so many texels a side.
    void stand_at(std::int64_t step);
    /// The visible light if the light that the picture does not have is hidden.
    Image supposed();
    /// The visible light, from a rendering.
    Image rendered(const Progress& progress);
    /// The visible light if the same share of it is hidden as then.
    Image seen() const { return shown(flat_.sum()); }
    /// Takes the colours a step on from what is seen.
    void step_from(Image seen, bool overshoot) { steps_.take(std::move(seen), flat_, !overshoot); }
    /// Takes them to the picture's flux, cell by cell.
    void match_cells(const Image& seen) { flat_.multiply(cell_ratio(target_, seen), double(flux_cell_px)); }
    /// On sRGB values of some rows.
    double psnr_db(const Image& seen) const;
    /// The share of each texel's flat light that reaches the viewer: of detail there are enough splats in
    /// each for it to follow none of them.
    Image share_by_texel(const Progress& progress);

  private:
    Image shown(Image flat) const;

    Image target_;  // the picture as the filter shows it
    Steps steps_{target_};
    FlatLight flat_;
    RenderSettings settings_;
    RenderLayer layer_;
    Camera camera_;
    Image share_;           // of the flat light that reaches the viewer, at half the picture's size
    float highest_ = 0.0f;  // splat, texels
};

void FittedView::stand_at(std::int64_t step) {
    settings_.width = (target_.width + step - 1) / step;
    settings_.height = (target_.height + step - 1) / step;
    const auto width = double(step * settings_.width), height = double(step * settings_.height);  // texels
    CameraParams params;
    params.projection = Projection::orthographic;
    params.target = 0.5 * glm::dvec3(width - double(target_.width), double(target_.height) - height, 0.0);
    params.position = params.target + glm::dvec3(0.0, 0.0, 2.0 * double(highest_) + width);
    params.height = height;
    camera_ = make_camera(params, double(settings_.width), double(settings_.height), {});
}

Image FittedView::supposed() {
    Image flat = flat_.sum();
    share_ = share_of(halved(target_), halved(flat));
    parallel_each(share_.pixels.size(), 65536,
                  [&](std::size_t i) { share_.pixels[i] = std::min(share_.pixels[i], 1.0f); });
    share_ = gaussian_blur(share_, share_blur_px);
    return shown(std::move(flat));
}

Image FittedView::rendered(const Progress& progress) {
    share_ = {};
    release_spare_pages();  // of the steps
    Image beauty = render({&layer_, 1}, camera_, nullptr, settings_, progress).beauty;
    if (beauty.width == target_.width && beauty.height == target_.height) beauty = halved(beauty);
    Image flat = flat_.sum();
    share_ = share_of(beauty, halved(flat));
    beauty = {};
    release_spare_pages();
    return shown(std::move(flat));
}

Image FittedView::share_by_texel(const Progress& progress) {
    stand_at(1);
    const Image flat = flat_.sum();
    return share_of(render({&layer_, 1}, camera_, nullptr, settings_, progress).beauty, flat);
}

Image FittedView::shown(Image flat) const {
    const Image share = doubled(share_, flat.width, flat.height);
    parallel_each(flat.pixels.size(), 65536, [&](std::size_t i) { flat.pixels[i] *= share.pixels[i]; });
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

// Each after a rendering with the last ones: what hides what has changed with them.
constexpr int detail_steps[] = {4, 2, 2};

// The flat light of splats of one sort.
Image flat_light_of(SplatRange::Of sort, PictureSplats& set, std::int64_t width, std::int64_t height,
                    double filter_texels) {
    std::vector<SplatRange> all = set.ranges;
    std::erase_if(set.ranges, [&](const SplatRange& range) { return range.of != sort; });
    Image sum = FlatLight(set, width, height, filter_texels).sum();
    set.ranges = std::move(all);
    return sum;
}

// What all parts are seen with: texels of the whole picture.
struct AboutDetail {
    Image coarser, stars;  // flat light
    Image share;           // of it that reaches the viewer
};

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

// A part's light with what the Gaussians of stars do not show of them, texel by texel.
Image with_lacking_stars(const DetailPart& part, const AboutDetail& about) {
    Image lacking = part_of(about.stars, part.shown);
    const Image share = part_of(about.share, part.shown);
    for (std::size_t i = 0; i < lacking.pixels.size(); ++i)
        lacking.pixels[i] = part.stars.pixels[i] - share.pixels[i] * lacking.pixels[i];
    lacking = octaves_larger(std::move(lacking), part.octaves);
    parallel_each(lacking.pixels.size(), 65536, [&](std::size_t i) {
        lacking.pixels[i] = std::max(0.0f, part.light.pixels[i] + lacking.pixels[i]);
    });
    return lacking;
}

// By what the light of splats of detail, as if nothing hid anything, misses each texel's.
Image texel_ratio(const DetailPart& part, const Image& light, const Image& below, const Image& passes,
                  const Image& flat) {
    constexpr float largest = 2.0f;
    const std::int64_t times = std::int64_t{1} << part.octaves;
    Image ratio = unfilled_image(part.shown.width, part.shown.height, 3);
    for_each_pixel(ratio, [&](std::int64_t x, std::int64_t y) {
        glm::dvec3 wanted(0.0), own(0.0);
        for_each_between(flat, times * x, times * y, times * (x + 1) - 1, times * (y + 1) - 1,
                         [&](std::int64_t i, std::int64_t j) {
                             for (int c = 0; c < 3; ++c) {
                                 const auto share = double(std::max(0.0f, passes.at(i, j)[c]));
                                 wanted[c] += double(light.at(i, j)[c]) -
                                              share * double(std::max(0.0f, below.at(i, j)[c]));
                                 own[c] += share * double(flat.at(i, j)[c]);
                             }
                         });
        for (int c = 0; c < 3; ++c)
            ratio.at(x, y)[c] =
                own[c] > 0.0 ? std::clamp(float(wanted[c] / own[c]), 1.0f / largest, largest) : 1.0f;
    });
    return ratio;
}

// Takes the splats of a part's detail on until they and what is coarser, seen through the filter at its own
// pixels, are the part itself: what the filter would take of it is put in before. `colors`: of all splats
// before; what lies in other parts stays as it is.
void fit_part(PictureSplats& all, std::span<const DetailPart> parts, std::size_t number,
              const AboutDetail& about, int count, Buffer<glm::vec3>& colors) {
    const DetailPart& part = parts[number];
    SeenDetail own = seen_detail(all, parts, number, {about.share.width, about.share.height});
    if (own.row.empty()) return;
    const Image passes = octaves_larger(part_of(about.share, part.shown), part.octaves),
                below = octaves_larger(part_of(about.coarser, part.shown), part.octaves);
    const double times = double(1 << part.octaves);
    FlatLight flat(own.set, part.light.width, part.light.height, filter_px);
    const Image wanted = with_lacking_stars(part, about);
    Steps steps(wanted);
    for (int step = 0; step < count; ++step) {
        Image seen = flat.sum();
        parallel_each(seen.pixels.size(), 65536, [&](std::size_t i) {
            seen.pixels[i] =
                std::max(0.0f, passes.pixels[i]) * (seen.pixels[i] + std::max(0.0f, below.pixels[i]));
        });
        steps.take(std::move(seen), flat, step + 1 == count);
    }
    constexpr int flux_rounds = 5;  // between cells' middles a factor is that of neither
    for (int round = 0; round < flux_rounds; ++round)
        flat.multiply(texel_ratio(part, wanted, below, passes, flat.sum()), times);
    for (std::size_t i = 0; i < own.row.size(); ++i)
        if (own.row[i] >= 0) colors[std::size_t(own.row[i])] = own.set.splats.color[i];
}

}  // namespace

FrontFit fit_front(PictureSplats& set, Image light, bool small, const Progress& progress,
                   std::span<const DetailPart> detail) {
    FittedView view(set, light, small);
    const int steps_after = small || set.absorbs ? last_steps_of_detail : last_steps;
    const std::int64_t width = light.width, height = light.height;
    light = {};
    Image seen = view.supposed();
    for (int step = 0; step < first_steps; ++step) {
        progress.check();
        view.step_from(step == 0 ? std::move(seen) : view.seen(), true);
        progress.at(0.55 * (step + 1) / first_steps);
    }
    seen = view.rendered(progress.part(0.55, 0.7));
    for (int step = 0; step < steps_after; ++step) {
        progress.check();
        view.step_from(std::move(seen), step + 1 < steps_after);
        progress.at(0.7 + 0.3 * (step + 1) / steps_after);
        seen = view.seen();  // after the last step the light of wide areas is right, too
    }
    const double psnr_db = view.psnr_db(seen);
    view.match_cells(seen);
    seen = {};
    view.match_cells(view.seen());  // between the cells' middles a factor is that of neither
    if (!detail.empty()) {
        constexpr double texel_deviation = 0.2887;  // of a square's light, texels
        AboutDetail about;
        about.coarser = flat_light_of(SplatRange::Of::bands, set, width, height, 0.25 * filter_px);
        about.stars = flat_light_of(SplatRange::Of::stars, set, width, height, texel_deviation);
        for (const int count : detail_steps) {
            about.share = view.share_by_texel(progress);
            Buffer<glm::vec3> colors = set.splats.color;
            for (std::size_t i = 0; i < detail.size(); ++i) {
                progress.check();
                fit_part(set, detail, i, about, count, colors);
            }
            set.splats.color = std::move(colors);
        }
    }
    return {first_steps + steps_after, psnr_db};
}

}  // namespace astrosplat

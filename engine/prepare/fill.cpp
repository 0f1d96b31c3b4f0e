// Each hole is solved alone, in its box: averages of known pixels at half the size and so on down to one
// pixel, then back up, each level starting from the coarser one and relaxed a few times. Texture is cloned
// seamlessly: the difference of the two rims is solved for instead (Perez et al. 2003,
// "Poisson image editing").
#include "prepare/stages.h"

#include "core/parallel.h"
#include "core/real.h"

namespace astrosplat {
namespace {

constexpr int sweeps = 24;                                 // of relaxation a level
constexpr float over_relaxation = 1.5f;                    // between 1 and 2, where the sweeps converge
constexpr std::int64_t rim_px = 2;                         // known pixels around a hole that its box takes in
constexpr int directions = 16;                             // in which pieces of texture are looked for
constexpr std::array<double, 3> distances{1.0, 1.6, 2.5};  // of the box's diagonal

// A piece of a picture, some of it unknown. Unknown values are 0 until they are solved.
struct Patch {
    Image image;
    std::vector<unsigned char> known;

    bool is_known(std::int64_t x, std::int64_t y) const { return known[y * image.width + x] != 0; }
};

Patch make_patch(std::int64_t width, std::int64_t height, int channels) {
    return {make_image(width, height, channels), std::vector<unsigned char>(std::size_t(width * height))};
}

// A pixel is the mean of what is known of its four, and known where any of them is.
Patch half_size(const Patch& fine) {
    const int channels = fine.image.channels;
    Patch coarse = make_patch((fine.image.width + 1) / 2, (fine.image.height + 1) / 2, channels);
    for (std::int64_t y = 0; y < fine.image.height; ++y) {
        for (std::int64_t x = 0; x < fine.image.width; ++x) {
            if (!fine.is_known(x, y)) continue;
            float* const to = coarse.image.at(x / 2, y / 2);
            for (int c = 0; c < channels; ++c) to[c] += fine.image.at(x, y)[c];
            ++coarse.known[y / 2 * coarse.image.width + x / 2];
        }
    }
    for (std::size_t i = 0; i < coarse.known.size(); ++i) {
        if (coarse.known[i] == 0) continue;
        float* const to = coarse.image.pixels.data() + i * std::size_t(channels);
        for (int c = 0; c < channels; ++c) to[c] /= float(coarse.known[i]);
        coarse.known[i] = 1;
    }
    return coarse;
}

// Linear between the coarse pixels' centres.
void start_from(const Image& coarse, Image& fine, std::int64_t x, std::int64_t y) {
    const auto other = [](std::int64_t i, std::int64_t n) {
        return std::clamp<std::int64_t>(i % 2 ? i / 2 + 1 : i / 2 - 1, 0, n - 1);
    };
    const std::int64_t far_x = other(x, coarse.width), far_y = other(y, coarse.height);
    for (int c = 0; c < fine.channels; ++c) {
        const float near = 0.75f * coarse.at(x / 2, y / 2)[c] + 0.25f * coarse.at(far_x, y / 2)[c];
        const float far = 0.75f * coarse.at(x / 2, far_y)[c] + 0.25f * coarse.at(far_x, far_y)[c];
        fine.at(x, y)[c] = 0.75f * near + 0.25f * far;
    }
}

// Towards the mean of the neighbours at the four sides and beyond it; those beyond the patch do not count.
void relax(Image& image, std::int64_t x, std::int64_t y) {
    std::array<const float*, 4> around;
    std::size_t count = 0;
    if (x > 0) around[count++] = image.at(x - 1, y);
    if (y > 0) around[count++] = image.at(x, y - 1);
    if (x + 1 < image.width) around[count++] = image.at(x + 1, y);
    if (y + 1 < image.height) around[count++] = image.at(x, y + 1);
    if (count == 0) return;
    for (int c = 0; c < image.channels; ++c) {
        float sum = 0.0f;
        for (std::size_t i = 0; i < count; ++i) sum += around[i][c];
        float& value = image.at(x, y)[c];
        value += over_relaxation * (sum / float(count) - value);
    }
}

void solve_membrane(Patch& patch) {
    std::vector<std::int64_t> unknown;
    for (std::size_t i = 0; i < patch.known.size(); ++i)
        if (patch.known[i] == 0) unknown.push_back(std::int64_t(i));
    if (unknown.empty() || patch.known.size() == 1) return;
    Patch coarse = half_size(patch);
    solve_membrane(coarse);
    const std::int64_t width = patch.image.width;
    for (const std::int64_t i : unknown) start_from(coarse.image, patch.image, i % width, i / width);
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (const std::int64_t i : unknown) relax(patch.image, i % width, i / width);
}

// Where a hole's box lies in the picture, with a rim of known pixels.
Region with_rim(const PixelPart& hole, const Image& image) {
    const std::int64_t left = std::max<std::int64_t>(0, hole.box.x - rim_px);
    const std::int64_t top = std::max<std::int64_t>(0, hole.box.y - rim_px);
    return {left, top, std::min(image.width, hole.box.x + hole.box.width + rim_px) - left,
            std::min(image.height, hole.box.y + hole.box.height + rim_px) - top};
}

Patch patch_of(const Image& image, const PixelMask& holes, const Region& box) {
    Patch patch = make_patch(box.width, box.height, image.channels);
    for (std::int64_t y = 0; y < box.height; ++y) {
        for (std::int64_t x = 0; x < box.width; ++x) {
            if (holes.at(box.x + x, box.y + y)) continue;
            std::copy_n(image.at(box.x + x, box.y + y), image.channels, patch.image.at(x, y));
            patch.known[y * box.width + x] = 1;
        }
    }
    return patch;
}

struct Offset {
    std::int64_t x, y;
};

// How little the piece at an offset looks like the hole's surroundings: the mean squared distance from the
// membrane and, where known, from the picture. Empty where a part of it is not known itself.
std::optional<double> unlikeness(const Image& image, const PixelMask& holes, const Region& box,
                                 const Patch& membrane, const Offset& offset) {
    const std::int64_t left = box.x + offset.x, top = box.y + offset.y;
    if (left < 0 || top < 0 || left + box.width > image.width || top + box.height > image.height) return {};
    double sum = 0.0;
    for (std::int64_t y = 0; y < box.height; ++y) {
        for (std::int64_t x = 0; x < box.width; ++x) {
            if (holes.at(left + x, top + y)) return {};
            for (int c = 0; c < image.channels; ++c) {
                const double d = double(image.at(left + x, top + y)[c] - membrane.image.at(x, y)[c]);
                sum += d * d;
            }
        }
    }
    return sum;
}

std::optional<Offset> best_offset(const Image& image, const PixelMask& holes, const Region& box,
                                  const Patch& membrane) {
    const double size = std::hypot(double(box.width), double(box.height));
    std::optional<Offset> best;
    double least = 0.0;
    for (const double distance : distances) {
        for (int i = 0; i < directions; ++i) {
            const double angle = 2.0 * real::pi * i / directions;
            const Offset offset{std::llround(distance * size * real::cos(angle)),
                                std::llround(distance * size * real::sin(angle))};
            const std::optional<double> found = unlikeness(image, holes, box, membrane, offset);
            if (!found || (best && *found >= least)) continue;
            best = offset;
            least = *found;
        }
    }
    return best;
}

// The piece at an offset, and upon it the membrane of what the rims differ by.
void clone(const Image& image, const Region& box, const Offset& offset, Patch& patch) {
    const auto piece = [&](std::size_t i) {
        const auto at = std::int64_t(i);
        return image.at(box.x + offset.x + at % box.width, box.y + offset.y + at / box.width);
    };
    const auto channels = std::size_t(image.channels);
    for (std::size_t i = 0; i < patch.known.size(); ++i)
        for (std::size_t c = 0; c < channels && patch.known[i]; ++c)
            patch.image.pixels[i * channels + c] -= piece(i)[c];
    solve_membrane(patch);
    for (std::size_t i = 0; i < patch.known.size(); ++i)
        for (std::size_t c = 0; c < channels; ++c) patch.image.pixels[i * channels + c] += piece(i)[c];
}

// Reads known pixels alone and writes those of the hole: holes can be filled in any order.
void fill_hole(Image& image, const PixelMask& holes, const PixelPart& hole, FillKind kind) {
    const Region box = with_rim(hole, image);
    const Patch rim = patch_of(image, holes, box);
    Patch filled = rim;
    solve_membrane(filled);
    if (kind == FillKind::texture) {
        if (const std::optional<Offset> offset = best_offset(image, holes, box, filled)) {
            filled = rim;
            clone(image, box, *offset, filled);
        }
    }
    for (const std::int64_t i : hole.pixels) {
        const std::int64_t x = i % image.width, y = i / image.width;
        std::copy_n(filled.image.at(x - box.x, y - box.y), image.channels, image.at(x, y));
    }
}

}  // namespace

void fill(Image& image, const PixelMask& holes, FillKind kind, const Progress& progress) {
    std::vector<PixelPart> parts = connected_parts(holes);
    parallel_each(parts.size(), 1, [&](std::size_t i) {
        progress.check();
        std::ranges::sort(parts[i].pixels);
        fill_hole(image, holes, parts[i], kind);
    });
}

}  // namespace astrosplat

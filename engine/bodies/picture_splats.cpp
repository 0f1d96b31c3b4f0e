#include "bodies/picture_splats.h"

#include "core/real.h"
#include "core/shared_maths.h"
#include "image/channels.h"
#include "splats/splat_set.h"

namespace astrosplat {
namespace {

using shared::as_exp, shared::as_log, shared::as_pow, shared::as_uniform;

constexpr float cell_jitter = 0.5f;         // of the lattice's spacing
constexpr float least_brightness = 0.002f;  // below which opacity falls to 0: empty sky hides nothing
constexpr float greatest_opacity = 0.985f;
constexpr float star_opacity = 0.25f;     // of a star's own
constexpr float spheroid_hiding = 0.35f;  // share of its optical depth that a spheroid keeps (INCLINED 3)
constexpr float glow_hiding = 0.47f;      // and the glow between two walls

// A splat before it has a depth.
struct Candidate {
    float x, y;           // texels from the top left corner
    glm::vec3 light;      // of its footprint
    float amplitude;      // the brightest of it
    float brightest;      // of the picture there
    float opacity_limit;  // the picture's alpha
    std::uint64_t id;
};

// Share of the optical depth that splats keep. A bulge, old stars without dust, glows: seen from the side,
// light comes from all of its depth, not from a surface as a cloud's would. So does what is between two
// walls: were it a fog, the fit would raise the filaments of the back wall by what is lost in it, and from
// behind they would burn out.
float hiding_of(const BandSplats& splats) {
    return splats.family == GalaxyFamily::spheroid ? spheroid_hiding : splats.glow ? glow_hiding : 1.0f;
}

// The optical depth a splat adds to its column is its share of the column's light.
void shade(const Candidate& splat, float hiding, float footprint, const Opacity& opacity, std::size_t at,
           ShadedSplats& out) {
    const float brightest = std::max(least_brightness, splat.brightest);
    const float tau = hiding * opacity.depth_of(splat.brightest, splat.opacity_limit);
    const float alpha = std::clamp(tau * (splat.amplitude / brightest) / footprint, 1e-6f, 1.0f);
    out.alpha[at] = alpha;
    out.color[at] = splat.light * (boost_of(tau) / (alpha * footprint));
    out.id[at] = splat.id;
}

// The splats of a band that are of one size.
struct BandMaker {
    const BandLight& band;
    const BandSplats& splats;
    const Image &picture, &alpha;
    const Placement& placement;
    const Opacity& opacity;
    SplatLattice lattice{picture.width, picture.height, splats.spacing, band.region};

    // A cell's splat, where there is light and it is not thinned out.
    std::optional<Candidate> candidate_of(const LatticeCell& cell) const {
        Candidate splat;
        splat.id = std::uint64_t(splats.number) << band_bit | std::uint64_t(splats.size) << size_bit;
        splat.id += lattice.number(cell);
        const auto place_in = [&](std::int64_t step, std::uint32_t purpose) {
            const float random = as_uniform(placement.hash_of(splat.id, purpose));
            return (float(step) + 0.5f + cell_jitter * (random - 0.5f)) * splats.spacing;
        };
        splat.x = place_in(cell.column, shared::PURPOSE_JITTER_X);
        splat.y = place_in(cell.row, shared::PURPOSE_JITTER_Y);
        const Region& part = band.region;
        if (splat.x < float(part.x) || splat.x >= float(part.x + part.width) || splat.y < float(part.y) ||
            splat.y >= float(part.y + part.height))
            return {};
        if (splats.index == 0 && placement.detail.at(splat.x, splat.y) != splats.octaves) return {};
        const LinearSample place(picture, splat.x, splat.y);
        const LinearSample fine(band.light, (splat.x - float(band.shown.x)) * band.times,
                                (splat.y - float(band.shown.y)) * band.times);
        splat.light = share_of(placement, splats, splat.x, splat.y) *
                      glm::vec3(fine.of(band.light, 0), fine.of(band.light, 1), fine.of(band.light, 2));
        splat.amplitude = std::max({splat.light.x, splat.light.y, splat.light.z});
        if (splat.amplitude <= 0.0f) return {};
        splat.opacity_limit = alpha.pixels.empty() ? 1.0f : place.of(alpha);
        if (splat.opacity_limit <= 0.0f) return {};
        splat.brightest = place.brightest_of(picture);
        const float kept = kept_share(splat.amplitude, splat.brightest, splats);
        if (as_uniform(placement.hash_of(splat.id, shared::PURPOSE_DENSITY)) >= kept) return {};
        const float gain = splats.spacing * splats.spacing / kept;
        splat.light *= gain;
        splat.amplitude *= gain;
        return splat;
    }

    void make_splats(std::span<const LatticeCell> cells, std::size_t first, PictureSplats& out) const {
        const float footprint = footprint_share * float(2.0 * real::pi) * splats.sigma * splats.sigma;
        const std::uint32_t even_key = placement.hash_of(
            std::uint64_t(splats.number) << 8 | std::uint64_t(splats.size), shared::PURPOSE_EVEN);
        PlacedBlock block;
        block.count = int(cells.size());
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const Candidate splat = *candidate_of(cells[i]);
            block.x[i] = splat.x;
            block.y[i] = splat.y;
            block.random[i] = placement.hash_of(splat.id, shared::PURPOSE_DEPTH);
            block.even[i] = even_number(cells[i], even_key);
            shade(splat, hiding_of(splats), footprint, opacity, first + i, out.splats);
        }
        place(placement, splats, block);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            out.splats.position[first + i] = placement.among_splats(block.x[i], block.y[i], block.z[i]);
            out.distance[first + i] = block.distance[i];
            if (placement.axis)
                out.splats.color[first + i] *= placement.axis->tint(block.x[i], block.y[i], block.z[i]);
        }
    }
};

std::uint32_t reversed_bits(std::uint32_t n) {
    n = n >> 16 | n << 16;
    n = (n & 0xff00ff00u) >> 8 | (n & 0x00ff00ffu) << 8;
    n = (n & 0xf0f0f0f0u) >> 4 | (n & 0x0f0f0f0fu) << 4;
    n = (n & 0xccccccccu) >> 2 | (n & 0x33333333u) << 2;
    return (n & 0xaaaaaaaau) >> 1 | (n & 0x55555555u) << 1;
}

// A permutation in which a bit depends on it and on the lower ones alone (Laine and Karras 2011).
std::uint32_t mixed_upwards(std::uint32_t n, std::uint32_t key) {
    n += key;
    n ^= n * 0x6c50b47cu;
    n ^= n * 0xb82f1e52u;
    n ^= n * 0xc7afe638u;
    return n ^ n * 0x8d22f6e6u;
}

// The same from the highest bit down: aligned blocks of cells change places, and halves of these within them.
std::uint32_t scrambled(std::int64_t number, std::uint32_t key) {
    return reversed_bits(mixed_upwards(reversed_bits(std::uint32_t(number)), key));
}

// Bit k becomes the parity of those bits j of n of which binomial(k, j) is odd: of subsets of k (Lucas).
std::uint32_t by_pascal(std::uint32_t n) {
    n ^= (n & 0x55555555u) << 1;
    n ^= (n & 0x33333333u) << 2;
    n ^= (n & 0x0f0f0f0fu) << 4;
    n ^= (n & 0x00ff00ffu) << 8;
    return n ^ n << 16;
}

}  // namespace

float even_number(const LatticeCell& cell, std::uint32_t key) {
    const std::uint32_t n =
        scrambled(cell.column, key) ^ by_pascal(scrambled(cell.row, shared::as_mix(key + 1u)));
    return as_uniform(reversed_bits(mixed_upwards(n, shared::as_mix(key + 2u))));
}

void reserve_splats(PictureSplats& set, std::int64_t count) {
    const auto size = std::size_t(count);
    for_each_array(set.splats, [&](auto& values) { values.reserve(size); });
    set.distance.reserve(size);
}

void resize_splats(PictureSplats& set, std::int64_t count) {
    const auto size = std::size_t(count);
    for_each_array(set.splats, [&](auto& values) { values.resize(size); });
    set.distance.resize(size);
}

float kept_share(float amplitude, float brightest, const BandSplats& splats) {
    constexpr float dark_sky = 0.03f;  // DEPTH 3
    return std::min(1.0f, amplitude / (splats.threshold * (brightest + dark_sky)));
}

float Opacity::depth_of(float brightest, float alpha) const {
    float hidden = std::min(greatest_opacity, density * as_pow(std::max(least_brightness, brightest), power));
    if (brightest < least_brightness) hidden *= brightest / least_brightness;
    return -as_log(1.0f - std::min(hidden, alpha));
}

float boost_of(float tau) { return tau > 1e-4f ? tau / (1.0f - as_exp(-tau)) : 1.0f; }

SplatRange add_band(const BandLight& band, const BandSplats& splats, const Image& picture, const Image& alpha,
                    const Placement& placement, const Opacity& opacity, PictureSplats& out) {
    out.ranges.push_back(
        add_on_lattice(BandMaker{band, splats, picture, alpha, placement, opacity}, splats.sigma, out));
    if (splats.octaves > 0) out.ranges.back().of = SplatRange::Of::detail;
    return out.ranges.back();
}

namespace {

// Those of about one size. `first_number`: in ids.
void add_stars(std::span<const Star> stars, std::size_t first_number, const Placement& placement,
               const Opacity& opacity, PictureSplats& out) {
    const std::int64_t begin = out.splats.size();
    resize_splats(out, begin + std::ssize(stars));
    double sigmas = 0.0;
    for (std::size_t i = 0; i < stars.size(); ++i) {
        const Star& star = stars[i];
        const std::size_t at = std::size_t(begin) + i;
        const float spread = star_height(placement, star);
        const float peak = std::max({star.peak.x, star.peak.y, star.peak.z, 1e-6f});
        const float alpha =
            std::clamp(star_opacity * opacity.depth_of(peak, 1.0f) / footprint_share, 1e-3f, 1.0f);
        out.splats.position[at] =
            placement.among_splats(star.x, star.y, spread + middle_plane(placement, star.x, star.y));
        out.splats.color[at] = star.peak / alpha;
        out.splats.alpha[at] = alpha;
        out.splats.radius[at] = radius_sigmas * star.sigma;
        out.splats.id[at] = star_band << band_bit | (first_number + i);
        out.distance[at] = std::fabs(spread);
        sigmas += double(star.sigma);
    }
    out.ranges.push_back(
        {begin, out.splats.size(), float(sigmas / double(stars.size())), SplatRange::Of::stars});
}

}  // namespace

void add_picture_stars(const PictureStars& stars, const Placement& placement, const Opacity& opacity,
                       PictureSplats& out) {
    constexpr float about_one_size = 1.4f;  // widest over narrowest: each more takes the front's fit longer
    const std::span<const Star> all(stars.all.data(), stars.taken);
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
        const bool ordinary = begin < stars.ordinary;
        const float widest = ordinary ? about_one_size * all[begin].sigma : all[begin].sigma;
        while (end < (ordinary ? stars.ordinary : all.size()) && all[end].sigma <= widest) ++end;
        add_stars(all.subspan(begin, end - begin), begin, placement, opacity, out);
    }
}

void add_spikes(std::span<const SpikeLight> spikes, std::span<const glm::vec2> places, int part, int times,
                const Placement& placement, const Opacity& opacity, PictureSplats& out) {
    if (spikes.empty()) return;
    constexpr float sigma = 0.45f;  // texels, as of the finest band: one range with its splats
    constexpr float footprint = footprint_share * float(2.0 * real::pi) * sigma * sigma;
    std::vector<float> heights;
    for (const glm::vec2& place : places) heights.push_back(star_height(placement, {place.x, place.y}));
    const auto begin = std::size_t(out.splats.size());
    resize_splats(out, std::int64_t(begin + spikes.size()));
    const std::int64_t columns = placement.picture_width / times + 1;
    parallel_each(spikes.size(), 4096, [&](std::size_t i) {
        const SpikeLight& spike = spikes[i];
        const glm::vec2& star = places[std::size_t(spike.star)];
        const float height = heights[std::size_t(spike.star)];
        const float most = std::max({spike.light.x, spike.light.y, spike.light.z});
        const float alpha = std::clamp(star_opacity * opacity.depth_of(most, 1.0f) / footprint, 1e-3f, 1.0f);
        out.splats.position[begin + i] = placement.among_splats(
            (float(spike.column) + 0.5f) * float(times), (float(spike.row) + 0.5f) * float(times),
            height + middle_plane(placement, star.x, star.y));
        out.splats.color[begin + i] = spike.light / (alpha * footprint);
        out.splats.alpha[begin + i] = alpha;
        out.splats.radius[begin + i] = radius_sigmas * sigma * float(times);
        out.splats.id[begin + i] = spike_band << band_bit | std::uint64_t(part) << size_bit |
                                   std::uint64_t(spike.row * columns + spike.column);
        out.distance[begin + i] = std::fabs(height);
    });
    out.ranges.push_back(
        {std::int64_t(begin), out.splats.size(), sigma * float(times), SplatRange::Of::stars});
}

}  // namespace astrosplat

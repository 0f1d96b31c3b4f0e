// Counting into bins; the pictures are read again, because a set no longer knows their values.
#include "viewer/histograms.h"
#include "source/obj.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "source/fits.h"
#include "source/mesh.h"
#include "source/picture.h"
#include "source/stretch.h"

namespace astrosplat {
namespace {

using Values = LayerHistograms::Values;
constexpr int bins = LayerHistograms::bins;

/// Counts over lo .. hi; what lies outside or is not a number is left out.
class Counter {
  public:
    Counter(double lo, double hi) : lo_(lo), bins_per_unit_(hi > lo ? bins / (hi - lo) : 0.0) {}

    void add(double value) {
        const double bin = (value - lo_) * bins_per_unit_;
        if (!(bin >= 0.0 && bin <= bins)) return;
        ++counts_[static_cast<std::size_t>(std::min(bin, bins - 1.0))];
    }

    /// Share of the fullest bin.
    template <class Array>
    void write(Array& shares) const {
        const double most = static_cast<double>(*std::max_element(counts_.begin(), counts_.end()));
        for (std::size_t i = 0; i < counts_.size(); ++i)
            shares[i] = most > 0.0 ? static_cast<float>(static_cast<double>(counts_[i]) / most) : 0.0f;
    }

  private:
    double lo_, bins_per_unit_;
    std::array<std::int64_t, bins> counts_{};
};

/// The range of FITS data worth showing: half as much again beyond black and white, for stars and cosmic rays
/// would squeeze everything else into one bin.
Values fits_values(const std::filesystem::path& file, const TextureSettings& settings) {
    const FitsPlane plane = read_fits(file, settings.hdu, settings.plane);
    const ValueRange range = value_range(plane.values);
    const Limits automatic = choose_limits(range, TextureSettings{}, file.string());
    const double margin = 0.5 * (automatic.white - automatic.black);
    Values values;
    values.black = automatic.black;
    values.white = automatic.white;
    values.lo = std::max(range.min, automatic.black - margin);
    values.hi = std::max(std::min(range.max, automatic.white + margin), automatic.white);
    Counter counter(values.lo, values.hi);
    for (const double value : plane.values) counter.add(value);
    values.share.resize(bins);
    counter.write(values.share);
    return values;
}

Values picture_values(const std::filesystem::path& file) {
    const Picture picture = read_picture(file);
    const int channels = picture.image.channels;
    const Buffer<float>& pixels = picture.image.pixels;
    const auto largest_at = [&](std::size_t i) {
        return std::max({pixels[i], pixels[i + 1], pixels[i + 2]});
    };
    Values values;
    for (std::size_t i = 0; i < pixels.size(); i += static_cast<std::size_t>(channels))
        if (std::isfinite(largest_at(i))) values.hi = std::max(values.hi, double(largest_at(i)));
    Counter counter(values.lo, values.hi);
    for (std::size_t i = 0; i < pixels.size(); i += static_cast<std::size_t>(channels))
        counter.add(largest_at(i));
    values.share.resize(bins);
    counter.write(values.share);
    return values;
}

/// Empty: none is named, or the mesh's own.
std::filesystem::path first_picture(const SourceParams& source) {
    if (source.kind != SourceKind::mesh || source.meshes.empty()) return {};
    const MeshInput& input = source.meshes.front();
    if (!input.texture.empty() && !input.texture.front().empty()) return input.texture.front();
    if (is_builtin_mesh(input.mesh)) return {};
    for (const std::filesystem::path& map : load_obj(input.mesh).maps)
        if (!map.empty()) return map;
    return {};
}

}  // namespace

LayerHistograms histograms(const SplatSet& set, const SourceParams& source) {
    LayerHistograms result;
    result.max_distance = set.max_distance;
    Counter counter(0.0, set.max_distance);
    for (const float distance : set.distance) counter.add(distance);
    counter.write(result.distance);
    try {
        const std::filesystem::path file = first_picture(source);
        if (!file.empty())
            result.values = is_fits(file) ? fits_values(file, source.texture) : picture_values(file);
    } catch (const InputError&) {
        // It was readable when the set was made; the next generation will say what is wrong with it now.
    }
    return result;
}

glm::dvec2 unset_radius(const SplatSet& set) {
    if (!set.radius.empty()) {
        const auto [least, most] = std::minmax_element(set.radius.begin(), set.radius.end());
        return {*least, *most};
    }
    const glm::dvec3 s = set.spacing;
    return glm::dvec2(0.6 * std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z));
}

}  // namespace astrosplat

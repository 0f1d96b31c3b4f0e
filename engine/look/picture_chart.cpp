// A least-squares plane says how places follow from u and v; its metric turns a width into steps of u and v.
// A sample of the set says for each block and its neighbours how places follow from u and v, and so how many
// cells a footprint is wide.
#include "look/picture_fit.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/parallel.h"
#include "look/shared_look.h"

namespace astrosplat {
namespace {

struct SurfaceSample {
    glm::dvec2 at{0.0};            // u and v
    glm::dvec3 place{0.0};         // scene units
    double light = 0.0, r2 = 0.0;  // how much of a splat is expected there, and its squared radius
};

using SurfaceSamples = std::vector<SurfaceSample>;

struct SurfaceMetric {
    double sigma_u = 0.0, sigma_v = 0.0;  // standard deviations of a footprint, in units of u and v
    double area = 0.0;                    // square scene units under a unit square of u and v; 0: not known
};

// A map's value as the kernel and cards read it.
glm::vec3 map_value(const Image& map, const glm::vec2& uv) {
    const int width = int(map.width), height = int(map.height);
    const float x = shared::look_texel(uv.x, width), y = shared::look_texel(1.0f - uv.y, height);
    const int x0 = int(x), y0 = int(y);
    const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
    glm::vec3 value;
    for (int c = 0; c < 3; ++c) {
        const int from = map.channels >= 3 ? c : 0;
        value[c] = shared::look_bilinear(map.at(x0, y0)[from], map.at(x1, y0)[from], map.at(x0, y1)[from],
                                         map.at(x1, y1)[from], x - std::floor(x), y - std::floor(y));
    }
    return value;
}

}  // namespace

OneSplat look_at(const LookRun& run, const PreparedLook& uniforms, std::int64_t i) {
    const LookColumns& in = run.in;
    shared::LookInput s{};
    s.position = in.position[i];
    s.color = in.color[i];
    s.alpha = in.alpha[i];
    s.from_surface = in.distance[i];
    s.radius = uniforms.radius.own ? in.radius[i] : 0.0f;
    s.map_value = uniforms.stop_count > 1 ? map_value(*run.map, in.uv[i]) : glm::vec3(0.0f);
    s.id_low = std::uint32_t(in.id[i]);
    s.id_high = std::uint32_t(in.id[i] >> 32);
    s.outlined = outlined(uniforms, in.position[i]);
    const shared::LookOutput look = shared::look_splat(uniforms, s);
    return {look.keep, look.probability, look.color, look.alpha, look.radius};
}

namespace {

constexpr double least_samples = 8.0;  // of a block, for a plane through them
constexpr double share_about_one = 0.125, share_on_surface = 0.75;
constexpr double least_part = 24.0;  // samples

// Places as a linear function of u and v, by least squares, and the direction in which they lie off it.
struct Plane {
    glm::dvec2 middle{0.0};
    glm::dvec3 place{0.0}, along_u{0.0}, along_v{0.0}, normal{0.0};
    bool known = false;
};

void fit_slopes(const SurfaceSamples& samples, std::size_t count, Plane& plane) {
    for (std::size_t i = 0; i < count; ++i) plane.middle += samples[i].at, plane.place += samples[i].place;
    plane.middle /= double(count), plane.place /= double(count);
    double uu = 0.0, uv = 0.0, vv = 0.0;
    glm::dvec3 pu(0.0), pv(0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec2 d = samples[i].at - plane.middle;
        uu += d.x * d.x, uv += d.x * d.y, vv += d.y * d.y;
        pu += (samples[i].place - plane.place) * d.x, pv += (samples[i].place - plane.place) * d.y;
    }
    const double spread = uu * vv - uv * uv;
    plane.known = uu > 0.0 && vv > 0.0 && spread > 1e-6 * uu * vv;
    if (!plane.known) return;
    plane.along_u = (pu * vv - pv * uv) / spread, plane.along_v = (pv * uu - pu * uv) / spread;
}

glm::dvec3 off_plane(const Plane& plane, const SurfaceSample& sample) {
    const glm::dvec2 d = sample.at - plane.middle;
    return sample.place - plane.place - plane.along_u * d.x - plane.along_v * d.y;
}

// Where positions lie off the plane most, by powers of their covariance. The plane itself leans by chance,
// where a thick layer has few samples; its slopes along the normal are that chance.
void find_normal(const SurfaceSamples& samples, std::size_t count, Plane& plane) {
    glm::dmat3 covariance(0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 off = off_plane(plane, samples[i]);
        for (int c = 0; c < 3; ++c) covariance[c] += off * off[c];
    }
    int most = 0;
    for (int c = 1; c < 3; ++c)
        if (covariance[c][c] > covariance[most][most]) most = c;
    glm::dvec3 normal = covariance[most];
    for (int n = 0; n < 16 && glm::dot(normal, normal) > 0.0; ++n) {
        normal /= std::sqrt(glm::dot(normal, normal));
        normal = covariance[0] * normal.x + covariance[1] * normal.y + covariance[2] * normal.z;
    }
    const double length = std::sqrt(glm::dot(normal, normal));
    plane.normal = length > 0.0 ? normal / length : glm::dvec3(0.0);
    plane.along_u -= plane.normal * glm::dot(plane.along_u, plane.normal);
    plane.along_v -= plane.normal * glm::dot(plane.along_v, plane.normal);
}

Plane plane_through(const SurfaceSamples& samples, std::size_t count) {
    Plane plane;
    if (double(count) < least_samples) return plane;
    fit_slopes(samples, count, plane);
    if (plane.known) find_normal(samples, count, plane);
    return plane;
}

// Squared distance along the plane from where u and v put a sample.
double astray(const Plane& plane, const SurfaceSample& sample) {
    const glm::dvec3 off = off_plane(plane, sample);
    const double across = glm::dot(off, plane.normal);
    return glm::dot(off, off) - across * across;
}

// The part that lies about one of them: other parts of the mesh may have the same u and v. Of these the ones
// that are most astray are left out: positions beyond the edge of a mesh have the edge's u and v.
Plane surface_plane(SurfaceSamples& samples, const glm::dvec2& middle) {
    const auto first = [&](double share) {
        const double part = double(samples.size()) * share;
        return std::ptrdiff_t(std::min(double(samples.size()), std::max(part, least_part)));
    };
    if (samples.empty()) return {};
    const auto off = [](const auto& d) { return glm::dot(d, d); };
    const glm::dvec3 about = std::ranges::min_element(samples, {}, [&](const SurfaceSample& s) {
                                 return off(s.at - middle);
                             })->place;
    const std::ptrdiff_t near = first(share_about_one), kept = first(share_about_one * share_on_surface);
    std::ranges::nth_element(samples, samples.begin() + near, {},
                             [&](const SurfaceSample& s) { return off(s.place - about); });
    Plane plane = plane_through(samples, std::size_t(near));
    for (int round = 0; round < 2 && plane.known; ++round) {
        std::ranges::nth_element(samples.begin(), samples.begin() + kept, samples.begin() + near, {},
                                 [&](const SurfaceSample& s) { return astray(plane, s); });
        plane = plane_through(samples, std::size_t(kept));
    }
    return plane;
}

// Of the part of the surface about the sample that is nearest to `middle` in u and v. `falloff_variance`:
// along an axis, square radii. Reorders the samples.
SurfaceMetric surface_metric(SurfaceSamples& samples, const glm::dvec2& middle, double falloff_variance) {
    const Plane plane = surface_plane(samples, middle);
    double light = 0.0, light_r2 = 0.0;
    for (const SurfaceSample& s : samples) light += s.light, light_r2 += s.light * s.r2;
    if (!plane.known || !(light > 0.0)) return {};
    const double e = glm::dot(plane.along_u, plane.along_u), f = glm::dot(plane.along_u, plane.along_v),
                 g = glm::dot(plane.along_v, plane.along_v);
    const double determinant = e * g - f * f;
    if (!(determinant > 1e-6 * e * g)) return {};
    const double variance = falloff_variance * light_r2 / light;
    return {std::sqrt(variance * g / determinant), std::sqrt(variance * e / determinant),
            std::sqrt(determinant)};
}

constexpr std::int64_t most_sampled = 1 << 17;  // positions
constexpr std::int64_t most_cells = 1 << 22;    // of all meshes
constexpr double widest_sigma = 8.0;            // cells; wider ones only cost
constexpr float edge_width = 2e-6f;             // of the picture: what rounding leaves
constexpr std::uint32_t purpose_sample = 0x706373u;

float part_of(float x) {
    const float part = x - std::floor(x);
    return part == 0.0f && x > 0.0f ? 1.0f : part;  // the right edge of the picture is not its left
}

std::int64_t mesh_of(const SplatSet& set, std::int64_t i) { return set.mesh.empty() ? 0 : set.mesh[i]; }

std::int64_t place_along(float x, std::int64_t size) {
    return std::min(size - 1, std::int64_t(part_of(x) * float(size)));
}

// A sample of the set, by blocks.
std::vector<SurfaceSamples> sampled(const LookRun& run, const SplatSet& set, std::int64_t meshes) {
    std::vector<SurfaceSamples> samples(std::size_t(meshes * chart_side * chart_side));
    const std::int64_t step = std::max<std::int64_t>(1, set.size() / most_sampled);
    for (std::int64_t from = 0; from + step <= set.size(); from += step) {
        // Anywhere in the step, since a set is in rows.
        const auto low = std::uint32_t(from), high = std::uint32_t(from >> 32);
        const std::int64_t i = from + shared::as_hash(1u, low, high, purpose_sample) % step;
        if (PictureChart::on_edge(set, i)) continue;
        const OneSplat look = look_at(run, run.uniforms, i);
        const glm::vec2 uv = set.uv[i];
        const std::int64_t row = place_along(uv.y, chart_side), column = place_along(uv.x, chart_side);
        const double r2 = double(look.radius) * double(look.radius);
        const double light = double(look.probability) * double(look.alpha) * r2;
        samples[(mesh_of(set, i) * chart_side + row) * chart_side + column].push_back(
            {{part_of(uv.x), part_of(uv.y)}, set.position[i], light, r2});
    }
    return samples;
}

// Of a block and its neighbours.
SurfaceSamples around(const std::vector<SurfaceSamples>& samples, std::int64_t block) {
    const std::int64_t row = block / chart_side % chart_side, column = block % chart_side;
    SurfaceSamples result;
    for (std::int64_t y = std::max<std::int64_t>(0, row - 1); y <= std::min(chart_side - 1, row + 1); ++y)
        for (std::int64_t x = std::max<std::int64_t>(0, column - 1);
             x <= std::min(chart_side - 1, column + 1); ++x) {
            const SurfaceSamples& own = samples[block + (y - row) * chart_side + x - column];
            result.insert(result.end(), own.begin(), own.end());
        }
    return result;
}

glm::dvec2 middle_of(std::int64_t block) {
    const auto side = double(chart_side);
    return {(double(block % chart_side) + 0.5) / side,
            (double(block / chart_side % chart_side) + 0.5) / side};
}

// Cells as wide as a footprint's standard deviation in the mean, if there may be so many.
void choose_cells(const std::vector<SurfaceMetric>& metrics, std::int64_t positions, PictureChart& chart) {
    double columns = 0.0, rows = 0.0, known = 0.0;
    for (const SurfaceMetric& m : metrics) {
        if (m.area == 0.0) continue;
        columns += 1.0 / m.sigma_u, rows += 1.0 / m.sigma_v, known += 1.0;
    }
    if (known == 0.0) return;
    columns /= known, rows /= known;
    const auto most = double(std::min(positions, most_cells)) / double(chart.meshes);
    const double less = std::min(1.0, std::sqrt(most / (columns * rows)));
    columns = std::clamp(columns * less, 1.0, most), rows = std::clamp(rows * less, 1.0, most / columns);
    chart.columns = std::int64_t(columns), chart.rows = std::int64_t(rows);
}

ChartBlock block_of(const SurfaceMetric& m, const PictureChart& chart) {
    const auto columns = double(chart.columns), rows = double(chart.rows);
    return {std::min(widest_sigma, m.sigma_u * columns), std::min(widest_sigma, m.sigma_v * rows),
            m.area / (columns * rows)};
}

SurfaceMetric mean_of_known(const std::vector<SurfaceMetric>& metrics) {
    SurfaceMetric mean;
    double known = 0.0;
    for (const SurfaceMetric& m : metrics) {
        if (m.area == 0.0) continue;
        mean.sigma_u += m.sigma_u, mean.sigma_v += m.sigma_v, mean.area += m.area, known += 1.0;
    }
    return {mean.sigma_u / known, mean.sigma_v / known, mean.area / known};
}

}  // namespace

std::int64_t PictureChart::cell_of(const SplatSet& set, std::int64_t i) const {
    const glm::vec2 uv = set.uv[i];
    return (mesh_of(set, i) * rows + place_along(uv.y, rows)) * columns + place_along(uv.x, columns);
}

bool PictureChart::on_edge(const SplatSet& set, std::int64_t i) {
    const auto ends = [](float x) {
        const float part = part_of(x);
        return part < edge_width || part > 1.0f - edge_width;
    };
    return ends(set.uv[i].x) || ends(set.uv[i].y);
}

PictureChart picture_chart(const LookRun& run, const SplatSet& set, double falloff_variance) {
    PictureChart chart;
    const std::int64_t meshes = set.mesh.empty() ? 1 : std::int64_t(*std::ranges::max_element(set.mesh)) + 1;
    const std::vector<SurfaceSamples> samples = sampled(run, set, meshes);
    std::vector<SurfaceMetric> metrics(samples.size());
    parallel_for(std::int64_t(samples.size()), [&](std::int64_t block, int) {
        SurfaceSamples about = around(samples, block);
        metrics[block] = surface_metric(about, middle_of(block), falloff_variance);
    });
    chart.meshes = meshes;
    choose_cells(metrics, set.size(), chart);
    if (chart.columns == 0 || chart.rows == 0) return {};
    const SurfaceMetric mean = mean_of_known(metrics);
    for (const SurfaceMetric& m : metrics) chart.blocks.push_back(block_of(m.area == 0.0 ? mean : m, chart));
    return chart;
}

}  // namespace astrosplat

#include "render/footprint.h"

#include "core/parallel.h"

namespace astrosplat {
namespace {

/// Integral of w(t) f(t) from 0 to 1.
template <class F>
double integral_with(const Falloff& falloff, const F& f) {
    constexpr double ends[] = {0.0, 0.01, 0.03, 0.1, 0.3, 0.6, 1.0};
    return integrate_falloff(falloff, ends, [&](double t) { return falloff_value(falloff, t) * f(t); });
}

}  // namespace

double falloff_value(const Falloff& falloff, double t) {
    return shared::falloff_weight(int(falloff.shape), falloff.core, falloff.sharpness, float(t));
}

FalloffTraits traits_of(const Falloff& falloff) {
    using Shape = Falloff::Shape;
    constexpr double exponent = 11.5, steep = 8.0;  // e^-11.5 = 1e-5
    const double core = falloff.core, sharpness = falloff.sharpness;
    const double decay = std::min(1.0, exponent / sharpness);  // where exponential carries no more
    switch (falloff.shape) {
        case Shape::constant:
            return {.flat_core = true, .core = 1.0f, .linear_in_distance = false};
        case Shape::linear:
            return {};
        case Shape::trapezoid:
            return {.flat_core = true,
                    .core = falloff.core,
                    .kinks = core > 0.0 && core < 1.0 ? std::vector{core} : std::vector<double>{}};
        case Shape::gaussian:
            return {.reach = float(std::sqrt(decay)),
                    .linear_in_distance = false,
                    .steep_centre = sharpness > steep};
        case Shape::exponential:
            return {.reach = float(decay), .steep_centre = sharpness > steep};
    }
    return {};
}

double falloff_integral(const Falloff& falloff) {
    return 2.0 * real::pi * integral_with(falloff, [](double t) { return t; });
}

double falloff_variance(const Falloff& falloff) {
    return real::pi * integral_with(falloff, [](double t) { return t * t * t; }) / falloff_integral(falloff);
}

namespace {

constexpr int segments = FootprintNode::segments;
constexpr int samples = 3 * segments + 1;  // each cubic passes through four equidistant samples
const double lattice_frequencies[3] = {1.0, std::sqrt(2.0), 2.0};  // of the pixel raster, cycles per px
constexpr double ripple_limit_px = 32.0;  // beyond, the spectrum at one cycle per pixel is below 1e-4

/// Bessel function e^-x I0(x), x >= 0. Abramowitz and Stegun 9.8.1, 9.8.2; error below 2e-7.
double bessel_i0_scaled(double x) {
    if (x < 3.75) {
        const double t = (x / 3.75) * (x / 3.75);
        const double p =
            1.0 + t * (3.5156229 +
                       t * (3.0899424 + t * (1.2067492 + t * (0.2659732 + t * (0.0360768 + t * 0.0045813)))));
        return p * real::exp(-x);
    }
    const double t = 3.75 / x;
    const double p =
        0.39894228 +
        t * (0.01328592 +
             t * (0.00225319 +
                  t * (-0.00157565 +
                       t * (0.00916281 +
                            t * (-0.02057706 + t * (0.02635537 + t * (-0.01647633 + t * 0.00392377)))))));
    return p / std::sqrt(x);
}

/// Bessel function J0(x), x >= 0. Abramowitz and Stegun 9.4.1, 9.4.3; error below 5e-8.
double bessel_j0(double x) {
    if (x < 3.0) {
        const double t = (x / 3.0) * (x / 3.0);
        return 1.0 +
               t * (-2.2499997 +
                    t * (1.2656208 + t * (-0.3163866 + t * (0.0444479 + t * (-0.0039444 + t * 0.0002100)))));
    }
    const double t = 3.0 / x;
    const double f =
        0.79788456 +
        t * (-0.00000077 +
             t * (-0.00552740 + t * (-0.00009512 + t * (0.00137237 + t * (-0.00072805 + t * 0.00014476)))));
    const double theta =
        x - 0.78539816 +
        t * (-0.04166397 +
             t * (-0.00003954 + t * (0.00262573 + t * (-0.00054125 + t * (-0.00029333 + t * 0.00013558)))));
    return f * real::cos(theta) / std::sqrt(x);
}

/// Ends of the panels over which a falloff is smooth, as shares of the radius.
std::vector<double> panel_ends(const Falloff& falloff) {
    std::vector<double> ends = {0.0, 0.25, 0.5, 0.75, 1.0};
    const FalloffTraits traits = traits_of(falloff);
    ends.insert(ends.end(), traits.kinks.begin(), traits.kinks.end());
    if (traits.steep_centre) ends.insert(ends.end(), {0.005, 0.02, 0.06, 0.12});
    std::ranges::sort(ends);
    return ends;
}

/// The convolution of falloff and (untruncated) Gaussian filter at distance d, as a radial integral.
struct Profile {
    Falloff falloff;
    double radius, sigma;  // px
    std::vector<double> ends = panel_ends(falloff);

    double at(double d) const {
        const double lo = std::max(0.0, d - 6.0 * sigma), hi = std::min(radius, d + 6.0 * sigma);
        double sum = 0.0;
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            const double a = std::max(lo, ends[i] * radius), b = std::min(hi, ends[i + 1] * radius);
            const int parts = std::max(1, int(std::ceil((b - a) / (2.0 * sigma))));
            for (int k = 0; k < parts && b > a; ++k)
                sum += integrate_panel(a + (b - a) * k / parts, a + (b - a) * (k + 1) / parts,
                                       [&](double r) { return ring(r, d); });
        }
        return sum;
    }

    /// Spectrum of falloff and filter at `frequency` cycles per px, relative to frequency 0.
    double relative_spectrum(double frequency, double integral) const {
        double sum = 0.0;
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            const double a = ends[i], b = ends[i + 1];
            const int parts = 1 + int((b - a) * radius * frequency);
            for (int k = 0; k < parts; ++k)
                sum += integrate_panel(a + (b - a) * k / parts, a + (b - a) * (k + 1) / parts, [&](double t) {
                    return falloff_value(falloff, t) * t * bessel_j0(2.0 * real::pi * frequency * radius * t);
                });
        }
        const double filter = 2.0 * real::pi * real::pi * sigma * sigma * frequency * frequency;
        return 2.0 * real::pi * sum / integral * real::exp(-filter);
    }

    double ring(double r, double d) const {
        const double s2 = sigma * sigma;
        return falloff_value(falloff, r / radius) * r / s2 * real::exp(-(r - d) * (r - d) / (2.0 * s2)) *
               bessel_i0_scaled(r * d / s2);
    }
};

/// Range of d over which u runs from 0 to 1.
exact::ProfileRange range_of(const FootprintTable& table, double radius_px) {
    return exact::profile_range(table.core, table.reach, 4.0 * table.pixel_filter_px, radius_px);
}

double distance_at(const FootprintTable& table, const exact::ProfileRange& range, double u) {
    const double place = exact::profile_begin(table.linear_in_distance, range) +
                         exact::profile_width(table.linear_in_distance, range) * u;
    return table.linear_in_distance ? place : std::sqrt(place);
}

/// Values of P at the samples, bent by less than 1e-4 so that it ends at exactly 0 and, with a flat inside,
/// starts at exactly 1: the filter is cut off at four standard deviations.
std::array<double, samples> sample_profile(const FootprintTable& table, const Falloff& falloff,
                                           double radius_px) {
    const Profile profile{falloff, radius_px, table.pixel_filter_px};
    const exact::ProfileRange range = range_of(table, radius_px);
    std::array<double, samples> p;
    for (int i = 0; i < samples; ++i) p[i] = profile.at(distance_at(table, range, double(i) / (samples - 1)));
    const double excess = p[samples - 1];
    // Also for the node just below the radius where a flat inside begins: it is interpolated with the
    // next one.
    const bool flat_inside = radius_px * (1.0 + 1.0 / 32.0) * table.core > 4.0 * table.pixel_filter_px;
    const double lack = flat_inside ? 1.0 - p[0] : 0.0;
    for (int i = 0; i < samples; ++i) {
        const double u = double(i) / (samples - 1);
        p[i] = std::clamp(p[i] + lack * (1.0 - u) - excess * u, 0.0, 1.0);
    }
    return p;
}

/// Cubic through four equidistant values on [0, 1], by powers.
std::array<double, 4> cubic_through(const double* p) {
    return {p[0], -5.5 * p[0] + 9.0 * p[1] - 4.5 * p[2] + p[3],
            9.0 * p[0] - 22.5 * p[1] + 18.0 * p[2] - 4.5 * p[3],
            -4.5 * p[0] + 13.5 * p[1] - 13.5 * p[2] + 4.5 * p[3]};
}

/// Spectrum of P (1 - P) at `frequency` cycles per px.
double edge_spectrum(const FootprintTable& table, const FootprintNode& node, double radius_px,
                     double frequency) {
    const exact::ProfileRange range = range_of(table, radius_px);
    double sum = 0.0;
    for (int s = 0; s < segments; ++s) {
        const auto distance = [&](double f) { return distance_at(table, range, (s + f) / segments); };
        const double d0 = distance(0.0), d1 = distance(1.0);
        sum += integrate_panel(d0, d1, [&](double d) {
            const double place =
                table.linear_in_distance ? (d - d0) / (d1 - d0) : (d * d - d0 * d0) / (d1 * d1 - d0 * d0);
            const auto c = [&](int k) { return double(node.cubic[k][s]); };
            const double p = std::clamp(((c(3) * place + c(2)) * place + c(1)) * place + c(0), 0.0, 1.0);
            return p * (1.0 - p) * d * bessel_j0(2.0 * real::pi * frequency * d);
        });
    }
    return sum;
}

FootprintNode make_node(const FootprintTable& table, const Falloff& falloff, double radius_px) {
    FootprintNode node{};
    const std::array<double, samples> p = sample_profile(table, falloff, radius_px);
    double moments[4] = {0.0, 0.0, 0.0, 0.0};
    for (int s = 0; s < segments; ++s) {
        const std::array<double, 4> c = cubic_through(&p[3 * s]);
        for (int k = 0; k < 4; ++k) node.cubic[k][s] = float(c[k]);
        const auto value = [&](double f) {
            return std::clamp(((c[3] * f + c[2]) * f + c[1]) * f + c[0], 0.0, 1.0);
        };
        const auto place = [&](double f) { return (s + f) / segments; };
        moments[0] += integrate_panel(0.0, 1.0, [&](double f) { return value(f); });
        moments[1] += integrate_panel(0.0, 1.0, [&](double f) { return value(f) * place(f); });
        moments[2] += integrate_panel(0.0, 1.0, [&](double f) { return value(f) * (1.0 - value(f)); });
        moments[3] +=
            integrate_panel(0.0, 1.0, [&](double f) { return value(f) * (1.0 - value(f)) * place(f); });
    }
    node.moments.mean = float(moments[0] / segments);
    node.moments.first_moment = float(moments[1] / segments);
    node.moments.edge_mean = float(moments[2] / segments);
    node.moments.edge_first_moment = float(moments[3] / segments);
    if (radius_px < ripple_limit_px) {
        const Profile profile{falloff, radius_px, table.pixel_filter_px};
        for (int i = 0; i < 3; ++i) {
            node.moments.ripple[i] = float(profile.relative_spectrum(lattice_frequencies[i], table.integral));
            if (table.flat_core)
                node.moments.edge_ripple[i] =
                    float(edge_spectrum(table, node, radius_px, lattice_frequencies[i]) /
                          edge_spectrum(table, node, radius_px, 0.0));
        }
    }
    return node;
}

std::array<float, 256> make_cosines() {
    std::array<float, 256> table;
    for (int i = 0; i < 256; ++i) table[i] = -float(real::cos(2.0 * real::pi * i / 256.0));
    return table;
}

/// The range of a splat's profile; below the smallest radius it is that radius's.
shared::ProfileRange range_in_px(const FootprintTable& table, float radius_px) {
    return shared::profile_range(table.core, table.reach, 4.0f * table.pixel_filter_px,
                                 std::max(radius_px, shared::SMALLEST_RADIUS_PX));
}

/// A moment between the nodes of a radius.
float moment(const FootprintNodes& nodes, float FootprintMoments::*field) {
    const float a = nodes.a->moments.*field, b = nodes.b->moments.*field;
    return a + (b - a) * nodes.t;
}

/// Relative excess of the sum over all pixels over the integral, for a spectrum of either kind.
float ripple(const FootprintNodes& nodes, float (FootprintMoments::*spectrum)[3], float x_px, float y_px) {
    const auto at = [&](int i) {
        const float a = (nodes.a->moments.*spectrum)[i], b = (nodes.b->moments.*spectrum)[i];
        return a + (b - a) * nodes.t;
    };
    return shared::pixel_ripple(at(0), at(1), at(2), pixel_cosine(x_px), pixel_cosine(y_px));
}

}  // namespace

FootprintTable begin_footprint_table(const Falloff& falloff, float pixel_filter_px) {
    const FalloffTraits traits = traits_of(falloff);
    FootprintTable table;
    table.falloff = falloff;
    table.linear_in_distance = traits.linear_in_distance;
    table.flat_core = traits.flat_core;
    table.pixel_filter_px = pixel_filter_px;
    table.reach = traits.reach;
    table.core = traits.core;
    table.integral = float(falloff_integral(falloff));
    table.variance = float(falloff_variance(falloff));
    table.nodes.resize(shared::NODE_COUNT);
    return table;
}

void make_footprint_nodes(FootprintTable& table, float least_px, float largest_px, const Progress& progress) {
    const auto number = [&](const FootprintNode* node) { return std::size_t(node - table.nodes.data()); };
    std::size_t first = number(footprint_nodes(table, least_px).a);
    std::size_t end = number(footprint_nodes(table, largest_px).b) + 1;
    if (table.first_made < table.end_made) {  // they stay in one piece
        first = std::min(first, table.first_made);
        end = std::max(end, table.end_made);
    }
    parallel_for(std::int64_t(end - first), [&](std::int64_t n, int) {
        const std::size_t i = first + std::size_t(n);
        if (i >= table.first_made && i < table.end_made) return;
        progress.check();
        table.nodes[i] = make_node(table, table.falloff, double{node_radius_px(i)});
    });
    table.first_made = first;
    table.end_made = end;
}

FootprintTable make_footprint_table(const Falloff& falloff, float pixel_filter_px, const Progress& progress) {
    FootprintTable table = begin_footprint_table(falloff, pixel_filter_px);
    make_footprint_nodes(table, 0.0f, std::numeric_limits<float>::max(), progress);
    return table;
}

const std::array<float, 256> pixel_cosines = make_cosines();

FootprintNodes footprint_nodes(const FootprintTable& table, float radius_px) {
    const shared::NodePlace place = shared::node_of_radius(radius_px);
    const FootprintNode* first = table.nodes.data() + place.first;
    return {first, std::min(first + (place.share > 0.0f ? 1 : 0), &table.nodes.back()), place.share};
}

float node_radius_px(std::size_t node) {
    const auto bits = std::uint32_t(shared::FIRST_NODE) + std::uint32_t(node);
    return std::bit_cast<float>(bits << shared::NODE_BITS);
}

FootprintMass footprint_mass(const FootprintTable& table, float radius_px) {
    using Moments = FootprintMoments;
    const FootprintNodes nodes = footprint_nodes(table, radius_px);
    const shared::ProfileRange range = range_in_px(table, radius_px);
    const bool linear = table.linear_in_distance;
    return {shared::profile_mass(linear, range, moment(nodes, &Moments::mean),
                                 moment(nodes, &Moments::first_moment)),
            shared::edge_mass(linear, range, moment(nodes, &Moments::edge_mean),
                              moment(nodes, &Moments::edge_first_moment))};
}

void footprint_at(const FootprintTable& table, float radius_px, float x_px, float y_px,
                  Footprint& footprint) {
    const FootprintNodes pair = footprint_nodes(table, radius_px);
    const FootprintMass mass = footprint_mass(table, radius_px);
    const shared::ProfileRange range = range_in_px(table, radius_px);
    const float tabulated_px = std::max(radius_px, shared::SMALLEST_RADIUS_PX);
    const shared::FootprintGains gains = shared::footprint_gains(
        table.flat_core, shared::is_tabulated(shared::node_of_radius(radius_px)),
        shared::shrink_of_radius(radius_px), table.integral * tabulated_px * tabulated_px,
        mass.profile * (1.0f + ripple(pair, &FootprintMoments::ripple, x_px, y_px)),
        mass.edge * (1.0f + ripple(pair, &FootprintMoments::edge_ripple, x_px, y_px)));
    footprint = {pair.a,
                 pair.b,
                 pair.t,
                 shared::profile_begin(table.linear_in_distance, range),
                 float(segments) / shared::profile_width(table.linear_in_distance, range),
                 gains.amplitude,
                 gains.edge_gain,
                 table.support_px(tabulated_px)};
}

float footprint_weight(const FootprintTable& table, const Footprint& footprint, float distance_px) {
    const float place = table.linear_in_distance ? distance_px : distance_px * distance_px;
    const float u = std::max((place - footprint.lo) * footprint.scale, 0.0f);
    if (!(u < float(segments))) return 0.0f;
    const int s = std::min(int(u), segments - 1);
    const float f = u - float(s);
    float c[4];
    for (int k = 0; k < 4; ++k) {
        const float a = footprint.node_a->cubic[k][s];
        c[k] = a + (footprint.node_b->cubic[k][s] - a) * footprint.t;
    }
    const float p = ((c[3] * f + c[2]) * f + c[1]) * f + c[0];
    return std::max(0.0f, footprint.amplitude * (p + footprint.edge_gain * (p * (1.0f - p))));
}

}  // namespace astrosplat

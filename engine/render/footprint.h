// Falloffs as C++ sees them: w(t) from shaders/shared/falloff.glsl, what the renderer has to know of it
// besides, and integrals over it. And footprints: a falloff convolved with the pixel filter, as a radial
// profile that the fold evaluates per pixel.
//
// For a splat of radius R px the weight of a pixel at distance d from its centre is P(u), a piecewise
// cubic of 16 segments over u in [0, 1], where u runs linearly over [lo, hi] in d^2 (constant, gaussian)
// or in d (the others). hi is the edge of the support; below lo the profile is flat and exactly 1. Tables
// exist for 32 radii per octave and are interpolated linearly in between; sixteen segments because that is
// one vector permute.
//
// Sampling P at pixel centres does not conserve light: by Poisson's formula the sum over all pixels is the
// integral times 1 + ripple(sub-pixel offset), where ripple is the profile's spectrum at whole
// frequencies. It is divided out, in closed form, so the flux is right at every radius and offset without
// summing pixels first.
#pragma once

#include "core/progress.h"
#include "core/real.h"
#include "render/frame.h"
#include "render/shared_render.h"

namespace astrosplat {

/// w(t), t >= 0.
double falloff_value(const Falloff& falloff, double t);

/// Facts about w(t), by its shape.
struct FalloffTraits {
    bool flat_core = false;          // exactly 1 inside, as constant and trapezoid: only the edge is scaled
    float core = 0.0f;               // share of the radius that is flat
    float reach = 1.0f;              // share of the radius that carries more than 1e-5 of the peak
    bool linear_in_distance = true;  // false: w is smooth in t^2, and tables run over that
    bool steep_centre = false;       // quadrature takes small steps there
    std::vector<double> kinks = {};  // in (0, 1), ascending: of w, or jumps: quadrature breaks there
};
FalloffTraits traits_of(const Falloff& falloff);

/// Integral of f(t) from 0 to 1, where f is smooth within the panels `ends` but for the falloff's kinks.
/// Panels shrink towards where f is sharp: most falloffs have their light in the centre.
template <class F>
double integrate_falloff(const Falloff& falloff, std::span<const double> ends, const F& f) {
    const std::vector<double> kinks = traits_of(falloff).kinks;
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        double panel = 0.0, from = ends[i];
        for (const double kink : kinks)
            if (kink > from && kink < ends[i + 1]) {
                panel += integrate_panel(from, kink, f);
                from = kink;
            }
        sum += panel + integrate_panel(from, ends[i + 1], f);
    }
    return sum;
}

/// Integral of w(|p|) over the unit disc: the flux of a splat of radius 1 px and alpha 1, square px.
double falloff_integral(const Falloff& falloff);

/// Its variance along an axis, square radii.
double falloff_variance(const Falloff& falloff);

// ---- footprints

/// Moments for normalising a profile, in fours: so they are interpolated.
struct FootprintMoments {
    float mean;       // integral of P du
    float ripple[3];  // spectrum of P at frequencies (1,0), (1,1), (2,0) per px, relative to its integral
    float edge_mean;  // the same two of P (1 - P), for flat cores
    float edge_ripple[3];
    float first_moment;  // integral of P u du
    float edge_first_moment;
    float unused[2];
};

/// Profile of one radius: cubic coefficients [power][segment], and what normalising needs.
struct alignas(64) FootprintNode {
    static constexpr int segments = 16;
    float cubic[4][segments];
    FootprintMoments moments;
};

struct FootprintTable {
    std::vector<FootprintNode> nodes;          // 0 until they are made
    std::size_t first_made = 0, end_made = 0;  // the nodes that exist
    Falloff falloff;
    bool linear_in_distance = false;  // u linear in d, not in d^2; this and the next as in FalloffTraits
    bool flat_core = false;
    float pixel_filter_px = 0.5f;
    float reach = 1.0f, core = 0.0f;  // shares of the radius, as in FalloffTraits
    float integral = 1.0f;            // of the falloff over the unit disc
    float variance = 0.25f;           // of the falloff along an axis, square radii

    /// Distance from the centre beyond which all weights are 0.
    float support_px(float radius_px) const { return radius_px * reach + 4.0f * pixel_filter_px; }
    /// The same for the shape that is drawn: radii below the smallest tabulated one have its shape.
    float drawn_support_px(float radius_px) const {
        return support_px(std::max(radius_px, shared::SMALLEST_RADIUS_PX));
    }
};

/// Everything the fold needs of one splat's footprint besides its centre. The cubics are node_a's, moved by
/// the share t towards node_b's.
struct Footprint {
    const FootprintNode* node_a = nullptr;
    const FootprintNode* node_b = nullptr;
    float t = 0.0f;
    float lo = 0.0f, scale = 0.0f;  // segment coordinate = (d or d^2 - lo) * scale, in [0, 16)
    float amplitude = 1.0f;         // multiplies the weight
    float edge_gain = 0.0f;         // flat cores: w += edge_gain * w (1 - w)
    float support_px = 0.0f;
};

/// A table without nodes: all that does not depend on the radius.
FootprintTable begin_footprint_table(const Falloff& falloff, float pixel_filter_px);
/// Makes those nodes that radii in [least, largest] need and that do not exist yet. All of them take about
/// 60 ms of a core. When Cancelled is thrown the table is as before.
void make_footprint_nodes(FootprintTable& table, float least_px, float largest_px,
                          const Progress& progress = {});
/// The table for every radius from 2^-6 to 2^10 px (larger ones reuse the last shape).
FootprintTable make_footprint_table(const Falloff& falloff, float pixel_filter_px,
                                    const Progress& progress = {});

/// The nodes on either side of a radius, and the share of the second.
struct FootprintNodes {
    const FootprintNode* a;
    const FootprintNode* b;
    float t;
};
FootprintNodes footprint_nodes(const FootprintTable& table, float radius_px);
/// The radius of a node, px.
float node_radius_px(std::size_t node);

/// -cos(2 pi i / 256): splat centres are snapped to 1/256 px.
extern const std::array<float, 256> pixel_cosines;
constexpr float pixel_cosine_far_px = 1e6f;  // so far out nothing of a splat this small shows
/// cos of the phase of a coordinate, snapped to 1/256 px, relative to the pixel centres.
inline float pixel_cosine(float coordinate_px) {
    const float inside = std::min(std::max(coordinate_px, -pixel_cosine_far_px), pixel_cosine_far_px);
    return pixel_cosines[int(inside * 256.0f) & 255];
}

/// Integrals over the plane of the profile of a radius, and of its P (1 - P), square px.
struct FootprintMass {
    float profile, edge;
};
FootprintMass footprint_mass(const FootprintTable& table, float radius_px);

/// The footprint of one splat; x_px, y_px are its centre, snapped to 1/256 px by the caller.
void footprint_at(const FootprintTable& table, float radius_px, float x_px, float y_px, Footprint& footprint);

/// Weight at distance d: what the vector kernels compute, for tests and level of detail.
float footprint_weight(const FootprintTable& table, const Footprint& footprint, float distance_px);

}  // namespace astrosplat

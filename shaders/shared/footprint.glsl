// Footprints: the sums that bring a splat's light to what it shall be. A profile P(u) falls over u in [0, 1], which
// runs over the distance d from the centre, or over d^2, from `lo` to `hi`; inside lo it is 1. The tables hold moments
// of P and its spectrum for 32 radii an octave. Needs lens.glsl.

const float FOOTPRINT_PI = 3.14159265f;
const float SMALLEST_RADIUS_PX = 1.0f / 64.0f;  // below, the shape is that of this radius and the light is as R^2
// A node's radius, as bits of a float: told apart by the mantissa's five top bits.
const int NODE_BITS = 18;
const int FIRST_NODE = (127 - 6) << 5;
const int NODE_COUNT = 16 * 32 + 1;  // up to 2^10 px
const int NODE_MASK = (1 << NODE_BITS) - 1;

// Between which nodes a radius lies: `first` and the next, which has the share `share`. Beyond the last: that one.
struct NodePlace {
    Int first;
    Float share;
};
NodePlace node_of_radius(Float radius_px) {
    Int bits = floatBitsToInt(radius_px);
    Int index = (bits >> NODE_BITS) - FIRST_NODE;
    Int first = min(max(index, 0), NODE_COUNT - 1);
    return NodePlace(first, mix(0.0f, Float(bits & NODE_MASK) * (1.0f / 262144.0f), first == index));
}

// Not where the shape is that of the last node: pixels sample that finely, and nothing is to be corrected.
Bool is_tabulated(NodePlace node) {
    return node.first < NODE_COUNT - 2 || (node.first == NODE_COUNT - 2 && node.share > 0.0f);
}

// Distances between which P falls.
struct ProfileRange {
    Float lo;
    Float hi;
};
ProfileRange profile_range(Real core, Real reach, Real margin_px, Float radius_px) {
    return ProfileRange(max(0.0f, radius_px * core - margin_px), radius_px * reach + margin_px);
}
// Where u begins, in units of d or d^2, and how far it runs.
Float profile_begin(bool linear_in_distance, ProfileRange r) {
    if (linear_in_distance) return r.lo;
    return r.lo * r.lo;
}
Float profile_width(bool linear_in_distance, ProfileRange r) {
    if (linear_in_distance) return r.hi - r.lo;
    return r.hi * r.hi - r.lo * r.lo;
}

// Integral of P over the plane, from its moments over u, square px.
Float profile_mass(bool linear_in_distance, ProfileRange r, Float mean, Float first_moment) {
    Float width = profile_width(linear_in_distance, r);
    if (!linear_in_distance) return FOOTPRINT_PI * (r.lo * r.lo + width * mean);
    return FOOTPRINT_PI * (r.lo * r.lo + 2.0f * width * (r.lo * mean + width * first_moment));
}
// The same of P (1 - P), which is 0 inside.
Float edge_mass(bool linear_in_distance, ProfileRange r, Float mean, Float first_moment) {
    Float width = profile_width(linear_in_distance, r);
    if (!linear_in_distance) return FOOTPRINT_PI * width * mean;
    return FOOTPRINT_PI * 2.0f * width * (r.lo * mean + width * first_moment);
}

// By Poisson's formula: relative excess of the sum over all pixels over the integral, from the spectrum at (1,0),
// (1,1) and (2,0) cycles per px. cx, cy: cosines of the centre's phase between pixel centres.
Float pixel_ripple(Float s10, Float s11, Float s20, Float cx, Float cy) {
    Float c2 = (2.0f * cx * cx - 1.0f) + (2.0f * cy * cy - 1.0f);
    Float sum = 2.0f * s10 * (cx + cy) + 4.0f * s11 * (cx * cy) + 2.0f * s20 * c2;
    return mix(sum, 0.0f, abs(s10) < 1e-6f);
}

Float shrink_of_radius(Float radius_px) {
    Float ratio = as_div(radius_px, SMALLEST_RADIUS_PX);
    return mix(1.0f, ratio * ratio, radius_px < SMALLEST_RADIUS_PX);
}

// The weight of a pixel is amplitude * (P + edge_gain * P (1 - P)). Inside flat cores it is exactly 1, so only their
// edge is scaled. wanted: the light; found: what P adds up to over all pixels, edge_found: the same of P (1 - P).
struct FootprintGains {
    Float amplitude;
    Float edge_gain;
};
FootprintGains footprint_gains(bool flat_core, Bool tabulated, Float shrink, Float wanted, Float found,
                               Float edge_found) {
    if (flat_core) return FootprintGains(shrink, mix(0.0f, as_div(wanted - found, edge_found), tabulated));
    return FootprintGains(mix(shrink, shrink * as_div(wanted, found), tabulated), 0.0f);
}

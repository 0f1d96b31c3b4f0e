// The seven operators of DESIGN 5, in order: SplatSet + Look -> ShadedSplats. The arithmetic of one splat is
// shaders/shared/look.glsl, which cards compile too; this prepares its uniforms and runs it over the set.
// Gaussians have more than other splats: colours that depend on where they are seen from, which come
// before the look, and shapes, which come after it.
#pragma once

#include <glm/vec3.hpp>

#include "core/buffer.h"
#include "core/image.h"
#include "core/progress.h"
#include "look/look.h"
#include "splats/shaded_splats.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// How a column of splats adds up, so that vertical matching can undo it: the blend, as a plain number.
enum class ColumnLaw { transmittance, screen, sum, maximum };  // over, hybrid | screen | add | lighten

/// Inputs of the look from elsewhere, as plain values.
struct LookInputs {
    glm::vec3 axis{0.0f, 1.0f, 0.0f};  // the layer's thin direction, layer space
    std::uint32_t seed = 1;            // of the layer, never 0 (see resolved_seed)
    double falloff_integral = 1.0;     // of the layer's falloff over the unit disc
    double falloff_variance = 0.1;     // of it along an axis, square radii; match = "picture" reads it
    ColumnLaw column = ColumnLaw::transmittance;
    const Buffer<glm::vec3>* seen_colors = nullptr;  // in place of the set's; null: these
    const Image* thickness_map = nullptr;  // raw values; must be there when look.thickness.map is set
    bool operator==(const LookInputs&) const = default;
};

/// The columns that the look reads, of those that a set can do without.
OptionalColumns columns_read(const Look& look);

struct LookStatistics {
    std::int64_t kept = 0;
    double seconds = 0.0;
};

/// Deterministic for any thread count and instruction set. Throws InputError when the look cannot be applied
/// to the set (no radius known, match without spacing, thickness map without uv). A look at its defaults on a
/// set read from a file passes the splats through unchanged.
ShadedSplats apply_look(const SplatSet& set, const Look& look, const LookInputs& inputs,
                        const Progress& progress = {}, LookStatistics* statistics = nullptr);

/// The same into arrays of an earlier call, whose memory is used again.
void apply_look(const SplatSet& set, const Look& look, const LookInputs& inputs, ShadedSplats& shaded,
                const Progress& progress = {}, LookStatistics* statistics = nullptr);

/// The same in the memory of the set, which keeps no splats but its other values; for a set that is not read
/// again, because fresh memory costs more than the arithmetic. It throws before it begins or not at all, also
/// Cancelled: a set that was changed in part would be of no use.
ShadedSplats apply_look_in_place(SplatSet& set, const Look& look, const LookInputs& inputs,
                                 const Progress& progress = {}, LookStatistics* statistics = nullptr);

/// Where a layer is seen from, in its own space.
struct SeenFrom {
    glm::dvec3 eye{0.0};
    glm::dvec3 along{0.0};  // parallel rays: their direction, length 1; else 0
    bool operator==(const SeenFrom&) const = default;
};

/// Linear colours of a set with harmonics. Throws Cancelled.
Buffer<glm::vec3> seen_colors(const SplatSet& set, const SeenFrom& from, const Progress& progress = {});

/// Gives the splats that a look left of a set of Gaussians their shapes.
void add_shapes(const SplatSet& set, ShadedSplats& shaded);

/// Linear colours as a display shows them, beyond 0..1 too (sRGB), for layers that are composited so.
void encode_colors(ShadedSplats& shaded);

}  // namespace astrosplat

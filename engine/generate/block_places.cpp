// Lattice positions moved by their own random numbers.
#include "generate/lattice_cull.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "generate/block_places.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "core/shared_maths.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

using namespace astrosplat::glsl;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "maths.glsl"
#pragma GCC diagnostic pop

// half_range * (2 uniform - 1), added to the lattice position.
HWY_FLATTEN void add_jitter(const uint* HWY_RESTRICT id_low, const uint* HWY_RESTRICT id_high,
                            std::uint32_t seed, std::uint32_t purpose, double half_range,
                            double* HWY_RESTRICT at) {
    for (std::size_t s = 0; s < block_positions; ++s) {
        const float random = as_uniform(as_hash(seed, id_low[s], id_high[s], purpose));
        at[s] = at[s] + half_range * (2.0 * double(random) - 1.0);
    }
}

void jitter(const uint* id_low, const uint* id_high, std::uint32_t seed, const glm::dvec3& half_range,
            BlockAnswers& answers) {
    add_jitter(id_low, id_high, seed, PURPOSE_JITTER_X, half_range.x, answers.x.data());
    add_jitter(id_low, id_high, seed, PURPOSE_JITTER_Y, half_range.y, answers.y.data());
    add_jitter(id_low, id_high, seed, PURPOSE_JITTER_Z, half_range.z, answers.z.data());
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(jitter);

void place_block(const Lattice& lattice, const CullSettings& settings, const LatticeBlock& block,
                 Positions kind, BlockAnswers& answers) {
    const glm::i64vec3 first = block.at * block_cells;
    const bool centres = kind == Positions::centres;
    const auto coordinate = [&](int axis, std::size_t i) {
        const double cells = double(first[axis] + std::int64_t(i));
        return lattice_coordinate(lattice, axis, cells + (centres ? 0.5 : 0.0));
    };
    std::array<double, block_cells> x;
    for (std::size_t i = 0; i < block_cells; ++i) x[i] = coordinate(0, i);
    std::array<std::uint32_t, block_positions> id_low, id_high;
    for (std::size_t k = 0; k < block_cells; ++k) {
        const double z = coordinate(2, k);
        for (std::size_t j = 0; j < block_cells; ++j) {
            const double y = coordinate(1, j);
            const glm::i64vec3 at = first + glm::i64vec3(0, j, k);
            const std::uint64_t row = centres ? centre_id(lattice, at) : corner_id(lattice, at);
            for (std::size_t i = 0; i < block_cells; ++i) {
                const std::size_t s = block_slot(i, j, k);
                id_low[s] = std::uint32_t(row + i);
                id_high[s] = std::uint32_t((row + i) >> 32);
                answers.x[s] = x[i], answers.y[s] = y, answers.z[s] = z;
            }
        }
    }
    const glm::dvec3 half_range = lattice.spacing() * (0.5 * settings.jitter);
    HWY_DYNAMIC_DISPATCH(jitter)(id_low.data(), id_high.data(), settings.seed, half_range, answers);
}

}  // namespace astrosplat
#endif

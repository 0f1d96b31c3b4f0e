// Lattice positions moved by their own random numbers.
#include "generate/block_places.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "generate/block_places.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "core/glsl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

using namespace astrosplat::glsl;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "maths.glsl"
#pragma GCC diagnostic pop

struct Jitter {
    std::uint32_t seed, purpose;
    double half_range;
};

// As jitter_offset: half_range * (2 uniform - 1), added to the lattice position.
HWY_FLATTEN void add_jitter(const uint* HWY_RESTRICT id_low, const uint* HWY_RESTRICT id_high, Jitter jitter,
                            double* HWY_RESTRICT at) {
    for (std::size_t s = 0; s < block_positions; ++s) {
        const float random = as_uniform(as_hash(jitter.seed, id_low[s], id_high[s], jitter.purpose));
        at[s] = at[s] + jitter.half_range * (2.0 * static_cast<double>(random) - 1.0);
    }
}

struct IdHalves {
    std::array<uint, block_positions> low, high;
};

void place_kind(const KindPlaces& places, Positions kind, IdHalves& ids, BlockAnswers& answers) {
    for (std::size_t k = 0; k < block_cells; ++k) {
        for (std::size_t j = 0; j < block_cells; ++j) {
            for (std::size_t i = 0; i < block_cells; ++i) {
                const std::size_t s = block_slot(kind, i, j, k);
                const std::uint64_t id = places.first_id + i + j * places.row_ids + k * places.slice_ids;
                ids.low[s] = static_cast<uint>(id);
                ids.high[s] = static_cast<uint>(id >> 32);
                answers.x[s] = places.x[i];
                answers.y[s] = places.y[j];
                answers.z[s] = places.z[k];
            }
        }
    }
}

void place(const BlockPlaces& places, BlockAnswers& answers) {
    IdHalves ids;
    place_kind(places.corners, Positions::corners, ids, answers);
    place_kind(places.centres, Positions::centres, ids, answers);
    const glm::dvec3& range = places.half_range;
    const auto add = [&](std::uint32_t purpose, double half_range, double* at) HWY_ATTR {
        add_jitter(ids.low.data(), ids.high.data(), {places.seed, purpose, half_range}, at);
    };
    add(PURPOSE_JITTER_X, range.x, answers.x.data());
    add(PURPOSE_JITTER_Y, range.y, answers.y.data());
    add(PURPOSE_JITTER_Z, range.z, answers.z.data());
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(place);

void place_block(const BlockPlaces& places, BlockAnswers& answers) {
    HWY_DYNAMIC_DISPATCH(place)(places, answers);
}

}  // namespace astrosplat
#endif

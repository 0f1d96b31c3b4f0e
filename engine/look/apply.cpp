// Chunks of the set go through the kernel in any order; each writes its kept splats at the chunk's own place
// in the output. Afterwards the gaps are closed in order, so the result does not depend on who did what.
#include "look/apply.h"

#include <atomic>

#include "core/color.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/rotation.h"
#include "look/kernel.h"
#include "look/picture_fit.h"
#include "look/prepare.h"

namespace astrosplat {
namespace {

constexpr std::int64_t chunk_size = 1 << 14;  // splats; 1.3 MB in and out

void make_room(ShadedSplats& shaded, std::int64_t count) {
    const auto size = std::size_t(count);
    if (shaded.position.capacity() < size) {
        const std::size_t bytes = 2 * sizeof(glm::vec3) + 2 * sizeof(float) + sizeof(std::uint64_t);
        claim_memory(count * std::int64_t(bytes), "shaded splats");
    }
    for_each_array(shaded, [&](auto& array) {
        array.clear();  // nothing to copy should it grow
        array.resize(size);
    });
}

template <class T>
void close_gaps(Buffer<T>& buffer, const std::vector<std::int64_t>& kept) {
    std::int64_t end = 0;
    for (std::size_t c = 0; c < kept.size(); ++c) {
        const auto begin = std::int64_t(c) * chunk_size;
        if (end != begin) std::copy_n(buffer.begin() + begin, kept[c], buffer.begin() + end);
        end += kept[c];
    }
    buffer.resize(std::size_t(end));
}

void close_gaps(ShadedSplats& shaded, const std::vector<std::int64_t>& kept) {
    std::vector<std::function<void()>> tasks;
    for_each_array(shaded, [&](auto& array) { tasks.push_back([&] { close_gaps(array, kept); }); });
    parallel_each(tasks.size(), 1, [&](std::size_t array) { tasks[array](); });
}

// Gives memory back where most of it is not used.
void trim(ShadedSplats& shaded) {
    for_each_array(shaded, [](auto& array) {
        if (array.capacity() > 2 * array.size()) array.shrink_to_fit();
    });
}

// Hands the set's arrays to the shaded splats, the distances where it has no radii.
// The set's other arrays stay.
ShadedSplats take_arrays(SplatSet& set) {
    ShadedSplats shaded;
    shaded.position = std::move(set.position);
    shaded.color = std::move(set.color);
    shaded.alpha = std::move(set.alpha);
    shaded.radius = std::move(set.radius.empty() ? set.distance : set.radius);
    shaded.id = std::move(set.id);
    return shaded;
}

// Throws Cancelled where the caller can cancel.
void shade_all(const LookRun& run, std::int64_t count, const Progress& progress) {
    std::vector<std::int64_t> kept(std::size_t((count + chunk_size - 1) / chunk_size));
    std::atomic<std::int64_t> done{0};
    parallel_chunks(count, chunk_size, [&](std::int64_t begin, std::int64_t end, int) {
        progress.check();
        kept[begin / chunk_size] = shade_run(run, begin, end);
        progress.at(double(done += end - begin) / double(count));
    });
    close_gaps(run.out, kept);
}

// The factors of match = "picture"; none for others. Before the set's arrays are written over.
PictureFactors factors_of(const LookRun& run, const SplatSet& set, const Look& look,
                          const LookInputs& inputs) {
    const bool wanted = look.vertical.match == VerticalAlpha::Match::picture;
    return wanted && run.uniforms.match != shared_types::MATCH_NONE
               ? picture_factors(run, set, {inputs.falloff_integral, inputs.falloff_variance})
               : PictureFactors();
}

// Fills the statistics, if any, of a look that began at `start`.
void finish(const ShadedSplats& shaded, Clock::time_point start, LookStatistics* statistics) {
    if (!statistics) return;
    statistics->kept = shaded.size();
    statistics->seconds = seconds_since(start);
}

constexpr std::int64_t splats_per_chunk = 1 << 14;

/// The rows of the set that the splats are: both are in ascending order of id, and no row is there twice.
Buffer<std::uint32_t> rows_of(const SplatSet& set, const ShadedSplats& shaded) {
    Buffer<std::uint32_t> rows(shaded.id.size());
    std::size_t row = 0;
    for (std::size_t i = 0; i < rows.size(); ++i, ++row) {
        while (set.id[row] != shaded.id[i]) ++row;
        rows[i] = std::uint32_t(row);
    }
    return rows;
}

/// The matrix from the ball of the radius to the ellipsoid of three standard deviations.
glm::mat3 shape_of(const SplatSet& set, std::size_t row) {
    if (!(set.radius[row] > 0.0f)) return glm::mat3(0.0f);
    glm::dmat3 m = matrix_of_quaternion(glm::dvec4(set.rotation[row]));
    for (int k = 0; k < 3; ++k) m[k] *= 3.0 * double(set.scale[row][k]) / double(set.radius[row]);
    return glm::mat3(m);
}

}  // namespace

OptionalColumns columns_read(const Look& look) {
    const bool cells = look.vertical.match == VerticalAlpha::Match::picture;
    return {cells || !look.thickness.map.empty(), false, cells};
}

void apply_look(const SplatSet& set, const Look& look, const LookInputs& inputs, ShadedSplats& shaded,
                const Progress& progress, LookStatistics* statistics) {
    const auto start = Clock::now();
    const DenormalsAreZero as_on_cards;
    const PreparedLook uniforms = prepare_look(set, look, inputs);
    make_room(shaded, set.size());
    LookColumns columns(set);
    if (inputs.seen_colors) columns.color = inputs.seen_colors->data();
    const LookRun run{columns, uniforms, inputs.thickness_map, shaded};
    const PictureFactors factors = factors_of(run, set, look, inputs);
    shade_all(run, set.size(), progress);
    apply_factors(factors, shaded);
    finish(shaded, start, statistics);
}

ShadedSplats apply_look_in_place(SplatSet& set, const Look& look, const LookInputs& inputs,
                                 const Progress& progress, LookStatistics* statistics) {
    assert(!inputs.seen_colors);
    const auto start = Clock::now();
    const DenormalsAreZero as_on_cards;
    const PreparedLook uniforms = prepare_look(set, look, inputs);
    progress.check();
    const std::int64_t count = set.size();
    const LookColumns columns(set);  // where the arrays are does not change when they are handed over
    ShadedSplats shaded;
    const LookRun run{columns, uniforms, inputs.thickness_map, shaded};
    const PictureFactors factors = factors_of(run, set, look, inputs);
    shaded = take_arrays(set);
    shade_all(run, count, Progress{progress.report, nullptr});
    apply_factors(factors, shaded);
    drop_splats(set);
    trim(shaded);
    finish(shaded, start, statistics);
    return shaded;
}

ShadedSplats apply_look(const SplatSet& set, const Look& look, const LookInputs& inputs,
                        const Progress& progress, LookStatistics* statistics) {
    ShadedSplats shaded;
    apply_look(set, look, inputs, shaded, progress, statistics);
    trim(shaded);
    return shaded;
}

Buffer<glm::vec3> seen_colors(const SplatSet& set, const SeenFrom& from, const Progress& progress) {
    assert(!set.harmonics.empty());
    claim_memory(set.size() * std::int64_t(sizeof(glm::vec3)), "colours by direction");
    Buffer<glm::vec3> colors(set.harmonics.size());
    parallel_chunks(set.size(), splats_per_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        progress.check();
        for (std::int64_t i = begin; i < end; ++i) {
            glm::dvec3 d = from.along;
            if (d == glm::dvec3(0.0)) {
                d = glm::dvec3(set.position[i]) - from.eye;
                const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
                d = length > 0.0 ? d / length : glm::dvec3(0.0, 0.0, -1.0);
            }
            glm::vec3 color = color_towards(set.harmonics[i], glm::vec3(d));
            if (set.display_harmonics)
                for (int k = 0; k < 3; ++k) color[k] = float(real::srgb_to_linear(color[k]));
            colors[i] = color;
        }
    });
    return colors;
}

void add_shapes(const SplatSet& set, ShadedSplats& shaded) {
    assert(holds_gaussians(set));
    if (shaded.stretch.capacity() < shaded.position.size())
        claim_memory(shaded.size() * std::int64_t(sizeof(glm::mat3)), "shapes of splats");
    shaded.stretch.resize(shaded.position.size());
    if (shaded.size() == set.size()) {
        parallel_each(shaded.stretch.size(), splats_per_chunk,
                      [&](std::size_t i) { shaded.stretch[i] = shape_of(set, i); });
        return;
    }
    const Buffer<std::uint32_t> rows = rows_of(set, shaded);
    parallel_each(rows.size(), splats_per_chunk,
                  [&](std::size_t i) { shaded.stretch[i] = shape_of(set, rows[i]); });
}

void encode_colors(ShadedSplats& shaded) {
    parallel_each(shaded.color.size(), splats_per_chunk, [&](std::size_t i) {
        for (int k = 0; k < 3; ++k) shaded.color[i][k] = float(real::linear_to_srgb(shaded.color[i][k]));
    });
    shaded.encoded = true;
}

}  // namespace astrosplat

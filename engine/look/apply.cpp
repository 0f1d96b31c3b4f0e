// Chunks of the set go through the kernel in any order; each writes its kept splats at the chunk's own place
// in the output. Afterwards the gaps are closed in order, so the result does not depend on who did what.
#include "look/apply.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <vector>

#include "core/memory.h"
#include "core/parallel.h"
#include "look/kernel.h"
#include "look/prepare.h"

namespace astrosplat {
namespace {

constexpr std::int64_t chunk_size = 1 << 14;  // splats; 1.3 MB in and out

template <class T>
void make_room(Buffer<T>& buffer, std::size_t size) {
    buffer.clear();  // nothing to copy should it grow
    buffer.resize(size);
}

void make_room(ShadedSplats& shaded, std::int64_t count) {
    const auto size = std::size_t(count);
    if (shaded.position.capacity() < size) {
        const std::size_t bytes = 2 * sizeof(glm::vec3) + 2 * sizeof(float) + sizeof(std::uint64_t);
        claim_memory(count * std::int64_t(bytes), "shaded splats");
    }
    make_room(shaded.position, size);
    make_room(shaded.color, size);
    make_room(shaded.alpha, size);
    make_room(shaded.radius, size);
    make_room(shaded.id, size);
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
    parallel_for(5, [&](std::int64_t array, int) {
        if (array == 0) close_gaps(shaded.position, kept);
        if (array == 1) close_gaps(shaded.color, kept);
        if (array == 2) close_gaps(shaded.alpha, kept);
        if (array == 3) close_gaps(shaded.radius, kept);
        if (array == 4) close_gaps(shaded.id, kept);
    });
}

// Gives memory back where most of it is not used.
template <class T>
void trim(Buffer<T>& buffer) {
    if (buffer.capacity() > 2 * buffer.size()) buffer.shrink_to_fit();
}

}  // namespace

void apply_look(const SplatSet& set, const Look& look, const LookInputs& inputs, ShadedSplats& shaded,
                const Progress& progress, LookStatistics* statistics) {
    const auto start = std::chrono::steady_clock::now();
    const LookUniforms uniforms = prepare_look(set, look, inputs);
    make_room(shaded, set.size());
    const LookRun run{set, uniforms, inputs.thickness_map, shaded};
    std::vector<std::int64_t> kept(std::size_t((set.size() + chunk_size - 1) / chunk_size));
    std::atomic<std::int64_t> done{0};
    parallel_chunks(set.size(), chunk_size, [&](std::int64_t begin, std::int64_t end, int) {
        progress.check();
        kept[std::size_t(begin / chunk_size)] = shade_run(run, begin, end);
        progress.at(double(done += end - begin) / double(set.size()));
    });
    close_gaps(shaded, kept);
    if (!statistics) return;
    statistics->kept = shaded.size();
    statistics->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

ShadedSplats apply_look(const SplatSet& set, const Look& look, const LookInputs& inputs,
                        const Progress& progress, LookStatistics* statistics) {
    ShadedSplats shaded;
    apply_look(set, look, inputs, shaded, progress, statistics);
    trim(shaded.position);
    trim(shaded.color);
    trim(shaded.alpha);
    trim(shaded.radius);
    trim(shaded.id);
    return shaded;
}

}  // namespace astrosplat

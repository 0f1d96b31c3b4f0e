#include "generate/columns.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "generate/kept_store.h"
#include "generate/surface.h"
#include "source/sample.h"
#include "splats/splat_set.h"

namespace astrosplat {
namespace {

constexpr std::int64_t rows_at_once = 1 << 14;

/// Rows whose alpha is not 0, before each chunk of rows; the last is the number of all.
std::vector<std::int64_t> lit_before_chunks(const Buffer<float>& alpha) {
    const auto rows = static_cast<std::int64_t>(alpha.size());
    std::vector<std::int64_t> before(static_cast<std::size_t>((rows + rows_at_once - 1) / rows_at_once) + 1);
    parallel_chunks(rows, rows_at_once, [&](std::int64_t begin, std::int64_t end, int) {
        std::int64_t lit = 0;
        for (std::int64_t i = begin; i < end; ++i) lit += alpha[i] > 0.0f;
        before[begin / rows_at_once + 1] = lit;
    });
    for (std::size_t i = 1; i < before.size(); ++i) before[i] += before[i - 1];
    return before;
}

template <class T>
Buffer<T> lit_rows(const Buffer<T>& all, const Buffer<float>& alpha,
                   const std::vector<std::int64_t>& before) {
    Buffer<T> lit(static_cast<std::size_t>(before.back()));
    parallel_chunks(static_cast<std::int64_t>(all.size()), rows_at_once,
                    [&](std::int64_t begin, std::int64_t end, int) {
                        std::int64_t to = before[begin / rows_at_once];
                        for (std::int64_t i = begin; i < end; ++i)
                            if (alpha[i] > 0.0f) lit[to++] = all[i];
                    });
    return lit;
}

}  // namespace

void read_texels(std::span<const TexturedMesh> meshes, Columns& columns, const Progress& progress) {
    SplatSet& set = columns.splats;
    describe_pictures(meshes, set);
    const Buffer<SurfaceTriangle> surface = surface_triangles(meshes, set.spacing);
    set.color.resize(set.position.size());
    set.alpha.resize(set.position.size());
    constexpr std::int64_t ahead = 16;  // rows whose triangles are on their way
    parallel_chunks(set.size(), rows_at_once, [&](std::int64_t begin, std::int64_t end, int) {
        progress.check();
        for (std::int64_t i = begin; i < end; ++i) {
            __builtin_prefetch(&surface[set.face[std::min(i + ahead, end - 1)]]);
            const SurfaceTriangle& triangle = surface[set.face[i]];
            const TextureSample picture = sample(*triangle.texture, set.uv[i], triangle.box_texels);
            set.color[i] = picture.color;
            set.alpha[i] = picture.alpha;
        }
    });
}

void show_end(const Columns& columns, KeptWatcher& watcher) {
    watcher.ends({sample_rows(columns.splats, watcher.sample_limit())}, columns.splats.size());
}

SplatSet lit_splats(Columns columns) {
    SplatSet set = std::move(columns.splats);
    drop_columns(set, {});
    const std::vector<std::int64_t> before = lit_before_chunks(set.alpha);
    const std::int64_t dark = set.size() - before.back();
    if (dark == 0) return set;
    set.zero_alpha += dark;
    const Buffer<float> alpha = set.alpha;
    for_each_column([&](auto column, SplatColumn) {
        if (!(set.*column).empty()) set.*column = lit_rows(set.*column, alpha, before);
    });
    return set;
}

}  // namespace astrosplat

// Sets in memory, and sets in files. A native file's order is that of 64^3 cells along a Morton curve, and of
// ids within a cell, so cubes of 8^n cells follow each other in the file: each is made by a cull of the part
// of the lattice that reaches into it.
#include "generate/generate.h"

#include <cfloat>

#include "core/memory.h"
#include "core/parallel.h"
#include "generate/kept_store.h"
#include "generate/lattice_cull.h"
#include "generate/triangle_tree.h"
#include "source/texture.h"
#include "splat_files/native.h"
#include "splats/row_order.h"

namespace astrosplat {
namespace {

constexpr std::int64_t rows_at_once = 1 << 14;

/// Rows whose alpha is not 0, before each chunk of rows; the last is the number of all.
std::vector<std::int64_t> lit_before_chunks(const Buffer<float>& alpha) {
    const auto rows = std::int64_t(alpha.size());
    std::vector<std::int64_t> before(std::size_t((rows + rows_at_once - 1) / rows_at_once) + 1);
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
    Buffer<T> lit(std::size_t(before.back()));
    parallel_chunks(std::int64_t(all.size()), rows_at_once, [&](std::int64_t begin, std::int64_t end, int) {
        std::int64_t to = before[begin / rows_at_once];
        for (std::int64_t i = begin; i < end; ++i)
            if (alpha[i] > 0.0f) lit[to++] = all[i];
    });
    return lit;
}

// Adds what is kept to the set.
void run_cull(const LatticeCull& cull, const Progress& progress, KeptWatcher* watcher, SplatSet& set) {
    const std::vector<LatticeBlock> blocks = cull.blocks({}, progress);
    reserve(set, blocks.size() * 2 * block_positions);
    const auto append = [&](std::span<const KeptStore::Run> runs) { append_sorted(runs, set); };
    set.zero_alpha += cull.run(blocks, progress, append, watcher);
}

/// Memory of so many positions, and of a batch of them that exists twice.
double bytes_of_positions(double positions) {
    constexpr double most_in_batch =
        0.5 * LatticeCull::batch_blocks * block_positions;  // a surface keeps half of a block
    return positions * double(bytes_per_splat(is_generated)) +
           std::min(0.5 * positions, most_in_batch) * double(sizeof(KeptSplat));
}

// The facts of columns before any of them is made: zero_alpha is 0.
SplatSetFacts facts_of_columns(std::span<const TexturedMesh> meshes, const Lattice& lattice,
                               double max_distance) {
    SplatSetFacts facts;
    facts.spacing = lattice.spacing();
    facts.max_distance = max_distance;
    facts.generated = true;
    facts.test_positions = lattice.positions();
    describe_pictures(meshes, facts);
    return facts;
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

std::int64_t columns_memory_bytes(std::int64_t positions) {
    return std::int64_t(bytes_of_positions(double(positions)));
}

std::int64_t columns_memory_bytes(std::span<const TexturedMesh> meshes, const Lattice& lattice,
                                  double max_distance) {
    double triangles = 0.0;
    for (const TexturedMesh& m : meshes) triangles += double(m.mesh.triangles.size());
    const double per_triangle =
        sizeof(TreeTriangle) + sizeof(SurfaceTriangle) + 6.9 * sizeof(float);  // 8/7 boxes
    const double bytes =
        bytes_of_positions(expected_positions(lattice, meshes, max_distance)) + triangles * per_triangle;
    return std::int64_t(std::min(bytes, 9e18));
}

KeptCounts count_kept(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance) {
    KeptCounts counts;
    const LatticeCull cull(meshes, lattice, {max_distance, 1.0, 1});
    const std::int64_t unseen = cull.run(cull.blocks({}, {}), {}, [&](std::span<const KeptStore::Run> runs) {
        for (const KeptStore::Run& run : runs) {
            counts.kept += std::int64_t(run.count);
            counts.lit += std::int64_t(run.lit);
        }
    });
    counts.kept += unseen;
    return counts;
}

Columns make_columns(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                     double jitter, std::uint32_t seed, const Progress& progress, KeptWatcher* watcher) {
    claim_memory(columns_memory_bytes(meshes, lattice, max_distance), "generating splats");
    Columns columns;
    static_cast<SplatSetFacts&>(columns.splats) = facts_of_columns(meshes, lattice, max_distance);
    run_cull(LatticeCull(meshes, lattice, {max_distance, jitter, seed}), progress, watcher, columns.splats);
    check_consistent(columns.splats);
    if (watcher) show_end(columns, *watcher);
    return columns;
}

SplatSet generate(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                  double jitter, std::uint32_t seed, const Progress& progress) {
    return lit_splats(make_columns(meshes, lattice, max_distance, jitter, seed, progress));
}

namespace {

/// Facts about the set, known before any of it is written.
struct Survey {
    std::int64_t lit = 0, dark = 0, unseen = 0;  // positions: alpha above 0, alpha 0, no picture there
    Bounds lit_box;                              // of positions whose alpha is above 0
    std::vector<std::int64_t> kept;              // positions with either alpha, in each cell of `cells`
};

constexpr std::int64_t runs_at_once = 64;

void add_to(std::span<const KeptStore::Run> runs, const SpatialCells& cells, std::vector<Survey>& workers) {
    parallel_chunks(std::int64_t(runs.size()), runs_at_once,
                    [&](std::int64_t begin, std::int64_t end, int number) {
                        Survey& own = workers[number];
                        for (std::int64_t i = begin; i < end; ++i) {
                            const KeptStore::Run& run = runs[i];
                            for (const KeptSplat& splat : std::span(run.splats, run.count)) {
                                ++own.kept[cells.of(splat.position)];
                                if (splat.alpha > 0.0f) own.lit_box.add(glm::dvec3(splat.position));
                            }
                            own.lit += std::int64_t(run.lit);
                            own.dark += std::int64_t(run.count - run.lit);
                        }
                    });
}

/// Slabs of the lattice, of whole blocks each, along its longest axis.
std::vector<CellRange> slabs_of(const Lattice& lattice, std::int64_t count) {
    int axis = 0;
    for (int other = 1; other < 3; ++other)
        if (lattice.n[other] > lattice.n[axis]) axis = other;
    const std::int64_t layers = lattice.n[axis] / block_cells + 1,
                       wanted = std::clamp<std::int64_t>(count, 1, layers);
    std::vector<CellRange> slabs(wanted);
    for (std::int64_t i = 0; i < wanted; ++i) {
        CellRange& slab = slabs[i];
        slab.lo[axis] = i * layers / wanted * block_cells;
        slab.hi[axis] = (i + 1) * layers / wanted * block_cells;
    }
    return slabs;
}

Survey survey_of(const LatticeCull& cull, const std::vector<CellRange>& slabs, const SpatialCells& cells,
                 const Progress& progress) {
    std::vector<Survey> workers(thread_count());
    for (Survey& worker : workers) worker.kept.resize(SpatialCells::count);
    Survey survey;
    for (std::size_t i = 0; i < slabs.size(); ++i) {
        const auto share = [&](std::size_t done) { return double(done) / double(slabs.size()); };
        survey.unseen +=
            cull.run(cull.blocks(slabs[i], progress), progress.part(share(i), share(i + 1)),
                     [&](std::span<const KeptStore::Run> runs) { add_to(runs, cells, workers); });
    }
    survey.kept.resize(SpatialCells::count);
    for (const Survey& worker : workers) {
        survey.lit += worker.lit;
        survey.dark += worker.dark;
        survey.lit_box.add(worker.lit_box);
        for (std::size_t cell = 0; cell < survey.kept.size(); ++cell) survey.kept[cell] += worker.kept[cell];
    }
    return survey;
}

/// Cells of the file's order, from `first` on.
struct Part {
    std::uint32_t first, cells;
    std::int64_t most;  // positions that a cull of it keeps, at most
};

/// Halves space until parts hold no more than `most` positions.
struct PartList {
    const Survey& survey;
    const SpatialCells &surveyed, &cells;
    std::int64_t most;
    std::vector<Part> parts = {};

    void add(std::uint32_t first, std::uint32_t count) {
        const std::int64_t kept = kept_about(cells.cube(first, count));
        if (kept == 0) return;
        if (kept <= most || count == 1 || !cells.extended()) {
            parts.push_back({first, count, kept});
            return;
        }
        for (std::uint32_t child = 0; child < 8; ++child) add(first + child * (count / 8), count / 8);
    }

    /// Positions in all surveyed cells that the cube reaches, and in its neighbourhood's.
    std::int64_t kept_about(const Bounds& cube) const {
        const glm::dvec3 margin(1e-6 * cube.extent().x);
        const glm::uvec3 lo = surveyed.place_of(cube.lo - margin), hi = surveyed.place_of(cube.hi + margin);
        std::int64_t kept = 0;
        for (std::uint32_t z = lo.z; z <= hi.z; ++z)
            for (std::uint32_t y = lo.y; y <= hi.y; ++y)
                for (std::uint32_t x = lo.x; x <= hi.x; ++x)
                    kept += survey.kept[SpatialCells::number_of({x, y, z})];
        return kept;
    }
};

/// The cells of the lattice whose positions, moved by jitter and rounded, may lie in the cube.
CellRange cells_about(const Bounds& cube, const Lattice& lattice) {
    const glm::dvec3 size = glm::max(glm::abs(lattice.box.lo), glm::abs(lattice.box.hi));
    const glm::dvec3 rounding(2.0 * FLT_EPSILON * std::max({size.x, size.y, size.z}));
    const glm::dvec3 spacing = lattice.spacing();
    CellRange range;
    for (int axis = 0; axis < 3; ++axis) {
        const double lo = (cube.lo[axis] - rounding[axis] - lattice.box.lo[axis]) / spacing[axis];
        const double hi = (cube.hi[axis] + rounding[axis] - lattice.box.lo[axis]) / spacing[axis];
        const auto last = double(lattice.n[axis]);
        range.lo[axis] = std::int64_t(std::clamp(std::floor(lo) - 2.0, 0.0, last));
        range.hi[axis] = std::int64_t(std::clamp(std::ceil(hi) + 2.0, 0.0, last) + 1.0);
    }
    return range;
}

/// Writes the part's rows: the lit positions in its cells.
void write_part(const LatticeCull& cull, const Lattice& lattice, const SpatialCells& cells, const Part& part,
                const Progress& progress, NativeStream& file) {
    const std::vector<LatticeBlock> blocks =
        cull.blocks(cells_about(cells.cube(part.first, part.cells), lattice), progress);
    SplatSet set;
    reserve(set, blocks.size() * 2 * block_positions);
    cull.run(blocks, progress, [&](std::span<const KeptStore::Run> runs) { append_sorted(runs, set); });
    Buffer<std::uint32_t> bins(set.position.size());
    parallel_each(bins.size(), 1 << 14, [&](std::size_t i) {
        const std::uint32_t cell = cells.of(set.position[i]) - part.first;
        bins[i] = cell < part.cells && set.alpha[i] > 0.0f ? cell : part.cells;
    });
    const auto others = std::size_t(std::ranges::count(bins, part.cells));
    const Buffer<std::uint32_t> rows = rows_by_bin<std::uint32_t>(bins, part.cells + 1, set.id);
    file.append(set, std::span(rows).first(rows.size() - others));
}

// Without splats none.
SplatColumns written_columns(std::int64_t splats) {
    SplatColumns columns;
    for_each_column([&](auto, SplatColumn column) {
        columns.set(index_of(column), splats > 0 && is_generated(column) && column != SplatColumn::face);
    });
    return columns;
}

}  // namespace

std::int64_t write_columns(const WriteTarget& target, std::span<const TexturedMesh> meshes,
                           const Lattice& lattice, double max_distance, double jitter, std::uint32_t seed,
                           std::int64_t room_bytes, const Progress& progress) {
    constexpr double positions_of_block = 4.0;  // few: of the thinnest sheets
    const LatticeCull cull(meshes, lattice, {max_distance, jitter, seed});
    const SpatialCells surveyed(lattice.box);
    const double blocks = expected_positions(lattice, meshes, max_distance) / positions_of_block;
    const double slabs = std::ceil(blocks * sizeof(LatticeBlock) / (0.25 * double(room_bytes)));
    const Survey survey = survey_of(cull, slabs_of(lattice, std::int64_t(std::min(slabs, 1e9))), surveyed,
                                    progress.part(0.0, 0.45));

    SplatSetFacts facts = facts_of_columns(meshes, lattice, max_distance);
    facts.zero_alpha = survey.dark + survey.unseen;
    NativeStream file(target, facts, written_columns(survey.lit), survey.lit);
    if (survey.lit > 0) {
        const std::int64_t bytes_per_row =
            std::int64_t(bytes_per_splat(is_generated)) + 2 * sizeof(std::uint32_t) + sizeof(LatticeBlock);
        const SpatialCells cells(survey.lit_box);
        PartList list{survey, surveyed, cells, room_bytes / bytes_per_row};
        list.add(0, SpatialCells::count);
        const std::vector<Part>& parts = list.parts;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto share = [&](std::size_t done) {
                return 0.45 + 0.55 * double(done) / double(parts.size());
            };
            claim_memory(parts[i].most * bytes_per_row, "a part of the splats");
            write_part(cull, lattice, cells, parts[i], progress.part(share(i), share(i + 1)), file);
        }
    }
    file.finish();
    return survey.lit;
}

}  // namespace astrosplat

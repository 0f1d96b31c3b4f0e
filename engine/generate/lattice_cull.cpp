// Surface attributes of triangles are prepared once, so that a kept position costs one lookup. The octree is
// gone through level by level, so that each level is one parallel loop. Threads then take short rows of
// blocks; what they write depends on the row alone.
#include "generate/lattice_cull.h"

#include <atomic>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tuple>

#include "core/parallel.h"
#include "core/text.h"
#include "source/origin.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

// |gradient of u * voxel side|, for u and v: the gradient is the one along the surface, so for gradients g of
// the barycentric weights it is uv_ab * g_b + uv_ac * g_c.
glm::vec2 texels_per_voxel(const SurfaceTriangle& t, const TriangleShape& s, const glm::dvec3& spacing) {
    const double determinant = s.ab_ab * s.ac_ac - s.ab_ac * s.ab_ac;
    if (!(determinant > 0.0)) return glm::vec2(0.0f);
    const glm::dvec3 g_b = (s.ab * s.ac_ac - s.ac * s.ab_ac) / determinant;
    const glm::dvec3 g_c = (s.ac * s.ab_ab - s.ab * s.ab_ac) / determinant;
    const glm::dvec2 uv_ab = glm::dvec2(t.uv_b) - glm::dvec2(t.uv_a);
    const glm::dvec2 uv_ac = glm::dvec2(t.uv_c) - glm::dvec2(t.uv_a);
    const glm::dvec3 along_u = (g_b * uv_ab.x + g_c * uv_ac.x) * spacing;
    const glm::dvec3 along_v = (g_b * uv_ab.y + g_c * uv_ac.y) * spacing;
    return glm::vec2(std::sqrt(glm::dot(along_u, along_u)) * double(t.texture->image.width),
                     std::sqrt(glm::dot(along_v, along_v)) * double(t.texture->image.height));
}

// The same for a picture that is seen through a camera, at the face's own depth.
glm::vec2 texels_per_voxel(const TexturedMesh& m, const SurfaceTriangle& t, const TriangleShape& s,
                           const glm::dvec3& spacing) {
    const std::optional<PlaceInPicture> seen = place_in_picture(*m.camera, s.a + (s.ab + s.ac) / 3.0);
    if (!seen) return glm::vec2(0.0f);
    const double texels_per_unit =
        double(t.texture->image.height) / picture_height_at(*m.camera, seen->depth);
    const glm::dmat3& axes = m.camera->world_from_camera;
    return glm::vec2(glm::length(axes[0] * spacing), glm::length(axes[1] * spacing)) * float(texels_per_unit);
}

glm::vec3 face_normal(const TriangleShape& s) {
    const glm::dvec3 n = glm::cross(s.ab, s.ac);
    const double length = std::sqrt(glm::dot(n, n));
    return length > 0.0 ? glm::vec3(n / length) : glm::vec3(0.0f, 1.0f, 0.0f);
}

SurfaceTriangle surface_triangle(const TexturedMesh& m, const Mesh::Triangle& face,
                                 const TriangleShape& shape, const glm::dvec3& spacing) {
    const auto uv = [&](std::size_t corner) {
        return face.uv[corner] == Mesh::no_uv ? glm::vec2(0.0f) : m.mesh.uvs[face.uv[corner]];
    };
    const std::size_t texture = m.textures.size() == 1 ? 0 : face.material;
    assert(texture < m.textures.size());
    SurfaceTriangle t{uv(0),
                      uv(1),
                      uv(2),
                      face_normal(shape),
                      {},
                      0,
                      &m.textures[texture],
                      m.camera ? &*m.camera : nullptr};
    t.box_texels = m.camera ? texels_per_voxel(m, t, shape, spacing) : texels_per_voxel(t, shape, spacing);
    return t;
}

// Blocks of the next finer level that begin inside the lattice and reach into the range; corners reach one
// cell further than centres.
std::vector<LatticeBlock> split(const std::vector<LatticeBlock>& parents, const Lattice& lattice,
                                const CellRange& range, std::int64_t child_cells) {
    const glm::i64vec3 first = range.lo / child_cells;
    const glm::i64vec3 last = glm::min(lattice.n, range.hi - std::int64_t{1}) / child_cells;
    std::vector<LatticeBlock> children;
    children.reserve(parents.size() * 8);
    for (const LatticeBlock& parent : parents) {
        for (int child = 0; child < 8; ++child) {
            const glm::i64vec3 at =
                parent.at * std::int64_t{2} + glm::i64vec3(child & 1, child >> 1 & 1, child >> 2);
            if (at.x >= first.x && at.y >= first.y && at.z >= first.z && at.x <= last.x && at.y <= last.y &&
                at.z <= last.z)
                children.push_back({at, parent.near_slot});
        }
    }
    return children;
}

void drop_far(std::vector<LatticeBlock>& blocks, std::int64_t cells, const TriangleTree& tree,
              const Lattice& lattice, const CullSettings& settings) {
    parallel_each(blocks.size(), 256, [&](std::size_t i) {
        LatticeBlock& block = blocks[i];
        const BlockBall ball = block_ball(lattice, settings.jitter, block.at * cells, cells);
        block.near_slot =
            closest_point(tree, ball.center, settings.max_distance + ball.radius, block.near_slot).slot;
    });
    std::erase_if(blocks, [](const LatticeBlock& block) { return block.near_slot == ClosestPoint::none; });
}

}  // namespace

Buffer<SurfaceTriangle> surface_triangles(std::span<const TexturedMesh> meshes, const glm::dvec3& spacing) {
    std::size_t count = 0, first = 0;
    for (const TexturedMesh& m : meshes) count += m.mesh.triangles.size();
    Buffer<SurfaceTriangle> triangles(count);
    for (std::size_t number = 0; number < meshes.size(); ++number) {
        const TexturedMesh& m = meshes[number];
        const auto corner = [&](const Mesh::Triangle& face, std::size_t k) {
            return glm::dvec3(m.mesh.positions[face.position[k]]);
        };
        parallel_each(m.mesh.triangles.size(), 4096, [&](std::size_t i) {
            const Mesh::Triangle& face = m.mesh.triangles[i];
            const TriangleShape shape = triangle_shape(corner(face, 0), corner(face, 1), corner(face, 2));
            triangles[first + i] = surface_triangle(m, face, shape, spacing);
            triangles[first + i].mesh = std::uint32_t(number);
        });
        first += m.mesh.triangles.size();
    }
    return triangles;
}

void describe_pictures(std::span<const TexturedMesh> meshes, SplatSetFacts& facts) {
    std::vector<std::string> credits;
    facts.divided = false;
    for (const TexturedMesh& m : meshes) {
        for (const Texture& texture : m.textures) {
            facts.divided = facts.divided || texture.divided;
            credits.push_back(texture.credit);
        }
    }
    facts.credit = joined_once(credits);
    facts.origin = columns_origin;
}

std::optional<glm::vec2> uv_of(const SurfaceTriangle& triangle, const glm::dvec2& barycentric,
                               const glm::dvec3& position) {
    if (!triangle.camera) {
        const glm::dvec2 a(triangle.uv_a), ab = glm::dvec2(triangle.uv_b) - a,
                                           ac = glm::dvec2(triangle.uv_c) - a;
        return glm::vec2(a + ab * barycentric.x + ac * barycentric.y);
    }
    const std::optional<PlaceInPicture> seen = place_in_picture(*triangle.camera, position);
    if (!seen) return std::nullopt;
    return glm::vec2(seen->uv);
}

BlockBall block_ball(const Lattice& lattice, double jitter, const glm::i64vec3& first, std::int64_t cells) {
    const glm::i64vec3 last_corner = glm::min(first + (cells - 1), lattice.n);
    const glm::i64vec3 last_centre = glm::min(first + (cells - 1), lattice.n - std::int64_t{1});
    const glm::dvec3 last = glm::max(glm::dvec3(last_corner), glm::dvec3(last_centre) + 0.5);
    const glm::dvec3 low = glm::dvec3(first) - 0.5 * jitter, high = last + 0.5 * jitter;
    const glm::dvec3 spacing = lattice.spacing();
    const glm::dvec3 size = glm::max(glm::abs(lattice.box.lo), glm::abs(lattice.box.hi));
    const double rounding =
        1e-14 * (size.x + size.y + size.z);  // of positions and of the middle, many times over
    return {lattice.box.lo + spacing * ((low + high) * 0.5),
            glm::length(spacing * ((high - low) * 0.5)) * (1.0 + 1e-9) + rounding};
}

std::vector<LatticeBlock> blocks_near(const TriangleTree& tree, const Lattice& lattice,
                                      const CullSettings& settings, const Progress& progress,
                                      const CellRange& range) {
    std::int64_t cells = block_cells;
    while (cells <= std::max({lattice.n.x, lattice.n.y, lattice.n.z})) cells *= 2;
    std::vector<LatticeBlock> blocks{{glm::i64vec3(0), ClosestPoint::none}};
    while (true) {
        progress.check();
        drop_far(blocks, cells, tree, lattice, settings);
        if (cells == block_cells) break;
        cells /= 2;
        blocks = split(blocks, lattice, range, cells);
    }
    std::ranges::sort(blocks, [](const LatticeBlock& a, const LatticeBlock& b) {
        return std::tie(a.at.z, a.at.y, a.at.x) < std::tie(b.at.z, b.at.y, b.at.x);
    });
    return blocks;
}

namespace {

constexpr std::size_t longest_row = 64;  // blocks: their answers stay in the second-level cache
constexpr std::size_t batch_blocks = LatticeCull::batch_blocks;

/// Blocks begin .. end-1: a row has the same (y, z) and ascending x, a batch is whole layers of the same z.
struct BlockRange {
    std::size_t begin, end;
};

std::vector<BlockRange> rows_of(const std::vector<LatticeBlock>& blocks, const BlockRange& batch) {
    std::vector<BlockRange> rows;
    for (std::size_t i = batch.begin; i < batch.end; ++i) {
        const bool joins = !rows.empty() && i - rows.back().begin < longest_row &&
                           blocks[i - 1].at.y == blocks[i].at.y && blocks[i - 1].at.z == blocks[i].at.z;
        if (!joins) rows.push_back({i, i});
        rows.back().end = i + 1;
    }
    return rows;
}

// Ids of one batch come before those of the next, because a batch ends where a layer of blocks does.
std::vector<BlockRange> batches_of(const std::vector<LatticeBlock>& blocks) {
    std::vector<BlockRange> batches;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const bool new_layer = i == 0 || blocks[i - 1].at.z != blocks[i].at.z;
        if (batches.empty() || (new_layer && i - batches.back().begin >= batch_blocks))
            batches.push_back({i, i});
        batches.back().end = i + 1;
    }
    return batches;
}

/// The state of one thread, and its results.
struct Worker {
    std::vector<BlockAnswers> answers;
    std::vector<std::uint32_t> scratch;
    KeptStore kept;
    std::int64_t unseen = 0;  // positions that no picture shows, whatever it is
};

// All corners, then all centres, as their ids ask for; each time batch by batch,
// so that little is stored twice.
struct BlockRun {
    const TriangleTree& tree;
    const Buffer<SurfaceTriangle>& surface;
    const Lattice& lattice;
    const CullSettings& settings;
    const Progress& progress;
    KeptWatcher* watcher;
    std::vector<Worker> workers = std::vector<Worker>(thread_count());
    std::atomic<std::size_t> done{0};  // blocks, each once for either kind

    std::int64_t run(const std::vector<LatticeBlock>& blocks, const TakeKept& take) {
        const std::vector<BlockRange> batches = batches_of(blocks);
        for (const Positions kind : {Positions::corners, Positions::centres}) {
            for (const BlockRange& batch : batches) {
                run_batch(blocks, batch, kind);
                hand_over(take);
            }
        }
        std::int64_t unseen = 0;
        for (const Worker& worker : workers) unseen += worker.unseen;
        return unseen;
    }

    void run_batch(const std::vector<LatticeBlock>& blocks, const BlockRange& batch, Positions kind) {
        const std::vector<BlockRange> rows = rows_of(blocks, batch);
        parallel_for(std::int64_t(rows.size()), [&](std::int64_t row, int number) {
            progress.check();
            const BlockRange& range = rows[row];
            const std::size_t count = range.end - range.begin;
            Worker& worker = workers[number];
            const std::size_t runs = worker.kept.runs().size();
            run_row({&blocks[range.begin], count}, kind, worker);
            if (watcher) watcher->keeps(std::span(worker.kept.runs()).subspan(runs));
            progress.at(0.5 * double(done += count) / double(blocks.size()));
        });
    }

    // The answers in order of id: each lattice row across all blocks, which is a run of the store.
    void run_row(std::span<const LatticeBlock> row, Positions kind, Worker& worker) const {
        worker.answers.resize(longest_row);
        for (std::size_t i = 0; i < row.size(); ++i)
            query_block(tree, lattice, settings, row[i], kind, worker.scratch, worker.answers[i]);
        for (std::size_t k = 0; k < block_cells; ++k) {
            for (std::size_t j = 0; j < block_cells; ++j) {
                worker.kept.begin_run();
                for (std::size_t b = 0; b < row.size(); ++b)
                    keep_row_of_block(row[b], kind, j, k, worker.answers[b], worker);
            }
        }
    }

    void keep_row_of_block(const LatticeBlock& block, Positions kind, std::size_t j, std::size_t k,
                           const BlockAnswers& answers, Worker& worker) const {
        const glm::i64vec3 at = block.at * block_cells + glm::i64vec3(0, j, k);
        const std::uint64_t id = kind == Positions::centres ? centre_id(lattice, at) : corner_id(lattice, at);
        for (std::size_t i = 0; i < block_cells; ++i) {
            const std::size_t slot = block_slot(i, j, k);
            if (answers.triangle[slot] != ClosestPoint::none) keep(answers, slot, id + i, worker);
        }
    }

    void keep(const BlockAnswers& answers, std::size_t slot, std::uint64_t id, Worker& worker) const {
        const SurfaceTriangle& face = surface[answers.triangle[slot]];
        const glm::dvec3 place(answers.x[slot], answers.y[slot], answers.z[slot]);
        const std::optional<glm::vec2> uv = uv_of(face, {answers.v[slot], answers.w[slot]}, place);
        if (!uv) {
            ++worker.unseen;
            return;
        }
        const TextureSample picture = sample(*face.texture, *uv, face.box_texels);
        const glm::vec3 position(place);
        const auto distance = float(std::sqrt(answers.distance_squared[slot]));
        worker.kept.add({position, picture.color, picture.alpha, distance, id, *uv, face.normal, face.mesh,
                         answers.triangle[slot]});
    }

    void hand_over(const TakeKept& take) {
        std::vector<KeptStore::Run> runs;
        for (const Worker& worker : workers)
            runs.insert(runs.end(), worker.kept.runs().begin(), worker.kept.runs().end());
        take(runs);
        for (Worker& worker : workers) worker.kept.clear();
    }
};

TriangleTree tree_of(std::span<const TexturedMesh> meshes) {
    std::vector<const Mesh*> shapes;
    for (const TexturedMesh& m : meshes) shapes.push_back(&m.mesh);
    return make_triangle_tree(shapes);
}

}  // namespace

LatticeCull::LatticeCull(std::span<const TexturedMesh> meshes, const Lattice& lattice,
                         const CullSettings& settings)
    : lattice_(lattice),
      settings_(settings),
      tree_(tree_of(meshes)),
      surface_(surface_triangles(meshes, lattice.spacing())) {}

std::vector<LatticeBlock> LatticeCull::blocks(const CellRange& range, const Progress& progress) const {
    return blocks_near(tree_, lattice_, settings_, progress, range);
}

std::int64_t LatticeCull::run(const std::vector<LatticeBlock>& blocks, const Progress& progress,
                              const TakeKept& take, KeptWatcher* watcher) const {
    return BlockRun{tree_, surface_, lattice_, settings_, progress, watcher}.run(blocks, take);
}

}  // namespace astrosplat

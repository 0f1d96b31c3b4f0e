// Reading copies straight from the page cache; the checksum tells damage, and what a reader would index with
// is looked at besides.
#include "viewer/kept_trees.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "splat_files/file_bytes.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic = "\x89TREE\r\n\x1a";
constexpr std::uint32_t version = 2;
constexpr std::int64_t rows_a_chunk = 1 << 16;
constexpr std::int64_t largest_share =
    8;  // a tree takes at most an eighth of the cache: none drives out its set

struct Header {
    char magic[8];
    std::uint32_t version, levels;
    std::uint64_t rows, nodes;
};
static_assert(sizeof(Header) == 32);

template <class T>
std::string_view bytes_of(std::span<const T> array) {
    return {reinterpret_cast<const char*>(array.data()), array.size_bytes()};
}

/// Hex; all that build_merge_tree looks at.
std::string name_of(const SplatSet& set, const Progress& progress) {
    const std::int64_t chunks = (set.size() + rows_a_chunk - 1) / rows_a_chunk;
    std::vector<std::uint64_t> sums(static_cast<std::size_t>(3 * chunks));
    parallel_for(chunks, [&](std::int64_t c, int) {
        progress.check();
        const auto first = static_cast<std::size_t>(c * rows_a_chunk);
        const auto count = std::min(set.id.size() - first, static_cast<std::size_t>(rows_a_chunk));
        sums[3 * c] = xxh64(bytes_of(std::span<const glm::vec3>(&set.position[first], count)));
        sums[3 * c + 1] = xxh64(bytes_of(std::span<const std::uint64_t>(&set.id[first], count)));
        if (!set.absorbs) return;
        std::string absorbing(count, '\0');
        for (std::size_t i = 0; i < count; ++i) absorbing[i] = set.color[first + i].x < 0.0f;
        sums[3 * c + 2] = xxh64(absorbing);
    });
    const std::int64_t size = set.size();
    const bool lattice = set.is_on_lattice();
    return Sha256()
        .add(&version, sizeof version)
        .add(&size, sizeof size)
        .add(&lattice, sizeof lattice)
        .add(bytes_of(std::span<const std::uint64_t>(sums)))
        .hex();
}

std::int64_t file_bytes(std::size_t levels, std::size_t rows, std::size_t nodes) {
    return static_cast<std::int64_t>(sizeof(Header) + levels * sizeof(std::int64_t) +
                                     rows * sizeof(std::int64_t) + nodes * sizeof(MergeNode) +
                                     sizeof(std::uint64_t));
}

template <class Array>
void take(std::string_view& bytes, std::size_t count, Array& array) {
    array.resize(count);
    const std::size_t size = count * sizeof(array[0]);
    constexpr std::size_t at_once = 1 << 22;
    parallel_for(static_cast<std::int64_t>((size + at_once - 1) / at_once), [&](std::int64_t c, int) {
        const std::size_t first = static_cast<std::size_t>(c) * at_once;
        std::memcpy(reinterpret_cast<char*>(array.data()) + first, bytes.data() + first,
                    std::min(at_once, size - first));
    });
    bytes.remove_prefix(size);
}

/// Whether nothing in it leads out of its arrays.
bool is_sound(const MergeTree& tree) {
    const auto rows = static_cast<std::int64_t>(tree.rows.size());
    const auto nodes = static_cast<std::int64_t>(tree.nodes.size());
    std::atomic<bool> sound{std::ranges::is_sorted(tree.levels) && !tree.levels.empty() &&
                            tree.levels.front() == 0 && tree.levels.back() == nodes};
    parallel_chunks(rows, rows_a_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin; i < end; ++i)
            if (tree.rows[i] < 0 || tree.rows[i] >= rows) sound = false;
    });
    parallel_chunks(nodes, rows_a_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin; i < end; ++i) {
            const MergeNode& node = tree.nodes[i];
            const bool in_rows = 0 <= node.first && node.first < node.end && node.end <= rows;
            const bool below = node.is_leaf() || (node.children > i && node.children + 1 < nodes);
            if (!in_rows || !below) sound = false;
        }
    });
    return sound;
}

/// Nothing where this is no tree of so many rows.
std::optional<MergeTree> tree_of(std::string_view bytes, std::int64_t rows) {
    Header header;
    if (bytes.size() < sizeof header + sizeof(std::uint64_t)) return std::nullopt;
    std::memcpy(&header, bytes.data(), sizeof header);
    const std::string_view body = bytes.substr(0, bytes.size() - sizeof(std::uint64_t));
    const std::uint64_t most = bytes.size();  // of anything, so that no product overflows
    if (std::string_view(header.magic, sizeof header.magic) != magic || header.version != version ||
        header.rows != static_cast<std::uint64_t>(rows) || header.rows > most || header.nodes > most ||
        file_bytes(header.levels, header.rows, header.nodes) != static_cast<std::int64_t>(bytes.size()))
        return std::nullopt;
    std::uint64_t checksum;
    std::memcpy(&checksum, bytes.data() + body.size(), sizeof checksum);
    if (xxh64(body) != checksum) return std::nullopt;
    std::string_view rest = body.substr(sizeof header);
    MergeTree tree;
    take(rest, header.levels, tree.levels);
    take(rest, header.rows, tree.rows);
    take(rest, header.nodes, tree.nodes);
    if (!is_sound(tree)) return std::nullopt;
    return tree;
}

std::optional<MergeTree> read_tree(const fs::path& file, std::int64_t rows) try {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (error) return std::nullopt;
    claim_memory(static_cast<std::int64_t>(size), "the tree of a preview");
    std::optional<MergeTree> tree =
        read_mapped(file, [&](std::string_view bytes) { return tree_of(bytes, rows); });
    if (tree)
        fs::last_write_time(file, fs::file_time_type::clock::now(), error);  // refused: it seems older
    else if (fs::remove(file, error))
        log_detail(file.string() + ": damaged or of another version; the tree is built again");
    return tree;
} catch (const InputError&) {  // not to be read, or no memory for it: what builds it says so
    return std::nullopt;
}

}  // namespace

KeptTree read_or_build_tree(const SetCache& cache, const SplatSet& set, const Progress& progress) {
    KeptTree kept;
    if (!cache.folder.empty() && set.size() > 0) {
        kept.file = cache.folder / (name_of(set, progress) + ".tree");
        if (std::optional<MergeTree> tree = read_tree(kept.file, set.size())) {
            kept.tree = std::make_shared<const MergeTree>(std::move(*tree));
            kept.cached = true;
            return kept;
        }
    }
    kept.tree = std::make_shared<const MergeTree>(build_merge_tree(set, progress));
    return kept;
}

void keep_tree(const SetCache& cache, const KeptTree& kept, const Progress& progress) {
    if (kept.file.empty() || kept.cached) return;
    const MergeTree& tree = *kept.tree;
    const std::int64_t bytes = file_bytes(tree.levels.size(), tree.rows.size(), tree.nodes.size());
    const std::int64_t limit = limit_bytes(cache);
    if (bytes > limit / largest_share) return;
    shrink_cache(cache, limit - bytes);
    Header header{
        {}, version, static_cast<std::uint32_t>(tree.levels.size()), tree.rows.size(), tree.nodes.size()};
    std::memcpy(header.magic, magic.data(), sizeof header.magic);
    try {
        std::error_code ignored;
        fs::create_directories(cache.folder, ignored);
        AtomicFile file(kept.file);
        RunningChecksum checksum;
        const auto write = [&](std::string_view part) {
            constexpr std::size_t at_once = 1 << 22;
            for (; !part.empty(); part.remove_prefix(std::min(at_once, part.size()))) {
                progress.check();
                checksum.add(part.substr(0, at_once));
                file.write(part.substr(0, at_once));
            }
        };
        write(bytes_of(std::span<const Header>(&header, 1)));
        write(bytes_of(std::span<const std::int64_t>(tree.levels)));
        write(bytes_of(std::span<const std::int64_t>(tree.rows)));
        write(bytes_of(std::span<const MergeNode>(tree.nodes)));
        const std::uint64_t sum = checksum.value();
        file.write(&sum, sizeof sum);
        file.commit();
    } catch (const OutputError& error) {
        warn_unkept(cache, error.what());
    }
}

}  // namespace astrosplat

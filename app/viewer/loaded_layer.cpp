// Reading copies straight from the page cache; the checksum tells damage, and what a reader would index with
// is looked at besides.
#include "viewer/loaded_layer.h"

#include <cstring>
#include <ranges>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/shared_maths.h"
#include "generate/generate.h"
#include "scene/layer_setup.h"
#include "source/fits.h"
#include "source/mesh.h"
#include "source/picture.h"
#include "splat_files/file_bytes.h"

namespace astrosplat {
namespace {

using Values = LayerHistograms::Values;
constexpr int bins = LayerHistograms::bins;

/// How many of the values lie in each bin over lo .. hi, as shares of the fullest; what lies outside or is
/// not a number is left out.
template <class Range>
std::array<float, bins> shares_of(const Range& values, double lo, double hi) {
    const double bins_per_unit = hi > lo ? bins / (hi - lo) : 0.0;
    std::array<double, bins> counts{};
    for (const double value : values) {
        const double bin = (value - lo) * bins_per_unit;
        if (bin >= 0.0 && bin <= bins) ++counts[static_cast<std::size_t>(std::min(bin, bins - 1.0))];
    }
    const double most = *std::ranges::max_element(counts);
    std::array<float, bins> shares{};
    for (std::size_t i = 0; i < counts.size() && most > 0.0; ++i)
        shares[i] = static_cast<float>(counts[i] / most);
    return shares;
}

/// Over the range that is set.
template <class Range>
void count(const Range& values, Values& into) {
    const std::array<float, bins> shares = shares_of(values, into.lo, into.hi);
    into.share.assign(shares.begin(), shares.end());
}

/// The range of FITS data worth showing: half as much again beyond black and white, for stars and cosmic rays
/// would squeeze everything else into one bin.
Values fits_values(const fs::path& file, const TextureSettings& settings) {
    const FitsPlane plane = read_fits(file, settings.hdu, settings.plane);
    const ValueRange range = value_range(plane.values);
    const Limits automatic = choose_limits(range, TextureSettings{}, file.string());
    const double margin = 0.5 * (automatic.white - automatic.black);
    Values values;
    values.black = automatic.black;
    values.white = automatic.white;
    values.lo = std::max(range.min, automatic.black - margin);
    values.hi = std::max(std::min(range.max, automatic.white + margin), automatic.white);
    count(plane.values, values);
    return values;
}

/// The picture is read again, because a set no longer knows its values.
Values picture_values(const fs::path& file) {
    const Image image = read_picture(file).image;
    const auto largest = [&](std::int64_t i) {
        const float* const p = image.pixels.data() + i * image.channels;
        return static_cast<double>(std::max({p[0], p[1], p[2]}));
    };
    const auto all =
        std::views::iota(std::int64_t{0}, image.width * image.height) | std::views::transform(largest);
    Values values;
    for (const double value : all)
        if (std::isfinite(value)) values.hi = std::max(values.hi, value);
    count(all, values);
    return values;
}

/// Empty: none is named, or the mesh's own.
fs::path first_picture(const SourceParams& source) {
    if (source.kind != SourceKind::mesh || source.meshes.empty()) return {};
    const MeshInput& input = source.meshes.front();
    if (!input.texture.empty() && !input.texture.front().empty()) return input.texture.front();
    if (is_builtin_mesh(input.mesh)) return {};
    for (const fs::path& map : load_obj(input.mesh).maps)
        if (!map.empty()) return map;
    return {};
}

/// Smallest and largest radius in scene units that a look without radii gives: the file's own, or 0.6 voxel
/// diagonals; 0, 0 where neither is known.
glm::dvec2 unset_radius(const SplatSet& set) {
    if (!set.radius.empty()) {
        const auto [least, most] = std::minmax_element(set.radius.begin(), set.radius.end());
        return {*least, *most};
    }
    const glm::dvec3 s = set.spacing;
    return glm::dvec2(0.6 * std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z));
}

glm::vec3 mean_color(const SplatSet& set) {
    constexpr std::int64_t sampled = 4096;
    glm::vec3 sum(0.0f);
    float weight = 0.0f;
    const std::int64_t count = std::min(sampled, set.size());
    for (std::int64_t i = 0; i < count; ++i) {
        const std::int64_t row = sampled_row(set.size(), count, i);
        sum += set.alpha[row] * set.color[row];
        weight += set.alpha[row];
    }
    return weight > 0.0f ? sum / weight : glm::vec3(1.0f);
}

LoadedLayer layer_of(MergeSource sample, const SourceParams& source, const std::string& name) {
    LoadedLayer layer;
    layer.color = mean_color(*sample.set);
    layer.sample = std::move(sample);
    layer.source = source;
    layer.name = name;
    return layer;
}

}  // namespace

MergeSource source_of(std::shared_ptr<const SplatSet> set, std::int64_t stands_for) {
    MergeSource source;
    if (set->size() > 0)
        source.weight =
            static_cast<float>(static_cast<double>(stands_for) / static_cast<double>(set->size()));
    source.tree = std::make_shared<const MergeTree>(build_merge_tree(*set));
    source.set = std::move(set);
    return source;
}

MergeSource light_sample(const SplatSet& set, std::int64_t count) {
    MergeSource source = sample_light(set, count);
    source.tree = std::make_shared<const MergeTree>(build_merge_tree(*source.set));
    return source;
}

LoadedLayer whole_layer(std::shared_ptr<const SplatSet> set, const SourceParams& source,
                        const std::string& name, std::int64_t sample_limit, const MergeSource* sample) {
    const std::int64_t splats = set->size();
    const bool is_small = splats <= sample_limit;
    MergeSource seen;
    if (set->stars)  // drawn as they are, however many: no splat could stand for several
        seen.set = set;
    else if (is_small)
        seen = source_of(set, splats);
    else if (!set->radius.empty())
        seen = light_sample(*set, sample_limit);
    else
        seen = sample ? *sample
                      : source_of(std::make_shared<const SplatSet>(sample_rows(*set, sample_limit)), splats);
    LoadedLayer layer = layer_of(std::move(seen), source, name);
    layer.box = bounds(*set);
    if (!set->stars) layer.radius = unset_radius(*set);
    layer.splats = splats;
    layer.arranged = is_small || set->stars;
    layer.set = std::move(set);
    return layer;
}

LoadedLayer sampled_layer(SetSample sample, const SourceParams& source, const std::string& name) {
    auto set = std::make_shared<const SplatSet>(std::move(sample.set));
    LoadedLayer layer = layer_of(source_of(set, sample.splats), source, name);
    layer.box = bounds(*set);
    layer.radius = unset_radius(*set);
    layer.splats = sample.splats;
    layer.stands_in = sample.stands_in;
    layer.making = sample.making;
    return layer;
}

LoadedLayer arranged_layer(LoadedLayer layer, std::shared_ptr<const MergeTree> tree) {
    constexpr std::int64_t rows_per_sampled = 16;
    layer.whole.set = layer.set;
    layer.whole.tree = std::move(tree);
    const std::int64_t count = std::max(layer.sample.set->size(), layer.set->size() / rows_per_sampled);
    layer.sample =
        source_of(std::make_shared<const SplatSet>(sample_tree(*layer.whole.tree, *layer.set, count)),
                  layer.set->size());
    layer.arranged = true;
    return layer;
}

LoadedLayer described_layer(LoadedLayer layer) {
    try {
        layer.files = all_files(layer.source);
    } catch (const InputError&) {  // gone since: when it is back, it is read again
        layer.files = named_files(layer.source);
    }
    try {
        layer.automatic = automatic_values(layer.source);
    } catch (const InputError&) {  // as above
    }
    layer.histograms = std::make_shared<const LayerHistograms>(histograms(*layer.set, layer.source));
    return layer;
}

LayerHistograms histograms(const SplatSet& set, const SourceParams& source) {
    LayerHistograms result;
    result.max_distance = set.max_distance;
    result.distance = shares_of(set.distance, 0.0, set.max_distance);
    try {
        const fs::path file = first_picture(source);
        if (!file.empty())
            result.values = is_fits(file) ? fits_values(file, source.texture) : picture_values(file);
    } catch (const InputError&) {
        // It was readable when the set was made; the next generation will say what is wrong with it now.
    }
    return result;
}

namespace {

constexpr std::string_view magic = "\x89TREE\r\n\x1a";
constexpr std::uint32_t version = 3;
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

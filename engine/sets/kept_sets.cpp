#include "sets/kept_sets.h"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/sha256.h"
#include "splat_files/native.h"
#include "splats/splat_set.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

/// What read() makes of an entry. Nothing where there is none, or none that can be used: one that is damaged,
/// or that was made of something else, whatever its name says, for which read() throws. Where the memory left
/// would not hold it the generator is to say so.
template <class Read>
auto read_entry(const fs::path& file, const Read& read) -> std::optional<decltype(read(file))> {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(file, error);
    if (error || bytes > static_cast<std::uintmax_t>(available_memory_bytes())) return std::nullopt;
    try {
        auto result = read(file);
        fs::last_write_time(file, fs::file_time_type::clock::now(), error);  // refused: it seems older
        return result;
    } catch (const InputError& damage) {
        log_warning(fmt::format("{}; the set is generated again", damage.what()));
        fs::remove(file, error);
    }
    return std::nullopt;
}

void require_own(const fs::path& file, bool is_own) {
    if (!is_own) bad_input(file.string(), "recipe", "that of the set asked for", "another");
}

bool is_geometry(const std::string& text, const std::string& name) {
    return Sha256().add(text).hex() == name;
}

/// What is to be read of columns that are kept: the lit ones, and a sample of all.
struct ColumnChoice {
    LitRows lit;
    Buffer<std::int64_t> sample;
    OptionalColumns wanted;

    std::array<NativeRows, 2> rows() const {
        return {NativeRows{lit.rows, wanted}, NativeRows{sample, {true, true, true, true}}};
    }
};

void add_colors(SplatSet colors, SplatSet& set) {
    set.color = std::move(colors.color);
    set.alpha = std::move(colors.alpha);
    set.divided = colors.divided;
    set.credit = std::move(colors.credit);
    set.recipe.clear();
}

}  // namespace

fs::path set_file(const SetCache& cache, const std::string& name) {
    return cache.folder / (name + ".splats");
}

fs::path texel_file(const SetCache& cache, const std::string& name) {
    return cache.folder / (name + ".texels");
}

std::string texel_recipe(const Recipe& recipe, const std::string& geometry_name) {
    return recipe.text + "geometry " + geometry_name;
}

std::optional<SplatSet> read_whole(const SetCache& cache, const Recipe& recipe, const Progress& progress,
                                   const OptionalColumns& wanted) {
    return read_entry(set_file(cache, recipe.name), [&](const fs::path& file) {
        SplatSet set = read_native(file, progress, wanted);
        require_own(file, std::exchange(set.recipe, "") == recipe.text);
        return set;
    });
}

std::optional<Columns> read_geometry(const SetCache& cache, const std::string& name,
                                     const Progress& progress) {
    return read_entry(set_file(cache, name), [&](const fs::path& file) {
        SplatSet set = read_native(file, progress, {true, true, true, true}, NativePart::geometry);
        require_own(file, is_geometry(std::exchange(set.recipe, ""), name));
        return Columns{std::move(set)};
    });
}

/// Dark positions are passed by: to read them into memory first takes as long as all else.
std::optional<KeptColumns> read_columns(const SetCache& cache, const Recipe& recipe,
                                        std::int64_t sample_limit, const OptionalColumns& wanted,
                                        const Progress& progress) {
    ColumnChoice choice;
    choice.wanted = wanted;
    const std::string beginning = texel_recipe(recipe, "");
    auto colors = read_entry(texel_file(cache, recipe.name), [&](const fs::path& file) {
        choice.lit = native_lit_rows(file, progress);
        choice.sample = sampled_rows(choice.lit.of, sample_limit);
        auto sets = read_native_rows(file, NativePart::colors, choice.rows(), progress);
        require_own(file, sets[0].recipe.starts_with(beginning));
        return sets;
    });
    if (!colors) return std::nullopt;
    const std::string name = colors->front().recipe.substr(beginning.size());
    auto sets = read_entry(set_file(cache, name), [&](const fs::path& file) {
        auto found = read_native_rows(file, NativePart::geometry, choice.rows(), progress);
        require_own(file, is_geometry(found[0].recipe, name) && native_splat_count(file) == choice.lit.of);
        return found;
    });
    if (!sets) return std::nullopt;
    for (std::size_t i = 0; i < sets->size(); ++i) add_colors(std::move((*colors)[i]), (*sets)[i]);
    KeptColumns kept{std::move((*sets)[0]), {std::move((*sets)[1])}, choice.lit.of};
    kept.set.zero_alpha += kept.positions - kept.set.size();
    return kept;
}

void keep(const SetCache& cache, const std::vector<KeptFile>& entries, SplatSet& set,
          const Progress& progress) {
    std::int64_t bytes = 0;
    for (const KeptFile& entry : entries) {
        set.recipe = entry.recipe;
        bytes += native_file_bytes(set, entry.part);
    }
    const std::int64_t limit = limit_bytes(cache);
    if (bytes > limit) {
        log_info(fmt::format("a set of {} is not kept: the cache may hold {}",
                             human_bytes(static_cast<double>(bytes)),
                             human_bytes(static_cast<double>(limit))));
    } else {
        shrink_cache(cache, limit - bytes);
        try {
            for (const KeptFile& entry : entries) {
                set.recipe = entry.recipe;
                write_native(entry.file, set, Progress{{}, progress.cancelled}, RowOrder::id, entry.part);
            }
        } catch (const OutputError& error) {
            warn_unkept(cache, error.what());
        }
    }
    set.recipe.clear();
}

}  // namespace astrosplat

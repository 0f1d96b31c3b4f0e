// An entry is read without a lock, for it appears whole or not at all. The lock of its name is held from
// before generation until the file is in place; what is found unlocked was left by a process that ended
// early.
#include "sets/set_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file_lock.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/sha256.h"
#include "generate/kept_store.h"
#include "sets/load_source.h"
#include "sets/prepared_cache.h"
#include "sets/recipe.h"
#include "splat_files/native.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

constexpr auto poll_interval = std::chrono::milliseconds(50);

constexpr std::string_view geometry_line = "geometry ";  // the last of the recipe of texels

fs::path set_file(const SetCache& cache, const std::string& name) {
    return cache.folder / (name + ".splats");
}
fs::path texel_file(const SetCache& cache, const std::string& name) {
    return cache.folder / (name + ".texels");
}
fs::path lock_file(const fs::path& folder, const std::string& name) { return folder / (name + ".lock"); }

bool serves(const SetCache& cache, const SourceParams& source) {
    return !cache.folder.empty() && source.kind == SourceKind::mesh;
}

// ---- reading

/// Nothing where there is no entry, or none that can be used: one that is damaged, or that was made of
/// something else, whatever its name says. Where the memory left would not hold it the generator is to say
/// so. `is_own` looks at its recipe.
std::optional<SplatSet> read_entry(const fs::path& file, NativePart part, const Progress& progress,
                                   const OptionalColumns& wanted,
                                   const std::function<bool(std::string_view recipe)>& is_own) {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(file, error);
    if (error || bytes > static_cast<std::uintmax_t>(available_memory_bytes())) return std::nullopt;
    try {
        SplatSet set = read_native(file, progress, wanted, part);
        if (!is_own(set.recipe)) bad_input(file.string(), "recipe", "that of the set asked for", "another");
        fs::last_write_time(file, fs::file_time_type::clock::now(), error);  // refused: it seems older
        return set;
    } catch (const InputError& damage) {
        log_warning(fmt::format("{}; the set is generated again", damage.what()));
        fs::remove(file, error);
    }
    return std::nullopt;
}

std::optional<SplatSet> read_whole(const SetCache& cache, const Recipe& recipe, const Progress& progress,
                                   const OptionalColumns& wanted) {
    auto set = read_entry(set_file(cache, recipe.name), NativePart::whole, progress, wanted,
                          [&](std::string_view text) { return text == recipe.text; });
    if (set) set->recipe.clear();
    return set;
}

std::optional<Columns> read_geometry(const SetCache& cache, const std::string& name, const Progress& progress,
                                     const OptionalColumns& wanted) {
    auto set = read_entry(set_file(cache, name), NativePart::geometry, progress, wanted,
                          [&](std::string_view text) { return Sha256().add(text).hex() == name; });
    if (!set) return std::nullopt;
    set->recipe.clear();
    return Columns{std::move(*set)};
}

/// Geometry and texels that belong together.
std::optional<Columns> read_columns(const SetCache& cache, const Recipe& recipe, const Progress& progress,
                                    const OptionalColumns& wanted) {
    const std::string beginning = recipe.text + std::string(geometry_line);
    auto texels = read_entry(texel_file(cache, recipe.name), NativePart::colors, progress, wanted,
                             [&](std::string_view text) { return text.starts_with(beginning); });
    if (!texels) return std::nullopt;
    auto columns = read_geometry(cache, texels->recipe.substr(beginning.size()), progress, wanted);
    if (!columns || columns->splats.position.size() != texels->color.size()) return std::nullopt;
    SplatSet& set = columns->splats;
    set.color = std::move(texels->color);
    set.alpha = std::move(texels->alpha);
    set.divided = texels->divided;
    set.credit = std::move(texels->credit);
    return columns;
}

// ---- keeping

/// Removes lock files of processes that ended early: those whose lock nobody holds. `own_name` is the one
/// held by the caller.
void remove_leftovers(const fs::path& folder, const std::string& own_name) {
    constexpr std::size_t name_length = 64;
    for (const fs::path& file : files_in(folder)) {
        const std::string name = file.stem().string();
        const bool is_name =
            name.size() == name_length && name.find_first_not_of("0123456789abcdef") == name.npos;
        if (file.extension() != ".lock" || !is_name || name == own_name) continue;
        FileLock lock(file);  // removes the file where the lock can be had
        lock.try_lock(FileLock::Missing::leave);
    }
}

struct Entry {
    fs::path file;
    NativePart part;
    std::string recipe;
};

/// Files of one set, where the cache has room for all of them. Called with the lock of the set held (or on
/// file systems without locks).
void keep(const SetCache& cache, const std::vector<Entry>& entries, SplatSet& set, const Progress& progress) {
    std::int64_t bytes = 0;
    for (const Entry& entry : entries) {
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
            for (const Entry& entry : entries) {
                set.recipe = entry.recipe;
                write_native(entry.file, set, Progress{{}, progress.cancelled}, RowOrder::id, entry.part);
            }
        } catch (const OutputError& error) {
            warn_unkept(cache, error.what());
        }
    }
    set.recipe.clear();
}

/// Waits while another process generates the same set.
FileLock::State wait_for(FileLock& lock, const std::string& layer_name, const Progress& progress) {
    for (int tries = 0;; ++tries) {
        const FileLock::State state = lock.try_lock();
        if (state != FileLock::State::busy) return state;
        progress.check();
        if (tries == 2)  // not for the moment in which another looks for leftovers
            log_info(fmt::format("layer '{}': waiting for another process that generates the same set",
                                 layer_name));
        std::this_thread::sleep_for(poll_interval);
    }
}

/// One load_source() through the cache.
class CachedLoad {
  public:
    CachedLoad(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
               const Progress& progress, KeptWatcher* watcher, const OptionalColumns& wanted)
        : cache_(cache),
          source_(source),
          layer_name_(layer_name),
          progress_(progress),
          watcher_(watcher),
          wanted_(wanted) {}

    LoadedSet load() {
        if (serves(cache_, source_)) recipe_ = recipe_of(source_, layer_name_, progress_);
        if (recipe_.name.empty()) return {uncached()};
        if (auto found = find()) return std::move(*found);
        std::error_code error;
        fs::create_directories(cache_.folder, error);
        if (error) {
            warn_unkept(cache_, "cannot be made: " + error.message());
            return {uncached()};
        }
        FileLock lock(lock_file(cache_.folder, recipe_.name));
        const bool locked = wait_for(lock, layer_name_, progress_) == FileLock::State::held;
        if (auto found = find()) return std::move(*found);
        if (locked) remove_leftovers(cache_.folder, recipe_.name);
        return makes_columns(source_) ? columns() : bodies();
    }

  private:
    SplatSet uncached() const {
        return load_source(source_, layer_name_, progress_, watcher_, kept_pictures(cache_));
    }

    /// False: a file was changed while it was used.
    bool is_current() const { return recipe_text(source_, layer_name_, progress_) == recipe_.text; }

    /// With columns that are not wanted where the set had to be generated.
    LoadedSet bodies() const {
        LoadedSet loaded{uncached()};
        if (is_current())
            keep(cache_, {{set_file(cache_, recipe_.name), NativePart::whole, recipe_.text}}, loaded.set,
                 progress_);
        return loaded;
    }

    /// Geometry that is kept gets other texels; else both are made, by one process while others wait.
    LoadedSet columns() const {
        const ColumnPlan plan = plan_columns(source_, layer_name_, progress_, kept_pictures(cache_));
        const Recipe geometry = geometry_recipe(plan);
        FileLock lock(lock_file(cache_.folder, geometry.name));
        wait_for(lock, layer_name_, progress_);
        const OptionalColumns all{true, true, true, true};
        std::optional<Columns> columns = read_geometry(cache_, geometry.name, progress_, all);
        const bool known = columns.has_value();
        if (known) {
            log_info(fmt::format("layer '{}': {} from the cache, pictures are read again", layer_name_,
                                 human_count(columns->splats.size(), "position")));
            read_texels(plan.meshes, *columns, progress_);
            if (watcher_) watcher_->ends(*columns);
        } else {
            columns = make_columns(plan, layer_name_, progress_, watcher_);
        }
        if (is_current()) {
            std::vector<Entry> entries;
            if (!known)
                entries.push_back({set_file(cache_, geometry.name), NativePart::geometry, geometry.text});
            entries.push_back({texel_file(cache_, recipe_.name), NativePart::colors,
                               recipe_.text + std::string(geometry_line) + geometry.name});
            keep(cache_, entries, columns->splats, progress_);
        }
        return {lit_splats(std::move(*columns)), false, known};
    }

    std::optional<LoadedSet> find() const {
        std::optional<SplatSet> set;
        if (makes_columns(source_)) {
            OptionalColumns wanted = wanted_;
            wanted.face = watcher_ != nullptr;
            std::optional<Columns> columns = read_columns(cache_, recipe_, progress_, wanted);
            if (columns && watcher_) watcher_->ends(*columns);
            if (columns) set = lit_splats(std::move(*columns));
        } else {
            set = read_whole(cache_, recipe_, progress_, wanted_);
        }
        if (!set) return std::nullopt;
        log_info(
            fmt::format("layer '{}': {} from the cache", layer_name_, human_count(set->size(), "splat")));
        return LoadedSet{std::move(*set), true, true};
    }

    const SetCache& cache_;
    const SourceParams& source_;
    const std::string& layer_name_;
    const Progress& progress_;
    KeptWatcher* watcher_;
    const OptionalColumns& wanted_;
    Recipe recipe_;  // empty: nothing can be kept
};

}  // namespace

LoadedSet load_source(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                      const Progress& progress, KeptWatcher* watcher, const OptionalColumns& wanted) {
    LoadedSet loaded = CachedLoad(cache, source, layer_name, progress, watcher, wanted).load();
    drop_columns(loaded.set, wanted);
    return loaded;
}

std::optional<std::int64_t> cached_splats(const SetCache& cache, const SourceParams& source,
                                          const std::string& layer_name) try {
    const std::string name = serves(cache, source) ? recipe_of(source, layer_name).name : "";
    if (name.empty()) return std::nullopt;
    const fs::path file = makes_columns(source) ? texel_file(cache, name) : set_file(cache, name);
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return std::nullopt;
    return native_splat_count(file);
} catch (const InputError&) {
    return std::nullopt;  // load_source will say what is wrong with it
}

}  // namespace astrosplat

// An entry is read without a lock, for it appears whole or not at all. The lock of its name is held from
// before generation until the file is in place; what is found unlocked was left by a process that was killed.
#include "sets/kept.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "generate/kept_store.h"
#include "sets/load_source.h"

namespace astrosplat {
namespace {

constexpr auto poll_interval = std::chrono::milliseconds(50);

fs::path lock_file(const fs::path& folder, const std::string& name) { return folder / (name + ".lock"); }

bool serves(const SetCache& cache, const SourceParams& source) {
    return !cache.folder.empty() && source.kind == SourceKind::mesh;
}

/// Removes lock files of processes that ended early: those whose lock no process holds. `own_name` is the one
/// held by the caller.
void remove_leftovers(const fs::path& folder, const std::string& own_name) {
    constexpr std::size_t name_length = 64;
    for (const fs::path& file : entries_of(folder)) {
        const std::string name = file.stem().string();
        const bool is_name =
            name.size() == name_length && name.find_first_not_of("0123456789abcdef") == name.npos;
        if (file.extension() != ".lock" || !is_name || name == own_name) continue;
        FileLock lock(file);  // removes the file where the lock can be had
        lock.try_lock(FileLock::Missing::leave);
    }
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
struct CachedLoad {
    const SetCache& cache;
    const SourceParams& source;
    const std::string& layer_name;
    const Progress& progress;
    KeptWatcher* watcher;
    const OptionalColumns& wanted;
    Recipe recipe = {};  // empty: nothing can be kept

    LoadedSet load() {
        if (serves(cache, source)) recipe = recipe_of(source, layer_name, progress);
        if (recipe.name.empty()) return {uncached()};
        if (auto found = find()) return std::move(*found);
        std::error_code error;
        fs::create_directories(cache.folder, error);
        if (error) {
            warn_unkept(cache, "cannot be made: " + error.message());
            return {uncached()};
        }
        FileLock lock(lock_file(cache.folder, recipe.name));
        const bool locked = wait_for(lock, layer_name, progress) == FileLock::State::held;
        if (auto found = find()) return std::move(*found);
        if (locked) remove_leftovers(cache.folder, recipe.name);
        return makes_columns(source) ? columns() : bodies();
    }

    SplatSet uncached() const {
        if (source.kind == SourceKind::stars)
            return load_stars(source, layer_name, progress, kept_pictures(cache), [&] {
                return load_source(cache, picture_source(source), source.stars.like, progress).set;
            });
        return load_source(source, layer_name, progress, watcher, kept_pictures(cache));
    }

    /// False: a file was changed while it was used.
    bool is_current() const { return recipe_text(source, layer_name, progress) == recipe.text; }

    /// With columns that are not wanted where the set had to be generated.
    LoadedSet bodies() const {
        LoadedSet loaded{uncached()};
        if (!loaded.set.of_this_machine && is_current())
            keep(cache, {{set_file(cache, recipe.name), NativePart::whole, recipe.text}}, loaded.set,
                 progress);
        return loaded;
    }

    /// Geometry that is kept gets other texels; else both are made, by one process while others wait.
    LoadedSet columns() const {
        const ColumnPlan plan = plan_columns(source, layer_name, progress, kept_pictures(cache));
        const Recipe geometry = geometry_recipe(plan);
        FileLock lock(lock_file(cache.folder, geometry.name));
        wait_for(lock, layer_name, progress);
        std::optional<Columns> columns = read_geometry(cache, geometry.name, progress);
        const bool known = columns.has_value();
        if (known) {
            log_info(fmt::format("layer '{}': {} from the cache, pictures are read again", layer_name,
                                 human_count(columns->splats.size(), "position")));
            read_texels(plan.meshes, *columns, progress);
            if (watcher) show_end(*columns, *watcher);
        } else {
            columns = make_columns(plan, layer_name, progress, watcher);
        }
        if (is_current()) {
            std::vector<KeptFile> entries;
            if (!known)
                entries.push_back({set_file(cache, geometry.name), NativePart::geometry, geometry.text});
            entries.push_back(
                {texel_file(cache, recipe.name), NativePart::colors, texel_recipe(recipe, geometry.name)});
            keep(cache, entries, columns->splats, progress);
        }
        return {lit_splats(std::move(*columns)), false, known};
    }

    std::optional<LoadedSet> find() const {
        std::optional<SplatSet> set;
        if (makes_columns(source)) {
            auto kept = read_columns(cache, recipe, watcher ? watcher->sample_limit() : 0, wanted, progress);
            if (kept && watcher) watcher->ends(std::move(kept->sample), kept->positions);
            if (kept) set = std::move(kept->set);
        } else {
            set = read_whole(cache, recipe, progress, wanted);
        }
        if (!set) return std::nullopt;
        log_info(fmt::format("layer '{}': {} from the cache", layer_name, human_count(set->size(), "splat")));
        return LoadedSet{std::move(*set), true, true};
    }
};

}  // namespace

LoadedSet load_source(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                      const Progress& progress, KeptWatcher* watcher, const OptionalColumns& wanted) {
    const StoppableLoops stops(progress);
    LoadedSet loaded = CachedLoad{cache, source, layer_name, progress, watcher, wanted}.load();
    warn_of_no_splats(loaded.set, source.kind == SourceKind::splats ? source.file.string()
                                                                    : fmt::format("layer '{}'", layer_name));
    drop_columns(loaded.set, wanted);
    return loaded;
}

SplatSet load_picture_stars(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                            const SplatSet& of_picture, const Progress& progress) try {
    return load_picture_stars(source, layer_name, progress, kept_pictures(cache),
                              [&]() -> const SplatSet& { return of_picture; });
} catch (const InputError& error) {
    throw InputError(fmt::format("layer '{}': {}", layer_name, error.what()));
}

}  // namespace astrosplat

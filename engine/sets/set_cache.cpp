// An entry is read without a lock, for it appears whole or not at all. The lock of its name is held from
// before generation until the file is in place; what is found unlocked was left by a process that ended
// early.
#include "sets/set_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file_lock.h"
#include "core/log.h"
#include "core/memory.h"
#include "sets/load_source.h"
#include "sets/prepared_cache.h"
#include "sets/recipe.h"
#include "splat_files/native.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

constexpr auto poll_interval = std::chrono::milliseconds(50);

fs::path entry_file(const SetCache& cache, const std::string& name) {
    return cache.folder / (name + ".splats");
}
fs::path lock_file(const fs::path& folder, const std::string& name) { return folder / (name + ".lock"); }

bool serves(const SetCache& cache, const SourceParams& source) {
    return !cache.folder.empty() && source.kind == SourceKind::mesh;
}

// ---- reading

/// Nothing where there is no entry, or none that can be used: one that is damaged, or that was made of
/// something else, whatever its name says. Where the memory left would not hold it the generator is to say
/// so.
std::optional<SplatSet> read_entry(const fs::path& file, const Recipe& recipe, const Progress& progress,
                                   const OptionalColumns& wanted) {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(file, error);
    if (error || bytes > static_cast<std::uintmax_t>(available_memory_bytes())) return std::nullopt;
    try {
        SplatSet set = read_native(file, progress, wanted);
        if (std::exchange(set.recipe, "") != recipe.text)
            bad_input(file.string(), "recipe", "that of the set asked for", "another");
        fs::last_write_time(file, fs::file_time_type::clock::now(), error);  // refused: it seems older
        return set;
    } catch (const InputError& damage) {
        log_warning(fmt::format("{}; the set is generated again", damage.what()));
        fs::remove(file, error);
    }
    return std::nullopt;
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

/// Where the cache has room for it.
void write_entry(const SetCache& cache, const std::string& name, const SplatSet& set,
                 const Progress& progress) {
    const std::int64_t bytes = native_file_bytes(set), limit = limit_bytes(cache);
    if (bytes > limit) {
        log_info(fmt::format("a set of {} is not kept: the cache may hold {}",
                             human_bytes(static_cast<double>(bytes)),
                             human_bytes(static_cast<double>(limit))));
        return;
    }
    shrink_cache(cache, limit - bytes);
    try {
        write_native(entry_file(cache, name), set, Progress{{}, progress.cancelled}, RowOrder::id);
    } catch (const OutputError& error) {
        warn_unkept(cache, error.what());
    }
}

/// Called with the lock of the entry held (or on file systems without locks).
void keep(const SetCache& cache, const Recipe& recipe, SplatSet& set, const Progress& progress) {
    set.recipe = recipe.text;
    write_entry(cache, recipe.name, set, progress);
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

std::optional<SplatSet> find(const SetCache& cache, const Recipe& recipe, const std::string& layer_name,
                             const Progress& progress, const OptionalColumns& wanted) {
    std::optional<SplatSet> set = read_entry(entry_file(cache, recipe.name), recipe, progress, wanted);
    if (set)
        log_info(fmt::format("layer '{}': {} from the cache", layer_name, human_count(set->size(), "splat")));
    return set;
}

/// With columns that are not wanted where the set had to be generated.
LoadedSet find_or_load(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                       const Progress& progress, KeptWatcher* watcher, const OptionalColumns& wanted) {
    const Recipe recipe = serves(cache, source) ? recipe_of(source, layer_name, progress) : Recipe();
    if (recipe.name.empty())
        return {load_source(source, layer_name, progress, watcher, kept_pictures(cache)), false};
    if (auto set = find(cache, recipe, layer_name, progress, wanted)) return {std::move(*set), true};
    std::error_code error;
    fs::create_directories(cache.folder, error);
    if (error) {
        warn_unkept(cache, "cannot be made: " + error.message());
        return {load_source(source, layer_name, progress, watcher, kept_pictures(cache)), false};
    }
    FileLock lock(lock_file(cache.folder, recipe.name));
    const bool locked = wait_for(lock, layer_name, progress) == FileLock::State::held;
    if (auto set = find(cache, recipe, layer_name, progress, wanted)) return {std::move(*set), true};
    if (locked) remove_leftovers(cache.folder, recipe.name);
    LoadedSet loaded{load_source(source, layer_name, progress, watcher, kept_pictures(cache)), false};
    if (recipe_text(source, layer_name, progress) == recipe.text)
        keep(cache, recipe, loaded.set, progress);  // else a file changed
    return loaded;
}

}  // namespace

LoadedSet load_source(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                      const Progress& progress, KeptWatcher* watcher, const OptionalColumns& wanted) {
    LoadedSet loaded = find_or_load(cache, source, layer_name, progress, watcher, wanted);
    drop_columns(loaded.set, wanted);
    return loaded;
}

std::optional<std::int64_t> cached_splats(const SetCache& cache, const SourceParams& source,
                                          const std::string& layer_name) try {
    const std::string name = serves(cache, source) ? recipe_of(source, layer_name).name : "";
    std::error_code error;
    if (name.empty() || !fs::is_regular_file(entry_file(cache, name), error)) return std::nullopt;
    return native_splat_count(entry_file(cache, name));
} catch (const InputError&) {
    return std::nullopt;  // load_source will say what is wrong with it
}

}  // namespace astrosplat

// The folder in which sets and prepared pictures are kept from run to run. In: its name and limit. Out: room
// for more.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace astrosplat {

struct SetCache {
    std::filesystem::path folder;  // made when something is kept; empty: no cache
    /// Bytes of all entries; the least recently used go first. 0: 20 GiB or a tenth of the disk, whichever is
    /// less.
    std::int64_t limit_bytes = 0;
};

/// $ASTROSPLAT_CACHE, else $XDG_CACHE_HOME/astrosplat, else ~/.cache/astrosplat; empty without a home.
std::filesystem::path default_cache_folder();

/// What the limit 0 means for this folder, or the limit.
std::int64_t limit_bytes(const SetCache& cache);

/// Removes entries (.splats, .texels, .tree, .exr), least recently used first, until they take at most
/// `bytes` together.
void shrink_cache(const SetCache& cache, std::int64_t bytes);

/// A warning: the run goes on without the cache.
void warn_unkept(const SetCache& cache, const std::string& why);

}  // namespace astrosplat

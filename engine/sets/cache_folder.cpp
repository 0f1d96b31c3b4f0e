#include "sets/cache_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <tuple>

#include "core/file.h"
#include "core/log.h"
#include "core/user_folders.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t largest_limit = std::int64_t{20} << 30;  // bytes

}  // namespace

fs::path default_cache_folder() {
    const char* folder = std::getenv("ASTROSPLAT_CACHE");
    return folder && *folder ? fs::path(folder) : cache_folder();
}

std::int64_t limit_bytes(const SetCache& cache) {
    if (cache.limit_bytes > 0) return cache.limit_bytes;
    std::error_code error;
    const fs::space_info disk = fs::space(cache.folder, error);
    if (error) return largest_limit;
    return static_cast<std::int64_t>(std::min<std::uintmax_t>(disk.capacity / 10, largest_limit));
}

void shrink_cache(const SetCache& cache, std::int64_t bytes) {
    struct Entry {
        fs::file_time_type used;
        fs::path file;
        std::int64_t bytes;
    };
    std::vector<Entry> entries;
    std::int64_t total = 0;
    std::error_code error;
    for (const fs::path& file : entries_of(cache.folder)) {
        constexpr std::array endings = {".splats", ".texels", ".tree", ".exr"};
        const std::string ending = file.extension().string();
        const bool entry = std::ranges::any_of(endings, [&](const char* own) { return ending == own; });
        if (!entry || file.filename().string().front() == '.') continue;
        entries.push_back({fs::last_write_time(file, error), file, 0});
        const std::uintmax_t size = fs::file_size(file, error);
        if (!error)
            entries.back().bytes = static_cast<std::int64_t>(size);  // else another process removed it
        total += entries.back().bytes;
    }
    std::ranges::sort(entries, {}, [](const Entry& entry) { return std::tie(entry.used, entry.file); });
    for (const Entry& entry : entries) {
        if (total <= bytes) return;
        if (fs::remove(entry.file, error)) log_detail(entry.file.string() + ": removed from the cache");
        total -= entry.bytes;
    }
}

void warn_unkept(const SetCache& cache, const std::string& why) {
    log_warning(fmt::format("cache {}: {}; what was generated is not kept", cache.folder.string(), why));
}

}  // namespace astrosplat

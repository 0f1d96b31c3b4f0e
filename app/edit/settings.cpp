#include "edit/settings.h"

#include <cstdlib>

namespace astrosplat {
namespace {

constexpr SettingChoice scales[] = {{0, "Auto"},    {100, "100 %"}, {125, "125 %"},
                                    {150, "150 %"}, {200, "200 %"}, {300, "300 %"}};
constexpr SettingChoice contrasts[] = {{0, "Normal"}, {1, "High"}};
constexpr SettingChoice memories[] = {{0, "Auto"},    {2, "2 GiB"},   {4, "4 GiB"},  {8, "8 GiB"},
                                      {16, "16 GiB"}, {32, "32 GiB"}, {64, "64 GiB"}};
constexpr SettingChoice threads[] = {{0, "All"}, {1, "1"},   {2, "2"},  {4, "4"},
                                     {8, "8"},   {16, "16"}, {32, "32"}};
constexpr SettingChoice caches[] = {{0, "Auto"},    {5, "5 GiB"},     {20, "20 GiB"},
                                    {50, "50 GiB"}, {100, "100 GiB"}, {500, "500 GiB"}};
constexpr SettingChoice autosaves[] = {{15, "15 s"}, {30, "30 s"}, {60, "1 min"}, {300, "5 min"}};
constexpr SettingChoice settles[] = {{1, "Goes on to the final frame"}, {0, "Stays a preview"}};
constexpr SettingChoice engines[] = {{0, "Auto"}, {1, "OpenGL"}, {2, "Processor"}};

constexpr SettingRow rows[] = {
    {"interface_percent", "Interface", "Size of text and controls; Auto: as the screen asks",
     &Settings::interface_percent, scales},
    {"contrast", "Contrast", "Of text and controls against their background", &Settings::contrast, contrasts},
    {"settles", "View at rest", "How views begin; View > Settle changes the one that is open",
     &Settings::settles, settles},
    {"engine", "Preview by", "How views begin; the tools' Engine changes the one that is open",
     &Settings::engine, engines},
    {"threads", "Threads", "Of the window and of each of its jobs, from the next start; --threads wins",
     &Settings::threads, threads},
    {"memory_gib", "Memory",
     "Most that the window takes, from the next start, as if the machine had no more: sets that are larger "
     "are made "
     "coarser or refused; Auto: what is free",
     &Settings::memory_gib, memories},
    {"cache_gib", "Cache",
     "Most that generated sets may take, from the next start; Auto: 20 GiB or a tenth of the disk",
     &Settings::cache_gib, caches},
    {"autosave_s", "Autosave", "How soon an edit is safe from a crash, from the next start",
     &Settings::autosave_s, autosaves}};

}  // namespace

std::span<const SettingRow> setting_rows() { return rows; }

std::string problem_of_cache_folder(const std::string& folder) {
    const std::filesystem::path path = folder;
    std::error_code ignored;
    if (folder.empty()) return "";
    if (!path.is_absolute()) return "expected an absolute path, found '" + folder + "'";
    if (std::filesystem::exists(path, ignored) && !std::filesystem::is_directory(path, ignored))
        return "expected a folder, found the file '" + folder + "'";
    return "";
}

MachineLimits limits_with(const Settings& settings, int threads_given) {
    return {threads_given > 0 ? threads_given : settings.threads, settings.memory_gib};
}

std::vector<std::string> limit_arguments(const MachineLimits& limits) {
    std::vector<std::string> words;
    if (limits.threads > 0) words.push_back("--threads=" + std::to_string(limits.threads));
    if (limits.memory_gib > 0) words.push_back("--memory=" + std::to_string(limits.memory_gib));
    return words;
}

SetCache cache_with(const Settings& settings, const SetCache& asked, bool given) {
    SetCache cache = asked;
    const char* const named = std::getenv("ASTROSPLAT_CACHE");
    const bool free = !given && !(named && *named);
    if (free && !settings.cache_folder.empty()) cache.folder = settings.cache_folder;
    cache.limit_bytes = std::int64_t{settings.cache_gib} << 30;
    return cache;
}

}  // namespace astrosplat

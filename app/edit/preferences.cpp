// nlohmann-json reads and writes numbers without the person's locale.
#include "edit/preferences.h"

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/file.h"
#include "core/log.h"

namespace astrosplat {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RenderTask, kind, frames, width, height, folder, name, by_slurm, chunk,
                                   partition, layer, most_splats)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(KeptRender, scene, usual, task)

namespace {

using Json = nlohmann::ordered_json;

void read(const Json& json, const char* name, bool& value) {
    if (json.contains(name) && json[name].is_boolean()) value = json[name].get<bool>();
}

template <class Number>
void read(const Json& json, const char* name, Number& value, double lo, double hi) {
    if (!json.contains(name) || !json[name].is_number()) return;
    const double number = json[name].get<double>();
    if (number >= lo && number <= hi) value = static_cast<Number>(number);
}

// Absolute paths, as long as they are there.
std::vector<fs::path> paths_of(const Json& json, const char* name, std::size_t most,
                               bool (*is_there)(const fs::path&, std::error_code&) noexcept) {
    std::vector<fs::path> paths;
    if (!json.contains(name) || !json[name].is_array()) return paths;
    for (const Json& entry : json[name]) {
        if (!entry.is_string() || paths.size() == most) continue;
        const fs::path path = entry.get<std::string>();
        std::error_code ignored;
        if (is_there(path, ignored)) paths.push_back(path);
    }
    return paths;
}

Json json_of(const std::vector<fs::path>& paths) {
    Json json = Json::array();
    for (const fs::path& path : paths) json.push_back(path.string());
    return json;
}

// Of scenes that are there, where all are told in full.
std::vector<KeptRender> renders_of(const nlohmann::json& json) try {
    auto renders = json.get<std::vector<KeptRender>>();
    std::erase_if(renders, [](const KeptRender& kept) {
        std::error_code ignored;
        return kept.task.kind > RenderKind::splats || !fs::exists(kept.scene, ignored);
    });
    return renders;
} catch (const nlohmann::json::exception&) {
    return {};
}

void add_first(std::vector<fs::path>& paths, const fs::path& path, std::size_t most) {
    const fs::path full = fs::absolute(path).lexically_normal();
    std::erase(paths, full);
    paths.insert(paths.begin(), full);
    if (paths.size() > most) paths.resize(most);
}

Preferences from_json(const Json& json) {
    Preferences p;
    read(json, "window_width", p.window_width, 100, 65536);
    read(json, "window_height", p.window_height, 100, 65536);
    read(json, "panel_width", p.panel_width, 300, 520);
    read(json, "timeline_height", p.timeline_height, 36, 2000);
    read(json, "timeline_open", p.timeline_open);
    read(json, "scopes_open", p.scopes_open);
    for (std::size_t i = 0; i < scope_count; ++i) read(json, scope_names[i], p.scopes[i]);
    for (const SettingRow& row : setting_rows()) {
        int value = 0;
        read(json, row.name, value, -1e9, 1e9);
        const auto is_it = [&](const SettingChoice& choice) { return choice.value == value; };
        if (json.contains(row.name) && std::any_of(row.choices.begin(), row.choices.end(), is_it))
            p.settings.*row.value = value;
    }
    if (json.contains("cache_folder") && json["cache_folder"].is_string()) {
        const std::string folder = json["cache_folder"].get<std::string>();
        if (problem_of_cache_folder(folder).empty()) p.settings.cache_folder = folder;
    }
    p.recent = paths_of(json, "recent", Preferences::most_recent_files, fs::is_regular_file);
    if (json.contains("renders")) p.renders = renders_of(json["renders"]);
    p.recent_folders = paths_of(json, "recent_folders", Preferences::most_recent_folders, fs::is_directory);
    return p;
}

Json to_json(const Preferences& p) {
    Json json{{"window_width", p.window_width},   {"window_height", p.window_height},
              {"panel_width", p.panel_width},     {"timeline_height", p.timeline_height},
              {"timeline_open", p.timeline_open}, {"scopes_open", p.scopes_open}};
    for (std::size_t i = 0; i < scope_count; ++i) json[scope_names[i]] = p.scopes[i];
    for (const SettingRow& row : setting_rows()) json[row.name] = p.settings.*row.value;
    json["cache_folder"] = p.settings.cache_folder;
    json["recent"] = json_of(p.recent);
    json["recent_folders"] = json_of(p.recent_folders);
    json["renders"] = nlohmann::json(p.renders);
    return json;
}

}  // namespace

fs::path preferences_file() {
    const fs::path folder = config_folder();
    return folder.empty() ? fs::path() : folder / "viewer.json";
}

Preferences load_preferences(const fs::path& file) {
    std::error_code ignored;
    if (file.empty() || !fs::exists(file, ignored)) return {};
    try {
        const Json json = Json::parse(read_file(file));
        if (json.is_object()) return from_json(json);
        log_warning(file.string() + ": expected a JSON object, found another value; defaults are used");
    } catch (const nlohmann::json::exception&) {
        log_warning(file.string() + ": expected JSON, found something else; defaults are used");
    } catch (const std::exception& error) {
        log_warning(fmt::format("{}; defaults are used", error.what()));
    }
    return {};
}

void save_preferences(const Preferences& preferences, const fs::path& file) {
    if (file.empty()) return;
    try {
        make_folder(file.parent_path());
        const std::string text =
            to_json(preferences).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
        write_file_atomically(file, text);
    } catch (const std::exception& error) {
        log_warning(fmt::format("the window's sizes and recent files are not kept: {}", error.what()));
    }
}

void add_recent(Preferences& preferences, const fs::path& file) {
    add_first(preferences.recent, file, Preferences::most_recent_files);
}

void add_recent_folder(PanelSizes& window, const fs::path& folder) {
    add_first(window.recent_folders, folder, Preferences::most_recent_folders);
}

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
constexpr SettingChoice frames[] = {{0, "Auto"},  {-1, "Off"},    {1, "1 GiB"},  {4, "4 GiB"},
                                    {8, "8 GiB"}, {16, "16 GiB"}, {32, "32 GiB"}};
constexpr SettingChoice autosaves[] = {{15, "15 s"}, {30, "30 s"}, {60, "1 min"}, {300, "5 min"}};
constexpr SettingChoice settles[] = {{1, "Goes on to the final frame"}, {0, "Stays a preview"}};
constexpr SettingChoice engines[] = {{0, "Auto"}, {1, "Card"}, {2, "Processor"}};
constexpr SettingChoice devices[] = {{int(DeviceChoice::automatic), "Auto"},
                                     {int(DeviceChoice::gpu), "Card"},
                                     {int(DeviceChoice::cpu), "Processor"}};

constexpr SettingRow rows[] = {
    {"interface_percent", "Interface", "Size of text and controls; Auto: as the screen asks",
     &Settings::interface_percent, scales},
    {"contrast", "Contrast", "Of text and controls against their background", &Settings::contrast, contrasts},
    {"settles", "View at rest", "How views begin; View > Settle changes the one that is open",
     &Settings::settles, settles},
    {"engine", "Preview by", "How views begin; the tools' Engine changes the one that is open",
     &Settings::engine, engines},
    {"device", "Frames by",
     "What draws final frames and those of jobs, from the next start: a graphics card that has the "
     "processor's bits, or the processor; --device wins",
     &Settings::device, devices},
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
    {"frames_gib", "Final frames",
     "Most memory for final frames that were shown, which are there at once when they are to be seen again; "
     "Auto: 2 GiB, but no more than a quarter of what is free",
     &Settings::frames_gib, frames},
    {"autosave_s", "Autosave", "How soon an edit is safe from a crash, from the next start",
     &Settings::autosave_s, autosaves}};

}  // namespace

std::span<const SettingRow> setting_rows() { return rows; }

std::string problem_of_cache_folder(const std::string& folder) {
    const fs::path path = folder;
    std::error_code ignored;
    if (folder.empty()) return "";
    if (!path.is_absolute()) return "expected an absolute path, found '" + folder + "'";
    if (fs::exists(path, ignored) && !fs::is_directory(path, ignored))
        return "expected a folder, found the file '" + folder + "'";
    return "";
}

MachineLimits limits_with(const Settings& settings, int threads_given, DeviceChoice device_given) {
    const bool asked = device_given != DeviceChoice::automatic;
    return {threads_given > 0 ? threads_given : settings.threads, settings.memory_gib,
            asked ? device_given : static_cast<DeviceChoice>(settings.device)};
}

std::vector<std::string> limit_arguments(const MachineLimits& limits) {
    std::vector<std::string> words;
    if (limits.threads > 0) words.push_back("--threads=" + std::to_string(limits.threads));
    if (limits.memory_gib > 0) words.push_back("--memory=" + std::to_string(limits.memory_gib));
    if (limits.device != DeviceChoice::automatic)
        words.push_back(limits.device == DeviceChoice::gpu ? "--device=gpu" : "--device=cpu");
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

// nlohmann-json reads and writes numbers without the person's locale.
#include "edit/preferences.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/file.h"
#include "core/log.h"
#include "edit/user_folders.h"

namespace astrosplat {
namespace fs = std::filesystem;
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

Preferences from_json(const Json& json) {
    Preferences p;
    read(json, "window_width", p.window_width, 100, 65536);
    read(json, "window_height", p.window_height, 100, 65536);
    read(json, "panel_width", p.panel_width, 300, 520);
    read(json, "timeline_height", p.timeline_height, 36, 2000);
    read(json, "timeline_open", p.timeline_open);
    if (!json.contains("recent") || !json["recent"].is_array()) return p;
    for (const Json& entry : json["recent"]) {
        if (!entry.is_string() || p.recent.size() == Preferences::most_recent_files) continue;
        const fs::path file = entry.get<std::string>();
        std::error_code ignored;
        if (fs::is_regular_file(file, ignored)) p.recent.push_back(file);
    }
    return p;
}

Json to_json(const Preferences& p) {
    Json recent = Json::array();
    for (const fs::path& file : p.recent) recent.push_back(file.string());
    return {{"window_width", p.window_width},   {"window_height", p.window_height},
            {"panel_width", p.panel_width},     {"timeline_height", p.timeline_height},
            {"timeline_open", p.timeline_open}, {"recent", recent}};
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
    const fs::path full = fs::absolute(file).lexically_normal();
    auto& recent = preferences.recent;
    std::erase(recent, full);
    recent.insert(recent.begin(), full);
    if (recent.size() > Preferences::most_recent_files) recent.resize(Preferences::most_recent_files);
}

}  // namespace astrosplat

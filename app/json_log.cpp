#include "json_log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "core/log.h"

namespace astrosplat {
namespace {

using Json = nlohmann::ordered_json;

bool as_json = false;  // set once, before anything runs beside it

// UTC, as RFC 3339 has it.
std::string time_now() {
    const auto now =
        std::chrono::time_point_cast<std::chrono::milliseconds>(std::chrono::system_clock::now());
    const auto ms = now.time_since_epoch().count();
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(now)),
                       ms % 1000);
}

Json event_of(const char* name) { return {{"time", time_now()}, {"event", name}}; }

// Bytes of a file's name that are no UTF-8 are replaced.
std::string line_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

const char* name_of_level(LogLevel level) {
    switch (level) {
        case LogLevel::error:
            return "error";
        case LogLevel::warning:
            return "warning";
        case LogLevel::info:
            return "info";
        case LogLevel::detail:
            break;
    }
    return "detail";
}

std::string json_message(LogLevel level, const std::string& text) {
    Json json = event_of("message");
    json["level"] = name_of_level(level);
    json["text"] = text;
    return line_of(json);
}

}  // namespace

void log_as_json() {
    as_json = true;
    set_log_format(json_message);
}

bool logs_json() { return as_json; }

std::string json_line(const ProgressEvent& event) {
    Json json = event_of("progress");
    json["step"] = event.step;
    if (event.frame) {
        json["frame"] = *event.frame;
        json["index"] = event.index;
        json["count"] = event.count;
    }
    json["fraction"] = event.fraction;
    json["fraction_of_all"] = event.fraction_of_all;
    if (event.seconds_left) json["seconds_left"] = *event.seconds_left;
    if (event.seconds_left_of_all) json["seconds_left_of_all"] = *event.seconds_left_of_all;
    return line_of(json);
}

std::string json_line_saved(const std::filesystem::path& file, double seconds) {
    Json json = event_of("saved");
    json["file"] = file.string();
    json["seconds"] = seconds;
    return line_of(json);
}

}  // namespace astrosplat

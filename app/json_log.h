// --log-json: everything on stderr as JSON, one object a line, for programs that watch a render. In: messages
// and progress. Out: lines such as {"time":"2026-11-24T09:30:00.250Z","event":"message","level":"warning",
// "text":"..."}.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace astrosplat {

/// From now on messages are JSON, and so is progress.
void log_as_json();
bool logs_json();

/// How far a step or a frame is. Times in seconds, none while they are not known.
struct ProgressEvent {
    std::string step;                   // "preparing"; of frames "frame"
    std::optional<std::int64_t> frame;  // its number
    std::int64_t index = 1, count = 1;  // of the frame among those of the run, from 1
    double fraction = 0.0;              // 0..1 of this step or frame
    double fraction_of_all = 0.0;
    std::optional<double> seconds_left, seconds_left_of_all;
};
std::string json_line(const ProgressEvent& event);

/// A file was written.
std::string json_line_saved(const std::filesystem::path& file, double seconds);

}  // namespace astrosplat

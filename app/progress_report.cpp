#include "progress_report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/log.h"
#include "core/text.h"
#include "exit.h"

namespace astrosplat {
namespace {

// Lines of JSON, for --log-json.

using Json = nlohmann::ordered_json;

bool as_json = false;  // set once, before any other thread runs

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
    constexpr std::array names = {std::pair(LogLevel::error, "error"),
                                  std::pair(LogLevel::warning, "warning"), std::pair(LogLevel::info, "info"),
                                  std::pair(LogLevel::detail, "detail")};
    return std::ranges::find(names, level, [](const auto& named) { return named.first; })->second;
}

std::string json_message(LogLevel level, const std::string& text) {
    Json json = event_of("message");
    json["level"] = name_of_level(level);
    json["text"] = text;
    return line_of(json);
}

// The bar and plain lines.

constexpr auto bar_interval = std::chrono::milliseconds(100);
constexpr auto line_interval = std::chrono::seconds(5);  // at least every 10 s is promised

/// At the pace so far; negative while nothing is done yet.
double seconds_left(std::chrono::steady_clock::time_point start, double fraction) {
    return fraction > 0.0 ? seconds_since(start) * (1.0 - fraction) / fraction : -1.0;
}

int percent_of(double fraction) { return static_cast<int>(fraction * 100.0); }

std::string bar_text(double fraction) {
    constexpr int width = 30;
    const int filled = static_cast<int>(fraction * width);
    return "[" + std::string(static_cast<std::size_t>(filled), '#') +
           std::string(static_cast<std::size_t>(width - filled), '.') + "]";
}

}  // namespace

void log_as_json() {
    as_json = true;
    set_log_format(json_message);
}

std::string clock_text(double seconds) {
    if (!(seconds >= 0.0 && seconds < 360000.0)) return "--:--:--";
    const int whole = static_cast<int>(seconds + 0.5);
    return fmt::format("{:02}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

ProgressReport::Style ProgressReport::style_for(ProgressMode mode) {
    if (mode == ProgressMode::none) return Style::none;
    if (as_json) return Style::json;
    const bool terminal = isatty(STDERR_FILENO) != 0;
    return mode == ProgressMode::automatic && terminal ? Style::bar : Style::plain;
}

ProgressReport::ProgressReport(ProgressMode mode)
    : style_(style_for(mode)),
      printer_([this] { return print_when_due(); },
               style_ == Style::none ? std::chrono::milliseconds(0) : bar_interval) {
    if (style_ == Style::none) return;
    set_log_sink([this](LogLevel level, const std::string& line) {
        const auto held = printer_.lock();
        clear_bar();
        fmt::print(stderr, "{}\n", terminal_line(level, line));
    });
}

ProgressReport::~ProgressReport() {
    if (style_ == Style::none) return;
    {
        const auto held = printer_.lock();
        label_.clear();
        clear_bar();
    }
    set_log_sink(nullptr);
}

Progress ProgressReport::begin_step(const std::string& name) { return begin(name, {}, 1, 1); }

Progress ProgressReport::begin_frame(std::int64_t number, std::int64_t index, std::int64_t count) {
    return begin(fmt::format("frame {} ({}/{})", number, index, count), number, index, count);
}

Progress ProgressReport::begin(const std::string& label, std::optional<std::int64_t> frame,
                               std::int64_t index, std::int64_t count) {
    const auto held = printer_.lock();
    frame_start_ = Clock::now();
    if (index == 1) start_ = frame_start_;
    label_ = printable(label);
    frame_ = frame;
    index_ = index;
    count_ = count;
    fraction_ = 0.0;
    print_status();
    return Progress{[this](double fraction) { fraction_.store(fraction, std::memory_order_relaxed); },
                    &interrupted()};
}

void ProgressReport::saved(const fs::path& file, double seconds) {
    const auto held = printer_.lock();
    label_.clear();
    if (style_ == Style::none) return;
    clear_bar();
    if (style_ != Style::json) {
        fmt::print(stderr, "saved {} {:.2f}s\n", printable(file.string()), seconds);
        return;
    }
    Json json = event_of("saved");
    json["file"] = file.string();
    json["seconds"] = seconds;
    fmt::print(stderr, "{}\n", line_of(json));
}

double ProgressReport::fraction_of_all(double fraction) const {
    return (static_cast<double>(index_ - 1) + fraction) / static_cast<double>(count_);
}

void ProgressReport::print_json(double fraction) {
    const double all = fraction_of_all(fraction);
    Json json = event_of("progress");
    json["step"] = frame_ ? "frame" : label_;
    if (frame_) {
        json["frame"] = *frame_;
        json["index"] = index_;
        json["count"] = count_;
    }
    json["fraction"] = fraction;
    json["fraction_of_all"] = all;
    const auto add_known = [&](const char* name, double seconds) {
        if (seconds >= 0.0) json[name] = seconds;
    };
    add_known("seconds_left", seconds_left(frame_start_, fraction));
    add_known("seconds_left_of_all", seconds_left(start_, all));
    fmt::print(stderr, "{}\n", line_of(json));
}

// Of a run of frames both are said: how far this frame is and how far all are.
void ProgressReport::print_status() {
    if (style_ == Style::none || label_.empty()) return;
    const double fraction = std::clamp(fraction_.load(std::memory_order_relaxed), 0.0, 1.0);
    last_print_ = Clock::now();
    if (style_ == Style::json) return print_json(fraction);
    const double all = fraction_of_all(fraction);
    const std::string own = clock_text(seconds_left(frame_start_, fraction));
    const std::string rest =
        count_ > 1 ? fmt::format(", all {}% eta {}", percent_of(all), clock_text(seconds_left(start_, all)))
                   : "";
    if (style_ == Style::plain) {
        fmt::print(stderr, "astrosplat: {} {}% eta {}{}\n", label_, percent_of(fraction), own, rest);
        return;
    }
    fmt::print(stderr, "\r{} {} {:3}% eta {}{}\x1b[K", label_, bar_text(all), percent_of(fraction), own,
               rest);
    std::fflush(stderr);
    bar_shown_ = true;
}

void ProgressReport::clear_bar() {
    if (bar_shown_) fmt::print(stderr, "\r\x1b[K");
    bar_shown_ = false;
}

Worker::Task ProgressReport::print_when_due() {
    if (style_ == Style::bar || Clock::now() - last_print_ >= line_interval) print_status();
    return {};
}

}  // namespace astrosplat

#include "progress_report.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "core/log.h"
#include "core/progress.h"
#include "core/text.h"
#include "interrupt.h"
#include "json_log.h"

namespace astrosplat {
namespace {

constexpr auto bar_interval = std::chrono::milliseconds(100);
// At the pace so far; negative while nothing is done yet.
double seconds_left(std::chrono::steady_clock::time_point start, double fraction) {
    return fraction > 0.0 ? seconds_since(start) * (1.0 - fraction) / fraction : -1.0;
}

int percent_of(double fraction) { return static_cast<int>(fraction * 100.0); }

constexpr auto line_interval = std::chrono::seconds(5);  // at least every 10 s is promised

std::string bar_text(double fraction) {
    constexpr int width = 30;
    const int filled = static_cast<int>(fraction * width);
    return "[" + std::string(static_cast<std::size_t>(filled), '#') +
           std::string(static_cast<std::size_t>(width - filled), '.') + "]";
}

}  // namespace

std::string clock_text(double seconds) {
    if (!(seconds >= 0.0 && seconds < 360000.0)) return "--:--:--";
    const int whole = static_cast<int>(seconds + 0.5);
    return fmt::format("{:02}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

ProgressReport::Style ProgressReport::style_for(ProgressMode mode) {
    if (mode == ProgressMode::none) return Style::none;
    if (logs_json()) return Style::json;
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

void ProgressReport::saved(const std::filesystem::path& file, double seconds) {
    const auto held = printer_.lock();
    label_.clear();
    if (style_ == Style::none) return;
    clear_bar();
    if (style_ == Style::json)
        fmt::print(stderr, "{}\n", json_line_saved(file, seconds));
    else
        fmt::print(stderr, "saved {} {:.2f}s\n", printable(file.string()), seconds);
}

double ProgressReport::fraction_of_all(double fraction) const {
    return (static_cast<double>(index_ - 1) + fraction) / static_cast<double>(count_);
}

void ProgressReport::print_json(double fraction) {
    const double all = fraction_of_all(fraction);
    const auto known = [](double seconds) {
        return seconds >= 0.0 ? std::optional<double>(seconds) : std::nullopt;
    };
    const std::string line = json_line({.step = frame_ ? "frame" : label_,
                                        .frame = frame_,
                                        .index = index_,
                                        .count = count_,
                                        .fraction = fraction,
                                        .fraction_of_all = all,
                                        .seconds_left = known(seconds_left(frame_start_, fraction)),
                                        .seconds_left_of_all = known(seconds_left(start_, all))});
    fmt::print(stderr, "{}\n", line);
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

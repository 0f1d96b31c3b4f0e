// Progress on stderr: a bar with the time left on a terminal, plain lines elsewhere; with --log-json all on
// stderr is JSON, one object a line, for programs that watch a render: {"time":"2026-11-24T09:30:00.250Z",
// "event":"message","level":"warning","text":"..."}. Work reports fractions through Progress values from any
// thread; one thread of its own prints, so that a slow frame still gives a line in time.
#pragma once

#include <atomic>
#include <chrono>

#include "core/progress.h"
#include "core/worker.h"

namespace astrosplat {

enum class ProgressMode { automatic, plain, none };

/// From now on messages are JSON, and so is progress.
void log_as_json();

/// "00:04:10"; "--:--:--" for what is not known (negative) or longer than 99 hours.
std::string clock_text(double seconds);

class ProgressReport {
  public:
    /// Log messages pass through here while it lives, so that they do not collide with the bar.
    explicit ProgressReport(ProgressMode mode);
    ~ProgressReport();
    ProgressReport(const ProgressReport&) = delete;
    ProgressReport& operator=(const ProgressReport&) = delete;

    /// A step that counts for itself, such as "preparing".
    Progress begin_step(const std::string& name);
    /// Frame `number`, the index-th (from 1) of `count`. The time left covers all of them.
    Progress begin_frame(std::int64_t number, std::int64_t index, std::int64_t count);
    /// "saved FILE 1.82s"
    void saved(const fs::path& file, double seconds);

  private:
    enum class Style { bar, plain, json, none };
    static Style style_for(ProgressMode mode);
    Progress begin(const std::string& label, std::optional<std::int64_t> frame, std::int64_t index,
                   std::int64_t count);
    void print_json(double fraction);
    Worker::Task print_when_due();
    void print_status();  // these three with the printer's lock
    void clear_bar();
    double fraction_of_all(double fraction) const;

    Style style_;
    std::atomic<double> fraction_{0.0};  // of the step or frame at hand
    bool bar_shown_ = false;
    std::string label_;                  // empty: nothing at hand
    std::optional<std::int64_t> frame_;  // none: a step
    std::int64_t index_ = 1, count_ = 1;
    std::chrono::steady_clock::time_point start_;        // of the first frame, or of the step
    std::chrono::steady_clock::time_point frame_start_;  // of this one
    std::chrono::steady_clock::time_point last_print_;
    Worker printer_;
};

}  // namespace astrosplat

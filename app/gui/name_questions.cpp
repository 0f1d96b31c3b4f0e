#include "gui/name_questions.h"

#include <utility>

#include "core/clock.h"

namespace astrosplat {
namespace fs = std::filesystem;

void NameQuestions::complete(const std::string& typed, const fs::path& folder) {
    completes_ = typed;
    asked_at_ = seconds_now();
    completion_.begin([typed, folder](const std::atomic<bool>&) { return complete_path(typed, folder); });
    completed_ = completion_.take(disk_moment);
}

std::optional<std::string> NameQuestions::completed(const std::string& typed_now) {
    if (typed_now != completes_) {
        completion_.forget();
        completed_.reset();
    }
    if (!completed_) completed_ = completion_.take();
    return std::exchange(completed_, std::nullopt);
}

void NameQuestions::look(const fs::path& typed, const std::string& ending) {
    asked_at_ = seconds_now();
    file_.begin([typed, ending](const std::atomic<bool>&) { return look_at(typed, ending); });
    found_ = file_.take(disk_moment);
}

std::optional<TypedFile> NameQuestions::found() {
    if (!found_) found_ = file_.take();
    return std::exchange(found_, std::nullopt);
}

void NameQuestions::forget() {
    completion_.forget();
    file_.forget();
    completed_.reset();
    found_.reset();
}

bool NameQuestions::keys_wait() const {
    constexpr double patience_s = 1.0;
    return (completion_.is_open() || file_.is_open()) && seconds_now() - asked_at_ < patience_s;
}

}  // namespace astrosplat

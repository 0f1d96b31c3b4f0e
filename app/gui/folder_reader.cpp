// One thread a folder, which owns all that it touches: nothing waits for it, also when the program ends.
#include "gui/folder_reader.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace astrosplat {
namespace fs = std::filesystem;

struct FolderReader::Job {
    std::mutex mutex;
    std::condition_variable ready;
    std::atomic<bool> cancelled{false};
    std::optional<FolderContents> found;
};

FolderReader::~FolderReader() { forget(); }

void FolderReader::forget() {
    if (job_) job_->cancelled = true;
    job_.reset();
}

void FolderReader::begin(const fs::path& folder, const fs::path& otherwise,
                         const std::vector<std::string>& extensions) {
    forget();
    job_ = std::make_shared<Job>();
    std::thread([job = job_, folder, otherwise, extensions] {
        std::error_code ignored;
        FolderContents contents;
        contents.folder =
            fs::weakly_canonical(fs::is_directory(folder, ignored) ? folder : otherwise, ignored);
        contents.entries = list_folder(contents.folder, extensions, &job->cancelled);
        const std::lock_guard held(job->mutex);
        job->found = std::move(contents);
        job->ready.notify_all();
    }).detach();
}

std::optional<FolderContents> FolderReader::take(std::chrono::milliseconds at_most) {
    if (!job_) return std::nullopt;
    std::unique_lock held(job_->mutex);
    if (!job_->ready.wait_for(held, at_most, [&] { return job_->found.has_value(); })) return std::nullopt;
    std::optional<FolderContents> found = std::move(job_->found);
    held.unlock();
    job_.reset();
    return found;
}

}  // namespace astrosplat

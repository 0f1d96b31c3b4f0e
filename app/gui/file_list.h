// The content of a file dialog, without widgets: entries of a folder, the rest of a path whose beginning is
// typed, and how a disk is asked for these outside of the window's thread, which a slow disk must not stop.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace astrosplat {

struct FileEntry {
    std::string name;
    bool folder = false;
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type changed{};
};

enum class FileOrder { name, changed, size };

/// Folders first, then files, each by name without regard to case; hidden ones left out. `extensions`
/// (".toml", lower case) limit the files; empty: all. An unreadable folder is empty; the rest is missing once
/// `cancelled`.
std::vector<FileEntry> list_folder(const std::filesystem::path& folder,
                                   const std::vector<std::string>& extensions,
                                   const std::atomic<bool>* cancelled = nullptr);

/// Folders first; each by `order`, then by name without regard to case, numbers in names as numbers. What is
/// newer or larger comes first, unless `backwards`.
void sort_entries(std::vector<FileEntry>& entries, FileOrder order, bool backwards);

/// The first entry whose name begins with what is typed, in capitals or not; none: where nothing is.
std::optional<std::size_t> entry_begun(const std::vector<FileEntry>& entries, const std::string& typed);
/// The entry above (`step` -1) or below (1) the one that is typed; where none is, the one begun, else the
/// first or the last.
std::optional<std::size_t> entry_beside(const std::vector<FileEntry>& entries, const std::string& typed,
                                        int step);

/// "2026-03-01 18:30", on this machine's clock.
std::string time_text(std::filesystem::file_time_type time);

/// `typed` as a path: "~/x" in the home folder, relative ones in `folder`.
std::filesystem::path typed_path(const std::string& typed, const std::filesystem::path& folder);

/// The target of a path.
struct TypedFile {
    std::filesystem::path file;
    bool is_folder = false;
    bool exists = false;      // a file
    bool has_folder = false;  // that it lies in, or would
};
/// `ending` (".toml"; may be empty) is added where `typed` has none and is no folder.
TypedFile look_at(const std::filesystem::path& typed, const std::string& ending);

/// `typed` lengthened as far as the files there leave no choice; a folder that is the only choice gets its
/// "/".
std::string complete_path(const std::string& typed, const std::filesystem::path& folder);

/// $HOME, or the root.
std::filesystem::path home_folder();

struct FolderContents {
    std::filesystem::path folder;  // without symbolic links, as far as it exists
    std::vector<FileEntry> entries;
};
/// Of `otherwise` where there is no such folder. `extensions` and `cancelled` as list_folder has them.
FolderContents read_folder(const std::filesystem::path& folder, const std::filesystem::path& otherwise,
                           const std::vector<std::string>& extensions, const std::atomic<bool>& cancelled);

/// A question to a disk. In: a function that asks. Out: its answer, when that is known. Each has a thread,
/// which owns all that it touches: nothing waits for it, also when the program ends.
template <class Answer>
class DiskQuestion {
  public:
    /// Once `forgotten` the rest of the answer may be left out.
    using Ask = std::function<Answer(const std::atomic<bool>& forgotten)>;

    DiskQuestion() = default;
    ~DiskQuestion() { forget(); }
    DiskQuestion(const DiskQuestion&) = delete;
    DiskQuestion& operator=(const DiskQuestion&) = delete;

    /// Earlier questions are dropped. Waits for as long as a window that stands still does not flash, in
    /// which most disks answer.
    void begin(Ask ask) {
        forget();
        forgotten_ = std::make_shared<std::atomic<bool>>(false);
        std::packaged_task<Answer()> task(
            [forgotten = forgotten_, ask = std::move(ask)] { return ask(*forgotten); });
        answer_ = task.get_future();
        std::thread(std::move(task)).detach();
        answer_.wait_for(std::chrono::milliseconds(200));
    }
    /// The answer is not known yet, or was not taken.
    bool is_open() const { return answer_.valid(); }
    /// The answer, once, when it is known.
    std::optional<Answer> take() {
        using std::chrono::seconds;
        if (!is_open() || answer_.wait_for(seconds(0)) != std::future_status::ready) return std::nullopt;
        return answer_.get();
    }
    void forget() {
        if (forgotten_) *forgotten_ = true;
        answer_ = {};
    }

  private:
    std::shared_ptr<std::atomic<bool>> forgotten_;  // null: nothing was asked for
    std::future<Answer> answer_;
};

}  // namespace astrosplat

// The window's own file dialog: a path that completes with Tab, the folder's files of the wanted kind by
// name, time or size, with thumbnails, places to jump to, and a question before a file is replaced. Beneath
// it, its content without widgets, and how a disk is asked for that outside of the window's thread, which a
// slow disk must not stop.
#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include "edit/document.h"
#include "edit/status.h"
#include "edit/view_state.h"
#include "gui/gui_frame.h"
#include "gui/widgets.h"
#include "scene/parameter_key.h"

struct ImGuiInputTextCallbackData;

namespace astrosplat {

struct FileEntry {
    std::string name;
    bool folder = false;
    std::uintmax_t bytes = 0;
    fs::file_time_type changed{};
};

enum class FileOrder { name, changed, size };

/// Folders first, then files, each by name without regard to case; hidden ones left out. `extensions`
/// (".toml", lower case) limit the files; empty: all. An unreadable folder is empty;
/// the rest is missing once `cancelled`.
std::vector<FileEntry> list_folder(const fs::path& folder, const std::vector<std::string>& extensions,
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
std::string time_text(fs::file_time_type time);

/// `typed` as a path: "~/x" in the home folder, relative ones in `folder`.
fs::path typed_path(const std::string& typed, const fs::path& folder);

/// The target of a path.
struct TypedFile {
    fs::path file;
    bool is_folder = false;
    bool exists = false;      // a file
    bool has_folder = false;  // that it lies in, or would
};
/// `ending` (".toml"; may be empty) is added where `typed` has none and is no folder.
TypedFile look_at(const fs::path& typed, const std::string& ending);

/// `typed` lengthened as far as the files there leave no choice; a folder that is the only choice
/// gets its "/".
std::string complete_path(const std::string& typed, const fs::path& folder);

/// $HOME, or the root.
fs::path home_folder();

struct FolderContents {
    fs::path folder;  // without symbolic links, as far as it exists
    std::vector<FileEntry> entries;
};
/// Of `otherwise` where there is no such folder. `extensions` and `cancelled` as list_folder has them.
FolderContents read_folder(const fs::path& folder, const fs::path& otherwise,
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

/// A file the person is to choose.
struct FileQuery {
    std::string title;                    // "Open a scene"
    bool saving = false;                  // the file need not exist, and is asked for again where it does
    std::string kind;                     // "Scenes", of the filter
    std::vector<std::string> extensions;  // ".toml", lower case; empty: any
    fs::path folder;                      // to begin in
    std::string name;                     // suggested, when saving
    fs::path otherwise{};                 // to begin in where there is no such folder; empty: home
};

/// The request where `kind` needs a path; nothing where it needs none.
std::optional<FileQuery> query_for(Command::Kind kind, const Document& document);
/// The request for the value of a parameter.
FileQuery query_for(const ParameterKey& key, const Document& document);

inline constexpr float file_row_height = 26, thumbnail_row_height = 54;  // px at scale 1

struct FileRow {
    Icon icon = Icon::file;
    std::string text;
    bool chosen = false;
    std::string time{}, size{};                  // in columns of their own, both or none
    bool high = false;                           // among pictures: there is room for one in place of the icon
    bool picture = false;                        // it is one, and black until it is seen
    const ListedThumbnail* thumbnail = nullptr;  // of a picture; null: not read yet
};

struct FileClick {
    bool once = false, twice = false;
};
/// As wide as there is room.
FileClick file_row(const char* id, const FileRow& row);

/// The columns' names over rows `room` px wide. True when one was clicked, which changes the order, or the
/// same one backwards.
bool draw_file_columns(GuiFrame& frame, float room, FileOrder& order, bool& backwards);

class FileDialog {
  public:
    void open(const FileQuery& query);
    bool is_open() const { return open_; }
    /// The path is about to take what is typed.
    bool awaits_typing() const { return open_ && (awaits_typing_ || keys_wait()); }

    struct Answer {
        bool done = false;  // the dialog has closed
        std::optional<fs::path> file;
    };
    /// Draws it while it is open.
    Answer draw(GuiFrame& frame);

  private:
    /// `otherwise`: where there is no such folder.
    void go_to(const fs::path& folder, const fs::path& otherwise);
    void go_to(const fs::path& folder) { go_to(folder, folder); }
    void retype(const std::string& text) { retyped_ = typed_ = text; }
    void forget_questions();
    bool keys_wait() const;
    void draw_places(GuiFrame& frame);
    void draw_path(GuiFrame& frame);
    void scroll_to_typed();
    static int on_key(ImGuiInputTextCallbackData* data);
    std::optional<std::string> text_for(const ImGuiInputTextCallbackData& data);
    void list_entries(const fs::path& otherwise);
    void take_entries();
    FileClick draw_entry(GuiFrame& frame, const FileEntry& entry);
    bool draw_entries(GuiFrame& frame);
    Answer draw_bottom(GuiFrame& frame, bool chosen);
    void look();
    std::optional<fs::path> accept(const TypedFile& typed);

    FileQuery query_;
    bool open_ = false, all_files_ = false, focus_path_ = false, awaits_typing_ = false;
    bool replaces_ = false;  // the file exists and the person was told
    fs::path folder_;
    DiskQuestion<FolderContents> contents_;
    DiskQuestion<std::string> completion_;  // of:
    std::string completed_;
    DiskQuestion<TypedFile> target_;  // of what is typed
    double asked_at_ = 0.0;           // for one of these two, s
    std::string typed_, complaint_;
    std::optional<std::string> retyped_;  // for the field, which has its own text while keys go there
    double entered_ = -1e9;               // when the click began that went into the folder, s
    bool typed_anew_ = false;             // the list has not followed yet
    std::vector<FileEntry> entries_;      // folders first
    std::size_t folders_ = 0;             // of these
    bool pictures_ = false;               // some of the files are
    float rows_px_ = 0.0f;                // width of the rows drawn last: less beside a scroll bar
    FileOrder order_ = FileOrder::name;   // stays for the next file
    bool backwards_ = false;
};

}  // namespace astrosplat

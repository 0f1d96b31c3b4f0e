// The window's own file dialog: a path that completes with Tab, the folder's files of the wanted kind, places
// to jump to, and a question before a file is replaced. It lists by name, time or size, pictures as they
// look.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gui/file_list.h"
#include "gui/file_queries.h"
#include "gui/file_rows.h"
#include "gui/folder_reader.h"
#include "gui/gui_frame.h"
#include "gui/name_questions.h"

struct ImGuiInputTextCallbackData;

namespace astrosplat {

class FileDialog {
  public:
    void open(const FileQuery& query);
    bool is_open() const { return open_; }
    /// The path is about to take what is typed.
    bool awaits_typing() const { return open_ && (awaits_typing_ || name_.keys_wait()); }

    struct Answer {
        bool done = false;  // the dialog has closed
        std::optional<std::filesystem::path> file;
    };
    /// Draws it while it is open.
    Answer draw(GuiFrame& frame);

  private:
    /// `otherwise`: where there is no such folder.
    void go_to(const std::filesystem::path& folder, const std::filesystem::path& otherwise);
    void go_to(const std::filesystem::path& folder) { go_to(folder, folder); }
    void retype(const std::string& text) { retyped_ = typed_ = text; }
    void draw_places(GuiFrame& frame);
    void draw_path(GuiFrame& frame);
    void scroll_to_typed();
    static int on_key(ImGuiInputTextCallbackData* data);
    void list_entries(const std::filesystem::path& otherwise);
    void take_entries(std::chrono::milliseconds at_most);
    FileClick draw_entry(GuiFrame& frame, const FileEntry& entry);
    bool draw_entries(GuiFrame& frame);
    Answer draw_bottom(GuiFrame& frame, bool chosen);
    void look();
    std::optional<std::filesystem::path> accept(const TypedFile& typed);

    FileQuery query_;
    bool open_ = false, all_files_ = false, focus_path_ = false, awaits_typing_ = false;
    bool replaces_ = false;  // the file exists and the person was told
    std::filesystem::path folder_;
    FolderReader reader_;
    NameQuestions name_;  // about what is typed
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

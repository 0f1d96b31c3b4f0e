// The window's own file dialog: a path that completes with Tab, the folder's files of the wanted kind, places
// to jump to, and a question before a file is replaced. It lists by name, time or size, with thumbnails.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "edit/commands.h"
#include "edit/document.h"
#include "edit/status.h"
#include "gui/file_list.h"
#include "gui/gui_frame.h"
#include "gui/icons.h"
#include "scene/parameter_key.h"

struct ImGuiInputTextCallbackData;

namespace astrosplat {

/// A file the person is to choose.
struct FileQuery {
    std::string title;                    // "Open a scene"
    bool saving = false;                  // the file need not exist, and is asked for again where it does
    std::string kind;                     // "Scenes", of the filter
    std::vector<std::string> extensions;  // ".toml", lower case; empty: any
    std::filesystem::path folder;         // to begin in
    std::string name;                     // suggested, when saving
    std::filesystem::path otherwise{};    // to begin in where there is no such folder; empty: home
};

/// The request where `kind` needs a path; nothing where it needs none.
std::optional<FileQuery> query_for(Command::Kind kind, const Document& document);
/// The request for the value of a parameter.
FileQuery query_for(const ParameterKey& key, const Document& document);

inline constexpr float file_row_height = 26, picture_row_height = 54;  // px at scale 1

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
        std::optional<std::filesystem::path> file;
    };
    /// Draws it while it is open.
    Answer draw(GuiFrame& frame);

  private:
    /// `otherwise`: where there is no such folder.
    void go_to(const std::filesystem::path& folder, const std::filesystem::path& otherwise);
    void go_to(const std::filesystem::path& folder) { go_to(folder, folder); }
    void retype(const std::string& text) { retyped_ = typed_ = text; }
    void forget_questions();
    bool keys_wait() const;
    void draw_places(GuiFrame& frame);
    void draw_path(GuiFrame& frame);
    void scroll_to_typed();
    static int on_key(ImGuiInputTextCallbackData* data);
    std::optional<std::string> text_for(const ImGuiInputTextCallbackData& data);
    void list_entries(const std::filesystem::path& otherwise);
    void take_entries();
    FileClick draw_entry(GuiFrame& frame, const FileEntry& entry);
    bool draw_entries(GuiFrame& frame);
    Answer draw_bottom(GuiFrame& frame, bool chosen);
    void look();
    std::optional<std::filesystem::path> accept(const TypedFile& typed);

    FileQuery query_;
    bool open_ = false, all_files_ = false, focus_path_ = false, awaits_typing_ = false;
    bool replaces_ = false;  // the file exists and the person was told
    std::filesystem::path folder_;
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

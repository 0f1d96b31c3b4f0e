// Folders read and paths completed; then places at the left, files at the right, the path above them, the
// answer below.
#include "gui/file_dialog.h"

#include <fmt/format.h>
#include <imgui_stdlib.h>
#include <sys/stat.h>

#include <cstdlib>
#include <ctime>

#include "core/file.h"
#include "core/file_format.h"
#include "core/progress.h"
#include "core/text.h"
#include "edit/preferences.h"
#include "gui/parts.h"

namespace astrosplat {
namespace {

bool wanted(const FileEntry& entry, const std::vector<std::string>& extensions) {
    if (entry.folder || extensions.empty()) return true;
    const std::string name = lower_case(entry.name);
    return std::ranges::any_of(extensions, [&](const std::string& ending) { return name.ends_with(ending); });
}

/// All but the name is missing where it may not be looked at.
FileEntry entry_at(const fs::path& path) {
    FileEntry entry{path.filename().string()};
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return entry;
    entry.folder = S_ISDIR(status.st_mode);
    if (!entry.folder) entry.bytes = static_cast<std::uintmax_t>(status.st_size);
    const std::chrono::sys_time<std::chrono::nanoseconds> changed(
        std::chrono::seconds(status.st_mtim.tv_sec) + std::chrono::nanoseconds(status.st_mtim.tv_nsec));
    entry.changed = std::chrono::file_clock::from_sys(changed);
    return entry;
}

std::size_t common_length(const std::string& a, const std::string& b) {
    auto n = static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
    // Not in the middle of a UTF-8 character.
    while (n > 0 && n < a.size() && (static_cast<unsigned char>(a[n]) & 0xC0) == 0x80) --n;
    return n;
}

/// The end of the digits from `begin` on, and where they begin without zeros.
struct Digits {
    std::size_t first, end;
};
Digits digits_at(const std::string& text, std::size_t begin) {
    constexpr const char* all = "0123456789";
    const std::size_t end = std::min(text.find_first_not_of(all, begin), text.size());
    return {std::min(text.find_first_not_of('0', begin), end), end};
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// As people count: "p9" before "p10".
bool comes_before(const std::string& a, const std::string& b) {
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (!is_digit(a[i]) || !is_digit(b[j])) {
            if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
            ++i;
            ++j;
            continue;
        }
        const Digits m = digits_at(a, i), n = digits_at(b, j);
        const std::size_t length = m.end - m.first;
        if (length != n.end - n.first) return length < n.end - n.first;
        if (const int order = a.compare(m.first, length, b, n.first, length); order != 0) return order < 0;
        i = m.end;
        j = n.end;
    }
    return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

}  // namespace

std::vector<FileEntry> list_folder(const fs::path& folder, const std::vector<std::string>& extensions,
                                   const std::atomic<bool>* cancelled) {
    std::vector<FileEntry> entries;
    for (const fs::path& path : entries_of(folder)) {
        if (cancelled && *cancelled) break;
        FileEntry entry = entry_at(path);
        if (entry.name[0] != '.' && wanted(entry, extensions)) entries.push_back(std::move(entry));
    }
    sort_entries(entries, FileOrder::name, false);
    return entries;
}

void sort_entries(std::vector<FileEntry>& entries, FileOrder order, bool backwards) {
    std::vector<std::pair<std::string, FileEntry>> named;  // names in lower case, made once each
    named.reserve(entries.size());
    for (FileEntry& entry : entries) {
        std::string name = lower_case(entry.name);
        named.emplace_back(std::move(name), std::move(entry));
    }
    std::sort(named.begin(), named.end(), [&](const auto& one, const auto& other) {
        const auto& [name_a, a] = one;
        const auto& [name_b, b] = other;
        if (a.folder != b.folder) return a.folder;
        if (order == FileOrder::changed && a.changed != b.changed)
            return (a.changed > b.changed) != backwards;
        if (order == FileOrder::size && a.bytes != b.bytes) return (a.bytes > b.bytes) != backwards;
        const bool backwards_names = backwards && order == FileOrder::name;
        return (name_a != name_b ? comes_before(name_a, name_b) : a.name < b.name) !=
               (backwards_names && a.name != b.name);
    });
    entries.clear();
    for (auto& [name, entry] : named) entries.push_back(std::move(entry));
}

std::optional<std::size_t> entry_begun(const std::vector<FileEntry>& entries, const std::string& typed) {
    if (typed.empty()) return std::nullopt;
    const std::string begun = lower_case(typed);
    const auto found = std::ranges::find_if(
        entries, [&](const FileEntry& entry) { return lower_case(entry.name).starts_with(begun); });
    if (found == entries.end()) return std::nullopt;
    return static_cast<std::size_t>(found - entries.begin());
}

std::optional<std::size_t> entry_beside(const std::vector<FileEntry>& entries, const std::string& typed,
                                        int step) {
    if (entries.empty()) return std::nullopt;
    const auto last = static_cast<std::ptrdiff_t>(entries.size()) - 1;
    const auto chosen = std::ranges::find(entries, typed, &FileEntry::name);
    if (chosen != entries.end())
        return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(chosen - entries.begin() + step, 0, last));
    if (const auto begun = entry_begun(entries, typed)) return begun;
    return step > 0 ? 0 : static_cast<std::size_t>(last);
}

std::string time_text(fs::file_time_type time) {
    const auto since_1970 = std::chrono::file_clock::to_sys(time).time_since_epoch();
    const std::time_t seconds = std::chrono::duration_cast<std::chrono::seconds>(since_1970).count();
    std::tm local{};
    if (!localtime_r(&seconds, &local)) return {};
    char text[32];
    return std::string(text, std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &local));
}

FolderContents read_folder(const fs::path& folder, const fs::path& otherwise,
                           const std::vector<std::string>& extensions, const std::atomic<bool>& cancelled) {
    std::error_code ignored;
    const fs::path read =
        fs::weakly_canonical(fs::is_directory(folder, ignored) ? folder : otherwise, ignored);
    return {read, list_folder(read, extensions, &cancelled)};
}

fs::path home_folder() {
    const char* home = std::getenv("HOME");
    return home && *home ? fs::path(home) : fs::path("/");
}

fs::path typed_path(const std::string& typed, const fs::path& folder) {
    if (typed == "~") return home_folder();
    if (typed.rfind("~/", 0) == 0) return home_folder() / typed.substr(2);
    return folder / typed;  // an absolute path stays as it is
}

TypedFile look_at(const fs::path& typed, const std::string& ending) {
    std::error_code ignored;
    TypedFile found{typed};
    if (fs::is_directory(typed, ignored)) {
        found.is_folder = true;
        return found;
    }
    if (!found.file.has_extension()) found.file += ending;
    found.exists = fs::exists(found.file, ignored);
    found.has_folder = fs::is_directory(found.file.parent_path(), ignored);
    return found;
}

std::string complete_path(const std::string& typed, const fs::path& folder) {
    const std::size_t slash = typed.rfind('/');
    const std::string head = slash == std::string::npos ? "" : typed.substr(0, slash + 1);
    const std::string begun = typed.substr(head.size());
    std::string common;
    int matches = 0;
    bool is_folder = false;
    for (const FileEntry& entry : list_folder(typed_path(head, folder), {})) {
        if (entry.name.rfind(begun, 0) != 0) continue;
        common = matches++ == 0 ? entry.name : common.substr(0, common_length(common, entry.name));
        is_folder = entry.folder;
    }
    if (matches == 0) return typed;
    return head + common + (matches == 1 && is_folder ? "/" : "");
}

namespace {

constexpr float dialog_width = 820, dialog_height = 520, places_width = 168;
constexpr std::size_t most_places = 12;

bool shows_picture(const FileEntry& entry) {
    return !entry.folder && kind_of(format_by_name(entry.name)) == FileKind::picture;
}

// "1.2 MB".
std::string size_text(std::uintmax_t bytes) {
    const double n = static_cast<double>(bytes);
    if (n < 1e3) return fmt::format("{} B", bytes);
    if (n < 1e6) return fmt::format("{:.0f} kB", n / 1e3);
    if (n < 1e9) return fmt::format("{:.1f} MB", n / 1e6);
    return fmt::format("{:.1f} GB", n / 1e9);
}

}  // namespace

void FileDialog::open(const FileQuery& query) {
    query_ = query;
    open_ = true;
    all_files_ = replaces_ = false;
    go_to(query.folder, query.otherwise.empty() ? home_folder() : query.otherwise);
    typed_ = query.name;
}

void FileDialog::go_to(const fs::path& folder, const fs::path& otherwise) {
    forget_questions();
    folder_ = folder.lexically_normal();
    list_entries(otherwise);
    complaint_.clear();
    if (!query_.saving) retype("");
    focus_path_ = awaits_typing_ = true;  // the name comes next
}

void FileDialog::list_entries(const fs::path& otherwise) {
    entries_.clear();
    folders_ = 0;
    contents_.begin(
        [folder = folder_, otherwise,
         extensions = all_files_ ? std::vector<std::string>{} : query_.extensions](const auto& forgotten) {
            return read_folder(folder, otherwise, extensions, forgotten);
        });
    take_entries();
}

void FileDialog::take_entries() {
    std::optional<FolderContents> found = contents_.take();
    if (!found) return;
    folder_ = std::move(found->folder);
    entries_ = std::move(found->entries);
    sort_entries(entries_, order_, backwards_);
    folders_ = static_cast<std::size_t>(std::ranges::count_if(entries_, &FileEntry::folder));
    pictures_ = std::ranges::any_of(entries_, shows_picture);
}

void FileDialog::draw_places(GuiFrame& frame) {
    std::vector<std::pair<std::string, fs::path>> places;
    if (!frame.document.file().empty())
        places.emplace_back("Scene folder", frame.document.file().parent_path());
    places.emplace_back("Home", home_folder());
    places.emplace_back("Computer", "/");
    const auto add = [&](const fs::path& folder) {
        const bool known = std::ranges::any_of(places, [&](const auto& p) { return p.second == folder; });
        if (!known && places.size() < most_places) places.emplace_back(folder.filename().string(), folder);
    };
    for (const fs::path& folder : frame.view.recent_folders) add(folder);
    for (const fs::path& file : frame.status.recent) add(file.parent_path());
    for (const auto& [name, folder] : places) {
        if (file_row(folder.c_str(), {Icon::folder, name, folder == folder_}).once) go_to(folder);
        note_item(frame, "place/" + folder.string());
        tooltip(folder.c_str());
    }
}

void FileDialog::forget_questions() {
    completion_.forget();
    target_.forget();
}

// For a while keys are better kept: where they go depends on an answer that is to come.
bool FileDialog::keys_wait() const {
    constexpr double patience_s = 1.0;
    return (completion_.is_open() || target_.is_open()) && seconds_now() - asked_at_ < patience_s;
}

// The text to replace the path with: Tab lengthens what is typed, Up and Down go through the list.
std::optional<std::string> FileDialog::text_for(const ImGuiInputTextCallbackData& data) {
    const std::string typed(data.Buf, data.Buf + data.BufTextLen);
    if (data.EventFlag == ImGuiInputTextFlags_CallbackHistory) {
        const auto entry = entry_beside(entries_, typed, data.EventKey == ImGuiKey_UpArrow ? -1 : 1);
        return entry ? std::optional(entries_[*entry].name) : std::nullopt;
    }
    if (retyped_) return std::exchange(retyped_, {});
    if (data.EventFlag == ImGuiInputTextFlags_CallbackCompletion) {
        completed_ = typed;
        asked_at_ = seconds_now();
        completion_.begin([typed, folder = folder_](const auto&) { return complete_path(typed, folder); });
    }
    if (typed != completed_) completion_.forget();
    return completion_.take();
}

int FileDialog::on_key(ImGuiInputTextCallbackData* data) {
    if (const auto text = static_cast<FileDialog*>(data->UserData)->text_for(*data)) {
        data->DeleteChars(0, data->BufTextLen);
        data->InsertChars(0, text->c_str());
    }
    return 0;
}

void FileDialog::draw_path(GuiFrame& frame) {
    if (icon_button("up", Icon::chevron_up, {px(28), px(28)}, px(11), color::dim, "Folder above"))
        go_to(folder_.parent_path());
    ImGui::SameLine(0, px(4));
    row_text(fitting(folder_.string() + (folder_ == folder_.root_path() ? "" : "/"), px(dialog_width - 60)),
             px(28), color::dim);
    if (focus_path_) ImGui::SetKeyboardFocusHere();
    focus_path_ = false;
    ImGui::SetNextItemWidth(-1);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(8), px(6)));
    const std::string before = typed_;
    ImGui::InputTextWithHint("##path", "File, or a path; Tab completes it, Up and Down choose", &typed_,
                             ImGuiInputTextFlags_CallbackCompletion | ImGuiInputTextFlags_CallbackHistory |
                                 ImGuiInputTextFlags_CallbackAlways,
                             on_key, this);
    ImGui::PopStyleVar();
    retyped_.reset();  // where it was not active, it shows typed_
    if (ImGui::IsItemActive()) awaits_typing_ = false;
    note_item(frame, "file/path");
    if (typed_ != before) {
        forget_questions();
        replaces_ = false;
        complaint_.clear();
        typed_anew_ = true;
    }
}

// The entry that is typed, or begun, comes into sight.
void FileDialog::scroll_to_typed() {
    if (!std::exchange(typed_anew_, false)) return;
    const std::optional<std::size_t> entry = entry_begun(entries_, typed_);
    if (!entry) return;
    const float row = px(*entry >= folders_ && pictures_ ? thumbnail_row_height : file_row_height);
    const std::size_t high = *entry > folders_ ? *entry - folders_ : 0;
    const float top = px(file_row_height) * static_cast<float>(*entry - high) +
                      px(pictures_ ? thumbnail_row_height : file_row_height) * static_cast<float>(high);
    const float seen = ImGui::GetScrollY(), room = ImGui::GetWindowHeight();
    if (top < seen) ImGui::SetScrollY(top);
    if (top + row > seen + room) ImGui::SetScrollY(top + row - room);
}

FileClick FileDialog::draw_entry(GuiFrame& frame, const FileEntry& entry) {
    FileRow row{entry.folder ? Icon::folder : Icon::file, entry.name, entry.name == typed_,
                time_text(entry.changed), entry.folder ? "" : size_text(entry.bytes)};
    row.high = !entry.folder && pictures_;
    row.picture = shows_picture(entry);
    if (row.picture) {
        const ListedPicture listed{folder_ / entry.name, entry.changed, entry.bytes};
        const auto seen = frame.status.thumbnails.find(listed);
        if (seen != frame.status.thumbnails.end()) row.thumbnail = &seen->second;
        frame.view.listed_pictures.push_back(listed);
    }
    const FileClick click = file_row(entry.name.c_str(), row);
    note_item(frame, "file/" + entry.name);
    return click;
}

// Only rows that are seen are drawn: a folder may hold every frame of a film.
bool FileDialog::draw_entries(GuiFrame& frame) {
    bool chosen = false;
    fs::path enter;
    // The first one went into the folder; what lies there now is not meant.
    const double pressed = ImGui::GetIO().MouseClickedTime[ImGuiMouseButton_Left];
    const bool is_rest_of_double_click =
        pressed > entered_ && pressed - entered_ < double{ImGui::GetIO().MouseDoubleClickTime};
    const auto draw_rows = [&](std::size_t begin, std::size_t end, float height) {
        ImGuiListClipper clipper;
        clipper.Begin(static_cast<int>(end - begin), px(height));
        while (clipper.Step())
            for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
                const FileEntry& entry = entries_[begin + static_cast<std::size_t>(i)];
                const FileClick click = draw_entry(frame, entry);
                if (is_rest_of_double_click) continue;
                if (entry.folder && click.once) enter = folder_ / entry.name;
                if (!entry.folder && click.once) {
                    typed_ = entry.name;
                    forget_questions();
                    replaces_ = false;
                }
                if (!entry.folder && click.twice) chosen = true;
            }
    };
    draw_rows(0, folders_, file_row_height);
    draw_rows(folders_, entries_.size(), pictures_ ? thumbnail_row_height : file_row_height);
    if (entries_.empty()) {
        ImGui::SetCursorPosX(px(12));
        row_text(contents_.is_open() ? "Reading the folder..."
                 : all_files_        ? "This folder is empty."
                                     : "No " + query_.kind + " here.",
                 px(file_row_height), color::dim);
    }
    if (!enter.empty()) {
        entered_ = pressed;
        go_to(enter);
    }
    return chosen;
}

void FileDialog::look() {
    if (typed_.empty()) return;
    const bool adds = query_.saving && !query_.extensions.empty();
    asked_at_ = seconds_now();
    target_.begin(
        [file = typed_path(typed_, folder_).lexically_normal(),
         ending = adds ? query_.extensions.front() : ""](const auto&) { return look_at(file, ending); });
}

std::optional<fs::path> FileDialog::accept(const TypedFile& typed) {
    const fs::path& file = typed.file;
    if (typed.is_folder) {
        retype("");
        go_to(file);
        return std::nullopt;
    }
    if (!query_.saving) {
        if (typed.exists) return file;
        complaint_ = "There is no file of this name.";
        return std::nullopt;
    }
    if (!typed.has_folder) {
        complaint_ = "There is no folder " + file.parent_path().string() + ".";
        return std::nullopt;
    }
    if (typed.exists && !replaces_) {
        complaint_ = file.filename().string() + " exists already.";
        replaces_ = true;
        return std::nullopt;
    }
    return file;
}

FileDialog::Answer FileDialog::draw_bottom(GuiFrame& frame, bool chosen) {
    ImGui::Dummy({0, px(4)});
    const float y = ImGui::GetCursorPosY();
    if (target_.is_open())
        row_text("Waiting for the disk...", px(28), color::dim);
    else if (!complaint_.empty())
        row_text(fitting(complaint_, px(400)), px(28), color::attention);
    else if (!query_.extensions.empty()) {
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(4), px(4)));
        if (ImGui::Checkbox("All files", &all_files_)) list_entries(folder_);
        ImGui::PopStyleVar();
        note_item(frame, "file/All files");
    }
    ImGui::SameLine();
    ImGui::SetCursorPosY(y);
    const char* does = replaces_ ? "Replace" : query_.saving ? "Save" : "Open";
    const int button = dialog_buttons(frame, "file", {"Cancel", does}, 0);
    if (button == 0) return {true, std::nullopt};
    if (button == 1 || chosen) {
        look();
        focus_path_ = target_.is_open();  // another name may be meant, should that take long
    }
    const std::optional<TypedFile> found = target_.take();
    const std::optional<fs::path> file = found ? accept(*found) : std::nullopt;
    return {file.has_value(), file};
}

FileDialog::Answer FileDialog::draw(GuiFrame& frame) {
    frame.view.listed_pictures.clear();
    if (open_) take_entries();
    if (!begin_dialog("file dialog", query_.title, open_, dialog_width, dialog_height)) return {};
    draw_path(frame);
    ImGui::Dummy({0, px(4)});
    const float list_height = ImGui::GetContentRegionAvail().y - px(44);
    ImGui::PushStyleColor(ImGuiCol_ChildBg, color4(color::window));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 0));
    constexpr ImGuiWindowFlags flat = ImGuiWindowFlags_NavFlattened;
    ImGui::BeginChild("places", {px(places_width), list_height}, false, flat);
    draw_places(frame);
    ImGui::EndChild();
    ImGui::SameLine(0, px(8));
    ImGui::BeginChild("files", {0, list_height}, false, flat);
    if (draw_file_columns(frame, rows_px_, order_, backwards_)) sort_entries(entries_, order_, backwards_);
    ImGui::BeginChild("entries", {0, 0}, false, flat);
    rows_px_ = ImGui::GetContentRegionAvail().x;
    scroll_to_typed();
    const bool chosen = draw_entries(frame);
    ImGui::EndChild();
    ImGui::EndChild();
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
    const Answer answer = draw_bottom(frame, chosen);
    if (answer.file) add_recent_folder(frame.view, answer.file->parent_path());
    if (answer.done) {
        open_ = false;
        forget_questions();
    }
    end_dialog(answer.done);
    return answer;
}

}  // namespace astrosplat

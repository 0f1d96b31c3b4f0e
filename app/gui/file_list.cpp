// Folders read and paths completed.
#include "gui/file_list.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <utility>

#include "core/file.h"
#include "core/text.h"

namespace astrosplat {
namespace fs = std::filesystem;
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

}  // namespace astrosplat

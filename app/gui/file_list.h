// The content of a file dialog, without widgets: entries of a folder, and the rest of a path whose
// beginning is typed.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
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
/// newer or larger comes first,
/// unless `backwards`.
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

}  // namespace astrosplat

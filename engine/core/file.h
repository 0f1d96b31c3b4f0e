// Files to read from, with the same one line for every reader when that cannot be. Only regular files: a pipe
// or a device may never end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"

namespace astrosplat {

/// An open file, closed by the destructor.
class InputFile {
  public:
    /// Throws InputError "FILE: cannot be read: REASON" (missing, a folder, no permission, no regular file).
    explicit InputFile(const std::filesystem::path& file);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    int descriptor() const { return descriptor_; }
    std::int64_t size() const { return size_; }  // bytes when it was opened
    /// The next bytes, at most `size` of them; 0 at the end. Throws InputError.
    std::size_t read(char* out, std::size_t size);

  private:
    std::filesystem::path file_;
    int descriptor_ = -1;
    std::int64_t size_ = 0;
};

/// Throws InputError like InputFile: for files that a library opens itself.
void require_readable(const std::filesystem::path& file);

/// All bytes of a file. Throws InputError as InputFile does, and when it is larger than the
/// memory left; Cancelled.
std::string read_file(const std::filesystem::path& file, const Progress& progress = {});

/// Entries of a folder, sorted by name; nothing where it cannot be read. (libstdc++'s own iterator ends the
/// program where memory runs out.)
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);

/// When and how large a file was, and which one has the name: replacing it by renaming another changes that
/// alone. All 0 where there is no file, or none that may be looked at.
struct FileStamp {
    std::int64_t seconds = 0, nanoseconds = 0;  // of its last change
    std::int64_t size = 0;                      // bytes
    std::uint64_t device = 0, inode = 0;
    bool operator==(const FileStamp&) const = default;
};
FileStamp stamp_of(const std::filesystem::path& file);

/// At most the first `size` bytes, such as a format's magic bytes; empty where the file cannot be read.
std::string read_beginning(const std::filesystem::path& file, std::size_t size);

}  // namespace astrosplat

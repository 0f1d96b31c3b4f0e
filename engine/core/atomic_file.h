// A file appears complete or not at all: it is written under a temporary name in the same folder, flushed to
// the disk and renamed. Used by everything that writes a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace astrosplat {

/// Owns one temporary file. Without commit() the destructor removes it and the old target stays as it was.
class AtomicFile {
  public:
    /// Creates an empty temporary file beside `target` (symbolic links are followed). Throws OutputError when
    /// the folder cannot be written or the target exists and is no regular file.
    explicit AtomicFile(const std::filesystem::path& target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// The temporary name, with the target's ending: for libraries that open files themselves. They may
    /// truncate it.
    const std::filesystem::path& temporary() const { return temporary_; }

    /// Appends bytes. Throws OutputError (disk full). Not to be mixed with a library's writing.
    void write(const void* bytes, std::size_t size);
    void write(std::string_view text) { write(text.data(), text.size()); }

    /// Flushes to the disk and renames to the target. Throws OutputError, and then the target is untouched.
    void commit();

  private:
    std::filesystem::path target_;     // what messages name
    std::filesystem::path resolved_;   // behind symbolic links
    std::filesystem::path temporary_;  // empty once committed
    int descriptor_ = -1;
    std::int64_t written_ = 0, handed_over_ = 0;  // bytes of write(); of them on their way to the disk
};

/// The whole of `text` as file `target`, by the above.
void write_file_atomically(const std::filesystem::path& target, std::string_view text);

}  // namespace astrosplat

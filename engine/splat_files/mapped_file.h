// A file's bytes as read-only memory. In: a path. Out: a string_view of the bytes while a reader works on
// them. The kernel pages the file in as it is touched, so nothing is copied. Where another program shortens
// the file meanwhile, the missing pages read as zeros instead of ending the process, and the reader fails.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/error.h"
#include "core/file.h"

namespace astrosplat {

class MappedFile {
  public:
    /// Throws InputError when the file is missing, unreadable or not a regular file.
    explicit MappedFile(const std::filesystem::path& file);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::string_view bytes() const { return {memory_, size_}; }
    /// Throws InputError when the file has become shorter since it was opened: its bytes are not to be
    /// trusted.
    void require_whole() const;

  private:
    std::filesystem::path file_;
    InputFile input_;
    const char* memory_ = nullptr;
    std::size_t size_ = 0;
    std::size_t guard_ = 0;  // place in the table of mappings that the signal handler knows
};

/// For a reader that is done with some bytes of a mapped file: their pages no longer count as this program's
/// memory. Elsewhere it does nothing. From any thread.
void forget_pages(std::string_view bytes);

/// The result of read(bytes) for the file's bytes. Throws InputError, in words about the file's length where
/// that changed meanwhile, whatever the reader made of it.
template <class Read>
auto read_mapped(const std::filesystem::path& file, const Read& read) {
    const MappedFile mapped(file);
    try {
        auto result = read(mapped.bytes());
        mapped.require_whole();
        return result;
    } catch (const InputError&) {
        mapped.require_whole();
        throw;
    }
}

}  // namespace astrosplat

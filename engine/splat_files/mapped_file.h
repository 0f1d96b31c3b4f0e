// A file's bytes as read-only memory. In: a path. Out: one string_view that lives as long as the object. The
// kernel pages the file in as it is touched, so nothing is copied. A file that another program shortens
// meanwhile ends the process with SIGBUS, as everywhere with mmap; our own writers replace files by renaming
// and never do that.
#pragma once

#include <filesystem>
#include <string_view>

namespace astrosplat {

class MappedFile {
  public:
    /// Throws InputError when the file is missing, unreadable or not a regular file.
    explicit MappedFile(const std::filesystem::path& file);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::string_view bytes() const { return {static_cast<const char*>(memory_), size_}; }

  private:
    void* memory_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace astrosplat

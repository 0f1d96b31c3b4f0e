// The bytes of large files. Read: as read-only memory that the kernel pages in as it is touched, so nothing
// is copied; where another program shortens the file meanwhile, the missing pages read as zeros instead of
// ending the process, and the reader fails. Written: rows that are formatted in parallel and come out in
// order: threads format chunks of rows into memory of a few chunks, and one of them at a time appends what is
// complete, so that the bytes do not depend on threads.
#pragma once

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/progress.h"

namespace astrosplat {

class MappedFile {
  public:
    /// Throws InputError when the file is missing, unreadable or not a regular file.
    explicit MappedFile(const fs::path& file);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::string_view bytes() const { return {memory_, size_}; }
    /// Throws InputError when the file has become shorter since it was opened: its bytes are not
    /// to be trusted.
    void require_whole() const;

  private:
    fs::path file_;
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
auto read_mapped(const fs::path& file, const Read& read) {
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

/// Writes rows [begin, end) to `out` and returns the end of what it wrote.
using FormatRows = std::function<char*(std::int64_t begin, std::int64_t end, char* out)>;
/// Text behind the rows; asked for once all of them are formatted.
using Footer = std::function<std::string()>;

/// `header`, then `count` rows in chunks of `chunk`, each row at most `row_bytes` long. Atomic: the file
/// appears whole or not at all. Throws OutputError, Cancelled.
void write_ordered(const WriteTarget& target, std::string_view header, std::int64_t count, std::int64_t chunk,
                   std::size_t row_bytes, const Progress& progress, const FormatRows& format,
                   const Footer& footer = {});

/// The same row by row: put_row(out, row) writes one to `out` and returns the end of what it wrote.
template <class PutRow>
void write_rows(const WriteTarget& target, std::string_view header, std::int64_t count, std::int64_t chunk,
                std::size_t row_bytes, const Progress& progress, const PutRow& put_row,
                const Footer& footer = {}) {
    const auto format = [&](std::int64_t begin, std::int64_t end, char* out) {
        for (std::int64_t row = begin; row < end; ++row) out = put_row(out, row);
        return out;
    };
    write_ordered(target, header, count, chunk, row_bytes, progress, format, footer);
}

}  // namespace astrosplat

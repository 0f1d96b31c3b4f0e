// Files that appear complete or not at all: written under a temporary name in the same folder, flushed to the
// disk and renamed; used by everything that writes a file. Files left by killed programs are removed by the
// next one that writes into the same folder. Also locks that processes share through files.
#pragma once

#include <exception>

#include "core/error.h"

namespace astrosplat {

/// The choice of commit() where a file has the target's name.
enum class Existing { replace, keep };

/// Something has the target's name, and stays as it is.
struct AlreadyExists : OutputError {
    using OutputError::OutputError;
};

/// Where a file goes.
struct WriteTarget {
    /// A path alone is a file that may be replaced.
    WriteTarget(fs::path path, Existing when_there = Existing::replace)
        : file(std::move(path)), existing(when_there) {}

    fs::path file;
    Existing existing;  // keep: AlreadyExists is thrown, also where it came while we wrote
};

/// Owns one temporary file. Without commit() the destructor removes it and the old target stays as it was.
class AtomicFile {
  public:
    /// Creates an empty temporary file beside `target` (symbolic links are followed). Throws OutputError when
    /// the folder cannot be written or the target exists and is no regular file.
    explicit AtomicFile(const fs::path& target, Existing existing = Existing::replace);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const fs::path& target() const { return target_; }
    const fs::path& temporary() const { return temporary_; }
    /// Bytes from the start to the last one written.
    std::int64_t size() const { return size_; }

    /// Appends bytes. Throws OutputError (disk full).
    void write(const void* bytes, std::size_t size) { write_at(size_, bytes, size); }
    void write(std::string_view text) { write(text.data(), text.size()); }
    /// The same at `offset` bytes from the start.
    void write_at(std::int64_t offset, const void* bytes, std::size_t size);

    /// Flushes to the disk and renames to the target. Throws OutputError (AlreadyExists under
    /// Existing::keep), and then the target is untouched.
    void commit();

  private:
    bool create_temporary();

    fs::path target_;     // what messages name
    fs::path resolved_;   // behind symbolic links
    fs::path temporary_;  // empty once committed
    Existing existing_;
    int descriptor_ = -1;                      // locked, which tells others that the file is in use
    std::int64_t size_ = 0, handed_over_ = 0;  // bytes; of them on their way to the disk
};

/// The whole of `text` as file `target`, by the above.
void write_file_atomically(const fs::path& target, std::string_view text,
                           Existing existing = Existing::replace);

/// Throws AlreadyExists when anything has this name.
void refuse_existing(const fs::path& target);

/// Throws OutputError when something lies at `target` that is no regular file (symbolic links are followed):
/// no file can be written there.
void refuse_other_than_file(const fs::path& target);

/// An AtomicFile behind the code of a library that exceptions must not pass, or that swallows them: a write
/// that fails is remembered, and thrown where the library has returned.
class GuardedFile {
  public:
    explicit GuardedFile(AtomicFile& file) : file_(file) {}

    /// False where this write or one before it failed.
    bool write_at(std::int64_t offset, const void* bytes, std::size_t size) noexcept {
        if (failure_) return false;
        try {
            file_.write_at(offset, bytes, size);
        } catch (...) {
            failure_ = std::current_exception();
        }
        return !failure_;
    }
    bool failed() const { return failure_ != nullptr; }
    /// The write that failed first, an OutputError.
    void rethrow_failure() const {
        if (failure_) std::rethrow_exception(failure_);
    }
    std::int64_t size() const { return file_.size(); }
    const fs::path& target() const { return file_.target(); }

  private:
    AtomicFile& file_;
    std::exception_ptr failure_;
};

/// A lock that processes share through a file: whoever holds it may do what only one should do at a time. The
/// kernel gives it back when a process ends, however it ends.
///
/// Owns the lock once try_lock() said `held`; the destructor gives it back and removes the file. flock(2):
/// two objects exclude each other in one process, too.
class FileLock {
  public:
    enum class State {
        held,
        busy,     // another process has it
        absent,   // there is no such file, and none was to be made: no process has it
        refused,  // the folder cannot be written, or the file system knows no locks
    };
    enum class Missing { create, leave };

    explicit FileLock(fs::path file) : file_(std::move(file)) {}
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

    /// Never waits. Not to be called again once it is held.
    State try_lock(Missing missing = Missing::create);

  private:
    fs::path file_;
    int descriptor_ = -1;  // open while the lock is held
};

}  // namespace astrosplat

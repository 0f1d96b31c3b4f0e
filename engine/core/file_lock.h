// A lock that processes share through a file: whoever holds it may do what only one should do at a time. The
// kernel gives it back when a process ends, however it ends.
#pragma once

#include <filesystem>

namespace astrosplat {

/// Owns the lock once try_lock() said `held`; the destructor gives it back and removes the file. flock(2):
/// two objects exclude each other in one process, too.
class FileLock {
  public:
    enum class State {
        held,
        busy,     // another process has it
        absent,   // there is no such file, and none was to be made: nobody has it
        refused,  // the folder cannot be written, or the file system knows no locks
    };
    enum class Missing { create, leave };

    explicit FileLock(std::filesystem::path file) : file_(std::move(file)) {}
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

    /// Never waits. Not to be called again once it is held.
    State try_lock(Missing missing = Missing::create);

  private:
    std::filesystem::path file_;
    int descriptor_ = -1;  // open while the lock is held
};

}  // namespace astrosplat

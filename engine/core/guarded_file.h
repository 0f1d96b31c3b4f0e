// An AtomicFile behind the code of a library that exceptions must not pass, or that swallows them: a write
// that fails is remembered, and thrown where the library has returned.
#pragma once

#include <exception>

#include "core/atomic_file.h"

namespace astrosplat {

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
    const std::filesystem::path& target() const { return file_.target(); }

  private:
    AtomicFile& file_;
    std::exception_ptr failure_;
};

}  // namespace astrosplat

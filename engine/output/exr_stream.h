// What OpenEXR writes, collected into large pieces: it writes a frame as hundreds of small ones, and comes
// back to the table in front of them. In: an AtomicFile. Included by the writers of EXR alone.
#pragma once

#include <ImfIO.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/atomic_file.h"

namespace astrosplat {

class ExrStream : public Imf::OStream {
  public:
    explicit ExrStream(AtomicFile& file);

    void write(const char bytes[], int size) override;
    std::uint64_t tellp() override { return begin_ + piece_.size(); }
    void seekp(std::uint64_t position) override;

    /// Writes what is collected. Throws the first OutputError of all writes, of which some may have been made
    /// where nothing can be thrown.
    void flush();

  private:
    GuardedFile file_;
    std::vector<char> piece_;
    std::uint64_t begin_ = 0;  // of the piece in the file
};

}  // namespace astrosplat

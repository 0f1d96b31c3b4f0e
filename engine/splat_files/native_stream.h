// A native file (native.h) written in parts, for sets that are never in memory as a whole. In: what is known
// of the set, how many splats it has, and their rows part by part, in the order of the file. Out: the file
// that write_native makes of the whole.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "splat_files/write_target.h"
#include "splats/splat_set.h"

namespace astrosplat {

class NativeStream {
  public:
    /// A file of `splats` rows in the order of space, with the columns that `holds` names. Throws
    /// OutputError.
    NativeStream(const WriteTarget& target, const SplatSetFacts& facts, bool (*holds)(SplatColumn),
                 std::int64_t splats);
    ~NativeStream();

    /// Those rows of a part, which has the columns. Throws OutputError.
    void append(const SplatSet& part, std::span<const std::uint32_t> rows);

    /// All rows are there: the file appears. Throws OutputError.
    void finish();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat

// Native files (native.h) in parts, for sets that are never in memory as a whole. Reading: the facts of the
// set, and the rows of the blocks that are asked for; bytes are read, not mapped, so that they count as this
// program's memory only while it has them. Writing: rows part by part, in the order of the file; the file is
// the one that write_native makes of the whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "core/atomic_file.h"
#include "core/bounds.h"
#include "splat_files/native.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// A file, of which blocks are read.
class NativeBlocks {
  public:
    /// Checks header and table. Throws InputError as read_native does.
    explicit NativeBlocks(const std::filesystem::path& file, NativePart part = NativePart::whole);
    ~NativeBlocks();

    const SplatSetFacts& facts() const;
    std::size_t size() const;             // blocks
    std::int64_t splats() const;          // of the whole set
    std::int64_t bytes() const;           // that the set takes in memory, with all columns
    std::int64_t most_rows() const;       // of a block
    bool has(SplatColumn column) const;   // whether the file holds it
    Bounds box(std::size_t block) const;  // of its positions, as the file says

    enum class Check { all, none };
    /// Sets the columns of `out` that are there and wanted to the block's rows; the others become empty. With
    /// Check::all also what read_native checks. From any thread, several at a time. Throws InputError.
    void read(std::size_t block, const OptionalColumns& wanted, Check check, SplatSet& out) const;

    /// About so many rows, evenly spread over the file, with all columns that are there. All of them where
    /// there are no more. Of checks only whether numbers are finite. Throws InputError.
    SplatSet sample(std::int64_t rows_wanted) const;

  private:
    struct State;
    std::unique_ptr<const State> state_;
};

/// A file while it is written.
class NativeStream {
  public:
    /// A file of `splats` rows in the order of space, with the columns `held`. Throws OutputError.
    NativeStream(const WriteTarget& target, const SplatSetFacts& facts, const SplatColumns& held,
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

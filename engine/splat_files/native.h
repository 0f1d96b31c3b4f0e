// The program's own splat files (.splats): everything a SplatSet holds, bit for bit. In and out: SplatSet, or
// some of its rows, for a cache that keeps more than is to be seen. Memory mapped, checked by block, and in
// an order that keeps neighbours together.
#pragma once

#include "core/atomic_file.h"
#include "core/bounds.h"
#include "core/buffer.h"
#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

// Format version 1, all little-endian, checksums XXH64 (core/hash.h):
//   header   0  8 bytes  89 'S' 'P' 'L' 'A' 'T' 0d 0a
//            8  u32      version, 1
//           12  u32      flags: 1 generated, 2 divided, 4 uv, 8 normal, 16 mesh, 32 radius are present,
//                    64 the rows are in ascending order of id,
//                    128 a recipe is present, 256 splats of colours below 0 absorb, 512 faces are present,
//                    1024 colour and alpha are not there, 2048 nothing but colour and alpha is there,
//                    4096 scale, 8192 rotation, 16384 harmonics are present, 32768 these give display values
//           16  u64      splats
//           24  u32      splats in a block (the last block may hold fewer)
//           28  u32      bytes of the credit, and of a zero and the recipe where that is present
//           32  3 f64    spacing             56  f64  max_distance
//           64  i64      test positions
//           72  i64      positions dropped for zero alpha; of colours those that are 0
//           80           credit (UTF-8), 0, recipe, zeros up to 8 bytes before a multiple of 64,
//                        u64 checksum of all before it
//   blocks  one after the other, in each: position 3 f32, colour 3 f32, alpha f32, distance f32, id u64,
//           and where present uv 2 f32, normal 3 f32, mesh u32, radius f32, face u32, scale 3 f32,
//           rotation 4 f32, harmonics 48 f32 (16 of red, green, blue), every array whole before the next
//   table   for each block: lowest and highest x y z of its positions (6 f32; 0 without positions),
//           u64 checksum of its bytes; then u64 checksum of the table

/// space: neighbours share blocks (splats/row_order.h), for files that travel. id: as the set has them, so
/// that nothing is sorted when it is read again.
enum class RowOrder { space, id };

/// The part of a set that a file holds. Sets travel whole; a cache keeps geometry, which is all but colour
/// and alpha, and these two in files of their own.
enum class NativePart { whole, geometry, colors };

/// Rows come back in the file's order; sort_by_id brings back that of the ids. Every length is checked before
/// memory is taken or touched, every block against its checksum. Throws InputError, also where the file holds
/// another part of a set. Columns that are not wanted stay empty.
SplatSet read_native(const fs::path& file, const Progress& progress = {}, const OptionalColumns& wanted = {},
                     NativePart part = NativePart::whole);

/// How many splats a file holds, from its header; of colours those whose alpha is not 0. Throws InputError.
std::int64_t native_splat_count(const fs::path& file);

/// The same bytes for any thread count. For RowOrder::id the set must be in ascending order of id.
/// Throws OutputError.
void write_native(const WriteTarget& target, const SplatSet& set, const Progress& progress = {},
                  RowOrder order = RowOrder::space, NativePart part = NativePart::whole);

/// Length of the file that write_native makes of a set.
std::int64_t native_file_bytes(const SplatSet& set, NativePart part = NativePart::whole);

/// The columns that a file holds.
SplatColumns native_columns(const fs::path& file);

/// Some rows of a file, ascending, and the columns of them that are wanted.
struct NativeRows {
    std::span<const std::int64_t> rows;
    OptionalColumns wanted;
};

/// Several choices of rows of one file, which is read and checked once, as by read_native().
std::vector<SplatSet> read_native_rows(const fs::path& file, NativePart part,
                                       std::span<const NativeRows> choices, const Progress& progress = {});

/// The rows of a file of colours whose alpha is not 0, and how many rows it has. Its blocks are not checked.
/// Throws InputError.
struct LitRows {
    Buffer<std::int64_t> rows;
    std::int64_t of = 0;
};
LitRows native_lit_rows(const fs::path& file, const Progress& progress = {});

// In parts, for sets that are never in memory as a whole. Reading: the facts of the set, and the rows of the
// blocks that are asked for; bytes are read, not mapped, so that they count as this program's memory only
// while it has them. Writing: rows part by part, in the order of the file; the file is the one that
// write_native makes of the whole.

/// A file, of which blocks are read.
class NativeBlocks {
  public:
    /// Checks header and table. Throws InputError as read_native does.
    explicit NativeBlocks(const fs::path& file, NativePart part = NativePart::whole);
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

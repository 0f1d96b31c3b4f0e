// One block of the file at a time: every column has its place in the block as if it was full, rows are put
// there as they come, and a full block goes to the file.
#include "splat_files/native_stream.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <vector>

#include "core/atomic_file.h"
#include "core/parallel.h"
#include "splat_files/native_bytes.h"
#include "splats/row_order.h"

namespace astrosplat {

struct NativeStream::State {
    AtomicFile file;
    std::uint32_t flags;
    std::int64_t splats, written = 0;
    std::vector<native::BlockEntry> table;
    Buffer<char> block;
    std::size_t filled = 0;  // rows of the block

    State(const WriteTarget& target, std::uint32_t file_flags, std::int64_t count)
        : file(target.file, target.existing),
          flags(file_flags),
          splats(count),
          block(native::splats_per_block * native::row_bytes(file_flags)) {
        table.reserve(native::block_count(static_cast<std::uint64_t>(count), native::splats_per_block));
    }

    /// Calls visit(column, place in a block of so many rows) for every column of the file.
    template <class Visit>
    void for_each_place(std::size_t block_rows, Visit visit) {
        std::size_t place = 0;
        for_each_column([&]<class T>(Buffer<T> SplatSet::*column, SplatColumn which) {
            if (!native::has(flags, which)) return;
            visit(column, place);
            place += block_rows * sizeof(T);
        });
    }

    void put(const SplatSet& part, std::span<const std::uint32_t> rows) {
        constexpr std::int64_t rows_at_once = 4096;
        parallel_chunks(static_cast<std::int64_t>(rows.size()), rows_at_once,
                        [&](std::int64_t begin, std::int64_t end, int) {
                            const auto some = rows.subspan(static_cast<std::size_t>(begin),
                                                           static_cast<std::size_t>(end - begin));
                            const std::size_t first = filled + static_cast<std::size_t>(begin);
                            for_each_place(native::splats_per_block, [&]<class T>(Buffer<T> SplatSet::*column,
                                                                                  std::size_t place) {
                                gather((part.*column).data(), some, block.data() + place + first * sizeof(T));
                            });
                        });
        filled += rows.size();
    }

    void write_block() {
        if (filled < native::splats_per_block) close_gaps();
        const std::string_view bytes(block.data(), filled * native::row_bytes(flags));
        table.push_back(native::describe_block(flags, bytes, filled));
        file.write(bytes);
        written += static_cast<std::int64_t>(filled);
        filled = 0;
    }

    /// The last block has fewer rows than its columns have room for.
    void close_gaps() {
        std::size_t to = 0;
        for_each_place(native::splats_per_block, [&]<class T>(Buffer<T> SplatSet::*, std::size_t place) {
            std::memmove(block.data() + to, block.data() + place, filled * sizeof(T));
            to += filled * sizeof(T);
        });
    }
};

NativeStream::NativeStream(const WriteTarget& target, const SplatSetFacts& facts, bool (*holds)(SplatColumn),
                           std::int64_t splats)
    : state_(std::make_unique<State>(
          target, native::flags_of(facts, holds, RowOrder::space, NativePart::whole), splats)) {
    state_->file.write(native::header_bytes(facts, state_->flags, splats));
}
NativeStream::~NativeStream() = default;

void NativeStream::append(const SplatSet& part, std::span<const std::uint32_t> rows) {
    while (!rows.empty()) {
        const std::size_t count = std::min(rows.size(), native::splats_per_block - state_->filled);
        state_->put(part, rows.first(count));
        if (state_->filled == native::splats_per_block) state_->write_block();
        rows = rows.subspan(count);
    }
}

void NativeStream::finish() {
    if (state_->filled > 0) state_->write_block();
    assert(state_->written == state_->splats);
    state_->file.write(native::table_bytes(state_->table));
    state_->file.commit();
}

}  // namespace astrosplat

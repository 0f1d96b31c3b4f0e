// Reading: columns one by one straight into the set's arrays, so that unwanted ones are not read at all.
// Writing: one block at a time; every column has its place in the block as if it was full, rows are put there
// as they come, and a full block goes to the file.
#include "splat_files/native.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cfloat>
#include <cstring>

#include "core/file.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "splat_files/file_bytes.h"
#include "splat_files/native_layout.h"
#include "splats/row_order.h"

namespace astrosplat {

struct NativeBlocks::State {
    fs::path path;
    native::Layout layout;  // without the blocks' bytes
    SplatSetFacts facts;
    InputFile file;

    State(const fs::path& of, NativePart part)
        : path(of),
          layout(read_mapped(
              of, [&](std::string_view bytes) { return native::read_layout({of.string()}, bytes, part); })),
          facts(native::facts_of(layout)),
          file(of) {
        layout.blocks = {};
    }

    std::size_t rows(std::size_t block) const {
        const std::size_t first = block * layout.header.block;
        return std::min<std::size_t>(layout.header.block, layout.header.splats - first);
    }
    std::size_t offset(std::size_t block) const {
        return native::data_offset(layout.header.credit_bytes) +
               block * layout.header.block * native::row_bytes(layout.header.flags);
    }

    void read_at(std::size_t offset, char* out, std::size_t bytes) const {
        while (bytes > 0) {
            const ssize_t got = ::pread(file.descriptor(), out, bytes, static_cast<off_t>(offset));
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0)
                throw InputError(
                    fmt::format("{}: cannot be read: {}", path.string(),
                                got < 0 ? std::strerror(errno) : "it became shorter while it was read"));
            offset += std::size_t(got);
            out += got;
            bytes -= std::size_t(got);
        }
    }
};

NativeBlocks::NativeBlocks(const fs::path& file, NativePart part)
    : state_(std::make_unique<State>(file, part)) {}
NativeBlocks::~NativeBlocks() = default;

const SplatSetFacts& NativeBlocks::facts() const { return state_->facts; }
std::size_t NativeBlocks::size() const { return state_->layout.table.size(); }
std::int64_t NativeBlocks::splats() const { return std::int64_t(state_->layout.header.splats); }
std::int64_t NativeBlocks::bytes() const {
    return splats() * std::int64_t(native::row_bytes(state_->layout.header.flags));
}
std::int64_t NativeBlocks::most_rows() const { return state_->layout.header.block; }
bool NativeBlocks::has(SplatColumn column) const { return native::has(state_->layout.header.flags, column); }

Bounds NativeBlocks::box(std::size_t block) const {
    const native::BlockEntry& entry = state_->layout.table[block];
    return {glm::dvec3(entry.lo), glm::dvec3(entry.hi)};
}

// Through a mapping: of so many small reads the calls would take longer than all else.
SplatSet NativeBlocks::sample(std::int64_t rows_wanted) const {
    // Neighbours are alike: of longer runs a sample says less. Of single rows it takes longer to read.
    constexpr std::int64_t at_once = 4;
    const State& state = *state_;
    SplatSet out;
    static_cast<SplatSetFacts&>(out) = state.facts;
    const std::int64_t all = (splats() + at_once - 1) / at_once;
    const std::int64_t places = std::min((rows_wanted + at_once - 1) / at_once, all);
    const double stride = places == all ? double(at_once) : double(splats()) / double(places);
    return read_mapped(state.path, [&](std::string_view bytes) {
        if (std::int64_t(bytes.size()) != state.file.size())
            throw InputError(
                fmt::format("{}: cannot be read: it was changed while it was read", state.path.string()));
        std::size_t in_memory = 0;  // block
        for (std::int64_t n = 0; n < places; ++n) {
            const auto row = std::size_t(double(n) * stride);
            const std::size_t block = row / state.layout.header.block,
                              first = row % state.layout.header.block;
            if (const std::size_t before = std::exchange(in_memory, block); before != block)
                forget_pages(bytes.substr(state.offset(before), state.offset(block) - state.offset(before)));
            const std::size_t rows = state.rows(block), count = std::min<std::size_t>(at_once, rows - first);
            std::size_t offset = state.offset(block);
            for_each_column([&](auto column, SplatColumn which) {
                if (!has(which)) return;
                auto& array = out.*column;
                const std::size_t size = sizeof array[0], end = array.size();
                array.resize(end + count);
                std::memcpy(array.data() + end, bytes.data() + offset + first * size, count * size);
                offset += rows * size;
            });
        }
        bool finite = true;
        for_each_column([&](auto column, SplatColumn) {
            finite &= native::all_finite((out.*column).data(), (out.*column).size());
        });
        if (!finite)
            throw InputError(
                fmt::format("{}: expected finite numbers, found infinity or NaN", state.path.string()));
        return std::move(out);
    });
}

void NativeBlocks::read(std::size_t block, const OptionalColumns& wanted, Check check, SplatSet& out) const {
    const State& state = *state_;
    const native::Checker checker{state.path.string()};
    const std::size_t rows = state.rows(block);
    std::size_t offset = state.offset(block);
    RunningChecksum checksum;
    bool finite = true;
    for_each_column([&](auto column, SplatColumn which) {
        auto& array = out.*column;
        array.clear();
        if (!has(which)) return;
        array.resize(rows);
        const std::size_t bytes = rows * sizeof array[0];
        const bool used = is_wanted(which, wanted);
        if (used || check == Check::all) state.read_at(offset, reinterpret_cast<char*>(array.data()), bytes);
        offset += bytes;
        if (check == Check::all) {
            checksum.add({reinterpret_cast<const char*>(array.data()), bytes});
            if (used) finite &= native::all_finite(array.data(), array.size());
        }
        if (!used) array.clear();
    });
    if (check == Check::none) return;
    native::BlockEntry found{glm::vec3(FLT_MAX), glm::vec3(-FLT_MAX), checksum.value()};
    native::add_to_box(out.position, found);
    checker.block(block, state.layout.table[block], found, [&] { return finite; });
}

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
        table.reserve(native::block_count(std::uint64_t(count), native::splats_per_block));
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
        parallel_chunks(
            std::int64_t(rows.size()), rows_at_once, [&](std::int64_t begin, std::int64_t end, int) {
                const auto some = rows.subspan(std::size_t(begin), std::size_t(end - begin));
                const std::size_t first = filled + std::size_t(begin);
                for_each_place(
                    native::splats_per_block, [&]<class T>(Buffer<T> SplatSet::*column, std::size_t place) {
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
        written += std::int64_t(filled);
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

NativeStream::NativeStream(const WriteTarget& target, const SplatSetFacts& facts, const SplatColumns& held,
                           std::int64_t splats)
    : state_(std::make_unique<State>(
          target, native::flags_of(facts, held, RowOrder::space, NativePart::whole), splats)) {
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

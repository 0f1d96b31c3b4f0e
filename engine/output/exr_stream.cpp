#include "output/exr_stream.h"

namespace astrosplat {
namespace {

constexpr std::size_t piece_bytes = std::size_t{4} << 20;

}  // namespace

ExrStream::ExrStream(AtomicFile& file) : OStream(file.target().c_str()), file_(file) {
    piece_.reserve(piece_bytes);
}

void ExrStream::write(const char bytes[], int size) {
    const auto count = static_cast<std::size_t>(size);
    if (piece_.size() + count > piece_bytes) flush();
    piece_.insert(piece_.end(), bytes, bytes + count);
}

void ExrStream::seekp(std::uint64_t position) {
    if (position == tellp()) return;
    flush();
    begin_ = position;
}

void ExrStream::flush() {
    file_.write_at(static_cast<std::int64_t>(begin_), piece_.data(), piece_.size());
    file_.rethrow_failure();  // which OpenEXR swallows where it ends a file
    begin_ += piece_.size();
    piece_.clear();
}

}  // namespace astrosplat

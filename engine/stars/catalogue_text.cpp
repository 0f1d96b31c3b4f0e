#include "stars/catalogue_text.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/memory.h"

namespace astrosplat {
namespace {

constexpr std::size_t block_bytes = std::size_t{1} << 22;
constexpr int any_gzip = 15 + 16;  // zlib: the largest window, and gzip's own header

// A gzip file may be several of them one after the other.
class Inflater {
  public:
    Inflater(std::string_view packed, std::string name) : name_(std::move(name)) {
        stream_.next_in =
            reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // which zlib only reads
        left_ = packed.size();
    }

    /// Adds the next block to `text`; false at the end. Throws InputError.
    bool add_block(std::string& text) {
        if (done_) return false;
        feed();
        const std::size_t have = text.size();
        text.resize(have + block_bytes);
        stream_.next_out = reinterpret_cast<Bytef*>(text.data() + have);
        stream_.avail_out = static_cast<uInt>(block_bytes);
        while (!done_ && stream_.avail_out > 0) step();
        text.resize(text.size() - stream_.avail_out);
        return true;
    }

  private:
    void feed() {
        if (stream_.avail_in > 0) return;
        stream_.avail_in = static_cast<uInt>(std::min<std::size_t>(left_, 1u << 30));
        left_ -= stream_.avail_in;
    }

    void step() {
        if (!open_) {
            if (inflateInit2(&stream_, any_gzip) != Z_OK) throw std::bad_alloc();
            open_.reset(&stream_);
        }
        feed();
        const int result = inflate(&stream_, Z_NO_FLUSH);
        if (result == Z_STREAM_END) {
            open_.reset();
            feed();
            const bool more = stream_.avail_in >= 2 && stream_.next_in[0] == 0x1f;
            done_ = !more;
        } else if (result != Z_OK) {
            bad_input(name_, "", "a whole gzip file", "damaged data");
        }
    }

    std::string name_;
    z_stream stream_{};
    std::unique_ptr<z_stream, int (*)(z_stream*)> open_{nullptr, inflateEnd};
    std::size_t left_ = 0;
    bool done_ = false;
};

}  // namespace

std::string read_catalogue_text(const std::filesystem::path& file, const Progress& progress) {
    const std::string bytes = read_file(file, progress);
    if (!bytes.starts_with("\x1f\x8b")) return bytes;
    std::string text;
    for (Inflater inflater(bytes, file.string()); inflater.add_block(text);) {
        progress.check();
        claim_memory(static_cast<std::int64_t>(text.size()), fmt::format("reading {}", file.string()));
    }
    return text;
}

}  // namespace astrosplat

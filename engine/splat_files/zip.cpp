// By the directory at the archive's end (PKWARE's APPNOTE.TXT); what is not in it is not there.
#include "splat_files/zip.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/memory.h"
#include "core/text.h"
#include "splat_files/packed_gaussians.h"

namespace astrosplat {
namespace {

struct ZipEntry {
    std::uint16_t method = 0;
    std::size_t packed = 0, size = 0, header_at = 0;
};

/// The place of `size` bytes at `at`.
const char* zip_bytes_at(const fs::path& file, std::string_view bytes, std::size_t at, std::size_t size) {
    if (at > bytes.size() || size > bytes.size() - at)
        bad_input(file, "ZIP", fmt::format("{} bytes at byte {}", size, at), "the end of the file");
    return bytes.data() + at;
}

ZipEntry zip_entry(const fs::path& file, std::string_view bytes, std::string_view name) {
    constexpr std::size_t end_bytes = 22, longest_comment = 0xffff, entry_bytes = 46;
    const std::size_t tail = std::min(bytes.size(), end_bytes + longest_comment);
    const std::size_t found = bytes.substr(bytes.size() - tail).rfind("PK\5\6");
    if (found == std::string_view::npos || tail - found < end_bytes)
        bad_input(file, "ZIP", "a directory at its end", "none");
    const char* const end = bytes.data() + bytes.size() - tail + found;
    std::size_t at = number_at<std::uint32_t>(end + 16);
    for (int left = number_at<std::uint16_t>(end + 10); left > 0; --left) {
        const char* const p = zip_bytes_at(file, bytes, at, entry_bytes);
        const std::size_t length = number_at<std::uint16_t>(p + 28);
        const std::string_view own(zip_bytes_at(file, bytes, at + entry_bytes, length), length);
        if (own == name)
            return {number_at<std::uint16_t>(p + 10), number_at<std::uint32_t>(p + 20),
                    number_at<std::uint32_t>(p + 24), number_at<std::uint32_t>(p + 42)};
        at += entry_bytes + length + number_at<std::uint16_t>(p + 30) + number_at<std::uint16_t>(p + 32);
    }
    bad_input(file, "ZIP", fmt::format("a file '{}'", printable(name)), "none");
}

}  // namespace

Buffer<char> zipped_file(const fs::path& file, std::string_view bytes, std::string_view name) {
    constexpr std::size_t local_bytes = 30, most_from_a_byte = 1032;  // the most that deflate packs
    constexpr int raw_deflate = -15;
    const ZipEntry entry = zip_entry(file, bytes, name);
    const char* const local = zip_bytes_at(file, bytes, entry.header_at, local_bytes);
    const std::size_t at = entry.header_at + local_bytes + number_at<std::uint16_t>(local + 26) +
                           number_at<std::uint16_t>(local + 28);
    const std::string_view packed(zip_bytes_at(file, bytes, at, entry.packed), entry.packed);
    if (entry.method == 0) return {packed.begin(), packed.end()};
    if (entry.method != 8 || entry.size > packed.size() * most_from_a_byte)
        bad_input(file, printable(name), "a stored or deflated file",
                  fmt::format("method {}, {} bytes in {}", entry.method, entry.size, packed.size()));
    claim_memory(std::int64_t(entry.size), "reading " + file.string());
    Buffer<char> out(entry.size);
    const std::size_t written = inflate_to(packed, out, raw_deflate);
    if (written != out.size())
        bad_input(file, printable(name), fmt::format("{} bytes", out.size()), std::to_string(written));
    return out;
}

}  // namespace astrosplat

// Reads a file in one go, with the messages every reader needs.
#include "core/file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "core/error.h"
#include "core/memory.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const char* reason) {
    throw InputError(fmt::format("{}: cannot be read: {}", file.string(), reason));
}

}  // namespace

std::string read_file(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (fs::is_directory(status)) fail(file, "it is a folder");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"), &std::fclose);
    if (!in) fail(file, std::strerror(errno));
    std::string text;
    if (fs::is_regular_file(status)) {  // pipes have no size
        const std::uintmax_t size = fs::file_size(file, error);
        if (!error) {
            claim_memory(static_cast<std::int64_t>(size), fmt::format("reading {}", file.string()));
            text.reserve(static_cast<std::size_t>(size));
        }
    }
    char block[65536];
    for (std::size_t got = 0; (got = std::fread(block, 1, sizeof block, in.get())) > 0;)
        text.append(block, got);
    if (std::ferror(in.get())) fail(file, std::strerror(errno));
    return text;
}

}  // namespace astrosplat

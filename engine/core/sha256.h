// SHA-256 (OpenSSL's libcrypto) of bytes and files, as lower-case hex. Pixel hashes, frame
// hashes, names in the cache.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/progress.h"

namespace astrosplat {

class Sha256 {
  public:
    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;
    Sha256& add(const void* bytes, std::size_t size);
    Sha256& add(std::string_view text) { return add(text.data(), text.size()); }
    /// 64 lower-case hex digits; the object cannot be used any more.
    std::string hex();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Hash of a file's bytes. Throws InputError when it cannot be read; Cancelled.
std::string sha256_of_file(const std::filesystem::path& file, const Progress& progress = {});

}  // namespace astrosplat

// Hashes of bytes and files. SHA-256 (OpenSSL's libcrypto) as lower-case hex: pixel hashes, frame hashes,
// names in the cache. XXH64 (Yann Collet's xxHash, seed 0), fast enough that checking a file costs less than
// copying it: it finds damage, not malice.
#pragma once

#include <xxhash.h>

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
std::string sha256_of_file(const fs::path& file, const Progress& progress = {});

/// Lower-case hex of bytes by a method of OpenSSL's: "sha1", "sha256", "sha512"; nothing for other names.
std::optional<std::string> digest_of(const std::string& method, std::string_view bytes);

/// XXH64 of all bytes, with seed 0.
inline std::uint64_t xxh64(std::string_view bytes) { return XXH64(bytes.data(), bytes.size(), 0); }

/// The same of bytes that come piece by piece.
class RunningChecksum {
  public:
    RunningChecksum() : state_(XXH64_createState()) { XXH64_reset(state_.get(), 0); }
    void add(std::string_view bytes) { XXH64_update(state_.get(), bytes.data(), bytes.size()); }
    std::uint64_t value() const { return XXH64_digest(state_.get()); }

  private:
    struct Free {
        void operator()(XXH64_state_t* state) const { XXH64_freeState(state); }
    };
    std::unique_ptr<XXH64_state_t, Free> state_;
};

}  // namespace astrosplat

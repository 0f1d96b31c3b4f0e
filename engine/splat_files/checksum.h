// XXH64, the 64-bit hash of Yann Collet's xxHash, with seed 0: fast enough that checking a file costs less
// than copying it. It finds damage, not malice.
#pragma once

#include <xxhash.h>

#include <cstdint>
#include <memory>
#include <string_view>

namespace astrosplat {

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

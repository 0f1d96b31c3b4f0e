// Four lanes of 64 bits, then the rest in words of 8, 4 and 1 bytes, then mixing.
#include "splat_files/checksum.h"

#include <bit>
#include <cstring>

namespace astrosplat {

namespace {

constexpr std::uint64_t prime1 = 0x9e3779b185ebca87u, prime2 = 0xc2b2ae3d27d4eb4fu,
                        prime3 = 0x165667b19e3779f9u, prime4 = 0x85ebca77c2b2ae63u,
                        prime5 = 0x27d4eb2f165667c5u;

template <class T>
std::uint64_t load(const char* p) {
    static_assert(std::endian::native == std::endian::little);
    T value;
    std::memcpy(&value, p, sizeof value);
    return value;
}

std::uint64_t round(std::uint64_t lane, std::uint64_t input) {
    return std::rotl(lane + input * prime2, 31) * prime1;
}
std::uint64_t merge(std::uint64_t hash, std::uint64_t lane) {
    return (hash ^ round(0, lane)) * prime1 + prime4;
}

/// Takes all whole stripes of 32 bytes from p.
std::uint64_t hash_stripes(const char*& p, const char* end) {
    std::uint64_t a = prime1 + prime2, b = prime2, c = 0, d = 0 - prime1;
    for (; end - p >= 32; p += 32) {
        a = round(a, load<std::uint64_t>(p));
        b = round(b, load<std::uint64_t>(p + 8));
        c = round(c, load<std::uint64_t>(p + 16));
        d = round(d, load<std::uint64_t>(p + 24));
    }
    const std::uint64_t hash = std::rotl(a, 1) + std::rotl(b, 7) + std::rotl(c, 12) + std::rotl(d, 18);
    return merge(merge(merge(merge(hash, a), b), c), d);
}

}  // namespace

std::uint64_t xxh64(std::string_view bytes) {
    const char* p = bytes.data();
    const char* const end = p + bytes.size();
    std::uint64_t hash = bytes.size() >= 32 ? hash_stripes(p, end) : prime5;
    hash += bytes.size();
    for (; end - p >= 8; p += 8)
        hash = std::rotl(hash ^ round(0, load<std::uint64_t>(p)), 27) * prime1 + prime4;
    if (end - p >= 4) {
        hash = std::rotl(hash ^ load<std::uint32_t>(p) * prime1, 23) * prime2 + prime3;
        p += 4;
    }
    for (; p < end; ++p) hash = std::rotl(hash ^ load<std::uint8_t>(p) * prime5, 11) * prime1;
    hash = (hash ^ hash >> 33) * prime2;
    hash = (hash ^ hash >> 29) * prime3;
    return hash ^ hash >> 32;
}

}  // namespace astrosplat

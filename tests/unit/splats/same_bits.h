// Whether two columns of splats hold the same bits, which is how results of the generator and files are
// compared.
#pragma once

#include <cstring>

#include "core/buffer.h"

namespace astrosplat {

template <class T>
bool same_bits(const Buffer<T>& a, const Buffer<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace astrosplat

// The bytes of results, and whether they are the same whoever computes them.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <ranges>
#include <type_traits>

#include "core/buffer.h"
#include "core/image.h"
#include "core/parallel.h"

namespace astrosplat {

/// Of two columns of splats.
template <class T>
bool same_bits(const Buffer<T>& a, const Buffer<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace astrosplat

namespace astrosplat::test {

/// One part after the other: `Bits() << image << numbers`.
class Bits {
  public:
    /// Elements without padding.
    template <std::ranges::contiguous_range Array>
    Bits& operator<<(const Array& array) {
        bytes_.append(reinterpret_cast<const char*>(std::ranges::data(array)),
                      std::ranges::size(array) * sizeof(*std::ranges::data(array)));
        return *this;
    }
    template <class Number>
    requires std::is_arithmetic_v<Number> Bits& operator<<(Number number) {
        bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
        return *this;
    }
    Bits& operator<<(const Image& image) { return *this << image.pixels; }
    Bits& operator<<(const std::vector<Image>& images) {
        for (const Image& image : images) *this << image;
        return *this;
    }

    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

inline std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Fails the test where the text has no such part.
inline std::string replaced(std::string text, const std::string& part, const std::string& by) {
    const std::size_t at = text.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return at == std::string::npos ? text : text.replace(at, part.size(), by);
}

/// `run` gives Bits: the same on one thread, on several, and on every instruction set.
template <class Run>
void expect_same_bits(const Run& run) {
    const auto bytes = [&] { return Bits(run()).bytes(); };
    set_thread_count(1);
    const std::string expected = bytes();
    EXPECT_FALSE(expected.empty());
    for (const int threads : {2, 3, 7}) {
        set_thread_count(threads);
        EXPECT_TRUE(bytes() == expected) << threads << " threads";
    }
    set_thread_count(0);
    for (const std::string& target : vector_targets()) {
        set_vector_target(target);
        EXPECT_TRUE(bytes() == expected) << target;
    }
    set_vector_target("best");
}

}  // namespace astrosplat::test

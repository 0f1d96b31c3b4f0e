// Floats as the fast writer puts them against std::to_chars, which is the definition.
#include "splat_files/number_text.h"

#include <bit>
#include <cfloat>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace astrosplat {
namespace {

std::string text_of(float value) {
    std::string text(float_text_room, '?');
    text.resize(static_cast<std::size_t>(put_float(text.data(), value) - text.data()));
    return text;
}

std::string definition(float value) {
    char text[64];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

void expect_same(std::uint32_t bits) {
    const float value = std::bit_cast<float>(bits);
    ASSERT_EQ(text_of(value), definition(value)) << "bits " << bits;
    ASSERT_EQ(text_of(-value), definition(-value)) << "bits " << bits;
}

TEST(FloatText, PlainValues) {
    EXPECT_EQ(text_of(0.0f), "0");
    EXPECT_EQ(text_of(-0.0f), "-0");
    EXPECT_EQ(text_of(1.0f), "1");
    EXPECT_EQ(text_of(-0.5f), "-0.5");
    EXPECT_EQ(text_of(0.001f), "0.001");
    EXPECT_EQ(text_of(0.001953125f), "0.001953125");
    EXPECT_EQ(text_of(1.0f / 3.0f), "0.33333334");
    EXPECT_EQ(text_of(99999.99f), "99999.99");
    EXPECT_EQ(text_of(100000.0f), "1e+05");
    EXPECT_EQ(text_of(10000.0f), "10000");
    EXPECT_EQ(text_of(16777216.0f), "16777216");
    EXPECT_EQ(text_of(FLT_MAX), "3.4028235e+38");
    EXPECT_EQ(text_of(-FLT_MIN), "-1.1754944e-38");
    EXPECT_EQ(text_of(std::numeric_limits<float>::infinity()), "inf");
}

// Every 1021st float, from zero through infinity to the last NaN. (All of them were compared once.)
TEST(FloatText, IsWhatToCharsWrites) {
    for (std::uint64_t bits = 0; bits < std::uint64_t{1} << 31; bits += 1021)
        expect_same(static_cast<std::uint32_t>(bits));
}

// Where the spacing of floats or of decimals changes: around powers of two and of ten, and short decimals.
TEST(FloatText, AroundPowersAndShortDecimals) {
    for (std::uint32_t exponent = 1; exponent < 255; ++exponent)
        for (std::uint32_t near = 0; near < 129; ++near) expect_same((exponent << 23) + near - 64);
    for (const float power : {1e-4f, 1e-3f, 1e-2f, 1e-1f, 1e0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f})
        for (std::uint32_t near = 0; near < 129; ++near)
            expect_same(std::bit_cast<std::uint32_t>(power) + near - 64);
    for (int thousandth = 1; thousandth < 200000; ++thousandth)
        expect_same(std::bit_cast<std::uint32_t>(static_cast<float>(thousandth) / 1000.0f));
}

}  // namespace
}  // namespace astrosplat

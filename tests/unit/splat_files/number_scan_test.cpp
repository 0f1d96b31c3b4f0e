// Numbers as the fast scanner reads them against std::from_chars, which is the definition.
#include "splat_files/number_text.h"

#include <fmt/format.h>

#include <limits>

#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

void expect_nearest(const std::string& text) {
    float expected = 0.0f, got = 0.0f;
    std::from_chars(text.data(), text.data() + text.size(), expected);
    const char* end = scan::scan_float(text.data(), text.data() + text.size(), got);
    ASSERT_EQ(end, text.data() + text.size()) << text;
    ASSERT_EQ(std::bit_cast<std::uint32_t>(got), std::bit_cast<std::uint32_t>(expected)) << text;
}

float value_of(const std::string& text) {
    float value = -1.0f;
    return scan::scan_float(text.data(), text.data() + text.size(), value) ? value : -1.0f;
}

TEST(NumberScan, FloatsAreTheNearest) {
    for (std::uint32_t i = 0; i < 200000; ++i) {
        const float value = awkward(i);
        expect_nearest(fmt::format("{}", value));
        expect_nearest(fmt::format("{:.6g}", value));
        expect_nearest(fmt::format("{:.17g}", double{value} * 1.000000001));
    }
}

TEST(NumberScan, HalvesGoToEvenUnlessDigitsBehindDecide) {
    EXPECT_EQ(value_of("16777217"), 16777216.0f);
    EXPECT_EQ(value_of("16777219"), 16777220.0f);
    EXPECT_EQ(value_of("16777217.0000001"), 16777218.0f);
    EXPECT_EQ(value_of("16777217.00000000000000000000000001"), 16777218.0f);
    EXPECT_EQ(value_of("1677721700000000000e-11"), 16777216.0f);
}

TEST(NumberScan, ExtremesAndSigns) {
    EXPECT_EQ(value_of("3.4028235e38"), FLT_MAX);
    EXPECT_EQ(value_of("1e39"), std::numeric_limits<float>::infinity());
    EXPECT_EQ(value_of("-1e400"), -std::numeric_limits<float>::infinity());
    EXPECT_EQ(value_of("1e-45"), FLT_TRUE_MIN);
    EXPECT_EQ(value_of("1e-50"), 0.0f);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(value_of("-1e-400")), 0x80000000u);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(value_of("-0.000")), 0x80000000u);
    EXPECT_EQ(value_of("+.5"), 0.5f);
    EXPECT_EQ(value_of("00000000000000000000000000000001.5e+000"), 1.5f);
}

TEST(NumberScan, WhatIsNoNumber) {
    for (const char* text : {"", "-", "+", ".", "e5", "-.e1", "+-1", "--1", "abc"})
        EXPECT_EQ(value_of(text), -1.0f);
    std::string text = "1e+-5";
    float value = 0.0f;
    EXPECT_EQ(scan::scan_float(text.data(), text.data() + text.size(), value), text.data() + 1);
}

/// Text behind a field of a file belongs to the next one.
TEST(NumberScan, StopsAtTheEndOfItsText) {
    const char* const text = "12.5e3";
    for (const auto& [length, wanted] : {std::pair(1, 1.0f), {2, 12.0f}, {3, 12.0f}, {4, 12.5f}}) {
        float value = 0.0f;
        EXPECT_EQ(scan::scan_float(text, text + length, value), text + length);
        EXPECT_EQ(value, wanted);
    }
}

TEST(NumberScan, WholeNumbers) {
    const auto whole = [](const std::string& text) {
        std::uint64_t value = 77;
        return scan::scan_whole(text.data(), text.data() + text.size(), value) ? value : 0xbadu;
    };
    EXPECT_EQ(whole("18446744073709551615"), ~0ull);
    EXPECT_EQ(whole("3.0"), 3u);
    EXPECT_EQ(whole("1e+06"), 1000000u);
    for (const char* text : {"", "-1", "1.5", "1e300", "nan", "x", "18446744073709551616"})
        EXPECT_EQ(whole(text), 0xbadu) << text;
}

}  // namespace
}  // namespace astrosplat

// CFITSIO 4.2 trusts the cards that describe a tile-compressed image: with one wrong byte in them it divides
// by zero, writes out of bounds or aborts. Of a table whose sizes it cannot read it takes memory for any
// number of columns. Cards have 80 characters, "KEYWORD = value / comment", in blocks of 2880 bytes.
#include <fmt/format.h>
#include <unistd.h>

#include <map>

#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "source/fits.h"

namespace astrosplat {
namespace {

constexpr std::size_t card_size = 80, block_size = 2880;
using Cards = std::map<std::string, std::string, std::less<>>;  // keyword -> value as written

// The blocks of a file, or of what it was unpacked to, one after the other.
struct Blocks {
    const InputFile& in;
    const std::string* unpacked;
    std::int64_t at = 0;

    bool next(char* block) {
        const std::int64_t from = std::exchange(at, at + std::int64_t(block_size));
        if (!unpacked) return ::pread(in.descriptor(), block, block_size, from) == ssize_t(block_size);
        return from <= std::ssize(*unpacked) &&
               unpacked->copy(block, block_size, std::size_t(from)) == block_size;
    }
};

// The text between "= " and the comment.
std::string value_text(std::string_view card) {
    if (card.substr(8, 2) != "= ") return {};
    const std::string_view text = trim(card.substr(10));
    if (text.substr(0, 1) == "'") return std::string(text.substr(0, text.find('\'', 1) + 1));
    return std::string(trim(text.substr(0, text.find('/'))));
}

// False at the end of the file.
bool read_header(Blocks& in, Cards& cards) {
    std::array<char, block_size> block{};
    cards.clear();
    while (in.next(block.data())) {
        for (std::size_t at = 0; at < block_size; at += card_size) {
            const std::string_view card(block.data() + at, card_size);
            const std::string_view keyword = trim(card.substr(0, 8));
            if (keyword == "END") return true;
            cards.try_emplace(std::string(keyword), value_text(card));
        }
    }
    return false;
}

std::optional<std::int64_t> whole(const Cards& cards, std::string_view keyword) {
    const auto card = cards.find(keyword);
    return card == cards.end() ? std::nullopt : parse_int64(card->second);
}

// Bytes of data behind a header, with their padding; nothing where the header does not say.
std::optional<std::int64_t> data_bytes(const Cards& cards) {
    const std::int64_t axes = whole(cards, "NAXIS").value_or(-1);
    if (axes == 0) return 0;
    std::int64_t count = axes < 0 ? -1 : 1;
    for (std::int64_t i = 1; i <= axes && count >= 0; ++i) {
        const std::int64_t n = whole(cards, fmt::format("NAXIS{}", i)).value_or(-1);
        const bool groups = i == 1 && n == 0;  // random groups: the other axes count
        if (n < 0 || (!groups && __builtin_mul_overflow(count, n, &count))) count = -1;
    }
    const std::int64_t bits = std::abs(whole(cards, "BITPIX").value_or(0));
    if (count < 0 || __builtin_add_overflow(count, whole(cards, "PCOUNT").value_or(0), &count) ||
        __builtin_mul_overflow(count, whole(cards, "GCOUNT").value_or(1), &count) ||
        __builtin_mul_overflow(count, bits / 8, &count) || count < 0 || count > INT64_MAX - 2880)
        return std::nullopt;
    return (count + 2879) / 2880 * 2880;
}

// The kind of value that a card needs; its name may end in a number.
struct Rule {
    std::string_view name;
    bool numbered;
    double lowest, highest;  // of a whole number
};
constexpr double large = 2147483647.0;
constexpr std::array<Rule, 8> rules = {{{"ZNAXIS", false, 1, 6},
                                        {"ZNAXIS", true, 1, large},
                                        {"ZTILE", true, 1, large},
                                        {"ZPCOUNT", false, 0, large},
                                        {"ZGCOUNT", false, 0, large},
                                        {"ZBLANK", false, -large - 1.0, large},
                                        {"ZDITHER0", false, 0, 10000},
                                        {"ZBITPIX", false, -64, 64}}};
constexpr std::array compressions = {"RICE_1", "RICE_ONE",    "GZIP_1",    "GZIP_2",
                                     "PLIO_1", "HCOMPRESS_1", "NOCOMPRESS"};

struct Checker {
    std::string file, place;
    const Cards& cards;

    [[noreturn]] void fail(std::string_view keyword, std::string_view expected,
                           std::string_view found) const {
        bad_input(file, place, fmt::format("{} to be {}", keyword, expected), found.empty() ? "none" : found);
    }

    void check_whole(const std::string& keyword, const std::string& value, double lowest,
                     double highest) const {
        const std::optional<std::int64_t> number = parse_int64(value);
        const double n = number ? double(*number) : NAN;
        if (!(n >= lowest && n <= highest))
            fail(keyword, fmt::format("a whole number from {} to {}", lowest, highest), value);
    }

    void check_number(const std::string& keyword, const std::string& value) const {
        const std::optional<double> number = parse_double(value);
        if (!number || !std::isfinite(*number)) fail(keyword, "a number", value);
    }

    void check_by_rule(const std::string& keyword, const std::string& value) const {
        const std::size_t digits = keyword.find_last_not_of("0123456789") + 1;
        for (const Rule& rule : rules) {
            const bool same = rule.numbered
                                  ? digits < keyword.size() && keyword.compare(0, digits, rule.name) == 0
                                  : keyword == rule.name;
            if (same) check_whole(keyword, value, rule.lowest, rule.highest);
        }
        if (keyword == "ZSCALE" || keyword == "ZZERO") check_number(keyword, value);
    }

    // CFITSIO goes on without a number that it could not read, and takes memory for whatever stood there.
    void check_table() const {
        for (const char* keyword : {"NAXIS", "NAXIS1", "NAXIS2", "PCOUNT", "GCOUNT", "TFIELDS"}) {
            const auto value = cards.find(keyword);
            if (value == cards.end()) fail(keyword, "there", "");
            check_whole(keyword, value->second, 0, keyword == std::string_view("TFIELDS") ? 999 : 1e18);
        }
    }

    // The compression's own parameters: CFITSIO takes the first two by their number, whatever their name.
    void check_parameters(const std::string& compression) const {
        for (int i = 1; i <= 9; ++i) {
            const std::string keyword = fmt::format("ZVAL{}", i);
            const auto value = cards.find(keyword);
            const bool named = cards.contains(fmt::format("ZNAME{}", i));
            if (value == cards.end() && !named) continue;
            if (value == cards.end() || !named) fail(keyword, fmt::format("there with ZNAME{}", i), "");
            const bool rice = compression.starts_with("RICE");
            if (rice && i == 1 && value->second != "16" && value->second != "32")
                fail(keyword, "16 or 32 pixels", value->second);
            if (rice && i == 2 && value->second != "1" && value->second != "2" && value->second != "4" &&
                value->second != "8")
                fail(keyword, "1, 2, 4 or 8 bytes", value->second);
            if (!value->second.starts_with("'")) check_number(keyword, value->second);
        }
    }

    void check_sizes() const {
        const std::int64_t axes = whole(cards, "ZNAXIS").value_or(0);
        double tile = 1.0;
        for (std::int64_t i = 1; i <= axes; ++i) {
            const std::string axis = fmt::format("ZNAXIS{}", i);
            if (!cards.contains(axis)) fail(axis, "there", "");
            // Without it tiles are rows.
            tile *= double(whole(cards, fmt::format("ZTILE{}", i)).value_or(1));
        }
        if (tile > large)
            fail("ZTILEn", fmt::format("tiles of at most {} pixels", large), fmt::format("{}", tile));
    }

    void check_compressed_image() const {
        for (const char* keyword : {"ZBITPIX", "ZNAXIS", "ZCMPTYPE"})
            if (!cards.contains(keyword)) fail(keyword, "there", "");
        for (const auto& [keyword, value] : cards) check_by_rule(keyword, value);
        const std::int64_t bits = *whole(cards, "ZBITPIX");
        if (bits == 0 || bits % 8 != 0 || 64 % bits != 0 || bits == -8 || bits == -16)
            fail("ZBITPIX", "8, 16, 32, 64, -32 or -64", fmt::format("{}", bits));
        const std::string quoted = cards.find("ZCMPTYPE")->second;
        const std::string compression(trim(std::string_view(quoted).substr(
            quoted.empty() ? 0 : 1, std::max<std::size_t>(2, quoted.size()) - 2)));
        if (std::ranges::find(compressions, compression) == compressions.end())
            fail("ZCMPTYPE", fmt::format("one of {}", fmt::join(compressions, ", ")), quoted);
        const auto quantized = cards.find("ZQUANTIZ");
        if (quantized != cards.end() && quantized->second.starts_with("'SUBTRACTIVE") &&
            whole(cards, "ZDITHER0").value_or(1) == 0)
            fail("ZDITHER0", "a seed from 1 to 10000", "0");
        check_parameters(compression);
        check_sizes();
    }
};

}  // namespace

void check_fits_headers(const fs::path& file, const std::string* unpacked) {
    const InputFile open(file);
    Blocks in{open, unpacked};
    Cards cards;
    for (int hdu = 0; read_header(in, cards); ++hdu) {
        const Checker checker{file.string(), fmt::format("HDU {}", hdu), cards};
        // CFITSIO has room for so many; it opens a file with more and writes beyond it.
        if (const std::int64_t axes = whole(cards, "NAXIS").value_or(0); axes > 99)
            checker.fail("NAXIS", "at most 99", std::to_string(axes));
        const auto image = cards.find("ZIMAGE"), extension = cards.find("XTENSION");
        if (extension != cards.end() && extension->second.find("TABLE") != std::string::npos)
            checker.check_table();
        if (image != cards.end() && image->second != "F") checker.check_compressed_image();
        const std::optional<std::int64_t> bytes = data_bytes(cards);
        if (!bytes || *bytes > INT64_MAX - in.at - 2 * std::int64_t(block_size)) return;
        in.at += *bytes;
    }
}

}  // namespace astrosplat

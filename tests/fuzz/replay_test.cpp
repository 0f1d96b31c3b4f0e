// Every reader on some hundred damaged files: the right data or an InputError of one line, never anything
// else. Runs in normal builds and, where it bites hardest, under the sanitizers.
#include <cctype>

#include "fuzz/targets.h"
#include "support/test.h"

namespace astrosplat::fuzz {
namespace {

// Random choices are hashes of a counter (PCG-like output mixing), so that no library decides them.

struct Choices {
    std::uint64_t state;
    /// A number below `count` (which is > 0).
    std::size_t below(std::size_t count) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        std::uint64_t v = (state ^ state >> 33) * 0xff51afd7ed558ccdu;
        v = (v ^ v >> 33) * 0xc4ceb9fe1a85ec53u;
        return std::size_t((v ^ v >> 33) % count);
    }
};

constexpr std::string_view awkward_words[] = {"",
                                              "-1",
                                              "0",
                                              "1e999",
                                              "-1e-999",
                                              "nan",
                                              "inf",
                                              "2147483648",
                                              "-2147483649",
                                              "4294967295",
                                              "18446744073709551615",
                                              "99999999999999999999",
                                              "1e18",
                                              "1000000000000000000",
                                              "0x10",
                                              "1.5",
                                              "//",
                                              "\"",
                                              "[",
                                              "]]",
                                              "\n",
                                              "\xff\xfe",
                                              "{",
                                              "'",
                                              "="};

bool in_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '_';
}

void replace_word(std::string& bytes, Choices& choices) {
    std::size_t begin = choices.below(bytes.size());
    while (begin > 0 && in_word(bytes[begin - 1])) --begin;
    std::size_t end = begin;
    while (end < bytes.size() && in_word(bytes[end])) ++end;
    const std::string_view word = awkward_words[choices.below(std::size(awkward_words))];
    bytes.replace(begin, end - begin, word);
}

void edit(std::string& bytes, Choices& choices) {
    if (bytes.empty()) return;
    const std::size_t at = choices.below(bytes.size());
    const std::size_t length = 1 + choices.below(std::min<std::size_t>(bytes.size() - at, 40));
    switch (choices.below(8)) {
        case 0:
            bytes[at] = char(bytes[at] ^ (1 << choices.below(8)));
            break;
        case 1:
            bytes[at] = char(choices.below(256));
            break;
        case 2:
            bytes.resize(at);
            break;
        case 3:
            bytes.erase(at, length);
            break;
        case 4:
            bytes.insert(at, bytes.substr(at, length));
            break;
        case 5:
            std::swap(bytes[at], bytes[choices.below(bytes.size())]);
            break;
        case 6:
            std::fill_n(bytes.begin() + std::ptrdiff_t(at), length, choices.below(2) ? '\xff' : '\0');
            break;
        default:
            replace_word(bytes, choices);
    }
}

/// Damage to a file, by edits of one to four places: flipped bits, replaced bytes, cut ends, removed,
/// repeated or exchanged pieces, words replaced by awkward ones. Mutation k of some bytes is the same
/// everywhere and for ever.
std::string mutate(std::string bytes, std::uint32_t number) {
    Choices choices{number};
    for (std::size_t edits = 1 + choices.below(4); edits > 0; --edits) edit(bytes, choices);
    return bytes;
}

class Replay : public testing::TestWithParam<Target> {
    Said said_;
};

TEST_P(Replay, SeedsAreRead) {
    EXPECT_FALSE(GetParam().seeds().empty());
    for (const std::string& seed : GetParam().seeds()) EXPECT_GT(GetParam().read(seed), 0u);
}

TEST_P(Replay, DamageIsAnsweredWithOneLine) {
    constexpr std::uint32_t mutations = 600;
    int refused = 0;
    for (const std::string& seed : GetParam().seeds())
        for (std::uint32_t number = 0; number < mutations; ++number) {
            SCOPED_TRACE("mutation " + std::to_string(number));
            try {
                GetParam().read(mutate(seed, number));
            } catch (const InputError& error) {
                ++refused;
                const std::string line = error.what();
                EXPECT_FALSE(line.empty());
                EXPECT_EQ(line.find('\n'), line.npos) << line;
            } catch (const std::exception& error) {
                ADD_FAILURE() << "not an InputError: " << error.what();
            }
        }
    EXPECT_EQ(refused > 0, GetParam().refuses);
}

INSTANTIATE_TEST_SUITE_P(Readers, Replay, testing::ValuesIn(targets()),
                         [](const auto& reader) { return reader.param.name; });

}  // namespace
}  // namespace astrosplat::fuzz

// The canonical text as a frame file carries it: there and back, and what two texts do not share.
#include "output/metadata.h"

#include <gtest/gtest.h>

#include "core/text.h"

namespace astrosplat {
namespace {

TEST(HashedText, ComesBackAsItWas) {
    std::string text = "pixels = 2\nlayer.\xc3\xbc.name = \"\xc3\xbc\"\n";
    EXPECT_EQ(unpack_hashed_text(pack_hashed_text(text)), text);
    for (int i = 0; i < 20000; ++i) text += "key" + std::to_string(i) + " = 0.25\n";
    const std::string packed = pack_hashed_text(text);
    EXPECT_EQ(unpack_hashed_text(packed), text);
    EXPECT_LT(packed.size(), text.size() / 3);
    EXPECT_EQ(packed.find_first_of(" \n\t"), packed.npos);
}

TEST(HashedText, DamagedOnesAreNone) {
    const std::string packed = pack_hashed_text("output.exposure = 0.5\noutput.view = \"srgb\"\n");
    EXPECT_FALSE(unpack_hashed_text(""));
    EXPECT_FALSE(unpack_hashed_text("no base64!"));
    EXPECT_FALSE(unpack_hashed_text(packed.substr(0, packed.size() / 8 * 4)));
    EXPECT_FALSE(unpack_hashed_text(base64("bytes that were never deflated")));
    EXPECT_FALSE(unpack_hashed_text(pack_hashed_text(std::string(std::size_t{70} << 20, '0'))))
        << "few bytes that claim a lot of memory";
}

TEST(HashedText, TellsWhichKeysDiffer) {
    const std::string a =
        "pixels = 2\nx.both = 1\nx.other = [1, 2]\nx.gone = \"a = b\"\nx.path = 1\nx.path = 2\n";
    const std::string b = "pixels = 2\nx.both = 1\nx.other = [1, 3]\nx.path = 1\nx.path = 3\nx.new = 0.5\n";
    const std::vector<KeyDifference> expected = {{"x.other", "[1, 2]", "[1, 3]"},
                                                 {"x.gone", "\"a = b\"", ""},
                                                 {"x.path", "1; 2", "1; 3"},
                                                 {"x.new", "", "0.5"}};
    EXPECT_EQ(differing_keys(a, b), expected);
    EXPECT_TRUE(differing_keys(a, a).empty());
    EXPECT_EQ(hashed_value(a, "x.other"), "[1, 2]");
    EXPECT_FALSE(hashed_value(a, "x.new"));
}

}  // namespace
}  // namespace astrosplat

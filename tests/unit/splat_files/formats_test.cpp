// Rules that all formats of splats share, and files that are read in part.
#include <cfloat>
#include <charconv>
#include <csignal>

#include "core/file.h"
#include "core/file_format.h"
#include "core/log.h"
#include "splat_files/file_bytes.h"
#include "splat_files/formats.h"
#include "splat_files/native.h"
#include "splat_files/number_text.h"
#include "splat_files/splat_file.h"
#include "support/test.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

// Shared by all formats of splats: rules, and numbers as text.

// Kept by all formats of splats: what is read again, dust, files that stay.

// Every splat format of the table has a reader, and a writer where it says so; what is written is read again.
// A new row of core/file_format.cpp is tested as soon as it is there.

class SplatFormats : public SplatFileTest {
  protected:
    static std::vector<std::string> endings(FileUse use) { return endings_of({FileKind::splats}, use); }
};

TEST_F(SplatFormats, HaveReaders) {
    for (const std::string& ending : endings(FileUse::read)) {
        const auto file = write("empty" + ending, "");
        for (const std::string& error : {error_of(file, [](const auto& f) { read_splats(f); }),
                                         error_of(file, [](const auto& f) { splat_attributes(f); })}) {
            EXPECT_NE(error, "") << ending;  // it is no such file
            EXPECT_EQ(error.find("one of the endings"), std::string::npos) << ending << ": " << error;
        }
    }
}

TEST_F(SplatFormats, AreReadAsTheyWereWritten) {
    const SplatSet set = awkward_set(300);
    for (const std::string& ending : endings(FileUse::written)) {
        const auto file = path("a" + ending);
        write_splats({file}, set);
        SplatSet read = read_splats(file);
        sort_by_id(read);
        SCOPED_TRACE(ending);
        expect_same_splats(read, set);
    }
}

// Dust in files of formats that cannot say that a splat absorbs: a warning tells, the native format does not.

std::vector<std::string> warnings_of(const SplatSet& set, const std::string& name) {
    const TempFolder folder;
    const Said said;
    write_splats({folder / name, Existing::replace}, set);
    forget_warnings();
    return said.warnings;
}

TEST(DustInSplatFiles, IsWarnedOfWhereTheFormatCannotSayIt) {
    SplatSet set;
    set.position.resize(3);
    set.color.resize(3);
    set.alpha.resize(3);
    set.distance.resize(3);
    set.id.resize(3);
    for (std::size_t i = 0; i < 3; ++i) {
        set.color[i] = i == 0 ? glm::vec3(-1.0f, -1.2f, -1.5f) : glm::vec3(0.5f);
        set.id[i] = i;
    }
    set.absorbs = true;
    for (const char* name : {"a.ply", "a.pda"}) {
        const std::vector<std::string> warnings = warnings_of(set, name);
        ASSERT_EQ(warnings.size(), 1u) << name;
        EXPECT_HAS(warnings[0],
                   "the dust, 1 splat, absorbs light, which this format cannot say: it becomes "
                   "grey; .splats keeps it");
    }
    EXPECT_TRUE(warnings_of(set, "a.splats").empty());
    set.absorbs = false;  // then such a color is no dust
    EXPECT_TRUE(warnings_of(set, "a.ply").empty());
    set.color[0] = glm::vec3(0.5f);
    EXPECT_TRUE(warnings_of(set, "a.ply").empty());
}

// A splat file that is not to be replaced stays, whatever format is written beside it.

TEST(ExistingSplatFile, IsKeptOrReplaced) {
    const TempFolder folder;
    const SplatSet set = awkward_set(2);
    for (const char* name : {"a.pda", "a.ply", "a.splats"}) {
        const auto file = folder.file(name, "of another program");
        EXPECT_THROW(write_splats({file, Existing::keep}, set), AlreadyExists) << name;
        EXPECT_EQ(read_file(file), "of another program") << name;
        write_splats(file, set);
        EXPECT_EQ(read_splats(file).size(), 2) << name;
    }
}

// Numbers as text, read and written fast, against the standard library.

// Numbers as the fast scanner reads them against std::from_chars, which is the definition.

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

// Floats as the fast writer puts them against std::to_chars, which is the definition.

std::string text_of(float value) {
    std::string text(float_text_room, '?');
    text.resize(std::size_t(put_float(text.data(), value) - text.data()));
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
        expect_same(std::uint32_t(bits));
}

// Where the spacing of floats or of decimals changes: around powers of two and of ten, and short decimals.
TEST(FloatText, AroundPowersAndShortDecimals) {
    for (std::uint32_t exponent = 1; exponent < 255; ++exponent)
        for (std::uint32_t near = 0; near < 129; ++near) expect_same((exponent << 23) + near - 64);
    for (const float power : {1e-4f, 1e-3f, 1e-2f, 1e-1f, 1e0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f})
        for (std::uint32_t near = 0; near < 129; ++near)
            expect_same(std::bit_cast<std::uint32_t>(power) + near - 64);
    for (int thousandth = 1; thousandth < 200000; ++thousandth)
        expect_same(std::bit_cast<std::uint32_t>(float(thousandth) / 1000.0f));
}

// Native files block by block, and files that shrink while they are read.

// Native files block by block: the rows that the whole file has, damage found where it is asked for, and a
// sample that is some of them.

class NativeBlocksTest : public SplatFileTest {
  protected:
    NativeBlocksTest() { write_native(path("a.splats"), awkward_set(150000)); }
    static constexpr OptionalColumns all{true, true, true, true};
};

TEST_F(NativeBlocksTest, TogetherAreTheFile) {
    const SplatSet whole = read_native(path("a.splats"), {}, all);
    const NativeBlocks file(path("a.splats"));
    ASSERT_EQ(file.size(), 3u);
    EXPECT_EQ(file.splats(), whole.size());
    SplatSet together, block;
    static_cast<SplatSetFacts&>(together) = file.facts();
    for (std::size_t i = 0; i < file.size(); ++i) {
        file.read(i, all, i == 1 ? NativeBlocks::Check::none : NativeBlocks::Check::all, block);
        for (const glm::vec3& p : block.position) {
            EXPECT_LE(file.box(i).lo.x, p.x);
            EXPECT_GE(file.box(i).hi.z, p.z);
        }
        for_each_column([&](auto column, SplatColumn) {
            (together.*column)
                .insert((together.*column).end(), (block.*column).begin(), (block.*column).end());
        });
    }
    expect_same_splats(together, whole);
    file.read(0, {false, false, false, false}, NativeBlocks::Check::all, block);
    EXPECT_TRUE(block.uv.empty() && block.normal.empty() && block.mesh.empty());
    EXPECT_EQ(block.id.size(), 65536u);
}

TEST_F(NativeBlocksTest, DamageIsFoundWhereItIsLookedFor) {
    std::string bytes = bytes_of(path("a.splats"));
    bytes[bytes.size() / 2] ^= 1;
    const auto file = write("b.splats", bytes);
    const NativeBlocks damaged(file);
    SplatSet block;
    EXPECT_NO_THROW(damaged.read(1, all, NativeBlocks::Check::none, block));
    const std::string error =
        error_of(file, [&](const auto&) { damaged.read(1, all, NativeBlocks::Check::all, block); });
    EXPECT_HAS(error, "block 1: expected the checksum written with it");
}

TEST_F(NativeBlocksTest, AFileThatIsCutShortIsSaid) {
    const NativeBlocks file(path("a.splats"));
    fs::resize_file(path("a.splats"), 1000);
    SplatSet block;
    const std::string error =
        error_of(path("a.splats"), [&](const auto&) { file.read(2, all, NativeBlocks::Check::none, block); });
    EXPECT_HAS(error, "it became shorter while it was read");
}

TEST_F(NativeBlocksTest, ASampleIsSomeOfTheRows) {
    const SplatSet whole = read_native(path("a.splats"), {}, all);
    const SplatSet sample = NativeBlocks(path("a.splats")).sample(638);
    check_consistent(sample);
    EXPECT_GT(sample.size(), 630);
    EXPECT_LE(sample.size(), 640);
    for (std::size_t i = 0; i < sample.id.size(); ++i) {
        const auto row = std::size_t(std::ranges::find(whole.id, sample.id[i]) - whole.id.begin());
        ASSERT_LT(row, whole.id.size());
        EXPECT_EQ(std::bit_cast<std::uint32_t>(whole.alpha[row]),
                  std::bit_cast<std::uint32_t>(sample.alpha[i]));
        EXPECT_EQ(std::bit_cast<std::uint32_t>(whole.position[row].z),
                  std::bit_cast<std::uint32_t>(sample.position[i].z));
    }
}

TEST_F(NativeBlocksTest, ASampleOfAllRowsIsTheSet) {
    const SplatSet whole = read_native(path("a.splats"), {}, all);
    const SplatSet sample = NativeBlocks(path("a.splats")).sample(whole.size());
    EXPECT_TRUE(std::ranges::equal(sample.id, whole.id));
    EXPECT_TRUE(std::ranges::equal(sample.alpha, whole.alpha));
}

// A file that another program shortens while it is read: one line, where the kernel alone would
// end the process.

using MappedFileTest = SplatFileTest;
constexpr const char* shorter = ": cannot be read: it became shorter while it was read";

TEST_F(MappedFileTest, MissingPagesReadAsZerosAndTheReaderIsToldSo) {
    const auto file = write("a.txt", std::string(100000, 'x'));
    const MappedFile first(file), second(file);
    EXPECT_NO_THROW(first.require_whole());
    fs::resize_file(file, 5000);
    EXPECT_EQ(first.bytes().substr(0, 5000), std::string(5000, 'x'));
    EXPECT_EQ(std::count(first.bytes().begin(), first.bytes().end(), '\0'), 95000);
    EXPECT_EQ(second.bytes()[99999], '\0');
    fs::resize_file(file, 100000);  // long enough again, but what was read was not the file
    EXPECT_THROW(first.require_whole(), InputError);
    EXPECT_THROW(second.require_whole(), InputError);
    EXPECT_NO_THROW(MappedFile(file).require_whole());
}

TEST_F(MappedFileTest, ManyOneAfterTheOther) {
    const auto file = write("a.txt", "abc");
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(MappedFile(file).bytes(), "abc");
    EXPECT_EQ(MappedFile(write("empty", "")).bytes(), "");
}

/// Reads a file that loses all but its first page once the first part of it was read.
template <class Read>
std::string error_of_shrinking(const fs::path& file, const Read& read) {
    Progress progress;
    progress.report = [&](double) { fs::resize_file(file, 4096); };
    return error_of(file, [&](const auto& each) { read(each, progress); });
}

TEST_F(MappedFileTest, EveryReaderSaysThatItsFileBecameShorter) {
    set_thread_count(1);
    const SplatSet set = awkward_set(150000);  // more than the readers take at once
    write_pda(path("a.pda"), set);
    write_ply(path("a.ply"), set);
    write_native(path("a.splats"), set);
    const auto native = [](const auto& file, const Progress& progress) {
        return read_native(file, progress);
    };
    EXPECT_EQ(error_of_shrinking(path("a.pda"), read_pda), std::string("a.pda") + shorter);
    EXPECT_EQ(error_of_shrinking(path("a.ply"), read_ply), std::string("a.ply") + shorter);
    EXPECT_EQ(error_of_shrinking(path("a.splats"), native), std::string("a.splats") + shorter);
}

TEST_F(MappedFileTest, FaultsElsewhereStillEndTheProcess) {
    const MappedFile installs_the_handler(write("a.txt", "abc"));
    EXPECT_EXIT(raise(SIGBUS), testing::KilledBySignal(SIGBUS), "");
}

}  // namespace
}  // namespace astrosplat

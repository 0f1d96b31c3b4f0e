// Errors, log, text, memory, buffers, hashes, vector targets, and numbers.
#include <malloc.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <glm/vec3.hpp>

#include "core/bounds.h"
#include "core/buffer.h"
#include "core/color.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/progress.h"
#include "core/sorting.h"
#include "core/text.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Errors, log, text, memory, buffers, hashes, vector targets.

TEST(Error, LineNamesFilePlaceExpectationAndFinding) {
    EXPECT_EQ(ERROR_OF(bad_input("a.obj", "12", "three numbers", "two")),
              "a.obj:12: expected three numbers, found two");
    EXPECT_EQ(ERROR_OF(bad_input("a.obj", "", "faces", "none")), "a.obj: expected faces, found none");
}

TEST(Progress, ThrowsOnlyWhenAskedToStop) {
    std::atomic<bool> stop{false};
    Progress progress;
    EXPECT_NO_THROW(progress.check());
    progress.cancelled = &stop;
    EXPECT_NO_THROW(progress.check());
    stop = true;
    EXPECT_THROW(progress.check(), Cancelled);
}

TEST(Log, LevelsAndRepeatedWarnings) {
    const Said said;
    log_detail("hidden");
    log_info("shown");
    for (int i = 0; i < 3; ++i) log_warning("odd");
    forget_warnings();
    log_warning("odd");
    EXPECT_EQ(said.text(), "shown\nodd\nodd\n");
}

TEST(Log, AQuietThreadIsNeitherHeardNorRemembered) {
    const Said said;
    {
        const QuietLog quiet;
        log_error("whispered");
        log_warning("odd");
        std::thread([] { log_info("beside"); }).join();
    }
    log_warning("odd");
    EXPECT_EQ(said.text(), "beside\nodd\n");
}

TEST(Text, NumbersDoNotDependOnTheLocale) {
    EXPECT_EQ(parse_double("1.5"), 1.5);
    EXPECT_EQ(parse_double("+1e-3"), 1e-3);
    EXPECT_EQ(parse_double("-.5"), -0.5);
    EXPECT_EQ(parse_double("7."), 7.0);
    for (const char* bad : {"", "+", "1,5", "1.5x", " 1", "+-1", "1e", "1e999"})
        EXPECT_FALSE(parse_double(bad)) << bad;
    EXPECT_EQ(parse_int64("-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
    for (const char* bad : {"", "9223372036854775808", "1.0", "0x10"}) EXPECT_FALSE(parse_int64(bad)) << bad;
}

TEST(Text, ShortestNumbersReadBack) {
    EXPECT_EQ(shortest(0.1), "0.1");
    EXPECT_EQ(shortest(0.1f), "0.1");
    for (const double value : {1.0 / 3.0, 1e300, -5e-324, 123456789.125})
        EXPECT_EQ(parse_double(shortest(value)), value);
}

TEST(Text, ControlCharactersAreShownAsText) {
    EXPECT_EQ(printable("Große Nebel ☆"), "Große Nebel ☆");
    EXPECT_EQ(printable("a\nb\tc\x1b[31m\x7f"), "a\\nb\\x09c\\x1b[31m\\x7f");
    EXPECT_EQ(printable("\xc2\x9b"
                        "2J \xc2\xa0"),
              "\\x9b2J \xc2\xa0");  // CSI as one character; a hard space stays
    EXPECT_EQ(printable("\xc2"), "\xc2");
    EXPECT_EQ(utf8_line("Größe ☆ \xf0\x9f\x8c\x8c"), "Größe ☆ \xf0\x9f\x8c\x8c");
    EXPECT_EQ(utf8_line("Gr\xf6\xdf"
                        "e \xc3"),
              "Größe Ã")
        << "Latin 1";
    EXPECT_EQ(utf8_line("a\nb\tc\x1b"
                        "d\x7f"),
              "a b c d\x7f");
    EXPECT_EQ(utf8_line("\xed\xa0\x80|\xc0\xaf|\xe0\x80\xaf|\xf4\x90\x80\x80|\xf5\x80\x80\x80|\xef\xbf\xbf"),
              "í\u00a0 |À¯|à ¯|ô   |õ   | ")
        << "surrogates, longer than needed, beyond Unicode, none of XML";
    EXPECT_EQ(utf8_line("Größe", 4), "Grö");
    EXPECT_EQ(utf8_line("Größe", 3), "Gr");
}

TEST(Text, LightYearsHaveThreeDigitsAndAUnit) {
    for (const auto& [length, text] :
         {std::pair(0.0421, "0.0421 ly"), std::pair(4.24, "4.24 ly"), std::pair(999.4, "999 ly"),
          std::pair(999.6, "1 kly"), std::pair(26670.0, "26.7 kly"), std::pair(2.537e6, "2.54 Mly"),
          std::pair(1.32e10, "13.2 Gly"), std::pair(0.0, "0 ly")})
        EXPECT_EQ(light_years_text(length), text);
}

TEST(Text, NounsAreCounted) {
    EXPECT_EQ(counted(1, "frame"), "1 frame");
    EXPECT_EQ(counted(0, "frame"), "0 frames");
    EXPECT_EQ(counted(12, "frame"), "12 frames");
    EXPECT_EQ(human_count(1, "splat"), "1 splat");
    EXPECT_EQ(human_count(12400000, "splat"), "12.4 M splats");
}

TEST(Log, LinesStayOneLine) {
    const Said said;
    log_info("a\nb\x1b[2J: not found");
    EXPECT_EQ(said.lines, std::vector<std::string>{"a\\nb\\x1b[2J: not found"});
}

TEST(Bounds, AreEmptyWhereAnyAxisIs) {
    EXPECT_TRUE(Bounds{}.empty());
    EXPECT_FALSE((Bounds{glm::dvec3(2.0), glm::dvec3(2.0)}.empty())) << "a point";
    for (int axis = 0; axis < 3; ++axis) {
        Bounds box{glm::dvec3(0.0), glm::dvec3(1.0)};
        box.lo[axis] = 2.0;
        EXPECT_TRUE(box.empty()) << axis;
    }
}

TEST(Memory, HumanNumbers) {
    EXPECT_EQ(human_bytes(1.25 * 1024 * 1024 * 1024), "1.25 GiB");
    EXPECT_EQ(human_bytes(312.0 * 1024 * 1024), "312 MiB");
    EXPECT_EQ(human_bytes(4096), "4 KiB");
    EXPECT_EQ(human_bytes(17), "17 B");
    EXPECT_EQ(human_count(12.4e6), "12.4 M");
    EXPECT_EQ(human_count(3100), "3.1 k");
    EXPECT_EQ(human_count(812), "812");
    EXPECT_EQ(human_count(999999), "1 M");
    EXPECT_EQ(human_count(100), "100");
}

TEST(Memory, ClaimOfTooMuchNamesBothFigures) {
    EXPECT_GT(available_memory_bytes(), 0);
    EXPECT_GT(peak_memory_bytes(), 0);
    EXPECT_NO_THROW(claim_memory(1024, "a test"));
    const std::string message = ERROR_OF(claim_memory(std::int64_t{1} << 60, "a test"));
    EXPECT_EQ(message.find("a test needs 1048576 TiB of memory, but only "), 0u) << message;
}

TEST(Memory, ALimitLeavesLess) {
    const std::int64_t limit = resident_memory_bytes() + (std::int64_t{64} << 20);
    limit_memory(limit);
    EXPECT_LE(available_memory_bytes(), std::int64_t{64} << 20);
    EXPECT_NO_THROW(claim_memory(1024, "a test"));
    const std::string message = ERROR_OF(claim_memory(std::int64_t{65} << 20, "a test"));
    EXPECT_HAS(message,
               " are available of the " + human_bytes(double(limit)) + " that --memory allows; this takes ");
    limit_memory(limit, "a dial");
    EXPECT_HAS(ERROR_OF(claim_memory(std::int64_t{65} << 20, "a test")), " that a dial allows");
    limit_memory(1);  // less than is taken already
    EXPECT_EQ(available_memory_bytes(), 0);
    limit_memory(0);
    EXPECT_NO_THROW(claim_memory(std::int64_t{65} << 20, "a test"));
}

TEST(Memory, GroupsLeaveTheirLimitLessWhatCannotBeGivenUp) {
    EXPECT_EQ(group_room("1000\n", "400\n", "anon 100\ninactive_file 300\n", "inactive_file"), 900);
    EXPECT_EQ(group_room("1000\n", "400\n", "", "inactive_file"), 600);
    EXPECT_EQ(group_room("1000\n", "1200\n", "inactive_file 100\n", "inactive_file"), 0);
}

TEST(Memory, GroupsWithoutALimitLeaveAll) {
    constexpr std::int64_t all = std::numeric_limits<std::int64_t>::max();
    EXPECT_EQ(group_room("max\n", "400\n", "inactive_file 300\n", "inactive_file"), all);
    // The first version of control groups has no word for it. Its memory.stat may tell of more cached pages
    // than the usage has.
    const std::string no_limit = "9223372036854771712\n";
    EXPECT_EQ(group_room(no_limit, "8192\n", "total_inactive_file 4096\n", "total_inactive_file"),
              9223372036854771712 - 4096);
    EXPECT_EQ(group_room(no_limit, "8192\n", "total_inactive_file 1000000\n", "total_inactive_file"),
              9223372036854771712);
    EXPECT_EQ(group_room("1000\n", "400\n", "inactive_file 500\n", "inactive_file"), 1000);
}

TEST(Buffer, BigBlocksAreAlignedAndKeepTheirContents) {
    for (const std::size_t size : {std::size_t{10}, std::size_t{1} << 20, (std::size_t{5} << 20) + 3}) {
        Buffer<std::uint8_t> bytes;
        bytes.resize(size);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(bytes.data()) % (size >= (4u << 20) ? 2u << 20 : 64u), 0u);
        bytes.back() = 7;
        bytes.resize(size * 2);
        EXPECT_EQ(bytes[size - 1], 7);
        bytes.shrink_to_fit();
    }
}

std::int64_t pages_of_process() {
    std::ifstream in("/proc/self/statm");
    std::int64_t size = 0, resident = 0;
    in >> size >> resident;
    return resident;
}

// Blocks whose pages are all there.
void* written_pages(std::size_t bytes) {
    void* const memory = allocate_pages(bytes);
    std::memset(memory, 1, bytes);
    return memory;
}

TEST(Buffer, FreedBlocksServeTheNextOfTheirSize) {
    if (!std::ifstream("/proc/self/smaps_rollup"))
        GTEST_SKIP() << "the system does not tell what was lent to it";
    constexpr std::size_t size = std::size_t{96} << 20;
    void* const first = written_pages(size);
    const std::int64_t used = resident_memory_bytes();
    free_pages(first, size);
    EXPECT_LT(resident_memory_bytes(), used - std::int64_t(size / 2));
    void* const nearly = allocate_pages(size - 100);
    EXPECT_EQ(nearly, first);
    free_pages(nearly, size - 100);
}

TEST(Buffer, SpareBlocksAddLittleToTheMostInUse) {
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "the thread sanitizer keeps several pages for each of the program's";
#endif
    release_spare_pages();
    const std::int64_t page = 4096, before = pages_of_process();
    constexpr std::size_t large = std::size_t{512} << 20;  // more than any test before; half of it is 256 MiB
    for (std::size_t size = large / 4; size <= large; size += large / 8)
        free_pages(written_pages(size), size);
    EXPECT_LE((pages_of_process() - before) * page, std::int64_t(large + large / 2 + large / 16));
    release_spare_pages();
    EXPECT_LT((pages_of_process() - before) * page, std::int64_t(large / 16));
}

TEST(Buffer, TooMuchIsBadAlloc) {
    EXPECT_THROW(allocate_pages(std::numeric_limits<std::size_t>::max()), std::bad_alloc);
    EXPECT_THROW(allocate_pages(std::size_t{1} << 62), std::bad_alloc);
}

TEST(Sha256, KnownDigests) {  // FIPS 180-4 examples
    EXPECT_EQ(Sha256().hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(Sha256().add("a").add("bc").hex(),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, ManyLeaveNoMemoryBehind) {
    const auto in_use = [] { return std::int64_t(mallinfo2().uordblks); };
    EXPECT_EQ(Sha256().add("a").hex().size(), 64u);
    const std::int64_t before = in_use();
    for (int i = 0; i < 1000; ++i) Sha256().add("a").hex();
    EXPECT_LT(in_use() - before, 10000);
}

TEST(Sha256, OfFiles) {
    const TempFolder folder;
    EXPECT_EQ(sha256_of_file(folder.file("a b", "abc")),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    const std::string missing = (folder / "missing").string();
    EXPECT_EQ(ERROR_OF(sha256_of_file(missing)), missing + ": cannot be read: No such file or directory");
    EXPECT_NE(ERROR_OF(sha256_of_file(folder.path())), "no error");
    const std::atomic<bool> cancelled{true};
    EXPECT_THROW(sha256_of_file(folder.file("a b", "abc"), Progress{{}, &cancelled}), Cancelled);
}

TEST(File, ReadsAllBytesOrSaysWhyNot) {
    const TempFolder folder;
    EXPECT_EQ(read_file(folder.file("x", std::string("a\0b", 3))), std::string("a\0b", 3));
    EXPECT_EQ(ERROR_OF(read_file(folder.path())),
              folder.path().string() + ": cannot be read: it is a folder");
    EXPECT_EQ(ERROR_OF(read_file(folder / "no")),
              (folder / "no").string() + ": cannot be read: No such file or directory");
    EXPECT_EQ(read_beginning(folder.file("y", "abc"), 2), "ab");
    EXPECT_EQ(read_beginning(folder / "y", 5), "abc");
    EXPECT_EQ(read_beginning(folder / "no", 5), "");
}

TEST(File, PipesDevicesAndSocketsAreRefusedAtOnce) {
    const TempFolder folder;
    const fs::path pipe = folder / "pipe", socket_file = folder / "socket";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    // "./socket", because the name of a socket is limited to 107 bytes.
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    const int descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{AF_UNIX, "./socket"};
    EXPECT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    fs::current_path(before);
    for (const fs::path& file : {pipe, socket_file, fs::path("/dev/zero")}) {
        const std::string expected = file.string() + ": cannot be read: it is not a regular file";
        EXPECT_EQ(ERROR_OF(read_file(file)), expected);
        EXPECT_EQ(ERROR_OF(sha256_of_file(file)), expected);
        EXPECT_EQ(read_beginning(file, 1), "");
    }
    close(descriptor);
}

TEST(File, ReadingStopsWhenAsked) {
    const TempFolder folder;
    const std::atomic<bool> stop{true};
    EXPECT_THROW(read_file(folder.file("x", "abc"), Progress{{}, &stop}), Cancelled);
}

TEST(VectorTarget, EachOfferedOneCanBeChosen) {
    const std::vector<std::string> targets = vector_targets();
    ASSERT_FALSE(targets.empty());
    for (const std::string& target : targets) {
        set_vector_target(target);
        EXPECT_EQ(vector_target(), target);
    }
    set_vector_target("best");
    EXPECT_EQ(vector_target(), targets.front());
    const std::string message = ERROR_OF(set_vector_target("mmx"));
    EXPECT_EQ(message.find("vector target: expected one that this processor has (best, " + targets.front()),
              0u);
    EXPECT_HAS(message, "found 'mmx'");
}

// The engine's elementary functions against the C library's 80-bit ones, in units of the last place.

constexpr double infinity = std::numeric_limits<double>::infinity();

double ulps(double value, long double truth) {
    const double nearest = double(truth);
    const double unit = std::nextafter(std::fabs(nearest), infinity) - std::fabs(nearest);
    return double(std::fabs((static_cast<long double>(value) - truth) / unit));
}

// The largest error over a dense, irrational walk through [lo, hi].
double worst(double lo, double hi, const std::function<double(double)>& ours,
             const std::function<long double(long double)>& truth) {
    double most = 0.0;
    for (int i = 0; i < 200000; ++i) {
        const double part = std::fmod(i * 0.6180339887498949, 1.0);
        const double x = lo + (hi - lo) * part;
        most = std::max(most, ulps(ours(x), truth(x)));
    }
    return most;
}

using L = long double;

TEST(Real, SinCosTanWithinTwoUlps) {
    for (const double range : {0.8, 10.0, 1000.0, 1e6}) {
        EXPECT_LE(worst(-range, range, real::sin, [](L x) { return std::sin(x); }), 1.0) << range;
        EXPECT_LE(worst(-range, range, real::cos, [](L x) { return std::cos(x); }), 1.0) << range;
        EXPECT_LE(worst(-range, range, real::tan, [](L x) { return std::tan(x); }), 2.0) << range;
    }
}

TEST(Real, SinAndCosNextToMultiplesOfHalfPi) {
    for (int k = 1; k < 600000; k += 997) {
        const double x = k * (real::pi / 2.0);
        EXPECT_LE(ulps(real::sin(x), std::sin(static_cast<L>(x))), 1.0) << k;
        EXPECT_LE(ulps(real::cos(x), std::cos(static_cast<L>(x))), 1.0) << k;
    }
}

// Every value there is: what children of splats look like hangs on the bits.
TEST(Real, OnACircleTheBitsAreThoseOfCosAndSin) {
    constexpr int turn = 1 << 24;
    for (int i = 0; i < turn; ++i) {
        const float turns = float(i) / turn;
        const glm::vec2 at = real::on_circle(turns);
        if (i % (turn / 4) == 0) continue;  // exact: see below
        const double angle = 2.0 * real::pi * double(turns);
        ASSERT_EQ(at.x, float(real::cos(angle))) << i;
        ASSERT_EQ(at.y, float(real::sin(angle))) << i;
    }
    for (int quarter = 0; quarter < 4; ++quarter) {
        const glm::vec2 at = real::on_circle(0.25f * float(quarter));
        EXPECT_EQ(at.x, quarter == 0 ? 1.0f : quarter == 2 ? -1.0f : 0.0f) << quarter;
        EXPECT_EQ(at.y, quarter == 1 ? 1.0f : quarter == 3 ? -1.0f : 0.0f) << quarter;
    }
}

TEST(Real, InverseFunctionsWithinTwoUlps) {
    EXPECT_LE(worst(-1.0, 1.0, real::asin, [](L x) { return std::asin(x); }), 2.0);
    EXPECT_LE(worst(-1.0, 1.0, real::acos, [](L x) { return std::acos(x); }), 2.0);
    EXPECT_LE(worst(-3.0, 3.0, real::atan, [](L x) { return std::atan(x); }), 2.0);
    EXPECT_LE(worst(-1e5, 1e5, real::atan, [](L x) { return std::atan(x); }), 2.0);
    for (const double y : {-2.0, -1e-9, 0.3, 5.0})
        EXPECT_LE(worst(
                      -7.0, 7.0, [y](double x) { return real::atan2(y, x); },
                      [y](L x) { return std::atan2(static_cast<L>(y), x); }),
                  2.0)
            << y;
}

TEST(Real, ExpAndLogWithinOneUlp) {
    EXPECT_LE(worst(-700.0, 709.0, real::exp, [](L x) { return std::exp(x); }), 1.0);
    EXPECT_LE(worst(-1.0, 1.0, real::exp, [](L x) { return std::exp(x); }), 1.0);
    EXPECT_LE(worst(1e-300, 1e300, real::log, [](L x) { return std::log(x); }), 1.0);
    EXPECT_LE(worst(0.5, 2.0, real::log, [](L x) { return std::log(x); }), 1.0);
    EXPECT_LE(worst(5e-324, 1e-308, real::log, [](L x) { return std::log(x); }), 1.0);
}

TEST(Real, PowWithinTwoUlpsWhereCurvesUseIt) {
    for (const double y : {2.4, 1.0 / 2.4, -0.7, 0.5, 3.0, 7.0})
        EXPECT_LE(worst(
                      1e-6, 4.0, [y](double x) { return real::pow(x, y); },
                      [y](L x) { return std::pow(x, static_cast<L>(y)); }),
                  2.0)
            << y;
}

TEST(Real, PowOfExtremesStaysWithinTenToTheMinusThirteen) {
    for (const double x : {1e-300, 1e-10, 0.999, 1.001, 1e10, 1e300})
        for (const double y : {-1.01, -0.3, 0.9, 1.02}) {
            const L truth = std::pow(static_cast<L>(x), static_cast<L>(y));
            EXPECT_LE(std::fabs(double((real::pow(x, y) - truth) / truth)), 1e-13) << x << "^" << y;
        }
}

TEST(Real, AsinhWithinThreeUlps) {
    for (const double range : {1e-3, 1.0, 100.0, 1e12})
        EXPECT_LE(worst(-range, range, real::asinh, [](L x) { return std::asinh(x); }), 3.0) << range;
}

TEST(Real, ExactValues) {
    EXPECT_EQ(real::sin(0.0), 0.0);
    EXPECT_EQ(real::cos(0.0), 1.0);
    EXPECT_EQ(real::exp(0.0), 1.0);
    EXPECT_EQ(real::log(1.0), 0.0);
    EXPECT_EQ(real::pow(3.5, 1.0), 3.5);
    EXPECT_EQ(real::pow(2.0, 10.0), 1024.0);
    EXPECT_EQ(real::pow(0.0, 0.0), 1.0);
    EXPECT_EQ(real::pow(0.0, 2.0), 0.0);
    EXPECT_EQ(real::asin(1.0), real::pi / 2.0);
    EXPECT_EQ(real::acos(-1.0), real::pi);
    EXPECT_EQ(real::acos(2.0), 0.0);
    EXPECT_EQ(real::atan2(0.0, 0.0), 0.0);
    EXPECT_EQ(real::atan2(1.0, 0.0), real::pi / 2.0);
    EXPECT_EQ(real::atan2(0.0, -1.0), real::pi);
    EXPECT_EQ(real::asinh(0.0), 0.0);
    EXPECT_EQ(real::atan2(1e308, 1e308), real::pi / 4.0);
}

TEST(Real, EndsOfTheRange) {
    EXPECT_EQ(real::exp(710.0), infinity);
    EXPECT_EQ(real::exp(-746.0), 0.0);
    EXPECT_EQ(real::exp(-745.0), 5e-324);
    EXPECT_EQ(real::exp(infinity), infinity);
    EXPECT_EQ(real::log(0.0), -infinity);
    EXPECT_TRUE(std::isnan(real::log(-1.0)));
    EXPECT_TRUE(std::isnan(real::pow(-1.0, 2.0)));
    EXPECT_TRUE(std::isnan(real::sin(infinity)));
    EXPECT_EQ(real::pow(1e200, 2.0), infinity);
    EXPECT_EQ(real::pow(1e-200, 2.0), 0.0);
    EXPECT_EQ(real::pow(infinity, -1.0), 0.0);
}

TEST(Color, SrgbCurveAtKnownValues) {
    EXPECT_EQ(real::srgb_to_linear(0.0), 0.0);
    EXPECT_EQ(real::srgb_to_linear(1.0), 1.0);
    EXPECT_NEAR(real::srgb_to_linear(0.5), 0.21404114048223255, 1e-16);
    EXPECT_DOUBLE_EQ(real::srgb_to_linear(0.04), 0.04 / 12.92);
    EXPECT_EQ(real::srgb_to_linear(-0.5), -real::srgb_to_linear(0.5));
}

TEST(Color, SrgbRoundTripOfAll16BitValues) {
    for (int i = 0; i <= 65535; ++i) {
        const double encoded = i / 65535.0;
        ASSERT_NEAR(real::linear_to_srgb(real::srgb_to_linear(encoded)), encoded, 1e-15) << i;
    }
}

// Matrices between primaries against published ones and what must hold for any.

TEST(Primaries, Rec709ToAcescgIsThePublishedMatrix) {
    // As in the ACES configs of OpenColorIO (Bradford), by rows.
    const double published[3][3] = {
        {0.613097, 0.339523, 0.047379}, {0.070194, 0.916354, 0.013452}, {0.020616, 0.109570, 0.869815}};
    const glm::dmat3 matrix = primaries_matrix(rec709_chromaticities, acescg_chromaticities);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            EXPECT_NEAR(matrix[column][row], published[row][column], 1e-6) << row << " " << column;
}

TEST(Primaries, WhiteStaysWhiteAndTheWayBackIsTheInverse) {
    const glm::dmat3 there = primaries_matrix(rec709_chromaticities, acescg_chromaticities),
                     back = primaries_matrix(acescg_chromaticities, rec709_chromaticities);
    const glm::dvec3 white = there * glm::dvec3(1.0);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(white[c], 1.0, 1e-12);
        for (int r = 0; r < 3; ++r) EXPECT_NEAR((back * there)[c][r], c == r ? 1.0 : 0.0, 1e-12);
    }
}

// Radix sort against std::stable_sort, medians, percentiles as numpy defines them, and the Morton curve's
// closed form.

using Pair = std::pair<std::uint64_t, int>;

std::vector<Pair> values(std::size_t count, std::uint64_t mask) {
    std::vector<Pair> all;
    for (std::size_t i = 0; i < count; ++i) all.emplace_back((i + 1) * 0x9e3779b97f4a7c15u & mask, int(i));
    return all;
}

std::vector<Pair> sorted_by_bits(std::vector<Pair> all, unsigned begin, unsigned end) {
    std::vector<Pair> scratch(all.size());
    const Pair* const sorted = radix_sort<8>(
        all.data(), scratch.data(), all.size(), begin, end, [](const Pair& p) { return p.first; }, [] {});
    return {sorted, sorted + all.size()};
}

TEST(RadixSort, IsAStableSortByTheBitsAskedFor) {
    for (const std::size_t count : {0u, 1u, 2u, 1000u, 70000u})
        for (const std::uint64_t mask : {~std::uint64_t{0}, std::uint64_t{0xffff00ff00}, std::uint64_t{0}}) {
            std::vector<Pair> expected = values(count, mask);
            std::stable_sort(expected.begin(), expected.end(),
                             [](const Pair& a, const Pair& b) { return a.first < b.first; });
            EXPECT_EQ(sorted_by_bits(values(count, mask), 0, 64), expected) << count << " " << mask;
        }
    std::vector<Pair> expected = values(5000, ~std::uint64_t{0});
    std::stable_sort(expected.begin(), expected.end(), [](const Pair& a, const Pair& b) {
        return (a.first >> 20 & 0xffffu) < (b.first >> 20 & 0xffffu);
    });
    EXPECT_EQ(sorted_by_bits(values(5000, ~std::uint64_t{0}), 20, 36), expected);
}

TEST(RadixSort, ACheckStopsIt) {
    std::vector<Pair> all = values(100, ~std::uint64_t{0}), scratch(100);
    const auto stop = [] { throw std::runtime_error("stopped"); };
    EXPECT_THROW(
        radix_sort<8>(
            all.data(), scratch.data(), all.size(), 0, 64, [](const Pair& p) { return p.first; }, stop),
        std::runtime_error);
}

TEST(Median, IsTheUpperOfTheTwoInTheMiddle) {
    EXPECT_EQ(median(std::vector{5.0f, 1.0f, 4.0f}), 4.0f);
    EXPECT_EQ(median(std::vector{5, 1, 4, 2}), 4);
    EXPECT_EQ(median(std::array{7.5}), 7.5);
    std::vector parts{9, 1, 2, 3, 9};
    EXPECT_EQ(median(std::span(parts).subspan(1, 3)), 2);
    EXPECT_EQ(parts.front(), 9);
}

TEST(Percentile, IsLinearBetweenNeighbours) {
    const std::vector<double> values{5.0, 1.0, 4.0, 2.0};
    EXPECT_EQ(percentile(values, 0.0), 1.0);
    EXPECT_EQ(percentile(values, 1.0), 5.0);
    EXPECT_EQ(percentile(values, 0.5), 3.0);
    EXPECT_NEAR(percentile(values, 0.9), 4.7, 1e-12);
    EXPECT_EQ(percentile({7.0}, 0.3), 7.0);
    EXPECT_EQ(percentile({}, 0.5), 0.0);
}

}  // namespace
}  // namespace astrosplat

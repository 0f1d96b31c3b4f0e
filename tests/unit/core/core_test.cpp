// Errors, log, text, memory, buffers, hashes, vector targets.
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "core/bounds.h"
#include "core/buffer.h"
#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/text.h"
#include "support/errors.h"
#include "support/quiet.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

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
    flush_warning_counts();
    log_warning("odd");
    flush_warning_counts();
    EXPECT_EQ(said.text(), "shown\nodd\nodd (3 times)\nodd\n");
}

TEST(Log, AQuietThreadIsNeitherHeardNorCounted) {
    const Said said;
    {
        const QuietLog quiet;
        log_error("whispered");
        log_warning("odd");
        std::thread([] { log_info("beside"); }).join();
    }
    log_warning("odd");
    flush_warning_counts();
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
    EXPECT_LT(resident_memory_bytes(), used - static_cast<std::int64_t>(size / 2));
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
    EXPECT_LE((pages_of_process() - before) * page,
              static_cast<std::int64_t>(large + large / 2 + large / 16));
    release_spare_pages();
    EXPECT_LT((pages_of_process() - before) * page, static_cast<std::int64_t>(large / 16));
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
    const auto in_use = [] { return static_cast<std::int64_t>(mallinfo2().uordblks); };
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

}  // namespace
}  // namespace astrosplat

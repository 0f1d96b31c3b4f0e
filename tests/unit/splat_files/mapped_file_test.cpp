// A file that another program shortens while it is read: one line, where the kernel alone would end the
// process.
#include "splat_files/file_bytes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <string>

#include "splat_files/formats.h"
#include "splat_files/native.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

using MappedFileTest = SplatFileTest;
constexpr const char* shorter = ": cannot be read: it became shorter while it was read";

TEST_F(MappedFileTest, MissingPagesReadAsZerosAndTheReaderIsToldSo) {
    const auto file = write("a.txt", std::string(100000, 'x'));
    const MappedFile first(file), second(file);
    EXPECT_NO_THROW(first.require_whole());
    std::filesystem::resize_file(file, 5000);
    EXPECT_EQ(first.bytes().substr(0, 5000), std::string(5000, 'x'));
    EXPECT_EQ(std::count(first.bytes().begin(), first.bytes().end(), '\0'), 95000);
    EXPECT_EQ(second.bytes()[99999], '\0');
    std::filesystem::resize_file(file, 100000);  // long enough again, but what was read was not the file
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
std::string error_of_shrinking(const std::filesystem::path& file, const Read& read) {
    Progress progress;
    progress.report = [&](double) { std::filesystem::resize_file(file, 4096); };
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

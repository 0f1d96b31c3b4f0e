// A file is there whole, or not at all.
#include "core/atomic_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "core/error.h"
#include "core/file.h"
#include "support/errors.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

std::ptrdiff_t entries(const fs::path& folder) {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(AtomicFile, AppearsAtCommitOnly) {
    const TempFolder folder;
    AtomicFile file(folder / "a b.exr");
    file.write("half");
    EXPECT_EQ(file.temporary().extension(), ".exr");
    EXPECT_EQ(file.temporary().parent_path(), folder.path());
    EXPECT_FALSE(fs::exists(folder / "a b.exr"));
    file.write(" done");
    file.commit();
    EXPECT_EQ(read_file(folder / "a b.exr"), "half done");
    EXPECT_EQ(entries(folder.path()), 1);
}

TEST(AtomicFile, FailureLeavesTheOldFileAndNothingElse) {
    const TempFolder folder;
    const fs::path target = folder.file("x.txt", "old");
    { AtomicFile(target).write("new"); }
    EXPECT_EQ(read_file(target), "old");
    EXPECT_EQ(entries(folder.path()), 1);
}

TEST(AtomicFile, LibrariesMayReplaceTheTemporary) {
    const TempFolder folder;
    AtomicFile file(folder / "x.bin");
    fs::remove(file.temporary());
    std::ofstream(file.temporary()) << "library";
    file.commit();
    EXPECT_EQ(read_file(folder / "x.bin"), "library");
}

TEST(AtomicFile, WritesThroughSymbolicLinks) {
    const TempFolder folder;
    const fs::path real = folder.file("real.txt", "old");
    fs::create_symlink(real, folder / "link.txt");
    write_file_atomically(folder / "link.txt", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
    EXPECT_EQ(read_file(real), "new");
}

TEST(AtomicFile, MissingFolderAndWrongKindAreOneLine) {
    const TempFolder folder;
    const fs::path inside = folder / "no" / fs::path("x.exr");
    EXPECT_EQ(message_of<OutputError>([&] { AtomicFile file(inside); }),
              inside.string() + ": cannot be written: No such file or directory");
    EXPECT_EQ(message_of<OutputError>([&] { AtomicFile file(folder.path()); }),
              folder.path().string() + ": cannot be written: it is no regular file");
}

}  // namespace
}  // namespace astrosplat

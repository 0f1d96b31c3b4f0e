// Files that are whole or absent, and the table of their formats.
#include <bzlib.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "core/atomic_file.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/packed_file.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// A file is there whole, or not at all.

std::ptrdiff_t entries(const fs::path& folder) {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

class AtomicFileTest : public testing::Test {
  protected:
    const TempFolder folder;
};

TEST_F(AtomicFileTest, AppearsAtCommitOnly) {
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

TEST_F(AtomicFileTest, NewFilesHaveThePermissionsThatTheUserGivesToAllFiles) {
    AtomicFile file(folder / "x.txt");
    file.commit();
    const mode_t mask = umask(0);
    umask(mask);
    struct stat status = {};
    ASSERT_EQ(stat((folder / "x.txt").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0666 & ~mask);
}

TEST_F(AtomicFileTest, FailureLeavesTheOldFileAndNothingElse) {
    const fs::path target = folder.file("x.txt", "old");
    { AtomicFile(target).write("new"); }
    EXPECT_EQ(read_file(target), "old");
    EXPECT_EQ(entries(folder.path()), 1);
}

TEST_F(AtomicFileTest, WritesThroughSymbolicLinks) {
    const fs::path real = folder.file("real.txt", "old");
    fs::create_symlink(real, folder / "link.txt");
    write_file_atomically(folder / "link.txt", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
    EXPECT_EQ(read_file(real), "new");
}

TEST_F(AtomicFileTest, WritesBehindLinksThatLeadNowhereYet) {
    fs::create_symlink("second", folder / "first");
    fs::create_symlink("real.txt", folder / "second");
    write_file_atomically(folder / "first", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "first") && fs::is_symlink(folder / "second"));
    EXPECT_FALSE(fs::is_symlink(folder / "real.txt"));
    EXPECT_EQ(read_file(folder / "real.txt"), "new");
    fs::create_symlink("loop", folder / "loop");
    EXPECT_EQ(message_of<OutputError>([&] { write_file_atomically(folder / "loop", "new"); }),
              (folder / "loop").string() + ": cannot be written: Too many levels of symbolic links");
    EXPECT_TRUE(fs::is_symlink(folder / "loop"));
}

TEST_F(AtomicFileTest, BytesMayBeReplacedBeforeTheEnd) {
    AtomicFile file(folder / "x");
    file.write("header....");
    file.write_at(6, "1234", 4);
    file.write(" end");
    EXPECT_EQ(file.size(), 14);
    file.commit();
    EXPECT_EQ(read_file(folder / "x"), "header1234 end");
}

TEST_F(AtomicFileTest, KeepsWhatAppearedMeanwhile) {
    AtomicFile first(folder / "x", Existing::keep), second(folder / "x", Existing::keep);
    first.write("first");
    second.write("second");
    second.commit();
    EXPECT_THROW(first.commit(), AlreadyExists);
    EXPECT_EQ(read_file(folder / "x"), "second");
    write_file_atomically(folder / "x", "third");
    EXPECT_EQ(read_file(folder / "x"), "third");
    EXPECT_THROW(refuse_existing(folder / "x"), AlreadyExists);
    EXPECT_NO_THROW(refuse_existing(folder / "y"));
}

TEST_F(AtomicFileTest, KeptFilesLeaveNoTemporary) {
    folder.file("x", "old");
    EXPECT_THROW(write_file_atomically(folder / "x", "new", Existing::keep), AlreadyExists);
    EXPECT_EQ(entries(folder.path()), 1);
}

TEST_F(AtomicFileTest, WhatKilledProgramsLeftIsRemovedAndNothingElse) {
    const TempFolder other;
    const std::vector<fs::path> gone = {folder.file(".shot.0001.1a2b-3c4d5e-0.part.exr", "half"),
                                        folder.file(".scene.1-2-3.part", "")};
    // Another AtomicFile's, made before its folder is looked at for the first time.
    AtomicFile alive(other / "y.exr");
    alive.write("alive");
    const fs::path moved = folder / alive.temporary().filename().string();
    fs::create_hard_link(alive.temporary(), moved);
    const std::vector<fs::path> stay = {moved,
                                        folder.file(".mine.part.exr", ""),
                                        folder.file("a.1-2-3.part", ""),
                                        folder.file(".a.1-2.part", ""),
                                        folder.file(".a.1-2-x.part", ""),
                                        folder.file(".a.1-2-3.party", ""),
                                        folder.file(".part", "")};
    write_file_atomically(folder / "x.exr", "new");
    for (const fs::path& file : gone) EXPECT_FALSE(fs::exists(file)) << file;
    for (const fs::path& file : stay) EXPECT_TRUE(fs::exists(file)) << file;
    EXPECT_EQ(entries(folder.path()), 1 + std::ptrdiff_t(stay.size()));
    alive.commit();
    EXPECT_EQ(read_file(other / "y.exr"), "alive");
}

TEST_F(AtomicFileTest, MissingFolderAndWrongKindAreOneLine) {
    const fs::path inside = folder / "no" / fs::path("x.exr");
    EXPECT_EQ(message_of<OutputError>([&] { AtomicFile file(inside); }),
              inside.string() + ": cannot be written: No such file or directory");
    EXPECT_EQ(message_of<OutputError>([&] { AtomicFile file(folder.path()); }),
              folder.path().string() + ": cannot be written: it is a folder");
    const fs::path pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(message_of<OutputError>([&] { AtomicFile file(pipe); }),
              pipe.string() + ": cannot be written: it is no regular file");
}

// What gzip and bzip2 packed.

std::string bzipped(std::string text) {
    unsigned size = unsigned(text.size()) + 1000;
    std::string packed(size, '\0');
    BZ2_bzBuffToBuffCompress(packed.data(), &size, text.data(), unsigned(text.size()), 9, 0, 0);
    packed.resize(size);
    return packed;
}

TEST(PackedFile, IsUnpackedWholeOrRefused) {
    std::string text;  // of more than one block
    for (int i = 0; text.size() < (std::size_t{9} << 20); ++i) text += std::to_string(i * 7919);
    const std::string packed = bzipped(text);
    EXPECT_EQ(unpacked(packed, "a"), text);
    EXPECT_EQ(unpacked(packed + bzipped("x") + bzipped(""), "a"), text + "x") << "as pbzip2 writes them";
    EXPECT_EQ(unpacked("BZ", "a"), "BZ");
    const std::string damaged = "a: expected a whole bzip2 file, found damaged data";
    EXPECT_EQ(ERROR_OF(unpacked(packed.substr(0, packed.size() / 2), "a")), damaged);
    EXPECT_EQ(ERROR_OF(unpacked("BZh", "a")), damaged);
    std::string wrong = packed;
    wrong[wrong.size() / 2] = char(wrong[wrong.size() / 2] ^ 4);
    EXPECT_EQ(ERROR_OF(unpacked(wrong, "a")), damaged);
}

TEST(PackedFile, ABombIsRefused) {
    const std::string zeros = bzipped(std::string(std::size_t{1} << 25, '\0'));
    std::string bomb;
    for (int i = 0; i < 100; ++i) bomb += zeros;
    EXPECT_EQ(ERROR_OF(unpacked(bomb, "a")),
              fmt::format("a: expected at most 200 times its {} bytes, found more "
                          "that bzip2 packed",
                          bomb.size()));
    EXPECT_HAS(ERROR_OF(unpacked(bomb, "a", {}, {.most_times = 30})), "a: expected at most 30 times its ");
    EXPECT_EQ(unpacked(bomb, "a", {}, {.enough = 5}).find_first_not_of('\0'), std::string::npos);
}

// The table of file formats: names, contents, and that its rows do not contradict each other.

std::string_view id_of(const FileFormat* format) { return format ? format->id : "none"; }

TEST(FileFormat, NamesInCapitalsOrNot) {
    for (const char* name :
         {"a.OBJ", "a.Toml", "A.FITS.GZ", "a.fits.fz", "a.fits.bz2", "b.TIF", "b.JPEG", "c.Splats"})
        EXPECT_NE(format_by_name(name), nullptr) << name;
    EXPECT_EQ(id_of(format_by_name("x.y.FITS.GZ")), "fits");
    EXPECT_EQ(id_of(format_by_name("a b.Exr")), "openexr");
    EXPECT_EQ(id_of(format_by_name("a.mp4")), "movie") << "which is written, and read by nothing";
    for (const char* name : {"a.txt", "a.null", "a.avi", "a.gz", "a", ".png", "png", ""})
        EXPECT_EQ(format_by_name(name), nullptr) << name;
}

TEST(FileFormat, ContentCountsMoreThanTheName) {
    const TempFolder folder;
    const std::string fits = "SIMPLE  =                    T";
    EXPECT_EQ(id_of(format_of_file(folder.file("a.dat", fits))), "fits");
    EXPECT_EQ(id_of(format_of_file(folder.file("a.png", "\xff\xd8\xff\xe0"))), "jpeg");
    EXPECT_EQ(id_of(format_of_file(folder.file("a.jpg", "RIFF\x10\x20\x30\x40WEBPVP8 "))), "webp");
    EXPECT_EQ(id_of(format_of_file(folder.file("a.wav", "RIFF\x10\x20\x30\x40WAVEfmt "))), "none");
    EXPECT_EQ(id_of(format_of_file(folder.file("b.tif", std::string("II*\0", 4)))), "tiff");
    EXPECT_EQ(id_of(format_of_file(folder.file("points", "ply\r\nformat"))), "ply");
    EXPECT_EQ(id_of(format_of_file(folder.file("c.png", "v 0 0 0"))), "png");  // whose reader says more
    EXPECT_EQ(id_of(format_of_file(folder.file("d.png", std::string("\0\0\0\x0cJXL \r\n\x87\n", 12)))),
              "jpegxl");
    EXPECT_EQ(id_of(format_of_file(folder / "missing.obj")), "obj");
}

TEST(FileFormat, RowsDoNotContradictEachOther) {
    std::set<std::string_view> endings, ids;
    for (const FileFormat& format : file_formats()) {
        EXPECT_TRUE(ids.insert(format.id).second) << format.id;
        ASSERT_FALSE(format.endings.empty()) << format.id;
        for (const auto& [ending, uses] : format.endings) {
            EXPECT_TRUE(endings.insert(ending).second) << ending;
            EXPECT_EQ(format_by_name("a" + std::string(ending)), &format) << ending;
        }
    }
}

TEST(FileFormat, ListsForDialogsAndMessages) {
    EXPECT_EQ(endings_of({FileKind::splats}),
              (std::vector<std::string>{".pda", ".ply", ".glb", ".gltf", ".usda", ".usd", ".spz", ".splat",
                                        ".sog", ".splats"}));
    EXPECT_EQ(endings_of({FileKind::splats}, FileUse::written),
              (std::vector<std::string>{".pda", ".ply", ".splats"}));
    EXPECT_EQ(endings_of({FileKind::picture}, FileUse::written),
              (std::vector<std::string>{".exr", ".tif", ".tiff", ".png"}));
    EXPECT_EQ(endings_of(FileUse::camera_written),
              (std::vector<std::string>{".chan", ".csv", ".gltf", ".usda"}));
    EXPECT_EQ(endings_of(FileUse::exported),
              (std::vector<std::string>{".ply", ".glb", ".usda", ".spz", ".vdb"}));
    EXPECT_EQ(endings_of(FileUse::movie).front(), ".mp4");
    EXPECT_EQ(names_of(FileKind::splats), "PDA, PLY, glTF, USD, SPZ, SPLAT, SOG or SPLATS");
    EXPECT_EQ(names_of(FileKind::mesh), "OBJ");
}

}  // namespace
}  // namespace astrosplat

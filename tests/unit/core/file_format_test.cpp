// The table of file formats: names, contents, and that its rows do not contradict each other.
#include "core/file_format.h"

#include <gtest/gtest.h>

#include <set>

#include "support/temp_folder.h"

namespace astrosplat {
namespace {

std::string_view id_of(const FileFormat* format) { return format ? format->id : "none"; }

TEST(FileFormat, NamesInCapitalsOrNot) {
    for (const char* name : {"a.OBJ", "a.Toml", "A.FITS.GZ", "a.fits.fz", "b.TIF", "b.JPEG", "c.Splats"})
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
              (std::vector<std::string>{".pda", ".ply", ".glb", ".gltf", ".usda", ".usd", ".splats"}));
    EXPECT_EQ(endings_of({FileKind::splats}, FileUse::written),
              (std::vector<std::string>{".pda", ".ply", ".splats"}));
    EXPECT_EQ(endings_of({FileKind::picture}, FileUse::written),
              (std::vector<std::string>{".exr", ".tif", ".tiff", ".png"}));
    EXPECT_EQ(endings_of(FileUse::camera_written),
              (std::vector<std::string>{".chan", ".csv", ".gltf", ".usda"}));
    EXPECT_EQ(endings_of(FileUse::exported), (std::vector<std::string>{".ply", ".glb", ".usda", ".vdb"}));
    EXPECT_EQ(endings_of(FileUse::movie).front(), ".mp4");
    EXPECT_EQ(names_of(FileKind::splats), "PDA, PLY, glTF, USD or SPLATS");
    EXPECT_EQ(names_of(FileKind::mesh), "OBJ");
}

}  // namespace
}  // namespace astrosplat

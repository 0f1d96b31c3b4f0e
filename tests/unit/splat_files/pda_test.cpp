// PDA: exact round trips, everything a header may look like, and one test for each thing that can be wrong.
#include "splat_files/formats.h"


#include <csignal>
#include <string>

#include "support/process_state.h"
#include "support/quiet.h"
#include "support/test_data.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

class Pda : public SplatFileTest {
  protected:
    SplatSet read(const std::string& text) { return read_pda(write("a.pda", text)); }
    std::string error(const std::string& text) {
        return error_of(write("a.pda", text), [](const auto& file) { read_pda(file); });
    }
    /// A file with one attribute beside position and one row.
    static std::string one(const std::string& attribute, const std::string& type, const std::string& value) {
        return "ATTRIBUTES\n position " + attribute + "\nTYPES\n V " + type +
               "\nNUMBER_OF_PARTICLES: 1\nBEGIN DATA\n1 2 3 " + value + "\n";
    }
    static std::string positions(const std::string& count, const std::string& rows) {
        return "ATTRIBUTES\n position\nTYPES\n V\nNUMBER_OF_PARTICLES: " + count + "\nBEGIN DATA\n" + rows;
    }
};

TEST_F(Pda, WritesWhatMayaReads) {
    SplatSet set;
    set.position.push_back({0.1f, -0.0f, 1e-5f});
    set.color.push_back({1.0f, 0.5f, 16777216.0f});
    set.alpha.push_back(0.25f);
    set.distance.push_back(0.0f);
    set.id.push_back(~0ull);
    set.mesh.push_back(2);
    write_pda(path("a.pda"), set);
    EXPECT_EQ(bytes_of(path("a.pda")),
              "ATTRIBUTES\n position rgbPP opacityPP DistanceFromSurfaceMeshPP whichMeshPP particleId\n"
              "TYPES\n V V R R I I\nNUMBER_OF_PARTICLES: 1\nBEGIN DATA\n"
              "0.1 -0 1e-05 1 0.5 16777216 0.25 0 2 18446744073709551615\n");
}

TEST_F(Pda, EveryBitSurvives) {
    const SplatSet set = awkward_set(50000);
    write_pda(path("a.pda"), set);
    const SplatSet got = read_pda(path("a.pda"));
    expect_same_splats(got, set);
    EXPECT_TRUE(got.uv.empty());
    EXPECT_TRUE(got.normal.empty());
    EXPECT_FALSE(got.generated);
}

TEST_F(Pda, ParticleIdCountsMoreThanId) {
    const std::string rows = "\nNUMBER_OF_PARTICLES: 1\nBEGIN DATA\n0 0 0 5 7\n";
    EXPECT_EQ(read("ATTRIBUTES\n position id particleId\nTYPES\n V I I" + rows).id[0], 7u);
    EXPECT_EQ(read("ATTRIBUTES\n position particleId id\nTYPES\n V I I" + rows).id[0], 5u);
    EXPECT_EQ(read("ATTRIBUTES\n position other id\nTYPES\n V I I" + rows).id[0], 7u);
    EXPECT_EQ(read(one("id", "R", "5.0")).id[0], 5u);
}

TEST_F(Pda, EmptySetSurvives) {
    write_pda(path("a.pda"), SplatSet{});
    EXPECT_EQ(read_pda(path("a.pda")).size(), 0);
}

TEST_F(Pda, LocaleDoesNotMatter) {
    const SplatSet set = awkward_set(2000);
    write_pda(path("plain.pda"), set);
    {
        const CommaLocale locale;
        write_pda(path("comma.pda"), set);
        expect_same_splats(read_pda(path("plain.pda")), set);
    }
    EXPECT_EQ(bytes_of(path("comma.pda")), bytes_of(path("plain.pda")));
}

TEST_F(Pda, AttributesInAnyOrderAndOthersSkippedByType) {
    const SplatSet set = read(
        "ATTRIBUTES\n particleId velocity opacityPP rgbPP lifespan whichMeshPP event position radiusPP "
        "DistanceFromSurfaceMeshPP\nTYPES\n I V R V R R I V R R\nNUMBER_OF_PARTICLES: 2\nBEGIN DATA\n"
        "9007199254740993 7 7 7 0.5 1 2 3 nan 4 8 10 20 30 0.75 0.125\n"
        "3 7 7 7 1 1 2 3 9 5 8 11 21 31 0.5 0.25\n");
    ASSERT_EQ(set.size(), 2);
    EXPECT_EQ(set.id[0], 9007199254740993u);
    EXPECT_EQ(set.alpha[0], 0.5f);
    EXPECT_EQ(set.color[0], glm::vec3(1, 2, 3));
    EXPECT_EQ(set.mesh[1], 5u);
    EXPECT_EQ(set.position[1], glm::vec3(11, 21, 31));
    EXPECT_EQ(set.radius[0], 0.75f);
    EXPECT_EQ(set.distance[0], 0.125f);
    EXPECT_EQ(set.max_distance, 0.25);
}

TEST_F(Pda, WhatAFileLacksHasDefaults) {
    const SplatSet set = read(positions("2", "1 2 3\n4 5 6\n"));
    EXPECT_EQ(set.color[1], glm::vec3(1.0f));
    EXPECT_EQ(set.alpha[1], 1.0f);
    EXPECT_EQ(set.distance[1], 0.0f);
    EXPECT_EQ(set.id[0], 0u);
    EXPECT_EQ(set.id[1], 1u);
    EXPECT_TRUE(set.radius.empty());
    EXPECT_TRUE(set.mesh.empty());
    EXPECT_EQ(set.spacing, glm::dvec3(0.0));
}

TEST_F(Pda, BlanksAndLineEndsOfAllKinds) {
    const SplatSet set = read(
        "\xef\xbb\xbf"
        "ATTRIBUTES \r\n\tposition\r\n id \r\nTYPES\r\n V I\r\nNUMBER_OF_PARTICLES : 2\r\nBEGIN DATA\r\n"
        "\r\n  1\t2  +3 7\t\r\n \t\r\n4e0 5.E+1 .6e-1 8");
    ASSERT_EQ(set.size(), 2);
    EXPECT_EQ(set.position[0], glm::vec3(1, 2, 3));
    EXPECT_EQ(set.position[1], glm::vec3(4, 50, 0.06f));
    EXPECT_EQ(set.id[1], 8u);
    EXPECT_EQ(read("ATTRIBUTES\nposition\nTYPES\nV\nNUMBER_OF_PARTICLES 1\nBEGIN DATA\n1 2 3").size(), 1);
    EXPECT_EQ(read("ATTRIBUTES\nposition\nTYPES\nV\nNUMBER_OF_PARTICLES:1\nBEGIN DATA\n1 2 3").size(), 1);
    EXPECT_EQ(read(positions("0", "")).size(), 0);
}

TEST_F(Pda, OpacityIsClampedWithAWarning) {
    const Said said;
    const SplatSet set = read(
        "ATTRIBUTES position opacityPP TYPES V R NUMBER_OF_PARTICLES: 3\nBEGIN DATA\n"
        "0 0 0 1.5\n0 0 0 -1\n0 0 0 0.5\n");
    EXPECT_EQ(set.alpha[0], 1.0f);
    EXPECT_EQ(set.alpha[1], 0.0f);
    EXPECT_EQ(set.alpha[2], 0.5f);
    EXPECT_NE(said.text().find("2 of 3 opacities lie outside 0..1"), std::string::npos) << said.text();
}

TEST_F(Pda, RealFiles) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(circle, "particles/circle.00001.pda");
    const SplatSet set = read_pda(circle);
    ASSERT_EQ(set.size(), 30);
    EXPECT_EQ(set.position[1], glm::vec3(0.207912f, 0.0f, 0.978148f));
    for (const glm::vec3& p : set.position) EXPECT_NEAR(p.x * p.x + p.z * p.z, 1.0f, 1e-5f);
    EXPECT_EQ(set.id[29], 29u);
    ASTROSPLAT_TEST_DATA_OR_SKIP(test, "particles/test.pda");
    EXPECT_EQ(error_of(test, [](const auto& file) { read_pda(file); }),
              "test.pda:7: expected 5 numbers (position life id), found 6");
}

TEST_F(Pda, WrongHeaders) {
    EXPECT_EQ(error(""), "a.pda:1: expected 'ATTRIBUTES', found the end of the file");
    EXPECT_EQ(error("v 0 0 0\n"), "a.pda:1: expected 'ATTRIBUTES', found 'v'");
    EXPECT_EQ(error(std::string("\x89PNG\r\n\0", 7)), "a.pda:1: expected 'ATTRIBUTES', found '\\x89PNG'");
    EXPECT_EQ(error("ATTRIBUTES\n position\n"), "a.pda:3: expected 'TYPES', found the end of the file");
    EXPECT_EQ(error("ATTRIBUTES\n position\nTYPES\n V\n"),
              "a.pda:5: expected 'NUMBER_OF_PARTICLES:', found the end of the file");
    EXPECT_EQ(error("ATTRIBUTES\n position\nTYPES\n Q\n"),
              "a.pda:4: expected type I, R or V of attribute position, found 'Q'");
    EXPECT_EQ(error("ATTRIBUTES\n position\nTYPES\n R\n"),
              "a.pda:4: expected type V of attribute position, found 'R'");
    EXPECT_EQ(error("ATTRIBUTES\n position life\nTYPES\n V\nNUMBER_OF_PARTICLES: 1\n"),
              "a.pda:5: expected type I, R or V of attribute life, found 'NUMBER_OF_PARTICLES:'");
    EXPECT_EQ(error("ATTRIBUTES\n life life\nTYPES\n"),
              "a.pda:2: expected each attribute once, found 'life'");
    EXPECT_EQ(error("ATTRIBUTES\n life\nTYPES\n R\n"),
              "a.pda:4: expected an attribute position, found 'none'");
    EXPECT_EQ(error("ATTRIBUTES\n position\nTYPES\n V\nNUMBER_OF_PARTICLES: 1\nBEGIN DATA 1 2 3\n"),
              "a.pda:6: expected nothing behind 'BEGIN DATA' on its line, found '1'");
    EXPECT_EQ(error("ATTRIBUTES\n position\nTYPES\n V\nNUMBER_OF_PARTICLES: 1\nDATA\n"),
              "a.pda:6: expected 'BEGIN', found 'DATA'");
}

TEST_F(Pda, WrongCounts) {
    EXPECT_EQ(error(positions("-3", "1 2 3\n")), "a.pda:5: expected a number of particles, found '-3'");
    EXPECT_EQ(error(positions("3x", "1 2 3\n")), "a.pda:5: expected a number of particles, found '3x'");
    EXPECT_EQ(error(positions("1000000000000000000", "1 2 3\n")),
              "a.pda: expected 1000000000000000000 rows, as NUMBER_OF_PARTICLES says, found 1");
    EXPECT_EQ(error(positions("99999999999999999999", "1 2 3\n")),
              "a.pda:5: expected a number of particles, found '99999999999999999999'");
    EXPECT_EQ(error(positions("3", "1 2 3\n1 2")),
              "a.pda: expected 3 rows, as NUMBER_OF_PARTICLES says, found 2");
    EXPECT_EQ(error(positions("1", "1 2 3\n1 2 3\n")),
              "a.pda: expected 1 rows, as NUMBER_OF_PARTICLES says, found 2");
}

TEST_F(Pda, WrongRows) {
    EXPECT_EQ(error(positions("2", "1 2 3\n1 2")), "a.pda:8: expected 3 numbers (position), found 2");
    EXPECT_EQ(error(positions("2", "\n1 2 3 4\n1 2\n")), "a.pda:8: expected 3 numbers (position), found 4");
    EXPECT_EQ(error(positions("1", "1 two 3\n")),
              "a.pda:7: expected a finite number for position, found 'two'");
    EXPECT_EQ(error(positions("1", "1 2,5 3\n")),
              "a.pda:7: expected a finite number for position, found '2,5'");
    EXPECT_EQ(error(positions("1", "1 nan 3\n")),
              "a.pda:7: expected a finite number for position, found 'nan'");
    EXPECT_EQ(error(positions("1", "1 -inf 3\n")),
              "a.pda:7: expected a finite number for position, found '-inf'");
    EXPECT_EQ(error(positions("1", "1 1e39 3\n")),
              "a.pda:7: expected a finite number for position, found '1e39'");
    EXPECT_EQ(error(one("opacityPP", "R", "nan")),
              "a.pda:7: expected a finite number for opacityPP, found 'nan'");
    EXPECT_EQ(error(one("radiusPP", "R", "-1")),
              "a.pda:7: expected a finite number >= 0 for radiusPP, found '-1'");
    EXPECT_EQ(error(one("DistanceFromSurfaceMeshPP", "R", "-1")),
              "a.pda:7: expected a finite number >= 0 for DistanceFromSurfaceMeshPP, found '-1'");
    EXPECT_EQ(error(one("particleId", "I", "-1")),
              "a.pda:7: expected a whole number >= 0 for particleId, found '-1'");
    EXPECT_EQ(error(one("particleId", "I", "1.5")),
              "a.pda:7: expected a whole number >= 0 for particleId, found '1.5'");
    EXPECT_EQ(error(one("whichMeshPP", "I", "4294967296")),
              "a.pda:7: expected a whole number >= 0 and < 2^32 for whichMeshPP, found '4294967296'");
}

TEST_F(Pda, TheFirstBadRowIsNamedWhateverTheThreads) {
    std::string rows;
    for (int i = 0; i < 300000; ++i) rows += i == 200000 || i == 290000 ? "1 2\n" : "1.5 2.5 3.5\n";
    for (const int threads : {1, 4}) {
        set_thread_count(threads);
        EXPECT_EQ(error(positions("300000", rows)), "a.pda:200007: expected 3 numbers (position), found 2");
    }
}

TEST_F(Pda, EveryTruncationIsAnErrorOrTheSameRows) {
    write_pda(path("whole.pda"), awkward_set(4));
    const std::string whole = bytes_of(path("whole.pda"));
    for (std::size_t size = 0; size + 21 < whole.size();
         ++size)  // a cut inside the last id cannot be noticed
        EXPECT_NE(error(whole.substr(0, size)), "") << size;
}

TEST_F(Pda, MissingFileFolderAndReadOnlyTarget) {
    const auto read = [](const auto& file) { read_pda(file); };
    EXPECT_EQ(error_of(path("none.pda"), read), "none.pda: cannot be read: No such file or directory");
    std::filesystem::create_directories(path("folder.pda"));
    EXPECT_EQ(error_of(path("folder.pda"), read), "folder.pda: cannot be read: it is a folder");
    EXPECT_THROW(write_pda(path("no such folder") / "a.pda", awkward_set(1)), OutputError);
}

TEST_F(Pda, CancelLeavesNothing) {
    std::atomic<bool> stop{true};
    Progress progress;
    progress.cancelled = &stop;
    EXPECT_THROW(write_pda(path("a.pda"), awkward_set(10), progress), Cancelled);
    EXPECT_TRUE(std::filesystem::is_empty(path("a.pda").parent_path()));
}

TEST_F(Pda, CancelInTheMiddleLeavesNothing) {
    const SplatSet set = awkward_set(200000);
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        std::atomic<bool> stop{false};
        Progress progress;
        progress.cancelled = &stop;
        progress.report = [&](double fraction) { stop = fraction > 0.3; };
        EXPECT_THROW(write_pda(path("a.pda"), set, progress), Cancelled);
        EXPECT_TRUE(std::filesystem::is_empty(path("a.pda").parent_path()));
    }
}

TEST_F(Pda, AFullDiskIsOneErrorAndLeavesNothing) {
    const SplatSet set = awkward_set(200000);
    const FileLimit full(8 << 20);
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        EXPECT_THROW(write_pda(path("a.pda"), set), OutputError);
        EXPECT_TRUE(std::filesystem::is_empty(path("a.pda").parent_path()));
    }
}

}  // namespace
}  // namespace astrosplat

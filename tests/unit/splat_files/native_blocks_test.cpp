// Native files block by block: the rows that the whole file has, damage found where it is asked for, and a
// sample that is some of them.

#include <algorithm>

#include "splat_files/native.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

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
    EXPECT_NE(error.find("block 1: expected the checksum written with it"), std::string::npos) << error;
}

TEST_F(NativeBlocksTest, AFileThatIsCutShortIsSaid) {
    const NativeBlocks file(path("a.splats"));
    std::filesystem::resize_file(path("a.splats"), 1000);
    SplatSet block;
    const std::string error =
        error_of(path("a.splats"), [&](const auto&) { file.read(2, all, NativeBlocks::Check::none, block); });
    EXPECT_NE(error.find("it became shorter while it was read"), std::string::npos) << error;
}

TEST_F(NativeBlocksTest, ASampleIsSomeOfTheRows) {
    const SplatSet whole = read_native(path("a.splats"), {}, all);
    const SplatSet sample = NativeBlocks(path("a.splats")).sample(638);
    check_consistent(sample);
    EXPECT_GT(sample.size(), 630);
    EXPECT_LE(sample.size(), 640);
    for (std::size_t i = 0; i < sample.id.size(); ++i) {
        const auto row =
            static_cast<std::size_t>(std::ranges::find(whole.id, sample.id[i]) - whole.id.begin());
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

}  // namespace
}  // namespace astrosplat

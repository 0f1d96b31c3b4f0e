// Native files: every field survives, damage anywhere is found, blocks are small regions; and the front door
// with conversions between all formats.
#include "splat_files/native.h"

#include "core/hash.h"
#include "splat_files/splat_file.h"
#include "splats/row_order.h"
#include "splats/splat_set.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

class Native : public SplatFileTest {
  protected:
    std::string error(const std::string& bytes) {
        return error_of(write("a.splats", bytes), [](const auto& file) { read_native(file); });
    }
};

SplatSet full_set(std::uint32_t rows) {
    SplatSet set = awkward_set(rows);
    set.spacing = {0.1, 0.25, 1e-300};
    set.max_distance = 0.7;
    set.generated = true;
    set.divided = true;
    set.absorbs = true;
    set.test_positions = 1ll << 40;
    set.zero_alpha = 12;
    set.credit = "ESA/Hubble & NASA, \xc3\xa9 \n second line";
    return set;
}

/// Replaces the bytes at `at` of a valid file's header and makes the header's checksum fit again.
template <class T>
std::string forged(std::string bytes, std::size_t at, T value, std::size_t header_end = 128) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
    const std::uint64_t checksum = xxh64(std::string_view(bytes).substr(0, header_end - 8));
    std::memcpy(bytes.data() + header_end - 8, &checksum, sizeof checksum);
    return bytes;
}

/// A valid file of one block with another lower bound in its table, and the table's checksum made to fit.
std::string with_bounds(std::string bytes, float lo) {
    constexpr std::size_t entry = 32, checksum = 8;
    const std::size_t table = bytes.size() - checksum - entry;
    std::memcpy(bytes.data() + table, &lo, sizeof lo);
    const std::uint64_t sum = xxh64(std::string_view(bytes).substr(table, entry));
    std::memcpy(bytes.data() + table + entry, &sum, sizeof sum);
    return bytes;
}

TEST_F(Native, EverythingSurvives) {
    const SplatSet set = full_set(200000);  // three blocks and a part
    write_native(path("a.splats"), set);
    SplatSet got = read_native(path("a.splats"));
    sort_by_id(got);
    expect_same_set(got, set);
}

TEST_F(Native, RecipeAndOriginSurviveBesideTheCredit) {
    SplatSet set = full_set(10);
    for (int texts = 0; texts < 8; ++texts) {
        set.credit = texts & 1 ? "ESA" : "", set.recipe = texts & 2 ? "set 1\nseed 3\n" : "";
        set.origin = texts & 4 ? "measured: light" : "";
        write_native(path("a.splats"), set, {}, RowOrder::id);
        const SplatSet got = read_native(path("a.splats"));
        EXPECT_EQ(got.credit, set.credit);
        EXPECT_EQ(got.origin, set.origin);
        EXPECT_EQ(got.recipe, set.recipe);
        EXPECT_EQ(std::int64_t(fs::file_size(path("a.splats"))), native_file_bytes(set));
    }
}

TEST_F(Native, OptionalArraysStayUnknown) {
    for (int present = 0; present < 16; ++present) {
        SplatSet set = full_set(100);
        if (!(present & 1)) set.uv.clear();
        if (!(present & 2)) set.normal.clear();
        if (!(present & 4)) set.mesh.clear();
        if (!(present & 8)) set.radius.clear();
        set.generated = present & 1;
        set.divided = present & 2;
        set.absorbs = present & 4;
        write_native(path("a.splats"), set);
        SplatSet got = read_native(path("a.splats"));
        sort_by_id(got);
        expect_same_set(got, set);
    }
}

TEST_F(Native, ColumnsThatAreNotWantedStayEmpty) {
    const SplatSet set = full_set(70000);  // a block and a part
    write_native(path("a.splats"), set, {}, RowOrder::id);
    for (int without = 0; without < 8; ++without) {
        const OptionalColumns wanted{(without & 1) == 0, (without & 2) == 0, (without & 4) == 0};
        SplatSet expected = set;
        drop_columns(expected, wanted);
        EXPECT_EQ(expected.uv.empty(), !wanted.uv);
        EXPECT_EQ(expected.normal.empty(), !wanted.normal);
        EXPECT_EQ(expected.mesh.empty(), !wanted.mesh);
        expect_same_set(read_native(path("a.splats"), {}, wanted), expected);
    }
}

TEST_F(Native, PartsOfASetTogetherAreTheSet) {
    SplatSet set = full_set(70000);
    std::ranges::sort(set.id);
    set.face.assign(set.position.size(), 9);
    std::fill_n(set.alpha.begin(), 30, 0.0f);
    write_native(path("g.splats"), set, {}, RowOrder::id, NativePart::geometry);
    write_native(path("c.splats"), set, {}, RowOrder::id, NativePart::colors);
    for (const auto& [file, part] :
         {std::pair{"g.splats", NativePart::geometry}, {"c.splats", NativePart::colors}})
        EXPECT_EQ(fs::file_size(path(file)), static_cast<std::uintmax_t>(native_file_bytes(set, part)));
    SplatSet got = read_native(path("g.splats"), {}, {true, true, true, true}, NativePart::geometry);
    EXPECT_TRUE(got.color.empty() && got.alpha.empty());
    SplatSet colors = read_native(path("c.splats"), {}, {}, NativePart::colors);
    EXPECT_TRUE(colors.position.empty() && colors.id.empty() && colors.uv.empty());
    got.color = std::move(colors.color);
    got.alpha = std::move(colors.alpha);
    expect_same_set(got, set);
    EXPECT_TRUE(same_bits(got.face, set.face));
    EXPECT_EQ(native_splat_count(path("g.splats")), 70000);
    EXPECT_EQ(native_splat_count(path("c.splats")), 70000 - std::ranges::count(set.alpha, 0.0f));
}

TEST_F(Native, RowsAreThoseOfTheWhole) {
    SplatSet set = full_set(150000);  // three blocks
    std::ranges::sort(set.id);
    for (std::size_t i = 0; i < set.alpha.size(); ++i)
        set.alpha[i] = i % 3 == 0 || i / 70000 == 1 ? 0.0f : 0.5f;
    for (const NativePart part : {NativePart::geometry, NativePart::colors, NativePart::whole})
        write_native(path(std::to_string(int(part))), set, {}, RowOrder::id, part);
    const auto file = [&](NativePart part) { return path(std::to_string(int(part))); };
    const LitRows lit = native_lit_rows(file(NativePart::colors));
    EXPECT_EQ(lit.of, 150000);
    ASSERT_EQ(std::int64_t(lit.rows.size()), native_splat_count(file(NativePart::colors)));
    for (const std::int64_t row : lit.rows) ASSERT_GT(set.alpha[row], 0.0f);
    const Buffer<std::int64_t> few = {0, 65535, 65536, 149999}, none;
    const NativeRows choices[] = {{lit.rows, {}}, {few, {false, true, false}}, {none, {}}};
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        const std::vector<SplatSet> got =
            read_native_rows(file(NativePart::whole), NativePart::whole, choices);
        ASSERT_EQ(got.size(), 3u);
        expect_same_set(got[0], take_rows(set, lit.rows));
        SplatSet expected = take_rows(set, few);
        drop_columns(expected, {false, true, false});
        expect_same_set(got[1], expected);
        EXPECT_EQ(got[2].size(), 0);
        const auto colors = read_native_rows(file(NativePart::colors), NativePart::colors, choices);
        EXPECT_TRUE(same_bits(colors[1].alpha, expected.alpha));
        EXPECT_TRUE(colors[1].position.empty());
    }
    const Buffer<std::int64_t> beyond = {150000};
    EXPECT_EQ(error_of(file(NativePart::whole),
                       [&](const auto& f) {
                           read_native_rows(f, NativePart::whole, std::array{NativeRows{beyond, {}}});
                       }),
              "0:header: expected more than 150000 splats, found 150000");
}

TEST_F(Native, APartIsNotTakenForASet) {
    write_native(path("a.splats"), full_set(5), {}, RowOrder::id, NativePart::geometry);
    EXPECT_EQ(error_of(path("a.splats"), [](const auto& file) { read_native(file); }),
              "a.splats:header: expected a whole set, found the geometry of a set, from a cache");
    EXPECT_EQ(
        error_of(path("a.splats"), [](const auto& file) { read_native(file, {}, {}, NativePart::colors); }),
        "a.splats:header: expected the colours of a set, from a cache, found the geometry of a set, from a "
        "cache");
}

TEST_F(Native, EmptySetSurvives) {
    write_native(path("a.splats"), full_set(0));
    expect_same_set(read_native(path("a.splats")), full_set(0));
}

TEST_F(Native, TheOrderOfTheSetDoesNotChangeBytes) {
    SplatSet set = full_set(150000);
    write_native(path("one.splats"), set);
    const SplatSet shuffled = read_native(path("one.splats"));
    write_native(path("five.splats"), shuffled);
    EXPECT_EQ(bytes_of(path("one.splats")), bytes_of(path("five.splats")));
}

TEST_F(Native, RowsByIdNeedNoSorting) {
    SplatSet set = full_set(200000);
    std::sort(set.id.begin(), set.id.end());
    write_native(path("a.splats"), set, {}, RowOrder::id);
    expect_same_set(read_native(path("a.splats")), set);
    EXPECT_EQ(native_file_bytes(set), std::int64_t(bytes_of(path("a.splats")).size()));
    EXPECT_EQ(native_splat_count(path("a.splats")), 200000);
}

TEST_F(Native, RowsThatBelieTheirOrderAreRefused) {
    SplatSet set = full_set(2);
    set.position[0] = glm::vec3(0.0f);
    set.position[1] = glm::vec3(1.0f);  // behind the other in space
    set.id[0] = 7;
    set.id[1] = 6;
    write_native(path("a.splats"), set);
    const std::string bytes = bytes_of(path("a.splats"));
    EXPECT_EQ(error(bytes), "");
    EXPECT_EQ(error(forged(bytes, 12, 0x7fu)),
              "a.splats: expected ids in ascending order, found another order");
}

TEST_F(Native, NeighboursShareBlocks) {
    SplatSet set;
    constexpr int side = 64;
    for (std::uint32_t i = 0; i < side * side * side; ++i) {
        set.position.push_back({float(i % side), float(i / side % side), float(i / side / side)});
        set.id.push_back(i);
    }
    const auto order = spatial_order<std::uint32_t>(set);
    for (std::size_t block = 0; block < 64; ++block) {  // 4096 rows: a cube of 16 along the Morton curve
        Bounds box;
        for (std::size_t i = block * 4096; i < (block + 1) * 4096; ++i)
            box.add(glm::dvec3(set.position[order[i]]));
        EXPECT_EQ(box.extent(), glm::dvec3(15.0));
    }
    const auto wide = spatial_order<std::uint64_t>(set);
    EXPECT_TRUE(std::equal(order.begin(), order.end(), wide.begin(), wide.end()));
    Buffer<std::uint32_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);
}

TEST_F(Native, OneCellKeepsTheOrderOfIds) {
    SplatSet set;
    for (const std::uint64_t id : {5u, 3u, 9u, 3u}) {
        set.position.push_back(glm::vec3(1.0f));
        set.id.push_back(id);
    }
    const auto order = spatial_order<std::uint32_t>(set);
    EXPECT_EQ(std::vector(order.begin(), order.end()), (std::vector<std::uint32_t>{1, 3, 0, 2}));
    const auto wide = spatial_order<std::uint64_t>(set);
    EXPECT_EQ(std::vector(wide.begin(), wide.end()), (std::vector<std::uint64_t>{1, 3, 0, 2}));
}

TEST(Checksum, PublishedValues) {
    EXPECT_EQ(xxh64(""), 0xef46db3751d8e999u);
    EXPECT_EQ(xxh64("a"), 0xd24ec4f1a98c6e5bu);
    EXPECT_EQ(xxh64("abc"), 0x44bc2cf5ad770999u);
    EXPECT_EQ(xxh64("Nobody inspects the spammish repetition"), 0xfbcea83c8a378bf1u);
}

TEST_F(Native, EveryDamagedByteAndEveryTruncationIsFound) {
    write_native(path("whole.splats"), full_set(20));
    const std::string whole = bytes_of(path("whole.splats"));
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string damaged = whole;
        damaged[at] = char(damaged[at] ^ 0x10);
        EXPECT_NE(error(damaged), "") << at;
        EXPECT_NE(error(whole.substr(0, at)), "") << at;
    }
    EXPECT_NE(error(whole + "x"), "");
}

TEST_F(Native, Messages) {
    write_native(path("whole.splats"), full_set(2));
    const std::string whole = bytes_of(path("whole.splats"));
    const std::string size = std::to_string(whole.size());
    EXPECT_EQ(forged(whole, 8, 1u), whole);  // the header ends where forged() believes
    EXPECT_EQ(error(""), "a.splats: expected an astrosplat .splats file, found another format");
    EXPECT_EQ(error("ply" + whole.substr(3)),
              "a.splats: expected an astrosplat .splats file, found another format");
    EXPECT_EQ(error(forged(whole, 8, 2u)), "a.splats:header: expected version 1, found 2");
    EXPECT_EQ(error(forged(whole, 12, 0x20000u)), "a.splats:header: expected known flags, found 0x20000");
    EXPECT_EQ(error(forged(whole, 12, 0x1000u)),
              "a.splats:header: expected scale, rotation and radius together, found 0x1000");
    EXPECT_EQ(error(forged(whole, 12, 0xc00u)), "a.splats:header: expected known flags, found 0xc00");
    std::uint32_t flags;
    std::memcpy(&flags, &whole[12], sizeof flags);
    EXPECT_EQ(error(forged(whole, 12, flags | 0x80u)),
              "a.splats:header: expected a zero between credit and recipe, found none");
    EXPECT_EQ(error(forged(whole, 12, flags | 0x10000u)),
              "a.splats:header: expected a zero between credit and origin, found none");
    EXPECT_EQ(error(forged(whole, 24, 0u)),
              "a.splats:header: expected blocks of at least one splat, found 0");
    for (const std::uint64_t count :
         {std::uint64_t{1000000000000000000}, ~std::uint64_t{0}, std::uint64_t{3}})
        EXPECT_EQ(error(forged(whole, 16, count)), "a.splats: expected the length that " +
                                                       std::to_string(count) + " splats take, found " + size +
                                                       " bytes (truncated or damaged file)");
    EXPECT_EQ(error(forged(whole, 32, std::nan(""))),
              "a.splats:header: expected spacing and max_distance finite and >= 0, found another value");
    EXPECT_EQ(error(forged(whole, 64, std::int64_t{-1})),
              "a.splats:header: expected counts of positions >= 0, found a negative count");
    std::string damaged = whole;
    damaged[90] ^= 1;
    EXPECT_EQ(error(damaged),
              "a.splats:header: expected the checksum written with it, found another (damaged file)");
    damaged = whole;
    damaged[200] ^= 1;
    EXPECT_EQ(error(damaged),
              "a.splats:block 0: expected the checksum written with it, found another (damaged file)");
    EXPECT_EQ(error(with_bounds(whole, -9.0f)),
              "a.splats:block 0: expected positions within its bounds, found others");
    damaged = whole;
    damaged[whole.size() - 20] ^= 1;
    EXPECT_EQ(error(damaged),
              "a.splats:table: expected the checksum written with it, found another (damaged file)");
}

TEST_F(Native, NumbersThatAreNotFiniteAreRefused) {
    SplatSet set = full_set(2);
    set.uv[1].x = INFINITY;
    write_native(path("a.splats"), set);
    EXPECT_EQ(error(bytes_of(path("a.splats"))),
              "a.splats:block 0: expected finite numbers, found infinity or NaN");
}

using SplatFile = SplatFileTest;

TEST_F(SplatFile, UnknownEndingsNameTheKnownOnes) {
    const std::string read = known_endings(FileUse::read);
    EXPECT_HAS(read, ".pda .ply .glb .gltf .usda .usd");
    EXPECT_EQ(error_of(write("a.other", "x"), [](const auto& file) { read_splats(file); }),
              "a.other: expected one of the endings " + read + ", found .other");
    EXPECT_EQ(error_of(path("a.other"), [](const auto& file) { write_splats(file, SplatSet{}); }),
              "a.other: expected one of the endings " + known_endings(FileUse::written) + ", found .other");
    EXPECT_EQ(error_of(write("a", "x"), [](const auto& file) { read_splats(file); }),
              "a: expected one of the endings " + read + ", found none");
    EXPECT_EQ(error_of(path("none.other"), [](const auto& file) { read_splats(file); }),
              "none.other: cannot be read: No such file or directory");
}

TEST_F(SplatFile, ContentCountsMoreThanTheName) {
    for (const char* ending : {"pda", "ply", "splats"}) {
        write_splats(path(std::string("a.") + ending), awkward_set(5));
        fs::copy_file(path(std::string("a.") + ending), path(std::string("copy of ") + ending));
        EXPECT_EQ(read_splats(path(std::string("copy of ") + ending)).size(), 5);
    }
}

TEST_F(SplatFile, AttributesAreThoseOfTheFile) {
    using Names = std::vector<std::string>;
    EXPECT_EQ(splat_attributes(write("a.ply",
                                     "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty "
                                     "float y\nproperty float z\nproperty uchar red\nend_header\n")),
              (Names{"position"}));
    EXPECT_EQ(splat_attributes(write(
                  "a.pda", "ATTRIBUTES position opacityPP TYPES V R NUMBER_OF_PARTICLES: 0 BEGIN DATA\n")),
              (Names{"position", "alpha"}));
    SplatSet set = awkward_set(3);
    for (const char* name : {"b.pda", "b.ply", "b.splats"}) {
        write_splats(path(name), set);
        Names expected{"position", "color", "alpha", "distance", "radius", "uv", "normal", "mesh", "id"};
        if (std::string(name) != "b.splats") std::erase(expected, "normal");
        if (std::string(name) == "b.pda") std::erase(expected, "uv");
        EXPECT_EQ(splat_attributes(path(name)), expected) << name;
    }
    set.radius.clear();
    write_splats(path("c.splats"), set);
    const Names names = splat_attributes(path("c.splats"));
    EXPECT_EQ(std::count(names.begin(), names.end(), "radius"), 0);
}

TEST_F(SplatFile, ConversionsKeepEveryBit) {
    const SplatSet set = awkward_set(3000);
    const char* names[] = {"a.pda", "a.ply", "a.SPLATS"};
    for (const char* from : names) {
        write_splats(path(from), set);
        for (const char* to : names) {
            const fs::path target = path(std::string("to_") + to);
            write_splats(target, read_splats(path(from)));
            SplatSet got = read_splats(target);
            sort_by_id(got);
            expect_same_splats(got, set);
        }
    }
}

}  // namespace
}  // namespace astrosplat

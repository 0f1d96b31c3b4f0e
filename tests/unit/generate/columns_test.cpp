// Columns of a set, written in parts and read again, and the runs that are kept of it.
#include "generate/generate.h"
#include "generate/kept_store.h"
#include "source/textured_mesh.h"
#include "splat_files/native.h"
#include "support/test.h"
#include "unit/generate/generate_support.h"

namespace astrosplat {
namespace {

// Pictures read again into columns that are there: the bits of a generation, and nothing lost that was dark.

/// Stripes of another colour, of which every n-th is transparent.
Texture stripes(std::int64_t n, TextureSettings::Filter filter) {
    Texture texture;
    texture.image = make_image(32, 16, 4);
    for (std::int64_t y = 0; y < 16; ++y)
        for (std::int64_t x = 0; x < 32; ++x) {
            float* const p = texture.image.at(x, y);
            p[3] = x % n == 0 ? 0.0f : 0.5f + 0.01f * float(y);
            for (int c = 0; c < 3; ++c) p[c] = p[3] * float(x + c) / 64.0f;
        }
    texture.filter = filter;
    texture.credit = "of " + std::to_string(n);
    texture.divided = n > 2;
    return texture;
}

class ColumnsTest : public testing::Test {
  protected:
    ~ColumnsTest() override { set_thread_count(0); }

    static std::vector<TexturedMesh> meshes(const Texture& texture, bool with_camera) {
        std::vector<TexturedMesh> made = {test::textured(builtin_mesh("sphere", 1.0), texture),
                                          test::textured(builtin_mesh("plane", 2.0), texture)};
        if (!with_camera) return made;
        UvCamera params;
        params.position = glm::dvec3(0.0, 1.0, 2.0);  // much lies behind it
        for (TexturedMesh& m : made) {
            m.camera = picture_camera(params, 2.0);
            apply_camera_uv(m.mesh, *m.camera);
        }
        return made;
    }
};

TEST_F(ColumnsTest, OtherPicturesGiveTheBitsOfAGeneration) {
    using Filter = TextureSettings::Filter;
    const Lattice lattice{{glm::dvec3(-5.5), glm::dvec3(5.5)}, glm::i64vec3(30, 20, 25)};
    for (const bool with_camera : {false, true}) {
        const auto first = meshes(stripes(2, Filter::nearest), with_camera),
                   second = meshes(stripes(5, Filter::area), with_camera);
        for (const int threads : {1, 3}) {
            set_thread_count(threads);
            Columns columns = make_columns(first, lattice, 0.5, 1.0, 7);
            const SplatSet few = lit_splats(columns);
            test::expect_same_bits(few, generate(first, lattice, 0.5, 1.0, 7));
            EXPECT_LT(few.size(), columns.splats.size());
            EXPECT_EQ(few.size() + few.zero_alpha, columns.splats.size() + columns.splats.zero_alpha);
            EXPECT_EQ(columns.splats.zero_alpha > 0, with_camera);  // what no picture shows
            EXPECT_TRUE(few.face.empty());
            read_texels(second, columns);
            EXPECT_EQ(columns.splats.credit, "of 5");
            EXPECT_TRUE(columns.splats.divided);
            test::expect_same_bits(lit_splats(columns), generate(second, lattice, 0.5, 1.0, 7));
            read_texels(first, columns);
            test::expect_same_bits(lit_splats(std::move(columns)), few);
        }
    }
}

TEST_F(ColumnsTest, ReadingPicturesCanBeCancelled) {
    const Lattice lattice{{glm::dvec3(-5.5), glm::dvec3(5.5)}, glm::i64vec3(10)};
    const auto made = meshes(stripes(2, TextureSettings::Filter::bilinear), false);
    Columns columns = make_columns(made, lattice, 0.5, 1.0, 7);
    const std::atomic<bool> cancelled{true};
    EXPECT_THROW(read_texels(made, columns, {{}, &cancelled}), Cancelled);
}

// Where a picture is mostly transparent, its dark positions are most of what is kept.
TEST_F(ColumnsTest, TheEstimateTellsOfPositionsThatAreDark) {
    Texture dark = stripes(1, TextureSettings::Filter::nearest);
    dark.image.at(3, 3)[3] = 1.0f;
    std::vector<TexturedMesh> made = {test::textured(builtin_mesh("plane", 2.0), dark)};
    SourceParams source;
    source.count = 40000;
    const Lattice lattice = make_lattice(source, made, 0.3);
    const Columns columns = make_columns(made, lattice, 0.3, 1.0, 1);
    const double bytes = double(columns.splats.size()) * (68.0 + 36.0);  // and half of them twice
    EXPECT_LT(lit_splats(columns).size() * 50, columns.splats.size());
    EXPECT_NEAR(double(columns_memory_bytes(made, lattice, 0.3)) / bytes, 1.0, 0.25);
}

// A set written in parts is the file of the set written as a whole, whatever the parts.

using glm::i64vec3;
using test::flat_texture;
using test::half_lit;
using test::textured;

struct Case {
    const char* mesh;
    i64vec3 voxels;
    double max_distance;
    glm::vec3 place{0.0f};
    float size = 1.5f;
};

class WriteColumns : public testing::Test {
  protected:
    ~WriteColumns() override { set_thread_count(0); }

    void expect_same_file(const Case& c, std::int64_t room_bytes, Texture texture, int threads) {
        SCOPED_TRACE(testing::Message() << c.mesh << " in " << room_bytes << " bytes, threads " << threads);
        Mesh mesh = builtin_mesh(c.mesh, c.size);
        for (glm::vec3& p : mesh.positions) p += c.place;
        std::vector<TexturedMesh> meshes = {textured(std::move(mesh), std::move(texture))};
        meshes[0].textures[0].credit = "NASA";
        const Lattice lattice = test::lattice_of(c.voxels, meshes, c.max_distance);
        set_thread_count(threads);
        const SplatSet set = generate(meshes, lattice, c.max_distance, 1.0, 5);
        write_native(folder_ / "whole.splats", set);
        const std::int64_t splats =
            write_columns(folder_ / "parts.splats", meshes, lattice, c.max_distance, 1.0, 5, room_bytes);
        EXPECT_EQ(splats, set.size());
        EXPECT_TRUE(test::bytes_of(folder_ / "parts.splats") == test::bytes_of(folder_ / "whole.splats"));
    }

    TempFolder folder_;
};

TEST_F(WriteColumns, AnyRoomMakesTheSameFile) {
    for (const Case& c : {Case{"sphere", i64vec3(61, 50, 47), 0.6}, Case{"plane", i64vec3(90, 3, 110), 0.4},
                          Case{"disk", i64vec3(40, 40, 40), 2.0}})
        for (const std::int64_t room : {std::int64_t{1} << 40, std::int64_t{1} << 20, std::int64_t{200'000}})
            expect_same_file(c, room, half_lit(), room == 200'000 ? 3 : 2);
}

// Jitter and float rounding move positions over the sides of parts.
TEST_F(WriteColumns, FarFromTheOriginToo) {
    expect_same_file({"sphere", i64vec3(40, 41, 42), 0.6, {1e4f, -3e5f, 2e3f}}, 300'000, half_lit(), 2);
    expect_same_file({"sphere", i64vec3(12, 400, 7), 0.6, {0, 0, 0}, 0.01f}, 100'000, half_lit(), 2);
}

TEST_F(WriteColumns, SeveralBlocksOfTheFile) {
    expect_same_file({"sphere", i64vec3(90, 91, 92), 3.0}, 3'000'000, flat_texture({1, 1, 1, 1}), 2);
}

TEST_F(WriteColumns, NothingLitIsAFileOfNothing) {
    expect_same_file({"plane", i64vec3(20, 3, 20), 0.5}, 1 << 20, flat_texture({0, 0, 0, 0}), 2);
}

// Runs of splats from several stores join a set in order of id.

KeptSplat splat_of(std::uint64_t id) {
    const auto v = float(id);
    return {glm::vec3(v), glm::vec3(0.5f), 1.0f, v, id, glm::vec2(v), glm::vec3(0, 1, 0), 7, 8};
}

// Store n of two has the odd or the even thousands; as many splats as two blocks and a half hold.
constexpr std::uint64_t run_splats = 1000, runs_each = 164;

void fill(KeptStore& store, std::uint64_t n) {
    for (std::uint64_t run = 0; run < runs_each; ++run) {
        store.begin_run();
        for (std::uint64_t i = 0; i < run_splats; ++i) store.add(splat_of((2 * run + n) * run_splats + i));
    }
}

void append(const KeptStore& store, std::size_t begin, std::size_t end, std::vector<KeptStore::Run>& runs) {
    runs.insert(runs.end(), store.runs().data() + begin, store.runs().data() + end);
}

TEST(KeptStore, PartAfterPartJoinsASetInOrder) {
    KeptStore stores[2];
    SplatSet set;
    for (int again = 0; again < 2; ++again) {  // clear() lets the blocks serve again
        for (std::uint64_t n : {1u, 0u}) {
            stores[n].clear();
            fill(stores[n], n);
            ASSERT_GT(stores[n].runs().size(),
                      runs_each);  // one that reaches a block's end goes on as another
        }
    }
    std::size_t begin[2] = {0, 0};
    for (const std::uint64_t end_id : {100 * run_splats, 240 * run_splats, 2 * runs_each * run_splats}) {
        std::vector<KeptStore::Run> runs;
        for (std::size_t n = 0; n < 2; ++n) {
            const std::vector<KeptStore::Run>& all = stores[n].runs();
            std::size_t end = begin[n];
            while (end < all.size() && all[end].splats->id < end_id) ++end;
            append(stores[n], begin[n], end, runs);
            begin[n] = end;
        }
        append_sorted(runs, set);
        ASSERT_EQ(set.size(), std::int64_t(end_id));
    }
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        ASSERT_EQ(set.id[i], i);
        ASSERT_EQ(set.position[i], glm::vec3(float(i)));
        ASSERT_EQ(set.mesh[i], 7u);
        ASSERT_EQ(set.face[i], 8u);
    }
}

// Who watches a generation sees every splat once, and changes nothing.

class Collector : public KeptWatcher {
  public:
    void keeps(std::span<const KeptStore::Run> runs) override {
        const std::lock_guard lock(mutex);
        for (const KeptStore::Run& run : runs)
            for (std::size_t i = 0; i < run.count; ++i) {
                EXPECT_TRUE(kept.emplace(run.splats[i].id, run.splats[i]).second) << "twice";
                EXPECT_LT(run.splats[i].id, i + 1 < run.count ? run.splats[i + 1].id : ~std::uint64_t{0});
            }
    }

    std::int64_t sample_limit() const override { return 1000; }
    void ends(Columns sample, std::int64_t of) override {
        ++ended;
        EXPECT_EQ(sample.splats.size(), 1000);
        EXPECT_EQ(std::size_t(of), kept.size());
        for (std::size_t i = 0; i < sample.splats.id.size(); ++i)
            EXPECT_EQ(kept.at(sample.splats.id[i]).face, sample.splats.face[i]);
    }

    int ended = 0;
    std::map<std::uint64_t, KeptSplat> kept;

  private:
    std::mutex mutex;
};

TEST(KeptWatcher, SeesEverySplatOnceAndChangesNothing) {
    std::vector<TexturedMesh> meshes = {
        test::textured(builtin_mesh("sphere", 1.0), test::flat_texture({0.2f, 0.4f, 0.8f, 0.5f}))};
    SourceParams source;
    source.count = 150000;  // more than one block of a store
    const Lattice lattice = make_lattice(source, meshes, 0.5);
    const SplatSet alone = generate(meshes, lattice, 0.5, 1.0, 9);
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        Collector watcher;
        const SplatSet watched = lit_splats(make_columns(meshes, lattice, 0.5, 1.0, 9, {}, &watcher));
        test::expect_same_bits(watched, alone);
        EXPECT_EQ(watcher.ended, 1);
        ASSERT_EQ(std::int64_t(watcher.kept.size()), alone.size());
        std::size_t row = 0;
        for (const auto& [id, splat] : watcher.kept) {
            ASSERT_EQ(id, alone.id[row]);
            ASSERT_EQ(splat.position, alone.position[row]);
            ASSERT_EQ(splat.alpha, alone.alpha[row]);
            ++row;
        }
    }
    set_thread_count(0);
}

}  // namespace
}  // namespace astrosplat

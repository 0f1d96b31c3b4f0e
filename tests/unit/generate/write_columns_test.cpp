// A set written in parts is the file of the set written as a whole, whatever the parts.
#include "generate/generate.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/parallel.h"
#include "splat_files/native.h"
#include "support/temp_folder.h"
#include "unit/generate/generate_support.h"

namespace astrosplat {
namespace {

using glm::i64vec3;
using test::flat_texture;
using test::textured;

std::string bytes_of(const std::filesystem::path& file) {
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();
    return bytes.str();
}

/// Its left half is transparent.
Texture half_lit() {
    Texture texture = flat_texture({0.25f, 0.5f, 1.0f, 0.75f}, 64);
    for (std::int64_t y = 0; y < 64; ++y)
        for (std::int64_t x = 0; x < 32; ++x) std::fill_n(texture.image.at(x, y), 4, 0.0f);
    texture.credit = "NASA";
    return texture;
}

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
        std::vector<TexturedMesh> meshes;
        meshes.push_back(textured(std::move(mesh), std::move(texture)));
        SourceParams source;
        source.voxels = c.voxels;
        const Lattice lattice = make_lattice(source, meshes, c.max_distance);
        set_thread_count(threads);
        const SplatSet set = generate(meshes, lattice, c.max_distance, 1.0, 5);
        write_native(folder_ / "whole.splats", set);
        const std::int64_t splats =
            write_columns(folder_ / "parts.splats", meshes, lattice, c.max_distance, 1.0, 5, room_bytes);
        EXPECT_EQ(splats, set.size());
        EXPECT_TRUE(bytes_of(folder_ / "parts.splats") == bytes_of(folder_ / "whole.splats"));
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

}  // namespace
}  // namespace astrosplat

// Pictures read again into columns that are there: the bits of a generation, and nothing lost that was dark.
#include "generate/generate.h"

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "source/textured_mesh.h"
#include "unit/generate/generate_support.h"

namespace astrosplat {
namespace {

/// Stripes of another colour, of which every n-th is transparent.
Texture stripes(std::int64_t n, TextureSettings::Filter filter) {
    Texture texture;
    texture.image = make_image(32, 16, 4);
    for (std::int64_t y = 0; y < 16; ++y)
        for (std::int64_t x = 0; x < 32; ++x) {
            float* const p = texture.image.at(x, y);
            p[3] = x % n == 0 ? 0.0f : 0.5f + 0.01f * static_cast<float>(y);
            for (int c = 0; c < 3; ++c) p[c] = p[3] * static_cast<float>(x + c) / 64.0f;
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
        std::vector<TexturedMesh> made;
        made.push_back(test::textured(builtin_mesh("sphere", 1.0), texture));
        made.push_back(test::textured(builtin_mesh("plane", 2.0), texture));
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
    std::vector<TexturedMesh> made;
    made.push_back(test::textured(builtin_mesh("plane", 2.0), dark));
    SourceParams source;
    source.count = 40000;
    const Lattice lattice = make_lattice(source, made, 0.3);
    const Columns columns = make_columns(made, lattice, 0.3, 1.0, 1);
    const double bytes =
        static_cast<double>(columns.splats.size()) * (68.0 + 36.0);  // and half of them twice
    EXPECT_LT(lit_splats(columns).size() * 50, columns.splats.size());
    EXPECT_NEAR(static_cast<double>(columns_memory_bytes(made, lattice, 0.3)) / bytes, 1.0, 0.25);
}

}  // namespace
}  // namespace astrosplat

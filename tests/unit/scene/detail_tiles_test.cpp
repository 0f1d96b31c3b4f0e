// Where detail lies by what a camera sees.
#include "scene/detail_tiles.h"
#include "scene/load.h"
#include "source/textured_mesh.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// 640 x 320 texels on 10 x 5 units: five rows of ten tiles.
std::vector<TexturedMesh> picture() {
    std::vector<TexturedMesh> meshes(1);
    meshes[0].mesh = builtin_mesh("plane", 2.0);
    meshes[0].textures.emplace_back();
    meshes[0].textures[0].image = make_image(640, 320, 4, 0.5f);
    return meshes;
}

// From above its middle, or moved to one side, 640 x 320 px: at a distance of d a texel is 10 / d px wide.
Scene seen_from(double distance, const std::string& animation = "") {
    return parse_scene(
        "astrosplat = 1\n[output]\nresolution = [640, 320]\nframes = \"1-9\"\n"
        "[camera]\nposition = [0, " +
            std::to_string(distance) +
            ", 0]\ntarget = [0, 0, 0]\nup = [0, 0, -1]\nfov = 28.0725\n"
            "[[layer]]\nname = \"p\"\n[layer.source]\nmeshes = [{ mesh = \"plane\" }]\n"
            "structure = { kind = \"sheet\" }\n" +
            animation,
        "x.toml");
}

DetailTiles tiles_of(const Scene& scene, double most_splats = 1e9) {
    const std::vector<TexturedMesh> meshes = picture();
    return detail_tiles(scene, scene.layers[0], meshes, most_splats);
}

TEST(DetailTiles, FollowWhatATexelIsWideInTheFrame) {
    EXPECT_EQ(tiles_of(seen_from(10.0)).tiles, "");       // 1 px
    const DetailTiles nearer = tiles_of(seen_from(3.0));  // 3.3 px; the frame shows 3 x 1.5 units
    EXPECT_EQ(nearer.tiles, "0000000000 0001111000 0001111000 0001111000 0000000000");
    EXPECT_NEAR(nearer.shares[1], 0.24, 1e-9);
    EXPECT_DOUBLE_EQ(nearer.shares[2], 0.0);
    EXPECT_GT(nearer.more_splats, 4.0 * 0.24 * 640.0 * 320.0);
    const DetailTiles close = tiles_of(seen_from(1.0));  // 10 px; neighbours differ by one
    EXPECT_EQ(close.tiles, "0000000000 0001111000 0001221000 0001111000 0000000000");
}

// The closest of all frames counts, also between keyframes; keys that move no camera change nothing.
TEST(DetailTiles, LookAtAllOfTheFlight) {
    const std::string flight =
        "[animation]\n\"camera.position\" = { keys = [[1, [0, 10, 0]], [5, [0, 1, 0]], [9, [0, 10, 0]]] }\n";
    const DetailTiles flown = tiles_of(seen_from(10.0, flight));
    EXPECT_EQ(flown.tiles, tiles_of(seen_from(1.0)).tiles);
    EXPECT_GT(flown.shares[2], 0.0);
    Scene other = seen_from(3.0);
    other.layers[0].look.density = 0.2f;
    other.layers[0].render.lod.max_px = 7.0f;
    EXPECT_EQ(tiles_of(other).tiles, tiles_of(seen_from(3.0)).tiles);
}

TEST(DetailTiles, AreNoMoreThanAskedFor) {
    const DetailTiles all = tiles_of(seen_from(1.0)), fewer = tiles_of(seen_from(1.0), 0.5 * all.more_splats);
    EXPECT_LE(fewer.more_splats, 0.5 * all.more_splats);
    EXPECT_GT(fewer.more_splats, 0.0);
    EXPECT_EQ(tiles_of(seen_from(1.0), 100.0).tiles, "");
}

}  // namespace
}  // namespace astrosplat

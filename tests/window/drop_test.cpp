// Files dropped on the window by another program.
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowDrop : public WindowTest {
  protected:
    glm::vec2 middle() { return same_widgets().at("frame in view"); }
};

TEST_F(WindowDrop, APictureBecomesALayerAndASceneIsOpened) {
    start();
    const Pixels before = settled_frame();
    write_rings(folder / "übrig 2.png");
    ASSERT_TRUE(screen->drop({folder / "übrig 2.png"}, middle()));
    expect_title("scene.toml - edited");
    settled_frame(before);
    person->press("ctrl+s");
    expect_title("scene.toml");
    const Scene scene = saved();
    ASSERT_EQ(scene.layers.size(), 2u);
    const std::vector<MeshInput>& meshes = scene.layers[1].source.meshes;
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_EQ(meshes[0].mesh, "plane");
    EXPECT_EQ(meshes[0].texture, std::vector<fs::path>{folder / "übrig 2.png"});

    fs::copy_file(scene_file, folder / "other.toml");
    ASSERT_TRUE(screen->drop({folder / "other.toml"}, middle()));
    expect_title("other.toml");
}

TEST_F(WindowDrop, ACameraDrivesTheScenes) {
    start();
    const Pixels before = settled_frame();
    write_text(folder / "weg ü.chan", "1 0 3 9 -15 10 0 30\n");
    ASSERT_TRUE(screen->drop({folder / "weg ü.chan"}, middle()));
    expect_title("scene.toml - edited");
    settled_frame(before);
    person->press("ctrl+s");
    expect_title("scene.toml");
    EXPECT_EQ(saved().camera.file, folder / "weg ü.chan");
    EXPECT_EQ(saved().layers.size(), 1u);
}

TEST_F(WindowDrop, ALookIsGivenToTheLayer) {
    start();
    const Pixels before = settled_frame();
    write_text(folder / "look.toml", "[look]\nalpha = { power = 3.0 }\n");
    ASSERT_TRUE(screen->drop({folder / "look.toml"}, middle()));
    expect_title("scene.toml - edited");
    settled_frame(before);
    person->press("ctrl+s");
    expect_title("scene.toml");
    EXPECT_EQ(saved().layers[0].look.alpha.power, 3.0f);
}

TEST_F(WindowDrop, OnTheDemoAPictureBecomesAGalaxy) {
    start({"--no-cache"});
    expect_title("Untitled");
    ASSERT_TRUE(screen->drop({folder / "rings.png"}, middle()));
    settled_frame();
    person->press("ctrl+s");
    person->press("ctrl+a");
    person->type("galaxy.toml");
    person->press("Return");
    expect_title("galaxy.toml");
    const Scene scene = load_scene(folder / "galaxy.toml");
    ASSERT_EQ(scene.layers.size(), 1u);
    EXPECT_EQ(scene.layers[0].source.meshes[0].mesh, "plane");
    EXPECT_EQ(scene.layers[0].source.meshes[0].texture, std::vector<fs::path>{folder / "rings.png"});
}

}  // namespace
}  // namespace astrosplat::test

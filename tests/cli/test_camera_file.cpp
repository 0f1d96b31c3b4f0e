// A camera made elsewhere drives the frames of --batch: the same bits as its keyframes would, any number of
// frames, in any locale.
#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

class CameraFileBatch : public SceneTest {
  protected:
    /// scene.toml with this [camera] and nothing else that moves.
    void write_still(const std::string& camera, const std::string& more = "") {
        write_scene();
        std::string text = text_of(folder / "scene.toml");
        text.erase(text.find("[animation]"));
        const std::string placed = "position = [0.0, 0.0, 9.0]\n";
        text.replace(text.find(placed), placed.size(), camera);
        write_text(folder / "scene.toml", text + more);
    }
};

const char* const three_lines =
    "1 0 0 9 0 0 0 40\n"
    "2 0.5 -0.25 8 0 0 0 42.5\n"
    "3 1.5 0.25 7.5 0 0 0 50\n";

TEST_F(CameraFileBatch, GivesTheBitsOfItsKeyframes) {
    write_text(folder / "cam.chan", three_lines);
    write_still("file = \"cam.chan\"\n");
    const std::vector<std::string> imported = hashes({});
    RunOptions german;
    german.environment = {"LC_ALL=de_DE.UTF-8"};
    EXPECT_EQ(hashes({}, german), imported);
    EXPECT_EQ(hashes({"-f", "3,2"}), (std::vector<std::string>{imported[1], imported[2]}));
    write_text(folder / "cam.csv",
               "frame,camera.position.x,camera.position.y,camera.position.z,camera.fov\n"
               "1,0,0,9,40\n2,0.5,-0.25,8,42.5\n3,1.5,0.25,7.5,50\n");
    write_still("file = \"cam.csv\"\nrotation = [0.0, 0.0, 0.0, 1.0]\n");
    EXPECT_EQ(hashes({}), imported);
    write_still(
        "rotation = [0.0, 0.0, 0.0, 1.0]\n",
        "[animation]\n"
        "\"camera.position\" = { keys = [[1, [0, 0, 9]], [2, [0.5, -0.25, 8]], [3, [1.5, 0.25, 7.5]]] }\n"
        "\"camera.fov\" = { keys = [[1, 40], [2, 42.5], [3, 50]] }\n");
    EXPECT_EQ(hashes({}), imported);
    EXPECT_NE(imported[0], imported[1]);
}

TEST_F(CameraFileBatch, AskingForNFramesGivesNFrames) {
    write_text(folder / "cam.chan", three_lines);
    write_still("file = \"cam.chan\"\n");
    const std::vector<std::string> all = hashes({"-f", "-1-7"});
    ASSERT_EQ(all.size(), 9u);
    EXPECT_EQ(all[0], all[2]) << "holds before the first";
    EXPECT_EQ(all[8], all[4]) << "and after the last";
    EXPECT_NE(all[3], all[4]);
}

TEST_F(CameraFileBatch, ResumeRendersOnlyWhatTheFileMoved) {
    write_text(folder / "cam.chan", three_lines);
    write_still("file = \"cam.chan\"\n");
    ASSERT_EQ(batch().code, 0);
    std::string moved = three_lines;
    moved.replace(moved.find("1.5"), 3, "2.5");
    write_text(folder / "cam.chan", moved);
    const RunResult again = batch({"--resume", "--overwrite", "--progress", "plain"});
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(again.err.find("saved frames/shot.0002.exr"), std::string::npos) << again.err;
    EXPECT_NE(again.err.find("shot.0003.exr"), std::string::npos) << again.err;
}

TEST_F(CameraFileBatch, TheSceneGivesItsCameraAway) {
    const RunResult written = run({"camera", "scene.toml", "-o", "out ö.csv", "-f", "1-5"});
    EXPECT_EQ(written.code, 0) << written.err;
    EXPECT_EQ(written.out, "out ö.csv: 5 frames\n");
    EXPECT_EQ(line_count(text_of(folder / "out ö.csv")), 6);
    expect_one_line(run({"camera", "scene.toml", "-o", "out ö.csv"}), 2, "exists already");
    expect_one_line(run({"camera", "scene.toml", "-o", "out.abc"}), 2, ".chan, .csv, .gltf or .usda");
    RunOptions german;
    german.environment = {"LC_ALL=de_DE.UTF-8"};
    const std::string before = text_of(folder / "out ö.csv");
    EXPECT_EQ(run({"camera", "scene.toml", "-o", "out ö.csv", "-f", "1-5", "--overwrite"}, german).code, 0);
    EXPECT_EQ(text_of(folder / "out ö.csv"), before);
}

TEST_F(CameraFileBatch, OddFilesEndInOneLine) {
    write_still("file = \"cam.chan\"\n");
    expect_one_line(batch(), 2,
                    "scene.toml:7: camera.file: cam.chan: cannot be read: No such file or directory");
    write_text(folder / "cam.chan", "1 0 0 9 0 0 0\n2 0 x 9 0 0 0\n");
    expect_one_line(batch(), 2, "cam.chan:2: expected a number for ty, found 'x'");
    fs::create_directory(folder / "dir.chan");
    write_still("file = \"dir.chan\"\n");
    expect_one_line(batch(), 2, "dir.chan: cannot be read: ");
    EXPECT_FALSE(fs::exists(folder / "frames"));
}

}  // namespace
}  // namespace astrosplat::test

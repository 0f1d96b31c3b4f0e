// The libraries that the program loads when it starts.
#include "cli/scene_fixture.h"

namespace astrosplat::test {
namespace {

class Start : public SceneTest {
  protected:
    void SetUp() override {
        SceneTest::SetUp();
#if !defined(__x86_64__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
        GTEST_SKIP() << "only x86-64 without sanitizers has the lazy loader";
#endif
    }

    /// The libraries that the dynamic linker loaded during a run, by its own account.
    std::string libraries_of(const std::vector<std::string>& arguments) const {
        const fs::path report = folder / ("libraries of " + arguments[0]);
        fs::remove_all(report);
        fs::create_directories(report);
        const std::string output = "LD_DEBUG_OUTPUT=" + (report / "report").string();
        RunOptions options;
        options.environment = {"LD_DEBUG=files", output};
        EXPECT_EQ(run(arguments, options).code, 0);
        std::string text;
        for (const auto& entry : fs::directory_iterator(report)) text += text_of(entry.path());
        return text;
    }
};

// With all that it needs OpenImageIO is 250 libraries, a fifth of a second and 100 MB.
TEST_F(Start, ThePictureLibraryWaitsForTheFirstPicture) {
    write_text(folder / "picture.ppm", small_picture());
    const std::string library = "libOpenImageIO.so", colors = "libOpenColorIO.so";
    EXPECT_NE(libraries_of({"info", "picture.ppm"}).find(library), std::string::npos);
    const std::string without = libraries_of({"parameters"});
    EXPECT_NE(without.find("libc.so"), std::string::npos);
    EXPECT_EQ(without.find(library), std::string::npos);
    EXPECT_EQ(without.find(colors), std::string::npos);
    EXPECT_EQ(libraries_of({"info", "stars.pda"}).find(library), std::string::npos);
}

TEST_F(Start, FramesAreWrittenAndResumedWithoutIt) {
    for (const char* file : {"frame.exr", "frame.png", "frame.tif"}) {
        for (const char* how : {"--overwrite", "--resume"}) {
            const std::string loaded =
                libraries_of({"--batch", "scene.toml", "--frames", "1", "--output", file, how});
            EXPECT_NE(loaded.find("libc.so"), std::string::npos);
            EXPECT_EQ(loaded.find("libOpenImageIO.so"), std::string::npos) << file << " " << how;
        }
    }
}

}  // namespace
}  // namespace astrosplat::test

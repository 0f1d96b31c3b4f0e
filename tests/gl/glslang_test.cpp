// The shaders are GLSL 4.10 for the reference compiler too, which takes less than Mesa does.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "gl/draw_pass.h"
#include "gl/environment_pass.h"
#include "gl/program.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

bool runs(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }

class ReferenceCompiler : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!runs("glslangValidator --version"))
            GTEST_SKIP() << "glslangValidator is not installed (glslang-tools)";
    }
    bool takes(const char* stage, const std::vector<std::string>& defines,
               const std::vector<std::string>& files) {
        std::string text = "#version 410 core\n";
        for (const std::string& define : defines) text += "#define " + define + "\n";
        for (const std::string& file : files) text += shader_text(file);
        return runs("glslangValidator '" + folder_.file(std::string("shader.") + stage, text).string() + "'");
    }
    TempFolder folder_;
};

TEST_F(ReferenceCompiler, TakesTheSplats) {
    for (const char* kind : {"KIND 0", "KIND 1", "KIND 2", "KIND 3"}) {
        EXPECT_TRUE(takes("vert", {kind}, splat_vertex_files)) << kind;
        EXPECT_TRUE(takes("vert", {kind, "QUADS"}, splat_vertex_files)) << kind;
        EXPECT_TRUE(takes("frag", {kind}, {"maths.glsl", "blend.glsl", "splat_fragment.glsl"})) << kind;
    }
    EXPECT_FALSE(takes("frag", {}, {"splat_fragment.glsl"}));  // the test can fail
}

TEST_F(ReferenceCompiler, TakesTheLook) {
    EXPECT_TRUE(
        takes("vert", {}, {"maths.glsl", "noise.glsl", "look_uniforms.glsl", "look.glsl", "look_pass.glsl"}));
}

TEST_F(ReferenceCompiler, TakesThePassesOverThePicture) {
    EXPECT_TRUE(takes("vert", {}, {"screen_vertex.glsl"}));
    EXPECT_TRUE(takes("frag", {}, environment_fragment_files));
    EXPECT_TRUE(takes("frag", {"BLEND 0"}, {"composite_fragment.glsl"}));
    EXPECT_TRUE(takes("frag", {"BLEND 2"}, {"composite_fragment.glsl"}));
    EXPECT_TRUE(takes("frag", {"VIEW 2", "TAPS_A 1", "DITHER"}, {"display_fragment.glsl"}));
    EXPECT_TRUE(takes("frag", {"VIEW 1", "TAPS_A 2", "VIEW_B 3", "TAPS_B 1", "DIFFERENCE"},
                      {"display_fragment.glsl"}));
}

}  // namespace
}  // namespace astrosplat

// Shader programs, for Mesa and for the reference compiler.
#include "gl/gl_fixture.h"
#include "gl/objects.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Contexts and shader programs: what is said where they cannot be had.

using test::GlTest;

class Programs : public GlTest {};

TEST_F(Programs, AContextSaysWhatDraws) {
    GLint major = 0, minor = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    EXPECT_GE(major * 10 + minor, 41);
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST_F(Programs, AnErrorNamesOurFileAndLine) {
    const std::string error = message_of<std::runtime_error>([] {
        GlProgram({{"VIEW no_such_view"}, {"screen_vertex.glsl"}, {"display_fragment.glsl"}, {}});
    });
    EXPECT_HAS(error, "display_fragment.glsl:");
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

TEST(ReadableLog, DriversCountStringsInTheirOwnWays) {
    const std::vector<FileStart> files = {{"maths.glsl", 3}, {"look.glsl", 100}};
    EXPECT_EQ(readable_log("0:116(5): error: what\n0:2: note", files),
              "look.glsl:17(5): error: what; 0:2: note");
    EXPECT_EQ(readable_log("0(44) : error C1008", files), "maths.glsl:42 : error C1008");
    EXPECT_EQ(readable_log("no number", files), "no number");
}

TEST(ShaderText, UnknownNamesAreOurMistake) {
    EXPECT_FALSE(shader_text("look.glsl").empty());
    EXPECT_THROW(shader_text("lok.glsl"), std::logic_error);
}

void* no_function(const char*) { return nullptr; }

TEST(Context, ADriverWithoutFunctionsIsOneLine) {
    EXPECT_EQ(message_of<std::runtime_error>([] { load_gl(reinterpret_cast<GlLoader>(&no_function)); }),
              "no OpenGL 4.1 context can be had: the driver's functions do not load");
}

// The shaders are GLSL 4.10 for the reference compiler too, which takes less than Mesa does.

bool runs(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }

class ReferenceCompiler : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!runs("glslangValidator --version"))
            GTEST_SKIP() << "glslangValidator is not installed (glslang-tools)";
    }
    bool takes(const char* stage, const std::vector<std::string>& defines,
               const std::vector<std::string>& files) {
        std::string text = "#version 410 core\nfloat as_div(float a, float b) { return a / b; }\n";
        for (const std::string& define : defines) text += "#define " + define + "\n";
        for (const std::string& file : files) text += shader_text(file);
        return runs("glslangValidator '" + folder_.file(std::string("shader.") + stage, text).string() + "'");
    }
    TempFolder folder_;
};

TEST_F(ReferenceCompiler, TakesTheLook) {
    EXPECT_TRUE(takes("vert", {},
                      {"maths.glsl", "noise.glsl", "look_uniforms.glsl", "look.glsl", "screen_vertex.glsl"}));
    EXPECT_FALSE(takes("vert", {}, {"look.glsl", "screen_vertex.glsl"}));  // the test can fail
}

TEST_F(ReferenceCompiler, TakesThePassesOverThePicture) {
    EXPECT_TRUE(takes("vert", {}, {"screen_vertex.glsl"}));
    EXPECT_TRUE(takes("frag", {"VIEW 2", "TAPS_A 1", "DITHER"}, {"display_fragment.glsl"}));
    EXPECT_TRUE(takes("frag", {"VIEW 1", "TAPS_A 2", "VIEW_B 3", "TAPS_B 1", "DIFFERENCE"},
                      {"display_fragment.glsl"}));
}

}  // namespace
}  // namespace astrosplat

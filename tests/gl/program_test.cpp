// Contexts and shader programs: what is said where they cannot be had.
#include "gl/program.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "gl/context.h"
#include "gl/gl_fixture.h"

namespace astrosplat {
namespace {

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
    try {
        const GlProgram program(
            {{"VIEW no_such_view"}, {"screen_vertex.glsl"}, {"display_fragment.glsl"}, {}});
        FAIL() << "compiled";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("display_fragment.glsl:"), std::string::npos)
            << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
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
    try {
        load_gl(reinterpret_cast<GlLoader>(&no_function));
        FAIL() << "loaded";
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "no OpenGL 4.1 context can be had: the driver's functions do not load");
    }
}

}  // namespace
}  // namespace astrosplat

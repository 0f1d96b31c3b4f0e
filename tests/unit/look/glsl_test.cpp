// The shared files are GLSL 4.10 as they stand: the reference compiler takes them, concatenated in order.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/bits.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

bool runs(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }

std::string shader(const std::string& body) {
    std::string text = "#version 410 core\n";
    for (const char* name : {"maths.glsl", "noise.glsl", "look_uniforms.glsl", "look.glsl"})
        text += test::bytes_of(std::filesystem::path(ASTROSPLAT_SOURCE_DIR) / "shaders/shared" / name);
    return text + body;
}

bool compiles(const std::string& text) {
    const TempFolder folder;
    return runs("glslangValidator '" + folder.file("look.vert", text).string() + "'");
}

TEST(Glsl, TheLookCompilesAsAShader) {
    if (!runs("glslangValidator --version"))
        GTEST_SKIP() << "glslangValidator is not installed (glslang-tools)";
    const std::string body =
        "uniform LookUniforms u;\n"
        "in vec3 position; in vec4 color; in vec3 rest; in vec3 map; in uvec2 id;\n"
        "out vec4 shaded;\n"
        "void main() {\n"
        "  LookOutput o = look_splat(u, LookInput(position, color.rgb, color.a, rest.x, rest.y, map, id.x, "
        "id.y));\n"
        "  gl_Position = vec4(o.position, o.keep ? o.radius : 0.0);\n"
        "  shaded = vec4(o.color, o.alpha);\n"
        "}\n";
    EXPECT_TRUE(compiles(shader(body)));
    EXPECT_FALSE(compiles(shader("void main() { gl_Position = look_splat(1); }\n")));  // the test can fail
}

}  // namespace
}  // namespace astrosplat

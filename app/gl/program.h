// Programs from the files of shaders/. In: names of files and defines. Out: a linked program, or an error in
// one readable text that names our file and line where the driver only counts strings.
#pragma once

#include <glad/gl.h>

#include <string>
#include <utility>
#include <vector>

namespace astrosplat {

/// The GLSL of shaders/ and shaders/shared, which is compiled into the program: text of "look.glsl" and the
/// like. Asking for one that does not exist is our own mistake (std::logic_error).
std::string shader_text(const std::string& name);

/// The parts of a program. Each stage is "#version 410 core", the defines and its files one after the other.
struct ProgramSource {
    std::vector<std::string> defines = {};   // "QUADS" or "KIND 2"
    std::vector<std::string> vertex = {};    // names for shader_text()
    std::vector<std::string> fragment = {};  // empty: no fragment stage
    std::vector<std::string> feedback = {};  // vertex outputs to capture, each into its own buffer
    /// Values instead of those in the texts, for lines "const int NAME = 8;".
    std::vector<std::pair<std::string, int>> constants = {};
    std::string fragment_head = {};  // GLSL before the files of the fragment stage, from elsewhere
    std::vector<std::pair<std::string, int>> samplers = {};  // and the texture unit that each reads
    std::string block = {};                                  // of uniforms, read from binding point 0
};

/// The files of projection.glsl and what it needs, followed by `more`.
std::vector<std::string> after_projections(const std::vector<std::string>& more);

class GlProgram {
  public:
    /// Throws std::runtime_error: "shader look.glsl:12: ..." in the driver's words.
    explicit GlProgram(const ProgramSource& source);
    ~GlProgram();
    GlProgram(const GlProgram&) = delete;
    GlProgram& operator=(const GlProgram&) = delete;

    void use() const { glUseProgram(program_); }
    GLuint name() const { return program_; }
    /// -1 where the program does not use it, which OpenGL's glUniform calls ignore.
    GLint uniform(const char* name) const { return glGetUniformLocation(program_, name); }

  private:
    GLuint program_ = 0;
};

/// Where a file begins in a shader's text, lines counted from 1.
struct FileStart {
    std::string name;
    int line = 1;
};
/// The driver's compile log as one line, with "0:117" or "0(117)" at the start of its lines written
/// as "look.glsl:17".
std::string readable_log(const std::string& log, const std::vector<FileStart>& files);

}  // namespace astrosplat

#include "gl/program.h"

#include <fmt/format.h>

#include <cctype>
#include <stdexcept>

#include "gl/shader_text.h"

namespace astrosplat {
namespace {

/// "#line" numbers the strings as `files` does, from 1 on; 0 is the head.
std::string stage_text(const ProgramSource& source, const std::vector<std::string>& files) {
    std::string text = "#version 410 core\n";
    for (const std::string& define : source.defines) text += "#define " + define + "\n";
    for (std::size_t i = 0; i < files.size(); ++i)
        text += fmt::format("#line 1 {}\n", i + 1) + shader_text(files[i]) + "\n";
    return text;
}

template <class GetSize, class GetLog>
std::string log_of(GLuint object, GetSize get_size, GetLog get_log) {
    GLint size = 0;
    get_size(object, GL_INFO_LOG_LENGTH, &size);
    std::string log(static_cast<std::size_t>(size > 0 ? size : 1), '\0');
    get_log(object, static_cast<GLsizei>(log.size()), nullptr, log.data());
    while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
    return log;
}

/// A shader that lives until it has been linked.
struct Stage {
    GLuint shader;
    Stage(GLenum kind, const ProgramSource& source, const std::vector<std::string>& files)
        : shader(glCreateShader(kind)) {
        const std::string text = stage_text(source, files);
        const char* pointer = text.c_str();
        glShaderSource(shader, 1, &pointer, nullptr);
        glCompileShader(shader);
        GLint compiled = GL_FALSE;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
        if (compiled) return;
        const std::string log = readable_log(log_of(shader, glGetShaderiv, glGetShaderInfoLog), files);
        glDeleteShader(shader);
        throw std::runtime_error("OpenGL does not take the shader " + log);
    }
    ~Stage() { glDeleteShader(shader); }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;
};

std::size_t digits_at(const std::string& line, std::size_t i) {
    std::size_t end = i;
    while (end < line.size() && std::isdigit(static_cast<unsigned char>(line[end]))) ++end;
    return end;
}

std::string readable_line(const std::string& line, const std::vector<std::string>& files) {
    const std::size_t number_end = digits_at(line, 0);
    if (number_end == 0 || number_end > 3 || number_end >= line.size()) return line;
    if (line[number_end] != ':' && line[number_end] != '(') return line;
    const std::size_t place_end = digits_at(line, number_end + 1);
    const auto file = static_cast<std::size_t>(std::stoi(line.substr(0, number_end)));
    if (place_end == number_end + 1 || file < 1 || file > files.size()) return line;
    const bool closes = line[number_end] == '(' && place_end < line.size() && line[place_end] == ')';
    return files[file - 1] + ":" + line.substr(number_end + 1, place_end - number_end - 1) +
           line.substr(place_end + (closes ? 1 : 0));
}

}  // namespace

std::string readable_log(const std::string& log, const std::vector<std::string>& files) {
    std::string result;
    for (std::size_t begin = 0; begin < log.size();) {
        std::size_t end = log.find('\n', begin);
        if (end == std::string::npos) end = log.size();
        if (!result.empty()) result += "; ";
        result += readable_line(log.substr(begin, end - begin), files);
        begin = end + 1;
    }
    return result;
}

GlProgram::GlProgram(const ProgramSource& source) {
    const Stage vertex(GL_VERTEX_SHADER, source, source.vertex);
    program_ = glCreateProgram();
    glAttachShader(program_, vertex.shader);
    if (!source.fragment.empty()) {
        const Stage fragment(GL_FRAGMENT_SHADER, source, source.fragment);
        glAttachShader(program_, fragment.shader);  // stays until the program goes
    }
    std::vector<const char*> captured;
    for (const std::string& name : source.feedback) captured.push_back(name.c_str());
    if (!captured.empty())
        glTransformFeedbackVaryings(program_, static_cast<GLsizei>(captured.size()), captured.data(),
                                    GL_SEPARATE_ATTRIBS);
    glLinkProgram(program_);
    GLint linked = GL_FALSE;
    glGetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (linked) return;
    const std::string log = log_of(program_, glGetProgramiv, glGetProgramInfoLog);
    glDeleteProgram(program_);
    throw std::runtime_error("OpenGL does not link the shaders of " + source.vertex.back() + ": " + log);
}

GlProgram::~GlProgram() { glDeleteProgram(program_); }

void GlProgram::set_sampler(const char* sampler, int unit) const {
    glUseProgram(program_);
    glUniform1i(uniform(sampler), unit);
}

void GlProgram::set_block(const char* block, GLuint binding) const {
    const GLuint index = glGetUniformBlockIndex(program_, block);
    if (index != GL_INVALID_INDEX) glUniformBlockBinding(program_, index, binding);
}

}  // namespace astrosplat

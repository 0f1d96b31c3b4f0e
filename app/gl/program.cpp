#include "gl/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace astrosplat {
namespace {

/// A stage's text and where its files begin. (Drivers do not agree on what "#line" with a number means.)
struct StageText {
    std::string text = "#version 410 core\n";
    std::vector<FileStart> files;
};

/// The text with another value for a constant it defines; unchanged where it does not.
void set_constant(std::string& text, const std::string& name, int value) {
    const std::string head = "const int " + name + " = ";
    const std::size_t at = text.find(head);
    if (at == std::string::npos) return;
    const std::size_t end = text.find(';', at);
    text.replace(at + head.size(), end - at - head.size(), std::to_string(value));
}

StageText stage_text(const ProgramSource& source, const std::vector<std::string>& files,
                     const std::string& head) {
    StageText stage;
    for (const std::string& define : source.defines) stage.text += "#define " + define + "\n";
    if (!head.empty()) stage.text += head + "\n";
    for (const std::string& file : files) {
        const auto lines = std::count(stage.text.begin(), stage.text.end(), '\n');
        stage.files.push_back({file, static_cast<int>(lines) + 1});
        stage.text += shader_text(file) + "\n";
    }
    for (const auto& [name, value] : source.constants) set_constant(stage.text, name, value);
    return stage;
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
    Stage(GLenum kind, const ProgramSource& source, const std::vector<std::string>& files,
          const std::string& head = {})
        : shader(glCreateShader(kind)) {
        const StageText stage = stage_text(source, files, head);
        const char* pointer = stage.text.c_str();
        glShaderSource(shader, 1, &pointer, nullptr);
        glCompileShader(shader);
        GLint compiled = GL_FALSE;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
        if (compiled) return;
        const std::string log = readable_log(log_of(shader, glGetShaderiv, glGetShaderInfoLog), stage.files);
        glDeleteShader(shader);
        throw std::runtime_error("OpenGL does not take the shader " + log);
    }
    ~Stage() { glDeleteShader(shader); }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;
};

/// Mesa writes "0:117(5): error", NVIDIA "0(117) : error": the number of a string, then of a line.
std::string readable_line(const std::string& line, const std::vector<FileStart>& files) {
    static const std::regex head(R"(\d+(?::(\d{1,6})|\((\d{1,6})\)?)(?!\d)(.*))");
    std::smatch parts;
    if (!std::regex_match(line, parts, head)) return line;
    const int number = std::stoi(parts[1].matched ? parts[1] : parts[2]);
    const FileStart* file = nullptr;
    for (const FileStart& candidate : files)
        if (candidate.line <= number) file = &candidate;
    return file ? fmt::format("{}:{}{}", file->name, number - file->line + 1, parts[3].str()) : line;
}

}  // namespace

std::string readable_log(const std::string& log, const std::vector<FileStart>& files) {
    std::string result;
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);)
        result += (result.empty() ? "" : "; ") + readable_line(line, files);
    return result;
}

std::vector<std::string> after_projections(const std::vector<std::string>& more) {
    std::vector<std::string> files = {"lens.glsl", "angles.glsl"};
    const std::string list = shader_text("projections.inc");
    const std::regex include("#include \"([^\"]+)\"");
    for (std::sregex_iterator it(list.begin(), list.end(), include), none; it != none; ++it)
        files.push_back((*it)[1]);
    files.insert(files.end(), more.begin(), more.end());
    return files;
}

GlProgram::GlProgram(const ProgramSource& source) {
    const Stage vertex(GL_VERTEX_SHADER, source, source.vertex);
    program_ = glCreateProgram();
    glAttachShader(program_, vertex.shader);
    if (!source.fragment.empty()) {
        const Stage fragment(GL_FRAGMENT_SHADER, source, source.fragment, source.fragment_head);
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
    if (!linked) {
        const std::string log = log_of(program_, glGetProgramiv, glGetProgramInfoLog);
        glDeleteProgram(program_);
        throw std::runtime_error("OpenGL does not link the shaders of " + source.vertex.back() + ": " + log);
    }
    glUseProgram(program_);
    for (const auto& [sampler, unit] : source.samplers) glUniform1i(uniform(sampler.c_str()), unit);
    const GLuint block = glGetUniformBlockIndex(program_, source.block.c_str());
    if (block != GL_INVALID_INDEX) glUniformBlockBinding(program_, block, 0);
}

GlProgram::~GlProgram() { glDeleteProgram(program_); }

}  // namespace astrosplat

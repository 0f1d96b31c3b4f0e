// One pass over the target: background, or one of two pictures through the view transform. What differs from
// one setting to the other are a few uniforms; which of the two pictures is read is decided per pixel.
#include "gl/display.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>

#include "core/real.h"
#include "gl/objects.h"
#include "gl/program.h"

namespace astrosplat {
namespace {

/// How a picture is read at a place that is `scale` target px to each of its px.
int taps_of(double px_per_target_px) {
    constexpr int most = 4;
    return std::clamp(static_cast<int>(std::ceil(px_per_target_px / 2.0)), 1, most);
}

struct Size {
    int width = 0, height = 0;
};

Size size_of(GLuint texture) {
    Size size;
    if (texture == 0) return size;
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &size.width);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &size.height);
    return size;
}

}  // namespace

struct Display::State {
    GlProgram program{{{}, {"screen_vertex.glsl"}, {"display_fragment.glsl"}, {}}};
    GlVertexArray nothing;
    GlTarget target;
    GlTexture black;

    State() {
        glBindTexture(GL_TEXTURE_2D, black.get());
        const float zero[4] = {0.0f, 0.0f, 0.0f, 0.0f};
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, 1, 1, 0, GL_RGBA, GL_FLOAT, zero);
        set_sampling(GL_TEXTURE_2D, GL_NEAREST);
        program.set_sampler("picture_a", 0);
        program.set_sampler("picture_b", 1);
    }

    /// Pixels one to one, or at least twice as large: as they are. Else smoothed, shrunk ones with several
    /// reads.
    void bind_picture(int unit, GLuint texture, const DisplaySettings& s, const char* taps_name) const {
        const Size size = size_of(texture);
        const double rate = s.width > 0.0f ? double(size.width) / double(s.width) : 1.0;
        const bool whole = std::fabs(rate - 1.0) < 1e-6 || rate <= 0.5;
        bind_texture(unit, GL_TEXTURE_2D, texture != 0 ? texture : black.name());
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        set_sampling(GL_TEXTURE_2D, whole ? GL_NEAREST : GL_LINEAR);
        glActiveTexture(GL_TEXTURE0);
        glUniform1i(program.uniform(taps_name), whole ? 1 : taps_of(rate));
    }

    void set_uniforms(const DisplaySettings& s) const {
        using Mode = DisplaySettings::Mode;
        const Mode mode = s.b == 0 ? Mode::a : s.mode;
        glUniform4f(program.uniform("place"), s.x, static_cast<float>(target.height()) - s.y, 1.0f / s.width,
                    1.0f / s.height);
        glUniform1i(program.uniform("mode"), static_cast<int>(mode));
        glUniform1i(program.uniform("view"), static_cast<int>(s.view));
        glUniform1f(program.uniform("gain"), float(real::pow(2.0, double(s.exposure))));
        glUniform1f(program.uniform("wipe"), s.wipe);
        glUniform1f(program.uniform("difference_gain"), s.difference_gain);
        glUniform1i(program.uniform("b_is_display"), s.b_is_display ? 1 : 0);
        glUniform1i(program.uniform("dithered"), s.dither ? 1 : 0);
        glUniform3fv(program.uniform("background"), 1, s.background);
    }
};

Display::Display() : state_(std::make_unique<State>()) {}
Display::~Display() = default;

unsigned Display::draw(const DisplaySettings& settings, int target_width, int target_height) {
    State& state = *state_;
    state.target.resize(target_width, target_height, GL_RGBA8);
    state.target.bind();
    state.program.use();
    glDisable(GL_BLEND);
    glDisable(GL_DITHER);
    state.bind_picture(0, settings.a, settings, "taps_a");
    state.bind_picture(1, settings.b, settings, "taps_b");
    state.set_uniforms(settings);
    glBindVertexArray(state.nothing.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return state.target.texture();
}

std::vector<unsigned char> Display::read() const {
    const GlTarget& target = state_->target;
    const auto row = static_cast<std::size_t>(target.width()) * 4;
    const auto rows = static_cast<std::size_t>(target.height());
    std::vector<unsigned char> bytes(row * rows);
    if (bytes.empty()) return bytes;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, target.width(), target.height(), GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    for (std::size_t y = 0; y < rows / 2; ++y)
        std::swap_ranges(bytes.begin() + std::ptrdiff_t(y * row),
                         bytes.begin() + std::ptrdiff_t((y + 1) * row),
                         bytes.begin() + std::ptrdiff_t((rows - 1 - y) * row));
    return bytes;
}

}  // namespace astrosplat

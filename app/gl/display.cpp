// Background by clearing, then the image, or its parts on both sides of the wipe, each cut to its rectangle
// and drawn by a program made for exactly what it shows: a pixel costs one read and one curve.
#include "gl/display.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/real.h"
#include "gl/objects.h"
#include "gl/program.h"

namespace astrosplat {
namespace {

constexpr int view_none = 3;  // VIEW_NONE of display_fragment.glsl

/// VIEW_LINEAR, VIEW_SRGB, VIEW_SOFT of display_fragment.glsl.
int view_number(OutputParams::View view) { return static_cast<int>(view) - 1; }

/// What one program of display_fragment.glsl is made for.
struct Variant {
    int view_a = 0, view_b = 0;
    int taps_a = 1, taps_b = 1;
    bool difference = false, dither = false;
    auto operator<=>(const Variant&) const = default;
};

ProgramSource source_of(const Variant& v) {
    ProgramSource source{{fmt::format("VIEW {}", v.view_a), fmt::format("TAPS_A {}", v.taps_a)},
                         {"screen_vertex.glsl"},
                         {"display_fragment.glsl"},
                         {}};
    if (v.difference) {
        source.defines.insert(source.defines.end(), {"DIFFERENCE", fmt::format("VIEW_B {}", v.view_b),
                                                     fmt::format("TAPS_B {}", v.taps_b)});
    }
    if (v.dither) source.defines.push_back("DITHER");
    return source;
}

/// A texture and how it is read: pixels one to one, or at least twice as large, as they are; else smoothed,
/// shrunk ones with several taps.
struct ShownImage {
    GLuint texture = 0;
    GLenum filter = GL_NEAREST;
    int taps = 1;
};

ShownImage image_of(GLuint texture, const DisplaySettings& s) {
    constexpr int most_taps = 4;
    GLint width = 0;
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
    const double rate = double(width) / double(s.width);
    if (rate == 1.0 || rate <= 0.5) return {texture, GL_NEAREST, 1};
    return {texture, GL_LINEAR, std::clamp(static_cast<int>(std::ceil(rate / 2.0)), 1, most_taps)};
}

void bind(int unit, const ShownImage& image) {
    bind_texture(unit, GL_TEXTURE_2D, image.texture);
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    set_sampling(GL_TEXTURE_2D, image.filter);
    glActiveTexture(GL_TEXTURE0);
}

/// Columns and rows of the target, from its upper left; ends excluded.
struct PixelRect {
    int x0, y0, x1, y1;
};

int rounded(float px) { return static_cast<int>(std::floor(std::clamp(px, -1e6f, 1e6f) + 0.5f)); }

PixelRect rect_of(const DisplaySettings& s, int width, int height) {
    return {std::clamp(rounded(s.x), 0, width), std::clamp(rounded(s.y), 0, height),
            std::clamp(rounded(s.x + s.width), 0, width), std::clamp(rounded(s.y + s.height), 0, height)};
}

/// The line between the two sides, light where a dark one would not show.
constexpr float line_brightness = 0.85f;

}  // namespace

struct Display::State {
    std::map<Variant, std::unique_ptr<GlProgram>> programs;  // compiled when first needed
    GlVertexArray nothing;
    GlTarget target;
    DisplaySettings drawn;  // what the target holds, when version is above 0
    std::uint64_t version = 0;

    bool holds(const DisplaySettings& settings, int width, int height) const {
        return settings.content != 0 && version != 0 && settings == drawn && width == target.width() &&
               height == target.height();
    }

    const GlProgram& program(const Variant& variant) {
        std::unique_ptr<GlProgram>& entry = programs[variant];
        if (!entry) {
            entry = std::make_unique<GlProgram>(source_of(variant));
            entry->set_sampler("image_a", 0);
            entry->set_sampler("image_b", 1);
        }
        return *entry;
    }

    /// Draws or clears only this part of the target.
    bool cut(const PixelRect& r) const {
        glScissor(r.x0, target.height() - r.y1, std::max(0, r.x1 - r.x0), std::max(0, r.y1 - r.y0));
        return r.x1 > r.x0 && r.y1 > r.y0;
    }

    void clear(const PixelRect& r, float red, float green, float blue) const {
        if (!cut(r)) return;
        glClearColor(red, green, blue, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT);
    }

    void draw(const PixelRect& r, const Variant& variant, const DisplaySettings& s) {
        if (!cut(r)) return;
        const GlProgram& p = program(variant);
        p.use();
        glUniform4f(p.uniform("place"), s.x, static_cast<float>(target.height()) - s.y, 1.0f / s.width,
                    1.0f / s.height);
        glUniform1f(p.uniform("gain"), float(real::pow(2.0, double(s.exposure))));
        glUniform1f(p.uniform("difference_gain"), s.difference_gain);
        glBindVertexArray(nothing.get());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glBindVertexArray(0);
    }

    void draw_side(const PixelRect& r, bool b, const DisplaySettings& s) {
        const ShownImage image = image_of(b ? s.b : s.a, s);
        bind(0, image);
        Variant variant;
        variant.view_a = b && s.b_is_display ? view_none : view_number(s.view);
        variant.taps_a = image.taps;
        variant.dither = s.dither;
        draw(r, variant, s);
    }

    void draw_difference(const PixelRect& r, const DisplaySettings& s) {
        const ShownImage a = image_of(s.a, s), b = image_of(s.b, s);
        bind(0, a);
        bind(1, b);
        const int view = view_number(s.view);
        draw(r, {view, s.b_is_display ? view_none : view, a.taps, b.taps, true, false}, s);
    }

    void draw_wipe(const PixelRect& r, const DisplaySettings& s) {
        const int line = rounded(s.x + s.width * std::clamp(s.wipe, 0.0f, 1.0f));
        const int end_a = std::clamp(line, r.x0, r.x1);
        draw_side({r.x0, r.y0, end_a, r.y1}, false, s);
        draw_side({end_a, r.y0, r.x1, r.y1}, true, s);
        if (line > r.x0 && line < r.x1)
            clear({line, r.y0, line + 1, r.y1}, line_brightness, line_brightness, line_brightness);
    }
};

Display::Display() : state_(std::make_unique<State>()) {}
Display::~Display() = default;

unsigned Display::draw(const DisplaySettings& settings, int target_width, int target_height) {
    using Mode = DisplaySettings::Mode;
    State& state = *state_;
    if (state.holds(settings, target_width, target_height)) return state.target.texture();
    state.drawn = settings;
    ++state.version;
    state.target.resize(target_width, target_height, GL_RGBA8);
    state.target.bind();
    glDisable(GL_BLEND);
    glDisable(GL_DITHER);
    glEnable(GL_SCISSOR_TEST);
    const float* around = settings.background;
    const PixelRect r = rect_of(settings, target_width, target_height);
    const bool covered = r.x0 == 0 && r.y0 == 0 && r.x1 == target_width && r.y1 == target_height;
    if (!covered || settings.a == 0)
        state.clear({0, 0, target_width, target_height}, around[0], around[1], around[2]);
    const Mode mode = settings.b == 0 ? Mode::a : settings.a == 0 ? Mode::b : settings.mode;
    const bool anything = settings.a != 0 || settings.b != 0;
    if (anything && settings.width > 0.0f && settings.height > 0.0f) {
        if (mode == Mode::difference)
            state.draw_difference(r, settings);
        else if (mode == Mode::wipe)
            state.draw_wipe(r, settings);
        else
            state.draw_side(r, mode == Mode::b, settings);
    }
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return state.target.texture();
}

std::uint64_t Display::version() const { return state_->version; }

std::vector<unsigned char> Display::read() const {
    const GlTarget& target = state_->target;
    return read_rgba8(target.framebuffer(), target.width(), target.height());
}

}  // namespace astrosplat

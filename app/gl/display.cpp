// Background by clearing, then the image, or its parts on both sides of the wipe, each cut to its rectangle.
#include "gl/display.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <string>
#include <utility>

#include "core/real.h"
#include "gl/objects.h"
#include "ocio/display_transform.h"

namespace astrosplat {
namespace {

/// A display transform of a configuration, as the GLSL and the tables that a fragment shader needs of it.
/// Tables are 32-bit floats: OpenGL interpolates the smooth ones.
class OcioTables {
  public:
    bool holds(const std::shared_ptr<const DisplayTransform>& transform) const {
        return transform_ == transform;
    }
    /// Uploads the tables of another one, by texture unit `unit`.
    void take(std::shared_ptr<const DisplayTransform> transform, int unit);
    /// GLSL of "vec4 ocio_display(vec4)".
    const std::string& text() const { return text_; }
    /// Texture units from `first` on.
    void add_samplers(ProgramSource& source, int first) const {
        for (const Table& table : tables_) source.samplers.emplace_back(table.sampler, first++);
    }
    void bind(int first) const {
        for (const Table& table : tables_) bind_texture(first++, table.target, table.texture.name());
    }

  private:
    struct Table {
        std::string sampler;
        GLenum target;
        GlTexture texture;
    };
    std::shared_ptr<const DisplayTransform> transform_;
    std::string text_;
    std::vector<Table> tables_;
};

GLenum target_of(const GlslTable& table) {
    return table.dimensions == 1 ? GL_TEXTURE_1D : table.dimensions == 2 ? GL_TEXTURE_2D : GL_TEXTURE_3D;
}

void upload(GLenum target, const GlslTable& table) {
    const GLint stored = table.channels == 1 ? GL_R32F : GL_RGB32F;
    const GLenum given = table.channels == 1 ? GL_RED : GL_RGB;
    const float* const values = table.values.data();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    if (target == GL_TEXTURE_1D)
        glTexImage1D(target, 0, stored, table.width, 0, given, GL_FLOAT, values);
    else if (target == GL_TEXTURE_2D)
        glTexImage2D(target, 0, stored, table.width, table.height, 0, given, GL_FLOAT, values);
    else
        glTexImage3D(target, 0, stored, table.width, table.width, table.width, 0, given, GL_FLOAT, values);
    set_sampling(target, table.smooth ? GL_LINEAR : GL_NEAREST);
    if (target == GL_TEXTURE_3D) glTexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

void OcioTables::take(std::shared_ptr<const DisplayTransform> transform, int unit) {
    transform_ = std::move(transform);
    tables_.clear();
    text_.clear();
    if (!transform_) return;
    const GlslTransform glsl = transform_->glsl();
    text_ = glsl.text;
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    for (const GlslTable& table : glsl.tables) {
        tables_.push_back({table.sampler, target_of(table), {}});
        glBindTexture(tables_.back().target, tables_.back().texture.get());
        upload(tables_.back().target, table);
    }
    glActiveTexture(GL_TEXTURE0);
}

constexpr int view_none = 3, view_ocio = 4;  // VIEW_NONE, VIEW_OCIO of display_fragment.glsl
constexpr int ocio_unit = 2;                 // its tables' first texture unit

/// The case that one program of display_fragment.glsl is made for.
struct DisplayVariant {
    int view_a = 0, view_b = 0;  // VIEW_... of display_fragment.glsl
    int taps_a = 1, taps_b = 1;
    enum class Mix { alone, over, difference } mix = Mix::alone;
    bool masked = false, dither = false;
    int channel = 0;  // Inspection::Channel
    bool gamma = false;
    auto operator<=>(const DisplayVariant&) const = default;
    /// Shows something through OpenColorIO.
    bool managed() const { return view_a == view_ocio || (mix != Mix::alone && view_b == view_ocio); }
};
using Mix = DisplayVariant::Mix;

/// Of light; and of display values where `holds_display`.
int view_number(const DisplaySettings& settings, bool holds_display) {
    if (holds_display) return view_none;
    // VIEW_LINEAR, VIEW_SRGB, VIEW_SOFT
    return settings.ocio ? view_ocio : static_cast<int>(settings.view) - 1;
}

ProgramSource source_of(const DisplayVariant& v, const OcioTables& ocio) {
    ProgramSource source{.defines = {fmt::format("VIEW {}", v.view_a), fmt::format("TAPS_A {}", v.taps_a),
                                     fmt::format("CHANNEL {}", v.channel)},
                         .vertex = {"screen_vertex.glsl"},
                         .fragment = {"exposure_bands.glsl", "display_fragment.glsl"},
                         .samplers = {{"image_a", 0}, {"image_b", 1}}};
    if (v.mix != Mix::alone) {
        const char* mix = v.mix == Mix::over ? "OVER" : "DIFFERENCE";
        source.defines.insert(source.defines.end(),
                              {mix, fmt::format("VIEW_B {}", v.view_b), fmt::format("TAPS_B {}", v.taps_b)});
    }
    if (v.masked) source.defines.push_back("MASKED");
    if (v.dither) source.defines.push_back("DITHER");
    if (v.gamma) source.defines.push_back("GAMMA");
    if (v.managed()) {
        source.defines.push_back("WITH_OCIO");
        source.fragment_head = ocio.text();
        ocio.add_samplers(source, ocio_unit);
    }
    return source;
}

/// The programs, each made for exactly what it shows: a pixel costs one read and one curve. Compiled when
/// first needed.
class DisplayPrograms {
  public:
    /// In use, with its textures at units 0 and 1, and beyond these `ocio`'s.
    const GlProgram& use(const DisplayVariant& variant, const std::shared_ptr<const DisplayTransform>& ocio);

  private:
    void use_ocio(const std::shared_ptr<const DisplayTransform>& wanted);

    std::map<DisplayVariant, std::unique_ptr<GlProgram>> programs_;
    OcioTables ocio_;
};

/// Programs of another transform go.
void DisplayPrograms::use_ocio(const std::shared_ptr<const DisplayTransform>& wanted) {
    if (!ocio_.holds(wanted)) {
        std::erase_if(programs_, [](const auto& entry) { return entry.first.managed(); });
        ocio_.take(wanted, ocio_unit);
    }
    ocio_.bind(ocio_unit);
}

const GlProgram& DisplayPrograms::use(const DisplayVariant& variant,
                                      const std::shared_ptr<const DisplayTransform>& ocio) {
    if (variant.managed()) use_ocio(ocio);
    std::unique_ptr<GlProgram>& entry = programs_[variant];
    if (!entry) entry = std::make_unique<GlProgram>(source_of(variant, ocio_));
    entry->use();
    return *entry;
}

/// A texture and how it is read: pixels one to one, or at least twice as large, as they are; else smoothed,
/// shrunk ones with several taps.
struct ShownImage {
    GLuint texture = 0;
    GLenum filter = GL_NEAREST;
    int taps = 1;
};

ShownImage image_of(GLuint texture, float shown_width) {
    constexpr int most_taps = 4;  // reads per axis
    GLint width = 0;
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
    const double rate = double(width) / double(shown_width);
    if (rate == 1.0 || rate <= 0.5) return {texture, GL_NEAREST, 1};
    return {texture, GL_LINEAR, std::clamp(static_cast<int>(std::ceil(rate / 2.0)), 1, most_taps)};
}

ShownImage image_a_of(const DisplaySettings& s) { return image_of(s.a, s.width); }

/// A turned one is always smoothed.
ShownImage image_b_of(const DisplaySettings& s) {
    if (!s.b_place) return image_of(s.b, s.width);
    ShownImage image = image_of(s.b, static_cast<float>(glm::length(s.b_place->right)));
    if (s.b_place->right.y != 0.0) image.filter = GL_LINEAR;
    return image;
}

void bind(int unit, const ShownImage& image) {
    bind_texture(unit, GL_TEXTURE_2D, image.texture);
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    set_sampling(GL_TEXTURE_2D, image.filter);
    glActiveTexture(GL_TEXTURE0);
}

int rounded(float px) { return static_cast<int>(std::floor(std::clamp(px, -1e6f, 1e6f) + 0.5f)); }

PixelRect rect_of(const DisplaySettings& s, int width, int height) {
    return {std::clamp(rounded(s.x), 0, width), std::clamp(rounded(s.y), 0, height),
            std::clamp(rounded(s.x + s.width), 0, width), std::clamp(rounded(s.y + s.height), 0, height)};
}

void end_drawing() {
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

/// The line between the two sides, light where a dark one would not show.
constexpr float line_brightness = 0.85f;

}  // namespace

struct Display::State {
    DisplayPrograms programs;
    WholeTarget triangle;
    GlTarget target;
    GlTarget values;  // of what is compared, as floats
    GlTarget points;
    int drawn_height = 0;
    float codes = 0.0f;     // the largest of a channel of the target that is drawn into; 0: it holds numbers
    DisplaySettings drawn;  // what the target holds, when version is above 0
    std::uint64_t version = 0;

    bool holds(const DisplaySettings& settings, int width, int height) const {
        return settings.content != 0 && version != 0 && settings == drawn && width == target.width() &&
               height == target.height();
    }

    void begin_drawing(GlTarget& into) {
        drawn_height = into.height();
        codes = &into == &target ? 255.0f : 0.0f;
        into.bind();
        glDisable(GL_BLEND);
        glDisable(GL_DITHER);
        glEnable(GL_SCISSOR_TEST);
    }

    /// Draws or clears only this part of the target.
    bool cut(const PixelRect& r) const {
        glScissor(r.x0, drawn_height - r.y1, std::max(0, r.x1 - r.x0), std::max(0, r.y1 - r.y0));
        return r.x1 > r.x0 && r.y1 > r.y0;
    }

    void clear(const PixelRect& r, float red, float green, float blue) const {
        if (!cut(r)) return;
        glClearColor(red, green, blue, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT);
    }

    static void set_b(const GlProgram& p, const DisplaySettings& s) {
        const PicturePlace place =
            s.b_place.value_or(PicturePlace{{s.x, s.y}, {s.width, 0.0}, {0.0, s.height}});
        const glm::dmat2 b_from_px = glm::inverse(glm::dmat2(place.right, place.down));
        const glm::vec2 origin = b_from_px * (glm::dvec2(s.x, s.y) - place.corner);
        glUniform2f(p.uniform("b_origin"), origin.x, origin.y);
        const glm::vec2 right = b_from_px[0], down = b_from_px[1];
        glUniform2f(p.uniform("b_right"), right.x, right.y);
        glUniform2f(p.uniform("b_down"), down.x, down.y);
        glUniform1f(p.uniform("b_opacity"), s.b_opacity);
        glUniform1f(p.uniform("difference_gain"), s.difference_gain);
    }

    void draw(const PixelRect& r, DisplayVariant variant, const DisplaySettings& s) {
        if (!cut(r)) return;
        variant.channel = static_cast<int>(s.inspection.channel);
        variant.gamma = s.inspection.gamma != 1.0f;
        const GlProgram& p = programs.use(variant, s.ocio);
        glUniform4f(p.uniform("place"), s.x, static_cast<float>(drawn_height) - s.y, 1.0f / s.width,
                    1.0f / s.height);
        glUniform1f(p.uniform("codes"), codes);
        glUniform1f(p.uniform("gain"),
                    float(real::pow(2.0, double(s.exposure) + double(s.inspection.exposure))));
        if (variant.gamma) glUniform1f(p.uniform("bend"), 1.0f / s.inspection.gamma);
        if (variant.mix != Mix::alone) set_b(p, s);
        triangle.draw();
    }

    void draw_side(const PixelRect& r, bool b, const DisplaySettings& s) {
        if (b && s.b_place && s.a != 0) return draw_both(r, Mix::over, s);
        const ShownImage image = b ? image_of(s.b, s.width) : image_a_of(s);
        bind(0, image);
        DisplayVariant variant;
        variant.view_a = view_number(s, b && s.b_is_display);
        variant.taps_a = image.taps;
        variant.dither = s.dither;
        draw(r, variant, s);
    }

    void draw_both(const PixelRect& r, Mix mix, const DisplaySettings& s, bool masked = false) {
        const ShownImage a = image_a_of(s), b = image_b_of(s);
        bind(0, a);
        bind(1, b);
        draw(r, {view_number(s, false), view_number(s, s.b_is_display), a.taps, b.taps, mix, masked, false},
             s);
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
    state.begin_drawing(state.target);
    const float* around = settings.background;
    const PixelRect r = rect_of(settings, target_width, target_height);
    const bool covered = r.x0 == 0 && r.y0 == 0 && r.x1 == target_width && r.y1 == target_height;
    if (!covered || settings.a == 0)
        state.clear({0, 0, target_width, target_height}, around[0], around[1], around[2]);
    const Mode mode = settings.b == 0 ? Mode::a : settings.a == 0 ? Mode::b : settings.mode;
    const bool anything = settings.a != 0 || settings.b != 0;
    if (anything && settings.width > 0.0f && settings.height > 0.0f) {
        if (mode == Mode::difference)
            state.draw_both(r, Mix::difference, settings);
        else if (mode == Mode::wipe)
            state.draw_wipe(r, settings);
        else
            state.draw_side(r, mode == Mode::b, settings);
    }
    end_drawing();
    return state.target.texture();
}

Display::Compared Display::read_compared(const DisplaySettings& settings, int target_width,
                                         int target_height) {
    const PixelRect r = rect_of(settings, target_width, target_height);
    Compared sides{make_image(std::max(0, r.x1 - r.x0), std::max(0, r.y1 - r.y0), 4), {}};
    sides.b = sides.a;
    if (settings.a == 0 || settings.b == 0 || sides.a.pixels.empty()) return sides;
    State& state = *state_;
    state.values.resize(target_width, target_height, GL_RGBA32F);
    state.begin_drawing(state.values);
    DisplaySettings alone = settings;
    alone.dither = false;
    alone.inspection = {};
    alone.b_opacity = 1.0f;
    const auto read = [&](Image& side) {
        glReadPixels(r.x0, target_height - r.y1, r.x1 - r.x0, r.y1 - r.y0, GL_RGBA, GL_FLOAT,
                     side.pixels.data());
    };
    state.draw_side(r, false, alone);
    read(sides.a);
    state.draw_both(r, Mix::over, alone, true);
    read(sides.b);
    end_drawing();
    return sides;
}

std::uint64_t Display::version() const { return state_->version; }

std::vector<unsigned char> Display::read() const {
    const GlTarget& target = state_->target;
    return read_rgba8(target.framebuffer(), target.width(), target.height());
}

ScreenPoints Display::points() {
    constexpr int most_rows = 162;  // with 512 columns twice as wide as high: a waveform shows these apart
    const GlTarget& target = state_->target;
    GlTarget& points = state_->points;
    const PixelRect r = rect_of(state_->drawn, target.width(), target.height());
    if (r.empty() || (state_->drawn.a == 0 && state_->drawn.b == 0)) return {};
    const int width = r.x1 - r.x0, columns = width >= 512 ? 512 : std::min(256, width);
    points.resize(columns, std::min(most_rows, r.y1 - r.y0), GL_RGBA8);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, points.framebuffer());
    glBlitFramebuffer(r.x0, target.height() - r.y1, r.x1, target.height() - r.y0, 0, 0, points.width(),
                      points.height(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return {points.width(), read_rgba8(points.framebuffer(), points.width(), points.height())};
}

}  // namespace astrosplat

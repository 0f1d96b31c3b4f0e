// Triangles with interpolated colour and texture, "over" in 8 bits.
#include "gui/software_draw.h"

#include <fmt/format.h>
#include <fstream>
#include <optional>

namespace astrosplat {
namespace {

struct Clip {
    int x0, y0, x1, y1;
};

// In double, so that of two triangles that share an edge each pixel on it belongs to one.
double edge(const ImVec2& a, const ImVec2& b, float x, float y) {
    const double ax = double{a.x}, ay = double{a.y};
    return (double{b.x} - ax) * (double{y} - ay) - (double{b.y} - ay) * (double{x} - ax);
}

// Bilinear, clamped.
std::array<float, 4> sample(const Picture8& texture, float u, float v) {
    const float x = std::clamp(u * float(texture.width) - 0.5f, 0.0f, float(texture.width - 1));
    const float y = std::clamp(v * float(texture.height) - 0.5f, 0.0f, float(texture.height - 1));
    const int x0 = int(x), y0 = int(y);
    const int x1 = std::min(x0 + 1, texture.width - 1), y1 = std::min(y0 + 1, texture.height - 1);
    const float fx = x - float(x0), fy = y - float(y0);
    std::array<float, 4> sum{};
    const auto add = [&](const Rgba8& p, float weight) {
        const std::array<std::uint8_t, 4> channels{p.r, p.g, p.b, p.a};
        for (std::size_t i = 0; i < 4; ++i) sum[i] += weight * float(channels[i]) / 255.0f;
    };
    add(texture.at(x0, y0), (1 - fx) * (1 - fy));
    add(texture.at(x1, y0), fx * (1 - fy));
    add(texture.at(x0, y1), (1 - fx) * fy);
    add(texture.at(x1, y1), fx * fy);
    return sum;
}

void blend(Rgba8& under, const std::array<float, 4>& over) {
    const auto mix = [&](std::uint8_t& channel, float value) {
        const float sum = value * over[3] + float(channel) / 255.0f * (1.0f - over[3]);
        channel = std::uint8_t(std::lround(std::clamp(sum, 0.0f, 1.0f) * 255.0f));
    };
    mix(under.r, over[0]);
    mix(under.g, over[1]);
    mix(under.b, over[2]);
}

// Edges belong to a triangle when they are its upper or left ones, so that shared edges are drawn once.
bool owns_edge(const ImVec2& a, const ImVec2& b) { return b.y < a.y || (b.y == a.y && b.x > a.x); }

using Triangle = std::array<ImDrawVert, 3>;

bool same(const ImVec2& a, const ImVec2& b) { return a.x == b.x && a.y == b.y; }

/// Filled with one colour, or a gradient: all its corners show the white pixel.
bool is_plain(const Triangle& v) { return same(v[0].uv, v[1].uv) && same(v[0].uv, v[2].uv); }

/// A stroke whose soft edges come from the font's atlas, where ImGui keeps one row for every width.
bool is_stroke(const Triangle& v) {
    const ImVec4 *const rows = ImGui::GetIO().Fonts->TexUvLines, last = rows[IM_DRAWLIST_TEX_LINES_WIDTH_MAX];
    return !is_plain(v) && v[0].uv.y >= rows[0].y && v[0].uv.y <= last.y && v[0].uv.x >= last.x &&
           v[0].uv.x <= last.z;
}

/// A texture, or what stands for it in a schematic picture.
struct Surface {
    enum class Kind { texture, boxes, coordinates } kind;
    const Picture8* texture;

    std::array<float, 4> texel(float u, float t) const {
        if (kind == Kind::texture) return sample(*texture, u, t);
        if (kind == Kind::boxes) return {1.0f, 1.0f, 1.0f, 0.5f};
        return {std::floor(u * 16.0f) / 16.0f, std::floor(t * 16.0f) / 16.0f, 0.5f, 1.0f};
    }
};

void draw_triangle(Picture8& target, const Clip& clip, const Surface& surface, Triangle v) {
    double area = edge(v[0].pos, v[1].pos, v[2].pos.x, v[2].pos.y);
    if (area == 0.0) return;
    if (area < 0.0) {
        std::swap(v[1], v[2]);
        area = -area;
    }
    const auto [lx, hx] = std::minmax({v[0].pos.x, v[1].pos.x, v[2].pos.x});
    const auto [ly, hy] = std::minmax({v[0].pos.y, v[1].pos.y, v[2].pos.y});
    const int x0 = std::max(clip.x0, int(std::floor(lx))), x1 = std::min(clip.x1, int(std::ceil(hx)));
    const int y0 = std::max(clip.y0, int(std::floor(ly))), y1 = std::min(clip.y1, int(std::ceil(hy)));
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const float px = float(x) + 0.5f, py = float(y) + 0.5f;
            std::array<float, 3> w{};
            bool inside = true;
            for (std::size_t i = 0; i < 3 && inside; ++i) {
                const ImVec2 &a = v[(i + 1) % 3].pos, &b = v[(i + 2) % 3].pos;
                const double side = edge(a, b, px, py);
                inside = side > 0.0 || (side == 0.0 && owns_edge(a, b));
                w[i] = float(side / area);
            }
            if (!inside) continue;
            float u = 0, t = 0;
            std::array<float, 4> color{};
            for (std::size_t i = 0; i < 3; ++i) {
                u += w[i] * v[i].uv.x;
                t += w[i] * v[i].uv.y;
                for (std::size_t c = 0; c < 4; ++c)
                    color[c] += w[i] * float((v[i].col >> (8 * c)) & 0xFF) / 255.0f;
            }
            const std::array<float, 4> texel = surface.texel(u, t);
            for (std::size_t c = 0; c < 4; ++c) color[c] *= texel[c];
            blend(target.at(x, y), color);
        }
}

/// In [-1, 1], as good as random in `n`.
float noise(std::uint32_t n) {
    n = (n ^ (n >> 16)) * 0x45D9F3Bu;
    n = (n ^ (n >> 16)) * 0x45D9F3Bu;
    return float((n ^ (n >> 16)) & 0xFFFF) / 32767.5f - 1.0f;
}

/// Calls f(command, index of the first corner in the list, triangle) for all that can be drawn.
template <class Function>
void each_triangle(const ImDrawData& data, Function f) {
    for (int n = 0; n < data.CmdListsCount; ++n) {
        const ImDrawList& list = *data.CmdLists[n];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            if (command.UserCallback) continue;
            const ImDrawIdx* const index = list.IdxBuffer.Data + command.IdxOffset;
            const ImDrawVert* const vertex = list.VtxBuffer.Data + command.VtxOffset;
            for (unsigned i = 0; i + 2 < command.ElemCount; i += 3)
                f(command, index + i, Triangle{vertex[index[i]], vertex[index[i + 1]], vertex[index[i + 2]]});
        }
    }
}

bool is_of_font(const ImDrawCmd& command) { return command.GetTexID() == ImGui::GetIO().Fonts->TexID; }

/// An edge of a line along an axis: `at` on the other axis, from low to high along it.
struct Edge {
    bool vertical;
    float at, low, high;
};

std::optional<Edge> edge_along_axis(const ImVec2& a, const ImVec2& b, float least_length) {
    constexpr float most_slope = 1e-2f;
    const float dx = std::fabs(a.x - b.x), dy = std::fabs(a.y - b.y);
    if (dy >= least_length && dx <= most_slope)
        return Edge{true, a.x, std::min(a.y, b.y), std::max(a.y, b.y)};
    if (dx >= least_length && dy <= most_slope)
        return Edge{false, a.y, std::min(a.x, b.x), std::max(a.x, b.x)};
    return std::nullopt;
}

bool is_clear(const ImDrawVert& v) { return (v.col & IM_COL32_A_MASK) == 0; }

/// 0 on the border of two pixels, 0.5 in the middle of one.
float from_border(float at) { return std::fabs(at - std::round(at)); }

}  // namespace

std::vector<std::string> unsnapped_lines(const ImDrawData& data) {
    constexpr float most = 0.2f, thin = 3.0f, stroke_length = 6.0f, rim_length = 13.0f;
    std::vector<std::string> found;
    const ImDrawIdx* before = nullptr;  // of the triangle before this one
    Triangle other{};
    each_triangle(data, [&](const ImDrawCmd& command, const ImDrawIdx* index, const Triangle& v) {
        const auto judge = [&](const ImVec2& a, const ImVec2& b, float border, float least_length) {
            const std::optional<Edge> e = edge_along_axis(a, b, least_length);
            if (!e || from_border(e->at + border) <= most) return;
            const ImVec4& clip = command.ClipRect;
            const bool seen = e->vertical
                                  ? e->at > clip.x && e->at < clip.z && e->high > clip.y && e->low < clip.w
                                  : e->at > clip.y && e->at < clip.w && e->high > clip.x && e->low < clip.z;
            if (seen)
                found.push_back(
                    fmt::format("{} {} from {} to {}", e->vertical ? "x" : "y", e->at, e->low, e->high));
        };
        const bool rectangle = before && index == before + 3 && index[0] == before[0] &&
                               before[1] == before[0] + 1 && index[2] == before[0] + 3;
        for (std::size_t i = 0; i < 3 && is_of_font(command); ++i) {
            const ImDrawVert &a = v[i], &b = v[(i + 1) % 3];
            if (is_stroke(v) && same(a.uv, b.uv)) judge(a.pos, b.pos, 0.0f, stroke_length);
            // The rim of a filled shape is one pixel wide, about its border.
            if (is_plain(v) && is_clear(a) && is_clear(b) && !is_clear(v[(i + 2) % 3]))
                judge(a.pos, b.pos, 0.5f, rim_length);
        }
        if (is_of_font(command) && rectangle && is_plain(v)) {
            const ImVec2 lo = v[0].pos, hi = v[1].pos, across = other[1].pos;
            const bool upright = across.x == hi.x && across.y == lo.y;
            if (upright && std::min(hi.x - lo.x, hi.y - lo.y) <= thin) {
                judge(lo, {lo.x, hi.y}, 0.0f, stroke_length);
                judge({hi.x, lo.y}, hi, 0.0f, stroke_length);
                judge(lo, {hi.x, lo.y}, 0.0f, stroke_length);
                judge({lo.x, hi.y}, hi, 0.0f, stroke_length);
            }
        }
        before = index;
        other = v;
    });
    return found;
}

void software_draw(const ImDrawData& data, Picture8& target, Style style, float tremble_px) {
    each_triangle(data, [&](const ImDrawCmd& command, const ImDrawIdx* index, Triangle v) {
        const bool schematic = style == Style::schematic;
        if (!command.GetTexID() && !schematic) return;
        const Clip clip{std::max(0, int(command.ClipRect.x)), std::max(0, int(command.ClipRect.y)),
                        std::min(target.width, int(command.ClipRect.z)),
                        std::min(target.height, int(command.ClipRect.w))};
        const bool glyph = is_of_font(command) && !is_plain(v) && !is_stroke(v);
        const Surface surface{!schematic            ? Surface::Kind::texture
                              : glyph               ? Surface::Kind::boxes
                              : is_of_font(command) ? Surface::Kind::texture
                                                    : Surface::Kind::coordinates,
                              static_cast<const Picture8*>(command.GetTexID())};
        for (std::size_t i = 0; i < 3 && is_of_font(command) && !glyph; ++i) {
            v[i].pos.x += tremble_px * noise(2u * index[i]);
            v[i].pos.y += tremble_px * noise(2u * index[i] + 1u);
        }
        draw_triangle(target, clip, surface, v);
    });
}

Picture8 cropped(const Picture8& picture, const Part& part) {
    Picture8 result(part.width, part.height);
    for (int row = 0; row < part.height; ++row)
        for (int column = 0; column < part.width; ++column)
            result.at(column, row) = picture.at(part.x + column, part.y + row);
    return result;
}

Picture8 font_picture() {
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    Picture8 picture(width, height);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = {pixels[4 * i], pixels[4 * i + 1], pixels[4 * i + 2], pixels[4 * i + 3]};
    return picture;
}

void write_ppm(const fs::path& file, const Picture8& picture) {
    std::ofstream out(file, std::ios::binary);
    out << "P6\n" << picture.width << ' ' << picture.height << "\n255\n";
    for (const Rgba8& p : picture.pixels) out.put(char(p.r)).put(char(p.g)).put(char(p.b));
}

}  // namespace astrosplat

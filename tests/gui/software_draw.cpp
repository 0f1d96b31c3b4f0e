// Triangles with interpolated colour and texture, "over" in 8 bits.
#include "gui/software_draw.h"

#include <fstream>

namespace astrosplat {
namespace {

struct Clip {
    int x0, y0, x1, y1;
};

float edge(const ImVec2& a, const ImVec2& b, float x, float y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
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

/// A texture, or what stands for it in a schematic picture.
struct Surface {
    enum class Kind { texture, glyphs, coordinates } kind;
    const Picture8* texture;

    std::array<float, 4> texel(const std::array<const ImDrawVert*, 3>& v, float u, float t) const {
        if (kind == Kind::texture) return sample(*texture, u, t);
        if (kind == Kind::coordinates)
            return {std::floor(u * 16.0f) / 16.0f, std::floor(t * 16.0f) / 16.0f, 0.5f, 1.0f};
        const auto same = [&](const ImVec2& uv) { return uv.x == v[0]->uv.x && uv.y == v[0]->uv.y; };
        return {1.0f, 1.0f, 1.0f, same(v[1]->uv) && same(v[2]->uv) ? 1.0f : 0.5f};
    }
};

void draw_triangle(Picture8& target, const Clip& clip, const Surface& surface,
                   std::array<const ImDrawVert*, 3> v) {
    float area = edge(v[0]->pos, v[1]->pos, v[2]->pos.x, v[2]->pos.y);
    if (area == 0.0f) return;
    if (area < 0.0f) {
        std::swap(v[1], v[2]);
        area = -area;
    }
    const auto [lx, hx] = std::minmax({v[0]->pos.x, v[1]->pos.x, v[2]->pos.x});
    const auto [ly, hy] = std::minmax({v[0]->pos.y, v[1]->pos.y, v[2]->pos.y});
    const int x0 = std::max(clip.x0, int(std::floor(lx))), x1 = std::min(clip.x1, int(std::ceil(hx)));
    const int y0 = std::max(clip.y0, int(std::floor(ly))), y1 = std::min(clip.y1, int(std::ceil(hy)));
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const float px = float(x) + 0.5f, py = float(y) + 0.5f;
            std::array<float, 3> w{};
            bool inside = true;
            for (std::size_t i = 0; i < 3 && inside; ++i) {
                const ImVec2 &a = v[(i + 1) % 3]->pos, &b = v[(i + 2) % 3]->pos;
                w[i] = edge(a, b, px, py);
                inside = w[i] > 0.0f || (w[i] == 0.0f && owns_edge(a, b));
                w[i] /= area;
            }
            if (!inside) continue;
            float u = 0, t = 0;
            std::array<float, 4> color{};
            for (std::size_t i = 0; i < 3; ++i) {
                u += w[i] * v[i]->uv.x;
                t += w[i] * v[i]->uv.y;
                for (std::size_t c = 0; c < 4; ++c)
                    color[c] += w[i] * float((v[i]->col >> (8 * c)) & 0xFF) / 255.0f;
            }
            const std::array<float, 4> texel = surface.texel(v, u, t);
            for (std::size_t c = 0; c < 4; ++c) color[c] *= texel[c];
            blend(target.at(x, y), color);
        }
}

}  // namespace

void software_draw(const ImDrawData& data, Picture8& target, Style style) {
    for (int n = 0; n < data.CmdListsCount; ++n) {
        const ImDrawList& list = *data.CmdLists[n];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const bool schematic = style == Style::schematic;
            if (command.UserCallback || !(command.GetTexID() || schematic)) continue;
            const Clip clip{std::max(0, int(command.ClipRect.x)), std::max(0, int(command.ClipRect.y)),
                            std::min(target.width, int(command.ClipRect.z)),
                            std::min(target.height, int(command.ClipRect.w))};
            const bool font = command.GetTexID() == ImGui::GetIO().Fonts->TexID;
            const Surface surface{!schematic ? Surface::Kind::texture
                                  : font     ? Surface::Kind::glyphs
                                             : Surface::Kind::coordinates,
                                  static_cast<const Picture8*>(command.GetTexID())};
            const ImDrawIdx* index = list.IdxBuffer.Data + command.IdxOffset;
            const ImDrawVert* vertex = list.VtxBuffer.Data + command.VtxOffset;
            for (unsigned i = 0; i + 2 < command.ElemCount; i += 3)
                draw_triangle(target, clip, surface,
                              {vertex + index[i], vertex + index[i + 1], vertex + index[i + 2]});
        }
    }
}

Picture8 cropped(const Picture8& picture, int x, int y, int width, int height) {
    Picture8 part(width, height);
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) part.at(column, row) = picture.at(x + column, y + row);
    return part;
}

void write_ppm(const fs::path& file, const Picture8& picture) {
    std::ofstream out(file, std::ios::binary);
    out << "P6\n" << picture.width << ' ' << picture.height << "\n255\n";
    for (const Rgba8& p : picture.pixels) out.put(char(p.r)).put(char(p.g)).put(char(p.b));
}

}  // namespace astrosplat

// ImGui's triangles into a picture, without a graphics library: for looking at the window in tests.
#pragma once

#include <imgui.h>

#include "core/standard.h"

namespace astrosplat {

struct Rgba8 {
    std::uint8_t r = 0, g = 0, b = 0, a = 255;
    bool operator==(const Rgba8&) const = default;
};

struct Picture8 {
    int width = 0, height = 0;
    std::vector<Rgba8> pixels;  // top row first

    Picture8() = default;
    Picture8(int w, int h) : width(w), height(h), pixels(std::size_t(w) * std::size_t(h)) {}
    Rgba8& at(int x, int y) { return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
    const Rgba8& at(int x, int y) const { return const_cast<Picture8*>(this)->at(x, y); }
};

/// A part of a picture, px from its upper left corner.
struct Part {
    int x, y, width, height;
};
Picture8 cropped(const Picture8& picture, const Part& part);

/// Schematic: glyphs are boxes and other textures show their coordinates, so that the picture depends
/// neither on how fonts are rasterised nor on what a renderer made.
enum class Style { as_seen, schematic };

/// Draws over `target`. ImTextureIDs are `const Picture8*`. `tremble_px`: all but glyphs and pictures is
/// moved by up to so much, every corner its own way.
void software_draw(const ImDrawData& data, Picture8& target, Style style = Style::as_seen,
                   float tremble_px = 0.0f);

/// Where edges of lines along an axis lie so near the middle of a pixel that a quarter of a pixel would
/// change which pixels they cover: "x 12.5 from 3 to 80". Lines are ImGui's strokes, the rims of its filled
/// shapes, and plain rectangles of at most 3 px. Pieces of curves (below 6 px) and small signs (below 13) do
/// not count.
std::vector<std::string> unsnapped_lines(const ImDrawData& data);

/// The atlas of the current context's fonts, built.
Picture8 font_picture();

/// Binary PPM, colours only.
void write_ppm(const fs::path& file, const Picture8& picture);

}  // namespace astrosplat

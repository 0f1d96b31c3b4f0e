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

/// The part of `width` x `height` px whose upper left corner is (x, y); it lies in the picture.
Picture8 cropped(const Picture8& picture, int x, int y, int width, int height);

/// Schematic: glyphs are boxes and other textures show their coordinates, so that the picture depends
/// neither on how fonts are rasterised nor on what a renderer made.
enum class Style { as_seen, schematic };

/// Draws over `target`. ImTextureIDs are `const Picture8*`.
void software_draw(const ImDrawData& data, Picture8& target, Style style = Style::as_seen);

/// Binary PPM, colours only.
void write_ppm(const fs::path& file, const Picture8& picture);

}  // namespace astrosplat

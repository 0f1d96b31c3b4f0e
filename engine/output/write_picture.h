// Plain 8-bit pictures, as they stand on a screen: screenshots and thumbnails.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace astrosplat {

/// Writes width x height px of RGBA bytes, top row first, atomically; the ending chooses the format. The
/// colour is written, alpha is left out. Throws OutputError.
void write_picture(const std::filesystem::path& file, std::int64_t width, std::int64_t height,
                   std::span<const unsigned char> rgba);

/// A PNG file in memory, of width x height px of RGB bytes, top row first. Throws OutputError.
std::string png_bytes(std::int64_t width, std::int64_t height, std::span<const unsigned char> rgb);

}  // namespace astrosplat

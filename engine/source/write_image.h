// Plain pictures: of 8 bits, as they stand on a screen (screenshots and thumbnails), and of linear light.
#pragma once

#include "core/atomic_file.h"
#include "core/image.h"

namespace astrosplat {

/// Writes width x height px of RGBA bytes, top row first, atomically; the ending chooses the format. The
/// colour is written, alpha is left out; a credit goes into the header. Throws OutputError.
void write_image(const fs::path& file, std::int64_t width, std::int64_t height,
                 std::span<const unsigned char> rgba, const std::string& credit = "");

/// Writes linear light of 3 channels, or 4 with a premultiplied alpha, as an EXR file of 32-bit floats,
/// atomically. `credit`, and metadata as a packet (xmp_packet), go into its header where there are any.
/// Throws OutputError.
void write_linear_image(const fs::path& file, const Image& image, const std::string& credit,
                        Existing existing, const std::string& xmp = "");

/// A PNG file in memory, of width x height px of RGB bytes, top row first. Throws OutputError.
std::string png_bytes(std::int64_t width, std::int64_t height, std::span<const unsigned char> rgb);

}  // namespace astrosplat

// A cube map as OpenEXR has them: six square faces one above the other in one file.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
// fmt first: OpenImageIO's copy of it would turn exceptions off.
#include <OpenImageIO/imageio.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

namespace astrosplat {

/// Writes a cube map of `edge` px with value(x, y) in all three channels; y runs through the six faces. It is
/// an uncompressed EXR with the attribute "envmap" put before its others and the offsets of the rows moved.
/// (OpenImageIO 2.4 cannot write one.)
inline void write_cube_map(const fs::path& file, int edge, const std::function<float(int x, int y)>& value) {
    const auto rows = std::size_t(6 * edge), row_bytes = std::size_t(edge) * 12;
    OIIO::ImageSpec spec(edge, 6 * edge, 3, OIIO::TypeFloat);
    spec.attribute("compression", "none");
    std::vector<float> pixels;
    for (int y = 0; y < 6 * edge; ++y)
        for (int x = 0; x < edge; ++x) pixels.insert(pixels.end(), 3, value(x, y));
    {
        const auto out = OIIO::ImageOutput::create(file.string());
        ASSERT_TRUE(out && out->open(file.string(), spec) &&
                    out->write_image(OIIO::TypeFloat, pixels.data()) && out->close());
    }
    std::ifstream in(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const std::string attribute("envmap\0envmap\0\1\0\0\0\1", 19);
    const std::size_t table = bytes.size() - rows * (8 + row_bytes) - rows * 8;
    for (std::size_t row = 0; row < rows; ++row) {
        std::uint64_t offset = 0;
        std::memcpy(&offset, bytes.data() + table + 8 * row, 8);
        ASSERT_EQ(offset, table + rows * 8 + row * (8 + row_bytes));
        offset += attribute.size();
        std::memcpy(bytes.data() + table + 8 * row, &offset, 8);
    }
    bytes.insert(8, attribute);
    std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace astrosplat

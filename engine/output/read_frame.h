// Headers of frame files, and of pictures of any kind.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "camera/camera.h"
#include "core/image.h"

namespace astrosplat {

struct ImageInfo {
    std::int64_t width = 0, height = 0;  // px, of the pixels stored
    std::int64_t x = 0, y = 0;           // px, where they lie in the whole frame
    std::int64_t whole_width = 0, whole_height = 0;
    std::string file_format;                                    // "openexr", "tiff", "png", ...
    std::vector<std::pair<std::string, std::string>> channels;  // name and type: "R", "half"
    std::vector<std::pair<std::string, std::string>> metadata;  // everything else in the header, as text
};

/// The header of a picture file, without reading its pixels. Throws InputError when the
/// file cannot be opened as a picture.
ImageInfo read_image_info(const std::filesystem::path& file);

/// The header of a frame file.
struct FrameHeader {
    std::optional<std::int64_t> frame;
    std::string frame_hash, pixel_hash;  // hex
    std::string hashed_text;  // what the frame hash was made of; empty in frames that older versions wrote
    bool dwaa = false;        // compressed with a loss
    Eye eye = Eye::centre;
    std::int64_t whole_width = 0, whole_height = 0;  // px
    Region region{};                                 // of the whole frame; empty: all
};
/// Fields that are not told, or not in a readable way, are empty; all of them where the file is no picture.
FrameHeader read_frame_header(const std::filesystem::path& file);

/// True when the file can be read to its last pixel.
bool frame_is_whole(const std::filesystem::path& file);

}  // namespace astrosplat

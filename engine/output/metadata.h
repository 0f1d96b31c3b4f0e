// The metadata of a frame file. Written: its header as text pairs that every format can hold (no host,
// user or clock), with the canonical text of frame_hash.h, deflated and in letters. Read: the header of a
// stored frame, whatever its format, which keys differ between two frames, and of pictures of any kind.
#pragma once

#include <map>

#include "camera/camera.h"
#include "core/image.h"
#include "output/write.h"

namespace astrosplat {

using MetadataEntries = std::vector<std::pair<std::string, std::string>>;

/// "astrosplat/version", "/frameHash", "/pixelHash", "/seed", "/frame", "/fps" and, where not empty,
/// "/hashed" (deflate_text), "/title", "/credit", "/type", "/origin".
MetadataEntries metadata_entries(const FrameMetadata& metadata);

/// The same for programs that read AVM, with what the sources say of object and colours: an XMP packet. Its
/// ID is the frame hash.
std::string frame_xmp(const FrameMetadata& metadata);

/// What a frame's file says, for a movie of it and others: a file of metadata for ffmpeg, with title, artist
/// and copyright (the credit), and all the rest in words as comment.
/// `movie_hash`: of all frames and their rate.
std::string movie_metadata(const fs::path& frame, const std::string& movie_hash);

/// The entries as lines "name=value" (line breaks in values become spaces): TIFF's ImageDescription.
std::string metadata_lines(const MetadataEntries& entries);
/// Such lines by name; the first of those with one name.
std::map<std::string, std::string> parse_metadata_lines(std::string_view lines);

/// Frames per second as a fraction: 24 is 24/1, 23.976 is 24000/1001; others to a thousandth.
struct Rational {
    int numerator, denominator;
};
Rational rational_fps(double fps);

/// Lines "key = value" as one line of printable letters.
std::string pack_hashed_text(const std::string& text);
/// The text again; nothing where it is no such line, or one of more than 64 MiB.
std::optional<std::string> unpack_hashed_text(const std::string& packed);

/// The value behind "KEY =" without blanks around it; nothing where no line has the key.
std::optional<std::string> hashed_value(const std::string& text, const std::string& key);

/// A key with other values in two texts. A value is empty where that text does not have the key: what does
/// not reach the pixels is not hashed. Of keys with several lines the values are joined with "; ".
struct KeyDifference {
    std::string key, first, second;
    bool operator==(const KeyDifference&) const = default;
};
/// In the order of the first text, then of the second.
std::vector<KeyDifference> differing_keys(const std::string& first, const std::string& second);

/// A frame file's header, as the readers of the three formats answer it; they answer nothing where the file
/// is none of their format or damaged.
struct StoredHeader {
    std::int64_t whole_width = 0, whole_height = 0;  // px
    Region region{};                                 // of what is stored in the whole
    std::map<std::string, std::string> texts;        // "astrosplat/frameHash", ..., "view"
    bool dwaa = false;                               // compressed with a loss
};

struct ImageInfo {
    std::int64_t width = 0, height = 0;  // px, of the pixels stored
    std::int64_t x = 0, y = 0;           // px, where they lie in the whole frame
    std::int64_t whole_width = 0, whole_height = 0;
    std::string file_format;                                    // "openexr", "tiff", "png", ...
    std::vector<std::pair<std::string, std::string>> channels;  // name and type: "R", "half"
    std::vector<std::pair<std::string, std::string>> metadata;  // everything else in the header, as text
    std::vector<std::string> parts = {};  // of a file of several pictures each; else none
};

/// The header of a picture file (of several pictures in it that which is taken), without reading its pixels.
/// Throws InputError when the file cannot be opened as a picture.
ImageInfo read_image_info(const fs::path& file);

/// The header of a frame file. The stored size and region are those of its hashed text, where it has one.
struct FrameHeader : StoredHeader {
    std::optional<std::int64_t> frame;
    std::string frame_hash, pixel_hash;  // hex
    std::string hashed_text;  // what the frame hash was made of; empty in frames that older versions wrote
    Eye eye = Eye::centre;
};
/// Fields that are missing, or not readable, are empty; all of them where the file is no picture.
FrameHeader read_frame_header(const fs::path& file);

/// True when the file can be read to its last pixel.
bool frame_is_whole(const fs::path& file);

}  // namespace astrosplat

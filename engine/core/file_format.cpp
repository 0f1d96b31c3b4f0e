// The table, and its look-up by name and by content.
#include "core/file_format.h"

#include "core/file.h"
#include "core/text.h"

namespace astrosplat {

using namespace std::string_view_literals;

// OpenImageIO's own movies and "null" are left out on purpose: they open files that are no pictures.
std::span<const FileFormat> file_formats() {
    using enum FileKind;
    using enum FileUse;
    static const std::vector<FileFormat> table = {
        {"openexr", "OpenEXR", picture, {".exr"}, {"\x76\x2f\x31\x01"}, written},
        {"tiff", "TIFF", picture, {".tif", ".tiff"}, {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}, written},
        {"png", "PNG", picture, {".png"}, {"\x89PNG\r\n\x1a\n"}, written},
        {"jpeg", "JPEG", picture, {".jpg", ".jpeg"}, {"\xff\xd8\xff"}},
        {"fits",
         "FITS",
         picture,
         {".fits", ".fit", ".fts", ".fits.gz", ".fit.gz", ".fts.gz", ".fits.bz2", ".fit.bz2", ".fts.bz2",
          ".fits.fz"},
         {"SIMPLE  ="}},
        {"xisf", "XISF", picture, {".xisf"}, {"XISF0100"}},
        {"hdr", "Radiance HDR", picture, {".hdr"}, {"#?RADIANCE", "#?RGBE"}},
        {"dpx", "DPX", picture, {".dpx"}, {"SDPX", "XPDS"}},
        {"webp", "WebP", picture, {".webp"}, {"RIFF????WEBP"}},
        {"jpeg2000", "JPEG 2000", picture, {".jp2"}, {"\0\0\0\x0cjP  "sv, "\xff\x4f\xff\x51"}},
        {"psd", "Photoshop", picture, {".psd"}, {"8BPS"}},
        {"bmp", "BMP", picture, {".bmp"}, {}},
        {"gif", "GIF", picture, {".gif"}, {"GIF87a", "GIF89a"}},
        {"targa", "TGA", picture, {".tga"}, {}},
        {"pnm",
         "PNM",
         picture,
         {".ppm", ".pgm", ".pnm", ".pbm", ".pfm"},
         {"P1\n", "P2\n", "P3\n", "P4\n", "P5\n", "P6\n", "PF\n", "Pf\n"}},
        {"heif",
         "HEIF",
         picture,
         {".heic", ".heif", ".avif"},
         {"????ftyphei", "????ftypmif1", "????ftypavi"}},
        {"jpegxl",
         "JPEG XL",
         picture,
         {".jxl"},
         {"\xff\x0a", "\0\0\0\x0cJXL \r\n"sv},
         read,
         "djxl FILE.jxl FILE.png, of the package libjxl-tools, makes a PNG of it"},
        {"raw",
         "camera raw",
         picture,
         {".dng", ".nef", ".arw", ".pef", ".cr2", ".cr3", ".orf", ".rw2", ".raf"},
         {}},
        {"chan", "Nuke's chan", unknown, {".chan"}, {}, camera_read | camera_written},
        {"gaia_sky", "Gaia Sky", unknown, {".gsc"}, {}, camera_read},
        {"openspace", "OpenSpace", unknown, {".osrectxt"}, {}, camera_read},
        {"transforms", "transforms.json", unknown, {".json"}, {}, camera_read},
        {"table", "CSV", unknown, {".csv"}, {}, camera_read | camera_written},
        {"obj", "OBJ", mesh, {".obj"}, {}},
        {"pda", "PDA", splats, {".pda"}, {"ATTRIBUTES"}, written},
        {"ply", "PLY", splats, {{".ply", exported}}, {"ply\n", "ply\r"}, written},
        {"gltf", "glTF", splats, {{".glb", exported}, {".gltf", camera_written}}, {"glTF"}, camera_read},
        {"usda", "USD", splats, {{".usda", exported | camera_written}, ".usd"}, {"#usda"}, camera_read},
        {"spz", "SPZ", splats, {{".spz", exported}}, {"NGSP"}},  // gzip around older ones is anyone's
        {"splat", "SPLAT", splats, {".splat"}, {}},
        {"sog", "SOG", splats, {".sog"}, {}},
        {"splats", "SPLATS", splats, {".splats"}, {"\x89SPLAT\r\n"}, written},
        {"openvdb", "OpenVDB", unknown, {".vdb"}, {}, exported},
        {"movie", "MP4, QuickTime or Matroska", unknown, {".mp4", ".mov", ".mkv"}, {}, movie},
        {"toml", "TOML", scene, {".toml"}, {}, written},
    };
    return table;
}

namespace {

constexpr std::size_t longest_magic = 16;

bool begins_with(std::string_view bytes, std::string_view magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(),
                      [](char wanted, char found) { return wanted == '?' || wanted == found; });
}

template <class Wanted>
const FileFormat* find(const Wanted& wanted) {
    const auto found = std::ranges::find_if(file_formats(), wanted);
    return found == file_formats().end() ? nullptr : &*found;
}

bool is_used(const FileFormat& format, const FileEnding& ending, FileUse use) {
    return includes(format.uses | ending.uses, use);
}

template <class Wanted>
std::vector<std::string> endings_where(const Wanted& wanted) {
    std::vector<std::string> endings;
    for (const FileFormat& format : file_formats())
        for (const FileEnding& ending : format.endings)
            if (wanted(format, ending)) endings.emplace_back(ending.text);
    return endings;
}

}  // namespace

const FileFormat* format_by_name(const fs::path& file, FileUse use) {
    const std::string name = lower_case(file.filename().string());
    return find([&](const FileFormat& format) {
        return std::ranges::any_of(format.endings, [&](const FileEnding& ending) {
            return name.size() > ending.text.size() && name.ends_with(ending.text) &&
                   is_used(format, ending, use);
        });
    });
}

const FileFormat* format_of_file(const fs::path& file) {
    const std::string bytes = read_beginning(file, longest_magic);
    const FileFormat* by_content = find([&](const FileFormat& format) {
        return std::ranges::any_of(format.magic,
                                   [&](std::string_view magic) { return begins_with(bytes, magic); });
    });
    const FileFormat* const by_name = format_by_name(file);
    // Most cameras' files are TIFF inside, with a small picture in front.
    const bool is_raw = by_content && by_content->id == "tiff" && by_name && by_name->id == "raw";
    return by_content && !is_raw ? by_content : by_name;
}

FileKind kind_of(const FileFormat* format) { return format ? format->kind : FileKind::unknown; }

std::vector<std::string> endings_of(std::initializer_list<FileKind> kinds, FileUse use) {
    return endings_where([&](const FileFormat& format, const FileEnding& ending) {
        return is_used(format, ending, use) && std::ranges::find(kinds, format.kind) != kinds.end();
    });
}

std::vector<std::string> endings_of(FileUse use) {
    return endings_where(
        [&](const FileFormat& format, const FileEnding& ending) { return is_used(format, ending, use); });
}

std::string names_of(FileKind kind, FileUse use) {
    std::vector<std::string> names;
    for (const FileFormat& format : file_formats())
        if (format.kind == kind && format.converter.empty() && is_used(format, format.endings.front(), use))
            names.emplace_back(format.name);
    return alternatives(names);
}

std::string_view conversion_advice(const fs::path& file) {
    const std::string name = lower_case(file.filename().string());
    if (name.ends_with(".abc")) return " (Alembic is not read: save cameras as .usda or .chan)";
    if (name.ends_with(".fbx")) return " (FBX is not read: save cameras as .usda or .chan)";
    return name.ends_with(".ksplat") || name == "meta.json" ? " (splat-transform makes a .ply of it)" : "";
}

}  // namespace astrosplat

#include "camera_files/read_camera.h"

#include <string_view>
#include <utility>

#include "camera_files/formats.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/text.h"

namespace astrosplat {
namespace {

using ReadTrack = CameraTrack (*)(const std::filesystem::path& file, const FrameRate& rate);

constexpr std::pair<std::string_view, ReadTrack> readers[] = {
    {"chan", read_chan}, {"gaia_sky", read_gaia_sky},          {"openspace", read_openspace},
    {"gltf", read_gltf}, {"transforms", read_transforms_json}, {"usda", read_usda}};

ReadTrack reader_of(const std::filesystem::path& file) {
    const FileFormat* const format = format_by_name(file);
    for (const auto& [id, read] : readers)
        if (format && format->id == id) return read;
    return nullptr;
}

}  // namespace

bool is_camera_file(const std::filesystem::path& file) { return reader_of(file) != nullptr; }

CameraTrack read_camera(const std::filesystem::path& file, const FrameRate& rate) {
    const ReadTrack read = reader_of(file);
    if (!read)
        bad_input(file.string(), "", "a name ending in " + alternatives(endings_of(FileUse::camera_read)),
                  "'" + printable(file.extension().string()) + "'");
    return read(file, rate);
}

}  // namespace astrosplat

#include "camera_files/read_camera.h"

#include <algorithm>

#include "camera_files/formats.h"
#include "core/error.h"
#include "core/text.h"

namespace astrosplat {
namespace {

struct Format {
    std::string ending;
    CameraTrack (*read)(const std::filesystem::path& file, const FrameRate& rate);
};

const std::vector<Format>& formats() {
    static const std::vector<Format> all{{".chan", read_chan},          {".gsc", read_gaia_sky},
                                         {".osrectxt", read_openspace}, {".gltf", read_gltf},
                                         {".glb", read_gltf},           {".json", read_transforms_json},
                                         {".usda", read_usda},          {".usd", read_usda}};
    return all;
}

const Format* format_of(const std::filesystem::path& file) {
    const auto found = std::ranges::find(formats(), lower_case(file.extension().string()), &Format::ending);
    return found == formats().end() ? nullptr : &*found;
}

}  // namespace

const std::vector<std::string>& camera_file_endings() {
    static const std::vector<std::string> endings = [] {
        std::vector<std::string> result;
        for (const Format& format : formats()) result.push_back(format.ending);
        return result;
    }();
    return endings;
}

bool is_camera_file(const std::filesystem::path& file) { return format_of(file) != nullptr; }

CameraTrack read_camera(const std::filesystem::path& file, const FrameRate& rate) {
    const Format* format = format_of(file);
    if (!format)
        bad_input(file.string(), "", "a name ending in " + alternatives(camera_file_endings()),
                  "'" + printable(file.extension().string()) + "'");
    return format->read(file, rate);
}

}  // namespace astrosplat

#include "camera_files/camera_track.h"

#include <glm/geometric.hpp>

#include "camera_files/formats.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/text.h"

namespace astrosplat {
namespace {

bool normalise(glm::dvec3& v) {
    const double largest = std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
    if (!(largest > 0.0) || !std::isfinite(largest)) return false;
    v /= largest;  // squares of 1e200 overflow
    v /= glm::length(v);
    return true;
}

bool is_mirrored(const glm::dmat3& m) { return glm::dot(glm::cross(m[2], m[0]), m[1]) < 0.0; }

// The largest of the four numbers first, so that nothing is divided by a small one.
glm::dvec4 quaternion_of(const glm::dmat3& m) {
    const double trace = m[0][0] + m[1][1] + m[2][2];
    glm::dvec4 q;
    if (trace > 0.0) {
        const double s = 2.0 * std::sqrt(trace + 1.0);
        q = {(m[1][2] - m[2][1]) / s, (m[2][0] - m[0][2]) / s, (m[0][1] - m[1][0]) / s, 0.25 * s};
    } else {
        const int i = m[0][0] >= m[1][1] && m[0][0] >= m[2][2] ? 0 : m[1][1] >= m[2][2] ? 1 : 2;
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double s = 2.0 * std::sqrt(std::fmax(0.0, 1.0 + m[i][i] - m[j][j] - m[k][k]));
        q[i] = 0.25 * s;
        q[j] = (m[i][j] + m[j][i]) / s;
        q[k] = (m[i][k] + m[k][i]) / s;
        q.w = (m[j][k] - m[k][j]) / s;
    }
    return q / glm::length(q);
}

using ReadTrack = CameraTrack (*)(const fs::path& file, const FrameRate& rate);

constexpr std::pair<std::string_view, ReadTrack> readers[] = {
    {"chan", read_chan}, {"gaia_sky", read_gaia_sky},          {"openspace", read_openspace},
    {"gltf", read_gltf}, {"transforms", read_transforms_json}, {"usda", read_usda}};

ReadTrack reader_of(const fs::path& file) {
    const FileFormat* const format = format_by_name(file);
    for (const auto& [id, read] : readers)
        if (format && format->id == id) return read;
    return nullptr;
}

}  // namespace

bool set_axes(const glm::dmat3& axes, const std::string& file, TrackSample& sample, CameraTrack& track) {
    const auto tell = [&](const std::string& what) {
        const std::string line = file + ": the camera is " + what;
        if (std::ranges::count(track.warnings, line) == 0) track.warnings.push_back(line);
    };
    if (is_mirrored(axes)) tell("mirrored, which no frame is: its up and its view stay");
    for (int c = 0; c < 3; ++c)
        if (const glm::dvec3 a = axes[c], b = axes[(c + 1) % 3];
            std::fabs(glm::dot(a, b)) > 1e-3 * glm::length(a) * glm::length(b))  // beyond what files round
            tell("sheared, which no frame is: its view stays");
    return quaternion_from_axes(axes, sample.rotation);
}

bool quaternion_from_axes(const glm::dmat3& world_from_camera, glm::dvec4& quaternion) {
    glm::dvec3 x = world_from_camera[0], z = world_from_camera[2];
    if (!normalise(z) || !normalise(x)) return false;
    if (is_mirrored(world_from_camera)) x = -x;
    x -= z * glm::dot(x, z);
    if (!(glm::length(x) > 1e-9) || !normalise(x)) return false;
    quaternion = quaternion_of(glm::dmat3(x, glm::cross(z, x), z));
    return true;
}

bool quaternion_from_view(const glm::dvec3& direction, const glm::dvec3& up, glm::dvec4& quaternion) {
    glm::dvec3 back = -direction, above = up;
    if (!normalise(back) || !normalise(above)) return false;
    return quaternion_from_axes(glm::dmat3(glm::cross(above, back), above, back), quaternion);
}

bool is_camera_file(const fs::path& file) { return reader_of(file) != nullptr; }

CameraTrack read_camera(const fs::path& file, const FrameRate& rate) {
    const ReadTrack read = reader_of(file);
    if (!read)
        bad_input(file, "a name ending in " + alternatives(endings_of(FileUse::camera_read)),
                  "'" + printable(file.extension().string()) + "'");
    return read(file, rate);
}

}  // namespace astrosplat

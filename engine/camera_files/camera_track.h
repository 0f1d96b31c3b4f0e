// A camera's way through another program's scene, as plain samples: what every reader of camera files gives
// and every writer takes. In: frames of the output, places in the file's units and axes. The readers turn
// their angles into quaternions and their lenses into vertical fields of view; nothing else is converted.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "camera/camera.h"
#include "core/standard.h"

namespace astrosplat {

struct TrackSample {
    double frame = 0.0;                       // ascending through a track
    glm::dvec3 eye{0.0};                      // units of the file
    glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};  // quaternion x y z w, world from camera, length 1
    double fov_deg = 0.0;   // vertical; of a fisheye its cone; meaningless where the track has none
    double height = 0.0;    // units of the file from bottom to top, orthographic tracks
    glm::dvec2 shift{0.0};  // of what a perspective frame shows, its heights to the right and up
};

enum class FileUp { y, z };

struct CameraTrack {
    std::vector<TrackSample> samples;  // at least one; between them cameras move in straight lines
    bool has_fov = false;              // every sample has fov_deg
    bool has_shift = false;            // some sample has a shift other than 0
    /// Orthographic: every sample has height instead of fov_deg.
    Projection projection = Projection::perspective;
    FileUp up = FileUp::y;              // the file's own word, or its format's habit
    double fps = 0.0;                   // as the file says; 0: it does not
    std::vector<std::string> warnings;  // odd but usable: one line each, with the file's name

    bool orthographic() const { return projection == Projection::orthographic; }
};

/// How frames of a file become frames of the output.
struct FrameRate {
    double output_fps = 24.0;  // 1/s
    double file_fps = 0.0;     // of a file that counts frames; 0: as the file says, else the output's

    /// Frames of the output in a frame of a file that says `own_fps`; 0: it says nothing.
    double output_frames(double own_fps = 0.0) const {
        const double fps = file_fps > 0.0 ? file_fps : own_fps;
        return fps > 0.0 ? output_fps / fps : 1.0;
    }
};

/// The longest track that is read: a day at 60 frames a second, and then some.
inline constexpr std::int64_t most_camera_samples = 6'000'000;

/// Nearest quaternion of axes that are orthogonal but for rounding and scale: the viewing axis (column 2) is
/// kept, then x, which is turned round where the axes are mirrored: up stays up. Returns false where they
/// span no space.
bool quaternion_from_axes(const glm::dmat3& world_from_camera, glm::dvec4& quaternion);

/// Looking along `direction` with `up` up. Returns false where the two are parallel or zero.
bool quaternion_from_view(const glm::dvec3& direction, const glm::dvec3& up, glm::dvec4& quaternion);

/// Whether the name ends as one of such files does, in capitals or not (core/file_format.h).
bool is_camera_file(const fs::path& file);

/// A file of one of these endings. Throws InputError, one line with file, line (where the format has lines),
/// expectation and finding.
CameraTrack read_camera(const fs::path& file, const FrameRate& rate);

}  // namespace astrosplat

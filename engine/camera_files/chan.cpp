#include "camera_files/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/camera.h"
#include "core/file.h"
#include "core/real.h"
#include "core/text.h"

namespace astrosplat {
namespace {

// Ry * Rx * Rz: z acts first.
glm::dvec4 quaternion_from_zxy(const glm::dvec3& degrees) {
    const double x = 0.5 * real::radians(degrees.x), y = 0.5 * real::radians(degrees.y),
                 z = 0.5 * real::radians(degrees.z);
    const double cx = real::cos(x), sx = real::sin(x), cy = real::cos(y), sy = real::sin(y),
                 cz = real::cos(z), sz = real::sin(z);
    return {cy * sx * cz + sy * cx * sz, sy * cx * cz - cy * sx * sz, cy * cx * sz - sy * sx * cz,
            cy * cx * cz + sy * sx * sz};
}

glm::dvec3 zxy_from_quaternion(const glm::dvec4& q) {
    const glm::dmat3 m = rotation_from_quaternion(q);  // m[column][row]
    const double sine = -m[2][1];
    constexpr double nearly_one = 1.0 - 1e-14;  // looking straight up or down: all the rest is yaw
    const bool pole = std::fabs(sine) > nearly_one;
    const double cosine = std::sqrt(m[2][0] * m[2][0] + m[2][2] * m[2][2]);
    const double x = real::atan2(sine, cosine);
    const double y = pole ? real::atan2(-m[0][2], m[0][0]) : real::atan2(m[2][0], m[2][2]);
    const double z = pole ? 0.0 : real::atan2(m[0][1], m[1][1]);
    return {real::degrees(x), real::degrees(y), real::degrees(z)};
}

/// Angles beyond one turn, such as a spinning camera has, within what our sines take.
double within_turn(double degrees) { return std::fmod(degrees, 360.0); }

/// The turn of `angle` nearest to the one of the frame before, so that other programs interpolate.
double unrolled(double angle, double before) {
    return angle + 360.0 * std::floor((before - angle) / 360.0 + 0.5);
}

}  // namespace

CameraTrack read_chan(const std::filesystem::path& file, const FrameRate& rate) {
    const std::string text = read_file(file);
    TextRows rows(text, file.string());
    const double factor = rate.file_fps > 0.0 ? rate.output_fps / rate.file_fps : 1.0;
    CameraTrack track;
    std::size_t columns = 0;
    while (rows.next()) {
        const auto& words = rows.fields();
        if (words.size() < 7 || words.size() > 8 || (columns && words.size() != columns))
            rows.fail(columns ? fmt::format("{} numbers as in the lines before", columns)
                              : "frame tx ty tz rx ry rz and perhaps fov, 7 or 8 numbers",
                      std::to_string(words.size()));
        columns = words.size();
        const auto number = [&](std::size_t i, const char* what) { return rows.number(words[i], what); };
        TrackSample sample;
        sample.frame = number(0, "the frame") * factor;
        sample.eye = {number(1, "tx"), number(2, "ty"), number(3, "tz")};
        sample.rotation = quaternion_from_zxy(
            {within_turn(number(4, "rx")), within_turn(number(5, "ry")), within_turn(number(6, "rz"))});
        if (columns == 8) sample.fov_deg = number(7, "fov");
        if (columns == 8 && !(sample.fov_deg > 0.0 && sample.fov_deg < 180.0))
            rows.fail("a vertical field of view between 0 and 180 degrees", std::string(words[7]));
        if (!track.samples.empty() && !(sample.frame > track.samples.back().frame))
            rows.fail("ascending frames, each once", fmt::format("{} after {}", shortest(sample.frame),
                                                                 shortest(track.samples.back().frame)));
        track.samples.push_back(sample);
    }
    if (track.samples.empty()) rows.fail("frame tx ty tz rx ry rz", "no line of numbers");
    track.has_fov = columns == 8;
    track.fps = rate.file_fps;
    return track;
}

std::string chan_text(const CameraTrack& track) {
    std::string text;
    glm::dvec3 before(0.0);
    for (const TrackSample& sample : track.samples) {
        glm::dvec3 degrees = zxy_from_quaternion(sample.rotation);
        for (int i = 0; i < 3; ++i) degrees[i] = unrolled(degrees[i], before[i]);
        before = degrees;
        text += fmt::format("{} {} {} {} {} {} {}", shortest(sample.frame), shortest(sample.eye.x),
                            shortest(sample.eye.y), shortest(sample.eye.z), shortest(degrees.x),
                            shortest(degrees.y), shortest(degrees.z));
        text += track.has_fov ? " " + shortest(sample.fov_deg) + "\n" : "\n";
    }
    return text;
}

}  // namespace astrosplat

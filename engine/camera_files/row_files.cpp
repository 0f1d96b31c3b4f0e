// Cameras in lines of numbers: .chan, and the recordings of Gaia Sky and OpenSpace.
#include "camera_files/formats.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

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

constexpr double gaia_sky_fps = 60.0;

using Words = std::vector<std::string_view>;

glm::dvec3 vector_of(const TextRows& rows, const Words& words, std::size_t first, const char* what) {
    glm::dvec3 v;
    for (int i = 0; i < 3; ++i) v[i] = rows.number(words[first + std::size_t(i)], what);
    return v;
}

void check_count(const TextRows& rows, std::int64_t count) {
    if (count >= most_camera_samples)
        rows.fail(fmt::format("at most {} frames", most_camera_samples), "more");
}

/// Where an OpenSpace format has its numbers.
struct Columns {
    std::string_view version;  // as the first line ends
    std::size_t time, place, quaternion, body, count;
    bool w_first;
};
constexpr Columns openspace_columns[] = {{"01.00A", 2, 4, 7, 13, 14, false},
                                         {"02.00A", 1, 3, 6, 12, 13, false},
                                         {"03.00A", 1, 3, 6, 12, 13, true}};

const Columns& columns_of(TextRows& rows) {
    if (!rows.next()) rows.fail("an OpenSpace recording", "an empty file");
    constexpr std::string_view begin = "OpenSpace_record/playback";
    const std::string_view line = rows.text();
    if (line.starts_with(begin))
        for (const Columns& columns : openspace_columns)
            if (line.substr(begin.size()) == columns.version) return columns;
    rows.fail("OpenSpace_record/playback with format 01.00A, 02.00A or 03.00A (text)", shown(line));
}

glm::dvec4 unit_quaternion(const TextRows& rows, const Words& words, const Columns& columns) {
    double q[4];
    for (std::size_t i = 0; i < 4; ++i) q[i] = rows.number(words[columns.quaternion + i], "the rotation");
    const glm::dvec4 turn =
        columns.w_first ? glm::dvec4(q[1], q[2], q[3], q[0]) : glm::dvec4(q[0], q[1], q[2], q[3]);
    const double length = glm::length(turn);
    if (!(length > 1e-6 && length < 1e6)) rows.fail("a rotation of length 1", fmt::format("{:.4g}", length));
    return turn / length;
}

}  // namespace

CameraTrack read_chan(const fs::path& file, const FrameRate& rate) {
    const std::string text = read_file(file);
    TextRows rows(text, file.string());
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
        sample.frame = number(0, "the frame") * rate.output_frames();
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

CameraTrack read_gaia_sky(const fs::path& file, const FrameRate& rate) {
    const std::string text = read_file(file);
    TextRows rows(text, file.string());
    CameraTrack track;
    track.fps = rate.file_fps > 0.0 ? rate.file_fps : gaia_sky_fps;
    while (rows.next()) {
        const Words& words = rows.fields();
        if (words.size() != 10)
            rows.fail("time x y z, direction and up, 10 numbers", std::to_string(words.size()));
        rows.number(words[0], "the time");
        const std::int64_t index = std::ssize(track.samples);
        check_count(rows, index);
        TrackSample sample;
        sample.frame = 1.0 + double(index) * rate.output_fps / track.fps;
        sample.eye = vector_of(rows, words, 1, "the place");
        const glm::dvec3 direction = vector_of(rows, words, 4, "the direction"),
                         up = vector_of(rows, words, 7, "up");
        if (!quaternion_from_view(direction, up, sample.rotation))
            rows.fail("a direction and an up that differ", shown(rows.text()));
        track.samples.push_back(sample);
    }
    if (track.samples.empty()) rows.fail("time x y z, direction and up", "no line of numbers");
    return track;
}

CameraTrack read_openspace(const fs::path& file, const FrameRate& rate) {
    const std::string text = read_file(file);
    TextRows rows(text, file.string());
    const Columns columns = columns_of(rows);
    CameraTrack track;
    std::string body;
    while (rows.next()) {
        const Words& words = rows.fields();
        if (words[0] != "camera") continue;
        if (words.size() != columns.count)
            rows.fail(fmt::format("{} words in a camera's line", columns.count),
                      std::to_string(words.size()));
        check_count(rows, std::ssize(track.samples));
        TrackSample sample;
        sample.frame = 1.0 + rows.number(words[columns.time], "the time") * rate.output_fps;
        sample.eye = vector_of(rows, words, columns.place, "the place");
        sample.rotation = unit_quaternion(rows, words, columns);
        if (body.empty()) body = words[columns.body];
        if (body != words[columns.body] && track.warnings.empty())
            track.warnings.push_back(
                fmt::format("{}:{}: places are relative to {} from here on, to {} before", file.string(),
                            rows.line(), shown(words[columns.body]), shown(body)));
        if (!track.samples.empty()) {
            const double before = track.samples.back().frame;
            if (sample.frame == before) continue;
            if (sample.frame < before) rows.fail("times that ascend", shown(words[columns.time]));
        }
        track.samples.push_back(sample);
    }
    if (track.samples.empty()) rows.fail("lines that begin with camera", "none");
    return track;
}

}  // namespace astrosplat

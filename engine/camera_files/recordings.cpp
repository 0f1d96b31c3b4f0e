#include "camera_files/formats.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/text.h"

namespace astrosplat {
namespace {

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

CameraTrack read_gaia_sky(const std::filesystem::path& file, const FrameRate& rate) {
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
        sample.frame = 1.0 + static_cast<double>(index) * rate.output_fps / track.fps;
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

CameraTrack read_openspace(const std::filesystem::path& file, const FrameRate& rate) {
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

#include "camera_files/formats.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/real.h"
#include "core/text.h"

namespace astrosplat {
namespace {

using Json = nlohmann::json;

/// The number of that name of a frame, or of all frames.
std::optional<double> number_of(const Json& frame, const Json& all, const char* name) {
    for (const Json* json : {&frame, &all})
        if (json->contains(name)) return json->at(name).get<double>();
    return std::nullopt;
}

std::optional<double> vertical_fov_deg(const Json& frame, const Json& all) {
    const auto number = [&](const char* name) { return number_of(frame, all, name); };
    const std::optional<double> w = number("w"), h = number("h");
    const auto fov = [](double half) { return real::degrees(2.0 * real::atan2(half, 1.0)); };
    if (const auto fl_y = number("fl_y"); fl_y && h) return fov(0.5 * *h / *fl_y);
    if (const auto fl_x = number("fl_x"); fl_x && h) return fov(0.5 * *h / *fl_x);
    if (const auto angle = number("camera_angle_y")) return real::degrees(*angle);
    const auto angle = number("camera_angle_x");
    if (!angle) return std::nullopt;
    return fov(real::tan(0.5 * *angle) * (w && h ? *h / *w : 1.0));
}

}  // namespace

CameraTrack read_transforms_json(const fs::path& file, const FrameRate&) try {
    const auto fail = [&](const std::string& expected, const std::string& found) {
        bad_input(file, expected, found);
    };
    const Json json = Json::parse(read_file(file), nullptr, false);
    if (!json.is_object() || !json.contains("frames"))
        fail("a transforms.json with frames", "something else");
    CameraTrack track;
    track.up = FileUp::z;
    const Json& frames = json.at("frames");
    if (!frames.is_array() || frames.empty()) fail("at least one of its frames", "none");
    if (std::ssize(frames) > most_camera_samples)
        fail(fmt::format("at most {} frames", most_camera_samples), "more");
    for (const Json& frame : frames) {
        TrackSample sample;
        sample.frame = double(track.samples.size() + 1);
        const std::string place = fmt::format("frame {}", sample.frame);
        const auto rows = frame.at("transform_matrix").get<std::vector<std::vector<double>>>();
        if (rows.size() < 3 || rows[0].size() != 4 || rows[1].size() != 4 || rows[2].size() != 4)
            fail(fmt::format("3 or 4 rows of 4 numbers as transform_matrix of {}", place), "others");
        glm::dmat3 axes;
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) axes[c][r] = rows[r][c];
        sample.eye = {rows[0][3], rows[1][3], rows[2][3]};
        if (!quaternion_from_axes(axes, sample.rotation))
            fail("axes in the transform_matrix of " + place, "none");
        const std::optional<double> fov = vertical_fov_deg(frame, json);
        if (fov && !(*fov > 0.0 && *fov < 180.0))
            fail(fmt::format("a field of view between 0 and 180 degrees at {}", place),
                 fmt::format("{:.4g}", *fov));
        if (track.samples.empty()) track.has_fov = fov.has_value();
        if (fov.has_value() != track.has_fov) fail("a field of view at all frames or at none", "some");
        sample.fov_deg = fov.value_or(0.0);
        track.samples.push_back(sample);
    }
    return track;
} catch (const Json::exception& error) {  // a value of another type
    bad_input(file, "a transforms.json", printable(error.what()));
}

}  // namespace astrosplat

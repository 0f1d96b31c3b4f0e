#include "camera_files/formats.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

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

/// The last number of the name of a frame's picture; nothing where it has none.
std::optional<std::int64_t> number_in_name(const Json& frame) {
    const std::string name = fs::path(frame.value("file_path", "")).stem().string();
    const std::size_t last = name.find_last_of("0123456789");
    if (last == name.npos) return std::nullopt;
    const std::size_t before = name.find_last_not_of("0123456789", last);
    const std::size_t first = before == name.npos ? 0 : before + 1;
    return parse_int64(name.substr(first, last + 1 - first));
}

/// The frames by those numbers; in the file's order where some have none or the same.
std::vector<const Json*> frames_in_order(const Json& frames) {
    std::vector<const Json*> in_order;
    std::map<std::int64_t, const Json*> by_number;
    for (const Json& frame : frames) {
        in_order.push_back(&frame);
        if (const auto number = number_in_name(frame)) by_number.emplace(*number, &frame);
    }
    if (by_number.size() != in_order.size()) return in_order;
    std::ranges::transform(by_number, in_order.begin(), [](const auto& entry) { return entry.second; });
    return in_order;
}

/// Of the models that nerfstudio and its kin name, without their distortions.
std::optional<Projection> projection_of(const std::string& model) {
    constexpr std::pair<std::string_view, Projection> models[] = {
        {"OPENCV", Projection::perspective},
        {"PINHOLE", Projection::perspective},
        {"SIMPLE_PINHOLE", Projection::perspective},
        {"PERSPECTIVE", Projection::perspective},
        {"SIMPLE_RADIAL", Projection::perspective},
        {"RADIAL", Projection::perspective},
        {"OPENCV_FISHEYE", Projection::fisheye},
        {"SIMPLE_RADIAL_FISHEYE", Projection::fisheye},
        {"EQUIRECTANGULAR", Projection::equirectangular}};
    for (const auto& [name, projection] : models)
        if (name == model) return projection;
    return std::nullopt;
}

/// What is told of all frames' lenses, each once: where it first holds.
struct LensWords {
    std::string distortion, pixels, middle, model, sizes, axes;
    std::set<std::string> unread;
};

/// Where the middle of a frame lies, and what is told of its lens.
void read_shift(const Json& frame, const Json& all, TrackSample& sample, CameraTrack& track,
                LensWords& words) {
    const auto number = [&](const char* name) { return number_of(frame, all, name); };
    std::string distortion;
    for (const char* name : {"k1", "k2", "k3", "k4", "k5", "k6", "p1", "p2"})
        if (const double k = number(name).value_or(0.0); k != 0.0)
            distortion += fmt::format("{}{} = {}", distortion.empty() ? "" : ", ", name, shortest(k));
    if (words.distortion.empty() && !distortion.empty())
        words.distortion = distortion + ": distortions are left out";
    for (const char* name : {"distortion_params", "fisheye_crop_radius", "rolling_shutter",
                             "rolling_shutter_offset", "rolling_shutter_time"})
        if (const Json& told = (frame.contains(name) ? frame : all).value(name, Json());
            told.dump().find_first_of("123456789") != std::string::npos)  // not null or zeros
            words.unread.insert(name);
    const auto w = number("w"), h = number("h"), fl_x = number("fl_x"), fl_y = number("fl_y"),
               cx = number("cx"), cy = number("cy");
    if (fl_x && fl_y && std::fabs(*fl_x - *fl_y) > 0.001 * std::fabs(*fl_y))
        words.pixels = fmt::format("fl_x = {}, fl_y = {}: pixels are taken for square ones, as fl_y has them",
                                   shortest(*fl_x), shortest(*fl_y));
    const glm::dvec2 shift(w && h && cx ? (0.5 * *w - *cx) / *h : 0.0, h && cy ? (*cy - 0.5 * *h) / *h : 0.0);
    if (track.projection == Projection::perspective)
        sample.shift = shift;
    else if (shift != glm::dvec2(0.0))
        words.middle = "cx and cy beside the middle are left out where no plane is shown";
    track.has_shift |= sample.shift != glm::dvec2(0.0);
}

/// The cone of an equidistant fisheye over the shorter side: pixels are an angle's 1 / fl.
std::optional<double> fisheye_fov_deg(const Json& frame, const Json& all) {
    const auto number = [&](const char* name) { return number_of(frame, all, name); };
    const auto w = number("w"), h = number("h"), fl = number("fl_y") ? number("fl_y") : number("fl_x");
    if (!w || !h || !fl) return std::nullopt;
    return real::degrees(std::fmin(*w, *h) / *fl);
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
    const std::string model =
        json.value("camera_model", json.value("is_fisheye", false) ? "OPENCV_FISHEYE" : "OPENCV");
    LensWords words;
    if (!projection_of(model))
        words.model = fmt::format("camera_model {} is not known, a perspective one is taken", shown(model));
    else if (projection_of(model) == Projection::fisheye)
        words.model = "of a fisheye the circle within the picture is shown, and not its corners";
    // instant-ngp's way into its own unit cube, which nothing that it exports lies in.
    if (const Json none{0.0, 0.0, 0.0};
        json.value("scale", Json(1.0)) != 1.0 || json.value("offset", none) != none)
        words.sizes = "scale and offset are left out: places are those of transform_matrix";
    track.projection = projection_of(model).value_or(Projection::perspective);
    const bool fisheye = track.projection == Projection::fisheye;
    for (const Json* const in_order : frames_in_order(frames)) {
        const Json& frame = *in_order;
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
        if (!set_axes(axes, file.string(), sample, track))
            fail("axes in the transform_matrix of " + place, "none");
        const glm::dvec3 sizes(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
        if (words.axes.empty() && glm::distance(sizes, glm::dvec3(1.0)) > 1e-3)
            words.axes = fmt::format("the axes of {} are {:.4g}, {:.4g} and {:.4g} long: taken for 1", place,
                                     sizes.x, sizes.y, sizes.z);
        read_shift(frame, json, sample, track, words);
        const std::optional<double> fov = track.projection == Projection::equirectangular ? std::nullopt
                                          : fisheye ? fisheye_fov_deg(frame, json)
                                                    : vertical_fov_deg(frame, json);
        if (fov && !(*fov > 0.0 && (fisheye ? *fov <= 360.0 : *fov < 180.0)))
            fail(fmt::format("a field of view between 0 and {} degrees at {}", fisheye ? 360 : 180, place),
                 fmt::format("{:.4g}", *fov));
        if (track.samples.empty()) track.has_fov = fov.has_value();
        if (fov.has_value() != track.has_fov) fail("a field of view at all frames or at none", "some");
        sample.fov_deg = fov.value_or(0.0);
        track.samples.push_back(sample);
    }
    for (const std::string& word :
         {words.model, words.distortion, words.pixels, words.middle, words.sizes, words.axes})
        if (!word.empty()) track.warnings.push_back(fmt::format("{}: {}", file.string(), word));
    if (!words.unread.empty())
        track.warnings.push_back(fmt::format("{}: its values of {} are not followed", file.string(),
                                             fmt::join(words.unread, ", ")));
    return track;
} catch (const Json::exception& error) {  // a value of another type
    bad_input(file, "a transforms.json", printable(error.what()));
}

}  // namespace astrosplat

// Cameras of USD as text: UsdGeomCamera as Blender, Houdini and we ourselves write it.
#include "camera_files/formats.h"

#include <fmt/format.h>

#include <set>

#include "camera/camera.h"
#include "core/error.h"
#include "core/file.h"
#include "core/real.h"
#include "core/text.h"
#include "usd/usda_stage.h"

namespace astrosplat {
namespace {

// ---- reading

// The schema's fallbacks, tenths of units.
constexpr double usual_vertical_aperture = 15.2908, usual_focal_length = 50.0;

using Chain = std::vector<const UsdPrim*>;

// The first camera, with its parents, and how many there are.
void find_cameras(const std::vector<UsdPrim>& prims, Chain& here, Chain& first, std::int64_t& count) {
    for (const UsdPrim& prim : prims) {
        if (!prim.defined) continue;
        here.push_back(&prim);
        if (prim.type == "Camera" && count++ == 0) first = here;
        find_cameras(prim.children, here, first, count);
        here.pop_back();
    }
}

double number_of(const UsdStage& stage, const char* name) {
    const auto found = stage.metadata.find(name);
    return found == stage.metadata.end() || found->second.numbers.size() != 1 ? 0.0
                                                                              : found->second.numbers[0];
}

// Of every sample, and whole ones between the first and the last.
std::vector<double> time_codes(const Chain& chain, const std::string& file) {
    std::set<double> times;
    for (const UsdPrim* const prim : chain) add_times(*prim, times);
    if (times.empty()) return {0.0};
    const double first = *times.begin(), last = *times.rbegin();
    if (!(last - first + double(times.size()) <= double(most_camera_samples)) ||
        !(std::fmax(std::fabs(first), std::fabs(last)) <= 1e12))
        bad_input(file, fmt::format("at most {} frames, near 0", most_camera_samples),
                  fmt::format("time codes from {} to {}", shortest(first), shortest(last)));
    for (double time = std::ceil(first); time < last; time += 1.0) times.insert(time);
    return {times.begin(), times.end()};
}

class CameraReader {
  public:
    CameraReader(const UsdStage& stage, Chain chain, std::string file, const FrameRate& rate)
        : chain_(std::move(chain)), camera_(*chain_.back()), file_(std::move(file)) {
        if (stage.is_z_up()) track_.up = FileUp::z;
        track_.fps = number_of(stage, "timeCodesPerSecond");
        if (!(track_.fps > 0.0)) track_.fps = number_of(stage, "framesPerSecond");
        if (!(track_.fps > 0.0) || !std::isfinite(track_.fps)) track_.fps = 0.0;
        frames_per_code_ = rate.output_frames(track_.fps);
        if (camera_.attribute("projection").value.is("orthographic"))
            track_.projection = Projection::orthographic;
        track_.has_fov = !track_.orthographic();
    }

    CameraTrack track() {
        for (const double time : time_codes(chain_, file_)) add_sample(time);
        const auto is_told = [&](const char* name) { return camera_.attributes.count(name) > 0; };
        if (track_.has_fov && is_told("horizontalAperture") && !is_told("verticalAperture"))
            track_.warnings.push_back(fmt::format(
                "{}: camera '{}' has no verticalAperture; USD's own, {}, is taken for its field of view",
                file_, printable(camera_.name), usual_vertical_aperture));
        if (const std::string text = left_out(chain_); !text.empty())
            track_.warnings.push_back(fmt::format("{}: {}", file_, text));
        return std::move(track_);
    }

  private:
    double positive(const char* name, double time, double usual) const {
        const std::vector<double> numbers = numbers_at(camera_, name, time, {usual});
        if (numbers.size() == 1 && numbers[0] > 0.0 && std::isfinite(numbers[0])) return numbers[0];
        bad_input(file_, fmt::format("{} above 0 at time code {}", name, shortest(time)),
                  numbers.size() == 1 ? shortest(numbers[0]) : "another value");
    }

    double offset(const char* name, double time) const {
        const std::vector<double> numbers = numbers_at(camera_, name, time, {0.0});
        if (numbers.size() == 1 && std::fabs(numbers[0]) <= 1e12) return numbers[0];
        bad_input(file_, fmt::format("a finite {} at time code {}", name, shortest(time)),
                  numbers.size() == 1 ? shortest(numbers[0]) : "another value");
    }

    void add_sample(double time) {
        const glm::dmat4 world = world_from_prim(chain_, time, file_);
        TrackSample sample;
        sample.frame = time * frames_per_code_;
        sample.eye = glm::dvec3(world[3]);
        const bool placed =
            std::isfinite(sample.eye.x) && std::isfinite(sample.eye.y) && std::isfinite(sample.eye.z);
        if (!placed || !set_axes(glm::dmat3(world), file_, sample, track_))
            bad_input(file_,
                      fmt::format("a place and axes of '{}' at time code {}", printable(camera_.name),
                                  shortest(time)),
                      "none");
        const double aperture = positive("verticalAperture", time, usual_vertical_aperture);
        sample.shift = {offset("horizontalApertureOffset", time), offset("verticalApertureOffset", time)};
        if (track_.orthographic()) {  // parallel rays: the same as a step aside
            sample.height = aperture / 10.0;
            const glm::dmat3 axes = rotation_from_quaternion(sample.rotation);
            sample.eye += (sample.shift.x * axes[0] + sample.shift.y * axes[1]) / 10.0;
            sample.shift = {0.0, 0.0};
        } else {
            const double focal_length = positive("focalLength", time, usual_focal_length);
            sample.fov_deg = 2.0 * real::degrees(real::atan2(0.5 * aperture, focal_length));
            sample.shift /= aperture;
        }
        track_.has_shift |= sample.shift != glm::dvec2(0.0);
        if (!track_.samples.empty() && !(sample.frame > track_.samples.back().frame)) return;  // rounded
        track_.samples.push_back(sample);
    }

    Chain chain_;
    const UsdPrim& camera_;
    std::string file_;
    double frames_per_code_ = 1.0;
    CameraTrack track_;
};

// ---- writing

constexpr double film_height = 24.0;  // mm
constexpr double farthest = 1e9;      // what USD is given for a camera without a far plane

std::string samples_of(const CameraTrack& track,
                       const std::function<std::string(const TrackSample&)>& value) {
    std::string text = ".timeSamples = {\n";
    for (const TrackSample& sample : track.samples)
        text += fmt::format("        {}: {},\n", shortest(sample.frame), value(sample));
    return text + "    }\n";
}

/// Rows are the axes, then the place: USD's vectors are rows.
std::string matrix_of(const TrackSample& sample) {
    const glm::dmat3 axes = rotation_from_quaternion(sample.rotation);
    std::string text = "( ";
    for (int c = 0; c < 3; ++c)
        text +=
            fmt::format("({}, {}, {}, 0), ", shortest(axes[c].x), shortest(axes[c].y), shortest(axes[c].z));
    return text + fmt::format("({}, {}, {}, 1) )", shortest(sample.eye.x), shortest(sample.eye.y),
                              shortest(sample.eye.z));
}

}  // namespace

CameraTrack read_usda(const fs::path& file, const FrameRate& rate) {
    const std::string text = read_file(file), name = file.string();
    const UsdStage stage = parse_usda(text, name);
    Chain here, first;
    std::int64_t count = 0;
    find_cameras(stage.prims, here, first, count);
    if (count == 0) bad_input(name, "a camera", stage.none_found());
    CameraReader reader(stage, first, name, rate);
    CameraTrack track = reader.track();
    if (count > 1)
        track.warnings.push_back(
            fmt::format("{}: of {} cameras '{}' is read", name, count, printable(first.back()->name)));
    return track;
}

std::string usda_text(const CameraTrack& track, const UsdLens& lens) {
    std::string text = fmt::format(
        "#usda 1.0\n(\n    defaultPrim = \"camera\"\n    startTimeCode = {}\n    endTimeCode = {}\n"
        "    timeCodesPerSecond = {}\n    upAxis = \"Y\"\n)\n\ndef Camera \"camera\"\n{{\n",
        shortest(track.samples.front().frame), shortest(track.samples.back().frame), shortest(track.fps));
    text += fmt::format("    float2 clippingRange = ({}, {})\n", shortest(lens.near),
                        shortest(lens.far > 0.0 ? lens.far : farthest));
    if (track.orthographic()) {
        text += "    token projection = \"orthographic\"\n";
        for (const bool wide : {true, false})
            text += std::string("    float ") + (wide ? "horizontal" : "vertical") + "Aperture" +
                    samples_of(track, [&](const TrackSample& sample) {
                        return shortest(10.0 * sample.height * (wide ? lens.aspect : 1.0));
                    });
    } else {
        text += fmt::format("    float horizontalAperture = {}\n    float verticalAperture = {}\n",
                            shortest(film_height * lens.aspect), shortest(film_height));
        for (const int axis : {0, 1})
            if (track.has_shift)
                text += fmt::format("    float {}ApertureOffset", axis == 0 ? "horizontal" : "vertical") +
                        samples_of(track, [&](const TrackSample& sample) {
                            return shortest(film_height * sample.shift[axis]);
                        });
        if (track.has_fov)
            text += "    float focalLength" + samples_of(track, [&](const TrackSample& sample) {
                        return shortest(0.5 * film_height / real::tan(real::radians(0.5 * sample.fov_deg)));
                    });
    }
    return text + "    matrix4d xformOp:transform" + samples_of(track, matrix_of) +
           "    uniform token[] xformOpOrder = [\"xformOp:transform\"]\n}\n";
}

}  // namespace astrosplat

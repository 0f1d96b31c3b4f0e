#include "camera_files/usda.h"

#include <fmt/format.h>

#include <functional>

#include "camera/camera.h"
#include "core/real.h"
#include "core/text.h"

namespace astrosplat {
namespace {

constexpr double film_height = 24.0;
constexpr double farthest = 1e9;

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

std::string usda_text(const CameraTrack& track, const UsdLens& lens) {
    std::string text = fmt::format(
        "#usda 1.0\n(\n    defaultPrim = \"camera\"\n    startTimeCode = {}\n    endTimeCode = {}\n"
        "    timeCodesPerSecond = {}\n    upAxis = \"Y\"\n)\n\ndef Camera \"camera\"\n{{\n",
        shortest(track.samples.front().frame), shortest(track.samples.back().frame), shortest(track.fps));
    text += fmt::format("    float2 clippingRange = ({}, {})\n", shortest(lens.near),
                        shortest(lens.far > 0.0 ? lens.far : farthest));
    if (track.orthographic) {
        text += "    token projection = \"orthographic\"\n";
        for (const bool wide : {true, false})
            text += std::string("    float ") + (wide ? "horizontal" : "vertical") + "Aperture" +
                    samples_of(track, [&](const TrackSample& sample) {
                        return shortest(10.0 * sample.height * (wide ? lens.aspect : 1.0));
                    });
    } else {
        text += fmt::format("    float horizontalAperture = {}\n    float verticalAperture = {}\n",
                            shortest(film_height * lens.aspect), shortest(film_height));
        if (track.has_fov)
            text += "    float focalLength" + samples_of(track, [&](const TrackSample& sample) {
                        return shortest(0.5 * film_height / real::tan(real::radians(0.5 * sample.fov_deg)));
                    });
    }
    return text + "    matrix4d xformOp:transform" + samples_of(track, matrix_of) +
           "    uniform token[] xformOpOrder = [\"xformOp:transform\"]\n}\n";
}

}  // namespace astrosplat

#include "scene/reference_place.h"

#include <glm/geometric.hpp>

#include "core/real.h"
#include "core/rotation.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

constexpr double least_scale = 1e-3, largest_scale = 1e3;

bool is_at_frame(const ReferenceParams& reference, double frame) {
    if (reference.frames.empty()) return true;
    const std::vector<std::int64_t> frames = parse_frames(reference.frames, "reference.frames");
    return std::ranges::binary_search(frames, std::int64_t(std::floor(frame)));
}

glm::dvec2 middle_of(const ReferenceParams& reference, const FrameOnScreen& frame) {
    return frame.middle + frame.height * glm::dvec2(reference.position.x, -reference.position.y);
}

void put_middle(ReferenceParams& reference, glm::dvec2 px, const FrameOnScreen& frame) {
    const glm::dvec2 heights = (px - frame.middle) / frame.height;
    reference.position = {heights.x, -heights.y};
}

/// Degrees counter-clockwise on the screen.
double angle_of(glm::dvec2 v) { return real::degrees(real::atan2(-v.y, v.x)); }

double rounded(double x, double per_unit) { return std::round(x * per_unit) / per_unit; }

}  // namespace

std::optional<std::size_t> find_reference(const Scene& scene, ReferenceParams::View view, double frame) {
    for (const ReferenceParams::View wanted : {view, ReferenceParams::View::any})
        for (std::size_t i = 0; i < scene.references.size(); ++i) {
            const ReferenceParams& reference = scene.references[i];
            if (!reference.file.empty() && reference.view == wanted && is_at_frame(reference, frame))
                return i;
        }
    return std::nullopt;
}

PicturePlace place_of(const ReferenceParams& reference, double aspect, const FrameOnScreen& frame) {
    const double angle = real::radians(reference.rotate), height = reference.scale * frame.height;
    const double c = real::cos(angle), s = real::sin(angle);
    PicturePlace place;
    place.right = (reference.mirrored ? -aspect : aspect) * height * glm::dvec2(c, -s);
    place.down = height * glm::dvec2(s, c);
    place.corner = middle_of(reference, frame) - 0.5 * (place.right + place.down);
    return place;
}

PlaceGrip grip_at(const PicturePlace& place, glm::dvec2 px, double reach) {
    for (const double u : {0.0, 1.0})
        for (const double v : {0.0, 1.0})
            if (glm::distance(place.corner + u * place.right + v * place.down, px) <= reach)
                return PlaceGrip::scale;
    const glm::dvec2 from_corner = px - place.corner;
    const double u = glm::dot(from_corner, place.right) / glm::dot(place.right, place.right);
    const double v = glm::dot(from_corner, place.down) / glm::dot(place.down, place.down);
    return std::max(std::fabs(u - 0.5), std::fabs(v - 0.5)) <= 0.5 ? PlaceGrip::move : PlaceGrip::turn;
}

ReferenceParams dragged(ReferenceParams reference, PlaceGrip grip, glm::dvec2 from, glm::dvec2 to,
                        const FrameOnScreen& frame) {
    const glm::dvec2 middle = middle_of(reference, frame);
    if (grip == PlaceGrip::move) {
        put_middle(reference, middle + to - from, frame);
    } else if (grip == PlaceGrip::turn) {
        reference.rotate =
            within_half_turn(reference.rotate + angle_of(to - middle) - angle_of(from - middle));
    } else if (from != middle) {
        const double factor = glm::distance(to, middle) / glm::distance(from, middle);
        reference.scale = std::clamp(reference.scale * factor, least_scale, largest_scale);
    }
    return reference;
}

ReferenceParams scaled_about(ReferenceParams reference, double factor, glm::dvec2 px,
                             const FrameOnScreen& frame) {
    const double scale = std::clamp(reference.scale * factor, least_scale, largest_scale);
    const glm::dvec2 from_px = middle_of(reference, frame) - px;
    put_middle(reference, px + from_px * (scale / reference.scale), frame);
    reference.scale = scale;
    return reference;
}

ReferenceParams rounded_place(ReferenceParams reference) {
    reference.position = {rounded(reference.position.x, 1e5), rounded(reference.position.y, 1e5)};
    reference.scale = rounded(reference.scale, 1e5);
    reference.rotate = rounded(reference.rotate, 1e3);
    return reference;
}

}  // namespace astrosplat

#include "source/origin.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"

namespace astrosplat {
namespace {

std::string degrees_of(const std::optional<double>& degrees) {
    return degrees ? fmt::format("{:.1f} degrees", *degrees) : "what the picture tells";
}

std::string galaxy_words(const GalaxyParams& galaxy) {
    if (galaxy.bulge == 1.0) return "a spheroid";
    if (galaxy.inclination == 0.0) return "a disk and a spheroid, in the picture's plane";
    return "a disk and a spheroid, inclined by " + degrees_of(galaxy.inclination);
}

std::string model_words(const StructureParams& params) {
    switch (params.kind) {
        case StructureKind::disk:
            if (params.galaxies.empty()) return galaxy_words(params.galaxy);
            return fmt::format("the disks and spheroids of {} galaxies", params.galaxies.size());
        case StructureKind::axis:
            return fmt::format("rings about an axis, tilted by {}, or two walls where the picture has none",
                               degrees_of(params.tilt));
        case StructureKind::walls:
            return "two walls, the farther apart the brighter";
        default:
            return "a sheet, the nearer the brighter";
    }
}

// Whether a picture may not tell all of its galaxy's plane.
bool hides_plane(const StructureParams& params) {
    const auto hidden = [](const GalaxyParams& galaxy) {
        return galaxy.bulge != 1.0 && galaxy.inclination.value_or(90.0) > hidden_from_deg;
    };
    return params.kind == StructureKind::disk &&
           (params.galaxies.empty() ? hidden(params.galaxy) : std::ranges::any_of(params.galaxies, hidden));
}

std::string beyond_words(const StructureParams& params, const std::optional<ShareBeyond>& beyond) {
    if (!beyond && params.margin > 0.0) return ", all beyond the frame";
    if (!beyond || beyond->splats <= 0.0) return "";
    return fmt::format(", all beyond the frame ({:.0f} % of the splats, {:.0f} % of the light)",
                       100.0 * beyond->splats, 100.0 * beyond->light);
}

std::string origin_of(const StructureParams& params, const std::optional<ShareBeyond>& beyond) {
    return fmt::format(
        "measured: light and colours, as the picture's camera sees them; modelled: depths, by {}; invented: "
        "each splat's place within that depth, all backs{}{}{}",
        model_words(params),
        params.detail > 0
            ? fmt::format(", detail of {} beyond the picture's texels{}", counted(params.detail, "octave"),
                          params.detail_tiles.empty() ? "" : " where the camera comes close")
            : "",
        hides_plane(params) ? ", arms and clouds along the line of sight, the dust's far side" : "",
        beyond_words(params, beyond));
}

std::string origin_of(const StarsParams& stars) {
    if (!stars.along.empty()) return "invented: all stars";
    if (stars.like.empty()) return "measured: light and places, those of the catalogue";
    return "measured: light and places in the picture, those of its table; invented: depths";
}

}  // namespace

std::string origin_of(const SourceParams& source, const std::optional<ShareBeyond>& beyond) {
    if (source.kind == SourceKind::splats) return "";
    if (source.kind == SourceKind::stars) return origin_of(source.stars);
    if (source.structure.kind == StructureKind::columns) return columns_origin;
    return origin_of(source.structure, beyond);
}

}  // namespace astrosplat

// How true a scene is to the telescope: what its splats look like from the front against its picture, and
// whether they hold from the side and from the edge. In: a scene. Out: numbers and the images that they
// were taken of.
#pragma once

#include "core/image.h"
#include "core/progress.h"
#include "fidelity/front.h"
#include "fidelity/side.h"
#include "scene/front_frame.h"
#include "scene/scene.h"
#include "sets/kept.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// The picture that the front view is compared with.
struct FidelityReference {
    std::string layer;    // whose picture it is, or stands for
    fs::path file;        // empty: the layer's own picture
    FrontFrame frame;     // world space
    GalaxyParams galaxy;  // of a disk: how it lies in its picture, by which the side views are turned
    Image picture;        // linear light on black, in its own resolution
    double border = 0.0;  // share of its width along every edge where light fades: not compared
    bool disk = true;     // seen from its edge it is to look like a galaxy: not a sheet, nor walls

    /// Height in px of a front view so wide.
    std::int64_t height_px(std::int64_t width_px) const;
    /// `wanted`, or less where a strip would become taller than 5120 px, but not less than the picture's own.
    std::int64_t front_width_px(std::int64_t wanted) const;
};

/// The picture of the first visible layer made of meshes, or of the first such layer at all, so that a
/// scene of splat files can name its picture in a layer that is not visible. `file` replaces the picture,
/// not its place; its proportions are to be the frame's within 1 %. `now`: the scene at one frame. Throws
/// InputError, Cancelled.
FidelityReference fidelity_reference(const Scene& now, const std::optional<fs::path>& file,
                                     const Progress& progress = {}, const SetCache& cache = {});

/// Width of the views that mottle and what is seen from above are measured in, px.
inline constexpr std::int64_t aside_width_px = 800;

struct FidelityReport {
    std::string layer;
    fs::path reference;
    std::string credit;         // of all sources and of the reference
    FrontFidelity front, full;  // at FidelitySettings::width_px and at the picture's own width
    Needles needles;            // from 60 degrees
    Needles flat_needles;       // of the picture, without any depth
    double mottle = 0.0;        // from 45 degrees
    DiskFromAbove above;        // of a disk
    EdgeOnProfile edge;
    bool disk = true;                   // FidelityReference::disk
    Image front_view, front_reference;  // of `front`: linear light on black
    Image side_view, edge_view;
};

struct FidelitySettings {
    SetCache cache;
    std::int64_t width_px = 1280;  // of the smaller front view and of the views from the side
    /// Called when a step begins; returns what the step reports to. Empty: to nothing.
    std::function<Progress(const std::string& step)> begin_step;
};

/// Bytes of images and measures at their peak, about: what comes on top of the splats.
std::int64_t fidelity_bytes(const FidelityReference& reference, const FidelitySettings& settings = {});

/// A front view and what it is compared with, both as linear light on black.
struct FrontComparison {
    FrontFidelity fidelity;
    Image seen, picture;
};

/// The front view alone, of sets that are there already, one a layer; null: the layer is left out. Throws
/// InputError, Cancelled.
FrontComparison compare_front(const Scene& now, std::vector<std::shared_ptr<const SplatSet>> sets,
                              const FidelityReference& reference, std::int64_t width_px,
                              const Progress& progress = {});

/// Renders the scene as it stands, with its looks and without its environment, and measures. Throws
/// InputError, Cancelled.
FidelityReport measure_fidelity(const Scene& now, const FidelityReference& reference,
                                const FidelitySettings& settings = {});

}  // namespace astrosplat

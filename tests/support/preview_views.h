// How true a moving picture is to the final one, on six views of the shipped scenes. In: the viewer's own
// session, driven without a window; needs a current OpenGL context and the assets. Out: light, blocks of
// 64 x 64 px and the thickness of a disk seen from its edge.
#pragma once

#include "core/image.h"
#include "edit/view_state.h"
#include "sets/kept.h"

namespace astrosplat::test {

struct NamedView {
    const char* name;
    const char* scene;     // of assets/scenes; null: a picture on a plane
    FreeCamera camera;     // 960 x 540 px
    bool is_edge = false;  // of a disk, which has a thickness then
};

/// Galaxy from the front, at an angle and from its edge; a picture on a plane at an angle; nebula from the
/// side and inside.
std::span<const NamedView> preview_views();

/// A preview and the final frame of the same view, both linear and without a sky.
struct ViewTruth {
    std::int64_t shown = 0, splats = 0;
    double light = 0.0;               // of the preview, over that of the final frame
    int bright_blocks = 0, near = 0;  // brighter than a tenth of the brightest; within 20 % of these
    double thickness = 1.0;           // at half brightness, over that of the final frame
    Image preview, final;             // RGBA
};

/// The preview draws so many splats; sets come from the cache.
ViewTruth measure_truth(const NamedView& view, std::int64_t shown, const SetCache& cache);

/// What a preview comes after.
enum class Cause { opening, move, edit };
inline constexpr const char* cause_names[] = {"opened", "moved", "look edited"};

/// Six views of any scene: its own camera's, 45 degrees off, aside, from its edge, from behind and close by.
struct CausedView {
    std::string view;
    Cause cause;
    ViewTruth truth;
};
/// The previews of a scene draw so many splats after each cause.
std::vector<CausedView> measure_causes(const std::filesystem::path& scene, std::int64_t shown,
                                       const SetCache& cache);

/// Compares two frames of the same size. `is_edge`: also how thick they are.
ViewTruth compare_frames(const Image& preview, const Image& final, bool is_edge);

}  // namespace astrosplat::test

#include "viewer/front_check.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "fidelity/signed_difference.h"
#include "measure_fidelity.h"
#include "scene/animate.h"

namespace astrosplat {
namespace {

FrontFound compared(const FrontRequest& request, std::int64_t width_px, const SetCache& cache,
                    const Progress& progress) {
    const FidelityReference reference = fidelity_reference(request.scene, {}, progress, cache);
    FrontComparison front = compare_front(request.scene, request.sets, reference,
                                          std::min(width_px, reference.picture.width), progress);
    FrontFound found;
    found.difference = signed_difference(front.seen, front.picture);
    found.fidelity = std::move(front.fidelity);
    return found;
}

/// Its picture faces the front, along y; the surface of a sculpted mesh with texture coordinates of its own
/// has no picture that it could look like.
bool shows_a_picture(const SourceParams& source) {
    constexpr std::string_view flat[] = {"plane", "relief", "sheet", "disk"};
    if (source.kind != SourceKind::mesh) return false;
    if (source.uv == UvMode::camera || source.uv == UvMode::planar_xz) return true;
    return source.uv == UvMode::mesh && std::ranges::all_of(source.meshes, [&](const auto& part) {
               return std::ranges::find(flat, part.mesh.generic_string()) != std::end(flat);
           });
}

}  // namespace

FrontRequest front_request(Scene now, std::vector<std::shared_ptr<const SplatSet>> sets,
                           std::uint64_t files) {
    OutputParams output;
    output.pixel_filter = now.output.pixel_filter;
    now.output = output;
    now.camera = {};
    now.environment = {};
    stop_animation(now);
    return {std::move(now), std::move(sets), files};
}

bool has_front_picture(const Scene& now) {
    return std::ranges::any_of(
        now.layers, [](const LayerParams& layer) { return layer.visible && shows_a_picture(layer.source); });
}

bool front_changed_by_look(const Scene& now) {
    return std::ranges::any_of(now.layers, [](const LayerParams& layer) {
        LayerRender render = layer.render;
        render.lod = {};
        return layer.visible && !(layer.look == Look{} && render == LayerRender{});
    });
}

FrontCheck::FrontCheck(std::int64_t width_px, const SetCache& cache)
    : LatestWork([width_px, cache](const FrontRequest& request, const Progress& progress) {
          return compared(request, width_px, cache, progress);
      }) {}

}  // namespace astrosplat

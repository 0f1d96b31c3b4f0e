#include "scene/layer_source.h"

#include <algorithm>

#include "camera/path.h"
#include "generate/lattice.h"
#include "scene/animate.h"
#include "stars/random_stars.h"

namespace astrosplat {
namespace {

constexpr int places_on_path = 1024;  // about
constexpr double tolerance = 0.01;    // of the distance that stars lie from the path

const Track* position_track(const Scene& scene) {
    const auto find_in = [](const std::vector<Track>& tracks) {
        const auto found =
            std::ranges::find_if(tracks, [](const Track& track) { return track.key == "camera.position"; });
        return found == tracks.end() ? nullptr : &*found;
    };
    const Track* const imported = scene.imported.camera ? find_in(scene.imported.camera->tracks) : nullptr;
    return imported ? imported : find_in(scene.animation);
}

}  // namespace

bool has_camera_places(const Scene& scene) { return scene.camera.position || position_track(scene); }

std::vector<glm::dvec3> camera_places(const Scene& scene) {
    const Track* const track = position_track(scene);
    if (!track)
        return scene.camera.position ? std::vector{*scene.camera.position} : std::vector<glm::dvec3>();
    const std::vector<Keyframe<glm::dvec3>> keyframes = position_keyframes(*track);
    const auto parts = static_cast<int>(keyframes.size()) - 1;
    const int steps = std::max(1, places_on_path / std::max(1, parts));  // between two keyframes
    std::vector<glm::dvec3> places;
    const auto add = [&](double frame) {
        places.push_back(evaluate_position(keyframes, frame, track->ends, track->constant_speed));
    };
    for (std::size_t k = 0; k + 1 < keyframes.size(); ++k)
        for (int i = 0; i < steps; ++i)
            add(keyframes[k].frame + (keyframes[k + 1].frame - keyframes[k].frame) * i / steps);
    add(keyframes.back().frame);
    return places;
}

bool follows_camera(const SourceParams& source) {
    return source.kind == SourceKind::stars && source.stars.along == "camera";
}

const LayerParams* like_layer(const Scene& scene, const LayerParams& layer) {
    if (layer.source.kind != SourceKind::stars || layer.source.stars.like.empty()) return nullptr;
    const auto found = std::ranges::find(scene.layers, layer.source.stars.like, &LayerParams::name);
    return found == scene.layers.end() || found->source.kind != SourceKind::mesh ? nullptr : &*found;
}

SourceParams source_of(const Scene& scene, const LayerParams& layer) {
    SourceParams source = layer.source;
    if (const LayerParams* const like = like_layer(scene, layer)) {
        source = like->source;
        source.kind = SourceKind::stars;
        source.seed = layer.source.seed;
        source.stars = layer.source.stars;
        source.stars.like_seed = resolved_seed(like->source.seed, like->name);
    }
    if (!follows_camera(source)) return source;
    const std::vector<glm::dvec3> places = camera_places(scene);
    if (!places.empty()) source.stars.path = simplified_path(places, tolerance * source.stars.spread);
    return source;
}

}  // namespace astrosplat

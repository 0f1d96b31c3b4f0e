#include "viewer/set_wishes.h"

#include <time.h>

#include <algorithm>
#include <utility>

namespace astrosplat {
namespace {

std::vector<SourceParams> sources_of(const Scene& scene) {
    std::vector<SourceParams> sources;
    for (const LayerParams& layer : scene.layers) sources.push_back(layer.source);
    return sources;
}

/// The set that a preview of the layer under its present levels can be made of.
std::shared_ptr<const LoadedLayer> base_of(const SetLoader& loader, const LayerParams& layer) {
    auto loaded = loader.layer(layer.name);
    if (!loaded || !loaded->set || loaded->outdated) return nullptr;
    return only_texels_differ(loaded->source, layer.source) ? loaded : nullptr;
}

}  // namespace

double thread_seconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

bool SetWishes::due(const Document& document, double now) {
    constexpr double rest_s = 0.4;
    if (document.revision() == wanted_revision_) return false;
    const std::vector<SourceParams> sources = sources_of(document.scene());
    const bool same_layers = sources.size() == wanted_sources_.size();
    const bool edited = same_layers && sources != wanted_sources_;
    const bool moves = edited && sources != edited_sources_ && abandon_followed(document.scene());
    if (edited && (source_edited_at_ < 0.0 || moves)) source_edited_at_ = now;
    edited_sources_ = sources;
    return source_edited_at_ < 0.0 || now - source_edited_at_ >= rest_s;
}

void SetWishes::want(const Document& document) {
    loader_.want(document.scene());
    wanted_revision_ = document.revision();
    wanted_sources_ = sources_of(document.scene());
    source_edited_at_ = -1.0;
}

bool SetWishes::loaded(const Document& document) const {
    return loader_.idle() && wanted_revision_ == document.revision();
}

bool SetWishes::wanted(const Scene& scene) const { return wanted_sources_ == sources_of(scene); }

/// Sets of levels that were passed on the way would hold up the preview. False: there is nothing to be
/// followed.
bool SetWishes::abandon_followed(const Scene& scene) {
    bool any = false;
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        const auto base = base_of(loader_, scene.layers[i]);
        if (!base) continue;
        loader_.abandon(scene.layers[i].name);
        wanted_sources_[i] = base->source;
        any = true;
    }
    return any;
}

void SetWishes::follow(const Scene& scene) {
    for (const LayerParams& layer : scene.layers)
        if (const auto base = base_of(loader_, layer)) return live_.want({base, layer.source});
    live_.forget();
}

std::shared_ptr<const LoadedLayer> SetWishes::layer(const LayerParams& layer) const {
    if (const auto base = base_of(loader_, layer))
        if (auto live = live_.layer(base)) return live;
    return loader_.layer(layer.name);
}

void SetWishes::show_growth(double now) {
    constexpr double shortest_s = 0.25, longest_s = 1.5, share = 0.03;  // the first drawing is a slow one
    if (now < grows_at_) return;
    const double start = thread_seconds();
    if (!loader_.grow()) return;
    grows_at_ = now + std::clamp((thread_seconds() - start + new_set_draw_s_) / share, shortest_s, longest_s);
}

bool SetWishes::new_sets() {
    const std::uint64_t sets = loader_.revision();
    return std::exchange(seen_sets_, sets) != sets;
}

}  // namespace astrosplat

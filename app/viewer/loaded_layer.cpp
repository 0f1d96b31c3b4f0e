#include "viewer/loaded_layer.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "scene/input_files.h"
#include "splats/stratified.h"
#include "viewer/histograms.h"

namespace astrosplat {
namespace {

/// Of the first splats of a preview, which are a fair sample.
glm::vec3 mean_color(const SplatSet& set) {
    constexpr std::int64_t sample = 4096;
    glm::vec3 sum(0.0f);
    float weight = 0.0f;
    for (std::int64_t i = 0; i < std::min(sample, set.size()); ++i) {
        sum += set.alpha[i] * set.color[i];
        weight += set.alpha[i];
    }
    return weight > 0.0f ? sum / weight : glm::vec3(1.0f);
}

LoadedLayer layer_of(std::shared_ptr<const SplatSet> preview, const SourceParams& source,
                     const std::string& name) {
    LoadedLayer layer;
    layer.color = mean_color(*preview);
    layer.preview = std::move(preview);
    layer.source = source;
    layer.name = name;
    return layer;
}

}  // namespace

LoadedLayer whole_layer(std::shared_ptr<const SplatSet> set, const SourceParams& source,
                        const std::string& name, std::int64_t preview_limit) {
    constexpr std::int64_t first_look = 1 << 18;  // splats of a preview before it is arranged
    SplatSet preview = sample_rows(*set, std::min(preview_limit, first_look));
    LoadedLayer layer = layer_of(std::make_shared<const SplatSet>(std::move(preview)), source, name);
    layer.box = bounds(*set);
    layer.radius = unset_radius(*set);
    layer.splats = set->size();
    layer.set = std::move(set);
    return layer;
}

LoadedLayer growing_layer(const GrowingSet::Sample& sample, const SourceParams& source,
                          const std::string& name) {
    LoadedLayer layer = layer_of(sample.set, source, name);
    layer.box = sample.box;
    layer.radius = unset_radius(*sample.set);
    layer.splats = sample.kept;
    return layer;
}

LoadedLayer arranged_layer(LoadedLayer layer, std::int64_t preview_limit, const Progress& progress) {
    const SplatSet& set = *layer.set;
    const Buffer<std::int64_t> order = stratified_order(set, progress);
    layer.preview =
        std::make_shared<const SplatSet>(take_rows(set, order, std::min(preview_limit, set.size())));
    layer.arranged = true;
    return layer;
}

LoadedLayer described_layer(LoadedLayer layer) {
    try {
        layer.files = all_files(layer.source);
    } catch (const InputError&) {  // gone since: when it is back, it is read again
        layer.files = named_files(layer.source);
    }
    layer.histograms = std::make_shared<const LayerHistograms>(histograms(*layer.set, layer.source));
    return layer;
}

}  // namespace astrosplat

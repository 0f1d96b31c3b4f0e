#include "viewer/loaded_layer.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "scene/input_files.h"
#include "splats/splat_set.h"
#include "viewer/histograms.h"

namespace astrosplat {
namespace {

glm::vec3 mean_color(const SplatSet& set) {
    constexpr std::int64_t sampled = 4096;
    glm::vec3 sum(0.0f);
    float weight = 0.0f;
    const std::int64_t count = std::min(sampled, set.size());
    for (std::int64_t i = 0; i < count; ++i) {
        const std::int64_t row = sampled_row(set.size(), count, i);
        sum += set.alpha[row] * set.color[row];
        weight += set.alpha[row];
    }
    return weight > 0.0f ? sum / weight : glm::vec3(1.0f);
}

LoadedLayer layer_of(MergeSource sample, const SourceParams& source, const std::string& name) {
    LoadedLayer layer;
    layer.color = mean_color(*sample.set);
    layer.sample = std::move(sample);
    layer.source = source;
    layer.name = name;
    return layer;
}

}  // namespace

MergeSource source_of(std::shared_ptr<const SplatSet> set, std::int64_t stands_for) {
    MergeSource source;
    if (set->size() > 0)
        source.weight =
            static_cast<float>(static_cast<double>(stands_for) / static_cast<double>(set->size()));
    source.tree = std::make_shared<const MergeTree>(build_merge_tree(*set));
    source.set = std::move(set);
    return source;
}

// Stars are drawn as they are, however many: no dot could stand for several.
LoadedLayer star_layer(std::shared_ptr<const SplatSet> set, const SourceParams& source,
                       const std::string& name) {
    MergeSource all;
    all.set = set;
    LoadedLayer layer = layer_of(std::move(all), source, name);
    layer.box = bounds(*set);
    layer.splats = set->size();
    layer.arranged = true;
    layer.set = std::move(set);
    return layer;
}

LoadedLayer whole_layer(std::shared_ptr<const SplatSet> set, const SourceParams& source,
                        const std::string& name, std::int64_t sample_limit, const MergeSource* sample) {
    if (set->stars) return star_layer(std::move(set), source, name);
    const std::int64_t splats = set->size();
    const bool is_small = splats <= sample_limit;
    MergeSource seen =
        is_small ? source_of(set, splats)
        : sample ? *sample
                 : source_of(std::make_shared<const SplatSet>(sample_rows(*set, sample_limit)), splats);
    LoadedLayer layer = layer_of(std::move(seen), source, name);
    layer.box = bounds(*set);
    layer.radius = unset_radius(*set);
    layer.splats = splats;
    layer.arranged = is_small;
    layer.set = std::move(set);
    return layer;
}

LoadedLayer growing_layer(const GrowingSet::Sample& sample, const SourceParams& source,
                          const std::string& name) {
    LoadedLayer layer = layer_of(source_of(sample.set, sample.kept), source, name);
    layer.box = sample.box;
    layer.radius = unset_radius(*sample.set);
    layer.splats = sample.kept;
    return layer;
}

LoadedLayer arranged_layer(LoadedLayer layer, std::shared_ptr<const MergeTree> tree) {
    constexpr std::int64_t rows_per_sampled = 16;
    layer.whole.set = layer.set;
    layer.whole.tree = std::move(tree);
    const std::int64_t count = std::max(layer.sample.set->size(), layer.set->size() / rows_per_sampled);
    layer.sample =
        source_of(std::make_shared<const SplatSet>(sample_tree(*layer.whole.tree, *layer.set, count)),
                  layer.set->size());
    layer.arranged = true;
    return layer;
}

LoadedLayer described_layer(LoadedLayer layer) {
    try {
        layer.files = all_files(layer.source);
    } catch (const InputError&) {  // gone since: when it is back, it is read again
        layer.files = named_files(layer.source);
    }
    try {
        layer.automatic = automatic_values(layer.source);
    } catch (const InputError&) {  // as above
    }
    layer.histograms = std::make_shared<const LayerHistograms>(histograms(*layer.set, layer.source));
    return layer;
}

}  // namespace astrosplat

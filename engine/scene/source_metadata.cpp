#include "scene/source_metadata.h"

#include <set>

#include "core/file_format.h"
#include "scene/layer_setup.h"
#include "source/picture.h"

namespace astrosplat {
namespace {

/// What a list of materials names may be missing.
bool is_picture(const fs::path& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored) && kind_of(format_of_file(file)) == FileKind::picture;
}

}  // namespace

ObjectMetadata source_metadata(const Scene& scene, const std::vector<const SplatSetFacts*>& sets) {
    std::vector<ObjectMetadata> all;
    std::set<fs::path> known;
    const auto add = [&](const std::vector<fs::path>& files) {
        for (const fs::path& file : files)
            if (known.insert(file.lexically_normal()).second && is_picture(file))
                all.push_back(read_picture_metadata(file));
    };
    for (std::size_t i = 0; i < sets.size(); ++i) {
        if (!sets[i]) continue;
        const LayerParams& layer = scene.layers[i];
        add(all_files(layer.source));
        if (const LayerParams* const like = like_layer(scene, layer)) add(all_files(like->source));
        add({layer.look.thickness.map});
        if (layer.source.kind == SourceKind::splats) all.emplace_back().credit = sets[i]->credit;
    }
    const EnvironmentParams& sky = scene.environment;
    if (sky.visible) add(sky.cube);
    if (sky.visible) add({sky.image, sky.tile});
    return merged_metadata(all);
}

ProvenanceParams resolved(ProvenanceParams provenance, const ObjectMetadata& sources) {
    if (provenance.title.empty()) provenance.title = sources.title;
    if (provenance.credit.empty()) provenance.credit = sources.credit;
    if (provenance.type == "auto") provenance.type = sources.type;
    return provenance;
}

}  // namespace astrosplat

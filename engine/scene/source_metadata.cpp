#include "scene/source_metadata.h"

#include <map>

#include "core/file_format.h"
#include "core/log.h"
#include "objects/identify.h"
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

// Layers' pictures are not opened by OpenImageIO, which a set from the cache does without: a credit that only
// it finds, in IPTC or EXIF, is that of the set.
ObjectMetadata source_metadata(const Scene& scene, const std::vector<const SplatSetFacts*>& sets) {
    const QuietLog quiet;  // what is taken of a file was said when it was read
    std::vector<ObjectMetadata> all;
    std::map<fs::path, bool> credited;
    const auto add = [&](const fs::path& file, const auto& read) {
        const auto [known, is_new] = credited.try_emplace(file.lexically_normal(), true);
        if (is_new && is_picture(file)) known->second = !all.emplace_back(read(file)).credit.empty();
        return known->second;
    };
    const auto quick = [](const fs::path& file) { return clues_of(file).metadata; };
    for (std::size_t i = 0; i < sets.size(); ++i) {
        if (!sets[i]) continue;
        const LayerParams& layer = scene.layers[i];
        bool whole = layer.source.kind != SourceKind::splats;
        for (const fs::path& file : all_files(layer.source)) whole = add(file, quick) && whole;
        if (const LayerParams* const like = like_layer(scene, layer))
            for (const fs::path& file : all_files(like->source)) add(file, quick);
        if (!whole) all.emplace_back().credit = sets[i]->credit;
        add(layer.look.thickness.map, read_picture_metadata);
    }
    std::vector<fs::path> sky = scene.environment.cube;
    sky.insert(sky.end(), {scene.environment.image, scene.environment.tile});
    if (scene.environment.visible)
        for (const fs::path& file : sky) add(file, read_picture_metadata);
    return merged_metadata(all);
}

ProvenanceParams resolved(ProvenanceParams provenance, const ObjectMetadata& sources) {
    if (provenance.title.empty()) provenance.title = sources.title;
    if (provenance.credit.empty()) provenance.credit = sources.credit;
    if (provenance.type == "auto") provenance.type = sources.type;
    return provenance;
}

}  // namespace astrosplat

// What the viewer keeps of one layer, from the first sample of a set that is being generated to the whole set
// with its histograms. In: sets and samples. Out: LoadedLayer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "core/progress.h"
#include "edit/status.h"
#include "source/source.h"
#include "splats/splat_set.h"
#include "viewer/growing_set.h"

namespace astrosplat {

struct LoadedLayer {
    std::shared_ptr<const SplatSet> set;      // in order of id: for the final frame; null while it grows
    std::shared_ptr<const SplatSet> preview;  // any prefix is a fair sample
    std::int64_t splats = 0;                  // of the whole set; while it grows those there are so far
    bool arranged = false;  // until then `preview` is a small sample, and grows a little later
    std::shared_ptr<const LayerHistograms> histograms;  // come a little later than the rest
    Bounds box;                                         // layer space; while it grows a guess
    glm::vec3 color{1.0f};                              // mean of the splats, weighted by alpha, linear
    glm::dvec2 radius{0.0};  // smallest and largest, scene units: what look.radius 0, 0 means; 0: unknown
    SourceParams source;
    std::string name;                          // which the seed may depend on
    std::vector<std::filesystem::path> files;  // it was made of; come with the histograms
    bool outdated = false;                     // one of them was changed since
};

/// A whole set, with a preview of a sample of at most `preview_limit` splats, in no time.
LoadedLayer whole_layer(std::shared_ptr<const SplatSet> set, const SourceParams& source,
                        const std::string& name, std::int64_t preview_limit);
/// A set that is being generated.
LoadedLayer growing_layer(const GrowingSet::Sample& sample, const SourceParams& source,
                          const std::string& name);
/// The same with its preview in stratified order, of as many splats as it may ever show.
LoadedLayer arranged_layer(LoadedLayer layer, std::int64_t preview_limit, const Progress& progress);
/// The same with histograms and files, for which meshes and frames are read once more.
LoadedLayer described_layer(LoadedLayer layer);

}  // namespace astrosplat

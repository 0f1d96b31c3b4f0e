// One layer as the viewer keeps it, from what stands for a set that is being generated to the whole set with
// its histograms. In: sets and the source they came from. Out: LoadedLayer.
#pragma once

#include <atomic>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/progress.h"
#include "edit/status.h"
#include "generate/kept_store.h"
#include "merge/tree.h"
#include "sets/kept.h"
#include "sets/load_source.h"
#include "sets/set_sample.h"
#include "source/source.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Some of the positions of columns, those of alpha 0 among them.
struct ColumnSample {
    std::shared_ptr<const SplatSet> set;  // with faces
    std::int64_t of = 0;                  // positions that there are
};

/// How far a set is that is being generated, and some positions of its columns in the end.
class MadeColumns : public KeptWatcher {
  public:
    /// At most so many positions.
    explicit MadeColumns(std::int64_t limit) : limit_(limit) {}

    void keeps(std::span<const KeptStore::Run> runs) override {
        for (const KeptStore::Run& run : runs) kept_ += std::int64_t(run.lit);
    }
    std::int64_t sample_limit() const override { return limit_; }
    void ends(Columns sample, std::int64_t of) override {
        columns_ = {std::make_shared<const SplatSet>(std::move(sample.splats)), of};
    }

    /// Splats kept so far; from any thread.
    std::int64_t kept() const { return kept_; }
    /// Spread evenly; without a set where there are none. Once the set is there.
    const ColumnSample& columns() const { return columns_; }

  private:
    std::int64_t limit_;
    std::atomic<std::int64_t> kept_{0};
    ColumnSample columns_;
};

struct LoadedLayer {
    std::shared_ptr<const SplatSet> set;  // for the final frame; null before it is there
    MergeSource sample;  // of it, for a preview at once; where that suffices, the set itself; stars: no tree
    MergeSource whole;   // for previews at rest; comes a little later, where `sample` is not all
    ColumnSample columns;     // of which set_loader.h makes a preview under other levels
    std::int64_t splats = 0;  // of the whole set, about before it is there
    bool arranged = false;    // nothing of the above is on its way
    std::shared_ptr<const LayerHistograms> histograms;  // come a little later than the rest
    Bounds box;                                         // layer space; a guess before it is there
    glm::vec3 color{1.0f};                              // mean of the splats, weighted by alpha, linear
    glm::dvec2 radius{0.0};     // smallest and largest, scene units: what look.radius 0, 0 means; 0: unknown
    AutomaticValues automatic;  // come with the histograms
    SourceParams source;
    std::string name;             // which the seed may depend on
    std::vector<fs::path> files;  // it was made of; come with the histograms
    bool outdated = false;        // one of them was changed since
    bool stands_in = false;       // splats of another set, until it is there
    Making making;                // of that
};

/// A set with its tree, as a sample of so many splats.
MergeSource source_of(std::shared_ptr<const SplatSet> set, std::int64_t stands_for);

/// Of a set with radii, with its tree (sample_light of merge/tree.h).
MergeSource light_sample(const SplatSet& set, std::int64_t count);

/// A whole set, with a sample of at most `sample_limit` splats, in no time; `sample`: of a larger set without
/// radii one that is there already, or null.
LoadedLayer whole_layer(std::shared_ptr<const SplatSet> set, const SourceParams& source,
                        const std::string& name, std::int64_t sample_limit,
                        const MergeSource* sample = nullptr);
/// Before the set is there, what stands for it.
LoadedLayer sampled_layer(SetSample sample, const SourceParams& source, const std::string& name);
/// The same with the tree of the whole, and a sixteenth of it, taken evenly over space, as the sample.
LoadedLayer arranged_layer(LoadedLayer layer, std::shared_ptr<const MergeTree> tree);
/// The same with histograms and files, for which meshes and pictures are read once more.
LoadedLayer described_layer(LoadedLayer layer);

/// How a set's distances spread and how its picture's values do, for the handles of the look's and the
/// source's controls. The values are those of the first picture of the first mesh: data values for FITS, else
/// the largest channel as stored. Without such a picture, or where it cannot be read, they are empty.
LayerHistograms histograms(const SplatSet& set, const SourceParams& source);

// Trees of large sets, kept in the cache beside the sets: a second start reads a tree instead of building it.
// In: a set, and the folder. Out: the same MergeTree, to the bit. What is damaged or of another version is
// removed and built again; a folder that cannot be written costs a warning.
//
// NAME.tree; the name says of which positions, ids and absorbing splats the tree is, wherever the set came
// from, so that sets that differ in the rest share theirs. Format version 3, in the machine's byte order:
//   header  8 bytes  89 'T' 'R' 'E' 'E' 0d 0a 1a, u32 version, u32 levels (ends of them, with the first 0),
//           u64 rows, u64 nodes
//   levels (i64), rows (i64), nodes (three i64 each)
//   u64 checksum (XXH64) of all before it

struct KeptTree {
    std::shared_ptr<const MergeTree> tree;
    fs::path file;        // where it is or belongs; empty: no cache
    bool cached = false;  // read from there
};

/// The set's tree, from the cache or built. Throws as build_merge_tree does.
KeptTree read_or_build_tree(const SetCache& cache, const SplatSet& set, const Progress& progress = {});

/// Writes one that was built, unless it would take more than an eighth of the cache. Throws Cancelled.
void keep_tree(const SetCache& cache, const KeptTree& kept, const Progress& progress = {});

}  // namespace astrosplat

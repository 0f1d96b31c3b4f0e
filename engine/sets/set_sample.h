// A hundredth of a layer's splats, to tell from what all of them will take. In: what load_source takes. Out:
// rows of a set that is kept, or of a splat file; of a set that is not kept yet those of a smaller picture
// or of a coarser lattice, as wide as those of the whole set, and how long the whole will take to make.
#pragma once

#include "core/progress.h"
#include "sets/kept.h"
#include "source/source.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// What making a whole set takes, about.
struct Making {
    double seconds = 0.0;           // 0: it is there
    std::int64_t bytes = 0;         // at most, while bodies are made of their pictures; 0: none are
    std::int64_t splats = 0;        // of bodies
    std::int64_t whole_splats = 0;  // the same without source.splats
};

struct SetSample {
    SplatSet set;
    std::int64_t splats = 0;  // of the whole set, about
    Making making = {};
    bool stands_in = false;  // rows of another set: show_quick_sets()
    /// How many splats a row stands for, at least 1; 0: there are none.
    double each() const { return set.size() > 0 ? double(splats) / double(set.size()) : 0.0; }
};

/// Of a set that is in the cache, or of a .splats file: at once. About so many rows, those of splats without
/// light counted; with 0 a hundredth, of small sets more, up to all of them: about 100,000. Nothing where the
/// set has to be made, or its file to be read as a whole, or where it cannot be used: then load_source says
/// why. Throws Cancelled.
std::optional<SetSample> sample_there(const SetCache& cache, const SourceParams& source,
                                      const std::string& layer_name, std::int64_t rows = 0,
                                      const Progress& progress = {});

/// That, or else a sample that is made; of splat files of other formats and of catalogues some of all rows.
/// Not for stars of a picture (is_like_a_layer). Nothing is kept. Throws as load_source does.
SetSample sample_set(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                     const Progress& progress = {});

/// What is to be seen of a set until it is there, each for as long as the next one takes: rows of one that is
/// kept, about `rows`, but of bodies, of which a few are blotches, only where there are very many; else the
/// flat picture, where it is asked for, and then bodies of a smaller picture, or columns on a coarser
/// lattice, unless the set takes hardly longer. Nothing of splat files of other formats and of catalogues.
/// Throws Cancelled; InputError where load_source will.
struct QuickSets {
    std::int64_t rows = 0;
    bool flat = true;
    std::function<void(SetSample)> show;
};
void show_quick_sets(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                     const QuickSets& quick, const Progress& progress = {});

}  // namespace astrosplat

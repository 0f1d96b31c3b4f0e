// Trees of large sets, kept in the cache beside the sets: a second start reads a tree instead of building it.
// In: a set, and the folder. Out: the same MergeTree, to the bit. What is damaged or of another version is
// removed and built again; a folder that cannot be written costs a warning.
//
// NAME.tree; the name says of which positions, ids and absorbing splats the tree is, wherever the set came
// from, so that sets that differ in the rest share theirs. Format version 2, in the machine's byte order:
//   header  8 bytes  89 'T' 'R' 'E' 'E' 0d 0a 1a, u32 version, u32 levels (ends of them, with the first 0),
//           u64 rows, u64 nodes
//   levels (i64), rows (i64), nodes (three i64 each)
//   u64 checksum (XXH64) of all before it
#pragma once

#include <filesystem>
#include <memory>

#include "core/progress.h"
#include "merge/tree.h"
#include "sets/kept.h"
#include "splats/splat_set.h"

namespace astrosplat {

struct KeptTree {
    std::shared_ptr<const MergeTree> tree;
    std::filesystem::path file;  // where it is or belongs; empty: no cache
    bool cached = false;         // read from there
};

/// The set's tree, from the cache or built. Throws as build_merge_tree does.
KeptTree read_or_build_tree(const SetCache& cache, const SplatSet& set, const Progress& progress = {});

/// Writes one that was built, unless it would take more than an eighth of the cache. Throws Cancelled.
void keep_tree(const SetCache& cache, const KeptTree& kept, const Progress& progress = {});

}  // namespace astrosplat

// Sets for tests of merging, with the splats of a look that changes nothing, and cuts of them.
#pragma once

#include <memory>
#include <span>
#include <utility>

#include "merge/cut.h"
#include "merge/tree.h"
#include "support/splats.h"

namespace astrosplat::test {

struct Cloud {
    std::shared_ptr<SplatSet> set = std::make_shared<SplatSet>();
    ShadedSplats splats;

    void add(const glm::vec3& position, const glm::vec3& color, float alpha, float radius, std::uint64_t id) {
        add_splat(*set, position, color, alpha);
        set->id.back() = id;
        splats.position.push_back(position);
        splats.color.push_back(color);
        splats.alpha.push_back(alpha);
        splats.radius.push_back(radius);
        splats.id.push_back(id);
    }
    void add(const glm::vec3& position, const glm::vec3& color, float alpha, float radius) {
        add(position, color, alpha, radius, static_cast<std::uint64_t>(set->size()));
    }
    MergedSplats merged(float weight = 1.0f) const {
        const auto tree = std::make_shared<const MergeTree>(build_merge_tree(*set));
        return merge_splats({set, tree, weight}, splats);
    }
};

/// Of one layer alone.
inline ShadedSplats cut_of(const MergedSplats& merged, const MergeSettings& merging,
                           const LayerProjection& projection, const CutSettings& settings) {
    const CutLayer cut{&merged, &merging, projection};
    return std::move(cut_splats(std::span(&cut, 1), settings)[0]);
}

}  // namespace astrosplat::test

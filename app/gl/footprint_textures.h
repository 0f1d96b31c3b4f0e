// The engine's footprint tables (render/footprint.h) as textures: weight over distance for every falloff in
// use, and what normalises it.
#pragma once

#include <vector>

#include "gl/objects.h"
#include "render/footprint.h"

namespace astrosplat {

/// What the vertex shader needs of a table besides its textures.
struct FootprintSlot {
    int table = 0;  // layer of the profiles, pair of rows of the nodes
    float reach = 1.0f;
    float core = 0.0f;
    bool flat_core = false;
};

class FootprintTextures {
  public:
    /// One slot per falloff, in order; tables that are not there yet are made (about 30 ms each).
    std::vector<FootprintSlot> prepare(const std::vector<Falloff>& falloffs, float pixel_filter_px);
    /// Weights: sampler2DArray of 256 x 513, linear; nodes: sampler2D, two rows a table.
    void bind(int profiles_unit, int nodes_unit) const;

  private:
    struct Entry {
        Falloff falloff;
        FootprintTable table;
    };
    void upload();
    std::vector<Entry> entries_;
    float pixel_filter_px_ = 0.0f;
    GlTexture profiles_, nodes_;
};

}  // namespace astrosplat

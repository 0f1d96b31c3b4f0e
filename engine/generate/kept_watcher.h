// Who wants to see a set while it is generated. In: splats as they are kept. What is made of them never
// reaches the set.
#pragma once

#include <span>

#include "core/bounds.h"
#include "generate/kept_store.h"

namespace astrosplat {

class KeptWatcher {
  public:
    virtual ~KeptWatcher() = default;
    /// Once, before the first splat. `empty` is the set as it will be but without splats; `box` holds the
    /// lattice, layer space.
    virtual void begins(const SplatSet& empty, const Bounds& box) = 0;
    /// Each kept splat once, in runs of ascending ids that come in any order; from any thread, several at a
    /// time. The runs are gone after the call, which keeps the thread from its work: it is to be short.
    virtual void keeps(std::span<const KeptStore::Run> runs) = 0;
};

}  // namespace astrosplat

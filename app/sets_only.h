// --batch --sets-only: generates the sets that the frames need and keeps them in the cache, one after the
// other, and renders nothing: what a farm does once before its tasks begin.
#pragma once

#include "batch.h"

namespace astrosplat {

/// Reports on stderr; the exit code. Throws InputError (also where an option beside asks for frames or there
/// is no cache), OutputError (the cache cannot be written), Cancelled.
int run_sets_only(const BatchOptions& options);

}  // namespace astrosplat

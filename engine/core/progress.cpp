// Turns a request to stop into an exception.
#include "core/progress.h"

#include "core/error.h"

namespace astrosplat {

void Progress::check() const {
    if (stop()) throw Cancelled();
}

}  // namespace astrosplat

// How much the view differs from what it is compared with, as numbers beside the difference that is shown.
// In: what the display shows. Out: numbers, measured again a few times a second while it changes.
#pragma once

#include <optional>

#include "edit/status.h"
#include "gl/display.h"

namespace astrosplat {

/// Of display values (RGBA of one size), where b's alpha is 1; none where that is nowhere.
std::optional<DifferenceStatus> difference_of(const Image& a, const Image& b);

class DifferenceMeter {
  public:
    /// What `display` shows of `shown` on a target of this size; `now` in seconds.
    void measure(Display& display, const DisplaySettings& shown, glm::ivec2 target_px, double now);
    void clear() { *this = {}; }
    const std::optional<DifferenceStatus>& found() const { return found_; }
    /// What is shown has not been measured yet.
    bool waiting() const { return waiting_; }

  private:
    DisplaySettings measured_;
    glm::ivec2 target_px_{0};
    double measured_at_ = -1.0;
    bool waiting_ = false;
    std::optional<DifferenceStatus> found_;
};

}  // namespace astrosplat

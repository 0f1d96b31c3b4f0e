// From linear images to what the screen shows: exposure, view transform over black, A/B wipe,
// difference, letterbox.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/image.h"
#include "output/inspection.h"
#include "output/scopes.h"
#include "scene/reference_place.h"
#include "scene/scene.h"

namespace astrosplat {

/// How an image is shown. `view` is not automatic.
struct DisplaySettings {
    OutputParams::View view = OutputParams::View::srgb;
    std::shared_ptr<const DisplayTransform> ocio;  // in place of `view`; null: none
    float exposure = 0.0f;                         // stops
    Inspection inspection;
    unsigned a = 0, b = 0;  // textures; b 0: only a
    /// Difference: a - b of display values times difference_gain, about middle grey; where b does not lie, a
    /// darker grey.
    enum class Mode { a, wipe, b, difference } mode = Mode::a;
    float wipe = 0.5f;  // 0..1 of the image's width
    float difference_gain = 1.0f;
    bool b_is_display = false;  // b holds display values (a reference image), not linear light
    std::optional<PicturePlace>
        b_place;  // px of the target: over a, which shows around b; none: b lies where a does, instead
    float b_opacity = 1.0f;  // over a, where b has a place
    // Where the image lies in the target, px from its upper left; may be larger than the target (1:1).
    float x = 0, y = 0, width = 0, height = 0;
    float background[3] = {0, 0, 0};  // around the image, display values
    bool dither = false;              // as 8-bit files are: no bands in dark gradients
    std::uint64_t content = 0;        // another number whenever the pixels of a or b are; 0: not known
    bool operator==(const DisplaySettings&) const = default;
};

/// An 8-bit target for the widgets to show.
class Display {
  public:
    Display();
    ~Display();
    /// Draws at target_width x target_height px, unless just that was drawn last; returns the texture (RGBA8,
    /// bottom row first as ImGui's ImVec2(0, 1) .. ImVec2(1, 0) expects).
    unsigned draw(const DisplaySettings& settings, int target_width, int target_height);
    /// Display values, without inspection, of what a difference of a and b compares: the part of a target of
    /// this size that the image covers, rows from the bottom. Alpha of b is 1 where b lies, else 0.
    struct Compared {
        Image a, b;
    };
    Compared read_compared(const DisplaySettings& settings, int target_width, int target_height);
    /// Grows whenever something was drawn.
    std::uint64_t version() const;
    /// The last draw(), read back as 8-bit RGBA, top row first.
    std::vector<unsigned char> read() const;
    /// Pixels of it that lie on the image or what it is compared with, 512 x 162 at most, evenly chosen, in
    /// as many columns as a waveform takes alike; none where nothing is shown.
    ScreenPoints points();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat

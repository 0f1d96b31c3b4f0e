// The programs of the display, each made for exactly what it shows: a pixel costs one read and one curve. In:
// what is shown, and the OpenColorIO transform in use. Out: a compiled program, kept.
#pragma once

#include <map>
#include <memory>

#include "gl/display.h"
#include "gl/ocio_tables.h"
#include "gl/program.h"

namespace astrosplat {

/// What one program of display_fragment.glsl is made for.
struct DisplayVariant {
    int view_a = 0, view_b = 0;  // VIEW_... of display_fragment.glsl
    int taps_a = 1, taps_b = 1;
    enum class Mix { alone, over, difference } mix = Mix::alone;
    bool masked = false, dither = false;
    auto operator<=>(const DisplayVariant&) const = default;
    /// Shows something through OpenColorIO.
    bool managed() const;
};

/// Of light; and of display values where `holds_display`.
int view_number(const DisplaySettings& settings, bool holds_display);

class DisplayPrograms {
  public:
    /// In use, with its textures at units 0 and 1, and beyond these `ocio`'s.
    const GlProgram& use(const DisplayVariant& variant, const std::shared_ptr<const DisplayTransform>& ocio);

  private:
    void use_ocio(const std::shared_ptr<const DisplayTransform>& wanted);

    std::map<DisplayVariant, std::unique_ptr<GlProgram>> programs_;  // compiled when first needed
    OcioTables ocio_;
};

}  // namespace astrosplat

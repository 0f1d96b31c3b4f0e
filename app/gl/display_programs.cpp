#include "gl/display_programs.h"

#include <fmt/format.h>

namespace astrosplat {
namespace {

constexpr int view_none = 3, view_ocio = 4;  // VIEW_NONE, VIEW_OCIO of display_fragment.glsl
constexpr int ocio_unit = 2;                 // its tables' first texture unit

ProgramSource source_of(const DisplayVariant& v, const OcioTables& ocio) {
    ProgramSource source{{fmt::format("VIEW {}", v.view_a), fmt::format("TAPS_A {}", v.taps_a)},
                         {"screen_vertex.glsl"},
                         {"display_fragment.glsl"},
                         {}};
    if (v.mix != DisplayVariant::Mix::alone) {
        const char* mix = v.mix == DisplayVariant::Mix::over ? "OVER" : "DIFFERENCE";
        source.defines.insert(source.defines.end(),
                              {mix, fmt::format("VIEW_B {}", v.view_b), fmt::format("TAPS_B {}", v.taps_b)});
    }
    if (v.masked) source.defines.push_back("MASKED");
    if (v.dither) source.defines.push_back("DITHER");
    if (v.managed()) {
        source.defines.push_back("WITH_OCIO");
        source.fragment_head = ocio.text();
    }
    return source;
}

}  // namespace

bool DisplayVariant::managed() const {
    return view_a == view_ocio || (mix != Mix::alone && view_b == view_ocio);
}

int view_number(const DisplaySettings& settings, bool holds_display) {
    if (holds_display) return view_none;
    // VIEW_LINEAR, VIEW_SRGB, VIEW_SOFT
    return settings.ocio ? view_ocio : static_cast<int>(settings.view) - 1;
}

/// Programs of another transform go.
void DisplayPrograms::use_ocio(const std::shared_ptr<const DisplayTransform>& wanted) {
    if (!ocio_.holds(wanted)) {
        std::erase_if(programs_, [](const auto& entry) { return entry.first.managed(); });
        ocio_.take(wanted, ocio_unit);
    }
    ocio_.bind(ocio_unit);
}

const GlProgram& DisplayPrograms::use(const DisplayVariant& variant,
                                      const std::shared_ptr<const DisplayTransform>& ocio) {
    if (variant.managed()) use_ocio(ocio);
    std::unique_ptr<GlProgram>& entry = programs_[variant];
    if (!entry) {
        entry = std::make_unique<GlProgram>(source_of(variant, ocio_));
        entry->set_sampler("image_a", 0);
        entry->set_sampler("image_b", 1);
        if (variant.managed()) ocio_.name_samplers(*entry, ocio_unit);
    }
    entry->use();
    return *entry;
}

}  // namespace astrosplat

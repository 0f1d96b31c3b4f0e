// The page of a fidelity report: numbers against targets, images side by side, difference, cells, power
// by scale and the views from the side. One file that asks for nothing from elsewhere.
#pragma once

#include <string>

#include "measure_fidelity.h"

namespace astrosplat {

/// HTML. `scene`: the name in the heading.
std::string fidelity_page(const FidelityReport& report, const std::string& scene);

}  // namespace astrosplat

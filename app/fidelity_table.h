// The measures of fidelity as people and programs read them: rows with targets, and JSON.
#pragma once

#include <string>
#include <vector>

#include "command.h"
#include "measure_fidelity.h"

namespace astrosplat {

/// none: there is no target.
enum class Verdict { none, met, missed };
const char* word_of(Verdict verdict);  // "", "met", "missed"

struct FidelityRow {
    std::string view;     // "front at 1280 px": what the rows of one view share
    std::string measure;  // "PSNR"
    std::string value;    // with its unit
    std::string target;   // "at least 39 dB"; empty: none
    Verdict verdict = Verdict::none;
};
std::vector<FidelityRow> fidelity_rows(const FidelityReport& report);

/// All numbers in full precision, under names that say their units.
Report fidelity_json(const FidelityReport& report, const std::string& scene);

/// A ratio as what is more or less: "+0.52 %".
std::string percent_off(double ratio);

}  // namespace astrosplat

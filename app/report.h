// Results on stdout: one ordered tree of names and values, printed as JSON or as indented lines for people.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace astrosplat {

using Report = nlohmann::ordered_json;

/// A number, or the word "inf", "-inf" or "nan", for which JSON has no number.
Report number(double value);

void print_report(const Report& report, bool json);

}  // namespace astrosplat

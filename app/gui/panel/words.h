// Values in words and figures, as rows and heads show them. Pure functions; nothing depends on the locale.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "edit/edit_rules.h"
#include "scene/parameter.h"

namespace astrosplat::panel {

/// Three figures at least, five where the number has them: "0.350", "45.0", "12.345", "2 000 000".
std::string figures(double number);

/// Of an integer: groups of three from 10,000 on.
std::string figures(std::int64_t number);

/// As above, with fewer figures (4, 3, 2, 1) until `fits` says yes; the shortest of them where none fits. In
/// a narrow box 1.2346 is "1.23"; digits before the point are never dropped.
std::string figures_that_fit(double number, const std::function<bool(const std::string&)>& fits);

/// "61 %"; `share` 0..1.
std::string percent(double share);

/// A choice as people write it: "gaussian" -> "Gaussian", "srgb" -> "sRGB".
std::string choice_label(const std::string& choice);

/// A value on one line, for tooltips and boxes that take any text: files by their names, nothing as "Auto".
std::string in_words(const ParameterSpec& spec, const Value& value);

/// Help, range and key: what a row's tooltip says.
std::string tooltip_text(const ParameterSpec& spec, const Value& standard);

/// `--set key=value` as one word of a shell.
std::string set_option(const std::string& key, const Value& value);

/// How much a parameter changes per pixel of dragging at `value`: a share of its range where that is short,
/// of itself where it spans magnitudes.
double drag_step(const ParameterSpec& spec, double value);

}  // namespace astrosplat::panel

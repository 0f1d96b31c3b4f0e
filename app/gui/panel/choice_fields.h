// Values that are chosen, not dragged or typed: yes or no, one of several words, some of several words.
#pragma once

#include "gui/panel/row.h"

namespace astrosplat::panel {

void boolean_field(Context& context, const Row& row);
void choice_field(Context& context, const Row& row);
/// A text that is one of these names, or empty, which `empty` says.
void name_field(Context& context, const Row& row, const std::vector<std::string>& names,
                const std::string& empty);
/// In as many lines as the words need; leaves the cursor below and returns true.
bool words_field(Context& context, const Row& row);

}  // namespace astrosplat::panel
